/* study.c: a folder of results: opened, gone on with, reported. */
#define _GNU_SOURCE
#include "study/study.h"

#include "core/file.h"
#include "core/memory.h"
#include "study/summary.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define RESULTS "results.csv"
#define TURNS "rotation.csv"
#define CURVES "fragments.csv"
#define KEY "study.key"
static const char turn_header[] = "scene,function,angle,ms,steps";
static const char curve_header[] = "scene,function,rule,passes,fragments of each pass";

enum { MAX_SIZE = 16384, MAX_VIEWS = 10000, MAX_FRAMES = 1000 };

/* Numbers are written with a point wherever the caller lives. */
static locale_t plain_numbers(locale_t *before)
{
    locale_t c = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    *before = c ? uselocale(c) : (locale_t)0;
    return c;
}

static void callers_numbers(locale_t c, locale_t before)
{
    if (c) {
        uselocale(before);
        freelocale(c);
    }
}

/* --------------------------------------------------------------------------------------------------------- files */

tc_status tc_study_path(char **out, const tc_study *study, const char *name, tc_error *err)
{
    if (asprintf(out, "%s/%s", study->folder, name) >= 0)
        return TC_OK;
    *out = NULL;
    return tc_fail_memory(err, "a path", strlen(study->folder) + strlen(name) + 2, 1);
}

tc_status tc_study_grow(void **array, size_t *room, size_t n, size_t size, tc_error *err)
{
    if (n < *room)
        return TC_OK;
    size_t more = 2 * *room + 64;
    void *grown = tc_realloc(*array, more, size);
    if (!grown)
        return tc_fail_memory(err, "the rows of a study", more, size);
    *array = grown;
    *room = more;
    return TC_OK;
}

static tc_status append(const tc_study *study, const char *name, const char *line, tc_error *err)
{
    char *path;
    tc_status status = tc_study_path(&path, study, name, err);
    if (status == TC_OK)
        status = tc_lines_append(path, line, err);
    free(path);
    return status;
}

static tc_status write_text(const tc_study *study, const char *name, tc_text *text, tc_error *err)
{
    char *path = NULL;
    tc_status status = text->failed ? tc_fail_memory(err, name, text->length, 1) : TC_OK;
    if (status == TC_OK)
        status = tc_study_path(&path, study, name, err);
    if (status == TC_OK)
        status = tc_file_replace(path, text->text, text->length, err);
    free(path);
    return status;
}

tc_status tc_study_keep(tc_study *study, const tc_study_row *row, tc_error *err)
{
    tc_text line = {0};
    tc_status status = tc_study_grow((void **)&study->row, &study->room_row, study->n_row, sizeof *study->row, err);
    if (status == TC_OK) {
        tc_study_row_write(&line, row);
        status = line.failed ? tc_fail_memory(err, "a row", line.length, 1) : append(study, RESULTS, line.text, err);
    }
    tc_text_finish(&line);
    if (status != TC_OK)
        return status;
    study->row[study->n_row++] = *row;
    if (study->options.row && !study->options.row(study->options.user, row))
        return tc_fail(err, TC_E_CANCEL, "the study was stopped after %zu rows; it goes on from there", study->n_row);
    return TC_OK;
}

tc_status tc_study_keep_turn(tc_study *study, const tc_turn *turn, tc_error *err)
{
    tc_text line = {0};
    tc_status status = tc_study_grow((void **)&study->turn, &study->room_turn, study->n_turn, sizeof *turn, err);
    if (status != TC_OK)
        return status;
    tc_text_add(&line, "%s,%s,%.9g,%.9g,%lld", turn->scene, turn->function, turn->angle, turn->ms,
                (long long)turn->steps);
    status = line.failed ? tc_fail_memory(err, "a row", line.length, 1) : append(study, TURNS, line.text, err);
    tc_text_finish(&line);
    if (status == TC_OK)
        study->turn[study->n_turn++] = *turn;
    return status;
}

