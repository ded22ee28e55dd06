/* films.h: the pictures of a batch, step after step, as videos. */
#ifndef TC_CLI_BATCH_FILMS_H
#define TC_CLI_BATCH_FILMS_H

#include "cli/batch/frames.h"
#include "cli/batch/report.h"

/* Can --video be what it is? The kind of file, names that tell the videos apart, pictures that ffmpeg takes. -1, or the exit code
 * of an error that was printed; that ffmpeg is not there is a warning. */
int tc_films_check(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk);
/* Makes one of each field, function and view whose pictures are all there, those of other shards, too; says what is not. -1, or
 * the exit code where one could not be made. */
int tc_films_make(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene,
                  tc_report *report, tc_talk *talk);

#endif
