/* look_options.c: the options of a look as one table, and the checks that need no mesh. */
#include "cli/picture/look_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AT(member) .at = offsetof(tc_look_options, member)
#define HAS(member) .has = offsetof(tc_look_options, member) + 1
enum { TC_NUMBERS_MOST = 8, TC_WORD_MOST = 256 };

static const tc_choice tc_model_choice[] = {
    {"density-emitter", TC_MODEL_DENSITY_EMITTER, false},
    {"emission", TC_MODEL_EMISSION, false},
    {"absorption", TC_MODEL_ABSORPTION, false},
    {"mip", TC_MODEL_MAXIMUM, false},
    {"minip", TC_MODEL_MINIMUM, false},
    {"average", TC_MODEL_AVERAGE, false},
    {"xray", TC_MODEL_XRAY, false},
    {"isosurface", TC_MODEL_SURFACES, false},
    {NULL, 0, false},
};
static const tc_choice tc_bar_choice[] = {
    {"right", TC_BAR_RIGHT, false},
    {"left", TC_BAR_LEFT, false},
    {"bottom", TC_BAR_BOTTOM, false},
    {NULL, 0, false},
};
static const tc_choice tc_shade_choice[] = {
    {"off", TC_GRADIENT_NONE, false},
    {"cell", TC_GRADIENT_CELL, false},
    {"vertex", TC_GRADIENT_VERTEX, false},
    {NULL, 0, false},
};

const char *tc_model_name(int model)
{
    const tc_choice *choice = tc_model_choice;
    while (choice->name && choice->value != model)
        choice++;
    return choice->name;
}

/* ----------------------------------------------------------------------------------------------- parts of a value */

/* The text up to the next ';', and *at behind it; false at the end. A ';' at the end begins no other part. */
static bool tc_next_part(tc_part *out, const char **at)
{
    if (!**at)
        return false;
    out->at = *at;
    out->length = strcspn(*at, ";");
    *at += out->length + ((*at)[out->length] == ';');
    return true;
}

/* The numbers of a part: from least to most of them. */
static bool tc_part_reals(double *out, const tc_part *part, int least, int most)
{
    char word[TC_WORD_MOST];
    int n = 0;
    if (part->length >= sizeof word)
        return false;
    snprintf(word, sizeof word, "%.*s", (int)part->length, part->at);
    return tc_parse_reals(out, &n, most, word) && n >= least;
}

bool tc_part_is(const tc_part *part, const char *text)
{
    return part->length == strlen(text) && !memcmp(part->at, text, part->length);
}

char *tc_part_text(const tc_part *part)
{
    char *text = malloc(part->length + 1);
    if (text) {
        memcpy(text, part->at, part->length);
        text[part->length] = 0;
    }
    return text;
}

static bool tc_too_many(char *why, int most)
{
    snprintf(why, 64, "at most %d of them", most);
    return false;
}

static bool tc_unit_range(const double *value, int n, char *why)
{
    for (int i = 0; i < n; i++)
        if (value[i] < 0 || value[i] > 1) {
            snprintf(why, 64, "each from 0 to 1");
            return false;
        }
    return true;
}

static bool tc_some_direction(const double *v, const char *what, char *why)
{
    if (v[0] != 0 || v[1] != 0 || v[2] != 0)
        return true;
    snprintf(why, 64, "%s 0,0,0 points nowhere", what);
    return false;
}

/* --------------------------------------------------------------------------------------------------------- values */

/* From 1 to TC_LOOK_MANY numbers. */
static bool tc_many_reals(double *out, int *n, const char *text, char *why)
{
    int words = 1;
    for (const char *at = text; *at; at++)
        words += *at == ',';
    return words > TC_LOOK_MANY ? tc_too_many(why, TC_LOOK_MANY) : tc_parse_reals(out, n, TC_LOOK_MANY, text);
}

static bool tc_iso_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    return tc_many_reals(out->iso.value, &out->iso.n, text, why);
}

static bool tc_iso_opacity_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    return tc_many_reals(out->iso_opacity.value, &out->iso_opacity.n, text, why) &&
           tc_unit_range(out->iso_opacity.value, out->iso_opacity.n, why);
}