tc_status tc_study_keep_curve(tc_study *study, tc_curve *curve, tc_error *err)
{
    tc_text line = {0};
    tc_status status = tc_study_grow((void **)&study->curve, &study->room_curve, study->n_curve, sizeof *curve, err);
    if (status == TC_OK) {
        tc_text_add(&line, "%s,%s,%s,%zu,", curve->scene, curve->function, curve->rule, curve->n);
        for (size_t i = 0; i < curve->n; i++)
            tc_text_add(&line, "%s%lld", i ? " " : "", (long long)curve->fragments[i]);
        status = line.failed ? tc_fail_memory(err, "a row", line.length, 1) : append(study, CURVES, line.text, err);
    }
    tc_text_finish(&line);
    if (status == TC_OK) {
        study->curve[study->n_curve++] = *curve;
        curve->fragments = NULL;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------- what was there */

static tc_status take_row(tc_study *study, const char *line, size_t length, tc_error *err)
{
    tc_study_row row;
    tc_status status = tc_study_grow((void **)&study->row, &study->room_row, study->n_row, sizeof row, err);
    if (status != TC_OK)
        return status;
    if (!tc_study_row_parse(&row, line, length))
        return tc_fail(err, TC_E_FILE,
                       "%s/" RESULTS " has a row that this version cannot read (row %zu); give another folder or start "
                       "it again",
                       study->folder, study->n_row + 1);
    study->row[study->n_row++] = row;
    return TC_OK;
}

static tc_status take_turn(tc_study *study, const char *line, size_t length, tc_error *err)
{
    tc_turn t = {0};
    char text[256];
    long long steps = 0;
    tc_status status = tc_study_grow((void **)&study->turn, &study->room_turn, study->n_turn, sizeof t, err);
    if (status != TC_OK)
        return status;
    snprintf(text, sizeof text, "%.*s", (int)(length < 255 ? length : 255), line);
    if (sscanf(text, "%63[^,],%31[^,],%lf,%lf,%lld", t.scene, t.function, &t.angle, &t.ms, &steps) != 5)
        return tc_fail(err, TC_E_FILE, "%s/" TURNS " has a row that is none of a study: %s; give another folder",
                       study->folder, text);
    t.steps = steps;
    study->turn[study->n_turn++] = t;
    return TC_OK;
}

static tc_status take_curve(tc_study *study, const char *line, size_t length, tc_error *err)
{
    tc_curve c = {0};
    char text[256];
    int used = 0;
    tc_status status = tc_study_grow((void **)&study->curve, &study->room_curve, study->n_curve, sizeof c, err);
    if (status != TC_OK)
        return status;
    snprintf(text, sizeof text, "%.*s", (int)(length < 255 ? length : 255), line);
    if (sscanf(text, "%63[^,],%31[^,],%15[^,],%zu,%n", c.scene, c.function, c.rule, &c.n, &used) != 4 || !used ||
        c.n > length)
        return tc_fail(err, TC_E_FILE, "%s/" CURVES " has a row that is none of a study: %.80s; give another folder",
                       study->folder, text);
    c.fragments = tc_calloc(c.n, sizeof *c.fragments);
    if (!c.fragments)
        return tc_fail_memory(err, "a curve", c.n, sizeof *c.fragments);
    const char *at = line + used;
    for (size_t i = 0; i < c.n; i++) {
        char *end;
        c.fragments[i] = strtoll(at, &end, 10);
        at = end; /* at the line's end strtoll would go on to the next: a row is whole, and c.n is its count */
    }
    study->curve[study->n_curve++] = c;
    return TC_OK;
}

static tc_status take_file(tc_study *study, const char *name, const char *header,
                           tc_status (*take)(tc_study *, const char *, size_t, tc_error *), tc_error *err)
{
    char *path = NULL, *content = NULL;
    tc_status status = tc_study_path(&path, study, name, err);
    if (status == TC_OK)
        status = tc_lines_open(&content, path, header, err);
    const char *line = content ? strchr(content, '\n') : NULL;
    while (status == TC_OK && line && line[1]) {
        line++;
        size_t length = strcspn(line, "\n");
        status = take(study, line, length, err);
        line += length;
    }
    free(content);
    free(path);
    return status;
}

static bool exists(const tc_study *study, const char *name)
{
    char *path = NULL;
    bool there = tc_study_path(&path, study, name, NULL) == TC_OK && access(path, F_OK) == 0;
    free(path);
    return there;
}

static void forget(const tc_study *study, const char *name)
{
    char *path = NULL;
    if (tc_study_path(&path, study, name, NULL) == TC_OK)
        unlink(path);
    free(path);
}

/* The folder is this request's, or becomes it. */
static tc_status check_key(tc_study *study, tc_error *err)
{
    const tc_study_options *o = &study->options;
    tc_text key = {0};
    void *data = NULL;
    size_t bytes = 0;
    char *path = NULL;
    tc_text_add(&key,
                "tetcast %s\nsize %dx%d\nviews %d\nframes %d\nverify %zu\nseed %llu\nunit distance %.17g\ngl %s\n%s\n",
                tc_version(), o->width, o->height, o->views, o->frames, o->verify, (unsigned long long)o->seed,
                o->unit_distance, o->gl ? o->gl : "auto", o->request ? o->request : "");
    tc_status status = key.failed ? tc_fail_memory(err, "a key", 256, 1) : tc_study_path(&path, study, KEY, err);
    if (status == TC_OK && o->restart) {
        static const char *const files[] = {KEY, RESULTS, TURNS, CURVES};
        for (size_t i = 0; i < sizeof files / sizeof *files; i++)
            forget(study, files[i]);
    }
    if (status == TC_OK && exists(study, KEY)) {
        status = tc_file_read(&data, &bytes, path, err);
        if (status == TC_OK && (bytes != key.length || memcmp(data, key.text, bytes) != 0))
            status = tc_fail(err, TC_E_ARG,
                             "%s holds a study that was asked for otherwise (%s says how); give another folder with "
                             "--out, or --restart to drop it",
                             study->folder, path);
    } else if (status == TC_OK && (exists(study, RESULTS) || exists(study, TURNS) || exists(study, CURVES))) {
        status =
            tc_fail(err, TC_E_ARG,
                    "%s holds results without %s, so what they are of is not known; give another folder with --out, "
                    "or --restart to drop them",
                    study->folder, KEY);
    } else if (status == TC_OK) {
        status = tc_file_replace(path, key.text, key.length, err);
    }
    free(data);
    free(path);
    tc_text_finish(&key);
    return status;
}

/* --------------------------------------------------------------------------------------------------- open, close */

static tc_status copy_options(tc_study *study, const tc_study_options *options, tc_error *err)
{
    tc_study_options *o = &study->options;
    *o = *options;
    if (!o->folder || !*o->folder)
        return tc_fail(err, TC_E_ARG, "a study needs a folder for its results");
    o->width = o->width ? o->width : 256;
    o->height = o->height ? o->height : 256;
    o->views = o->views ? o->views : 8;
    o->frames = o->frames ? o->frames : 5;
    if (o->width < 1 || o->height < 1 || o->width > MAX_SIZE || o->height > MAX_SIZE || o->views < 1 ||
        o->views > MAX_VIEWS || o->frames < 1 || o->frames > MAX_FRAMES)
        return tc_fail(err, TC_E_ARG,
                       "a study of %dx%d pixels, %d views and %d frames cannot be made; use 1 to %d pixels each way, 1 "
                       "to %d views and 1 to %d frames",
                       o->width, o->height, o->views, o->frames, MAX_SIZE, MAX_VIEWS, MAX_FRAMES);
    study->folder = tc_strdup(o->folder);
    study->knobs = tc_strdup(o->knobs);
    study->request = tc_strdup(o->request);
    study->gl = tc_strdup(o->gl);
    if (!study->folder || (o->knobs && !study->knobs) || (o->request && !study->request) || (o->gl && !study->gl))
        return tc_fail_memory(err, "the options of a study", 4096, 1);
    o->folder = study->folder;
    o->knobs = study->knobs;
    o->request = study->request;
    o->gl = study->gl;
    return tc_study_select(study->on, o->knobs, err);
}

tc_status tc_study_open(tc_study **out, const tc_study_options *options, const tc_log *log, tc_error *err)
{
    tc_text header = {0};
    *out = NULL;
    tc_study *study = tc_calloc(1, sizeof *study);
    if (!study)
        return tc_fail_memory(err, "a study", 1, sizeof *study);
    study->log = log;
    if (log)
        study->quiet = (tc_log){log->message, NULL, log->user};
    locale_t before, plain = plain_numbers(&before);
    tc_status status = copy_options(study, options, err);
    if (status == TC_OK && mkdir(study->folder, 0777) != 0 && errno != EEXIST)
        status = tc_fail(err, TC_E_FILE, "the folder %s cannot be made: %s", study->folder, strerror(errno));
    if (status == TC_OK)
        status = check_key(study, err);
    tc_study_row_header(&header);
    if (status == TC_OK && header.failed)
        status = tc_fail_memory(err, "a header", 1024, 1);
    if (status == TC_OK)
        status = take_file(study, RESULTS, header.text, take_row, err);
    if (status == TC_OK)
        status = take_file(study, TURNS, turn_header, take_turn, err);
    if (status == TC_OK)
        status = take_file(study, CURVES, curve_header, take_curve, err);
    callers_numbers(plain, before);
    tc_text_finish(&header);
    if (status != TC_OK)
        tc_study_close(&study);
    *out = study;
    return status;
}

void tc_study_close(tc_study **study)
{
    tc_study *s = *study;
    if (!s)
        return;
    tc_renderer_destroy(&s->renderer);
    tc_renderer_destroy(&s->reference);
    for (size_t i = 0; i < s->n_curve; i++)
        free(s->curve[i].fragments);
    free(s->row);
    free(s->turn);
    free(s->curve);
    free(s->folder);
    free(s->knobs);
    free(s->request);
    free(s->gl);
    free(s);
    *study = NULL;
}

/* ------------------------------------------------------------------------------------------------------- measure */

bool tc_study_has_row(const tc_study *study, const char *scene, const char *function, int view, size_t setting)
{
    size_t n;
    const char *name = tc_study_settings(&n)[setting].name;
    for (size_t i = 0; i < study->n_row; i++) {
        const tc_study_row *r = &study->row[i];
        if (r->view == view && !strcmp(r->setting, name) && !strcmp(r->scene, scene) && !strcmp(r->function, function))
            return true;
    }
    return false;
}

static void name_pair(tc_study_pair *pair, const char *scene, const char *function)
{
    tc_study_word(pair->scene, sizeof pair->scene, scene);
    tc_study_word(pair->function, sizeof pair->function, function);
}

static bool has_view(const tc_study *study, const tc_study_pair *pair, int view)
{
    for (size_t k = 0; k < TC_STUDY_SETTINGS; k++)
        if (study->on[k] && !tc_study_changes[k].figure &&
            !tc_study_has_row(study, pair->scene, pair->function, view, k))
            return false;
    return true;
}

bool tc_study_has(const tc_study *study, const char *scene, const char *function)
{
    tc_study_pair pair = {0};
    name_pair(&pair, scene, function);
    for (int v = 0; v < study->options.views; v++)
        if (!has_view(study, &pair, v))
            return false;
    return tc_study_has_figures(study, pair.scene, pair.function);
}

tc_status tc_study_renderer(tc_renderer **out, tc_study *study, bool reference, tc_error *err)
{
    tc_renderer **keep = reference ? &study->reference : &study->renderer;
    tc_status status = TC_OK;
    if (!*keep) {
        const tc_renderer_options options = {.gl = reference ? NULL : study->options.gl,
                                             .driver = reference ? "reference" : "pingpong",
                                             .threads = study->options.threads};
        status = tc_renderer_create(keep, &options, &study->quiet, err);
    }
    *out = *keep;
    return status;
}

tc_status tc_study_scene(tc_study *study, const char *scene, tc_mesh *mesh, const char *function, const tc_transfer *tf,
                         tc_error *err)
{
    tc_study_pair pair = {.mesh = mesh, .tf = tf};
    tc_status status = TC_OK;
    name_pair(&pair, scene, function);
    locale_t before, plain = plain_numbers(&before);
    for (int v = 0; v < study->options.views && status == TC_OK; v++)
        if (!has_view(study, &pair, v))
            status = tc_study_measure(study, &pair, v, err);
    if (status == TC_OK && !tc_study_has_figures(study, pair.scene, pair.function))
        status = tc_study_figures(study, &pair, err);
    study->done += status == TC_OK;
    callers_numbers(plain, before);
    return status;
}

/* -------------------------------------------------------------------------------------------------------- report */

static tc_status write_summary(const tc_study *study, const tc_summary *summary, tc_error *err)
{
    tc_text text = {0};
    tc_study_row_header(&text);
    tc_text_add(&text, ",views,time_ratio,front\n");
    for (size_t i = 0; i < summary->n; i++) {
        tc_study_row_write(&text, &summary->sum[i].row);
        tc_text_add(&text, ",%d,", summary->sum[i].views);
        tc_text_number(&text, summary->sum[i].time_ratio);
        tc_text_add(&text, ",%d\n", summary->sum[i].front);
    }
    tc_status status = write_text(study, "summary.csv", &text, err);
    tc_text_finish(&text);
    return status;
}

static tc_status write_json(const tc_study *study, const tc_summary *summary, tc_error *err)
{
    const tc_study_options *o = &study->options;
    json_t *root = json_pack("{s:s, s:{s:i, s:i}, s:i, s:i, s:I, s:I}", "tetcast", tc_version(), "image", "width",
                             o->width, "height", o->height, "views", o->views, "frames", o->frames, "verify",
                             (json_int_t)o->verify, "seed", (json_int_t)o->seed);
    json_t *rows = json_array(), *sums = json_array(), *turns = json_array(), *curves = json_array();
    for (size_t i = 0; i < study->n_row; i++)
        json_array_append_new(rows, tc_study_row_json(&study->row[i]));
    for (size_t i = 0; i < summary->n; i++) {
        json_t *sum = tc_study_row_json(&summary->sum[i].row);
        json_object_set_new(sum, "views", json_integer(summary->sum[i].views));
        if (isfinite(summary->sum[i].time_ratio))
            json_object_set_new(sum, "time_ratio", json_real(summary->sum[i].time_ratio));
        json_object_set_new(sum, "front", json_boolean(summary->sum[i].front));
        json_array_append_new(sums, sum);
    }
    for (size_t i = 0; i < study->n_turn; i++) {
        const tc_turn *t = &study->turn[i];
        json_array_append_new(turns, json_pack("{s:s, s:s, s:f, s:f, s:I}", "scene", t->scene, "function", t->function,
                                               "angle", t->angle, "ms", t->ms, "steps", (json_int_t)t->steps));
    }
    for (size_t i = 0; i < study->n_curve; i++) {
        const tc_curve *c = &study->curve[i];
        json_t *list = json_array();
        for (size_t k = 0; k < c->n; k++)
            json_array_append_new(list, json_integer((json_int_t)c->fragments[k]));
        json_array_append_new(curves, json_pack("{s:s, s:s, s:s, s:o}", "scene", c->scene, "function", c->function,
                                                "rule", c->rule, "fragments_per_pass", list));
    }
    json_object_set_new(root, "rows", rows);
    json_object_set_new(root, "summary", sums);
    json_object_set_new(root, "rotation", turns);
    json_object_set_new(root, "fragments", curves);
    char *dump = root ? json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(root);
    if (!dump)
        return tc_fail_memory(err, "the study as JSON", study->n_row, sizeof(tc_study_row));
    tc_text text = {dump, strlen(dump), strlen(dump) + 1, false};
    tc_text_add(&text, "\n");
    tc_status status = write_text(study, "study.json", &text, err);
    tc_text_finish(&text);
    return status;
}

tc_status tc_study_report(tc_study *study, size_t *plots, tc_error *err)
{
    tc_summary summary;
    locale_t before, plain = plain_numbers(&before);
    if (plots)
        *plots = 0;
    tc_status status = tc_summary_build(&summary, study->row, study->n_row, err);
    if (status == TC_OK) {
        status = write_summary(study, &summary, err);
        if (status == TC_OK)
            status = write_json(study, &summary, err);
        if (status == TC_OK)
            status = tc_study_plots(study, &summary, err);
        tc_summary_finish(&summary);
    }
    if (plots && status == TC_OK)
        *plots = study->n_plot;
    callers_numbers(plain, before);
    return status;
}

const char *tc_study_plot(const tc_study *study, size_t i)
{
    return i < study->n_plot ? study->plot[i] : NULL;
}
