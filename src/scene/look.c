/* look.c: what may be wrong with a look; each rule once, before any driver sees it. */
#include "scene/look.h"

#include "core/vec.h"
#include "mesh/field.h"
#include "scene/geometry.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void tc_shade_defaults(tc_shade *shade)
{
    *shade = (tc_shade){
        .volume = true, .surfaces = true, .ambient = 0.2, .diffuse = 0.8, .specular = 0.2, .power = 20, .magnitude = 1};
}

/* ------------------------------------------------------------------------------------------ what is asked for */

bool tc_look_lights_volume(const tc_look *look)
{
    return look->shade.gradient != TC_GRADIENT_NONE && look->shade.volume && look->model == TC_MODEL_DENSITY_EMITTER;
}

bool tc_look_lights_surfaces(const tc_look *look)
{
    return look->shade.gradient != TC_GRADIENT_NONE && look->shade.surfaces && look->n_iso > 0;
}

static bool has_geometry(const tc_look *look)
{
    for (int i = 0; i < look->n_geometry; i++)
        if (look->geometry[i].n_triangle > 0 || look->geometry[i].n_line > 0)
            return true;
    return false;
}

static bool has_lit_geometry(const tc_look *look)
{
    for (int i = 0; i < look->n_geometry; i++)
        if (look->geometry[i].lit && look->geometry[i].n_triangle > 0)
            return true;
    return false;
}

bool tc_look_is_plain(const tc_look *look)
{
    return !look ||
           (look->model == TC_MODEL_DENSITY_EMITTER && look->n_iso == 0 && !tc_look_lights_volume(look) &&
            !look->color_field && look->n_plane == 0 && !look->has_box && look->n_select == 0 && !has_geometry(look));
}

/* ----------------------------------------------------------------------------------------------- what is wrong */

/* Where a sentence goes. */
static const double FAR = 1e4; /* diagonals of the mesh that geometry may reach beyond it */

typedef struct sentence {
    char *text;
    size_t capacity;
} sentence;

/* Always true, so that a check can say `return wrong(…)`. */
static bool wrong(sentence s, const char *format, ...) TC_PRINTF(2, 3);
static bool wrong(sentence s, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(s.text, s.capacity, format, arguments);
    va_end(arguments);
    return true;
}

static bool is_share(double x)
{
    return x >= 0 && x <= 1;
}

static bool is_amount(double x)
{
    return x >= 0 && isfinite(x);
}

/* Has a length that its own square does not lose: who normalises it need not look. */
static bool is_direction(const double *x)
{
    const double length = tc_vec_length(x);
    return length > 1e-150 && length < 1e150;
}

static const char *const model_name[] = {"the density emitter", "emission",          "absorption",
                                         "maximum intensity",   "isosurfaces alone", "an X-ray",
                                         "minimum intensity",   "average intensity", "depth"};

static bool shows_one_scalar(tc_model model)
{
    return model == TC_MODEL_MAXIMUM || model == TC_MODEL_MINIMUM || model == TC_MODEL_AVERAGE;
}

/* A list that a look counts: there where its count says so. */
static bool wrong_list(sentence s, int n, const void *list, const char *what)
{
    if (n < 0)
        return wrong(s, "a look cannot have %d %s; give 0 or more", n, what);
    if (n > 0 && !list)
        return wrong(s, "the look counts %d %s, but the list of them is NULL; give it, or a count of 0", n, what);
    return false;
}

static bool wrong_isos(sentence s, const tc_look *look, const tc_mesh *mesh)
{
    if (wrong_list(s, look->n_iso, look->iso, "isosurfaces"))
        return true;
    if (look->n_iso > TC_LOOK_ISOS)
        return wrong(s, "%d isosurfaces are more than the %d that a picture may have; leave some out", look->n_iso,
                     TC_LOOK_ISOS);
    if (look->n_iso > 0 && (shows_one_scalar(look->model) || look->model == TC_MODEL_EMISSION))
        return wrong(s,
                     "isosurfaces belong to matter that absorbs, not to %s; leave them out, or take the density "
                     "emitter or isosurfaces alone for the model",
                     model_name[look->model]);
    if (look->n_iso > 0 && mesh->association == TC_CELL_DATA)
        return wrong(s,
                     "'%s' is cell data, which is constant in a cell and has no isosurfaces; take point data, or leave "
                     "the isosurfaces out",
                     mesh->field_name ? mesh->field_name : "the field");
    for (int i = 0; i < look->n_iso; i++) {
        const tc_iso *iso = &look->iso[i];
        if (!isfinite(iso->value))
            return wrong(s, "the value of isosurface %d is not a finite number; give one in the scalar's range", i + 1);
        if (!is_share(iso->opacity))
            return wrong(s, "the isosurface at %g has opacity %g; opacities lie in 0 to 1", iso->value, iso->opacity);
        if (iso->has_color && !(is_share(iso->color[0]) && is_share(iso->color[1]) && is_share(iso->color[2])))
            return wrong(s, "the isosurface at %g has colour %g %g %g; each channel lies in 0 to 1", iso->value,
                         iso->color[0], iso->color[1], iso->color[2]);
        for (int k = 0; k < i; k++)
            if (look->iso[k].value == iso->value)
                return wrong(s, "two isosurfaces have the value %g; leave one of them out", iso->value);
    }
    if (look->model == TC_MODEL_SURFACES && look->n_iso == 0 && !has_geometry(look))
        return wrong(s, "the model of isosurfaces alone has no isosurface and no geometry to show; give a value");
    return false;
}

