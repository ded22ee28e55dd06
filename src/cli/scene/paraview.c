/* paraview.c: a ParaView file as a scene: reading it, and what is said of it. */
#define _GNU_SOURCE
#include "cli/scene/paraview.h"
#include "cli/options.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

void tc_paraview_note(tc_paraview_notes *notes, const char *format, ...)
{
    char *line = NULL, **more;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&line, format, arguments) < 0)
        line = NULL;
    va_end(arguments);
    more = line ? realloc(notes->line, (notes->n + 1) * sizeof *more) : NULL;
    if (!more) {
        free(line);
        return;
    }
    notes->line = more;
    notes->line[notes->n++] = line;
}

void tc_paraview_notes_say(const tc_paraview_notes *notes, const char *path, tc_talk *talk)
{
    for (size_t i = 0; i < notes->n; i++)
        tc_talk_warning(talk, "%s: %s", path, notes->line[i]);
}

void tc_paraview_notes_finish(tc_paraview_notes *notes)
{
    for (size_t i = 0; i < notes->n; i++)
        free(notes->line[i]);
    free(notes->line);
    *notes = (tc_paraview_notes){0};
}

static bool tc_ends(const char *path, const char *const *known, size_t n)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < n; i++)
        if (!strcasecmp(dot, known[i]))
            return true;
    return false;
}

bool tc_is_paraview_camera(const char *path)
{
    static const char *const known[] = {".pvcc", ".pvcvbc"};
    return tc_ends(path, known, sizeof known / sizeof *known);
}

bool tc_input_is_paraview(const char *input)
{
    static const char *const known[] = {".pvsm"};
    return strncmp(input, "synth:", 6) != 0 && (tc_ends(input, known, 1) || tc_is_paraview_camera(input));
}

int tc_paraview_read(json_t **scene, tc_paraview_notes *notes, const char *path, bool wants_data, tc_talk *talk)
{
    tc_pv pv;
    *scene = NULL;
    *notes = (tc_paraview_notes){0};
    int code = tc_pv_read(&pv, path, talk);
    if (code >= 0)
        return code;
    code = tc_paraview_scene(scene, notes, &pv, path, wants_data, talk);
    tc_pv_finish(&pv);
    return code;
}

int tc_paraview_options(tc_scene *out, const char *path, bool wants_data, bool silent, const tc_command *command,
                        tc_talk *talk)
{
    json_t *json;
    tc_paraview_notes notes;
    *out = (tc_scene){0};
    int code = tc_paraview_read(&json, &notes, path, wants_data, talk);
    json_object_del(json, "series");
    if (code < 0 && json_object_get(json, "views")) {
        json_object_del(json, "views");
        if (!tc_command_option(command, "--frames")) /* a batch takes it */
            tc_paraview_note(&notes, "the camera's path is left out: tetcast batch makes several pictures");
    }
    if (code < 0 && !silent)
        tc_paraview_notes_say(&notes, path, talk);
    if (code < 0)
        code = tc_scene_from_json(out, json, -1, NULL, path, NULL, command, talk);
    json_decref(json);
    tc_paraview_notes_finish(&notes);
    return code;
}

int tc_paraview_many(json_t **data, json_t **views, const char *path, tc_talk *talk)
{
    json_t *json;
    tc_paraview_notes notes;
    const int code = tc_paraview_read(&json, &notes, path, data != NULL, talk);
    *views = json_incref(json_object_get(json, "views"));
    if (data) {
        json_t *series = json_object_get(json, "series");
        *data = json_incref(json_array_size(series) > 1 ? series : json_object_get(json, "data"));
    }
    json_decref(json);
    tc_paraview_notes_finish(&notes);
    return code;
}
