/* rows.h: rows of a study as lines of CSV, in files that only grow by whole lines. */
#ifndef TC_STUDY_ROWS_H
#define TC_STUDY_ROWS_H

#include "core/status.h"

#include <jansson.h>
#include <stdio.h>

/* A text that grows; text is NULL until the first append, failed when memory ran out. */
typedef struct tc_text {
    char *text;
    size_t length, capacity;
    bool failed;
} tc_text;
void tc_text_add(tc_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void tc_text_finish(tc_text *text);
/* A number as short as it is exact to 9 digits; nothing for NAN. */
void tc_text_number(tc_text *text, double value);

/* Nothing measured. */
void tc_study_row_clear(tc_study_row *row);
/* The line of column names, without newline. */
void tc_study_row_header(tc_text *out);
/* One line, without newline. */
void tc_study_row_write(tc_text *out, const tc_study_row *row);
/* From one line [length]; false: it is none. */
bool tc_study_row_parse(tc_study_row *out, const char *line, size_t length);
/* A new object with what was measured, or NULL when memory is out. */
json_t *tc_study_row_json(const tc_study_row *row);

/* name as a word of a file or cell: letters, digits and ._- stay, others become _. */
void tc_study_word(char *out, size_t capacity, const char *name);

/* A file of lines, the first of them `header`: what is in it (*content, the caller's, ended by 0; only whole lines),
 * after cutting off a line that was not finished. A file that is not there, or does not hold the header whole, becomes
 * one with the header alone. Errors: TC_E_FILE (also: it begins otherwise), TC_E_MEMORY. */
tc_status tc_lines_open(char **content, const char *path, const char *header, tc_error *err);
/* Adds one line and its newline by a single write. Errors: TC_E_FILE. */
tc_status tc_lines_append(const char *path, const char *line, tc_error *err);

#endif
