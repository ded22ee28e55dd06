/* report.h: how a batch tells of its frames: a bar on a terminal, else a line for each file, or events as JSON lines on
 * stdout; and what failed, at the end. */
#ifndef TC_CLI_BATCH_REPORT_H
#define TC_CLI_BATCH_REPORT_H

#include "cli/json_out.h"
#include "cli/talk.h"

/* What became of a frame. */
typedef enum tc_frame_end {
    TC_FRAME_DONE = 0,
    TC_FRAME_KEPT = 1, /* it was finished and valid before */
    TC_FRAME_FAILED = 2
} tc_frame_end;

/* A frame that failed, or a step, whose frames then all did. */
typedef struct tc_failure {
    char *file, *why;
    size_t frames;
} tc_failure;

typedef struct tc_report {
    tc_talk *talk;
    bool json;
    size_t all;                /* frames of this run */
    size_t done, kept, failed; /* of them, so far */
    double start_s, line_at_s;
    size_t n_failure;
    tc_failure *failure; /* [n_failure] */
} tc_report;

void tc_report_begin(tc_report *out, tc_talk *talk, bool json, size_t all);
/* A frame's end. number: of the frame in the whole plan; why: of a failed one; ms: of writing, NAN: not measured. */
void tc_report_frame(tc_report *report, tc_frame_end end, size_t number, const char *file, int step, double time,
                     const char *why, double ms, size_t bytes);
/* Frames that failed for one reason: those of a step that cannot be read. */
void tc_report_failed(tc_report *report, const char *file, const char *why, size_t frames);
/* One more event of this name with these values, which it takes over; nothing without --json. */
void tc_report_event(tc_report *report, const char *event, json_t *values);
/* Draws the bar anew, with the file at hand. */
void tc_report_bar(tc_report *report, const char *file);
/* Says what was done, how fast, and what failed. stopped: the signal that ended the run early; NULL. */
void tc_report_end(tc_report *report, const char *stopped);
void tc_report_finish(tc_report *report);

#endif
