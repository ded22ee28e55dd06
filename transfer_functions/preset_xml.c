/* preset_xml.c: reading ParaView's XML colour maps.
 *   <ColorMap name="…" space="Lab"> <Point x="0" o="1" r="0" g="0" b="0"/> … <NaN r="1" g="0" b="0"/> </ColorMap>
 * in any element around them. Opacities count where all points have one and they are not all 1 (older files fill in 1).
 */
#include "transfer_functions/preset_read.h"

#include "core/memory.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ATTRIBUTES = 16, VALUE = 256 };

typedef struct element {
    char name[64];
    bool closing, empty; /* </name>, <name/> */
    int n;
    char key[ATTRIBUTES][32], value[ATTRIBUTES][VALUE];
} element;

typedef struct scan {
    const char *at, *end;
    size_t line;
} scan;

static void step(scan *s)
{
    s->line += *s->at == '\n';
    s->at++;
}

static bool starts(const scan *s, const char *text)
{
    const size_t n = strlen(text);
    return (size_t)(s->end - s->at) >= n && memcmp(s->at, text, n) == 0;
}

static void skip_past(scan *s, const char *text)
{
    while (s->at < s->end && !starts(s, text))
        step(s);
    for (size_t n = strlen(text); n > 0 && s->at < s->end; n--)
        step(s);
}

static void skip_space(scan *s)
{
    while (s->at < s->end && isspace((unsigned char)*s->at))
        step(s);
}

static bool is_name(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '-' || c == ':' || c == '.';
}

static void take_name(char *out, size_t capacity, scan *s)
{
    size_t n = 0;
    for (; s->at < s->end && is_name(*s->at); step(s))
        if (n + 1 < capacity)
            out[n++] = *s->at;
    out[n] = 0;
}

