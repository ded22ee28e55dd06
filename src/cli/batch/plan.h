/* plan.h: which frames there are, in one order (steps, then fields, functions, views), and which of them a shard makes.
 */
#ifndef TC_CLI_BATCH_PLAN_H
#define TC_CLI_BATCH_PLAN_H

#include <stdbool.h>
#include <stddef.h>

enum { TC_PLAN_RANGES = 32, TC_PLAN_SHARDS_MOST = 1000000 };
/* More frames than that are refused. */
#define TC_PLAN_FRAMES_MOST 1000000000000ULL

/* Steps by number, from 0; negative: from the end. Both ends belong to it. */
typedef struct tc_plan_range {
    bool has_from, has_to;
    bool one; /* the step `from` alone */
    long long from, to;
    long long stride; /* 1 and more */
} tc_plan_range;

/* A list of ranges; n 0: every step. No memory of its own. */
typedef struct tc_plan_ranges {
    size_t n;
    tc_plan_range range[TC_PLAN_RANGES];
} tc_plan_ranges;

/* One of `of` equal shares of the work, counted from 1; both 0: all of it. */
typedef struct tc_plan_shard {
    int index, of;
} tc_plan_shard;

/* "FROM:TO[:STRIDE]", either end may be left out, or "N", or several by commas. field: a tc_plan_ranges, which is kept
 * as it is where text is wrong. False then, and why [64] may say more. As a tc_option's parse. */
bool tc_plan_ranges_parse(void *field, const char *text, char *why);

/* "I/N". field: a tc_plan_shard. As above. */
bool tc_plan_shard_parse(void *field, const char *text, char *why);

/* What a plan is made of. */
typedef struct tc_plan_options {
    size_t n_time;                      /* steps of the dataset; 0: it has no time, and one step, number 0 */
    const tc_plan_ranges *ranges;       /* NULL: every step */
    size_t n_field, n_function, n_view; /* each at least 1 */
    bool along;                         /* each step has its own view, that of its position; n_view is not looked at */
    tc_plan_shard shard;
} tc_plan_options;

/* Frames 0 … n-1. */
typedef struct tc_plan {
    size_t n_step, n_field, n_function, n_view; /* n_view is that of one step: 1 where along is set */
    int *step;                                  /* [n_step] numbers in the dataset, ascending, each once */
    bool along;
    tc_plan_shard shard;
    size_t n_of_step; /* frames of one step */
    size_t n;         /* of all shards */
} tc_plan;

/* A frame's place. */
typedef struct tc_plan_frame {
    size_t position; /* of the step in plan->step, which is a frame's number within its series, too */
    size_t field, function, view;
    int step; /* its number in the dataset */
} tc_plan_frame;

/* Frames first … first + n - 1. */
typedef struct tc_plan_span {
    size_t first, n;
} tc_plan_span;

/* Makes a plan. A range that ends behind the last step ends there. False: a range has no step, counts are 0 or there
 * are too many frames, or memory ran out; why [capacity_why] goes on behind the dataset's name: "has 21 time steps (0
 * to 20), so there is no step 30". *out is to be finished whatever it is. Cost: O(n_time). */
bool tc_plan_make(tc_plan *out, const tc_plan_options *options, char *why, size_t capacity_why);
void tc_plan_finish(tc_plan *plan);

/* From a frame, below plan->n, to its place and back; frame.step is not looked at. */
tc_plan_frame tc_plan_frame_at(const tc_plan *plan, size_t frame);
size_t tc_plan_frame_of(const tc_plan *plan, const tc_plan_frame *place);

/* The frames of the step at this position, below n_step, that are the shard's: n 0: none, and the step need not be
 * read. A step's frames stand together, so those of all positions in turn are the shard's frames, ascending.
 *
 * Steps are dealt out in turn, whole, where there are at least as many as shards: each is read by one shard alone. Else
 * a step's frames are dealt out in blocks among the shards that have it, so that those of one field stay together. */
tc_plan_span tc_plan_span_of(const tc_plan *plan, size_t position);

/* Is the frame the shard's? */
bool tc_plan_mine(const tc_plan *plan, size_t frame);
/* How many are. Cost: O(n_step). */
size_t tc_plan_n_mine(const tc_plan *plan);

#endif
