/* client.c: a program of someone else: one tet rendered by the reference driver through tetcast.h alone. */
#include <stdio.h>
#include <tetcast.h>

int main(void)
{
    static const double vertex[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, scalar[4] = {0, 1, 2, 3};
    static const double from[3] = {0, 0, 1}, up[3] = {0, 1, 0};
    static const int32_t tet[4] = {0, 1, 2, 3};
    static const tc_knot knot[2] = {{0, 0, 0, 1, 5}, {3, 1, 0, 0, 5}};
    tc_mesh_arrays arrays = {4, vertex, 1, tet, scalar, TC_POINT_DATA, "heat"};
    tc_prepare_options prepare = {.reentry = TC_REENTRY_AUTO, .threads = 1};
    tc_renderer_options where = {.driver = "reference", .threads = 1};
    tc_render_options how;
    tc_render_stats stats;
    tc_mesh_report report;
    tc_camera camera;
    tc_mesh *mesh = NULL;
    tc_transfer *tf = NULL;
    tc_renderer *renderer = NULL;
    tc_image *image = NULL;
    tc_error err = {0};
    tc_render_defaults(&how);
    how.width = how.height = 16;
    how.unit_distance = 1;
    if (tc_mesh_create(&mesh, &arrays, &err) || tc_mesh_prepare(mesh, &prepare, NULL, &err) ||
        tc_transfer_from_knots(&tf, knot, 2, &err) || tc_renderer_create(&renderer, &where, NULL, &err)) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    tc_mesh_get_report(&report, mesh);
    tc_camera_reset(&camera, report.bounds, from, up, 30, 1);
    tc_status status = tc_render(&image, &stats, renderer, mesh, tf, &camera, &how, NULL, &err);
    double covered = 0;
    for (int i = 0; !status && i < 16 * 16; i++)
        covered += image->rgba[4 * i + 3] > 0;
    tc_image_destroy(&image);
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    if (status || covered < 10) {
        fprintf(stderr, "%s (%g pixels covered)\n", err.text, covered);
        return 1;
    }
    return 0;
}
