/* suite.c: what the programs of the suite share. */
#define _GNU_SOURCE
#include "suite.h"

#include "core/vec.h"
#include "tests/common/backend.h"
#include "tests/common/sane.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct {
    const char *name;
    bool gpu;
    tc_renderer *renderer;
} suite;

bool suite_begin(int argc, char **argv)
{
    suite.name = argc == 2 ? argv[1] : "";
    if (!backend_known(suite.name)) {
        fprintf(stderr, "usage: %s osmesa|egl|osmesa-compute|egl-compute|reference\n", argv[0]);
        exit(2);
    }
    suite.gpu = strcmp(suite.name, "reference") != 0;
    int code = backend_open(&suite.renderer, suite.name);
    if (code != 0 && code != BACKEND_SKIPPED)
        exit(code);
    return code == 0;
}

void suite_end(void)
{
    tc_renderer_destroy(&suite.renderer);
}

const char *suite_backend(void)
{
    return suite.name;
}

const char *suite_context(void)
{
    return suite.gpu ? backend_options(suite.name).gl : suite.name;
}

bool suite_is_gpu(void)
{
    return suite.gpu;
}

bool suite_locks(void)
{
    return strcmp(backend_options(suite.name).driver, "pingpong") == 0;
}

void suite_say(const char *format, ...)
{
    va_list arguments;
    printf("    %s: ", suite.name);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
    fflush(stdout);
}

static void expect_ok(tc_status status, const tc_error *err, const char *what)
{
    if (status != TC_OK)
        fail_msg("%s: %s", what, err->text);
}

void suite_prepare(tc_mesh *mesh, tc_reentry reentry)
{
    const tc_prepare_options options = {.reentry = reentry};
    tc_error err = {0};
    expect_ok(tc_mesh_prepare(mesh, &options, NULL, &err), &err, "preparing");
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    if (reentry != TC_REENTRY_AUTO && !report.convex && report.reentry != reentry)
        fail_msg("the mesh was not prepared as asked: %s", report.reentry_why);
}

tc_mesh *suite_synth(const char *name, size_t n_cells, tc_reentry reentry)
{
    tc_mesh *mesh;
    tc_error err = {0};
    expect_ok(tc_synth_create(&mesh, name, n_cells, 1, &err), &err, name);
    suite_prepare(mesh, reentry);
    return mesh;
}

tc_mesh *suite_mesh(const tc_mesh_arrays *arrays, tc_reentry reentry)
{
    tc_mesh *mesh;
    tc_error err = {0};
    expect_ok(tc_mesh_create(&mesh, arrays, &err), &err, "making a mesh");
    suite_prepare(mesh, reentry);
    return mesh;
}

double suite_diagonal(const tc_mesh *mesh)
{
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const double *b = report.bounds;
    const double d[3] = {b[1] - b[0], b[3] - b[2], b[5] - b[4]};
    return tc_vec_length(d);
}

tc_transfer *suite_function(const tc_knot *knot, size_t n)
{
    tc_transfer *tf;
    tc_error err = {0};
    expect_ok(tc_transfer_from_knots(&tf, knot, n, &err), &err, "a function");
    return tf;
}

tc_transfer *suite_benchmark(const tc_mesh *mesh)
{
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const tc_transfer_options options = {.color_map = "Cool to Warm",
                                         .opacity = "linear",
                                         .data_range = {report.scalar_range[0], report.scalar_range[1]}};
    tc_transfer *tf;
    tc_error err = {0};
    expect_ok(tc_transfer_create(&tf, &options, &err), &err, "the benchmark function");
    return tf;
}

tc_camera suite_camera(const tc_mesh *mesh, double x, double y, double z, bool parallel)
{
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const double direction[3] = {x, y, z}, up[3] = {0, 1, 0};
    tc_camera camera = {.parallel = parallel};
    tc_camera_reset(&camera, report.bounds, direction, up, 30, 1);
    camera.parallel = parallel;
    return camera;
}

tc_render_options suite_options(int width, int height)
{
    tc_render_options options;
    tc_render_defaults(&options);
    options.width = width;
    options.height = height;
    return options;
}

