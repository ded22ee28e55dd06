/* fuzz_paraview.c: ParaView state and camera files from any bytes.
 * Promises: a file is taken or refused; what is taken has its parts within its arrays, its scene has keys of a scene
 * file alone, with values of their types, and its colour map and opacity make a transfer function or are refused in
 * words. */
#define _GNU_SOURCE
#include "fuzz.h"

#include "cli/commands.h"
#include "cli/picture/render_options.h"
#include "cli/scene/paraview.h"

#include <math.h>

static void check_parts(const tc_pv *pv)
{
    TC_FUZZ_CHECK(pv->n_text > 0 && pv->text[0] == 0 && pv->text[pv->n_text - 1] == 0);
    for (size_t i = 0; i < pv->n_proxy; i++) {
        const tc_pv_proxy *p = &pv->proxy[i];
        TC_FUZZ_CHECK(p->group < pv->n_text && p->type < pv->n_text && p->id < pv->n_text);
        TC_FUZZ_CHECK(p->first <= pv->n_property && p->n <= pv->n_property - p->first);
    }
    for (size_t i = 0; i < pv->n_property; i++) {
        const tc_pv_property *p = &pv->property[i];
        TC_FUZZ_CHECK(p->name < pv->n_text && p->n <= pv->n_value - p->first);
        TC_FUZZ_CHECK(p->n_link <= pv->n_link - p->first_link);
    }
}

static bool is_list_of_numbers(const json_t *list, size_t n)
{
    for (size_t i = 0; i < json_array_size(list); i++)
        if (!json_is_number(json_array_get(list, i)))
            return false;
    return json_array_size(list) == n;
}

/* Where camera and function are what a scene file may hold, they are options. */
static void check_scene(json_t *scene, tc_talk *talk)
{
    static tc_render_command values;
    json_t *camera = json_object_get(scene, "camera"),
           *range = json_object_get(json_object_get(scene, "transfer_function"), "range");
    tc_scene options;
    TC_FUZZ_CHECK(!json_object_get(camera, "position") || is_list_of_numbers(json_object_get(camera, "position"), 3));
    TC_FUZZ_CHECK(!range || (is_list_of_numbers(range, 2) && json_number_value(json_array_get(range, 0)) <
                                                                 json_number_value(json_array_get(range, 1))));
    json_object_del(scene, "views");
    json_object_del(scene, "series");
    int code = tc_scene_from_json(&options, scene, -1, NULL, "a.pvsm", NULL, &tc_command_render, talk);
    TC_FUZZ_CHECK(code == -1); /* each key is known and of its type */
    memset(&values, 0, sizeof values);
    for (size_t i = 0; i < options.n && code < 0; i++) /* what lies outside of its bounds is refused */
        code = tc_option_set(&values, talk, &tc_command_render, options.item[i].option, options.item[i].called,
                             options.item[i].text);
    tc_transfer *tf = NULL;
    tc_error err = {0};
    const tc_transfer_options make = {.color_map = values.color_map,
                                      .opacity = values.opacity,
                                      .has_range = values.has_range,
                                      .range = {values.range[0], values.range[1]},
                                      .data_range = {0, 1},
                                      .log = values.log};
    if (values.color_map && !tc_transfer_create(&tf, &make, &err)) {
        size_t n = 0;
        const tc_knot *knot = tc_transfer_knots(tf, &n);
        TC_FUZZ_CHECK(n > 0);
        for (size_t i = 0; i < n; i++)
            TC_FUZZ_CHECK(isfinite(knot[i].s) && isfinite(knot[i].a) && knot[i].a >= 0);
    }
    tc_transfer_destroy(&tf);
    tc_given_finish(&values.given);
    tc_scene_finish(&options);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc, (void)argv;
    FILE *nowhere = fopen("/dev/null", "w");
    if (nowhere)
        stderr = nowhere;
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tc_talk talk;
    tc_pv pv;
    tc_paraview_notes notes;
    json_t *scene;
    tc_talk_init(&talk);
    int code = tc_pv_parse(&pv, (const char *)data, size, "a.pvsm", &talk);
    TC_FUZZ_CHECK(code == -1 || (code == TC_EXIT_FAILED && !pv.text && !pv.n_proxy));
    if (code >= 0)
        return 0;
    check_parts(&pv);
    for (int wants_data = 0; wants_data < 2; wants_data++) {
        code = tc_paraview_scene(&scene, &notes, &pv, "a.pvsm", wants_data, &talk);
        TC_FUZZ_CHECK(scene ? code == -1 : code == TC_EXIT_FAILED);
        if (scene)
            check_scene(scene, &talk);
        json_decref(scene);
        tc_paraview_notes_finish(&notes);
    }
    tc_pv_finish(&pv);
    return 0;
}
