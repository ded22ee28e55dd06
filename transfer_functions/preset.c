/* preset.c: presets in memory, their names, and reading a file of them. */
#define _POSIX_C_SOURCE 200809L
#include "transfer_functions/preset.h"

#include "core/memory.h"
#include "transfer_functions/preset_read.h"

#include <ctype.h>
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --------------------------------------------------------------------------------------------------------- life */

tc_preset *tc_preset_create(const char *name, size_t n_color, size_t n_opacity)
{
    tc_preset *preset = tc_calloc(1, sizeof *preset);
    if (!preset)
        return NULL;
    preset->name = tc_strdup(name ? name : "");
    preset->color = tc_calloc(n_color, sizeof *preset->color);
    preset->opacity = tc_calloc(n_opacity, sizeof *preset->opacity);
    if (!preset->name || !preset->color || !preset->opacity) {
        tc_preset_destroy(&preset);
        return NULL;
    }
    preset->n_color = n_color;
    preset->n_opacity = n_opacity;
    for (size_t i = 0; i < n_color; i++)
        preset->color[i].midpoint = 0.5;
    for (size_t i = 0; i < n_opacity; i++)
        preset->opacity[i].midpoint = 0.5;
    return preset;
}

void tc_preset_destroy(tc_preset **preset)
{
    if (!preset || !*preset)
        return;
    free((*preset)->name);
    free((*preset)->color);
    free((*preset)->opacity);
    free((*preset)->problem);
    free(*preset);
    *preset = NULL;
}

void tc_preset_list_finish(tc_preset_list *list)
{
    for (size_t i = 0; i < list->n; i++)
        tc_preset_destroy(&list->preset[i]);
    free(list->preset);
    memset(list, 0, sizeof *list);
}

tc_status tc_preset_list_add(tc_preset_list *list, tc_preset *preset, tc_error *err)
{
    tc_preset **grown = preset ? tc_realloc(list->preset, list->n + 1, sizeof *grown) : NULL;
    if (!grown) {
        tc_preset_destroy(&preset);
        return tc_fail_memory(err, "a list of colour maps", list->n + 1, sizeof *grown);
    }
    list->preset = grown;
    list->preset[list->n++] = preset;
    return TC_OK;
}

void tc_preset_set_problem(tc_preset *preset, const char *format, ...)
{
    if (preset->problem)
        return;
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    preset->problem = tc_strdup(text);
}

/* ------------------------------------------------------------------------------------------------------- points */

/* Stable merge sort of n items of `size` bytes that start with a double. */
static void sort_by_first(char *item, char *scratch, size_t n, size_t size)
{
    if (n < 2)
        return;
    const size_t half = n / 2;
    sort_by_first(item, scratch, half, size);
    sort_by_first(item + half * size, scratch, n - half, size);
    memcpy(scratch, item, half * size);
    char *a = scratch, *a_end = scratch + half * size, *b = item + half * size, *b_end = item + n * size, *out = item;
    while (a < a_end) {
        double ka = 0, kb = 0;
        memcpy(&ka, a, sizeof ka);
        if (b < b_end)
            memcpy(&kb, b, sizeof kb);
        char **from = b < b_end && kb < ka ? &b : &a;
        memcpy(out, *from, size);
        *from += size;
        out += size;
    }
}

void tc_preset_sort(tc_preset *preset)
{
    const size_t most = preset->n_color > preset->n_opacity ? preset->n_color : preset->n_opacity;
    char *scratch = tc_alloc(most, sizeof(tc_color_point));
    if (!scratch) {
        tc_preset_set_problem(preset, "there is no memory to sort its points");
        return;
    }
    sort_by_first((char *)preset->color, scratch, preset->n_color, sizeof *preset->color);
    sort_by_first((char *)preset->opacity, scratch, preset->n_opacity, sizeof *preset->opacity);
    free(scratch);
}

