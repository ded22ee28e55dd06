/* test_gpu_effects.c: the table of effects, and what it does to programs: nothing that a scene does not call for. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/effect.h"
#include "gpu/program.h"

#include "tests/common/gl_program.h"

#include <stdlib.h>
#include <string.h>

static tc_mesh *make_mesh(void)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    const tc_prepare_options options = {.reentry = TC_REENTRY_PEEL};
    assert_int_equal(tc_synth_create(&mesh, "kuhn", 200, 0, &err), TC_OK);
    assert_int_equal(tc_mesh_prepare(mesh, &options, NULL, &err), TC_OK);
    return mesh;
}

/* Looks that turn one row on each, by its name. */
typedef struct looks {
    tc_mesh *mesh;
    tc_transfer *tf, *clear; /* clear: transparent over the whole range */
    tc_field *field;
    tc_iso iso;
    tc_plane plane;
    tc_select select;
    double range[1][2];
    double corner[9];
    int32_t triangle[3];
    tc_geometry geometry;
} looks;

static void looks_begin(looks *l)
{
    memset(l, 0, sizeof *l);
    l->mesh = make_mesh();
    double lo = l->mesh->report.scalar_range[0], hi = l->mesh->report.scalar_range[1];
    const tc_knot knots[2] = {{lo, 1, 0, 0, 0.1}, {hi, 0, 1, 0, 1}};
    const tc_knot empty[3] = {{lo, 1, 0, 0, 0}, {hi, 1, 0, 0, 0}, {2 * hi - lo, 0, 1, 0, 1}};
    tc_error err = {0};
    assert_int_equal(tc_transfer_from_knots(&l->tf, knots, 2, &err), TC_OK);
    assert_int_equal(tc_transfer_from_knots(&l->clear, empty, 3, &err), TC_OK);
    size_t n = l->mesh->n_vertex_source ? l->mesh->n_vertex_source : l->mesh->n_vertex;
    double *value = calloc(n, sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < n; i++)
        value[i] = (double)i;
    if (tc_field_create(&l->field, l->mesh, value, TC_POINT_DATA, "second", &err) != TC_OK)
        fail_msg("%s", err.text);
    free(value);
    l->iso = (tc_iso){.value = 0.5 * (lo + hi), .opacity = 0.5};
    l->plane = (tc_plane){{1, 0, 0}, 0.5 * (l->mesh->report.bounds[0] + l->mesh->report.bounds[1])};
    l->range[0][0] = 0.5 * (lo + hi);
    l->range[0][1] = hi;
    l->select = (tc_select){.n_range = 1, .range = (const double(*)[2])l->range};
    l->corner[3] = l->corner[7] = 1;
    l->triangle[1] = 1;
    l->triangle[2] = 2;
    l->geometry = (tc_geometry){
        .n_vertex = 3, .n_triangle = 1, .vertex = l->corner, .triangle = l->triangle, .opacity = 1, .width = 1};
}

static void looks_end(looks *l)
{
    tc_field_destroy(&l->field);
    tc_transfer_destroy(&l->tf);
    tc_transfer_destroy(&l->clear);
    tc_mesh_destroy(&l->mesh);
}

/* The look that turns on this row; false where the test does not know the row: then it is to be added here. */
static bool look_of(tc_look *look, const tc_transfer **tf, const char *name, const looks *l)
{
    static const char *const models[] = {"density-emitter", "emission", "absorption", "maximum", "surfaces", "xray",
                                         "minimum",         "average",  "depth"};
    memset(look, 0, sizeof *look);
    *tf = l->tf;
    for (int i = 0; i < 9; i++)
        if (strcmp(name, models[i]) == 0) {
            look->model = (tc_model)i;
            look->n_iso = look->model == TC_MODEL_SURFACES;
            look->iso = &l->iso;
            return true;
        }
    if (strcmp(name, "isosurfaces") == 0) {
        look->n_iso = 1;
        look->iso = &l->iso;
    } else if (strcmp(name, "clip") == 0) {
        look->n_plane = 1;
        look->plane = &l->plane;
    } else if (strcmp(name, "color-field") == 0) {
        look->color_field = l->field;
        look->color_function = l->tf;
    } else if (strcmp(name, "select") == 0) {
        look->n_select = 1;
        look->select = &l->select;
    } else if (strncmp(name, "shade", 5) == 0 || strncmp(name, "light", 5) == 0 || strncmp(name, "gradient", 8) == 0) {
        tc_shade_defaults(&look->shade);
        look->shade.gradient = strstr(name, "vert") ? TC_GRADIENT_VERTEX : TC_GRADIENT_CELL;
        look->shade.surfaces = strstr(name, "iso") || strstr(name, "surf");
        look->shade.volume = !look->shade.surfaces;
        look->n_iso = look->shade.surfaces;
        look->iso = &l->iso;
    } else if (strncmp(name, "geometry", 8) == 0) {
        look->model = strstr(name, "before") ? TC_MODEL_MAXIMUM : TC_MODEL_DENSITY_EMITTER;
        look->n_geometry = 1;
        look->geometry = &l->geometry;
    } else if (strcmp(name, "empty-space") == 0) {
        *tf = l->clear;
    } else {
        return false;
    }
    return true;
}

