/* bench_scene.c: mesh, function and view of the C benchmarks. */
#define _POSIX_C_SOURCE 200809L
#include "bench_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

void bench_check(tc_status status, const char *what, const tc_error *err)
{
    if (status == TC_OK)
        return;
    fprintf(stderr, "%s: %s\n", what, err->text);
    exit(1);
}

double bench_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

void bench_scene_open(bench_scene *out, const char *input, const char *field, tc_association association,
                      tc_reentry reentry, int threads)
{
    static const char prefix[] = "synth:";
    tc_error err = {0};
    tc_status status;
    memset(out, 0, sizeof *out);
    double start = bench_now_ms();
    if (strncmp(input, prefix, sizeof prefix - 1) == 0) {
        char name[64];
        const char *rest = input + sizeof prefix - 1, *colon = strchr(rest, ':');
        snprintf(name, sizeof name, "%.*s", (int)(colon ? colon - rest : (long)strlen(rest)), rest);
        status = tc_synth_create(&out->mesh, name, colon ? (size_t)strtoull(colon + 1, NULL, 10) : 0, 1, &err);
    } else {
        const tc_read_options read = {.field = field, .association = association};
        status = tc_mesh_read(&out->mesh, input, &read, NULL, &err);
    }
    bench_check(status, input, &err);
    out->ms_read = bench_now_ms() - start;
    start = bench_now_ms();
    const tc_prepare_options prepare = {.reentry = reentry, .threads = threads};
    bench_check(tc_mesh_prepare(out->mesh, &prepare, NULL, &err), input, &err);
    out->ms_prepare = bench_now_ms() - start;
    tc_mesh_get_report(&out->report, out->mesh);
}

void bench_scene_close(bench_scene *scene)
{
    tc_mesh_destroy(&scene->mesh);
}

tc_camera bench_camera(const bench_scene *scene, double azimuth, double elevation)
{
    static const double direction[3] = {0, 0, 1}, up[3] = {0, 1, 0};
    tc_camera camera = {.parallel = false};
    tc_camera_reset(&camera, scene->report.bounds, direction, up, 30, 1);
    tc_camera_azimuth(&camera, azimuth);
    tc_camera_elevation(&camera, elevation);
    return camera;
}

tc_transfer *bench_transfer(const bench_scene *scene, double most)
{
    char opacity[128];
    const double *range = scene->report.scalar_range;
    snprintf(opacity, sizeof opacity, "%.17g:0,%.17g:%g", range[0], range[1], most);
    const tc_transfer_options options = {.opacity = range[1] > range[0] ? opacity : NULL,
                                         .data_range = {range[0], range[1]}};
    tc_transfer *tf = NULL;
    tc_error err = {0};
    bench_check(tc_transfer_create(&tf, &options, &err), "the benchmark function", &err);
    return tf;
}

static int order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_median(double *value, size_t n)
{
    qsort(value, n, sizeof *value, order);
    return n % 2 ? value[n / 2] : 0.5 * (value[n / 2 - 1] + value[n / 2]);
}

void bench_set(json_t *object, const char *key, double value)
{
    if (value >= 0 && isfinite(value))
        json_object_set_new(object, key, json_real(value));
}

json_t *bench_mesh_json(const bench_scene *scene)
{
    const tc_mesh_report *r = &scene->report;
    json_t *mesh = json_object();
    json_object_set_new(mesh, "tets", json_integer((json_int_t)r->n_tet));
    json_object_set_new(mesh, "imaginary_tets", json_integer((json_int_t)r->n_imaginary));
    json_object_set_new(mesh, "points", json_integer((json_int_t)r->n_vertex));
    json_object_set_new(mesh, "convex", json_boolean(r->convex));
    json_object_set_new(mesh, "reentry", json_string(r->reentry == TC_REENTRY_PEEL ? "peel" : "convexify"));
    return mesh;
}

json_t *bench_time_json(const bench_scene *scene)
{
    const tc_mesh_report *r = &scene->report;
    json_t *time = json_object();
    bench_set(time, "read", scene->ms_read);
    bench_set(time, "prepare", scene->ms_prepare);
    bench_set(time, "check", r->ms_check);
    bench_set(time, "adjacency", r->ms_adjacency);
    bench_set(time, "order", r->ms_order);
    bench_set(time, "convexify", r->ms_convexify);
    return time;
}