void tc_preset_set_space(tc_preset *preset, const char *space)
{
    static const struct {
        const char *name;
        tc_color_space space;
        bool wrap;
    } known[] = {{"RGB", TC_SPACE_RGB, false},
                 {"HSV", TC_SPACE_HSV, false},
                 {"Lab", TC_SPACE_LAB, false},
                 {"CIELAB", TC_SPACE_LAB, false},
                 {"Diverging", TC_SPACE_DIVERGING, false},
                 {"Lab/CIEDE2000", TC_SPACE_CIEDE2000, false},
                 {"LabCIEDE2000", TC_SPACE_CIEDE2000, false},
                 {"CIEDE2000", TC_SPACE_CIEDE2000, false},
                 {"Step", TC_SPACE_STEP, false},
                 {"Wrapped", TC_SPACE_HSV, true}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (tc_preset_name_equal(space, known[i].name)) {
            preset->space = known[i].space;
            preset->hsv_wrap = known[i].wrap;
            return;
        }
    tc_preset_set_problem(
        preset, "its colour space \"%.60s\" is unknown; use RGB, HSV, Lab, Diverging, Lab/CIEDE2000 or Step", space);
}

void tc_preset_complete(tc_preset *preset)
{
    for (size_t i = 0; i < preset->n_color; i++) {
        tc_color_point *p = &preset->color[i];
        if (!isfinite(p->x) || !isfinite(p->rgb[0]) || !isfinite(p->rgb[1]) || !isfinite(p->rgb[2]))
            tc_preset_set_problem(preset, "its colour point %zu is not finite; remove or mend that point", i);
        preset->sorted |= i > 0 && p->x < preset->color[i - 1].x;
        for (int c = 0; c < 3; c++)
            p->rgb[c] = p->rgb[c] < 0 ? 0 : p->rgb[c] > 1 ? 1 : p->rgb[c];
    }
    for (size_t i = 0; i < preset->n_opacity; i++) {
        tc_opacity_point *p = &preset->opacity[i];
        if (!isfinite(p->x) || !isfinite(p->a))
            tc_preset_set_problem(preset, "its opacity point %zu is not finite; remove or mend that point", i);
        else if (p->a < 0)
            tc_preset_set_problem(preset, "its opacity point %zu is %g; opacity may not be negative", i, p->a);
        preset->sorted |= i > 0 && p->x < preset->opacity[i - 1].x;
        if (!(p->midpoint >= 0 && p->midpoint <= 1))
            p->midpoint = 0.5;
        if (!(p->sharpness >= 0 && p->sharpness <= 1))
            p->sharpness = 0;
    }
    if (preset->n_color == 0)
        tc_preset_set_problem(preset, "it has neither RGBPoints nor IndexedColors");
    if (preset->sorted && !preset->problem)
        tc_preset_sort(preset);
}

/* -------------------------------------------------------------------------------------------------------- names */

/* Letters and digits in lower case; "(matplotlib)" dropped. */
static void plain_name(char *out, size_t capacity, const char *name)
{
    static const char drop[] = "matplotlib";
    size_t n = 0;
    for (; *name && n + 1 < capacity; name++) {
        if (*name == '(' && strncmp(name + 1, drop, sizeof drop - 1) == 0 && name[sizeof drop] == ')') {
            name += sizeof drop;
            continue;
        }
        if (!isspace((unsigned char)*name) && *name != '-' && *name != '_')
            out[n++] = (char)tolower((unsigned char)*name);
    }
    out[n] = 0;
}

bool tc_preset_name_equal(const char *a, const char *b)
{
    char plain_a[256], plain_b[256];
    plain_name(plain_a, sizeof plain_a, a);
    plain_name(plain_b, sizeof plain_b, b);
    return strcmp(plain_a, plain_b) == 0;
}

/* Edits that turn one name into the other; a name that contains the other is near. */
static int name_distance(const char *name, const char *wanted)
{
    char a[64], b[64];
    plain_name(a, sizeof a, name);
    plain_name(b, sizeof b, wanted);
    const int na = (int)strlen(a), nb = (int)strlen(b);
    if (na > 0 && nb > 0 && (strstr(a, b) || strstr(b, a)))
        return 0;
    int row[64];
    for (int j = 0; j <= nb; j++)
        row[j] = j;
    for (int i = 1; i <= na; i++) {
        int diagonal = row[0];
        row[0] = i;
        for (int j = 1; j <= nb; j++) {
            const int swap = diagonal + (a[i - 1] != b[j - 1]), up = row[j] + 1, left = row[j - 1] + 1;
            diagonal = row[j];
            row[j] = swap < up ? swap : up;
            row[j] = row[j] < left ? row[j] : left;
        }
    }
    return row[nb];
}

void tc_preset_nearest(char *out, size_t capacity, const char *const *name, size_t n, const char *wanted)
{
    size_t best[3];
    int distance[3];
    int count = 0;
    for (size_t i = 0; i < n; i++) {
        const int d = name_distance(name[i], wanted);
        int at = count;
        while (at > 0 && distance[at - 1] > d)
            at--;
        if (at >= 3)
            continue;
        count = count < 3 ? count + 1 : 3;
        for (int k = count - 1; k > at; k--)
            best[k] = best[k - 1], distance[k] = distance[k - 1];
        best[at] = i;
        distance[at] = d;
    }
    size_t used = 0;
    out[0] = 0;
    for (int i = 0; i < count && used + 1 < capacity; i++) {
        const int wrote = snprintf(out + used, capacity - used, "%s\"%.80s\"", i ? ", " : "", name[best[i]]);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}

tc_status tc_preset_choose(const tc_preset **out, const tc_preset_list *list, const char *name, const char *path,
                           tc_error *err)
{
    *out = NULL;
    const tc_preset *found = !name && list->n > 0 ? list->preset[0] : NULL;
    for (size_t i = 0; i < list->n && name && !found; i++)
        if (strcmp(list->preset[i]->name, name) == 0)
            found = list->preset[i];
    for (size_t i = 0; i < list->n && name && !found; i++)
        if (tc_preset_name_equal(list->preset[i]->name, name))
            found = list->preset[i];
    if (!found) {
        const char **names = tc_alloc(list->n, sizeof *names);
        if (!names)
            return tc_fail_memory(err, "names of colour maps", list->n, sizeof *names);
        for (size_t i = 0; i < list->n; i++)
            names[i] = list->preset[i]->name;
        char nearest[300];
        tc_preset_nearest(nearest, sizeof nearest, names, list->n, name ? name : "");
        free(names);
        return tc_fail(err, TC_E_ARG, "%s has no colour map \"%.80s\"; of its %zu the nearest are %s", path,
                       name ? name : "", list->n, nearest);
    }
    if (found->problem)
        return tc_fail(err, TC_E_FILE, "%s: the colour map \"%.80s\" cannot be used: %s", path, found->name,
                       found->problem);
    *out = found;
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------------- reading */

tc_status tc_preset_parse(tc_preset_list *out, const char *text, size_t length, const char *path, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0)
        text += 3, length -= 3;
    size_t at = 0;
    while (at < length && isspace((unsigned char)text[at]))
        at++;
    if (at == length)
        return tc_fail(err, TC_E_FILE, "%s is empty; give a ParaView preset (.json or .xml)", path);
    /* Numbers have decimal points here, whatever the program's language. */
    const locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    const locale_t before = plain ? uselocale(plain) : (locale_t)0;
    tc_status status = text[at] == '<' ? tc_preset_parse_xml(out, text + at, length - at, path, err)
                                       : tc_preset_parse_json(out, text + at, length - at, path, err);
    if (plain) {
        uselocale(before);
        freelocale(plain);
    }
    if (status == TC_OK && out->n == 0)
        status = tc_fail(err, TC_E_FILE, "%s holds no colour map; give a ParaView preset (.json or .xml)", path);
    if (status != TC_OK)
        tc_preset_list_finish(out);
    return status;
}

tc_status tc_preset_read(tc_preset_list *out, const char *path, tc_error *err)
{
    memset(out, 0, sizeof *out);
    const size_t limit = (size_t)64 << 20;
    FILE *file = fopen(path, "rb");
    if (!file)
        return tc_fail(err, TC_E_FILE, "%s cannot be opened: %s", path, strerror(errno));
    size_t capacity = 1 << 16, length = 0;
    char *text = tc_alloc(capacity, 1);
    tc_status status = text ? TC_OK : tc_fail_memory(err, path, capacity, 1);
    while (status == TC_OK) {
        const size_t got = fread(text + length, 1, capacity - length, file);
        length += got;
        if (ferror(file))
            status = tc_fail(err, TC_E_FILE, "%s cannot be read: %s", path, strerror(errno));
        if (status != TC_OK || feof(file))
            break;
        if (length >= limit) {
            status = tc_fail(err, TC_E_FILE, "%s is larger than 64 MiB, too large for colour maps", path);
        } else if (length == capacity) {
            char *grown = tc_realloc(text, capacity *= 2, 1);
            if (grown)
                text = grown;
            else
                status = tc_fail_memory(err, path, capacity, 1);
        }
    }
    fclose(file);
    if (status == TC_OK)
        status = tc_preset_parse(out, text, length, path, err);
    free(text);
    return status;
}