void suite_ray(double origin[3], double direction[3], const tc_camera *camera, int width, int height, int x, int y)
{
    double forward[3], right[3], up[3];
    tc_vec_sub(forward, camera->focal_point, camera->position);
    tc_vec_normalize(forward);
    tc_vec_cross(right, forward, camera->view_up);
    tc_vec_normalize(right);
    tc_vec_cross(up, right, forward);
    double h = camera->parallel ? camera->parallel_scale : tan(camera->view_angle * 3.14159265358979323846 / 360);
    double across = h * ((2.0 * x + 1) / width - 1) * width / height, above = h * (1 - (2.0 * y + 1) / height);
    double *moved = camera->parallel ? origin : direction;
    tc_vec_copy(origin, camera->parallel ? camera->focal_point : camera->position);
    tc_vec_copy(direction, forward);
    tc_vec_mul_add(moved, moved, across, right);
    tc_vec_mul_add(moved, moved, above, up);
    tc_vec_normalize(direction);
}

tc_status suite_try_audit(tc_audit_ray *out, tc_error *err)
{
    return tc_render_audit(out, suite.renderer, err);
}

tc_status suite_try_render(const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                           const tc_render_options *options, tc_error *err)
{
    tc_image *image;
    tc_status status = tc_render(&image, NULL, suite.renderer, mesh, tf, camera, options, NULL, err);
    tc_image_destroy(&image);
    return status;
}

void suite_audit(tc_audit_ray *out)
{
    tc_error err = {0};
    if (suite_try_audit(out, &err) != TC_OK)
        fail_msg("%s", err.text);
}

/* What must hold of every picture. A table's colours and opacities are rounded apart from each other; light and surfaces of a
 * look may be brighter than the function. */
static void expect_sane(const tc_image *image, const tc_transfer *tf, const tc_render_options *options)
{
    char what[160];
    if (!picture_is_sane(what, sizeof what, image, tf, options->has_nan_color ? options->nan_color : NULL,
                         options->look ? INFINITY : options->table_format == TC_TABLE_8 ? 0.08 : SUITE_HALF_STEP))
        fail_msg("%s", what);
}

tc_renderer *suite_renderer(const char *poison)
{
    const tc_renderer_options options = backend_options(suite.name);
    tc_renderer *renderer;
    tc_error err = {0};
    if (poison)
        setenv("TETCAST_GL_POISON", poison, 1);
    expect_ok(tc_renderer_create(&renderer, &options, NULL, &err), &err, "another renderer");
    if (poison)
        unsetenv("TETCAST_GL_POISON");
    return renderer;
}

tc_image *suite_render_by(tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh, const tc_transfer *tf,
                          const tc_camera *camera, const tc_render_options *options)
{
    tc_image *image;
    tc_error err = {0};
    expect_ok(tc_render(&image, stats, renderer, mesh, tf, camera, options, NULL, &err), &err, "rendering");
    return image;
}

tc_image *suite_render(tc_render_stats *stats, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                       const tc_render_options *options)
{
    tc_render_stats own;
    if (!stats)
        stats = &own;
    tc_image *image = suite_render_by(stats, suite.renderer, mesh, tf, camera, options);
    assert_int_equal(stats->rays_lost, 0);
    assert_int_equal(image->width, options->width);
    assert_int_equal(image->height, options->height);
    expect_sane(image, tf, options);
    return image;
}

double suite_difference(const tc_image *a, const tc_image *b)
{
    tc_compare_result result;
    tc_error err = {0};
    expect_ok(tc_image_compare(&result, a, b, &err), &err, "comparing");
    return result.max_abs;
}

tc_verify_result suite_verify(const char *what, double bound, size_t n, const tc_image *image, const tc_mesh *mesh,
                              const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options)
{
    tc_verify_result v;
    tc_error err = {0};
    expect_ok(tc_verify(&v, image, n, 1, mesh, tf, camera, options, NULL, &err), &err, "verifying");
    suite_say("%s: %zu pixels, max error %.2e, mean %.1e, ill-posed %zu", what, v.pixels, v.max_abs_error,
              v.mean_abs_error, v.ill_posed);
    if (!(v.max_abs_error <= bound))
        fail_msg("%s: error %.3e at pixel %d, %d exceeds %.3e", what, v.max_abs_error, v.worst_x, v.worst_y, bound);
    if (v.ill_posed > 1 && (double)v.ill_posed > 1e-4 * (double)v.pixels)
        fail_msg("%s: %zu of %zu rays are ill-posed", what, v.ill_posed, v.pixels);
    assert_int_equal(v.rays_lost, -1); /* a picture does not tell; suite_render looked */
    return v;
}

void suite_check(const char *what, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                 const tc_render_options *options)
{
    tc_image *image = suite_render(NULL, mesh, tf, camera, options);
    suite_verify(what, SUITE_HALF_STEP, SIZE_MAX, image, mesh, tf, camera, options);
    tc_image_destroy(&image);
}
