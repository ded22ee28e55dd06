/* test_paraview_state.c: ParaView files as scenes, judged without a picture. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/views.h"
#include "cli/scene/paraview.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static tc_talk talk;

static int quiet_start(void **state)
{
    (void)state;
    tc_talk_init(&talk);
    return freopen("/dev/null", "w", stderr) ? 0 : -1;
}

/* A state with one volume: properties of the view, the representation, the colour table, the opacity; proxies more. */
typedef struct text_parts {
    const char *view, *shown, *table, *opacity, *more;
} text_parts;

#define PROPERTY(name, values) "<Property name='" name "'>" values "</Property>"
#define VALUE(v) "<Element index='0' value='" v "'/>"
#define TO(id) "<Proxy value='" id "'/>"
#define CAMERA                                                                                                         \
    PROPERTY("CameraPosition", VALUE("1") VALUE("2") VALUE("3"))                                                       \
    PROPERTY("CameraFocalPoint", VALUE("0") VALUE("0") VALUE("0"))
#define FIELD PROPERTY("ColorArrayName", VALUE("") VALUE("") VALUE("") VALUE("0") VALUE("a"))
#define POINTS_01                                                                                                      \
    PROPERTY("Points", VALUE("0") VALUE("0") VALUE("0.5") VALUE("0") VALUE("1") VALUE("1") VALUE("0.5") VALUE("0"))
#define RGB_01                                                                                                         \
    PROPERTY("RGBPoints", VALUE("0") VALUE("0") VALUE("0") VALUE("0") VALUE("1") VALUE("1") VALUE("1") VALUE("1"))

static const text_parts plain = {CAMERA, FIELD, RGB_01, POINTS_01, ""};

/* It as the text of a file; from malloc. */
static char *text_of(const text_parts *part)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    fputs("<ParaView><ServerManagerState version='5.9.0'>", stream);
    fprintf(stream, "<Proxy group='views' type='RenderView' id='1'>%s%s</Proxy>", part->view,
            PROPERTY("Representations", TO("2")));
    fprintf(stream, "<Proxy group='representations' type='UnstructuredGridRepresentation' id='2'>%s%s</Proxy>",
            part->shown,
            PROPERTY("Input", TO("9")) PROPERTY("Representation", VALUE("Volume")) PROPERTY("LookupTable", TO("3")));
    fprintf(stream, "<Proxy group='lookup_tables' type='PVLookupTable' id='3'>%s%s</Proxy>", part->table,
            PROPERTY("ScalarOpacityFunction", TO("4")));
    fprintf(stream, "<Proxy group='piecewise_functions' type='PiecewiseFunction' id='4'>%s</Proxy>", part->opacity);
    fprintf(stream, "%s</ServerManagerState></ParaView>", part->more);
    assert_int_equal(fclose(stream), 0);
    return text;
}

/* The scene of it, and its notes; NULL when it was refused. */
static json_t *scene_of(tc_paraview_notes *notes, const text_parts *part)
{
    char *text = text_of(part);
    tc_pv pv;
    json_t *scene = NULL;
    *notes = (tc_paraview_notes){0};
    if (tc_pv_parse(&pv, text, strlen(text), "a.pvsm", &talk) < 0) {
        tc_paraview_scene(&scene, notes, &pv, "a.pvsm", false, &talk);
        tc_pv_finish(&pv);
    }
    free(text);
    return scene;
}

static bool noted(const tc_paraview_notes *notes, const char *what)
{
    for (size_t i = 0; i < notes->n; i++)
        if (strstr(notes->line[i], what))
            return true;
    return false;
}

static json_t *at(json_t *scene, const char *section, const char *key)
{
    return json_object_get(*section ? json_object_get(scene, section) : scene, key);
}

