/* test_scene_look.c: what tc_look_wrong lets pass and what not, and which looks ask for nothing. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/field.h"
#include "scene/look.h"
#include "mesh_shapes.h"

/* A look with everything that goes together, and what it points to, for a test to spoil. */
typedef struct sample {
    tc_mesh *mesh, *cells; /* the same cells with point data, and with cell data */
    tc_field *field, *foreign;
    tc_look look;
    tc_iso iso[65];
    tc_light light[17];
    tc_plane plane[2];
    double range[2][2];
    tc_select select[2];
    tc_geometry geometry[1];
    double vertex[9];
    int32_t triangle[3];
} sample;

static const tc_transfer *const some_function = (const tc_transfer *)&some_function; /* it is only there or not */

static tc_mesh *make_mesh(tc_association association)
{
    static const int size[3] = {2, 1, 1};
    static const double value[64] = {1, 2, 3};
    shape s = {0};
    shape_grid(&s, size, NULL);
    tc_mesh *mesh = shape_mesh(&s, value, association);
    shape_prepare(mesh, TC_REENTRY_PEEL);
    shape_finish(&s);
    return mesh;
}

static int set_up(void **state)
{
    static sample s;
    static const double value[64] = {0, 1};
    s.mesh = make_mesh(TC_POINT_DATA);
    s.cells = make_mesh(TC_CELL_DATA);
    assert_int_equal(tc_field_create(&s.field, s.mesh, value, TC_CELL_DATA, "part", NULL), TC_OK);
    assert_int_equal(tc_field_create(&s.foreign, s.cells, value, TC_CELL_DATA, "alien", NULL), TC_OK);
    *state = &s;
    return 0;
}

static int tear_down(void **state)
{
    sample *s = *state;
    tc_field_destroy(&s->field);
    tc_field_destroy(&s->foreign);
    tc_mesh_destroy(&s->mesh);
    tc_mesh_destroy(&s->cells);
    return 0;
}

static void reset(sample *s)
{
    for (int i = 0; i < 65; i++)
        s->iso[i] = (tc_iso){.value = 1 + 0.01 * i, .opacity = 0.5, .has_color = i % 2 == 0, .color = {0, 0.5, 1}};
    for (int i = 0; i < 17; i++)
        s->light[i] = (tc_light){.head = i == 0, .direction = {0, 0, i}, .color = {1, 2, 0}};
    s->plane[0] = (tc_plane){{1, 0, 0}, -5};
    s->plane[1] = (tc_plane){{0, 1e-140, 0}, 0};
    s->range[0][0] = 2, s->range[0][1] = 2;
    s->range[1][0] = -INFINITY, s->range[1][1] = 0;
    s->select[0] = (tc_select){NULL, 2, (const double(*)[2])s->range};
    s->select[1] = (tc_select){s->field, 1, (const double(*)[2])s->range};
    memcpy(s->vertex, (const double[9]){0, 0, 0, 1, 0, 0, 0, 1, 0}, sizeof s->vertex);
    memcpy(s->triangle, (const int32_t[3]){0, 1, 2}, sizeof s->triangle);
    s->geometry[0] = (tc_geometry){.n_vertex = 3,
                                   .n_triangle = 1,
                                   .vertex = s->vertex,
                                   .triangle = s->triangle,
                                   .opacity = 1,
                                   .width = 1,
                                   .lit = true};
    s->look = (tc_look){.n_iso = 2,
                        .iso = s->iso,
                        .color_field = s->field,
                        .color_function = some_function,
                        .n_plane = 2,
                        .plane = s->plane,
                        .has_box = true,
                        .box = {0, 1, 2, 2, -1, 3},
                        .n_select = 2,
                        .select = s->select,
                        .n_geometry = 1,
                        .geometry = s->geometry};
    tc_shade_defaults(&s->look.shade);
    s->look.shade.gradient = TC_GRADIENT_VERTEX;
    s->look.shade.n_light = 2;
    s->look.shade.light = s->light;
}

static void passes(const tc_look *look, const tc_mesh *mesh)
{
    char why[512] = "";
    if (tc_look_wrong(why, sizeof why, look, mesh))
        fail_msg("%s", why);
    assert_string_equal(why, "");
}