/* The five named entities; others stay as they are. */
static void take_value(char *out, scan *s, char quote)
{
    static const char *const entity[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"};
    static const char plain[] = "&<>\"'";
    size_t n = 0;
    while (s->at < s->end && *s->at != quote) {
        char c = *s->at;
        size_t length = 1;
        for (int i = 0; i < 5; i++)
            if (starts(s, entity[i])) {
                c = plain[i];
                length = strlen(entity[i]);
            }
        if (n + 1 < VALUE)
            out[n++] = c;
        for (; length > 0; length--)
            step(s);
    }
    out[n] = 0;
}

/* Next element; false at the end of text. *broken names what is wrong. */
static bool next_element(element *out, scan *s, const char **broken)
{
    for (;;) {
        while (s->at < s->end && *s->at != '<')
            step(s);
        if (s->at == s->end)
            return false;
        if (starts(s, "<!--"))
            skip_past(s, "-->");
        else if (starts(s, "<?"))
            skip_past(s, "?>");
        else if (starts(s, "<!"))
            skip_past(s, ">");
        else
            break;
    }
    step(s);
    out->n = 0;
    out->empty = false;
    out->closing = s->at < s->end && *s->at == '/';
    if (out->closing)
        step(s);
    take_name(out->name, sizeof out->name, s);
    for (;;) {
        skip_space(s);
        if (s->at == s->end) {
            *broken = "an element is not closed";
            return false;
        }
        if (*s->at == '>') {
            step(s);
            return true;
        }
        if (*s->at == '/') {
            out->empty = true;
            step(s);
            continue;
        }
        const int i = out->n < ATTRIBUTES ? out->n : ATTRIBUTES - 1;
        take_name(out->key[i], sizeof out->key[i], s);
        skip_space(s);
        if (out->key[i][0] == 0 || s->at == s->end || *s->at != '=') {
            *broken = "an attribute has no value";
            return false;
        }
        step(s);
        skip_space(s);
        if (s->at == s->end || (*s->at != '"' && *s->at != '\'')) {
            *broken = "an attribute's value is not quoted";
            return false;
        }
        const char quote = *s->at;
        step(s);
        take_value(out->value[i], s, quote);
        if (s->at == s->end) {
            *broken = "a quoted value does not end";
            return false;
        }
        step(s);
        out->n = i + 1;
    }
}

static const char *attribute(const element *e, const char *key)
{
    for (int i = 0; i < e->n; i++)
        if (strcmp(e->key[i], key) == 0)
            return e->value[i];
    return NULL;
}

static double attribute_number(const element *e, const char *key)
{
    const char *text = attribute(e, key);
    char *end;
    const double v = text ? strtod(text, &end) : NAN;
    return text && end != text ? v : NAN;
}

static bool add_point(tc_preset *preset, const element *e)
{
    tc_color_point *color = tc_realloc(preset->color, preset->n_color + 1, sizeof *color);
    if (color)
        preset->color = color;
    tc_opacity_point *opacity = tc_realloc(preset->opacity, preset->n_color + 1, sizeof *opacity);
    if (opacity)
        preset->opacity = opacity;
    if (!color || !opacity)
        return false;
    const double x = attribute_number(e, "x");
    color[preset->n_color] = (tc_color_point){
        .x = x, .rgb = {attribute_number(e, "r"), attribute_number(e, "g"), attribute_number(e, "b")}, .midpoint = 0.5};
    if (attribute(e, "o"))
        opacity[preset->n_opacity++] = (tc_opacity_point){.x = x, .a = attribute_number(e, "o"), .midpoint = 0.5};
    preset->n_color++;
    return true;
}

static void end_map(tc_preset *preset, bool use_opacity)
{
    bool filled_in = !use_opacity;
    for (size_t i = 0; i < preset->n_opacity; i++)
        filled_in &= preset->opacity[i].a == 1;
    if (filled_in || preset->n_opacity < preset->n_color)
        preset->n_opacity = 0;
    tc_preset_complete(preset);
}

/* indexedLookup: the points are colours of categories; equal bands. */
static bool make_bands(tc_preset *preset)
{
    const size_t n = preset->n_color;
    tc_color_point *band = tc_calloc(2 * n, sizeof *band);
    if (!band)
        return false;
    for (size_t i = 0; i < 2 * n; i++) {
        band[i] = preset->color[i / 2];
        band[i].x = (double)((i + 1) / 2);
    }
    free(preset->color);
    preset->color = band;
    preset->n_color = 2 * n;
    preset->n_opacity = 0;
    preset->indexed = true;
    preset->space = TC_SPACE_RGB;
    return true;
}

tc_status tc_preset_parse_xml(tc_preset_list *out, const char *text, size_t length, const char *path, tc_error *err)
{
    scan s = {.at = text, .end = text + length, .line = 1};
    element *e = tc_calloc(1, sizeof *e);
    const char *broken = NULL;
    tc_preset *map = NULL;
    bool bands = false, use_opacity = false;
    tc_status status = e ? TC_OK : tc_fail_memory(err, path, 1, sizeof *e);
    while (status == TC_OK && next_element(e, &s, &broken)) {
        const bool is_map = strcmp(e->name, "ColorMap") == 0;
        if (is_map && !e->closing && !map) {
            const char *name = attribute(e, "name"), *space = attribute(e, "space"),
                       *indexed = attribute(e, "indexedLookup");
            map = tc_preset_create(name && *name ? name : "unnamed", 0, 0);
            if (!map) {
                status = tc_fail_memory(err, path, 1, sizeof *map);
                break;
            }
            if (space)
                tc_preset_set_space(map, space);
            use_opacity = attribute(e, "useOpacity") && strcmp(attribute(e, "useOpacity"), "1") == 0;
            bands = indexed && strcmp(indexed, "0") != 0 && strcmp(indexed, "false") != 0;
        } else if (map && !e->closing && strcmp(e->name, "Point") == 0) {
            if (!add_point(map, e))
                status = tc_fail_memory(err, path, map->n_color + 1, sizeof *map->color);
        } else if (map && !e->closing && strcmp(e->name, "NaN") == 0) {
            map->has_nan_color = true;
            const char *const key[3] = {"r", "g", "b"};
            for (int c = 0; c < 3; c++) {
                map->nan_color[c] = attribute_number(e, key[c]);
                map->has_nan_color &= map->nan_color[c] >= 0 && map->nan_color[c] <= 1;
            }
        }
        if (status == TC_OK && map && is_map && (e->closing || e->empty)) {
            if (bands && !make_bands(map))
                status = tc_fail_memory(err, path, 2 * map->n_color, sizeof *map->color);
            if (status != TC_OK)
                break;
            end_map(map, use_opacity);
            status = tc_preset_list_add(out, map, err);
            map = NULL;
        }
    }
    if (status == TC_OK && (broken || map))
        status = tc_fail(err, TC_E_FILE, "%s is no ParaView colour map: line %zu of its XML: %s", path, s.line,
                         broken ? broken : "<ColorMap> is not closed");
    tc_preset_destroy(&map);
    free(e);
    return status;
}
