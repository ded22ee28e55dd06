/* digest.h: what a frame's pixels depend on, as a short text that its files carry, so that a finished frame is known
 * again. */
#ifndef TC_CLI_BATCH_DIGEST_H
#define TC_CLI_BATCH_DIGEST_H

#include "cli/picture/render_options.h"

enum { TC_IDENTITY = 512 }; /* bytes that are enough for one */

/* A file as it is: name, size and time of its last change; of a dataset of several files (EnSight, OpenFOAM, PVD and
 * the like) also those of the files in and below its folder, as tc_cache_key_make. "" in out [capacity]: it cannot be
 * told. */
void tc_identity_make(char *out, size_t capacity, const char *path);

/* What a look is made with: the options that make a picture what it is, by name, and the identities of files that they
 * name. Of steps, views and files to write nothing. New reference. */
json_t *tc_digest_options(const tc_render_command *options);

/* 16 hexadecimal digits of the JSON's canonical text (FNV-1a, 64 bits; Fowler, Noll, Vo). Takes json over; "": memory
 * ran out. */
void tc_digest_make(char out[17], json_t *json);

#endif