/* field is a tc_color_list. */
static bool tc_colors_parse(void *field, const char *text, char *why)
{
    tc_color_list *out = field;
    tc_part part;
    for (out->n = 0; tc_next_part(&part, &text); out->n++) {
        if (out->n == TC_LOOK_MANY)
            return tc_too_many(why, TC_LOOK_MANY);
        if (!tc_part_reals(out->rgb[out->n], &part, 3, 3) || !tc_unit_range(out->rgb[out->n], 3, why))
            return false;
    }
    return out->n > 0;
}

/* field is double [3] */
static bool tc_color_parse(void *field, const char *text, char *why)
{
    const tc_part part = {text, strlen(text)};
    return tc_part_reals(field, &part, 3, 3) && tc_unit_range(field, 3, why);
}

static bool tc_light_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    tc_part part;
    for (out->light.n = 0; tc_next_part(&part, &text); out->light.n++) {
        if (out->light.n == TC_LIGHTS_MANY)
            return tc_too_many(why, TC_LIGHTS_MANY);
        tc_light *light = &out->light.light[out->light.n];
        *light = (tc_light){.head = tc_part_is(&part, "head"), .color = {1, 1, 1}};
        if (light->head)
            continue;
        if (!tc_part_reals(light->direction, &part, 3, 3) || !tc_some_direction(light->direction, "the direction", why))
            return false;
    }
    return out->light.n > 0;
}

/* Repeats. */
static bool tc_clip_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    tc_part part;
    double v[6];
    int before = out->clip.n;
    for (; tc_next_part(&part, &text); out->clip.n++) {
        if (out->clip.n == TC_LOOK_MANY)
            return tc_too_many(why, TC_LOOK_MANY);
        if (!tc_part_reals(v, &part, 6, 6) || !tc_some_direction(v + 3, "the normal", why))
            return false;
        out->clip.plane[out->clip.n] =
            (tc_plane){.normal = {v[3], v[4], v[5]}, .offset = v[0] * v[3] + v[1] * v[4] + v[2] * v[5]};
    }
    return out->clip.n > before;
}

static bool tc_clip_box_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    const tc_part part = {text, strlen(text)};
    if (!tc_part_reals(out->clip_box, &part, 6, 6))
        return false;
    for (int i = 0; i < 6; i += 2)
        if (!(out->clip_box[i] < out->clip_box[i + 1])) {
            snprintf(why, 64, "X0 below X1, Y0 below Y1, Z0 below Z1");
            return false;
        }
    return true;
}

/* V or LO,HI */
static bool tc_range_parse(tc_range_choice *out, const tc_part *part, char *why)
{
    double v[2];
    if (tc_part_reals(v, part, 2, 2)) {
        out->lo = v[0];
        out->hi = v[1];
    } else if (tc_part_reals(v, part, 1, 1)) {
        out->lo = out->hi = v[0];
    } else {
        return false;
    }
    if (!(out->lo <= out->hi)) {
        snprintf(why, 64, "LO not above HI");
        return false;
    }
    return true;
}

/* NAME:LO,HI or NAME:V; NAME may hold colons. Repeats. */
static bool tc_select_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    tc_part part;
    int before = out->select.n;
    for (; tc_next_part(&part, &text); out->select.n++) {
        size_t colon = part.length;
        while (colon > 0 && part.at[colon - 1] != ':')
            colon--;
        if (out->select.n == TC_LOOK_MANY)
            return tc_too_many(why, TC_LOOK_MANY);
        if (colon < 2)
            return false;
        const tc_part numbers = {part.at + colon, part.length - colon};
        tc_range_choice *range = &out->select.range[out->select.n];
        range->name = (tc_part){part.at, colon - 1};
        if (!tc_range_parse(range, &numbers, why))
            return false;
    }
    return out->select.n > before;
}

/* N, FROM:TO or a name, comma separated. */
static bool tc_blocks_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    out->blocks.n = 0;
    for (const char *at = text; *at; out->blocks.n++) {
        const size_t length = strcspn(at, ","), colon = strcspn(at, ":,");
        if (out->blocks.n == TC_LOOK_MANY)
            return tc_too_many(why, TC_LOOK_MANY);
        tc_range_choice *range = &out->blocks.range[out->blocks.n];
        *range = (tc_range_choice){0};
        const tc_part first = {at, colon}, last = {at + colon + 1, length - colon - 1};
        const bool one = tc_part_reals(&range->lo, &first, 1, 1);
        range->hi = range->lo;
        if (length == 0)
            return false;
        if (!one || (colon < length && !tc_part_reals(&range->hi, &last, 1, 1)))
            *range = (tc_range_choice){.name = {at, length}};
        else if (range->lo != floor(range->lo) || range->hi != floor(range->hi) || range->lo > range->hi) {
            snprintf(why, 64, "whole numbers, FROM not above TO");
            return false;
        }
        at += length;
        if (*at == ',' && !*++at)
            return false;
    }
    return out->blocks.n > 0;
}

