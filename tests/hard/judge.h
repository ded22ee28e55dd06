/* judge.h: brute force: one ray against every cell of a mesh, without a walk.
 *
 * Two judgements. hard_judge_walk takes the ray's frame and the float vertices that the shaders see, written anew in C,
 * and tells which cells the walk must visit: exactly those. hard_judge_chord takes the true coordinates in double and
 * tells how long the ray is in the mesh: what the walk's lengths must come near. It shares nothing with gpu/shaders. */
#ifndef TC_TESTS_HARD_JUDGE_H
#define TC_TESTS_HARD_JUDGE_H

#include "gpu/frame.h"

typedef struct hard_judge hard_judge;

/* mesh: prepared, borrowed for the judge's life; its geometry may not change. Errors: TC_E_MEMORY, as tc_pack_build. */
tc_status hard_judge_create(hard_judge **out, const tc_mesh *mesh, tc_error *err);
void hard_judge_destroy(hard_judge **judge);
/* The rays of a view in the judge's mesh space; the same uniforms that the shaders get. */
void hard_judge_frame(tc_frame *out, const hard_judge *judge, const tc_rays *rays);

/* What the walk of a ray must do, by the signs of the float coordinates. */
typedef struct hard_walk {
    uint32_t
        cells; /* on the paths that the picture shows, up to the far plane; behind an eye outside the mesh none are */
    uint32_t hash;   /* sum of tc_audit_hash over them */
    uint32_t layers; /* such paths */
    uint32_t broken; /* cells of which neither no nor two faces hold the ray, and paths that end inside: never */
    uint32_t cycle;  /* cells on closed paths, which no walk from the boundary reaches: float geometry that folds */
    uint32_t unseen; /* cells on paths, or their ends, that the picture does not show */
    uint32_t doubt;  /* faces met so near a clipping plane that float may decide otherwise: cells may differ there */
    double length, length_real; /* of the walk's segments, in the mesh's unit; depth never goes back */
} hard_walk;

/* (X, Y): the pixel's centre, y counted from the bottom. worker: 0..255, as from tc_parallel_for; two threads may ask
 * at once with different ones. Errors: TC_E_MEMORY. Cost: O(vertices + cells), some 5 ns each. */
tc_status hard_judge_walk(hard_walk *out, hard_judge *judge, const tc_frame *frame, double X, double Y, int worker);

/* How long a line is in the mesh, in the mesh's unit, between distances t_min and t_max from its origin. */
typedef struct hard_chord {
    double real;    /* sum over the real cells; overlaps count twice */
    double covered; /* length of their union: real, unless cells overlap */
    double all;     /* sum over real and imaginary cells */
    double hull;    /* from the first cell's entry to the last one's exit */
} hard_chord;

/* direction: unit length. Errors: TC_E_MEMORY. */
tc_status hard_judge_chord(hard_chord *out, hard_judge *judge, const double origin[3], const double direction[3],
                           double t_min, double t_max, int worker);

/* For the test of the tests: the judge overlooks this cell from now on; SIZE_MAX: none. */
void hard_judge_blind(hard_judge *judge, size_t cell);

#endif