/* Refused, and the sentence holds both words. */
static void fails(const tc_look *look, const tc_mesh *mesh, const char *word, const char *other)
{
    char why[512] = "";
    const char *answer = tc_look_wrong(why, sizeof why, look, mesh);
    if (!answer)
        fail_msg("passed, but '%s' was to be told", word);
    assert_ptr_equal(answer, why);
    if (!strstr(why, word) || !strstr(why, other))
        fail_msg("'%s' does not hold '%s' and '%s'", why, word, other);
    char brief[8];
    assert_non_null(tc_look_wrong(brief, sizeof brief, look, mesh)); /* and ends in time */
    assert_true(strlen(brief) == 7);
}

static void a_good_look_is_refused(void **state)
{
    sample *s = *state;
    reset(s);
    passes(&s->look, s->mesh);
    passes(NULL, s->mesh);
    passes(&(tc_look){0}, s->mesh);
    passes(&(tc_look){0}, s->cells);
    s->look.n_iso = 64;
    passes(&s->look, s->mesh);
    s->look.shade.n_light = 16;
    passes(&s->look, s->mesh);
    s->look.model = TC_MODEL_SURFACES;
    passes(&s->look, s->mesh);
    s->look.n_iso = 0; /* the geometry is left */
    passes(&s->look, s->mesh);
    for (int model = 0; model <= TC_MODEL_DEPTH; model++) {
        tc_look look = {.model = (tc_model)model, .n_geometry = 1, .geometry = s->geometry};
        tc_shade_defaults(&look.shade); /* light, for the geometry alone */
        passes(&look, s->mesh);
        passes(&look, s->cells);
    }
    for (int i = 0; i < 2; i++) { /* of both matter absorbs */
        reset(s);
        s->look.model = i == 0 ? TC_MODEL_ABSORPTION : TC_MODEL_XRAY;
        s->look.color_field = NULL, s->look.color_function = NULL;
        s->look.shade.volume = false;
        passes(&s->look, s->mesh);
    }
}

#define REFUSED(change, word, other)                                                                                   \
    do {                                                                                                               \
        reset(s);                                                                                                      \
        change;                                                                                                        \
        fails(&s->look, s->mesh, word, other);                                                                         \
    } while (0)

static void numbers_out_of_their_range_pass(void **state)
{
    sample *s = *state;
    REFUSED(s->look.model = (tc_model)9, "model 9", "0 to 8");
    REFUSED(s->look.model = (tc_model)-1, "model -1", "0 to 8");
    REFUSED(s->look.n_iso = -1, "-1 isosurfaces", "0 or more");
    REFUSED(s->look.iso = NULL, "2 isosurfaces", "NULL");
    REFUSED(s->look.n_iso = 65, "65 isosurfaces", "64");
    REFUSED(s->iso[1].value = NAN, "isosurface 2", "finite");
    REFUSED(s->iso[1].opacity = 1.5, "opacity 1.5", "0 to 1");
    REFUSED(s->iso[1].opacity = NAN, "opacity", "0 to 1");
    REFUSED(s->iso[0].color[1] = -0.5, "colour 0 -0.5 1", "0 to 1");
    REFUSED(s->iso[1].value = 1, "value 1;", "two");
    REFUSED(s->look.shade.gradient = (tc_gradient)3, "gradient 3", "there are");
    REFUSED(s->look.shade.ambient = -1, "ambient", "-1");
    REFUSED(s->look.shade.diffuse = NAN, "diffuse", "finite");
    REFUSED(s->look.shade.specular = INFINITY, "specular", "finite");
    REFUSED(s->look.shade.magnitude = -2, "magnitude", "-2");
    REFUSED(s->look.shade.power = 0, "power 0", "above 0");
    REFUSED(s->look.shade.power = INFINITY, "power", "finite");
    REFUSED(s->look.shade.n_light = -3, "-3 lights", "0 or more");
    REFUSED(s->look.shade.n_light = 17, "17 lights", "16");
    REFUSED(s->look.shade.light = NULL, "2 lights", "NULL");
    REFUSED(s->light[1].color[2] = -1, "light 2", "colour");
    REFUSED(s->light[1].direction[2] = 0, "light 2", "direction 0 0 0");
    REFUSED(s->light[1].direction[0] = NAN, "light 2", "direction");
    REFUSED(s->light[1].direction[2] = 1e-155, "light 2", "direction");
    REFUSED(s->look.n_plane = -1, "-1 planes", "0 or more");
    REFUSED(s->look.plane = NULL, "2 planes", "NULL");
    REFUSED(s->plane[1].normal[1] = 0, "plane 2", "normal 0 0 0");
    REFUSED(s->plane[1].normal[1] = INFINITY, "plane 2", "normal");
    REFUSED(s->plane[0].offset = NAN, "plane 1", "offset");
    REFUSED(s->look.box[2] = 2.5, "from 2.5 to 2 in y", "lesser");
    REFUSED(s->look.box[5] = INFINITY, "in z", "finite");
    REFUSED(s->look.box[0] = NAN, "in x", "finite");
    REFUSED(s->look.n_select = -1, "-1 selections", "0 or more");
    REFUSED(s->look.select = NULL, "2 selections", "NULL");
    REFUSED(s->select[1].n_range = 0, "selection 2", "no range");
    REFUSED(s->select[1].n_range = -1, "-1 ranges", "0 or more");
    REFUSED(s->select[0].range = NULL, "2 ranges", "NULL");
    REFUSED(s->range[1][1] = -INFINITY; s->range[1][0] = 0, "from 0 to -inf", "lesser");
    REFUSED(s->range[0][0] = NAN, "range", "numbers");
    REFUSED(s->look.n_geometry = -1, "-1 geometries", "0 or more");
    REFUSED(s->look.geometry = NULL, "1 geometries", "NULL");
    REFUSED(s->triangle[2] = 3, "geometry", "vertex 3");
    REFUSED(s->vertex[4] = -1e6, "vertex 1 of geometry 0", "diagonal");
}