static bool wrong_lights(sentence s, const tc_shade *shade)
{
    const struct {
        const char *name;
        double value;
    } amount[] = {{"ambient light", shade->ambient},
                  {"diffuse light", shade->diffuse},
                  {"specular light", shade->specular},
                  {"gradient magnitude", shade->magnitude}};
    for (size_t i = 0; i < sizeof amount / sizeof *amount; i++)
        if (!is_amount(amount[i].value))
            return wrong(s, "the coefficient %g of %s must be a finite number of 0 or more", amount[i].value,
                         amount[i].name);
    if (!(shade->power > 0) || !isfinite(shade->power))
        return wrong(s,
                     "the specular power %g must be a finite number above 0 (tc_shade_defaults sets all that light "
                     "goes by)",
                     shade->power);
    if (wrong_list(s, shade->n_light, shade->light, "lights"))
        return true;
    if (shade->n_light > TC_LOOK_LIGHTS)
        return wrong(s, "%d lights are more than the %d that a picture may have; leave some out", shade->n_light,
                     TC_LOOK_LIGHTS);
    for (int i = 0; i < shade->n_light; i++) {
        const tc_light *light = &shade->light[i];
        if (!is_amount(light->color[0]) || !is_amount(light->color[1]) || !is_amount(light->color[2]))
            return wrong(s, "light %d has colour %g %g %g; each channel is a finite number of 0 or more", i + 1,
                         light->color[0], light->color[1], light->color[2]);
        if (!light->head && !is_direction(light->direction))
            return wrong(s,
                         "light %d comes from direction %g %g %g, whose length is 0 or cannot be computed with; give "
                         "another one, or make it a head light",
                         i + 1, light->direction[0], light->direction[1], light->direction[2]);
    }
    return false;
}

static bool wrong_shade(sentence s, const tc_look *look)
{
    const tc_shade *shade = &look->shade;
    if ((int)shade->gradient < TC_GRADIENT_NONE || (int)shade->gradient > TC_GRADIENT_VERTEX)
        return wrong(s, "gradient %d is unknown; there are %d (none), %d (of cells) and %d (of vertices)",
                     (int)shade->gradient, TC_GRADIENT_NONE, TC_GRADIENT_CELL, TC_GRADIENT_VERTEX);
    if (shade->gradient == TC_GRADIENT_NONE)
        return false;
    if (wrong_lights(s, shade))
        return true;
    if (look->model == TC_MODEL_DEPTH)
        return wrong(s, "depth is a number, not a colour that light could change; leave the gradient out");
    if (look->model == TC_MODEL_DENSITY_EMITTER || look->model == TC_MODEL_SURFACES)
        return false;
    if (shade->volume)
        return wrong(s,
                     "%s has no colours of matter that light could fall on; take the density emitter for the model, or "
                     "leave the volume unlit",
                     model_name[look->model]);
    if (look->n_iso == 0 && !has_lit_geometry(look))
        return wrong(s, "%s has nothing that light could fall on; leave the gradient out", model_name[look->model]);
    return false;
}

static bool wrong_field(sentence s, const tc_field *field, const tc_mesh *mesh, const char *what)
{
    if (field->mesh_serial == mesh->serial)
        return false;
    const char *name = field->name ? field->name : "without a name";
    return wrong(
        s, "the field '%s' to %s by is of another mesh, or of this one before it was prepared again; make it anew",
        name, what);
}

static bool wrong_color(sentence s, const tc_look *look, const tc_mesh *mesh)
{
    if (!look->color_field && look->color_function)
        return wrong(s, "there is a function for the colours of a second field, but no field; give both or neither");
    if (look->color_field && !look->color_function)
        return wrong(s, "there is a field to colour by, but no function of its colours; give both or neither");
    if (!look->color_field)
        return false;
    if (look->model == TC_MODEL_ABSORPTION || look->model == TC_MODEL_XRAY || look->model == TC_MODEL_DEPTH)
        return wrong(s,
                     "%s shows no colours that a second field could give; leave that field out, or take another model",
                     model_name[look->model]);
    if (shows_one_scalar(look->model))
        return wrong(s,
                     "%s shows the colour of one scalar, which a second field has no part in; leave that field out, or "
                     "take another model",
                     model_name[look->model]);
    return wrong_field(s, look->color_field, mesh, "colour");
}

