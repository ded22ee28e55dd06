/* batch_options.h: the command line of `batch`: all options of render, and those of many pictures. */
#ifndef TC_CLI_BATCH_OPTIONS_H
#define TC_CLI_BATCH_OPTIONS_H

#include "cli/batch/plan.h"
#include "cli/picture/render_options.h"

/* What a range, the unit distance or the camera is found from. */
typedef enum tc_over {
    TC_OVER_AUTO = 0,
    TC_OVER_ALL = 1,   /* all steps of the batch, by a fast first pass */
    TC_OVER_FIRST = 2, /* the first step of the dataset */
    TC_OVER_STEP = 3   /* each step by itself */
} tc_over;

typedef struct tc_batch_command {
    tc_render_command picture; /* first: its options' table is this command's, too */
    tc_plan_ranges frames; /* n 0: all */
    tc_plan_shard shard;
    int range_over, unit_over, camera_over; /* tc_over */
    bool cinema;
    const char *video;
    double fps;
    bool resume, dry_run, json;
    uint64_t memory; /* bytes; 0: not bounded */
} tc_batch_command;

/* The command line, and with `at` a scene that stands in memory (tc_picture_command_take). -1, or the exit code of an
 * error that was printed; whatever it is, tc_batch_command_finish frees what the struct holds. */
int tc_batch_command_take(tc_batch_command *out, const tc_scene_at *at, tc_talk *talk, int argc, char **argv);
void tc_batch_command_finish(tc_batch_command *command);

/* Runs the command; in cmd_batch.c. */
int tc_batch_run_command(tc_talk *talk, const tc_command *command, int argc, char **argv);

#endif
