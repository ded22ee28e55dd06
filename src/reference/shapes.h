/* shapes.h: the triangles of a look's geometry, to be met by rays; inside the room. */
#ifndef TC_REFERENCE_SHAPES_H
#define TC_REFERENCE_SHAPES_H

#include "reference/trace.h"

/* One triangle that a ray meets. */
struct tc_meeting {
    double t;
    uint32_t shape; /* in tc_shapes.triangle */
};

typedef struct tc_shape {
    uint32_t geometry;
    int32_t id[3]; /* vertex ids, ascending */
} tc_shape;

typedef struct tc_shapes {
    tc_bvh bvh;
    size_t n;
    tc_shape *triangle; /* [n] in the order of the geometries */
    double **vertex;    /* [n_geometry] scaled, as the mesh's */
    int n_geometry;
} tc_shapes;

/* Triangles that repeat a vertex are left out. Lines are not drawn by rays.
 * Errors: TC_E_ARG (a vertex that is missing or not finite, names it), TC_E_MEMORY. Cost: O(n log n). */
tc_status tc_shapes_build(tc_shapes *out, const tc_geometry *geometry, int n_geometry, const tc_reference *reference,
                          tc_error *err);
void tc_shapes_finish(tc_shapes *shapes);

/* The triangles that the line meets between t_min and t_max, nearest first, ties in their order: *n of them in
 * scratch->meeting. False: no memory. */
bool tc_shapes_meet(size_t *n, tc_scratch *scratch, const tc_shapes *shapes, const tc_line *line);
/* The unit normal of a triangle; false: it has none. */
bool tc_shapes_normal(double out[3], const tc_shapes *shapes, uint32_t shape);

#endif
