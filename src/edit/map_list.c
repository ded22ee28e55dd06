/* map_list.c: colour maps to choose from. */
#include "edit/map_list.h"

#include "edit/fail.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static unsigned char channel(double value)
{
    return (unsigned char)lround(255 * fmax(0, fmin(1, value)));
}

void tc_map_strip(unsigned char (*rgb)[3], float *opacity, size_t n, const tc_transfer *tf)
{
    size_t n_knot, k = 0;
    const tc_knot *knot = tc_transfer_knots(tf, &n_knot);
    const double lo = knot[0].s, hi = knot[n_knot - 1].s;
    for (size_t i = 0; i < n; i++) {
        const double s = lo + (hi - lo) * ((double)i + 0.5) / (double)n;
        while (k + 1 < n_knot && knot[k + 1].s <= s)
            k++;
        const tc_knot *a = &knot[k], *b = k + 1 < n_knot ? a + 1 : a;
        const double t = b->s > a->s ? (s - a->s) / (b->s - a->s) : 0;
        rgb[i][0] = channel(a->r + t * (b->r - a->r));
        rgb[i][1] = channel(a->g + t * (b->g - a->g));
        rgb[i][2] = channel(a->b + t * (b->b - a->b));
        if (opacity)
            opacity[i] = (float)(a->a + t * (b->a - a->a));
    }
}

/* Is there an array of "Points" in the preset's text? Its keys are written at the beginning of lines, as no name can
 * be. */
static bool has_points(const char *text)
{
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += strspn(line, "\n ");
        if (!strncmp(line, "\"Points\"", 8))
            return true;
    }
    return false;
}

static tc_status entry_fill(tc_map_entry *out, const tc_text_pair *map, const char *file, tc_error *err)
{
    const tc_transfer_options options = {.color_map = map->value, .has_range = true, .range = {0, 1}};
    tc_transfer *tf;
    const tc_status status = tc_transfer_create(&tf, &options, err);
    if (status)
        return status;
    *out = (tc_map_entry){.name = map->key, .text = map->value, .file = file, .has_opacity = has_points(map->value)};
    tc_map_strip(out->strip, out->opacity, TC_MAP_STRIP, tf);
    float most = 0;
    for (size_t i = 0; i < TC_MAP_STRIP; i++)
        most = fmaxf(most, out->opacity[i]);
    for (size_t i = 0; i < TC_MAP_STRIP && most > 0; i++)
        out->opacity[i] /= most;
    tc_transfer_destroy(&tf);
    return TC_OK;
}

static bool is_there(const tc_map_list *list, const tc_text_pair *map)
{
    for (size_t i = 0; i < list->n; i++)
        if (!strcmp(list->entry[i].name, map->key) && !strcmp(list->entry[i].text, map->value))
            return true;
    return false;
}

/* Of each built-in map its text, in one block as of tc_transfer_presets. */
static tc_status builtin_texts(tc_text_pair **out, size_t *n, tc_error *err)
{
    const char *const *name = tc_transfer_builtin(n);
    tc_text_pair **each = calloc(*n, sizeof *each), *pair = NULL;
    size_t bytes = 0;
    tc_status status = each ? TC_OK : tc_edit_no_room(err, "colour maps", *n);
    for (size_t i = 0; i < *n && status == TC_OK; i++) {
        size_t one;
        status = tc_transfer_presets(&each[i], &one, name[i], err);
        if (status == TC_OK)
            bytes += sizeof *pair + strlen(each[i]->key) + strlen(each[i]->value) + 2;
    }
    if (status == TC_OK && !(pair = malloc(bytes)))
        status = tc_edit_no_room(err, "colour maps", *n);
    char *at = pair ? (char *)(pair + *n) : NULL;
    for (size_t i = 0; pair && i < *n; i++) {
        const size_t key = strlen(each[i]->key) + 1, value = strlen(each[i]->value) + 1;
        pair[i] = (tc_text_pair){memcpy(at, each[i]->key, key), memcpy(at + key, each[i]->value, value)};
        at += key + value;
    }
    for (size_t i = 0; each && i < *n; i++)
        free(each[i]);
    free(each);
    *out = pair;
    return status;
}

tc_status tc_map_list_read(tc_map_list **out, const char *file, tc_error *err)
{
    tc_text_pair *map = NULL;
    size_t n = 0;
    *out = NULL;
    tc_status status = file ? tc_transfer_presets(&map, &n, file, err) : builtin_texts(&map, &n, err);
    if (status)
        return status;
    tc_map_list *list = calloc(1, sizeof *list);
    char *name = file ? malloc(strlen(file) + 1) : NULL;
    tc_map_entry *entry = calloc(n, sizeof *entry);
    if (!list || !entry || (file && !name)) {
        free(map);
        free(list);
        free(name);
        free(entry);
        return tc_edit_no_room(err, "colour maps", n);
    }
    if (name)
        memcpy(name, file, strlen(file) + 1);
    *list = (tc_map_list){.entry = entry, .owned = {map, name}};
    for (size_t i = 0; i < n && status == TC_OK; i++)
        if (!is_there(list, &map[i])) {
            status = entry_fill(&entry[list->n], &map[i], name, err);
            list->n += status == TC_OK;
        }
    if (status)
        tc_map_list_destroy(&list);
    *out = list;
    return status;
}

void tc_map_list_destroy(tc_map_list **list)
{
    if (!list || !*list)
        return;
    free((*list)->entry);
    free((*list)->owned[0]);
    free((*list)->owned[1]);
    free(*list);
    *list = NULL;
}

/* Does the word stand in the text, without regard to case? */
static bool stands_in(const char *text, const char *word, size_t length)
{
    for (; text && *text; text++) {
        size_t i = 0;
        while (i < length && text[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)word[i]))
            i++;
        if (i == length)
            return true;
    }
    return false;
}

bool tc_map_matches(const tc_map_entry *entry, const char *search)
{
    const char *file = entry->file ? strrchr(entry->file, '/') : NULL;
    file = file ? file + 1 : entry->file;
    for (;;) {
        search += strspn(search, " \t");
        const size_t length = strcspn(search, " \t");
        if (length == 0)
            return true;
        if (!stands_in(entry->name, search, length) && !stands_in(file, search, length))
            return false;
        search += length;
    }
}
