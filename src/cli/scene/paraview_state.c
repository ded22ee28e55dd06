/* paraview_state.c: which view and which representation of a ParaView state are taken, what of them becomes a scene,
 * and what is said to be left out. */
#define _GNU_SOURCE
#include "cli/scene/paraview_parts.h"
#include "cli/options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tc_pv_put(tc_pv_build *b, const char *section, const char *key, json_t *value)
{
    json_t *holder = b->scene;
    if (*section) {
        holder = json_object_get(b->scene, section);
        if (!holder) {
            holder = json_object();
            json_object_set_new(b->scene, section, holder);
        }
    }
    json_object_set_new(holder, key, value);
}

/* ------------------------------------------------------------------------------------------------------------ views */

static bool tc_is_shown(const tc_pv *pv, const tc_pv_proxy *representation)
{
    return strcmp(tc_pv_value(pv, representation, "Visibility", 0), "0") != 0;
}

/* Does it show data, and not a colour bar or a text? */
static bool tc_is_of_data(const tc_pv *pv, const tc_pv_proxy *representation)
{
    return tc_pv_links(pv, representation, "Input") > 0 && tc_pv_property_of(pv, representation, "Representation");
}

static bool tc_is_volume(const tc_pv *pv, const tc_pv_proxy *representation)
{
    return !strcmp(tc_pv_value(pv, representation, "Representation", 0), "Volume");
}

/* How much a view has for us: 3 a volume that is shown, 2 data that are shown, 1 a camera, 0 it is no render view. */
static int tc_view_rank(const tc_pv *pv, const tc_pv_proxy *view)
{
    if (!view || !tc_pv_is(pv, view->group, "views") || !tc_pv_property_of(pv, view, "CameraPosition"))
        return 0;
    int rank = 1;
    for (size_t i = 0; i < tc_pv_links(pv, view, "Representations"); i++) {
        const tc_pv_proxy *r = tc_pv_link(pv, view, "Representations", i);
        if (r && tc_is_of_data(pv, r) && tc_is_shown(pv, r))
            rank = tc_is_volume(pv, r) ? 3 : rank < 2 ? 2 : rank;
    }
    return rank;
}

/* The view that shows most, the first of its layout among equals; what else there is is noted. */
static const tc_pv_proxy *tc_view_find(tc_pv_build *b)
{
    const tc_pv *pv = b->pv;
    const tc_pv_proxy *best = NULL;
    int most = 0;
    size_t n = 0;
    for (size_t i = 0; i < pv->n_cell; i++) {
        const tc_pv_proxy *view = tc_pv_find(pv, pv->text + pv->cell[i]);
        const int rank = tc_view_rank(pv, view);
        if (rank > most) {
            most = rank;
            best = view;
        }
    }
    for (size_t i = 0; i < pv->n_proxy; i++) {
        const int rank = tc_view_rank(pv, &pv->proxy[i]);
        n += rank > 0;
        if (rank > most) {
            most = rank;
            best = &pv->proxy[i];
        }
    }
    if (n > 1)
        tc_paraview_note(b->notes, "of its %zu render views %.80s is taken", n, tc_pv_name(pv, best, "views"));
    return best;
}

/* What a view shows that is no data: a colour bar, a text. */
static void tc_annotation_note(tc_pv_build *b, const tc_pv_proxy *shown)
{
    const tc_pv *pv = b->pv;
    if (strstr(pv->text + shown->type, "ScalarBar"))
        tc_paraview_note(b->notes, "the colour bar is left out (--color-bar)");
    else
        tc_paraview_note(b->notes, "%.80s (%.80s) is left out", tc_pv_name(pv, shown, NULL), pv->text + shown->type);
}

/* The representation that is taken: a volume before others, the first of them; what else is shown is noted. */
static const tc_pv_proxy *tc_representation_find(tc_pv_build *b, const tc_pv_proxy *view)
{
    const tc_pv *pv = b->pv;
    const tc_pv_proxy *best = NULL;
    const size_t n = tc_pv_links(pv, view, "Representations");
    for (size_t i = 0; i < n; i++) {
        const tc_pv_proxy *r = tc_pv_link(pv, view, "Representations", i);
        if (r && tc_is_of_data(pv, r) && tc_is_shown(pv, r) &&
            (!best || (tc_is_volume(pv, r) && !tc_is_volume(pv, best))))
            best = r;
    }
    for (size_t i = 0; i < n; i++) {
        const tc_pv_proxy *r = tc_pv_link(pv, view, "Representations", i);
        if (!r || r == best || !tc_is_shown(pv, r))
            continue;
        if (!tc_is_of_data(pv, r)) {
            tc_annotation_note(b, r);
            continue;
        }
        const tc_pv_proxy *input = tc_pv_link(pv, r, "Input", 0);
        tc_paraview_note(b->notes, "%.80s, shown as %.80s, is left out: one representation is taken",
                         input ? tc_pv_name(pv, input, "sources") : "a representation",
                         tc_pv_value(pv, r, "Representation", 0));
    }
    return best;
}

