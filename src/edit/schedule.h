/* schedule.h: how a picture is made while something moves and once it rests: how coarse, and in how many parts, so that
 * each is there in its time and can be given up between two. No GL and no clock here: times come in, plans go out. Not
 * thread-safe. */
#ifndef TC_EDIT_SCHEDULE_H
#define TC_EDIT_SCHEDULE_H

#include <stdbool.h>

enum { TC_COARSEST = 8 };

/* One rendering: rows of the picture at 1 / divide of its size, (width + divide - 1) / divide x (height + divide - 1) /
 * divide pixels. */
typedef struct tc_step {
    int divide;
    int from, rows; /* from row `from` on; all: 0 and the coarse picture's height */
    bool last;      /* with it the picture at full size is whole */
    bool kept;      /* it was planned as one along kept walks */
    unsigned state; /* of which change it is */
} tc_step;

/* What renderings took: fixed_ms + ns_a_pixel * pixels, by a Kalman filter of these two, which takes noise for a share
 * of what is measured, and one time that is far off for an accident. */
typedef struct tc_cost {
    int count; /* measured so often; 0: nothing is known */
    int far;   /* this often in a row far off */
    double fixed_ms, ns_a_pixel;
    double spread[3]; /* covariance: fixed fixed, fixed pixel, pixel pixel, per million pixels */
} tc_cost;

typedef struct tc_schedule {
    int width, height;  /* of the picture */
    double budget_ms;   /* of a picture while something moves: 60 */
    double part_ms;     /* of a part once it rests: 40, so that what comes next waits no longer */
    tc_cost cost[2];    /* [0] with a view that is new, [1] with one along which walks are kept */
    int coarse[2];      /* how coarse it was the last time, likewise; 0: not yet */
    int missed, doubt;  /* kept ones that were not, in a row; so many are not believed in any more */
    double crowd;       /* the fullest part of a picture, over the mean one */
    int parts;          /* of the last picture at full size, as planned */
    bool moving;
    unsigned state;     /* changes so far */
    unsigned sized;     /* … up to the last of the size */
    int shown;          /* the finest whole picture of what there is now; 0: none yet */
    int divide, row;    /* of the finer picture that is being made; divide 0: it is to be planned */
    int part_rows;      /* … in parts of so many rows */
    struct {
        double ms;                        /* of the parts so far */
        double most, most_of_two, before; /* for a row: the longest, the longest of two in a row, the last part's */
        int rows;                         /* of a part, as planned */
        int parts, kept;                  /* so far, and along kept walks */
    } pass;
} tc_schedule;

/* Nothing is known yet. */
void tc_schedule_begin(tc_schedule *schedule, int width, int height);
/* Another size; what is known of times stays. A change, of the same hand as the last one. */
void tc_schedule_resize(tc_schedule *schedule, int width, int height);
/* Something changed, by the user's hand if moving: the next step is a whole coarse picture. While it moves it is the
 * only one. It is as fine as it can be within the budget, 1 / 8 at the least, and gets finer only where four fifths of
 * the budget suffice, so that its size does not flicker. */
void tc_schedule_change(tc_schedule *schedule, bool moving);
/* It is at rest: after the coarse picture come finer ones. */
void tc_schedule_rest(tc_schedule *schedule);
/* What to render next; false: nothing, until there is a change, or rest after one that moved. kept: will walks be along
 * kept ones, as far as can be told? A promise that is broken several times is not believed for a while. The first
 * picture of all is small, since nothing is known. At rest follows the picture at full size, in parts; if it would take
 * more than twice the budget, before it one of a fourth of its time, and before that likewise. Parts take about part_ms
 * where they are fullest, but no less than thrice what a rendering takes beside its pixels, and are the same from
 * picture to picture as long as that holds, so that walks along them can be kept. A step that is given up is not told,
 * and comes again. */
bool tc_schedule_next(tc_step *out, tc_schedule *schedule, bool kept);
/* It was rendered, in so many milliseconds; kept: along kept walks. One of before the last change teaches times only.
 * */
void tc_schedule_done(tc_schedule *schedule, const tc_step *step, double ms, bool kept);

#endif
