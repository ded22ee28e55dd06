/* paraview_source.c: what a ParaView representation shows: through its filters to the reader, and to the reader's file.
 */
#define _GNU_SOURCE
#include "cli/scene/paraview_parts.h"
#include "cli/options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What does here what a filter does there. */
static const char *tc_filter_remedy(const char *type)
{
    static const char *const known[][2] = {
        {"Clip", "--clip, --clip-box"}, {"Threshold", "--select"}, {"ExtractBlock", "--blocks"},
        {"Slice", "--clip twice"},      {"Contour", "--iso"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strstr(type, known[i][0]))
            return known[i][1];
    return NULL;
}

/* From a representation up to what has no input; filters on the way are noted. NULL: there is none. */
static const tc_pv_proxy *tc_reader_find(tc_pv_build *b, const tc_pv_proxy *representation)
{
    const tc_pv *pv = b->pv;
    const tc_pv_proxy *at = tc_pv_link(pv, representation, "Input", 0);
    for (size_t steps = 0; at && steps <= pv->n_proxy; steps++) {
        const tc_pv_proxy *above = tc_pv_link(pv, at, "Input", 0);
        if (!above)
            return at;
        const char *type = pv->text + at->type, *remedy = tc_filter_remedy(type);
        tc_paraview_note(b->notes, "the filter %.80s (%.80s) is left out, what goes into it is shown%s%s%s",
                         tc_pv_name(pv, at, "sources"), type, remedy ? " (" : "", remedy ? remedy : "",
                         remedy ? ")" : "");
        if (tc_pv_links(pv, at, "Input") > 1)
            tc_paraview_note(b->notes, "of what goes into %.80s the first is taken", tc_pv_name(pv, at, "sources"));
        at = above;
    }
    return NULL;
}

/* The property that names a reader's file or files; NULL: it reads none. */
static const tc_pv_property *tc_files_find(const tc_pv *pv, const tc_pv_proxy *reader)
{
    static const char *const name[] = {"FileName", "FileNames", "CaseFileName", "XMLFileName", "FilePrefix"};
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        const tc_pv_property *p = tc_pv_property_of(pv, reader, name[i]);
        if (p && p->n > 0 && pv->text[pv->value[p->first]])
            return p;
    }
    return NULL;
}

/* The time that the state shows; false: it tells none. */
static bool tc_time_find(double *time, const tc_pv *pv, const tc_pv_proxy *view)
{
    for (size_t i = 0; i < pv->n_proxy; i++) {
        const tc_pv_proxy *proxy = &pv->proxy[i];
        if (tc_pv_is(pv, proxy->type, "AnimationScene") && tc_pv_reals(time, 1, pv, proxy, "AnimationTime"))
            return true;
    }
    for (size_t i = 0; i < pv->n_proxy; i++)
        if (tc_pv_is(pv, pv->proxy[i].type, "TimeKeeper") && tc_pv_reals(time, 1, pv, &pv->proxy[i], "Time"))
            return true;
    return tc_pv_reals(time, 1, pv, view, "ViewTime");
}

/* The last file of a series at or before a time: times are the reader's, else 0, 1, 2, … */
static size_t tc_series_find(const tc_pv *pv, const tc_pv_proxy *reader, size_t n, double time)
{
    const bool told = tc_pv_values(pv, reader, "TimestepValues") == n;
    size_t found = 0;
    for (size_t i = 0; i < n; i++) {
        double at = (double)i;
        if (told && !tc_parse_real(&at, tc_pv_value(pv, reader, "TimestepValues", i)))
            continue;
        if (at <= time)
            found = i;
    }
    return found;
}

/* The path of a file as the state says it: where it is not absolute, from the state's folder. From malloc, or NULL. */
static char *tc_data_led(const tc_pv_build *b, const char *file)
{
    const char *slash = strrchr(b->path, '/');
    const int length = *file == '/' || !slash ? 0 : (int)(slash - b->path) + 1;
    char *led = NULL;
    return asprintf(&led, "%.*s%s", length, b->path, file) < 0 ? NULL : led;
}

/* The path of a file of the state's: as it is, from the state's folder where it is not absolute, or of its name beside
 * the state where it is not there. NULL: it is not there, or memory ran out. */
