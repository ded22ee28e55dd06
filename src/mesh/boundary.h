/* boundary.h: the faces of a linked mesh that have no neighbour, as a surface. */
#ifndef TC_MESH_BOUNDARY_H
#define TC_MESH_BOUNDARY_H

#include "mesh/mesh.h"

typedef struct tc_boundary {
    size_t n_face, n_vertex;
    int32_t *face;     /* [n_face][3] local vertex numbers, counter-clockwise seen from outside */
    uint32_t *owner;   /* [n_face] 4 * tet + face */
    int32_t *vertex;   /* [n_vertex] the mesh's vertex of a local number; ascending */
    int64_t *across;   /* [n_face][3] 3 * face + edge beyond edge i (from corner i to corner i + 1), or -1: see below */
    size_t n_odd_edge; /* edges with across -1, that do not belong to exactly two faces running along them in
                          opposite senses; each counted once a face */
    size_t n_component; /* edge-connected parts of the surface */
} tc_boundary;

/* Faces of tets [0, n_tet) whose neighbour is -1 or not below n_tet. Errors: TC_E_MEMORY. Cost: O(n_tet). */
tc_status tc_boundary_build(tc_boundary *out, const tc_mesh *mesh, size_t n_tet, tc_error *err);
void tc_boundary_finish(tc_boundary *b);

/* Is it one closed surface that is convex, up to dents less deep than tolerance (in the mesh's unit)? No edge may be
 * reflex, unless its two faces become flat when their corners move by about the tolerance; every face must show its
 * inner side to the middle, and all together go around it once: a closed connected surface that is convex at every
 * point is convex (Tietze 1928, Nakajima 1928). Narrow faces do no harm; the angle between faces on both sides of one
 * that is narrower than the tolerance counts as theirs, and small dents that add up around a vertex are told. Out of
 * memory: false. Cost: O(n_face log) time, 27 B/face. */
bool tc_boundary_is_convex(const tc_boundary *b, const double *vertex, double tolerance);

/* A depth that rounding of coordinates explains: 1e-14 of the diagonal plus 4 units in the last place. */
double tc_boundary_rounding(const double bounds[6]);

#endif