static void tc_background_put(tc_pv_build *b, const tc_pv_proxy *view)
{
    static const char *const mode[] = {"", "a gradient", "a texture", "a skybox", "a skybox"};
    const tc_pv *pv = b->pv;
    double rgb[3], kind = 0;
    bool there = tc_pv_reals(rgb, 3, pv, view, "Background");
    for (size_t i = 0; i < pv->n_proxy && tc_pv_is_on(pv, view, "UseColorPaletteForBackground"); i++)
        if (tc_pv_is(pv, pv->proxy[i].type, "ColorPalette"))
            there = tc_pv_reals(rgb, 3, pv, &pv->proxy[i], "BackgroundColor") || there;
    if (!tc_pv_reals(&kind, 1, pv, view, "BackgroundColorMode")) /* before 5.9 */
        kind = tc_pv_is_on(pv, view, "UseGradientBackground")   ? 1
               : tc_pv_is_on(pv, view, "UseTexturedBackground") ? 2
               : tc_pv_is_on(pv, view, "UseSkyboxBackground")   ? 3
                                                                : 0;
    if (kind != 0)
        tc_paraview_note(b->notes, "the background is %s there and %s here",
                         kind > 0 && kind < 5 ? mode[(int)kind] : "of several colours",
                         there ? "its first colour" : "transparent");
    if (there)
        tc_pv_put(b, "output", "background", json_pack("[fff]", rgb[0], rgb[1], rgb[2]));
}

static void tc_view_put(tc_pv_build *b, const tc_pv_proxy *view)
{
    const tc_pv *pv = b->pv;
    double size[2];
    tc_pv_camera(b, view);
    if (tc_pv_reals(size, 2, pv, view, "ViewSize") && size[0] >= 1 && size[1] >= 1 && size[0] < 1e6 && size[1] < 1e6)
        tc_pv_put(b, "output", "size", json_pack("[ii]", (int)size[0], (int)size[1]));
    tc_background_put(b, view);
    if (tc_pv_links(pv, view, "AdditionalLights") > 0)
        tc_paraview_note(b->notes, "its lights are left out (--light)");
    if (tc_pv_is_on(pv, view, "OrientationAxesVisibility"))
        tc_paraview_note(b->notes, "the axes in the corner are left out (--triad)");
    if (tc_pv_is_on(pv, tc_pv_link(pv, view, "AxesGrid", 0), "Visibility"))
        tc_paraview_note(b->notes, "the grid of axes is left out (--axes)");
    if (tc_pv_is_on(pv, view, "StereoRender"))
        tc_paraview_note(b->notes, "stereo is left out");
}

/* -------------------------------------------------------------------------------------------------- representations */

/* Options of a representation that have no counterpart, where they are on. */
static void tc_options_note(tc_pv_build *b, const tc_pv_proxy *r)
{
    static const struct {
        const char *property, *what;
    } known[] = {
        {"UseTransfer2D", "the two-dimensional transfer function"},
        {"UseGradientOpacity", "opacity by the gradient"},
        {"UseSeparateOpacityArray", "the opacity's own array"},
        {"MultiComponentsMapping", "the mapping of several components"},
        {"Shade", "shading (--shade vertex)"},
    };
    static const struct {
        const char *property;
        double none;
    } moved[] = {{"Position", 0}, {"Translation", 0}, {"Orientation", 0}, {"Scale", 1}};
    double v[3];
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (tc_pv_is_on(b->pv, r, known[i].property))
            tc_paraview_note(b->notes, "%s is left out", known[i].what);
    for (size_t i = 0; i < sizeof moved / sizeof *moved; i++)
        if (tc_pv_reals(v, 3, b->pv, r, moved[i].property) &&
            (v[0] != moved[i].none || v[1] != moved[i].none || v[2] != moved[i].none))
            tc_paraview_note(b->notes, "the representation's %s (%g, %g, %g) is left out: the mesh stays where it is",
                             moved[i].property, v[0], v[1], v[2]);
    if (tc_pv_values(b->pv, r, "BlockVisibility") > 0)
        tc_paraview_note(b->notes, "blocks that are hidden are shown (--blocks)");
    const char *selector = tc_pv_value(b->pv, r, "BlockSelectors", 0);
    if (*selector && (strcmp(selector, "/") != 0 || tc_pv_values(b->pv, r, "BlockSelectors") > 1) &&
        strcmp(selector, "/Root") != 0)
        tc_paraview_note(b->notes, "the choice of blocks is left out: all are shown (--blocks)");
}

