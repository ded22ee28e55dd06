/* frame.h: one frame of a batch: from a mesh and a look that are set up to the files that are to be written. */
#ifndef TC_CLI_BATCH_FRAME_H
#define TC_CLI_BATCH_FRAME_H

#include "cli/batch/frames.h"
#include "cli/batch/writers.h"
#include "cli/picture/render_picture.h"

enum { TC_FRAME_ARGUMENTS = 256 };

/* What all frames are made with. */
typedef struct tc_frame_kit {
    const tc_batch_frames *frames;
    const tc_batch_base *base;
    const tc_batch_scene *scene;
    tc_frames renderer;
    char *argument[TC_FRAME_ARGUMENTS]; /* the command that pictures name */
    int n_argument;
    char data[TC_IDENTITY]; /* identity of the file that the mesh is from; "": it changed while it was read */
    size_t empty;         /* pictures in which nothing is seen, so far */
    char empty_why[1024]; /* the first of them, and why */
    tc_talk *talk;
} tc_frame_kit;

/* Fills *out, whose other members are set. -1, or the exit code of an error that was printed; whatever it is,
 * tc_frame_kit_finish ends what is there. */
int tc_frame_kit_make(tc_frame_kit *kit);
void tc_frame_kit_finish(tc_frame_kit *kit);

/* Makes a frame of base: a run whose mesh, function and look are set up. What is to be written goes to *files; a picture so
 * large that it is made in bands, or one that shows both eyes, is written at once: files->n is 0 then, and *written says
 * what became of it. The same codes. */
int tc_frame_make(tc_frame_files *files, tc_written *written, tc_frame_kit *kit, const tc_render_run *base,
                  size_t number);

#endif
