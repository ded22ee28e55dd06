/* look_build.c: from the options of a look, a mesh and its file to a tc_look. */
#define _POSIX_C_SOURCE 200809L
#include "cli/picture/look_build.h"
#include "cli/nearest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double tc_grey[3] = {0.8, 0.8, 0.8};

static int tc_memory_out(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* --------------------------------------------------------------------------------------------------------- fields */

/* Another array of INPUT, at the step that the mesh has; parts own it. option stands in errors. */
static int tc_field_take(const tc_field **out, tc_look_parts *parts, tc_mesh *mesh, const char *name,
                         const char *option, const tc_render_command *options, tc_talk *talk)
{
    tc_error err = {0};
    if (tc_input_is_synthetic(options->input)) {
        tc_talk_error(talk, "%s %s: a synthetic dataset has one field, %s", option, name,
                      "which --field shows: leave it out, or take a file");
        return TC_EXIT_USAGE;
    }
    tc_read_options read = tc_input_read_options(&options->source);
    read.field = name;
    read.association = TC_ANY_DATA;
    tc_status status = tc_field_read(&parts->field[parts->n_field], mesh, options->input, &read, &talk->log, &err);
    if (status)
        return tc_talk_status(talk, status, &err);
    *out = parts->field[parts->n_field++];
    return -1;
}

/* The name of the array that numbers the blocks, which readers/fields.cpp makes where there are several and none of
 * these; NULL: there is none. */
static const char *tc_block_array(const tc_mesh *mesh)
{
    static const char *const known[] = {"ObjectId",        "vtkCompositeIndex",    "BlockId", "BlockID", "block_id",
                                        "ElementBlockIds", "GlobalElementBlockId", "Block"};
    const tc_source *source = tc_mesh_source(mesh);
    for (size_t k = 0; source && k < sizeof known / sizeof *known; k++)
        for (size_t i = 0; i < source->n_array; i++)
            if (source->array[i].association == TC_CELL_DATA && !strcmp(source->array[i].name, known[k]))
                return known[k];
    return NULL;
}

/* Appends the numbers of the blocks of that name to parts->range. */
static int tc_block_named(tc_look_parts *parts, int *used, const tc_source *source, const char *name, const char *input,
                          tc_talk *talk)
{
    tc_nearest nearest = {.name = name};
    const int before = *used;
    for (size_t i = 0; i < source->n_block; i++) {
        const tc_block_info *block = &source->block[i];
        if (block->name && strcmp(block->name, name) != 0)
            tc_nearest_offer(&nearest, block->name);
        if (!block->name || strcmp(block->name, name) != 0)
            continue;
        if (*used >= 3 * TC_LOOK_MANY) { /* what is left is for numbers */
            tc_talk_error(talk, "%s has too many blocks named '%s': give their numbers, FROM:TO, to --blocks", input,
                          name);
            return TC_EXIT_FAILED;
        }
        parts->range[*used][0] = parts->range[*used][1] = (double)block->number;
        ++*used;
    }
    if (*used > before)
        return -1;
    if (nearest.best)
        tc_talk_error(talk, "%s has no block named '%s'; the nearest is '%s', and tetcast info tells all", input, name,
                      nearest.best);
    else
        tc_talk_error(talk, "%s has no names of blocks, so none is '%s': give numbers to --blocks", input, name);
    return TC_EXIT_FAILED;
}

/* Cells whose values of an array lie in one of n ranges, which parts->range holds from `first` on. */
static int tc_select_add(tc_look_parts *parts, tc_mesh *mesh, const char *name, const char *option, int first, int n,
                         const tc_render_command *options, tc_talk *talk)
{
    const tc_source *source = tc_mesh_source(mesh);
    const char *own = source ? source->field : "field"; /* as tc_run_field names it */
    tc_select *select = &parts->select[parts->look.n_select];
    *select = (tc_select){.n_range = n, .range = (const double(*)[2]) & parts->range[first]};
    int code = own && !strcmp(name, own) ? -1 : tc_field_take(&select->field, parts, mesh, name, option, options, talk);
    parts->look.n_select += code < 0;
    return code;
}

static int tc_selects_make(tc_look_parts *parts, tc_mesh *mesh, const tc_render_command *options, tc_talk *talk)
{
    const tc_look_options *o = &options->look;
    bool done[TC_LOOK_MANY] = {false};
    int code = -1, used = 0;
    for (int i = 0; i < o->select.n && code < 0; i++) { /* ranges of one array are one selection */
        const tc_part *name = &o->select.range[i].name;
        int first = used;
        for (int k = i; k < o->select.n && !done[i]; k++) {
            const tc_range_choice *range = &o->select.range[k];
            if (done[k] || range->name.length != name->length || memcmp(range->name.at, name->at, name->length) != 0)
                continue;
            parts->range[used][0] = range->lo;
            parts->range[used++][1] = range->hi;
            done[k] = k > i;
        }
        if (used == first)
            continue;
        char *text = tc_part_text(name);
        code = text ? tc_select_add(parts, mesh, text, "--select", first, used - first, options, talk)
                    : tc_memory_out(talk);
        free(text);
    }
    if (code >= 0 || o->blocks.n == 0)
        return code;
    const char *array = tc_block_array(mesh);
    if (!array) {
        tc_talk_error(talk,
                      "%s is one block, and has no array of block numbers (ObjectId, BlockId or vtkCompositeIndex of "
                      "the cells): leave --blocks out, or name an array with --select NAME:V",
                      options->input);
        return TC_EXIT_FAILED;
    }
    const int first = used;
    for (int i = 0; i < o->blocks.n && code < 0; i++) {
        const tc_range_choice *range = &o->blocks.range[i];
        if (range->name.at) {
            char *text = tc_part_text(&range->name);
            code = text ? tc_block_named(parts, &used, tc_mesh_source(mesh), text, options->input, talk)
                        : tc_memory_out(talk);
            free(text);
            continue;
        }
        parts->range[used][0] = range->lo;
        parts->range[used++][1] = range->hi;
    }
    return code < 0 ? tc_select_add(parts, mesh, array, "--blocks", first, used - first, options, talk) : code;
}

/* --------------------------------------------------------------------------------------------------------- colours */

static int tc_color_function_make(tc_look_parts *parts, const tc_render_command *options, tc_talk *talk)
{
    const tc_look_options *o = &options->look;
    tc_error err = {0};
    tc_field_info(parts->color_range, NULL, NULL, parts->look.color_field);
    if (o->has_color_range)
        memcpy(parts->color_range, o->color_range, sizeof parts->color_range);
    if (o->categories)
        return tc_categories_make(&parts->color_function, &parts->categories, o->categories, parts->color_range, talk);
    const tc_transfer_options make = {.color_map = options->color_map,
                                      .preset = options->preset,
                                      .opacity = "linear", /* its opacity is not looked at */
                                      .has_range = o->has_color_range,
                                      .range = {parts->color_range[0], parts->color_range[1]},
                                      .data_range = {parts->color_range[0], parts->color_range[1]}};
    tc_status status = tc_transfer_create(&parts->color_function, &make, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

static int tc_colors_make(tc_look_parts *parts, tc_mesh *mesh, const tc_render_command *options, tc_talk *talk)
{
    if (!options->look.color_field)
        return -1;
    int code =
        tc_field_take(&parts->look.color_field, parts, mesh, options->look.color_field, "--color-field", options, talk);
    if (code < 0 && !parts->color_function)
        code = tc_color_function_make(parts, options, talk);
    parts->look.color_function = parts->color_function;
    return code;
}

static void tc_isos_make(tc_look_parts *parts, const tc_look_options *o)
{
    parts->look.n_iso = o->iso.n;
    parts->look.iso = parts->iso;
    for (int i = 0; i < o->iso.n; i++) {
        const int n_color = o->iso_color.n, n_opacity = o->iso_opacity.n;
        tc_iso *iso = &parts->iso[i];
        *iso = (tc_iso){.value = o->iso.value[i], .opacity = 1, .has_color = n_color > 0};
        if (n_color > 0)
            memcpy(iso->color, o->iso_color.rgb[n_color > 1 ? i : 0], sizeof iso->color);
        if (n_opacity > 0)
            iso->opacity = o->iso_opacity.value[n_opacity > 1 ? i : 0];
    }
}

/* ------------------------------------------------------------------------------------------------------- geometry */

/* Files are read once. */
static int tc_files_read(tc_look_parts *parts, const tc_render_command *options, tc_talk *talk)
{
    const tc_look_options *o = &options->look;
    tc_error err = {0};
    while (parts->n_file < o->geometry.n) {
        const int i = parts->n_file, n_color = o->geometry_color.n;
        tc_geometry *one = &parts->geometry[i];
        char *path = tc_part_text(&o->geometry.file[i].file);
        if (!path)
            return tc_memory_out(talk);
        tc_status status = tc_geometry_read(one, path, &talk->log, &err);
        const bool judged = status == TC_OK && one->n_line > 0 && options->has_verify;
        if (judged)
            tc_talk_error(talk,
                          "%s has %zu lines, and the reference that --verify compares with draws none: leave out %s",
                          path, one->n_line, options->error_image ? "--error-image" : "--verify");
        free(path);
        if (status)
            return tc_talk_status(talk, status, &err);
        parts->n_file++;
        if (judged)
            return TC_EXIT_USAGE;
        one->opacity = o->geometry.file[i].opacity;
        memcpy(one->color, n_color == 0 ? tc_grey : o->geometry_color.rgb[n_color > 1 ? i : 0], sizeof one->color);
    }
    return -1;
}

/* Is what lies under the picture darker than mid grey? */
static bool tc_is_dark(const tc_background *background)
{
    const float *c = background->rgba;
    return background->there && c[3] > 0.5f && 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2] < 0.5f * c[3];
}

static int tc_part_add(tc_look_parts *parts, const tc_mesh *mesh, tc_mesh_part part, const double *color,
                       double opacity, tc_talk *talk)
{
    tc_error err = {0};
    tc_geometry *one = &parts->geometry[parts->look.n_geometry];
    tc_status status = tc_geometry_from_mesh(one, mesh, part, &err);
    if (status)
        return tc_talk_status(talk, status, &err);
    memcpy(one->color, color, sizeof one->color);
    one->opacity = opacity;
    parts->look.n_geometry++;
    return -1;
}

static int tc_geometry_make(tc_look_parts *parts, const tc_mesh *mesh, const tc_render_command *options, tc_talk *talk)
{
    const tc_look_options *o = &options->look;
    const double ink = tc_is_dark(&options->background) ? 1 : 0, line[3] = {ink, ink, ink};
    const double *lines = o->has_line_color ? o->line_color : line;
    int code = tc_files_read(parts, options, talk);
    parts->look.n_geometry = parts->n_file;
    parts->look.geometry = parts->geometry;
    if (code < 0 && o->outline)
        code = tc_part_add(parts, mesh, TC_PART_OUTLINE, lines, 1, talk);
    if (code < 0 && o->wireframe)
        code = tc_part_add(parts, mesh, TC_PART_WIREFRAME, lines, 1, talk);
    if (code < 0 && o->has_surface)
        code = tc_part_add(parts, mesh, TC_PART_SURFACE, o->has_surface_color ? o->surface_color : tc_grey, o->surface,
                           talk);
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

/* What was made of a mesh and its values. */
static void tc_of_mesh_finish(tc_look_parts *parts)
{
    for (int i = 0; i < parts->n_field; i++)
        tc_field_destroy(&parts->field[i]);
    parts->n_field = 0;
    for (int i = parts->n_file; i < parts->look.n_geometry; i++)
        tc_geometry_finish(&parts->geometry[i]);
    memset(&parts->look, 0, sizeof parts->look);
}

void tc_look_parts_finish(tc_look_parts *parts)
{
    tc_of_mesh_finish(parts);
    for (int i = 0; i < parts->n_file; i++)
        tc_geometry_finish(&parts->geometry[i]);
    parts->n_file = 0;
    tc_transfer_destroy(&parts->color_function);
    tc_category_list_finish(&parts->categories);
}

static bool tc_is_asked(const tc_look_options *o)
{
    return o->model || o->iso.n || o->gradient || o->color_field || o->clip.n || o->has_clip_box || o->select.n ||
           o->blocks.n || o->outline || o->wireframe || o->has_surface || o->geometry.n;
}

int tc_look_build(tc_look_parts *parts, tc_mesh *mesh, const tc_render_command *options, tc_talk *talk)
{
    const tc_look_options *o = &options->look;
    char why[1024];
    tc_of_mesh_finish(parts);
    parts->there = tc_is_asked(o);
    if (!parts->there)
        return -1;
    tc_look *look = &parts->look;
    look->model = (tc_model)o->model;
    look->shade = o->shade;
    look->shade.gradient = (tc_gradient)o->gradient;
    look->shade.volume = o->model == TC_MODEL_DENSITY_EMITTER;
    look->shade.n_light = o->light.n;
    look->shade.light = o->light.light;
    look->n_plane = o->clip.n;
    look->plane = o->clip.plane;
    look->has_box = o->has_clip_box;
    memcpy(look->box, o->clip_box, sizeof look->box);
    look->select = parts->select;
    tc_isos_make(parts, o);
    int code = tc_geometry_make(parts, mesh, options, talk);
    if (code < 0)
        code = tc_colors_make(parts, mesh, options, talk);
    if (code < 0)
        code = tc_selects_make(parts, mesh, options, talk);
    if (code < 0 && tc_look_wrong(why, sizeof why, look, mesh)) {
        tc_talk_error(talk, "%s: %s", options->input, why);
        code = TC_EXIT_USAGE;
    }
    return code;
}
