/* render_write.h: from a rendered picture to its files, in two halves: what needs the run, and what another thread may do. */
#ifndef TC_CLI_RENDER_WRITE_H
#define TC_CLI_RENDER_WRITE_H

#include "cli/picture/render_report.h"

/* A picture that waits to be written: all that its file holds. Owns everything. */
typedef struct tc_picture_file {
    char *path;
    tc_image *image;
    float *depth; /* [height][width]; NULL: none */
    tc_image_encoding encoding;
    tc_meta meta;
} tc_picture_file;

/* Lays the background under run->image and draws title, bar and axes over it. -1, or the exit code of an error that was
 * printed. */
int tc_picture_dress(tc_render_run *run, tc_talk *talk);
/* Fills *out with run->image, which it takes over, and the texts that the command argv gives it. The same codes. */
int tc_picture_file_make(tc_picture_file *out, tc_render_run *run, const char *path, int argc, char **argv,
                         tc_talk *talk);
/* Writes the file; writer NULL: with a helper program of its own. Of any thread, one at a time for one writer.
 * Errors: as tc_image_write. */
tc_status tc_picture_file_write(const tc_picture_file *file, tc_image_writer *writer, const tc_log *log, tc_error *err);
void tc_picture_file_finish(tc_picture_file *file);

#endif
