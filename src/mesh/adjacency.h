/* adjacency.h: which tets share a face. */
#ifndef TC_MESH_ADJACENCY_H
#define TC_MESH_ADJACENCY_H

#include "core/status.h"

/* Vertices of face f (opposite vertex f) of a positive tet, counter-clockwise seen from outside. */
extern const uint8_t tc_tet_face[4][3];

typedef struct tc_adjacency_result {
    size_t duplicates; /* tets equal to an earlier one; nothing is linked to them when > 0: drop them, build again */
    size_t many;       /* faces of three or more tets, left unlinked */
    size_t one_side;   /* faces of two tets on one side, left unlinked */
    size_t reoriented; /* zero-volume tets that were turned (vertices 2 and 3 swapped) to fit their neighbours */
} tc_adjacency_result;

typedef struct tc_adjacency_input {
    const double *vertex; /* [n_vertex][3]; finite where used */
    size_t n_vertex;
    int32_t *tet; /* [n_tet][4], distinct ids each, positive or zero volume; zero-volume ones may be turned */
    size_t n_tet;
    size_t first; /* tets below it are linked already: only their open faces take part, and they are not turned */
    size_t n_zero_volume; /* of the tets from first on; 0 spares a pass */
    int threads;
} tc_adjacency_input;

/* Neighbours of each tet across each face.
 *   neighbour [n_tet][4], caller's memory; face f is opposite vertex f; -1 outside. Entries below `first` are read.
 *   duplicate [n_tet] or NULL: set to 1 for each tet equal to an earlier one, else 0
 * Only faces with equal vertex sets on opposite sides are linked, so the result is an involution. Sides are told by
 * orientation: two positive tets on opposite sides wind their common face in opposite senses.
 * Errors: TC_E_MEMORY. Cost: O(n_tet) time, 9 B/tet scratch and, for each thread, some 100 B
 * for each tet of the part of the faces at hand (of few vertices, or where most tets share one, nearly all), threaded; the result does not depend on
 * the threads. */
tc_status tc_adjacency_build(int32_t *neighbour, uint8_t *duplicate, tc_adjacency_result *result,
                             const tc_adjacency_input *input, tc_error *err);

/* Face-connected parts of tets [0, n_tet); links to others are ignored. Errors: TC_E_MEMORY. Cost: O(n_tet), threaded,
 * 4 B/tet scratch. */
tc_status tc_adjacency_components(size_t *out, const int32_t *neighbour, size_t n_tet, int threads, tc_error *err);

#endif
