/* preset_json.c: reading ParaView's JSON presets.
 * ParaView's own reader takes what strict JSON forbids, and the file it ships (since 6.1) ends with a comma too many:
 * the text is cleaned before jansson sees it. */
#include "transfer_functions/preset_read.h"

#include "core/memory.h"

#include <ctype.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------------ cleaning */

/* Bytes of the UTF-8 character at text[at], 0 when broken. */
static size_t utf8_length(const unsigned char *text, size_t at, size_t length)
{
    const unsigned char first = text[at];
    const size_t n = first < 0x80                    ? 1
                     : first >= 0xC2 && first < 0xE0 ? 2
                     : first >= 0xE0 && first < 0xF0 ? 3
                     : first >= 0xF0 && first < 0xF5 ? 4
                                                     : 0;
    if (n == 0 || at + n > length)
        return 0;
    for (size_t i = 1; i < n; i++)
        if ((text[at + i] & 0xC0) != 0x80)
            return 0;
    if ((first == 0xE0 && text[at + 1] < 0xA0) || (first == 0xED && text[at + 1] > 0x9F) ||
        (first == 0xF0 && text[at + 1] < 0x90) || (first == 0xF4 && text[at + 1] > 0x8F))
        return 0;
    return n;
}

/* Copies a string up to its closing quote; control characters become blanks, broken UTF-8 '?'. */
static size_t clean_string(char *out, size_t *used, const char *text, size_t at, size_t length)
{
    out[(*used)++] = text[at++];
    while (at < length && text[at] != '"') {
        if (text[at] == '\\' && at + 1 < length && (unsigned char)text[at + 1] >= 0x20 &&
            (unsigned char)text[at + 1] < 0x7F) {
            out[(*used)++] = text[at++];
            out[(*used)++] = text[at++];
            continue;
        }
        const size_t n = utf8_length((const unsigned char *)text, at, length);
        if (n == 0 || (unsigned char)text[at] < 0x20) {
            out[(*used)++] = n == 0 ? '?' : ' ';
            at++;
            continue;
        }
        memcpy(out + *used, text + at, n);
        *used += n;
        at += n;
    }
    if (at < length)
        out[(*used)++] = text[at++];
    return at;
}

static size_t skip_comment(const char *text, size_t at, size_t length)
{
    if (text[at] == '#' || (at + 1 < length && text[at] == '/' && text[at + 1] == '/')) {
        while (at < length && text[at] != '\n')
            at++;
    } else if (at + 1 < length && text[at] == '/' && text[at + 1] == '*') {
        for (at += 2; at + 1 < length && !(text[at] == '*' && text[at + 1] == '/'); at++)
            ;
        at = at + 2 < length ? at + 2 : length;
    }
    return at;
}

/* NaN, Infinity and their like (a sign before counts); 0: none of them. */
static size_t nonfinite_length(const char *text, size_t at, size_t length)
{
    static const char *const word[] = {"infinity", "inf", "nan"};
    const size_t sign = text[at] == '-' || text[at] == '+';
    for (int i = 0; i < 3; i++) {
        const size_t n = strlen(word[i]);
        size_t k = 0;
        while (k < n && at + sign + k < length && tolower((unsigned char)text[at + sign + k]) == word[i][k])
            k++;
        if (k == n && (at + sign + n == length || !isalnum((unsigned char)text[at + sign + n])))
            return sign + n;
    }
    return 0;
}

/* Strict JSON of text, no longer than 4 times that; numbers that are none become null. */
static char *clean(const char *text, size_t length, size_t *used)
{
    char *out = tc_alloc(length, 4);
    if (!out)
        return NULL;
    size_t n = 0, at = 0;
    while (at < length) {
        const char c = text[at];
        const size_t after = skip_comment(text, at, length);
        if (after != at) {
            at = after;
        } else if (c == '"') {
            at = clean_string(out, &n, text, at, length);
        } else if (c == ']' || c == '}') {
            while (n > 0 && isspace((unsigned char)out[n - 1]))
                n--;
            if (n > 0 && out[n - 1] == ',')
                n--;
            out[n++] = text[at++];
        } else if (nonfinite_length(text, at, length) > 0) {
            at += nonfinite_length(text, at, length);
            memcpy(out + n, "null", 4);
            n += 4;
        } else {
            out[n++] = text[at++];
        }
    }
    while (n > 0 && (isspace((unsigned char)out[n - 1]) || out[n - 1] == ',' || out[n - 1] == 0))
        n--;
    *used = n;
    return out;
}

/* ------------------------------------------------------------------------------------------------------- reading */

/* A number, or a text that is one (ParaView writes both); NaN for anything else. */
static double number(const json_t *value)
{
    if (json_is_number(value))
        return json_number_value(value);
    if (json_is_string(value)) {
        char *end;
        const char *text = json_string_value(value);
        const double v = strtod(text, &end);
        return end != text && *end == 0 ? v : NAN;
    }
    return NAN;
}

static bool is_on(const json_t *value)
{
    return json_is_true(value) || (json_is_number(value) && json_number_value(value) != 0);
}