/* A list of [s, a] at s: lines, of two at one s the second. */
static double opacity_at(const json_t *list, double s)
{
    double a = NAN;
    for (size_t i = 0; i < json_array_size(list); i++) {
        const json_t *p = json_array_get(list, i), *q = json_array_get(list, i + 1);
        const double s0 = json_number_value(json_array_get(p, 0)), a0 = json_number_value(json_array_get(p, 1));
        const double s1 = json_number_value(json_array_get(q, 0)), a1 = json_number_value(json_array_get(q, 1));
        if (i == 0 || s >= s0)
            a = q && s >= s0 && s < s1 ? a0 + (a1 - a0) * (s - s0) / (s1 - s0) : a0;
    }
    return a;
}

static void a_plain_state_is_taken_without_a_note(void **state)
{
    (void)state;
    tc_paraview_notes notes;
    json_t *scene = scene_of(&notes, &plain);
    assert_non_null(scene);
    assert_int_equal(notes.n, 0);
    assert_string_equal(json_string_value(at(scene, "", "field")), "a");
    assert_true(json_is_true(at(scene, "", "point_data")));
    assert_null(at(scene, "", "data"));
    assert_null(at(scene, "", "time"));
    assert_true(json_is_object(at(scene, "transfer_function", "color_map")));
    assert_null(at(scene, "transfer_function", "nan_color"));
    json_t *opacity = at(scene, "transfer_function", "opacity");
    assert_int_equal(json_array_size(opacity), 2);
    assert_true(opacity_at(opacity, 0.25) == 0.25);
    json_decref(scene);
    tc_paraview_notes_finish(&notes);
}

/* Truth: vtkPiecewiseFunction::GetValue of VTK 9.1. */
static void midpoints_sharpness_and_logarithms_are_those_of_vtk(void **state)
{
    (void)state;
    static const struct {
        const char *points;
        double at[12][2];
    } test[] = {
        {PROPERTY("UseLogScale", VALUE("1")) PROPERTY("Points", VALUE("0.1") VALUE("0.2") VALUE("0.3") VALUE("0.4")
                                                                    VALUE("10") VALUE("0.8") VALUE("0.5") VALUE("0")),
         {{0.05, 0.2},
          {0.1, 0.2},
          {0.2, 0.205902},
          {0.3, 0.273505},
          {0.5, 0.608749},
          {0.9, 0.749161},
          {1.5, 0.786418},
          {3, 0.798682},
          {5, 0.799917},
          {8, 0.8},
          {10, 0.8},
          {20, 0.8}}},
        {PROPERTY("UseLogScale", VALUE("0")) PROPERTY("Points", VALUE("0.1") VALUE("0.2") VALUE("0.3") VALUE("0.4")
                                                                    VALUE("10") VALUE("0.8") VALUE("0.5") VALUE("0")),
         {{0.05, 0.2},
          {0.1, 0.2},
          {0.2, 0.2},
          {0.3, 0.2},
          {0.5, 0.200008},
          {0.9, 0.200256},
          {1.5, 0.204286},
          {3, 0.459614},
          {5, 0.758375},
          {8, 0.799639},
          {10, 0.8},
          {20, 0.8}}},
        {PROPERTY("Points", VALUE("0") VALUE("0") VALUE("0.7") VALUE("0.999") VALUE("1") VALUE("0.5") VALUE("0.2")
                                VALUE("0.8") VALUE("3") VALUE("0.1") VALUE("0.5") VALUE("0")),
         {{0.3, 0},
          {0.69, 0},
          {0.71, 0.5},
          {1.1, 0.5},
          {1.35, 0.468453},
          {1.45, 0.231637},
          {1.7, 0.111594},
          {2.5, 0.100001},
          {2.5, 0.100001},
          {3, 0.1},
          {4, 0.1},
          {-1, 0}}},
    };
    for (size_t t = 0; t < sizeof test / sizeof *test; t++) {
        tc_paraview_notes notes;
        text_parts part = plain;
        part.opacity = test[t].points;
        json_t *scene = scene_of(&notes, &part);
        assert_non_null(scene);
        assert_int_equal(notes.n, 0);
        for (int i = 0; i < 12; i++) {
            const double s = test[t].at[i][0], a = opacity_at(at(scene, "transfer_function", "opacity"), s);
            if (!(fabs(a - test[t].at[i][1]) < 1e-3))
                fail_msg("function %zu at %g is %g, not %g", t, s, a, test[t].at[i][1]);
        }
        json_decref(scene);
        tc_paraview_notes_finish(&notes);
    }
}