static char *tc_data_find(tc_pv_build *b, const char *file, bool silent)
{
    const char *slash = strrchr(b->path, '/'), *name = strrchr(file, '/');
    const int length = slash ? (int)(slash - b->path) + 1 : 0;
    char *led = tc_data_led(b, file);
    if (!led)
        return NULL;
    if (access(led, F_OK) == 0)
        return led;
    free(led);
    if (asprintf(&led, "%.*s%s", length, b->path, name ? name + 1 : file) < 0)
        return NULL;
    if (access(led, F_OK) == 0) {
        if (!silent)
            tc_paraview_note(b->notes, "its data %.300s are not there: %.300s is taken", file, led);
        return led;
    }
    free(led);
    return NULL;
}

static int tc_data_put(tc_pv_build *b, const tc_pv_proxy *reader, const char *file)
{
    if (!file) {
        tc_talk_error(b->talk, "%s shows %s, which reads no file: give the data, tetcast render INPUT --paraview %s",
                      b->path, reader ? tc_pv_name(b->pv, reader, "sources") : "nothing", b->path);
        return TC_EXIT_FAILED;
    }
    char *data = tc_data_find(b, file, false);
    if (!data) {
        tc_talk_error(b->talk,
                      "%s shows %s, which is not there: give the data, tetcast render INPUT --paraview %s, or put them "
                      "beside the state",
                      b->path, file, b->path);
        return TC_EXIT_FAILED;
    }
    tc_pv_put(b, "", "data", json_string(data));
    free(data);
    return -1;
}

/* What a reader does otherwise: blocks that it leaves away, pairs of a name and 0 or 1; displacements. */
static void tc_reader_note(tc_pv_build *b, const tc_pv_proxy *reader)
{
    const tc_pv *pv = b->pv;
    double magnitude = 1;
    if (tc_pv_values(pv, reader, "ApplyDisplacements") > 0 && !tc_pv_is_on(pv, reader, "ApplyDisplacements"))
        tc_paraview_note(b->notes, "the mesh is not displaced there and is here");
    else if (tc_pv_reals(&magnitude, 1, pv, reader, "DisplacementMagnitude") && magnitude != 1)
        tc_paraview_note(b->notes, "displacements are %g times as large there", magnitude);
    for (size_t i = 0; i < reader->n; i++) {
        const tc_pv_property *p = &pv->property[reader->first + i];
        const char *name = pv->text + p->name;
        size_t off = 0;
        if (!strstr(name, "Block") || strstr(name, "Info") || p->n % 2 != 0)
            continue;
        for (size_t k = 1; k < p->n; k += 2)
            off += !strcmp(pv->text + pv->value[p->first + k], "0");
        if (off > 0)
            tc_paraview_note(b->notes, "%zu blocks that %.80s does not read (%.80s) are shown (--blocks)", off,
                             tc_pv_name(pv, reader, "sources"), name);
    }
}

/* All files of a series; one that is not there stays as the state says it, so that its step is told of as missing. */
static void tc_series_put(tc_pv_build *b, const tc_pv_property *files)
{
    json_t *list = json_array();
    for (size_t i = 0; i < files->n; i++) {
        const char *file = b->pv->text + b->pv->value[files->first + i];
        char *data = tc_data_find(b, file, true);
        data = data ? data : tc_data_led(b, file);
        if (data)
            json_array_append_new(list, json_string(data));
        free(data);
    }
    tc_pv_put(b, "", "series", list);
}

int tc_pv_source(tc_pv_build *b, const tc_pv_proxy *representation, const tc_pv_proxy *view)
{
    const tc_pv *pv = b->pv;
    const tc_pv_proxy *reader = tc_reader_find(b, representation);
    const tc_pv_property *files = tc_files_find(pv, reader);
    double time = 0;
    const bool timed = tc_time_find(&time, pv, view);
    size_t chosen = 0;
    if (reader)
        tc_reader_note(b, reader);
    if (files && files->n > 1) {
        chosen = tc_series_find(pv, reader, files->n, time);
        if (b->wants_data) {
            tc_series_put(b, files);
            tc_paraview_note(b->notes, "of the series of %zu files the one at time %g is taken: %.300s", files->n, time,
                             pv->text + pv->value[files->first + chosen]);
        }
    } else if (timed && tc_pv_values(pv, reader, "TimestepValues") > 1) {
        tc_pv_put(b, "", "time", json_real(time));
    }
    if (!b->wants_data)
        return -1;
    return tc_data_put(b, reader, files ? pv->text + pv->value[files->first + chosen] : NULL);
}
