/* rows.c: a row's columns as one table, which writes and reads CSV and JSON. */
#define _GNU_SOURCE
#include "study/rows.h"

#include "core/file.h"
#include "core/memory.h"
#include "study/settings.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---------------------------------------------------------------------------------------------------------- text */

void tc_text_add(tc_text *t, const char *format, ...)
{
    char *piece = NULL;
    va_list list;
    va_start(list, format);
    int n = vasprintf(&piece, format, list);
    va_end(list);
    if (n < 0 || t->failed) {
        t->failed = true;
        if (n >= 0)
            free(piece);
        return;
    }
    if (t->capacity - t->length < (size_t)n + 1) {
        size_t capacity = 2 * t->capacity + (size_t)n + 256;
        char *more = tc_realloc(t->text, capacity, 1);
        if (!more) {
            t->failed = true;
            free(piece);
            return;
        }
        t->text = more;
        t->capacity = capacity;
    }
    memcpy(t->text + t->length, piece, (size_t)n + 1);
    t->length += (size_t)n;
    free(piece);
}

void tc_text_finish(tc_text *t)
{
    free(t->text);
    *t = (tc_text){0};
}

void tc_text_number(tc_text *t, double value)
{
    if (isfinite(value))
        tc_text_add(t, "%.9g", value);
}

