/* create.c: transfer functions from names, presets and opacity curves, and writing them back. */
#define _POSIX_C_SOURCE 200809L
#include "transfer_functions/transfer.h"

#include "core/memory.h"
#include "transfer_functions/builtin.h"
#include "transfer_functions/preset.h"
#include "transfer_functions/preset_read.h"
#include "transfer_functions/resolve.h"

#include <ctype.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* Default opacity: 0 at the range's start, 0.3 at its end. */
static const tc_opacity_point linear_curve[2] = {{0, 0, 0.5, 0}, {1, 0.3, 0.5, 0}};

/* -------------------------------------------------------------------------------------------------------- range */

static tc_status choose_range(double out[2], const tc_transfer_options *options, tc_error *err)
{
    const double *range = options->has_range ? options->range : options->data_range;
    out[0] = range[0];
    out[1] = range[1];
    if (!options->has_range && !(isfinite(out[0]) && isfinite(out[1]) && out[0] <= out[1])) {
        out[0] = 0; /* a field without a finite value */
        out[1] = 1;
    }
    if (!isfinite(out[0]) || !isfinite(out[1]) || out[0] > out[1])
        return tc_fail(err, TC_E_ARG, "the transfer function's range %g to %g must be finite and ascending", out[0],
                       out[1]);
    if (options->log && !(out[0] > 0))
        return tc_fail(err, TC_E_ARG,
                       "a logarithmic colour map needs a range above 0, not %g to %g; give --range LO,HI with LO > 0",
                       out[0], out[1]);
    if (out[0] == out[1]) { /* one value: the map's centre lies on it */
        const double centre = out[0], widen = centre != 0 ? fabs(centre) / 1024 : 0.5;
        out[0] = centre - widen;
        out[1] = centre + widen;
        if (!(isfinite(out[0]) && isfinite(out[1]) && out[0] < out[1]))
            return tc_fail(err, TC_E_ARG, "no range can be laid around the single scalar %g; give --range LO,HI",
                           centre);
    }
    return TC_OK;
}

/* ---------------------------------------------------------------------------------------------------- colour map */

static bool looks_like_file(const char *name)
{
    const size_t n = strlen(name);
    return strchr(name, '/') || (n > 5 && strcasecmp(name + n - 5, ".json") == 0) ||
           (n > 4 && strcasecmp(name + n - 4, ".xml") == 0) || access(name, F_OK) == 0;
}

static tc_preset *copy_preset(const tc_preset *from)
{
    tc_preset *copy = tc_preset_create(from->name, from->n_color, from->n_opacity);
    if (!copy)
        return NULL;
    memcpy(copy->color, from->color, from->n_color * sizeof *copy->color);
    if (from->n_opacity)
        memcpy(copy->opacity, from->opacity, from->n_opacity * sizeof *copy->opacity);
    copy->space = from->space;
    copy->hsv_wrap = from->hsv_wrap;
    copy->indexed = from->indexed;
    copy->sorted = from->sorted;
    copy->has_nan_color = from->has_nan_color;
    memcpy(copy->nan_color, from->nan_color, sizeof copy->nan_color);
    return copy;
}

/* Is it the text of a preset, not a name? */
static bool is_preset_text(const char *text)
{
    return *text == '{' || *text == '[';
}

/* Of a file, or of the text of one, which is the caller's argument. */
static tc_status load_preset(tc_preset **out, const char *from, const char *name, tc_error *err)
{
    tc_preset_list list = {0};
    const bool text = is_preset_text(from);
    const char *path = text ? "the colour map's text" : from;
    tc_status status = text ? tc_preset_parse(&list, from, strlen(from), path, err) : tc_preset_read(&list, path, err);
    const tc_preset *chosen;
    if (status == TC_OK)
        status = tc_preset_choose(&chosen, &list, name, path, err);
    if (status == TC_OK && !(*out = copy_preset(chosen)))
        status = tc_fail_memory(err, path, chosen->n_color, sizeof *chosen->color);
    tc_preset_list_finish(&list);
    if (text && status == TC_E_FILE) {
        status = TC_E_ARG;
        if (err)
            err->code = status;
    }
    return status;
}

/* Of the built-in map of that name; their number: none is. */
static size_t builtin_index(const char *name)
{
    size_t n, i = 0;
    const char *const *builtin = tc_transfer_builtin(&n);
    while (i < n && !tc_preset_name_equal(builtin[i], name))
        i++;
    return i;
}