static void read_rgb_points(tc_preset *preset, const json_t *array)
{
    for (size_t i = 0; i < preset->n_color; i++) {
        preset->color[i].x = number(json_array_get(array, 4 * i));
        for (size_t c = 0; c < 3; c++)
            preset->color[i].rgb[c] = number(json_array_get(array, 4 * i + 1 + c));
    }
}

/* One band of equal width for each colour. */
static void read_indexed(tc_preset *preset, const json_t *array)
{
    preset->indexed = preset->n_color > 0;
    for (size_t i = 0; i < preset->n_color; i++) {
        preset->color[i].x = (double)((i + 1) / 2);
        for (size_t c = 0; c < 3; c++)
            preset->color[i].rgb[c] = number(json_array_get(array, 3 * (i / 2) + c));
    }
}

static void read_points(tc_preset *preset, const json_t *array)
{
    for (size_t i = 0; i < preset->n_opacity; i++) {
        tc_opacity_point *p = &preset->opacity[i];
        p->x = number(json_array_get(array, 4 * i));
        p->a = number(json_array_get(array, 4 * i + 1));
        p->midpoint = number(json_array_get(array, 4 * i + 2));
        p->sharpness = number(json_array_get(array, 4 * i + 3));
    }
}

/* ParaView's maps of logarithmic scale (UseLogScale) lie over the scalars' logarithms: these are laid over a range. */
static void take_logarithms(double *x, size_t stride, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!(x[stride * i] > 0))
            return;
    for (size_t i = 0; i < n; i++)
        x[stride * i] = log10(x[stride * i]);
}

static tc_preset *read_map(const json_t *map, size_t index)
{
    const json_t *rgb = json_object_get(map, "RGBPoints"), *indexed = json_object_get(map, "IndexedColors");
    const json_t *points = json_object_get(map, "Points"), *nan = json_object_get(map, "NanColor");
    const size_t n_rgb = json_array_size(rgb), n_indexed = json_array_size(indexed), n_points = json_array_size(points);
    const char *name = json_string_value(json_object_get(map, "Name"));
    char unnamed[40];
    snprintf(unnamed, sizeof unnamed, "map %zu", index);
    tc_preset *preset =
        tc_preset_create(name && *name ? name : unnamed, n_rgb ? n_rgb / 4 : 2 * (n_indexed / 3), n_points / 4);
    if (!preset)
        return NULL;
    if (rgb && (!json_is_array(rgb) || n_rgb % 4 != 0))
        tc_preset_set_problem(preset, "its RGBPoints are %zu numbers, not x, r, g, b for each point", n_rgb);
    if (indexed && n_rgb == 0 && (!json_is_array(indexed) || n_indexed % 3 != 0))
        tc_preset_set_problem(preset, "its IndexedColors are %zu numbers, not r, g, b for each colour", n_indexed);
    if (points && !json_is_null(points) && (!json_is_array(points) || n_points % 4 != 0))
        tc_preset_set_problem(preset, "its Points are %zu numbers, not x, opacity, midpoint, sharpness for each point",
                              n_points);
    if (n_rgb)
        read_rgb_points(preset, rgb);
    else
        read_indexed(preset, indexed);
    read_points(preset, points);
    if (n_rgb && preset->n_color && is_on(json_object_get(map, "UseLogScale")))
        take_logarithms(&preset->color[0].x, sizeof *preset->color / sizeof(double), preset->n_color);
    if (preset->n_opacity && is_on(json_object_get(map, "UseLogScale")))
        take_logarithms(&preset->opacity[0].x, sizeof *preset->opacity / sizeof(double), preset->n_opacity);
    if (json_array_size(nan) == 3) {
        preset->has_nan_color = true;
        for (size_t c = 0; c < 3; c++) {
            preset->nan_color[c] = number(json_array_get(nan, c));
            preset->has_nan_color &= preset->nan_color[c] >= 0 && preset->nan_color[c] <= 1;
        }
    }
    const char *space = json_string_value(json_object_get(map, "ColorSpace"));
    if (space && n_rgb)
        tc_preset_set_space(preset, space);
    if (is_on(json_object_get(map, "HSVWrap")))
        preset->hsv_wrap = true;
    tc_preset_complete(preset);
    return preset;
}

tc_status tc_preset_parse_json(tc_preset_list *out, const char *text, size_t length, const char *path, tc_error *err)
{
    size_t used = 0;
    char *strict = clean(text, length, &used);
    if (!strict)
        return tc_fail_memory(err, path, length, 4);
    json_error_t where;
    json_t *root = json_loadb(strict, used, JSON_DECODE_INT_AS_REAL, &where);
    free(strict);
    if (!root)
        return tc_fail(err, TC_E_FILE, "%s is no ParaView preset: line %d of its JSON: %.200s", path, where.line,
                       where.text);
    tc_status status = TC_OK;
    if (json_is_object(root)) {
        status = tc_preset_list_add(out, read_map(root, 0), err);
    } else if (json_is_array(root)) {
        for (size_t i = 0; i < json_array_size(root) && status == TC_OK; i++)
            if (json_is_object(json_array_get(root, i)))
                status = tc_preset_list_add(out, read_map(json_array_get(root, i), i), err);
    } else {
        status = tc_fail(err, TC_E_FILE, "%s is no ParaView preset: its JSON is neither an array nor an object", path);
    }
    json_decref(root);
    return status;
}
