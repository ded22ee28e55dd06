/* schedule.h: how a picture is made while something moves and once it rests: how coarse, and in how many parts, so that each is there in
 * its time and can be given up between two. No GL and no clock here: times come in, plans go out. */
#ifndef TC_EDIT_SCHEDULE_H
#define TC_EDIT_SCHEDULE_H

#include <stdbool.h>

/* One rendering: the picture of width x height at 1 / divide of its size, of which the rows from `from` on (of the coarse picture) are made. */
typedef struct tc_step {
    int divide;
    int from, rows;  /* all: 0 and the coarse picture's height */
    bool last;       /* of the picture at full size: it rests */
} tc_step;

typedef struct tc_schedule {
    int width, height;  /* of the picture */
    double budget_ms;   /* of a picture while something moves: 60 */
    double part_ms;     /* of a part once it rests: 40, so that what comes next waits no longer */
    double ns_a_pixel[2]; /* measured, smoothed: [0] with a view that is new, [1] with one along which walks are kept; 0: not known */
    double fixed_ms[2];   /* what a rendering takes beside its pixels */
    bool moving;
    int divide, row;      /* of what comes next */
} tc_schedule;

void tc_schedule_begin(tc_schedule *schedule, int width, int height);
/* Something changed, by the user's hand if moving: the next step is a whole coarse picture. */
void tc_schedule_change(tc_schedule *schedule, bool moving);
/* It is at rest: after the coarse picture come finer ones. */
void tc_schedule_rest(tc_schedule *schedule);
/* What to render next; false: nothing, the picture at full size is whole. kept: will walks be along kept ones? The first of all is small,
 * since nothing is known; at rest follow, if the full picture would take more than twice the budget, one of a fourth of its time, then parts. */
bool tc_schedule_next(tc_step *out, tc_schedule *schedule, bool kept);
/* It was rendered, in so many milliseconds. */
void tc_schedule_done(tc_schedule *schedule, const tc_step *step, double ms, bool kept);

#endif