void tc_study_word(char *out, size_t capacity, const char *name)
{
    static const char good[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
    snprintf(out, capacity, "%s", name && *name ? name : "_");
    for (char *c = out; *c; c++)
        if (!strchr(good, *c))
            *c = '_';
}

/* ------------------------------------------------------------------------------------------------------- columns */

typedef enum kind { WORD, KNOB, SETTING, INT, COUNT, REAL } kind;

typedef struct column {
    const char *name;
    kind kind;
    size_t at, size;
} column;

#define COLUMN(kind, member)                                                                                           \
    {                                                                                                                  \
#member, kind, offsetof(tc_study_row, member), sizeof(((tc_study_row *)0)->member)                             \
    }
static const column columns[] = {
    COLUMN(WORD, scene),           COLUMN(WORD, function),      COLUMN(INT, view),
    COLUMN(REAL, azimuth),         COLUMN(REAL, elevation),     COLUMN(KNOB, knob),
    COLUMN(SETTING, setting),      COLUMN(INT, frames),         COLUMN(REAL, ms_median),
    COLUMN(REAL, ms_min),          COLUMN(REAL, ms_max),        COLUMN(WORD, truth),
    COLUMN(COUNT, pixels),         COLUMN(COUNT, ill_posed),    COLUMN(REAL, max_error),
    COLUMN(REAL, p9999_error),     COLUMN(REAL, p999_error),    COLUMN(REAL, mean_error),
    COLUMN(REAL, ill_posed_error), COLUMN(REAL, bytes_table),   COLUMN(REAL, bytes_state),
    COLUMN(REAL, steps_per_ray),   COLUMN(COUNT, steps),        COLUMN(COUNT, fragments),
    COLUMN(COUNT, rays),           COLUMN(COUNT, rays_lost),    COLUMN(INT, passes),
    COLUMN(INT, z_updates),        COLUMN(INT, steps_per_pass), COLUMN(INT, z_update_every),
    COLUMN(INT, integral_order),   COLUMN(INT, state_bits),     COLUMN(REAL, opacity_stop),
    COLUMN(WORD, integrator),      COLUMN(WORD, driver),        COLUMN(WORD, stepper),
    COLUMN(WORD, reentry),         COLUMN(WORD, samples),       COLUMN(WORD, note),
};
enum { N_COLUMN = sizeof columns / sizeof *columns };

void tc_study_row_clear(tc_study_row *row)
{
    memset(row, 0, sizeof *row);
    for (size_t i = 0; i < N_COLUMN; i++) {
        void *field = (char *)row + columns[i].at;
        if (columns[i].kind == INT)
            *(int *)field = -1;
        else if (columns[i].kind == COUNT)
            *(int64_t *)field = -1;
        else if (columns[i].kind == REAL)
            *(double *)field = NAN;
    }
}

void tc_study_row_header(tc_text *out)
{
    for (size_t i = 0; i < N_COLUMN; i++)
        tc_text_add(out, "%s%s", i ? "," : "", columns[i].name);
}

/* A cell has no comma, quote or line end, so that every reader of CSV takes it. */
static void write_words(tc_text *out, const char *text)
{
    tc_text_add(out, "%s", "");
    size_t from = out->length;
    tc_text_add(out, "%s", text);
    for (size_t i = from; !out->failed && i < out->length; i++) {
        char *c = &out->text[i];
        if (*c == ',')
            *c = ';';
        else if (*c == '"' || (unsigned char)*c < ' ')
            *c = *c == '"' ? '\'' : ' ';
    }
}

void tc_study_row_write(tc_text *out, const tc_study_row *row)
{
    for (size_t i = 0; i < N_COLUMN; i++) {
        const void *field = (const char *)row + columns[i].at;
        if (i)
            tc_text_add(out, ",");
        switch (columns[i].kind) {
        case WORD:
            write_words(out, field);
            break;
        case KNOB:
        case SETTING:
            write_words(out, *(const char *const *)field);
            break;
        case INT:
            if (*(const int *)field >= 0)
                tc_text_add(out, "%d", *(const int *)field);
            break;
        case COUNT:
            if (*(const int64_t *)field >= 0)
                tc_text_add(out, "%lld", (long long)*(const int64_t *)field);
            break;
        case REAL:
            tc_text_number(out, *(const double *)field);
            break;
        }
    }
}

/* One cell into a field of a cleared row; an empty one leaves it. */
static bool parse_cell(tc_study_row *row, const column *c, const char *cell)
{
    void *field = (char *)row + c->at;
    char *end = NULL;
    if (c->kind == WORD) {
        snprintf(field, c->size, "%s", cell);
        return true;
    }
    if (c->kind == KNOB)
        return true; /* comes with the setting */
    if (c->kind == SETTING) {
        size_t n;
        int k = tc_study_find(cell);
        if (k < 0)
            return false;
        row->setting = tc_study_settings(&n)[k].name;
        row->knob = tc_study_settings(&n)[k].knob;
        return true;
    }
    if (!*cell)
        return true;
    errno = 0;
    if (c->kind == REAL) {
        *(double *)field = strtod(cell, &end);
    } else {
        long long value = strtoll(cell, &end, 10);
        if (c->kind == INT)
            *(int *)field = (int)value;
        else
            *(int64_t *)field = value;
    }
    return !*end && errno == 0;
}

bool tc_study_row_parse(tc_study_row *out, const char *line, size_t length)
{
    char cell[256];
    tc_study_row_clear(out);
    for (size_t i = 0; i < N_COLUMN; i++) {
        const char *comma = memchr(line, ',', length);
        size_t n = comma ? (size_t)(comma - line) : length;
        if ((!comma) != (i + 1 == N_COLUMN) || n >= sizeof cell)
            return false;
        memcpy(cell, line, n);
        cell[n] = 0;
        if (!parse_cell(out, &columns[i], cell))
            return false;
        line += n + 1;
        length -= comma ? n + 1 : n;
    }
    return out->view >= 0;
}

json_t *tc_study_row_json(const tc_study_row *row)
{
    json_t *json = json_object();
    for (size_t i = 0; json && i < N_COLUMN; i++) {
        const void *field = (const char *)row + columns[i].at;
        json_t *value = NULL;
        switch (columns[i].kind) {
        case WORD:
            value = *(const char *)field ? json_string(field) : NULL;
            break;
        case KNOB:
        case SETTING:
            value = json_string(*(const char *const *)field);
            break;
        case INT:
            value = *(const int *)field >= 0 ? json_integer(*(const int *)field) : NULL;
            break;
        case COUNT:
            value = *(const int64_t *)field >= 0 ? json_integer(*(const int64_t *)field) : NULL;
            break;
        case REAL:
            value = isfinite(*(const double *)field) ? json_real(*(const double *)field) : NULL;
            break;
        }
        if (value)
            json_object_set_new(json, columns[i].name, value);
    }
    return json;
}

/* --------------------------------------------------------------------------------------------------------- files */

tc_status tc_lines_append(const char *path, const char *line, tc_error *err)
{
    int fd = open(path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    if (fd < 0)
        return tc_fail(err, TC_E_FILE, "%s cannot be written: %s; choose a folder that you may write to", path,
                       strerror(errno));
    tc_text whole = {0};
    tc_text_add(&whole, "%s\n", line);
    tc_status status = whole.failed ? tc_fail_memory(err, path, strlen(line), 1)
                                    : tc_file_write(fd, whole.text, whole.length, path, err);
    if (close(fd) != 0 && status == TC_OK)
        status = tc_fail(err, TC_E_FILE, "%s cannot be written: %s", path, strerror(errno));
    tc_text_finish(&whole);
    return status;
}

tc_status tc_lines_open(char **content, const char *path, const char *header, tc_error *err)
{
    void *data = NULL;
    size_t bytes = 0, head = strlen(header);
    *content = NULL;
    if (access(path, F_OK) == 0) {
        tc_status status = tc_file_read(&data, &bytes, path, err);
        if (status != TC_OK)
            return status;
    }
    char *text = tc_realloc(data, bytes + 1, 1);
    if (!text) {
        free(data);
        return tc_fail_memory(err, path, bytes + 1, 1);
    }
    text[bytes] = 0;
    if (memchr(text, 0, bytes) || strncmp(text, header, bytes < head ? bytes : head) != 0 ||
        (bytes > head && text[head] != '\n')) {
        free(text);
        return tc_fail(err, TC_E_FILE,
                       "%s was not written by this version of a study; give another folder or start it again", path);
    }
    size_t whole = bytes;
    while (whole > 0 && text[whole - 1] != '\n')
        whole--;
    tc_status status = TC_OK;
    if (whole <= head) {
        char *line = tc_alloc(head + 2, 1);
        if (line) {
            memcpy(line, header, head);
            memcpy(line + head, "\n", 2);
            status = tc_file_replace(path, line, head + 1, err);
            free(text);
            text = line;
        } else {
            status = tc_fail_memory(err, path, head + 2, 1);
        }
    } else if (whole < bytes) {
        if (truncate(path, (off_t)whole) != 0)
            status = tc_fail(err, TC_E_FILE, "%s cannot be written: %s", path, strerror(errno));
        text[whole] = 0;
    }
    if (status != TC_OK) {
        free(text);
        return status;
    }
    *content = text;
    return TC_OK;
}
