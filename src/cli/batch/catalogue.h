/* catalogue.h: the Cinema database of a batch: a row for each frame that is finished. */
#ifndef TC_CLI_BATCH_CATALOGUE_H
#define TC_CLI_BATCH_CATALOGUE_H

#include "cli/batch/cinema.h"
#include "cli/batch/frames.h"

typedef struct tc_catalogue {
    tc_cinema *cinema; /* NULL: none is asked for */
    bool degrees;      /* columns phi and theta; else one of views' names */
    bool depth, value;
    bool pair;         /* a stereo pair: FILE_right is the right eye's */
    double saved_s;    /* when it was saved last */
    size_t unsaved;
} tc_catalogue;

/* Opens the database of frames->cdb, if there is one. -1, or the exit code of an error that was printed. */
int tc_catalogue_open(tc_catalogue *out, const tc_batch_frames *frames, const tc_batch_scene *scene, tc_talk *talk);
/* Adds a finished frame, and saves every few seconds. The same codes. */
int tc_catalogue_add(tc_catalogue *catalogue, const tc_batch_frames *frames, const tc_batch_base *base,
                     const tc_batch_scene *scene, size_t frame, tc_talk *talk);
/* Saves what was added. The same codes. */
int tc_catalogue_save(tc_catalogue *catalogue, tc_talk *talk);
void tc_catalogue_finish(tc_catalogue *catalogue);

#endif
