/* frames.h: every frame of a batch: its camera, its file, what its pixels depend on, and whether it is still to do. */
#ifndef TC_CLI_BATCH_FRAMES_H
#define TC_CLI_BATCH_FRAMES_H

#include "cli/batch/base.h"
#include "cli/batch/names.h"

typedef enum tc_frame_state {
    TC_STATE_OTHER = 0, /* of another shard */
    TC_STATE_TO_DO,
    TC_STATE_KEPT, /* finished and valid before */
    TC_STATE_DONE,
    TC_STATE_FAILED
} tc_frame_state;

typedef struct tc_batch_frame {
    char *file; /* of its picture */
    unsigned char state;
} tc_batch_frame;

/* A camera of the plan: of a view, or, along time, of a step. */
typedef struct tc_batch_view {
    tc_camera camera; /* from the base's box */
    double phi, theta; /* degrees; NAN: it has none */
    char name[64];
} tc_batch_view;

typedef struct tc_batch_frames {
    tc_plan plan;
    tc_batch_frame *frame; /* [plan.n] */
    size_t n_view;
    tc_batch_view *view; /* [n_view] */
    char *pattern;       /* of the files' names */
    char *cdb;           /* the folder of the Cinema database; NULL: none */
} tc_batch_frames;

/* The steps that are chosen, and the plan. -1, or the exit code of an error that was printed; whatever it is,
 * tc_batch_frames_finish frees what is there. */
int tc_batch_plan(tc_batch_frames *out, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk);
/* Cameras and files of all frames, once base is surveyed. The same codes: names that meet, a wrong pattern or view. */
int tc_batch_frames_make(tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk);
void tc_batch_frames_finish(tc_batch_frames *frames);

/* The view of a frame. */
size_t tc_batch_view_of(const tc_batch_frames *frames, const tc_plan_frame *place);
/* What stands in a frame's name and title. field: as it is called in the file. */
tc_name_values tc_batch_values(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene,
                               size_t frame);
/* The file of an eye's picture, of a stereo pair (0 left, 1 right); from malloc; NULL: memory ran out. */
char *tc_batch_eye_file(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene,
                        size_t frame, int eye);
/* The camera of a view where the box is another than the base's. -1, or an exit code. */
int tc_batch_view_camera(tc_camera *out, const tc_batch_frames *frames, const tc_batch_scene *scene, size_t view,
                         const double bounds[6], tc_talk *talk);
/* The text "tetcast:frame" of a frame: its digest and its place, as JSON, from malloc; NULL: memory ran out. data: the
 * identity of its step's file. */
char *tc_batch_frame_text(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene,
                          size_t frame, const char *data);
/* With --resume: frames of this shard whose files are there, whole and of that digest become TC_STATE_KEPT. stale gets how
 * many files were there, but of another digest or damaged. */
int tc_batch_resume(tc_batch_frames *frames, size_t *stale, const tc_batch_base *base, const tc_batch_scene *scene,
                    tc_talk *talk);

#endif