static void what_excludes_each_other_passes(void **state)
{
    sample *s = *state;
    static const tc_model one_scalar[] = {TC_MODEL_MAXIMUM, TC_MODEL_MINIMUM, TC_MODEL_AVERAGE};
    for (int i = 0; i < 3; i++) {
        REFUSED(s->look.model = one_scalar[i], "isosurfaces belong to matter that absorbs", "intensity");
        REFUSED(s->look.model = one_scalar[i]; s->look.n_iso = 0, "intensity", "volume unlit");
        REFUSED(s->look.model = one_scalar[i]; s->look.n_iso = 0;
                s->look.shade.gradient = TC_GRADIENT_NONE, "intensity", "second field");
        REFUSED(s->look.model = one_scalar[i]; s->look.n_iso = 0; s->look.shade.volume = false;
                s->look.n_geometry = 0, "intensity", "nothing that light");
    }
    REFUSED(s->look.model = TC_MODEL_EMISSION, "isosurfaces belong to matter that absorbs", "emission");
    REFUSED(s->look.model = TC_MODEL_EMISSION; s->look.n_iso = 0, "emission", "unlit");
    REFUSED(s->look.model = TC_MODEL_ABSORPTION, "absorption", "unlit");
    REFUSED(s->look.model = TC_MODEL_XRAY, "X-ray", "unlit");
    REFUSED(s->look.model = TC_MODEL_ABSORPTION; s->look.shade.volume = false, "absorption", "second field");
    REFUSED(s->look.model = TC_MODEL_XRAY; s->look.shade.volume = false, "X-ray", "second field");
    REFUSED(s->look.model = TC_MODEL_SURFACES; s->look.n_iso = 0; s->look.n_geometry = 0, "isosurfaces alone", "value");
    REFUSED(s->look.model = TC_MODEL_SURFACES; s->look.n_iso = 0;
            s->geometry[0].n_triangle = 0, "isosurfaces alone", "value");
    REFUSED(s->look.model = TC_MODEL_DEPTH, "depth", "gradient");
    REFUSED(s->look.model = TC_MODEL_DEPTH; s->look.shade.gradient = TC_GRADIENT_NONE, "depth", "second field");
    REFUSED(s->look.model = TC_MODEL_DEPTH; s->look.depth_opacity = -0.1, "opacity -0.1", "0 to 1");
    REFUSED(s->look.model = TC_MODEL_DEPTH; s->look.depth_opacity = NAN, "opacity", "0 to 1");
    REFUSED(s->look.color_function = NULL, "no function", "both or neither");
    REFUSED(s->look.color_field = NULL, "no field", "both or neither");
    REFUSED(s->look.color_field = s->foreign, "'alien'", "colour");
    REFUSED(s->select[1].field = s->foreign, "'alien'", "select");
    reset(s);
    s->look.color_field = NULL, s->look.color_function = NULL, s->look.n_select = 1;
    fails(&s->look, s->cells, "cell data", "point data");
    s->look.n_iso = 0;
    passes(&s->look, s->cells);
}