static void a_logarithmic_table_is_laid_over_logarithms(void **state)
{
    (void)state;
    tc_paraview_notes notes;
    text_parts part = plain;
    part.table = PROPERTY("UseLogScale", VALUE("1"))
        PROPERTY("RGBPoints", VALUE("0.01") VALUE("0") VALUE("0") VALUE("0") VALUE("1") VALUE("1") VALUE("0") VALUE("0")
                                  VALUE("100") VALUE("1") VALUE("1") VALUE("1"));
    json_t *scene = scene_of(&notes, &part), *map = at(scene, "transfer_function", "color_map");
    json_t *rgb = json_object_get(map, "RGBPoints"), *range = at(scene, "transfer_function", "range");
    for (int i = 0; i < 3; i++)
        assert_true(fabs(json_number_value(json_array_get(rgb, 4 * (size_t)i)) - (2 * i - 2)) < 1e-12);
    assert_true(json_number_value(json_array_get(range, 0)) == 0.01 &&
                json_number_value(json_array_get(range, 1)) == 100);
    assert_true(json_is_true(at(scene, "transfer_function", "log")));
    json_decref(scene);
    tc_paraview_notes_finish(&notes);
    /* ParaView lays it over the scalars where logarithms have no meaning. */
    part.table = PROPERTY("UseLogScale", VALUE("1")) RGB_01;
    scene = scene_of(&notes, &part);
    assert_null(at(scene, "transfer_function", "log"));
    assert_true(noted(&notes, "the colour table is logarithmic but begins at 0"));
    json_decref(scene);
    tc_paraview_notes_finish(&notes);
}

/* VTK takes the opacity of what is no number from before the function's first point. */
static void missing_values_show_where_the_first_opacity_is_above_zero(void **state)
{
    (void)state;
    tc_paraview_notes notes;
    text_parts part = plain;
    part.table = RGB_01 PROPERTY("NanColor", VALUE("1") VALUE("0.5") VALUE("0"));
    part.opacity = PROPERTY("Points", VALUE("1") VALUE("1") VALUE("0.5") VALUE("0") VALUE("0") VALUE("0.25")
                                          VALUE("0.5") VALUE("0"));
    json_t *scene = scene_of(&notes, &part), *color = at(scene, "transfer_function", "nan_color");
    static const double wanted[4] = {1, 0.5, 0, 0.25};
    for (size_t i = 0; i < 4; i++)
        assert_true(json_number_value(json_array_get(color, i)) == wanted[i]);
    json_decref(scene);
    tc_paraview_notes_finish(&notes);
}

static void the_array_is_told_in_each_versions_way(void **state)
{
    (void)state;
    static const struct {
        const char *shown, *table, *field, *of, *note;
    } test[] = {
        {PROPERTY("ColorArrayName", VALUE("") VALUE("") VALUE("") VALUE("1") VALUE("v")), RGB_01, "v", "cell_data",
         NULL},
        {PROPERTY("ColorArrayName", VALUE("CELLS") VALUE("v")), RGB_01, "v", "cell_data", NULL},
        {PROPERTY("ColorArrayName", VALUE("v")) PROPERTY("ColorAttributeType", VALUE("0")), RGB_01, "v", "point_data",
         NULL},
        {PROPERTY("ColorArrayName", VALUE("v")), RGB_01, "v", NULL, "neither of points nor of cells"},
        {FIELD, RGB_01 PROPERTY("VectorMode", VALUE("1")) PROPERTY("VectorComponent", VALUE("2")), "a:2", "point_data",
         NULL},
        {FIELD, RGB_01 PROPERTY("VectorMode", VALUE("Component")), "a:0", "point_data", NULL},
        {FIELD, RGB_01 PROPERTY("VectorMode", VALUE("0")), "a", "point_data", NULL},
        {PROPERTY("ColorArrayName", VALUE("") VALUE("") VALUE("") VALUE("0") VALUE("")), RGB_01, NULL, NULL,
         "by no array"},
    };
    for (size_t t = 0; t < sizeof test / sizeof *test; t++) {
        tc_paraview_notes notes;
        text_parts part = plain;
        part.shown = test[t].shown;
        part.table = test[t].table;
        json_t *scene = scene_of(&notes, &part);
        const char *field = json_string_value(at(scene, "", "field"));
        assert_true(field ? test[t].field && !strcmp(field, test[t].field) : !test[t].field);
        assert_int_equal(json_is_true(at(scene, "", "cell_data")), test[t].of && !strcmp(test[t].of, "cell_data"));
        assert_int_equal(json_is_true(at(scene, "", "point_data")), test[t].of && !strcmp(test[t].of, "point_data"));
        assert_int_equal(notes.n, test[t].note != NULL);
        assert_true(!test[t].note || noted(&notes, test[t].note));
        json_decref(scene);
        tc_paraview_notes_finish(&notes);
    }
}

