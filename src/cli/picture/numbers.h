/* numbers.h: pictures of numbers beside one of colours: depth, and the scalar there. */
#ifndef TC_CLI_PICTURE_NUMBERS_H
#define TC_CLI_PICTURE_NUMBERS_H

#include "cli/picture/render_write.h"

/* Why the options' picture has no depth; NULL: it has. Static memory. */
const char *tc_numbers_wrong(const tc_render_command *options);

/* Files to be written beside the picture at path, where --depth and --value ask for them, of a run whose picture was rendered:
 * depth as a channel of the picture's own file where that is .exr (into *own), else NAME_depth.exr; the scalar as NAME_value.exr.
 *   out  [2], *n gets how many; the caller frees them (tc_picture_file_finish)
 * -1, or the exit code of an error that was printed. */
int tc_numbers_make(tc_picture_file *out, int *n, tc_picture_file *own, const tc_render_run *run, tc_renderer *renderer,
                    const char *path, tc_talk *talk);
/* The name of such a file, from malloc: NAME_kind.exr. NULL: memory ran out. */
char *tc_numbers_path(const char *path, const char *kind);
/* Is it a file of its own? */
bool tc_depth_is_apart(const char *path);

#endif