static void choose(tc_effects *out, const tc_look *look, const tc_transfer *tf, const looks *l)
{
    tc_render_options options = {.look = look};
    tc_error err = {0};
    const tc_effect_scene scene = {.mesh = l->mesh,
                                   .transfer = tf,
                                   .options = &options,
                                   .look = look,
                                   .scale = 1,
                                   .scalar = {l->mesh->report.scalar_range[0], l->mesh->report.scalar_range[1]},
                                   .length_unit = 1,
                                   .threads = 1};
    if (tc_effects_choose(out, NULL, &scene, &err) != TC_OK)
        fail_msg("%s", err.text);
}

static char *march_text(const tc_effects *effects)
{
    char alias[128], *text;
    tc_error err = {0};
    snprintf(alias, sizeof alias, "integrator.glsl=%s",
             effects && effects->integrator ? effects->integrator : "integrate_exact.glsl");
    if (tc_program_text(&text, "march.frag", effects ? effects->defines : "", alias, effects ? effects->shaders : NULL,
                        &err) != TC_OK)
        fail_msg("%s", err.text);
    return text;
}

/* The shader files of which a text holds something, by the numbers of its #line directives: bits of the list's places.
 */
static uint64_t files_in(const char *text, int first[1])
{
    uint64_t set = 0;
    *first = -1;
    for (int i = 0; tc_shader_files[i].name; i++)
        if (*first < 0 && strncmp(tc_shader_files[i].name, "effects/", 8) == 0)
            *first = i;
    for (const char *p = text; (p = strstr(p, "#line ")); p++) {
        long n = strtol(p + 6, NULL, 10) / 10000;
        if (n >= *first && n - *first < 64)
            set |= (uint64_t)1 << (n - *first);
    }
    return set;
}

static void a_plain_scene_holds_text_of_an_effect(void **state)
{
    (void)state;
    looks l;
    looks_begin(&l);
    tc_effects effects;
    const tc_look plain = {0};
    int first;
    choose(&effects, &plain, l.tf, &l);
    assert_int_equal(effects.n, 1);
    assert_string_equal(effects.row[0]->name, "density-emitter");
    assert_string_equal(effects.shaders, "");
    assert_string_equal(effects.defines, "");
    assert_int_equal(effects.needs, 0);
    assert_null(effects.integrator);
    char *with = march_text(&effects), *without = march_text(NULL);
    assert_string_equal(with, without);
    assert_true(files_in(with, &first) == 0);
    assert_null(strstr(with, "//@"));
    free(with);
    free(without);
    looks_end(&l);
}

static bool is_named(const char *name, const tc_effects *effects)
{
    return strstr(effects->shaders, name) || (effects->integrator && strcmp(effects->integrator, name) == 0);
}

/* Does a file that the effects in force name include it? */
static bool is_included(const char *name, const tc_effects *effects, int first)
{
    char line[96];
    snprintf(line, sizeof line, "#include \"%s\"", name);
    for (int f = first; tc_shader_files[f].name; f++)
        if (is_named(tc_shader_files[f].name, effects) && strstr(tc_shader_files[f].text, line))
            return true;
    return false;
}

/* Each row alone: it is in force, its files are in the program, and nobody else's. */
static void an_effect_brings_another_one_along(void **state)
{
    (void)state;
    looks l;
    looks_begin(&l);
    for (int i = 0; tc_effect_table[i]; i++) {
        const tc_effect *row = tc_effect_table[i];
        tc_look look;
        const tc_transfer *tf;
        tc_effects effects;
        if (!look_of(&look, &tf, row->name, &l))
            fail_msg("%s: this test knows no look that turns it on; add one to look_of", row->name);
        assert_true(row->what && *row->what && row->wanted);
        choose(&effects, &look, tf, &l);
        bool on = false;
        for (int k = 0; k < effects.n; k++) {
            on = on || effects.row[k] == row;
            assert_true(*effects.why[k]);
        }
        if (!on)
            fail_msg("%s is not in force where it is asked for", row->name);
        int first;
        char *text = march_text(&effects);
        uint64_t there = files_in(text, &first);
        for (int f = first; tc_shader_files[f].name; f++) {
            const char *name = tc_shader_files[f].name;
            bool named = is_named(name, &effects);
            if ((there >> (f - first) & 1) && !named && !is_included(name, &effects, first))
                fail_msg("%s brings %s along", row->name, name);
        }
        free(text);
    }
    looks_end(&l);
}