static void the_background_is_told_in_each_versions_way(void **state)
{
    (void)state;
    static const char color[] = PROPERTY("Background", VALUE("0.1") VALUE("0.2") VALUE("0.3"));
    static const struct {
        const char *view, *more, *note;
        double first;
    } test[] = {
        {"", "", NULL, 0.1},
        {PROPERTY("BackgroundColorMode", VALUE("1")), "", "a gradient there", 0.1},
        {PROPERTY("UseGradientBackground", VALUE("1")), "", "a gradient there", 0.1},
        {PROPERTY("BackgroundColorMode", VALUE("4")), "", "a skybox there", 0.1},
        {PROPERTY("UseColorPaletteForBackground", VALUE("1")),
         "<Proxy group='settings' type='ColorPalette' id='7'>" PROPERTY("BackgroundColor",
                                                                        VALUE("0.7") VALUE("0") VALUE("0")) "</Proxy>",
         NULL, 0.7},
    };
    for (size_t t = 0; t < sizeof test / sizeof *test; t++) {
        tc_paraview_notes notes;
        text_parts part = plain;
        char view[2000];
        snprintf(view, sizeof view, "%s%s%s", CAMERA, color, test[t].view);
        part.view = view;
        part.more = test[t].more;
        json_t *scene = scene_of(&notes, &part);
        assert_true(json_number_value(json_array_get(at(scene, "output", "background"), 0)) == test[t].first);
        assert_int_equal(notes.n, test[t].note != NULL);
        assert_true(!test[t].note || noted(&notes, test[t].note));
        json_decref(scene);
        tc_paraview_notes_finish(&notes);
    }
}

static void blend_modes_are_models_or_noted(void **state)
{
    (void)state;
    static const struct {
        const char *shown, *model;
    } test[] = {
        {FIELD PROPERTY("BlendMode", VALUE("0")), NULL},      {FIELD PROPERTY("BlendMode", VALUE("1")), "mip"},
        {FIELD PROPERTY("BlendMode", VALUE("3")), "average"}, {FIELD PROPERTY("BlendMode", VALUE("4")), ""},
        {FIELD PROPERTY("BlendMode", VALUE("1e300")), ""},    {FIELD PROPERTY("BlendMode", VALUE("-1")), ""},
    };
    for (size_t t = 0; t < sizeof test / sizeof *test; t++) {
        tc_paraview_notes notes;
        text_parts part = plain;
        part.shown = test[t].shown;
        json_t *scene = scene_of(&notes, &part);
        const char *model = json_string_value(at(scene, "effects", "model"));
        const bool named = test[t].model && *test[t].model;
        assert_true(model ? named && !strcmp(model, test[t].model) : !named);
        assert_int_equal(noted(&notes, "(--model)"), test[t].model && !*test[t].model);
        json_decref(scene);
        tc_paraview_notes_finish(&notes);
    }
}

