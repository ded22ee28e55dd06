/* suite.h: the one suite that every driver passes on every context (docs/architecture.md, "Drivers"): what its programs
 * share.
 *
 * Each program takes a back end as its argument: a context ("osmesa", "egl") for the driver pingpong, the same for the
 * driver compute ("osmesa-compute", "egl-compute"), or "reference".
 * Where a context is missing it says why and ends with SUITE_SKIPPED. Every picture that is rendered here must have
 * lost no ray and hold neither NaN, Inf, negative values, alpha above 1, nor colour more than half an 8-bit step above
 * alpha times the function's largest. */
#ifndef TC_TESTS_SUITE_SUITE_H
#define TC_TESTS_SUITE_SUITE_H

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>

#include "tetcast.h"

enum { SUITE_SKIPPED = 77 }; /* ctest's SKIP_RETURN_CODE */

/* Half an 8-bit step: what the defaults promise. */
#define SUITE_HALF_STEP (1.0 / 510)

/* Makes the renderer that argv[1] names. False: say SUITE_SKIPPED to ctest. Exits with 2 on a wrong argument and with 1
 * where a context that is installed cannot be used. */
bool suite_begin(int argc, char **argv);
void suite_end(void);
const char *suite_backend(void); /* that argument */
const char *suite_context(void); /* "osmesa", "egl" or "reference" */
/* The driver renders with GL: it has passes, fragments and bytes on the GPU. */
bool suite_is_gpu(void);
/* The driver locks finished rays by z-updates between passes. */
bool suite_locks(void);
/* Prints a measured value, with the back end's name before it. */
void suite_say(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Prepared meshes; n_cells 0: the generator's default. The test ends where one cannot be made. */
tc_mesh *suite_synth(const char *name, size_t n_cells, tc_reentry reentry);
tc_mesh *suite_mesh(const tc_mesh_arrays *arrays, tc_reentry reentry);
void suite_prepare(tc_mesh *mesh, tc_reentry reentry);
double suite_diagonal(const tc_mesh *mesh); /* of the bounds */

tc_transfer *suite_function(const tc_knot *knot, size_t n);
/* The benchmark function over the mesh's range: Cool to Warm, opacity linear from 0 to 0.3. */
tc_transfer *suite_benchmark(const tc_mesh *mesh);

/* The whole mesh in view from direction (x, y, z), 30 degrees or parallel. */
tc_camera suite_camera(const tc_mesh *mesh, double x, double y, double z, bool parallel);
/* The defaults at that size. */
tc_render_options suite_options(int width, int height);
/* The ray of a pixel (row 0 at the top), made from the camera's meaning alone: origin and unit direction. Perspective:
 * origin is the eye. */
void suite_ray(double origin[3], double direction[3], const tc_camera *camera, int width, int height, int x, int y);

/* Renders and checks what must hold of every picture (above). stats may be NULL. */
tc_image *suite_render(tc_render_stats *stats, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                       const tc_render_options *options);
/* Another renderer of this back end; the test ends where it cannot be made. poison: what TETCAST_GL_POISON says while
 * it is made, or NULL: what the environment says. */
tc_renderer *suite_renderer(const char *poison);
/* A picture by such a renderer, of which nothing is checked. stats may be NULL. */
tc_image *suite_render_by(tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh, const tc_transfer *tf,
                          const tc_camera *camera, const tc_render_options *options);
/* The audit of the last picture, out [height][width]; the test ends where there is none. */
void suite_audit(tc_audit_ray *out);
tc_status suite_try_audit(tc_audit_ray *out, tc_error *err);
/* A picture that is expected to fail; whatever was made of it is freed. */
tc_status suite_try_render(const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                           const tc_render_options *options, tc_error *err);
/* The largest difference of a channel. */
double suite_difference(const tc_image *a, const tc_image *b);
/* How far the picture is from the double-precision reference in n pixels, and that this is at most `bound` apart from
 * ill-posed rays, which may be one in 10000 (and one at least). Says what was measured. */
tc_verify_result suite_verify(const char *what, double bound, size_t n, const tc_image *image, const tc_mesh *mesh,
                              const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options);
/* Renders and verifies all pixels against half an 8-bit step. */
void suite_check(const char *what, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                 const tc_render_options *options);

#endif
