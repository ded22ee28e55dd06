/* categories.c: --categories: a colour for each value, as of material numbers. */
#define _POSIX_C_SOURCE 200809L
#include "cli/categories.h"
#include "cli/options.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TC_CATEGORIES_MOST = 65536, TC_FILE_MOST = 16 << 20, TC_LINE_MOST = 512 };

typedef struct tc_categories {
    size_t n;
    tc_knot *knot;    /* [n]: s is the value */
    const char *from; /* the file, or the option's name: stands in errors */
    tc_talk *talk;
} tc_categories;

static int tc_memory_out(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

static int tc_add(tc_categories *c, const tc_knot *knot)
{
    if (c->n == TC_CATEGORIES_MOST) {
        tc_talk_error(c->talk, "%s has more than %d values", c->from, TC_CATEGORIES_MOST);
        return TC_EXIT_FAILED;
    }
    tc_knot *more = realloc(c->knot, (c->n + 1) * sizeof *more);
    if (!more)
        return tc_memory_out(c->talk);
    c->knot = more;
    c->knot[c->n++] = *knot;
    return -1;
}

/* ---------------------------------------------------------------------------------------------------------- lines */

static bool tc_is_color(const double *rgb)
{
    for (int i = 0; i < 3; i++)
        if (!(rgb[i] >= 0 && rgb[i] <= 1))
            return false;
    return true;
}

/* V:R,G,B[,A] */
static int tc_entry(tc_categories *c, const char *text)
{
    double v[4] = {0, 0, 0, 1};
    tc_knot knot = {0};
    char word[TC_LINE_MOST];
    int n = 0;
    snprintf(word, sizeof word, "%s", text);
    char *colon = strchr(word, ':');
    if (colon)
        *colon = 0;
    if (!colon || !tc_parse_real(&knot.s, word) || !tc_parse_reals(v, &n, 4, colon + 1) || n < 3 || !tc_is_color(v) ||
        v[3] < 0) {
        tc_talk_error(c->talk, "%s: '%.100s' is not V:R,G,B[,A] with R, G and B from 0 to 1 and A not below 0", c->from,
                      text);
        return TC_EXIT_USAGE;
    }
    knot.r = v[0], knot.g = v[1], knot.b = v[2], knot.a = v[3];
    return tc_add(c, &knot);
}

/* Entries with ';' or line ends between them, and comments from # to the line's end. */
static int tc_entries(tc_categories *c, const char *text)
{
    int code = -1;
    while (*text && code < 0) {
        char word[TC_LINE_MOST];
        size_t length = strcspn(text, ";\n#"), keep = length;
        while (keep > 0 && strchr(" \t\r", text[keep - 1]))
            keep--;
        size_t skip = strspn(text, " \t\r");
        if (keep > skip) {
            snprintf(word, sizeof word, "%.*s", (int)(keep - skip), text + skip);
            code = tc_entry(c, word);
        }
        text += length;
        if (*text == '#')
            text += strcspn(text, "\n");
        text += *text != 0;
    }
    return code;
}

/* --------------------------------------------------------------------------------------------------------- preset */

/* Commas before a closing bracket, as ParaView's own list of presets has them, become spaces. */
static void tc_commas_drop(char *text)
{
    char *comma = NULL;
    bool in_string = false;
    for (char *c = text; *c; c++) {
        if (in_string) {
            if (*c == '\\' && c[1])
                c++;
            else
                in_string = *c != '"';
            continue;
        }
        if (*c == ',')
            comma = c;
        else if ((*c == ']' || *c == '}') && comma)
            *comma = ' ';
        if (!strchr(", \t\r\n", *c))
            comma = NULL;
        in_string = *c == '"';
    }
}

/* The value of colour i of a preset: its annotation, else a whole number. */
static int tc_preset_value(double *out, const tc_categories *c, const json_t *notes, size_t i, const double range[2])
{
    const char *text = json_string_value(json_array_get(notes, 2 * i));
    if (json_array_size(notes) == 0) {
        *out = floor(range[0] + 0.5) + (double)i;
        return -1;
    }
    if (text && tc_parse_real(out, text))
        return -1;
    tc_talk_error(c->talk, "%s: annotation %zu is of '%s', which is no number", c->from, i + 1, text ? text : "?");
    return TC_EXIT_FAILED;
}

static int tc_preset(tc_categories *c, char *text, const double range[2])
{
    json_error_t error;
    tc_commas_drop(text);
    json_t *json = json_loads(text, 0, &error);
    if (!json) {
        tc_talk_error(c->talk, "%s:%d: this is no JSON: %s", c->from, error.line, error.text);
        return TC_EXIT_FAILED;
    }
    const json_t *preset = json_is_array(json) ? NULL : json, *colors = json_object_get(preset, "IndexedColors");
    for (size_t i = 0; i < json_array_size(json) && !json_is_array(colors); i++) {
        preset = json_array_get(json, i);
        colors = json_object_get(preset, "IndexedColors");
    }
    const json_t *notes = json_object_get(preset, "Annotations");
    const size_t n = json_array_size(colors) / 3;
    const size_t n_value = json_array_size(notes) > 0 ? json_array_size(notes) / 2 : n;
    int code = -1;
    if (n == 0) {
        tc_talk_error(c->talk, "%s has no preset with IndexedColors; a colour map is for --color-map", c->from);
        code = TC_EXIT_FAILED;
    }
    for (size_t i = 0; n > 0 && i < n_value && code < 0; i++) {
        double rgb[3];
        tc_knot knot = {.a = 1};
        for (size_t k = 0; k < 3; k++) /* colours come round again, as in ParaView */
            rgb[k] = json_number_value(json_array_get(colors, 3 * (i % n) + k));
        knot.r = rgb[0], knot.g = rgb[1], knot.b = rgb[2];
        code = tc_preset_value(&knot.s, c, notes, i, range);
        if (code < 0 && !tc_is_color(rgb)) {
            tc_talk_error(c->talk, "%s: colour %zu is not from 0 to 1 each", c->from, i % n + 1);
            code = TC_EXIT_FAILED;
        }
        if (code < 0)
            code = tc_add(c, &knot);
    }
    json_decref(json);
    return code;
}

static int tc_file(tc_categories *c, const char *path, const double range[2])
{
    FILE *stream = fopen(path, "rb");
    char *text = stream ? malloc(TC_FILE_MOST + 1) : NULL;
    size_t n = text ? fread(text, 1, TC_FILE_MOST, stream) : 0;
    if (!text || ferror(stream) || n == TC_FILE_MOST) {
        tc_talk_error(c->talk, "%s cannot be read%s", path, n == TC_FILE_MOST ? ": it has 16 MiB and more" : "");
        if (stream)
            fclose(stream);
        free(text);
        return TC_EXIT_FAILED;
    }
    fclose(stream);
    text[n] = 0;
    const char *first = text + strspn(text, " \t\r\n");
    int code = *first == '[' || *first == '{' ? tc_preset(c, text, range) : tc_entries(c, text);
    free(text);
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

static int tc_by_value(const void *a, const void *b)
{
    const tc_knot *x = a, *y = b;
    return (x->s > y->s) - (x->s < y->s);
}

/* Two knots a value: where its colour begins and ends. */
static int tc_steps(tc_transfer **out, tc_categories *c)
{
    tc_error err = {0};
    qsort(c->knot, c->n, sizeof *c->knot, tc_by_value);
    for (size_t i = 1; i < c->n; i++)
        if (c->knot[i].s == c->knot[i - 1].s) {
            tc_talk_error(c->talk, "%s gives the value %g twice", c->from, c->knot[i].s);
            return TC_EXIT_USAGE;
        }
    tc_knot *knot = calloc(c->n, 2 * sizeof *knot);
    if (!knot)
        return tc_memory_out(c->talk);
    for (size_t i = 0; i < c->n; i++) {
        const tc_knot *k = &c->knot[i];
        knot[2 * i] = knot[2 * i + 1] = *k;
        knot[2 * i].s = i > 0 ? 0.5 * (k[-1].s + k->s) : k->s - 0.5;
        knot[2 * i + 1].s = i + 1 < c->n ? 0.5 * (k->s + k[1].s) : k->s + 0.5;
    }
    tc_status status = tc_transfer_from_knots(out, knot, 2 * c->n, &err);
    free(knot);
    return status ? tc_talk_status(c->talk, status, &err) : -1;
}

int tc_categories_make(tc_transfer **out, const char *text, const double range[2], tc_talk *talk)
{
    const bool file = access(text, F_OK) == 0;
    tc_categories c = {.from = file ? text : "--categories", .talk = talk};
    int code = -1;
    if (!file && !strchr(text, ':')) {
        tc_talk_error(talk, "--categories takes V:R,G,B[,A];… or a file, and there is no file %s", text);
        code = TC_EXIT_USAGE;
    } else {
        code = file ? tc_file(&c, text, range) : tc_entries(&c, text);
    }
    if (code < 0 && c.n == 0) {
        tc_talk_error(talk, "%s names no value", c.from);
        code = TC_EXIT_USAGE;
    }
    if (code < 0)
        code = tc_steps(out, &c);
    free(c.knot);
    return code;
}
