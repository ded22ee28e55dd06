/* json_out.h: JSON that is written whole or not at all; what was not measured is absent. */
#ifndef TC_CLI_JSON_OUT_H
#define TC_CLI_JSON_OUT_H

#include "cli/talk.h"

#include <jansson.h>

void tc_json_text(json_t *object, const char *key, const char *text);        /* absent when NULL or "" */
void tc_json_real(json_t *object, const char *key, double value);            /* absent when not finite */
void tc_json_measured(json_t *object, const char *key, double value);        /* absent when negative or not finite */
void tc_json_count(json_t *object, const char *key, uint64_t value);         /* always there */
void tc_json_measured_count(json_t *object, const char *key, int64_t value); /* absent when negative */
json_t *tc_json_reals(const double *value, size_t n);                        /* null where not finite */

/* Writes to path, or to stdout for "-", with a final newline. -1 to go on, else an exit code; the error is printed. */
int tc_json_write(const json_t *json, const char *path, tc_talk *talk);

/* Whether a file can be made at path: its folder exists and is writable, or path is a device. -1, or an exit code. */
int tc_output_check(const char *path, tc_talk *talk);

#endif
