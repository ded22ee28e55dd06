/* reference.h: the double-precision ray caster on the CPU: the truth that the GPU is judged by.
 *
 * It shares no code with gpu/ and uses nothing of the mesh's preparation: no adjacency, no orientation, no order, no
 * imaginary tets; a mesh need not be prepared. A bounding volume hierarchy over the real tets finds every tet a ray
 * meets; each is judged alone from its four corners in double, with exact signs (trace.c); the parts are sorted by
 * entry depth and integrated exactly between the function's knots (segment.c). Where tets overlap there is no order in
 * space; runs of tets that follow each other through common faces are then composited whole, in the order of their
 * entries, ties by tet (overlap.c).
 *
 * A tet with a scalar that is not finite at any corner (or its own, for cell data) is transparent, unless
 * tc_reference_set_nan_color gives it a colour: it adds to the length and to the segments but not to the picture. Tets
 * that repeat a vertex, or have a corner that is missing or not finite, are left out. */
#ifndef TC_REFERENCE_REFERENCE_H
#define TC_REFERENCE_REFERENCE_H

#include "mesh/mesh.h"
#include "scene/camera.h"
#include "transfer_functions/transfer.h"

typedef struct tc_reference tc_reference;

/* Builds the hierarchy over the mesh's real tets; mesh is borrowed for the reference's life, its geometry may not
 * change. Scalars are read when rays are traced: tc_mesh_set_scalar needs no new reference. threads: 0: all cores.
 * Errors: TC_E_MEMORY; TC_E_ARG (no mesh, 2^31 tets). Cost: O(n log n) time, about 60 B/tet, at the peak 130. */
tc_status tc_reference_create(tc_reference **out, const tc_mesh *mesh, int threads, tc_error *err);
void tc_reference_destroy(tc_reference **reference);

/* Tets with a scalar that is not finite show this colour from now on: color [4], r, g, b and the attenuation per unit
 * distance, copied; NULL: they are transparent again. Not while rays are traced. */
void tc_reference_set_nan_color(tc_reference *reference, const double *color);

/* The picture has this look from now on, until it is set anew (tetcast_look.h); NULL or nothing asked for: the plain
 * density emitter, to the last bit. The look and all that it points to are borrowed for so long; fields are in the mesh's
 * order. Gradients and selected cells are found here: after tc_mesh_set_scalar set it again. Not while rays are traced.
 *   isosurfaces  where a ray runs through an edge or a vertex the values of one place differ by rounding from cell to cell:
 *                the cell before decides, so that a surface there is neither missed nor met twice
 *   a field for colour that is not finite in a cell makes the cell one whose values are not finite
 *   geometry     triangles as they are: neither planes nor box nor selection cut them, only the camera's near and far do;
 *                lines are not drawn. With MAXIMUM, MINIMUM and AVERAGE it is all in front of the picture
 *   DEPTH        in pixels as tetcast_look.h says; of a ray by itself r is the distance from its origin
 *   nan color    lit by nothing; 0 with ABSORPTION, 1 with XRAY; not seen with SURFACES, MAXIMUM, MINIMUM, AVERAGE
 * Errors: TC_E_ARG (a field of another size, a colour field without function, isosurfaces of cell data, geometry with
 * vertices that are missing or not finite), TC_E_MEMORY; the look is plain then. Cost: O(n), with gradients of cell data
 * O(n log n); 24 B a tet or vertex for gradients, 1 B a tet for a selection, 100 B a triangle. */
tc_status tc_reference_set_look(tc_reference *reference, const tc_look *look, tc_error *err);

typedef struct tc_reference_ray {
    double rgba[4]; /* premultiplied */
    double length;  /* of all real segments that are seen */
    size_t segments;
} tc_reference_ray;

/* One ray: origin, unit direction, and the part of it that is seen, range [2] (tc_rays_range; either end may be
 * infinite).
 * unit: the unit distance U. opacity_stop is NOT applied: the truth has no early end. worker: 0..255, as from
 * tc_parallel_for; two threads may trace at once with different ones.
 * Errors: TC_E_MEMORY; TC_E_ARG (worker, unit <= 0). Cost: O(log n + segments). */
tc_status tc_reference_trace(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                             const double origin[3], const double direction[3], const double range[2], int worker);

/* Pixels have this many rays from now on: as tc_render_options.samples. Not while rays are traced. */
void tc_reference_set_samples(tc_reference *reference, int samples);

/* The pixel whose middle is (X, Y) in the coordinates of rays: the mean of its rays, of tc_reference_set_samples.
 * Adaptive: by how the reference's own first rays differ (samples.h).
 *   out [4]: r, g, b, alpha; worker as in tc_reference_trace
 * Errors: as tc_reference_trace. Cost: that of its rays. */
tc_status tc_reference_pixel(double *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                             const tc_rays *rays, double X, double Y, int worker);

/* Every pixel, with as many rays as tc_reference_set_samples said. log: progress only, from the calling thread.
 * Errors: TC_E_MEMORY; TC_E_ARG (sizes differ, unit <= 0). */
tc_status tc_reference_render(tc_image *image, const tc_reference *reference, const tc_transfer *tf, double unit,
                              const tc_rays *rays, int threads, const tc_log *log, tc_error *err);

/* Premultiplied colour and opacity of one segment of length l (in unit distances) over which the scalar runs linearly
 * from s0 to s1, both finite: exact to 1e-10. Where s0 = s1 lies on a step the right value holds. out: r, g, b, alpha.
 */
void tc_reference_segment(double out[4], const tc_transfer *tf, double s0, double s1, double l);

/* Compares n pixels of image (drawn without repetition from seed; n >= all: all) with the reference, channel by
 * channel, float against double; with as many rays a pixel as tc_reference_set_samples said (adaptive: 16). worst_x,
 * worst_y: the image's column and row (row 0 at the top). rays_lost stays 0. errors: as in tc_truth_compare; may be NULL.
 * Ill-posed rays are counted and left out of max, p999, p9999 and mean: their reference colour
 * moves by more than 1/1020 in a channel when the ray is shifted by 2^-22 of the diagonal to any of four sides or as
 * far along both to any of four corners, all scalars by 2^-22 of their range up or down, or, where
 * tets overlap, runs of them by 2^-22 of the diagonal against each other (all moves: ill_posed.c). Only rays whose error
 * exceeds 1/1020 are asked: others could not raise the maximum above it. A channel that is not finite counts as an
 * error of FLT_MAX and is never ill-posed. Many pictures of one view: truth.h.
 * Errors: TC_E_MEMORY; TC_E_ARG (sizes differ, unit <= 0). */
tc_status tc_reference_verify(tc_verify_result *out, tc_image *errors, const tc_image *image, size_t n, uint64_t seed,
                              const tc_reference *reference, const tc_transfer *tf, double unit, const tc_rays *rays,
                              int threads, const tc_log *log, tc_error *err);

#endif
