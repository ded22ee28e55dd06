/* invariants.h: one case (mesh, view, function) rendered and judged. */
#ifndef TC_TESTS_HARD_INVARIANTS_H
#define TC_TESTS_HARD_INVARIANTS_H

#include "cameras.h"
#include "functions.h"

/* Bounds: of lengths, in diagonals, against true ones and against exact arithmetic on the same floats (a walk adds its
 * segments up in float: through thousands of cells the sum is off by some 3.5e-6, whatever the weights are); of
 * pictures; of alpha over analytic chords; the share of ill-posed rays. Of colour above alpha's share: none but
 * rounding; tables of half floats round colour and alpha apart, by 2^-11 each. */
#define HARD_LENGTH 1e-5
#define HARD_WALK 5e-6
#define HARD_PICTURE (1.0 / 510)
#define HARD_ALPHA_INTEGRAL 1e-5
#define HARD_ALPHA_TABLE 5e-4
#define HARD_EXCESS 2e-5
#define HARD_EXCESS_HALF 0x1p-10
#define HARD_ILL_POSED 1e-4

/* Where pictures are made, and how many of their rays are judged. */
typedef struct hard_bench {
    const char *context;           /* a back end of tests/common/backend.h */
    bool gpu;                      /* walks from cell to cell */
    bool exact;                    /* its floats are IEEE's: the judge's cells must be the walk's */
    tc_renderer *renderer, *other; /* other: on another context or by another driver, or NULL */
    size_t judged, verified;       /* random rays by brute force and pixels by the reference, each picture */
    const char *write;             /* folder for pictures, or NULL */
} hard_bench;

typedef struct hard_result {
    char mesh[64], view[48], function[48], relation[48];
    int64_t rays, lost, broken;
    size_t judged, wrong, doubtful, cycles; /* rays by brute force; other cells than the walk's */
    size_t lengths;                         /* of these, the rays whose true length was asked for */
    double length_error, real_error;        /* in diagonals; of a ray whose length jumps, from those of its sides */
    double walk_error;                      /* of real lengths against exact weights of the same floats, all rays */
    size_t jumps;                           /* rays whose length jumps */
    size_t pixels, ill_posed;               /* by the reference */
    double picture_error;
    size_t chords, ill_chord; /* by the analytic chord */
    double alpha_error;
    size_t compared, ill_compared; /* pixels beside another picture of the same thing */
    double difference;
    char failure[400]; /* "" when all bounds are kept */
} hard_result;

/* A picture with all that its rays did. */
typedef struct hard_picture {
    tc_image *image;
    tc_audit_ray *audit; /* [height][width]; NULL: not by this driver */
    tc_rays rays;
    tc_render_options options;
} hard_picture;

void hard_fail(hard_result *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Renders and judges: finite pixels (invariant 10), no ray lost, no cell held wrongly, the cells of brute force (1),
 * lengths (2), alpha over analytic chords where function and view allow (3), the reference's picture (7). What fails
 * goes into r->failure. out may be NULL; hard_picture_finish frees it. */
void hard_judge_case(hard_picture *out, hard_result *r, const hard_bench *bench, tc_renderer *renderer,
                     const hard_mesh *mesh, const hard_view *view, const hard_function *function,
                     tc_integrator integrator);
void hard_picture_finish(hard_picture *p);

/* Two pictures of the same thing agree within HARD_PICTURE, apart from pixels that the reference of `mesh` (of which a
 * is) calls ill-posed. mirrored: b's columns run the other way, and alpha alone is compared. */
void hard_compare(hard_result *r, const hard_picture *a, const hard_picture *b, bool mirrored, const hard_mesh *mesh,
                  const hard_function *function);

#endif
