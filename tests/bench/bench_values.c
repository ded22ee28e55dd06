/* bench_values: new values on a mesh that is set up (tc_mesh_set_scalar, packing, upload) against setting it up
 * (tc_mesh_prepare, packing, upload), of points and of cells, in medians that are taken in turn.
 * Usage: bench_values [--json] [TETS [RUNS]]; default 1000000 tets, 5 runs. A picture of 8 x 8 pixels makes the
 * renderer pack and upload; its own time is not counted. */
#define _POSIX_C_SOURCE 200809L
#include "tetcast.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RUNS_MOST = 99 };

typedef struct times {
    double set_up[RUNS_MOST], points[RUNS_MOST], cells[RUNS_MOST];
} times;

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void must(tc_status status, const tc_error *err)
{
    if (status == TC_OK)
        return;
    fprintf(stderr, "bench_values: %s\n", err->text);
    exit(1);
}

/* What packing and upload of the picture's mesh took. */
static double picture(tc_renderer *renderer, const tc_mesh *mesh, const tc_transfer *tf)
{
    static const double from[3] = {0, 0, 1}, up[3] = {0, 1, 0};
    tc_mesh_report report;
    tc_render_options options;
    tc_render_stats stats;
    tc_camera camera = {0};
    tc_image *image = NULL;
    tc_error err = {0};
    tc_mesh_get_report(&report, mesh);
    tc_camera_reset(&camera, report.bounds, from, up, 30, 1);
    tc_render_defaults(&options);
    options.width = options.height = 8;
    options.integrator = TC_INTEGRATOR_INTEGRAL; /* so that the function is uploaded once */
    options.integral_order = 2;
    must(tc_render(&image, &stats, renderer, mesh, tf, &camera, &options, NULL, &err), &err);
    tc_image_destroy(&image);
    return stats.ms_pack + stats.ms_upload;
}

/* A wave through the lattice of points, cells in the same order; another one for each run. */
static double wave(size_t i, size_t n, int run)
{
    size_t side = (size_t)lround(cbrt((double)n));
    double x = (double)(i % side) / (double)side, y = (double)(i / side % side) / (double)side;
    double z = (double)(i / side / side) / (double)side;
    return 0.5 + 0.5 * sin(6 * x + y + run) * cos(5 * z + 2 * y);
}

static double update(tc_renderer *renderer, tc_mesh *mesh, const tc_transfer *tf, double *value, size_t n,
                     tc_association association, int run)
{
    tc_error err = {0};
    for (size_t i = 0; i < n; i++)
        value[i] = wave(i, n, run);
    value[0] = 0, value[n - 1] = 1; /* one range, so that the function stays */
    double start = now_ms();
    must(tc_mesh_set_scalar(mesh, value, association, &err), &err);
    double set = now_ms() - start;
    return set + picture(renderer, mesh, tf);
}

static int order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *value, int n)
{
    qsort(value, (size_t)n, sizeof *value, order);
    return n % 2 ? value[n / 2] : 0.5 * (value[n / 2 - 1] + value[n / 2]);
}

int main(int argc, char **argv)
{
    bool json = argc > 1 && strcmp(argv[1], "--json") == 0;
    int first = json ? 2 : 1, runs = argc > first + 1 ? atoi(argv[first + 1]) : 5;
    size_t n = argc > first ? (size_t)strtoull(argv[first], NULL, 10) : 1000000;
    static const tc_knot knot[] = {{0, 0.2, 0.3, 0.8, 0}, {1, 0.7, 0.1, 0.2, 0.3}};
    static times t;
    tc_error err = {0};
    tc_renderer *renderer = NULL;
    tc_transfer *tf = NULL;
    tc_mesh_report report = {0};
    if (n < 1 || runs < 1 || runs > RUNS_MOST) {
        fprintf(stderr, "usage: bench_values [--json] [TETS [RUNS]], 1 to %d runs\n", RUNS_MOST);
        return 2;
    }
    must(tc_renderer_create(&renderer, NULL, NULL, &err), &err);
    must(tc_transfer_from_knots(&tf, knot, 2, &err), &err);
    for (int run = 0; run < runs; run++) {
        tc_mesh *mesh = NULL;
        must(tc_synth_create(&mesh, "kuhn", n, 1, &err), &err);
        tc_mesh_get_report(&report, mesh); /* before it is prepared: lengths of the arrays it was made from */
        double *value = malloc((report.n_vertex + report.n_tet) * sizeof *value);
        if (!value)
            return 1;
        double start = now_ms();
        must(tc_mesh_prepare(mesh, NULL, NULL, &err), &err);
        t.set_up[run] = now_ms() - start;
        t.set_up[run] += picture(renderer, mesh, tf);
        update(renderer, mesh, tf, value, report.n_vertex, TC_POINT_DATA, 1); /* the function for this range */
        t.points[run] = update(renderer, mesh, tf, value, report.n_vertex, TC_POINT_DATA, 2 + run);
        update(renderer, mesh, tf, value, report.n_tet, TC_CELL_DATA, 1);
        t.cells[run] = update(renderer, mesh, tf, value, report.n_tet, TC_CELL_DATA, 2 + run);
        free(value);
        tc_mesh_destroy(&mesh);
    }
    double set_up = median(t.set_up, runs), points = median(t.points, runs), cells = median(t.cells, runs);
    if (json)
        printf(
            "{\"tets\": %zu, \"runs\": %d, \"ms_set_up\": %.3f, \"ms_point_values\": %.3f, \"ms_cell_values\": %.3f, "
            "\"ratio_point_values\": %.5f, \"ratio_cell_values\": %.5f}\n",
            report.n_tet, runs, set_up, points, cells, points / set_up, cells / set_up);
    else
        printf(
            "%zu tets, medians of %d, milliseconds\n%-34s %9.2f\n%-34s %9.2f  %5.2f %% of it\n%-34s %9.2f  %5.2f %% of "
            "it\n",
            report.n_tet, runs, "set-up: prepare, pack, upload", set_up, "new values of points", points,
            100 * points / set_up, "new values of cells", cells, 100 * cells / set_up);
    tc_transfer_destroy(&tf);
    tc_renderer_destroy(&renderer);
    return 0;
}
