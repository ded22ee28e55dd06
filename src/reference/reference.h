/* reference.h: the double-precision ray caster on the CPU: the truth that the GPU is judged by.
 *
 * It shares no code with gpu/ and none of the mesh's preparation: no adjacency, no orientation, no order. A bounding
 * volume hierarchy over the real tets finds every tet a ray meets; each is clipped as an intersection of four half
 * spaces in double; the segments are sorted by entry depth and integrated exactly between the function's knots. */
#ifndef TC_REFERENCE_REFERENCE_H
#define TC_REFERENCE_REFERENCE_H

#include "mesh/mesh.h"
#include "scene/camera.h"
#include "transfer_functions/transfer.h"

typedef struct tc_reference tc_reference;

/* Builds the hierarchy over the mesh's real tets; mesh is borrowed for the reference's life. O(n log n). */
tc_status tc_reference_create(tc_reference **out, const tc_mesh *mesh, int threads, tc_error *err);
void tc_reference_destroy(tc_reference **reference);

typedef struct tc_reference_ray {
    double rgba[4];      /* premultiplied */
    double length;       /* of all real segments in front of the eye */
    size_t segments;
} tc_reference_ray;

/* One ray: origin, unit direction, from t_min on (0 in perspective, -infinity in parallel).
 * unit: the unit distance U. opacity_stop is NOT applied: the truth has no early end. scratch per thread: worker index. */
tc_status tc_reference_trace(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                             const double origin[3], const double direction[3], double t_min, int worker);

/* Every pixel. Errors: TC_E_MEMORY, TC_E_CANCEL. */
tc_status tc_reference_render(tc_image *image, const tc_reference *reference, const tc_transfer *tf, double unit,
                              const tc_rays *rays, int threads, const tc_log *log, tc_error *err);

/* Transmittance and premultiplied colour of one segment of optical length l (in unit distances) over which the scalar
 * runs linearly from s0 to s1: exact to 1e-10. out: r, g, b, alpha. */
void tc_reference_segment(double out[4], const tc_transfer *tf, double s0, double s1, double l);

/* Compares n pixels of image with the reference (hard_cases.md invariant 7 for ill-posed rays: those whose reference colour
 * moves by more than 1/1020 when the ray is shifted by 2^-22 of the diagonal in its frame or the data by 2^-22 of range). */
tc_status tc_reference_verify(tc_verify_result *out, const tc_image *image, size_t n, uint64_t seed,
                              const tc_reference *reference, const tc_transfer *tf, double unit, const tc_rays *rays,
                              int threads, const tc_log *log, tc_error *err);

#endif