static bool wrong_clip(sentence s, const tc_look *look)
{
    if (wrong_list(s, look->n_plane, look->plane, "planes"))
        return true;
    for (int i = 0; i < look->n_plane; i++) {
        const tc_plane *plane = &look->plane[i];
        if (!is_direction(plane->normal))
            return wrong(s,
                         "plane %d has normal %g %g %g, whose length is 0 or cannot be computed with; give another one",
                         i + 1, plane->normal[0], plane->normal[1], plane->normal[2]);
        if (!isfinite(plane->offset))
            return wrong(s, "the offset of plane %d is not a finite number; give one", i + 1);
    }
    static const char axis[] = "xyz";
    for (int k = 0; look->has_box && k < 3; k++) {
        const double lo = look->box[2 * k], hi = look->box[2 * k + 1];
        if (!isfinite(lo) || !isfinite(hi))
            return wrong(s, "the box reaches from %g to %g in %c; give finite numbers", lo, hi, axis[k]);
        if (lo > hi)
            return wrong(s, "the box reaches from %g to %g in %c; give the lesser one first", lo, hi, axis[k]);
    }
    return false;
}

static bool wrong_select(sentence s, const tc_look *look, const tc_mesh *mesh)
{
    if (wrong_list(s, look->n_select, look->select, "selections"))
        return true;
    for (int i = 0; i < look->n_select; i++) {
        const tc_select *select = &look->select[i];
        if (wrong_list(s, select->n_range, select->range, "ranges to select cells by"))
            return true;
        if (select->n_range == 0)
            return wrong(s, "selection %d has no range and so would keep no cell; give one, or leave it out", i + 1);
        for (int r = 0; r < select->n_range; r++) {
            const double lo = select->range[r][0], hi = select->range[r][1];
            if (!(lo <= hi))
                return wrong(s, "a range to select cells by is from %g to %g; give two numbers, the lesser one first",
                             lo, hi);
        }
        if (select->field && wrong_field(s, select->field, mesh, "select"))
            return true;
    }
    return false;
}

/* Geometry is drawn in floats about the mesh's middle: far beyond it they tell no pixels apart. */
static bool wrong_reach(sentence s, int i, const tc_geometry *g, const tc_mesh *mesh)
{
    const double *b = mesh->report.bounds;
    double most = FAR * hypot(hypot(b[1] - b[0], b[3] - b[2]), b[5] - b[4]);
    for (size_t v = 0; v < g->n_vertex; v++)
        for (size_t k = 0; k < 3; k++)
            if (!(fabs(g->vertex[3 * v + k] - 0.5 * (b[2 * k] + b[2 * k + 1])) <= most))
                return wrong(
                    s,
                    "vertex %zu of geometry %d lies at %g,%g,%g, more than %g times the mesh's diagonal away; cut "
                    "the geometry to what is near the mesh",
                    v, i, g->vertex[3 * v], g->vertex[3 * v + 1], g->vertex[3 * v + 2], FAR);
    return false;
}

static bool wrong_geometry(sentence s, const tc_look *look, const tc_mesh *mesh)
{
    for (int i = 0; i < look->n_geometry; i++)
        if (tc_geometry_wrong(s.text, s.capacity, &look->geometry[i]) || wrong_reach(s, i, &look->geometry[i], mesh))
            return true;
    return false;
}

const char *tc_look_wrong(char *why, size_t capacity, const tc_look *look, const tc_mesh *mesh)
{
    const sentence s = {why, capacity};
    if (!look)
        return NULL;
    if ((int)look->model < TC_MODEL_DENSITY_EMITTER || (int)look->model > TC_MODEL_DEPTH)
        wrong(s, "model %d is unknown; there are %d to %d", (int)look->model, TC_MODEL_DENSITY_EMITTER, TC_MODEL_DEPTH);
    else if (look->model == TC_MODEL_DEPTH && !is_share(look->depth_opacity))
        wrong(s, "depth is looked for at opacity %g; opacities lie in 0 to 1 (0: 0.5)", look->depth_opacity);
    else if (!mesh->prepared)
        wrong(s, "the mesh was not prepared; call tc_mesh_prepare first");
    else if (!wrong_list(s, look->n_geometry, look->geometry, "geometries") && !wrong_geometry(s, look, mesh) &&
             !wrong_isos(s, look, mesh) && !wrong_shade(s, look) && !wrong_color(s, look, mesh) &&
             !wrong_clip(s, look) && !wrong_select(s, look, mesh))
        return NULL;
    return why;
}