#define READER_OF(times)                                                                                               \
    "<Proxy group='sources' type='R' id='9'>" PROPERTY("FileName", VALUE("a.ex2")) PROPERTY("TimestepValues", times)   \
        PROPERTY("ElementBlocks", VALUE("one") VALUE("1") VALUE("two") VALUE("0")) "</Proxy>"

static void time_is_the_animations_where_the_data_have_steps(void **state)
{
    (void)state;
    static const char scene_proxy[] =
        "<Proxy group='animation' type='AnimationScene' id='8'>" PROPERTY("AnimationTime", VALUE("0.75")) "</Proxy>";
    tc_paraview_notes notes;
    text_parts part = plain;
    char more[4000];
    snprintf(more, sizeof more, "%s%s", scene_proxy, READER_OF(VALUE("0") VALUE("1")));
    part.more = more;
    json_t *scene = scene_of(&notes, &part);
    assert_true(json_number_value(at(scene, "", "time")) == 0.75);
    assert_true(noted(&notes, "1 blocks that R does not read (ElementBlocks) are shown"));
    json_decref(scene);
    tc_paraview_notes_finish(&notes);
    snprintf(more, sizeof more, "%s%s", scene_proxy, READER_OF(VALUE("0")));
    scene = scene_of(&notes, &part);
    assert_null(at(scene, "", "time"));
    json_decref(scene);
    tc_paraview_notes_finish(&notes);
}

#define CUE(mode, keys)                                                                                                \
    "<Proxy group='animation' type='CameraAnimationCue' id='20'>" PROPERTY("AnimatedProxy", TO("1"))                   \
        PROPERTY("Enabled", VALUE("1")) PROPERTY("Mode", VALUE(mode)) PROPERTY("KeyFrames", keys) "</Proxy>"
#define KEY(id, time, more)                                                                                            \
    "<Proxy group='animation_keyframes' type='CameraKeyFrame' id='" id                                                 \
    "'>" PROPERTY("KeyTime", VALUE(time)) PROPERTY("Position", VALUE(time) VALUE("0") VALUE("5"))                      \
        PROPERTY("FocalPoint", VALUE("0") VALUE("0") VALUE("0")) PROPERTY("ViewAngle", VALUE("30")) more "</Proxy>"

static bool is_read_by_batch(const json_t *json)
{
    tc_views views;
    const bool good = tc_views_read(&views, json, "a.pvsm: views", &talk) < 0 && views.along && views.n_key > 1;
    tc_views_finish(&views);
    return good;
}

static void an_animated_camera_becomes_a_path(void **state)
{
    (void)state;
    tc_paraview_notes notes;
    text_parts part = plain;
    part.more = CUE("0", TO("21") TO("22")) KEY("21", "0", "") KEY("22", "1", "");
    json_t *scene = scene_of(&notes, &part), *path = at(scene, "views", "path");
    assert_int_equal(json_array_size(path), 2);
    assert_true(is_read_by_batch(json_object_get(scene, "views")));
    json_t *last = json_array_get(path, 1);
    assert_true(json_number_value(json_object_get(last, "time")) == 1);
    assert_true(json_number_value(json_array_get(json_object_get(last, "position"), 0)) == 1);
    assert_int_equal(notes.n, 0);
    json_decref(scene);

    part.more = CUE("1", TO("21") TO("22"))
        KEY("21", "0",
            PROPERTY("ClosedPositionPath", VALUE("1"))
                PROPERTY("PositionPathPoints", VALUE("5") VALUE("0") VALUE("0") VALUE("0") VALUE("5") VALUE("0")
                                                   VALUE("-5") VALUE("0") VALUE("0"))
                    PROPERTY("FocalPathPoints", VALUE("0") VALUE("0") VALUE("1"))) KEY("22", "1", "");
    scene = scene_of(&notes, &part);
    path = at(scene, "views", "path");
    assert_int_equal(json_array_size(path), 3);
    assert_true(json_is_true(at(scene, "views", "closed")));
    assert_true(is_read_by_batch(json_object_get(scene, "views")));
    json_t *second = json_array_get(path, 1);
    assert_true(json_number_value(json_array_get(json_object_get(second, "position"), 1)) == 5);
    assert_true(json_number_value(json_array_get(json_object_get(second, "focal_point"), 2)) == 1);
    json_decref(scene);

    part.more = CUE("2", TO("21") TO("22")) KEY("21", "0", "") KEY("22", "1", "");
    scene = scene_of(&notes, &part);
    assert_null(json_object_get(scene, "views"));
    assert_true(noted(&notes, "the camera's animation is of a kind that is not known"));
    json_decref(scene);
    tc_paraview_notes_finish(&notes);
}

