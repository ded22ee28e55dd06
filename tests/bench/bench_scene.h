/* bench_scene.h: the scene that the C benchmarks measure: a mesh, the benchmark function and ResetCamera's view. */
#ifndef TC_BENCH_SCENE_H
#define TC_BENCH_SCENE_H

#include "tetcast.h"

#include <jansson.h>

typedef struct bench_scene {
    tc_mesh *mesh;
    tc_mesh_report report;
    double ms_read, ms_prepare; /* wall; ms_read of a synthetic mesh: making it */
} bench_scene;

/* Ends the program where status is not TC_OK, with what it was about and err's sentence. */
void bench_check(tc_status status, const char *what, const tc_error *err);

/* Opens and prepares FILE or synth:NAME[:CELLS]; ends the program on an error. field NULL: the first array. */
void bench_scene_open(bench_scene *out, const char *input, const char *field, tc_association association,
                      tc_reentry reentry, int threads);
void bench_scene_close(bench_scene *scene);

/* The whole mesh in view from +z in a square picture, turned by degrees. */
tc_camera bench_camera(const bench_scene *scene, double azimuth, double elevation);

/* The benchmark function: Cool to Warm over the field's range, opacity linear from 0 to `most` (0.3). */
tc_transfer *bench_transfer(const bench_scene *scene, double most);

/* Middle value; sorts value [n], n > 0. */
double bench_median(double *value, size_t n);

/* Of the mesh and of its set-up, in interface.md's words: "mesh", "time_ms". New references. */
json_t *bench_mesh_json(const bench_scene *scene);
json_t *bench_time_json(const bench_scene *scene);

/* Sets key unless value is negative or NaN: not measured. */
void bench_set(json_t *object, const char *key, double value);

double bench_now_ms(void);

#endif