static void a_name_is_given_twice(void **state)
{
    (void)state;
    for (int i = 0; tc_effect_table[i]; i++)
        for (int k = 0; k < i; k++)
            assert_string_not_equal(tc_effect_table[i]->name, tc_effect_table[k]->name);
}

static void effects_that_exclude_each_other_are_taken(void **state)
{
    (void)state;
    looks l;
    looks_begin(&l);
    tc_look look;
    const tc_transfer *tf;
    tc_render_options options = {0};
    look_of(&look, &tf, "color-field", &l);
    look.model = TC_MODEL_MAXIMUM;
    tc_effect_scene scene = {.mesh = l.mesh, .transfer = tf, .options = &options, .look = &look};
    tc_effects effects;
    tc_error err = {0};
    bool there = false;
    for (int i = 0; tc_effect_table[i]; i++)
        there = there || strcmp(tc_effect_table[i]->name, "maximum") == 0;
    if (there) {
        assert_int_equal(tc_effects_choose(&effects, NULL, &scene, &err), TC_E_ARG);
        assert_non_null(strstr(err.text, "maximum"));
        assert_non_null(strstr(err.text, "color-field"));
    }
    look_of(&look, &tf, "isosurfaces", &l);
    options.integrator = TC_INTEGRATOR_TABLE;
    assert_int_equal(tc_effects_choose(&effects, NULL, &scene, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "exact"));
    looks_end(&l);
}

static void sections_are_put_elsewhere(void **state)
{
    (void)state;
    char *text;
    tc_error err = {0};
    const char *alias = "integrator.glsl=integrate_exact.glsl";
    assert_int_equal(tc_program_text(&text, "march.frag", "#define CLIP_PLANES 1\n", alias, "effects/clip.glsl", &err),
                     TC_OK);
    const char *ray = strstr(text, "    Ray ray = ray_of_pixel(pixel);\n"),
               *clip = strstr(text, "    clip_ray(ray);\n");
    assert_true(ray && clip && clip > ray && clip < strstr(ray, "Walk w;"));
    assert_null(strstr(text, "//@"));
    free(text);
    assert_int_equal(tc_program_text(&text, "march.frag", "", alias, "effects/absent.glsl", &err), TC_E_GL);
    assert_non_null(strstr(err.text, "effects/absent.glsl"));
    /* lines give way to a section */
    assert_int_equal(tc_program_text(&text, "march.frag", "", alias, "effects/parts.glsl", &err), TC_OK);
    assert_null(strstr(text, "                march_step(w, ray, integral);\n                k++;\n"));
    assert_non_null(strstr(text, "                parts_next(integral, ray);\n"));
    free(text);
    assert_int_equal(tc_program_text(&text, "march.frag", "", alias, "effects/parts.glsl effects/parts.glsl", &err),
                     TC_E_GL);
    assert_non_null(strstr(err.text, "march_"));
}

static void an_error_in_a_section_is_said_to_be_elsewhere(void **state)
{
    (void)state;
    bool any = false;
    for (int c = 0; c < GL_CONTEXTS; c++) {
        tc_context *context;
        if (tc_context_create(&context, gl_context_names[c], NULL, NULL) != TC_OK)
            continue;
        any = true;
        tc_program_cache *cache;
        assert_int_equal(tc_program_cache_create(&cache, &context->gl, NULL), TC_OK);
        const tc_program_source source = {"screen.vert", "march.frag", "#define clip_ray 3 3\n#define CLIP_PLANES 1\n",
                                          "integrator.glsl=integrate_exact.glsl", "effects/clip.glsl"};
        GLuint program;
        tc_error err = {0};
        assert_int_equal(tc_program_get(&program, cache, &source, &err), TC_E_GL);
        int line = 1;
        for (int i = 0; tc_shader_files[i].name; i++)
            if (strcmp(tc_shader_files[i].name, "effects/clip.glsl") == 0)
                for (const char *p = tc_shader_files[i].text; p < strstr(tc_shader_files[i].text, "void clip_ray"); p++)
                    line += *p == '\n';
        char expected[64];
        snprintf(expected, sizeof expected, "effects/clip.glsl:%d", line);
        if (!strstr(err.text, expected))
            fail_msg("no %s in: %s", expected, err.text);
        tc_program_cache_destroy(&cache);
        tc_context_destroy(&context);
    }
    if (!any)
        skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_scene_holds_text_of_an_effect),
        cmocka_unit_test(an_effect_brings_another_one_along),
        cmocka_unit_test(a_name_is_given_twice),
        cmocka_unit_test(effects_that_exclude_each_other_are_taken),
        cmocka_unit_test(sections_are_put_elsewhere),
        cmocka_unit_test(an_error_in_a_section_is_said_to_be_elsewhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