static tc_status load_color_map(tc_preset **out, const tc_transfer_options *options, tc_error *err)
{
    const char *name = options->color_map && *options->color_map ? options->color_map : "Cool to Warm";
    size_t n;
    const char *const *builtin = tc_transfer_builtin(&n);
    const size_t i = builtin_index(name);
    if (i < n && options->preset)
        return tc_fail(err, TC_E_ARG,
                       "the preset \"%.80s\" is of a file, but the colour map \"%s\" is a built-in one: leave "
                       "the preset out, or give a .json or .xml file as the colour map",
                       options->preset, builtin[i]);
    if (i < n) {
        *out = tc_builtin_preset(i);
        return *out ? TC_OK : tc_fail_memory(err, "a built-in colour map", 1, sizeof **out);
    }
    if (is_preset_text(name) || looks_like_file(name))
        return load_preset(out, name, options->preset, err);
    char nearest[300];
    tc_preset_nearest(nearest, sizeof nearest, builtin, n, name);
    return tc_fail(err, TC_E_ARG,
                   "there is no colour map \"%.80s\"; the nearest built-in ones are %s; or give a .json or .xml file",
                   name, nearest);
}

/* Names and texts of those in the list that can be used. */
static tc_status texts_of(tc_text_pair **out, size_t *n, const tc_preset_list *list, const char *path, tc_error *err)
{
    char **text = tc_calloc(list->n, sizeof *text);
    size_t bytes = 0, used = 0;
    tc_text_pair *pair = NULL;
    tc_status status = text ? TC_OK : tc_fail_memory(err, path, list->n, sizeof *text);
    for (size_t i = 0; i < list->n && status == TC_OK; i++) {
        if (list->preset[i]->problem)
            continue;
        if (!(text[i] = tc_preset_text(list->preset[i])))
            status = tc_fail_memory(err, path, list->preset[i]->n_color, 100);
        else
            bytes += strlen(list->preset[i]->name) + strlen(text[i]) + 2;
    }
    if (status == TC_OK && bytes == 0) {
        const tc_preset *any;
        status = tc_preset_choose(&any, list, NULL, path, err); /* says what is wrong with the first */
    }
    if (status == TC_OK && !(pair = tc_alloc(list->n * sizeof *pair + bytes, 1)))
        status = tc_fail_memory(err, path, bytes, 1);
    char *at = pair ? (char *)(pair + list->n) : NULL;
    for (size_t i = 0; i < list->n && status == TC_OK; i++) {
        if (!text[i])
            continue;
        const size_t name = strlen(list->preset[i]->name) + 1, length = strlen(text[i]) + 1;
        memcpy(at, list->preset[i]->name, name);
        memcpy(at + name, text[i], length);
        pair[used++] = (tc_text_pair){at, at + name};
        at += name + length;
    }
    for (size_t i = 0; text && i < list->n; i++)
        free(text[i]);
    free(text);
    *out = pair;
    *n = used;
    return status;
}

