/* run.h: the frames of a batch, from the plan to the files. */
#ifndef TC_CLI_BATCH_RUN_H
#define TC_CLI_BATCH_RUN_H

#include "cli/batch/catalogue.h"
#include "cli/batch/report.h"

/* Makes the frames that are to do, tells of each, and keeps the catalogue. -1: all are made, or what failed is in the report;
 * else the exit code of an error that was printed and that ended the run. */
int tc_batch_run(tc_batch_frames *frames, tc_batch_base *base, tc_catalogue *catalogue, const tc_batch_scene *scene,
                 tc_report *report, tc_talk *talk);

#endif
