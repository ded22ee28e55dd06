/* look.h: what a tc_look asks of the caster, made ready once for many rays; inside the room. */
#ifndef TC_REFERENCE_LOOK_H
#define TC_REFERENCE_LOOK_H

#include "mesh/field.h"
#include "reference/shapes.h"
#include "reference/trace.h"

/* Lengths are the caster's scaled ones, gradients are per scaled length. */
struct tc_look_ready {
    const tc_look *look; /* borrowed */
    double range;        /* width of the scalars' range */
    double color_range;  /* width of the colour field's */
    double diagonal;     /* of the real tets' bounds */
    tc_iso *iso;         /* [look->n_iso] by value, ascending */
    uint8_t *kept;       /* [mesh->n_tet] 0: left out; NULL: all are seen */
    double *gradient;    /* [mesh->n_tet][3] or, smooth, [mesh->n_vertex][3]; NULL: no light */
    bool smooth;
    tc_shapes shapes;
};

/* Leaves of the line what planes and box keep. */
void tc_look_cut(tc_line *line, const tc_reference *reference);

/* Of a ray that gave a place (TC_MODEL_DEPTH): its distance from the origin becomes that from the eye's plane, and
 * both numbers are kept within floats. Of others nothing changes. */
void tc_look_depth(double rgba[4], const tc_reference *reference, const tc_rays *rays, const double origin[3],
                   const double direction[3]);

/* Sums up what one ray sees.
 *   hit    [n] in order, cut to what is seen
 *   line   as it was asked for: geometry is neither cut by planes nor by the box
 *   walked where the hits were found: line, or beside it
 *   shift  is added to every scalar; it is in the hits' already
 * Errors: TC_E_MEMORY. */
tc_status tc_look_gather(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                         const tc_hit *hit, size_t n, const tc_line *line, const tc_line *walked, int worker);

/* The gradient of the scalar, per scaled length: of each tet [mesh->n_tet][3], zero where a value is not finite, where
 * the tet has no volume (point data) and in tets that the caster leaves out.
 * Errors: TC_E_MEMORY. Cost: O(n), with cell data O(n log n) and 80 bytes a tet. */
tc_status tc_gradient_of_cells(double *out, const tc_reference *reference);
/* The mean of `cell` around each vertex, by volume: [mesh->n_vertex][3]. Errors: TC_E_MEMORY. */
tc_status tc_gradient_of_vertices(double *out, const double *cell, const tc_reference *reference);

#endif