/* How a volume's ray is put together. */
static void tc_blend_put(tc_pv_build *b, const tc_pv_proxy *r)
{
    static const struct {
        const char *name, *model;
    } mode[] = {{"composite", "density-emitter"},
                {"maximum", "mip"},
                {"minimum", "minip"},
                {"average", "average"},
                {"additive", NULL},
                {"isosurface", NULL},
                {"slice", NULL}};
    double value = 0;
    if (!tc_pv_reals(&value, 1, b->pv, r, "BlendMode") || value == 0)
        return;
    const size_t i = value > 0 && value < sizeof mode / sizeof *mode ? (size_t)value : 0;
    if (mode[i].model && i > 0) {
        tc_pv_put(b, "effects", "model", json_string(mode[i].model));
        tc_paraview_note(b->notes, "the opacity of the blend mode %s is left out: the model %s is opaque", mode[i].name,
                         mode[i].model);
    } else {
        tc_paraview_note(b->notes, "the blend mode %s is left out (--model)", i > 0 ? mode[i].name : "of the volume");
    }
}

/* The array that colours it: {"", "", "", association, name}; before 4.2 {name} and ColorAttributeType. */
static void tc_field_put(tc_pv_build *b, const tc_pv_proxy *r)
{
    const tc_pv *pv = b->pv;
    const size_t n = tc_pv_values(pv, r, "ColorArrayName");
    const char *name = n > 0 ? tc_pv_value(pv, r, "ColorArrayName", n - 1) : "";
    const char *of = n > 1 ? tc_pv_value(pv, r, "ColorArrayName", n - 2) : tc_pv_value(pv, r, "ColorAttributeType", 0);
    const tc_pv_proxy *table = tc_pv_link(pv, r, "LookupTable", 0);
    double component = 0;
    char *field = NULL;
    if (!*name) {
        tc_paraview_note(b->notes, "it is coloured by no array: the first one is taken (--field)");
        return;
    }
    const bool one =
        tc_pv_is_on(pv, table, "VectorMode") || !strcmp(tc_pv_value(pv, table, "VectorMode", 0), "Component");
    tc_pv_reals(&component, 1, pv, table, "VectorComponent");
    if (one && component >= 0 && component < 1000 && asprintf(&field, "%s:%d", name, (int)component) < 0)
        field = NULL;
    tc_pv_put(b, "", "field", json_string(field ? field : name));
    free(field);
    if (!strcmp(of, "1") || !strcmp(of, "CELLS"))
        tc_pv_put(b, "", "cell_data", json_true());
    else if (!strcmp(of, "0") || !strcmp(of, "POINTS"))
        tc_pv_put(b, "", "point_data", json_true());
    else
        tc_paraview_note(b->notes, "%.80s is neither of points nor of cells there: what there is of the name is taken",
                         name);
}

/* ------------------------------------------------------------------------------------------------------------ whole */

static int tc_state_put(tc_pv_build *b)
{
    const tc_pv *pv = b->pv;
    const tc_pv_proxy *view = tc_view_find(b);
    if (!view) {
        tc_talk_error(b->talk, "%s has no render view: save it from ParaView with a 3D view (File, Save State)",
                      b->path);
        return TC_EXIT_FAILED;
    }
    tc_view_put(b, view);
    const tc_pv_proxy *r = tc_representation_find(b, view);
    if (!r) {
        tc_paraview_note(b->notes, "%.80s shows no data: its camera, size and background are taken",
                         tc_pv_name(pv, view, "views"));
    } else {
        if (!tc_is_volume(pv, r))
            tc_paraview_note(b->notes, "the representation is %.80s, not Volume: its colours are taken for one",
                             tc_pv_value(pv, r, "Representation", 0));
        tc_field_put(b, r);
        tc_pv_function(b, r);
        tc_blend_put(b, r);
        tc_options_note(b, r);
    }
    const int code = tc_pv_source(b, r, view);
    tc_pv_camera_path(b, view);
    return code;
}

/* The first configuration of a camera file. */
static int tc_camera_file_put(tc_pv_build *b)
{
    const tc_pv *pv = b->pv;
    const tc_pv_proxy *view = NULL;
    for (size_t i = 0; i < pv->n_proxy && !view; i++)
        if (tc_pv_property_of(pv, &pv->proxy[i], "CameraPosition"))
            view = &pv->proxy[i];
    if (b->wants_data || !view) {
        tc_talk_error(b->talk,
                      view ? "%s holds a camera and no data: tetcast render INPUT --paraview %s"
                           : "%s holds no camera: save it anew from ParaView's camera dialog",
                      b->path, b->path);
        return TC_EXIT_FAILED;
    }
    if (pv->n_camera > 1)
        tc_paraview_note(b->notes, "of its %zu cameras the first is taken", pv->n_camera);
    tc_pv_camera(b, view);
    return -1;
}

int tc_paraview_scene(json_t **scene, tc_paraview_notes *notes, const tc_pv *pv, const char *path, bool wants_data,
                      tc_talk *talk)
{
    tc_pv_build b = {.pv = pv, .path = path, .wants_data = wants_data, .notes = notes, .talk = talk};
    *scene = NULL;
    *notes = (tc_paraview_notes){0};
    b.scene = json_object();
    const int code = pv->is_state ? tc_state_put(&b) : tc_camera_file_put(&b);
    if (code >= 0)
        json_decref(b.scene);
    else
        *scene = b.scene;
    return code;
}
