/* render_picture.h: from a prepared mesh to one picture in a file. */
#ifndef TC_CLI_RENDER_PICTURE_H
#define TC_CLI_RENDER_PICTURE_H

#include "cli/picture/render_report.h"

/* What the frames of one run are made with. */
typedef struct tc_frames {
    tc_renderer_options make;
    tc_renderer_start *start; /* until renderer is there */
    tc_renderer *renderer;
    tc_image_writer *writer;                      /* NULL: pictures start one each */
    double *frame, *first_hit, *march, *readback; /* [repeat] each, one block */
} tc_frames;

/* Room for the times of --repeat. Begins what needs no mesh: the renderer, which tc_render_ready waits for, and the
 * program that writes pictures, if their format needs one; finish ends what is there of them. -1, or the exit code of an error that was printed.
 */
int tc_frames_make(tc_frames *out, const tc_render_command *options, tc_talk *talk);
void tc_frames_finish(tc_frames *frames);

/* Waits for the renderer. -1 to go on, else an exit code. */
int tc_render_ready(tc_frames *frames, tc_talk *talk);
/* Renders run->image and verifies it. -1 to go on, else an exit code. */
int tc_picture_render(tc_render_run *run, tc_frames *frames, tc_talk *talk);
/* The largest opacity of an image, or of light alone its largest channel. */
double tc_picture_peak(const tc_render_run *run, const tc_image *image);
/* Is there nothing to be seen in a picture with that peak? why gets the sentence that says so, and why as far as it can be
 * told. */
bool tc_peak_is_empty(char *why, size_t capacity, const tc_render_run *run, double peak);
/* Is there nothing to be seen in run->image? why gets the sentence that says so, and why as far as it can be told. */
bool tc_picture_is_empty(char *why, size_t capacity, const tc_render_run *run);
/* tc_picture_render, and writes the picture and the image of errors. The same codes; run->measured says whether there are
 * numbers all the same. */
int tc_render_picture(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv);
/* Says what was done, when all is written, and what was wrong with it. -1, or an exit code. */
int tc_render_end(const tc_render_run *run, tc_talk *talk);

#endif