/* FILE or FILE,OPACITY. Repeats. */
static bool tc_geometry_parse(void *field, const char *text, char *why)
{
    tc_look_options *out = field;
    const char *comma = strrchr(text, ',');
    if (out->geometry.n == TC_LOOK_MANY)
        return tc_too_many(why, TC_LOOK_MANY);
    tc_geometry_choice *one = &out->geometry.file[out->geometry.n];
    *one = (tc_geometry_choice){{text, strlen(text)}, 1};
    if (comma && tc_parse_real(&one->opacity, comma + 1)) {
        one->file.length = (size_t)(comma - text);
        if (!tc_unit_range(&one->opacity, 1, why)) {
            snprintf(why, 64, "OPACITY from 0 to 1");
            return false;
        }
    }
    if (one->file.length == 0)
        return false;
    out->geometry.n++;
    return true;
}

/* clang-format off */
const tc_option tc_look_option[] = {
    {.help = "What is shown"},
    {"--model", 0, "density-emitter|emission|absorption|mip|minip|average|xray|isosurface", "how light and matter act along a ray; default density-emitter", TC_OPTION_CHOICE, AT(model), .choice = tc_model_choice},
    {"--iso", 0, "V[,V…]", "surfaces on which the scalar has these values; with --model isosurface they alone", TC_OPTION_CUSTOM, .at = 0, .parse = tc_iso_parse},
    {"--iso-color", 0, "R,G,B[;…]", "of each of them, or one for all; default the map's colours there", TC_OPTION_CUSTOM, AT(iso_color), .parse = tc_colors_parse},
    {"--iso-opacity", 0, "A[,A…]", "of each of them, or one for all; default 1", TC_OPTION_CUSTOM, .at = 0, .parse = tc_iso_opacity_parse},
    {"--color-field", 0, "NAME[:COMPONENT]", "the array that --color-map colours, while --field gives the opacity", TC_OPTION_TEXT, AT(color_field)},
    {"--color-range", 0, "LO,HI", "its values that the map spans; default its range", TC_OPTION_REALS, AT(color_range), HAS(has_color_range), .n = 2},
    {"--categories", 0, "V:R,G,B[,A][:NAME];…|FILE", "a colour, attenuation A (1) and a name for the colour bar for each value, as of material numbers; a file of such lines, or a ParaView preset with IndexedColors", TC_OPTION_TEXT, AT(categories)},
    {.help = "Light"},
    {"--shade", 0, "off|cell|vertex", "light by gradients: flat in each cell, or smooth across cells; default off", TC_OPTION_CHOICE, AT(gradient), .choice = tc_shade_choice},
    {"--light", 0, "head|X,Y,Z[;…]", "from the eye, or towards the light in this direction; default head", TC_OPTION_CUSTOM, .at = 0, .parse = tc_light_parse},
    {"--ambient", 0, "K", "share of the colour without light; default 0.2", TC_OPTION_REAL, AT(shade.ambient), .low = 0, .high = 100},
    {"--diffuse", 0, "K", "share with light; default 0.8", TC_OPTION_REAL, AT(shade.diffuse), .low = 0, .high = 100},
    {"--specular", 0, "K", "strength of highlights; default 0.2", TC_OPTION_REAL, AT(shade.specular), .low = 0, .high = 100},
    {"--specular-power", 0, "P", "the greater, the smaller they are; default 20", TC_OPTION_REAL, AT(shade.power), .low = 0, .high = 1e6, .open = true},
    {"--one-sided", 0, NULL, "only sides towards the light are lit; default both", TC_OPTION_FLAG, AT(shade.one_sided)},
    {"--shade-magnitude", 0, "M", "gradients below M times the mean one give less light, so that flat regions do not sparkle; default 1, 0: all the same", TC_OPTION_REAL, AT(shade.magnitude), .low = 0, .high = 1e9},
    {.help = "Cutting and selection"},
    {"--clip", 0, "X,Y,Z,NX,NY,NZ[;…]", "keep the side of a plane through X,Y,Z that the normal NX,NY,NZ points to; cells are cut", TC_OPTION_CUSTOM, .at = 0, .repeat = true, .parse = tc_clip_parse},
    {"--clip-box", 0, "X0,X1,Y0,Y1,Z0,Z1", "keep what lies in this box", TC_OPTION_CUSTOM, .at = 0, HAS(has_clip_box), .parse = tc_clip_box_parse},
    {"--select", 0, "NAME:LO,HI|NAME:V[;…]", "keep whole cells with values of this array in the range; ranges of one array add up, of several arrays all must hold", TC_OPTION_CUSTOM, .at = 0, .repeat = true, .parse = tc_select_parse},
    {"--blocks", 0, "N|FROM:TO|NAME[,…]", "keep the cells of these blocks (tetcast info tells numbers and names)", TC_OPTION_CUSTOM, .at = 0, .parse = tc_blocks_parse},
    {.help = "Geometry in the picture"},
    {"--outline", 0, NULL, "the edges of the mesh's bounding box", TC_OPTION_FLAG, AT(outline)},
    {"--wireframe", 0, NULL, "the edges of the mesh's boundary", TC_OPTION_FLAG, AT(wireframe)},
    {"--surface", 0, "[OPACITY]", "the mesh's boundary, lit; default 1", TC_OPTION_REAL, AT(surface), HAS(has_surface), .low = 0, .high = 1, .optional = true},
    {"--geometry", 0, "FILE[,OPACITY]", "triangles and lines of another file; may be repeated", TC_OPTION_CUSTOM, .at = 0, .repeat = true, .parse = tc_geometry_parse},
    {"--geometry-color", 0, "R,G,B[;…]", "of each of these files, or one for all; default a light grey", TC_OPTION_CUSTOM, AT(geometry_color), .parse = tc_colors_parse},
    {"--line-color", 0, "R,G,B", "of --outline and --wireframe; default black, on a dark --background white", TC_OPTION_CUSTOM, AT(line_color), HAS(has_line_color), .parse = tc_color_parse},
    {"--surface-color", 0, "R,G,B", "of --surface; default a light grey", TC_OPTION_CUSTOM, AT(surface_color), HAS(has_surface_color), .parse = tc_color_parse},
    {.help = "Figure"},
    {"--title", 0, "TEXT", "above the picture", TC_OPTION_TEXT, AT(title)},
    {"--color-bar", 0, NULL, "what the colours stand for", TC_OPTION_FLAG, AT(color_bar)},
    {"--color-bar-place", 0, "right|left|bottom", "default right", TC_OPTION_CHOICE, AT(bar_place), .choice = tc_bar_choice},
    {"--color-bar-opacity", 0, NULL, "with the opacity in a strip beside it", TC_OPTION_FLAG, AT(bar_opacity)},
    {"--axes", 0, NULL, "ticks along the mesh's bounding box", TC_OPTION_FLAG, AT(axes)},
    {"--triad", 0, NULL, "arrows of x, y and z in a corner", TC_OPTION_FLAG, AT(triad)},
    {"--text-size", 0, "PX", "of letters, in pixels; default 1/44 of the picture's height, 10 at least", TC_OPTION_REAL, AT(text_size), .low = 4, .high = 1000},
};
/* clang-format on */
_Static_assert(sizeof tc_look_option == TC_N_LOOK_OPTION * sizeof *tc_look_option, "rows of the table");