tc_status tc_transfer_presets(tc_text_pair **out, size_t *n, const char *color_map, tc_error *err)
{
    tc_preset_list list = {0};
    tc_status status;
    if (!out || !n)
        return tc_fail(err, TC_E_ARG, "no place to put the colour maps");
    *out = NULL;
    *n = 0;
    size_t builtin;
    tc_transfer_builtin(&builtin);
    const char *path = color_map && *color_map ? color_map : "Cool to Warm";
    const bool text = is_preset_text(path);
    if (text) {
        path = "the colour map's text";
        status = tc_preset_parse(&list, color_map, strlen(color_map), path, err);
    } else if (builtin_index(path) == builtin && looks_like_file(path)) {
        status = tc_preset_read(&list, path, err);
    } else {
        const tc_transfer_options one = {.color_map = path};
        tc_preset *map = NULL;
        status = load_color_map(&map, &one, err);
        status = status == TC_OK ? tc_preset_list_add(&list, map, err) : status;
    }
    if (status == TC_OK)
        status = texts_of(out, n, &list, path, err);
    tc_preset_list_finish(&list);
    if (text && status == TC_E_FILE) {
        status = TC_E_ARG;
        if (err)
            err->code = status;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------- opacity */

typedef struct curve {
    tc_opacity_kind kind;
    tc_opacity_point *point; /* owned */
    size_t n;
} curve;

/* "S:A,S:A,…". */
static tc_status parse_list(curve *out, const char *text, tc_error *err)
{
    size_t most = 1;
    for (const char *c = text; *c; c++)
        most += *c == ',';
    out->kind = TC_OPACITY_SCALARS;
    out->point = tc_calloc(most, sizeof *out->point);
    if (!out->point)
        return tc_fail_memory(err, "opacity points", most, sizeof *out->point);
    for (const char *at = text;; at++) {
        char *end = NULL;
        const double s = strtod(at, &end);
        const char *after_s = end;
        const double a = *after_s == ':' && end != at ? strtod(after_s + 1, &end) : NAN;
        if (end == after_s || (*after_s == ':' && end == after_s + 1))
            return tc_fail(err, TC_E_ARG,
                           "opacity \"%.200s\": point %zu is not SCALAR:ATTENUATION; write S:A,S:A,… as in 0:0,1.5:0.3",
                           text, out->n + 1);
        while (isspace((unsigned char)*end))
            end++;
        if (!isfinite(s) || !isfinite(a) || a < 0)
            return tc_fail(err, TC_E_ARG, "opacity \"%.200s\": point %zu must be finite, its attenuation 0 or more",
                           text, out->n + 1);
        out->point[out->n++] = (tc_opacity_point){.x = s, .a = a, .midpoint = 0.5};
        at = end;
        if (*at == 0)
            break;
        if (*at != ',')
            return tc_fail(err, TC_E_ARG, "opacity \"%.200s\": a comma belongs after point %zu", text, out->n);
        if (at[1] == 0)
            break;
    }
    /* Stable, few: by insertion. */
    for (size_t i = 1; i < out->n; i++) {
        const tc_opacity_point p = out->point[i];
        size_t k = i;
        for (; k > 0 && out->point[k - 1].x > p.x; k--)
            out->point[k] = out->point[k - 1];
        out->point[k] = p;
    }
    return TC_OK;
}

static tc_status take_points(curve *out, const tc_opacity_point *point, size_t n, tc_error *err)
{
    out->kind = TC_OPACITY_POINTS;
    out->point = tc_alloc(n, sizeof *out->point);
    if (!out->point)
        return tc_fail_memory(err, "opacity points", n, sizeof *out->point);
    memcpy(out->point, point, n * sizeof *point);
    out->n = n;
    return TC_OK;
}

static tc_status load_opacity(curve *out, const tc_transfer_options *options, const tc_preset *map, tc_error *err)
{
    const char *text = options->opacity;
    if (!text || !*text)
        return map->n_opacity > 0 ? take_points(out, map->opacity, map->n_opacity, err)
                                  : take_points(out, linear_curve, 2, err);
    if (strcasecmp(text, "linear") == 0)
        return take_points(out, linear_curve, 2, err);
    if (strcasecmp(text, "geom") == 0 || strcasecmp(text, "sigmoid") == 0) {
        out->kind = strcasecmp(text, "geom") == 0 ? TC_OPACITY_GEOM : TC_OPACITY_SIGMOID;
        return TC_OK;
    }
    if (access(text, F_OK) != 0 && (strchr(text, ':') || isdigit((unsigned char)*text))) {
        const locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
        const locale_t before = plain ? uselocale(plain) : (locale_t)0;
        const tc_status status = parse_list(out, text, err);
        if (plain) {
            uselocale(before);
            freelocale(plain);
        }
        return status;
    }
    if (!looks_like_file(text))
        return tc_fail(err, TC_E_ARG, "opacity \"%.80s\" is neither linear, geom, sigmoid, a list S:A,S:A,… nor a file",
                       text);
    tc_preset *file = NULL;
    tc_status status = load_preset(&file, text, NULL, err);
    if (status == TC_OK && file->n_opacity == 0)
        status = tc_fail(err, TC_E_FILE, "%s has no opacity: its map \"%.80s\" lacks Points", text, file->name);
    if (status == TC_OK)
        status = take_points(out, file->opacity, file->n_opacity, err);
    tc_preset_destroy(&file);
    return status;
}

/* ----------------------------------------------------------------------------------------------------- the whole */

static double in_range(double x, double first, double last, const double range[2])
{
    const double u = last > first ? (x - first) / (last - first) : 0;
    return u >= 1 ? range[1] : range[0] * (1 - u) + range[1] * u;
}

/* x of the preset's points become scalars; its opacity becomes the curve in force. Both get points at both ends of what
 * they span together, since readers lay each over the whole range. */
static tc_preset *preset_in_scalars(const tc_preset *map, const curve *opacity, const double range[2])
{
    tc_preset *preset = tc_preset_create(map->name, map->n_color + 2, opacity->n + 2);
    if (!preset)
        return NULL;
    preset->space = map->space;
    preset->hsv_wrap = map->hsv_wrap;
    preset->has_nan_color = map->has_nan_color;
    memcpy(preset->nan_color, map->nan_color, sizeof preset->nan_color);
    tc_color_point *color = preset->color + 1;
    tc_opacity_point *point = preset->opacity + 1;
    for (size_t i = 0; i < map->n_color; i++) {
        color[i] = map->color[i];
        color[i].x = in_range(color[i].x, map->color[0].x, map->color[map->n_color - 1].x, range);
    }
    for (size_t i = 0; i < opacity->n; i++) {
        point[i] = opacity->point[i];
        if (opacity->kind == TC_OPACITY_POINTS)
            point[i].x = in_range(point[i].x, opacity->point[0].x, opacity->point[opacity->n - 1].x, range);
    }
    const size_t last_color = map->n_color - 1, last_point = opacity->n - 1;
    preset->color[0] = color[0];
    preset->opacity[0] = point[0];
    color[last_color + 1] = color[last_color];
    point[last_point + 1] = point[last_point];
    preset->color[0].x = preset->opacity[0].x = fmin(range[0], fmin(color[0].x, point[0].x));
    color[last_color + 1].x = point[last_point + 1].x = fmax(range[1], fmax(color[last_color].x, point[last_point].x));
    preset->color[0].midpoint = preset->opacity[0].midpoint = 0.5;
    preset->color[0].sharpness = preset->opacity[0].sharpness = 0;
    /* The added points go again where they repeat what is there. */
    const bool more_color = preset->color[0].x < color[0].x, more_point = preset->opacity[0].x < point[0].x;
    preset->n_color = map->n_color + more_color + (color[last_color + 1].x > color[last_color].x);
    preset->n_opacity = opacity->n + more_point + (point[last_point + 1].x > point[last_point].x);
    if (!more_color)
        memmove(preset->color, color, preset->n_color * sizeof *color);
    if (!more_point)
        memmove(preset->opacity, point, preset->n_opacity * sizeof *point);
    return preset;
}

tc_status tc_transfer_create(tc_transfer **out, const tc_transfer_options *options, tc_error *err)
{
    if (!out || !options)
        return tc_fail(err, TC_E_ARG, "no transfer function's options, or no place to put it");
    *out = NULL;
    double range[2];
    tc_status status = choose_range(range, options, err);
    if (status != TC_OK)
        return status;
    tc_preset *map = NULL;
    curve opacity = {.kind = TC_OPACITY_POINTS};
    tc_transfer *tf = NULL;
    tc_knot *knot = NULL;
    size_t n = 0;
    status = load_color_map(&map, options, err);
    if (status == TC_OK)
        status = load_opacity(&opacity, options, map, err);
    if (status != TC_OK)
        goto done;
    const tc_resolve_input input = {.map = map,
                                    .kind = opacity.kind,
                                    .n_opacity = opacity.n,
                                    .opacity = opacity.point,
                                    .range = {range[0], range[1]},
                                    .log = options->log};
    status = tc_resolve(&knot, &n, &input, err);
    if (status == TC_OK)
        status = tc_transfer_from_knots(&tf, knot, n, err);
    if (status != TC_OK)
        goto done;
    const bool formula = opacity.kind == TC_OPACITY_GEOM || opacity.kind == TC_OPACITY_SIGMOID;
    char *name = tc_strdup(map->name);
    if (name) {
        free(tf->name);
        tf->name = name;
    }
    if (map->has_nan_color)
        memcpy(tf->nan_color, map->nan_color, sizeof map->nan_color);
    if (!options->log && !formula) /* else it is written as knots */
        tf->preset = preset_in_scalars(map, &opacity, range);
    if (!name || (!options->log && !formula && !tf->preset)) {
        status = tc_fail_memory(err, "a transfer function", n, sizeof *knot);
        goto done;
    }
    *out = tf;
    tf = NULL;
done:
    tc_transfer_destroy(&tf);
    tc_preset_destroy(&map);
    free(opacity.point);
    free(knot);
    return status;
}

/* The knots as a preset of straight lines. */
static tc_preset *preset_of_knots(const tc_transfer *tf)
{
    tc_preset *preset = tc_preset_create(tf->name, tf->n, tf->n);
    for (size_t i = 0; preset && i < tf->n; i++) {
        const tc_knot *k = &tf->knot[i];
        preset->color[i] = (tc_color_point){.x = k->s, .rgb = {k->r, k->g, k->b}, .midpoint = 0.5};
        preset->opacity[i] = (tc_opacity_point){.x = k->s, .a = k->a, .midpoint = 0.5};
    }
    if (preset) {
        preset->has_nan_color = true;
        memcpy(preset->nan_color, tf->nan_color, sizeof preset->nan_color);
    }
    return preset;
}

tc_status tc_transfer_write(const tc_transfer *tf, const char *path, tc_error *err)
{
    if (!tf || !path || !*path)
        return tc_fail(err, TC_E_ARG, "no transfer function to write, or no file to write it to");
    const size_t length = strlen(path);
    const bool xml = length >= 4 && strcasecmp(path + length - 4, ".xml") == 0;
    if (tf->preset && !xml)
        return tc_preset_write(tf->preset, path, err);
    tc_preset *preset = preset_of_knots(tf); /* XML has one opacity a colour point, and no midpoints */
    if (!preset)
        return tc_fail_memory(err, path, tf->n, sizeof *tf->knot);
    const tc_status status = tc_preset_write(preset, path, err);
    tc_preset_destroy(&preset);
    return status;
}