static void a_field_outlives_another_preparation(void **state)
{
    (void)state;
    static const double value[64] = {0};
    tc_mesh *mesh = make_mesh(TC_POINT_DATA);
    tc_field *field = NULL;
    assert_int_equal(tc_field_create(&field, mesh, value, TC_POINT_DATA, NULL, NULL), TC_OK);
    const tc_look look = {.color_field = field, .color_function = some_function};
    passes(&look, mesh);
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, NULL), TC_OK); /* new values leave it as it is */
    passes(&look, mesh);
    shape_prepare(mesh, TC_REENTRY_CONVEXIFY);
    fails(&look, mesh, "prepared again", "anew");
    tc_field_destroy(&field);
    tc_mesh_destroy(&mesh);
}

/* What light goes by is looked at where there is light; a shade that is all zeros is none, for geometry either. */
static void a_shade_that_is_not_used_is_refused(void **state)
{
    sample *s = *state;
    reset(s);
    s->look.shade = (tc_shade){0};
    passes(&s->look, s->mesh);
    s->look.shade.gradient = TC_GRADIENT_CELL;
    fails(&s->look, s->mesh, "power 0", "tc_shade_defaults");
}

static void the_defaults_are_others(void **state)
{
    (void)state;
    tc_shade d;
    memset(&d, 0xff, sizeof d);
    tc_shade_defaults(&d);
    assert_true(d.ambient == 0.2 && d.diffuse == 0.8 && d.specular == 0.2 && d.power == 20 && d.magnitude == 1);
    assert_true(d.volume && d.surfaces && !d.one_sided && d.n_light == 0 && !d.light);
    assert_int_equal(d.gradient, TC_GRADIENT_NONE);
}

static void a_look_that_asks_for_something_is_plain(void **state)
{
    sample *s = *state;
    reset(s);
    assert_true(tc_look_is_plain(NULL));
    tc_look plain = {0};
    assert_true(tc_look_is_plain(&plain));
    tc_shade_defaults(&plain.shade);
    assert_true(tc_look_is_plain(&plain));
    plain.shade.gradient = TC_GRADIENT_CELL;
    plain.shade.volume = false; /* and no isosurface */
    assert_true(tc_look_is_plain(&plain));
    tc_geometry nothing = {.n_vertex = 1, .vertex = s->vertex, .lit = true};
    plain.n_geometry = 1, plain.geometry = &nothing;
    assert_true(tc_look_is_plain(&plain));
    tc_look look[8];
    for (int i = 0; i < 8; i++)
        look[i] = plain;
    look[0].model = TC_MODEL_XRAY;
    look[1].n_iso = 1, look[1].iso = s->iso;
    look[2].shade.volume = true;
    look[3].color_field = s->field, look[3].color_function = some_function;
    look[4].n_plane = 1, look[4].plane = s->plane;
    look[5].has_box = true;
    look[6].n_select = 1, look[6].select = s->select;
    look[7].geometry = s->geometry;
    for (int i = 0; i < 8; i++) {
        if (tc_look_is_plain(&look[i]))
            fail_msg("look %d", i);
        assert_int_equal(tc_look_lights_volume(&look[i]), i == 2);
        assert_int_equal(tc_look_lights_surfaces(&look[i]), i == 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_good_look_is_refused),
        cmocka_unit_test(numbers_out_of_their_range_pass),
        cmocka_unit_test(what_excludes_each_other_passes),
        cmocka_unit_test(a_field_outlives_another_preparation),
        cmocka_unit_test(a_shade_that_is_not_used_is_refused),
        cmocka_unit_test(the_defaults_are_others),
        cmocka_unit_test(a_look_that_asks_for_something_is_plain),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