/* --------------------------------------------------------------------------------------------------------- checks */

void tc_look_options_defaults(tc_look_options *out)
{
    memset(out, 0, sizeof *out);
    tc_shade_defaults(&out->shade);
}

/* Does an option stand without one that it belongs to? A scene's own may, where that was put off. */
static bool tc_stands_alone(const tc_given_list *given, const char *option, const char *const *of, size_t n)
{
    bool off = false;
    for (size_t i = 0; i < n; i++)
        off = off || tc_is_put_off(given, of[i]);
    return tc_is_given(given, option) && (!off || tc_is_of_line(given, option));
}

static int tc_needs(const tc_given_list *given, tc_talk *talk, const char *option, const char *with, const char *what)
{
    return tc_given_refuse(given, talk, option, with, "%s %s", option, what);
}

/* One for all, or one each. */
static int tc_count_check(int n, int of, const char *option, const char *each, const tc_given_list *given,
                          tc_talk *talk)
{
    if (n <= 1 || n == of)
        return -1;
    return tc_given_refuse(given, talk, option, each,
                           "%s has %d, but there are %d of %s: give one for all, or one each", option, n, of, each);
}

int tc_look_options_check(const tc_look_options *o, const tc_given_list *given, tc_talk *talk)
{
    static const char *const lit[] = {"--light",          "--ambient",   "--diffuse",        "--specular",
                                      "--specular-power", "--one-sided", "--shade-magnitude"};
    static const char *const lights[] = {"--shade", "--surface"}, *const lines[] = {"--outline", "--wireframe"},
                             *const surface[] = {"--surface"}, *const bar[] = {"--color-bar"},
                             *const of_bar[] = {"--color-bar-place", "--color-bar-opacity"},
                             *const of_iso[] = {"--iso-color", "--iso-opacity"};
    const bool surfaces = o->has_surface || o->geometry.n > 0;
    for (size_t i = 0; i < sizeof lit / sizeof *lit; i++)
        if (o->gradient == TC_GRADIENT_NONE && !surfaces && tc_stands_alone(given, lit[i], lights, 2))
            return tc_needs(given, talk, lit[i], NULL,
                            "acts on what is lit: give --shade cell or vertex, --surface or --geometry");
    if (o->has_color_range && !(o->color_range[0] < o->color_range[1]))
        return tc_given_refuse(given, talk, "--color-range", NULL,
                               "--color-range takes LO,HI with LO below HI, not %g,%g", o->color_range[0],
                               o->color_range[1]);
    if (o->has_color_range && !o->color_field)
        return tc_needs(given, talk, "--color-range", NULL,
                        "is of --color-field: give that too, or --range in its place");
    if (o->categories && o->has_color_range)
        return tc_needs(given, talk, "--color-range", "--categories",
                        "lays out a colour map, while --categories colours value by value: "
                        "leave one out");
    if (o->categories && tc_is_given(given, "--color-map"))
        return tc_needs(given, talk, "--color-map", "--categories",
                        "and --categories both give the colours: leave one out");
    for (int i = 0; o->categories && !o->color_field && i < 3; i++) {
        static const char *const other[] = {"--opacity", "--range", "--log"};
        if (tc_is_given(given, other[i]))
            return tc_needs(given, talk, other[i], "--categories",
                            "is of a colour map, while --categories gives each value its colour and "
                            "attenuation: leave one out, or give --color-field for the categories");
    }
    for (int i = 0; o->iso.n == 0 && i < 2; i++)
        if (tc_is_given(given, of_iso[i]))
            return tc_needs(given, talk, of_iso[i], NULL, "is of --iso: give the values of surfaces");
    if (o->model == TC_MODEL_SURFACES && o->iso.n == 0 && !surfaces && !o->wireframe && !o->outline)
        return tc_needs(given, talk, "--model", "--surface",
                        "isosurface shows surfaces alone: give --iso V[,V…], --surface or --geometry");
    if (tc_is_given(given, "--geometry-color") && o->geometry.n == 0)
        return tc_needs(given, talk, "--geometry-color", NULL,
                        "is of --geometry: give a file, or --surface-color, --line-color");
    if (!o->has_surface && tc_stands_alone(given, "--surface-color", surface, 1))
        return tc_needs(given, talk, "--surface-color", NULL, "is of --surface: give that too");
    if (!o->outline && !o->wireframe && tc_stands_alone(given, "--line-color", lines, 2))
        return tc_needs(given, talk, "--line-color", NULL, "is of --outline and --wireframe: give one of them");
    for (int i = 0; !o->color_bar && i < 2; i++)
        if (tc_stands_alone(given, of_bar[i], bar, 1))
            return tc_needs(given, talk, of_bar[i], NULL, "is of --color-bar: give that too");
    int code = tc_count_check(o->iso_color.n, o->iso.n, "--iso-color", "--iso", given, talk);
    if (code < 0)
        code = tc_count_check(o->iso_opacity.n, o->iso.n, "--iso-opacity", "--iso", given, talk);
    if (code < 0)
        code = tc_count_check(o->geometry_color.n, o->geometry.n, "--geometry-color", "--geometry", given, talk);
    return code;
}
