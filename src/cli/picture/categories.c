/* categories.c: --categories: a colour for each value, as of material numbers. */
#define _POSIX_C_SOURCE 200809L
#include "cli/picture/categories.h"
#include "cli/options.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TC_CATEGORIES_MOST = 65536, TC_FILE_MOST = 16 << 20, TC_LINE_MOST = 512 };

typedef struct tc_category {
    tc_knot knot; /* s is the value */
    char *name;   /* NULL: none */
} tc_category;

typedef struct tc_categories {
    size_t n;
    tc_category *item; /* [n] */
    const char *from;  /* the file, or the option's name: stands in errors */
    int wrong;         /* the exit code of what is wrong in it */
    tc_talk *talk;
} tc_categories;

static int tc_memory_out(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* name of that length, 0: none */
static int tc_add(tc_categories *c, const tc_knot *knot, const char *name, size_t length)
{
    if (c->n == TC_CATEGORIES_MOST) {
        tc_talk_error(c->talk, "%s has more than %d values", c->from, TC_CATEGORIES_MOST);
        return c->wrong;
    }
    tc_category *more = realloc(c->item, (c->n + 1) * sizeof *more);
    char *copy = more && length > 0 ? strndup(name, length) : NULL;
    if (more)
        c->item = more;
    if (!more || (length > 0 && !copy))
        return tc_memory_out(c->talk);
    c->item[c->n++] = (tc_category){*knot, copy};
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

/* V:R,G,B[,A][:NAME]; line 0: it stands in none */
static int tc_entry(tc_categories *c, const char *text, int line)
{
    double v[4] = {0, 0, 0, 1};
    tc_knot knot = {0};
    char word[TC_LINE_MOST];
    int n = 0;
    snprintf(word, sizeof word, "%s", text);
    char *colon = strchr(word, ':'), *name = colon ? strchr(colon + 1, ':') : NULL;
    if (colon)
        *colon = 0;
    if (name)
        *name++ = 0;
    if (!colon || !tc_parse_real(&knot.s, word) || !tc_parse_reals(v, &n, 4, colon + 1) || n < 3 || !tc_is_color(v) ||
        v[3] < 0) {
        char at[24] = "";
        if (line > 0)
            snprintf(at, sizeof at, ":%d", line);
        tc_talk_error(c->talk, "%s%s: '%.100s' is not V:R,G,B[,A][:NAME] with R, G and B from 0 to 1 and A not below 0",
                      c->from, at, text);
        return c->wrong;
    }
    knot.r = v[0], knot.g = v[1], knot.b = v[2], knot.a = v[3];
    return tc_add(c, &knot, name, name ? strlen(name) : 0);
}

/* Entries with ';' or line ends between them, and comments from # to the line's end. line: the first one's, 0: none. */
static int tc_entries(tc_categories *c, const char *text, int line)
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
            code = tc_entry(c, word, line);
        }
        text += length;
        if (*text == '#')
            text += strcspn(text, "\n");
        line += line > 0 && *text == '\n';
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
        for (size_t k = 0; k < 3; k++) { /* colours come round again, as in ParaView */
            const json_t *channel = json_array_get(colors, 3 * (i % n) + k);
            rgb[k] = json_is_number(channel) ? json_number_value(channel) : NAN;
        }
        knot.r = rgb[0], knot.g = rgb[1], knot.b = rgb[2];
        code = tc_preset_value(&knot.s, c, notes, i, range);
        if (code < 0 && !tc_is_color(rgb)) {
            tc_talk_error(c->talk, "%s: colour %zu of IndexedColors is not three numbers from 0 to 1", c->from,
                          i % n + 1);
            code = TC_EXIT_FAILED;
        }
        const char *name = json_string_value(json_array_get(notes, 2 * i + 1));
        if (code < 0)
            code = tc_add(c, &knot, name, name ? strlen(name) : 0);
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
    char *start = strncmp(text, "\xef\xbb\xbf", 3) == 0 ? text + 3 : text; /* a byte order mark says UTF-8 */
    const char *first = start + strspn(start, " \t\r\n");
    int code = *first == '[' || *first == '{' ? tc_preset(c, start, range) : tc_entries(c, start, 1);
    free(text);
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

void tc_category_list_finish(tc_category_list *list)
{
    for (size_t i = 0; list->name && i < list->n; i++)
        free((char *)list->name[i]);
    free(list->name);
    free(list->value);
    *list = (tc_category_list){0};
}

static int tc_by_value(const void *a, const void *b)
{
    const tc_category *x = a, *y = b;
    return (x->knot.s > y->knot.s) - (x->knot.s < y->knot.s);
}

/* Two knots a value: where its colour begins and ends. */
static int tc_steps(tc_transfer **out, const tc_categories *c)
{
    tc_error err = {0};
    tc_knot *knot = calloc(c->n, 2 * sizeof *knot);
    if (!knot)
        return tc_memory_out(c->talk);
    for (size_t i = 0; i < c->n; i++) {
        const tc_knot *k = &c->item[i].knot;
        const double before = i > 0 ? c->item[i - 1].knot.s : k->s - 1;
        const double after = i + 1 < c->n ? c->item[i + 1].knot.s : k->s + 1;
        knot[2 * i] = knot[2 * i + 1] = *k;
        knot[2 * i].s = 0.5 * (before + k->s);
        knot[2 * i + 1].s = 0.5 * (k->s + after);
    }
    tc_status status = tc_transfer_from_knots(out, knot, 2 * c->n, &err);
    free(knot);
    return status ? tc_talk_status(c->talk, status, &err) : -1;
}

/* Values in ascending order, each once. */
static int tc_order(tc_categories *c)
{
    if (c->n == 0) {
        tc_talk_error(c->talk, "%s names no value", c->from);
        return c->wrong;
    }
    qsort(c->item, c->n, sizeof *c->item, tc_by_value);
    for (size_t i = 1; i < c->n; i++)
        if (c->item[i].knot.s == c->item[i - 1].knot.s) {
            tc_talk_error(c->talk, "%s gives the value %g twice", c->from, c->item[i].knot.s);
            return c->wrong;
        }
    return -1;
}

/* The names go from c to the list. */
static int tc_list_make(tc_category_list *out, tc_categories *c)
{
    *out = (tc_category_list){c->n, calloc(c->n, sizeof *out->value), calloc(c->n, sizeof *out->name)};
    if (!out->value || !out->name)
        return tc_memory_out(c->talk);
    for (size_t i = 0; i < c->n; i++) {
        out->value[i] = c->item[i].knot.s;
        out->name[i] = c->item[i].name;
        c->item[i].name = NULL;
    }
    return -1;
}

int tc_categories_make(tc_transfer **out, tc_category_list *list, const char *text, const double range[2],
                       tc_talk *talk)
{
    const bool file = access(text, F_OK) == 0;
    tc_categories c = {
        .from = file ? text : "--categories", .wrong = file ? TC_EXIT_FAILED : TC_EXIT_USAGE, .talk = talk};
    int code;
    if (!file && !strchr(text, ':')) {
        tc_talk_error(talk, "--categories takes V:R,G,B[,A];… or a file, and there is no file %s", text);
        code = TC_EXIT_USAGE;
    } else {
        code = file ? tc_file(&c, text, range) : tc_entries(&c, text, 0);
    }
    if (code < 0)
        code = tc_order(&c);
    if (code < 0)
        code = tc_steps(out, &c);
    if (code < 0)
        code = tc_list_make(list, &c);
    for (size_t i = 0; i < c.n; i++)
        free(c.item[i].name);
    free(c.item);
    return code;
}