static void file_write(const char *path, const text_parts *part)
{
    char *text = text_of(part);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(text, stream);
    assert_int_equal(fclose(stream), 0);
    free(text);
}

static void views_of_a_file_are_its_cameras_path_alone(void **state)
{
    (void)state;
    static const char path[] = "paraview_test.pvsm";
    text_parts part = plain;
    json_t *views;
    file_write(path, &part);
    assert_int_equal(tc_paraview_many(NULL, &views, path, &talk), -1);
    assert_null(views);
    part.more = CUE("0", TO("21") TO("22")) KEY("21", "0", "") KEY("22", "1", "");
    file_write(path, &part);
    assert_int_equal(tc_paraview_many(NULL, &views, path, &talk), -1);
    assert_int_equal(json_array_size(json_object_get(views, "path")), 2);
    json_decref(views);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(tc_paraview_many(NULL, &views, path, &talk), TC_EXIT_FAILED);
    assert_null(views);
}

static void what_is_chosen_from_in_a_domain_is_not_what_is_chosen(void **state)
{
    (void)state;
    static const char text[] =
        "<PVCameraConfiguration><Proxy group='views' type='RenderView' id='1'>"
        "<Property name='A'><Proxy value='5'/><Domain name='d'><Proxy value='6'/><Element "
        "value='7'/></Domain></Property>"
        "<Property name='CameraPosition'><Element value='1'/><Element value='x'/><Element value='1e999'/></Property>"
        "</Proxy></PVCameraConfiguration>";
    tc_pv pv;
    double v[3] = {7, 7, 7};
    assert_int_equal(tc_pv_parse(&pv, text, strlen(text), "a.pvcc", &talk), -1);
    assert_int_equal(pv.n_proxy, 1);
    assert_int_equal(tc_pv_links(&pv, pv.proxy, "A"), 1);
    assert_int_equal(tc_pv_values(&pv, pv.proxy, "A"), 0);
    assert_false(tc_pv_reals(v, 3, &pv, pv.proxy, "CameraPosition"));
    assert_true(v[0] == 7);
    assert_true(tc_pv_reals(v, 1, &pv, pv.proxy, "CameraPosition"));
    assert_string_equal(tc_pv_value(&pv, pv.proxy, "CameraPosition", 9), "");
    assert_null(tc_pv_link(&pv, pv.proxy, "A", 0));
    tc_pv_finish(&pv);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_state_is_taken_without_a_note),
        cmocka_unit_test(midpoints_sharpness_and_logarithms_are_those_of_vtk),
        cmocka_unit_test(a_logarithmic_table_is_laid_over_logarithms),
        cmocka_unit_test(missing_values_show_where_the_first_opacity_is_above_zero),
        cmocka_unit_test(the_array_is_told_in_each_versions_way),
        cmocka_unit_test(the_background_is_told_in_each_versions_way),
        cmocka_unit_test(blend_modes_are_models_or_noted),
        cmocka_unit_test(time_is_the_animations_where_the_data_have_steps),
        cmocka_unit_test(an_animated_camera_becomes_a_path),
        cmocka_unit_test(views_of_a_file_are_its_cameras_path_alone),
        cmocka_unit_test(what_is_chosen_from_in_a_domain_is_not_what_is_chosen),
    };
    return cmocka_run_group_tests(tests, quiet_start, NULL);
}
