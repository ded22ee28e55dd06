/* test_suite_look_absence.c: a scene pays for what another one called for: code, bytes, passes, or a picture that
 * differs. */
#include "look.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 64,
    HEIGHT = 56,
    SIDE = 4,
    POINTS = (SIDE + 1) * (SIDE + 1) * (SIDE + 1),
    TETS = 6 * SIDE * SIDE * SIDE
};

static double slope(const double *x)
{
    return x[0] + 0.4 * x[1] * x[2];
}

static const tc_knot knots[3] = {{0, 0, 0, 1, 0.1}, {0.6, 1, 1, 0, 0.5}, {1.4, 1, 0, 0, 1}};
static const tc_iso iso[1] = {{.value = 0.5, .opacity = 0.5}};
static const tc_plane plane[1] = {{{1, 0, 0}, 0.3}};
static const double ranges[1][2] = {{0, 0.6}};
static const tc_select selected[1] = {{.n_range = 1, .range = ranges}};
static const double corners[9] = {0.2, 0.2, 0.5, 0.9, 0.2, 0.5, 0.2, 0.9, 0.5};
static const int32_t triangle[3] = {0, 1, 2}, line[2] = {0, 1};
static const tc_geometry geometry[1] = {{.n_vertex = 3,
                                         .n_triangle = 1,
                                         .n_line = 1,
                                         .vertex = corners,
                                         .triangle = triangle,
                                         .line = line,
                                         .color = {1, 0, 0},
                                         .opacity = 0.5,
                                         .width = 2}};

typedef struct picture {
    tc_image *image;
    tc_render_stats stats;
    tc_explanation explanation;
} picture;

static void make(picture *out, tc_renderer *renderer, const tc_mesh *mesh, const tc_transfer *tf, const tc_look *look)
{
    tc_camera camera = suite_camera(mesh, 0.4, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_error err = {0};
    options.look = look;
    out->image = suite_render_by(&out->stats, renderer, mesh, tf, &camera, &options);
    if (tc_render_explain(&out->explanation, renderer, &err) != TC_OK)
        fail_msg("%s", err.text);
}

static bool same_sizes(const tc_explained_size *a, int n_a, const tc_explained_size *b, int n_b)
{
    bool same = n_a == n_b;
    for (int i = 0; i < n_a && same; i++)
        same = strcmp(a[i].name, b[i].name) == 0 && a[i].bytes == b[i].bytes;
    return same;
}

static void expect_as_plain(const char *after, const picture *plain, const picture *now)
{
    const tc_explanation *a = &plain->explanation, *b = &now->explanation;
    if (!same_sizes(a->program, a->n_program, b->program, b->n_program))
        fail_msg("after %s a plain scene has other programs", after);
    if (!same_sizes(a->texture, a->n_texture, b->texture, b->n_texture))
        fail_msg("after %s a plain scene has other textures", after);
    if (now->stats.passes != plain->stats.passes || now->stats.z_updates != plain->stats.z_updates ||
        now->stats.layers != plain->stats.layers)
        fail_msg("after %s a plain scene has other passes", after);
    if (now->stats.gpu_bytes_other != plain->stats.gpu_bytes_other ||
        now->stats.gpu_bytes_table != plain->stats.gpu_bytes_table ||
        now->stats.gpu_bytes_mesh != plain->stats.gpu_bytes_mesh)
        fail_msg("after %s a plain scene holds other bytes", after);
    assert_string_equal(now->stats.effects, "density-emitter");
    if (suite_difference(plain->image, now->image) != 0)
        fail_msg("after %s a plain scene looks otherwise", after);
}

/* Each look, between plain pictures by one renderer; and each look as by a renderer of its own. */
static void a_scene_pays_for_another(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        return;
    tc_mesh *mesh = look_box(SIDE, slope, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, 3);
    tc_field *field = NULL;
    double value[POINTS], of_cell[TETS];
    for (int i = 0; i < POINTS; i++)
        value[i] = i % 7;
    for (int i = 0; i < TETS; i++)
        of_cell[i] = i % 5;
    tc_field *cells = NULL;
    tc_error err = {0};
    if (tc_field_create(&field, mesh, value, TC_POINT_DATA, "points", &err) != TC_OK ||
        tc_field_create(&cells, mesh, of_cell, TC_CELL_DATA, "cells", &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_shade shade[3];
    for (int i = 0; i < 3; i++) {
        tc_shade_defaults(&shade[i]);
        shade[i].gradient = i == 1 ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX;
    }
    const struct {
        const char *name, *row;
        tc_look look;
    } looks[] = {
        {"emission", "emission", {.model = TC_MODEL_EMISSION}},
        {"absorption", "absorption", {.model = TC_MODEL_ABSORPTION}},
        {"x-ray", "xray", {.model = TC_MODEL_XRAY}},
        {"the largest scalar", "maximum", {.model = TC_MODEL_MAXIMUM}},
        {"the least scalar", "minimum", {.model = TC_MODEL_MINIMUM}},
        {"the mean scalar", "average", {.model = TC_MODEL_AVERAGE}},
        {"depth", "depth", {.model = TC_MODEL_DEPTH}},
        {"depth among surfaces",
         "depth",
         {.model = TC_MODEL_DEPTH, .n_iso = 1, .iso = iso, .n_geometry = 1, .geometry = geometry}},
        {"isosurfaces alone", "surfaces", {.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = iso}},
        {"an isosurface", "isosurfaces", {.n_iso = 1, .iso = iso}},
        {"light, by vertices", "shade", {.shade = shade[0]}},
        {"light, by cells", "shade", {.shade = shade[1]}},
        {"a lit isosurface", "shade-isosurfaces", {.shade = shade[2], .n_iso = 1, .iso = iso}},
        {"a second field", "color-field", {.color_field = field, .color_function = tf}},
        {"a second field of cells", "color-field", {.color_field = cells, .color_function = tf}},
        {"a plane", "clip", {.n_plane = 1, .plane = plane}},
        {"a selection", "select", {.n_select = 1, .select = selected}},
        {"geometry", "geometry", {.n_geometry = 1, .geometry = geometry}},
    };
    tc_renderer *renderer = suite_renderer(NULL);
    picture *plain = calloc(3, sizeof *plain), *now = plain + 1, *alone = plain + 2;
    assert_non_null(plain);
    make(plain, renderer, mesh, tf, NULL);
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        make(now, renderer, mesh, tf, &looks[i].look);
        if (!strstr(now->stats.effects, looks[i].row))
            fail_msg("%s: in force are %s", looks[i].name, now->stats.effects);
        tc_renderer *own = suite_renderer(NULL);
        make(alone, own, mesh, tf, &looks[i].look);
        if (suite_difference(now->image, alone->image) != 0)
            fail_msg("%s looks otherwise after other pictures", looks[i].name);
        tc_image_destroy(&now->image);
        tc_image_destroy(&alone->image);
        tc_renderer_destroy(&own);
        make(now, renderer, mesh, tf, NULL);
        expect_as_plain(looks[i].name, plain, now);
        tc_image_destroy(&now->image);
    }
    tc_image_destroy(&plain->image);
    free(plain);
    tc_renderer_destroy(&renderer);
    tc_field_destroy(&field);
    tc_field_destroy(&cells);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_scene_pays_for_another)};
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
