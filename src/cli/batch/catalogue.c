/* catalogue.c: the Cinema database of a batch. */
#include "cli/batch/catalogue.h"
#include "cli/batch/folder.h"
#include "cli/picture/numbers.h"
#include "cli/picture/stereo_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TC_COLUMNS_MOST = 9 };
#define TC_SAVE_EVERY_S 5

int tc_catalogue_open(tc_catalogue *out, const tc_batch_frames *frames, const tc_batch_scene *scene, tc_talk *talk)
{
    *out = (tc_catalogue){0};
    if (!frames->cdb)
        return -1;
    const tc_output_options *o = &scene->look[0].picture.out;
    tc_cinema_column column[TC_COLUMNS_MOST];
    size_t n = 0;
    tc_error err = {0};
    out->degrees = scene->views.kind != TC_VIEWS_LIST && scene->views.kind != TC_VIEWS_PATH;
    out->depth = o->depth && tc_depth_is_apart(frames->pattern);
    out->value = o->value;
    out->pair = o->stereo == TC_STEREO_PAIR;
    column[n++] = (tc_cinema_column){"time", TC_CINEMA_FLOAT};
    if (out->degrees) {
        column[n++] = (tc_cinema_column){"phi", TC_CINEMA_FLOAT};
        column[n++] = (tc_cinema_column){"theta", TC_CINEMA_FLOAT};
    } else {
        column[n++] = (tc_cinema_column){"view", TC_CINEMA_TEXT};
    }
    column[n++] = (tc_cinema_column){"field", TC_CINEMA_TEXT};
    column[n++] = (tc_cinema_column){"tf", TC_CINEMA_TEXT};
    column[n++] = (tc_cinema_column){"FILE", TC_CINEMA_FILE};
    if (out->depth)
        column[n++] = (tc_cinema_column){"FILE_depth", TC_CINEMA_FILE};
    if (out->value)
        column[n++] = (tc_cinema_column){"FILE_value", TC_CINEMA_FILE};
    if (out->pair)
        column[n++] = (tc_cinema_column){"FILE_right", TC_CINEMA_FILE};
    out->saved_s = tc_talk_clock_s();
    const bool alone = scene->look[0].shard.of <= 1;
    int code = tc_folders_make(frames->frame[0].file, talk);
    if (code >= 0)
        return code;
    tc_status status = tc_cinema_open(&out->cinema, frames->cdb, column, n, alone, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

/* A file as seen from the database's folder: its names lead through it. */
static const char *tc_within(const tc_batch_frames *frames, const char *file)
{
    return file + strlen(frames->cdb) + 1;
}

int tc_catalogue_add(tc_catalogue *c, const tc_batch_frames *frames, const tc_batch_base *base,
                     const tc_batch_scene *scene, size_t frame, tc_talk *talk)
{
    if (!c->cinema)
        return -1;
    const tc_name_values values = tc_batch_values(frames, base, scene, frame);
    const char *file = frames->frame[frame].file;
    char view[64], *depth = c->depth ? tc_numbers_path(file, "depth") : NULL;
    char *value = c->value ? tc_numbers_path(file, "value") : NULL;
    char *right = c->pair ? tc_batch_eye_file(frames, base, scene, frame, 1) : NULL;
    tc_cinema_value row[TC_COLUMNS_MOST] = {{0}};
    size_t n = 0;
    tc_error err = {0};
    row[n++].number = values.time;
    if (c->degrees) {
        row[n++].number = values.phi;
        row[n++].number = values.theta;
    } else {
        const char *before = tc_cinema_text_ok(values.view, NULL, 0) ? "" : "v"; /* "0001" would be taken for a number */
        snprintf(view, sizeof view, "%s%.60s", before, values.view);
        row[n++].text = view;
    }
    row[n++].text = values.field;
    row[n++].text = values.tf;
    const char *const name[] = {file, depth, value, right};
    const bool there[] = {true, c->depth, c->value, c->pair};
    tc_status status = TC_OK;
    for (size_t i = 0; i < sizeof name / sizeof *name && status == TC_OK; i++) {
        if (there[i] && !name[i])
            status = TC_E_MEMORY;
        else if (there[i])
            row[n++].text = tc_within(frames, name[i]);
    }
    if (status == TC_OK)
        status = tc_cinema_add(c->cinema, row, &err);
    free(depth);
    free(value);
    free(right);
    if (status)
        return tc_talk_status(talk, status, &err);
    c->unsaved++;
    return tc_talk_clock_s() - c->saved_s < TC_SAVE_EVERY_S ? -1 : tc_catalogue_save(c, talk);
}

int tc_catalogue_save(tc_catalogue *c, tc_talk *talk)
{
    tc_error err = {0};
    if (!c->cinema || c->unsaved == 0)
        return -1;
    tc_status status = tc_cinema_save(c->cinema, &err);
    c->saved_s = tc_talk_clock_s();
    if (status)
        return tc_talk_status(talk, status, &err);
    c->unsaved = 0;
    return -1;
}

void tc_catalogue_finish(tc_catalogue *c)
{
    tc_cinema_destroy(&c->cinema);
}
