/* candidate.h: the settings that --error and --frame-time choose from, and the rules of choosing. Pure: no rendering.
 */
#ifndef TC_STUDY_CANDIDATE_H
#define TC_STUDY_CANDIDATE_H

#include "core/status.h"

/* A way to integrate, with an opacity at which rays end. Candidates of one group differ in that opacity alone. */
typedef struct tc_candidate {
    tc_integrator integrator;
    int order;    /* of INTEGRAL; 0: as the caller fixed it, or left to the renderer, which also leaves hard segments to
                     pieces */
    double split; /* of INTEGRAL; 0: none, or as the caller fixed it */
    int table[3]; /* of TABLE; 0: as the caller fixed it */
    tc_table_format format;
    double stop;
    int group;
    double error; /* largest seen so far; NAN: not measured; INFINITY: it cannot be rendered */
    double ms;    /* of a frame; NAN: not measured */
} tc_candidate;

enum { TC_CANDIDATE_MAX = 64, TC_CANDIDATE_TEXT = 128 };

/* All candidates that leave what `fixed` decides as it is: its integrator, order, split, table and opacity stop where
 * they are not 0. Groups follow each other, within a group the stop rises. Errors and times are NAN. Gives their
 * number. */
size_t tc_candidate_list(tc_candidate out[TC_CANDIDATE_MAX], const tc_render_options *fixed);

/* options with the candidate's knobs; the others stay. */
void tc_candidate_apply(tc_render_options *options, const tc_candidate *candidate);

/* A name without blanks, unique among candidates: "integral-2-0.25-0-0.999". */
void tc_candidate_key(char out[TC_CANDIDATE_TEXT], const tc_candidate *candidate);
/* In words: "running integrals of second order, split at 0.25, opacity stop 0.999". options: what the caller fixed. */
void tc_candidate_text(char out[TC_CANDIDATE_TEXT], const tc_candidate *candidate, const tc_render_options *options);

/* Of each group the candidate with the least stop whose error is at most limit: a lower stop is never slower. index [n]
 * gets them; gives their number. */
size_t tc_candidate_frugal(size_t *index, const tc_candidate *candidate, size_t n, double limit);
/* Of the m in index the one whose time is least; of those as fast to TC_TIME_SAME the one with the least error. Ones
 * without a time come last. m must not be 0. */
#define TC_TIME_SAME 0.03
size_t tc_candidate_cheapest(const tc_candidate *candidate, const size_t *index, size_t m);
/* The candidate with the least error, of those the one with the least stop; n where none was measured. */
size_t tc_candidate_best(const tc_candidate *candidate, size_t n);
/* The members of a group of which each is more accurate than the one before, by the stop: index gets them, gives their
 * number. A stop that nothing reaches buys nothing. */
size_t tc_candidate_ladder(size_t *index, const tc_candidate *candidate, size_t n, int group);

#endif
