/* cinema.c: the table of a Cinema database: rows, which of them are the same, and how a table is read and written. */
#define _GNU_SOURCE
#include "cli/batch/cinema_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

tc_status tc_cinema_fail(tc_error *err, tc_status code, const char *format, ...)
{
    if (err) {
        va_list rest;
        va_start(rest, format);
        vsnprintf(err->text, sizeof err->text, format, rest);
        va_end(rest);
        err->code = code;
    }
    return code;
}

static tc_status no_memory(tc_error *err, const tc_cinema *cinema)
{
    return tc_cinema_fail(err, TC_E_MEMORY, "memory ran out for the table of %s; add rows to a smaller database",
                          cinema->cdb);
}

bool tc_cinema_text_ok(const char *text, char *why, size_t capacity)
{
    const char *trouble = !*text                     ? "is empty: leave it out"
                          : tc_csv_like_number(text) ? "reads as a number: give it a letter"
                          : !tc_csv_is_utf8(text)    ? "is not UTF-8: rename it"
                                                     : NULL;
    if (trouble && why)
        snprintf(why, capacity, "'%.200s' cannot be a text in a Cinema database, because it %s", text, trouble);
    return !trouble;
}

/* Rows. */

tc_cinema_row *tc_cinema_row_make(const tc_cinema_cell *cell, size_t n)
{
    size_t bytes = 0;
    for (size_t i = 0; i < n; i++)
        bytes += cell[i].text ? strlen(cell[i].text) + 1 : 0;
    tc_cinema_row *row = malloc(sizeof *row + n * sizeof *cell + bytes);
    if (!row)
        return NULL;
    char *text = (char *)(row->cell + n);
    row->n = n;
    memcpy(row->cell, cell, n * sizeof *cell);
    for (size_t i = 0; i < n; i++) {
        if (!cell[i].text)
            continue;
        size_t length = strlen(cell[i].text) + 1;
        row->cell[i].text = memcpy(text, cell[i].text, length);
        text += length;
    }
    return row;
}

void tc_cinema_rows_free(tc_cinema_row **row, size_t n)
{
    for (size_t i = 0; row && i < n; i++)
        free(row[i]);
    free(row);
}

static int compare_cells(const tc_cinema_cell *a, const tc_cinema_cell *b, tc_cinema_type type)
{
    if (a->missing || b->missing)
        return a->missing - b->missing;
    if (type == TC_CINEMA_FLOAT && (isnan(a->number) || isnan(b->number)))
        return !!isnan(a->number) - !!isnan(b->number);
    if (type == TC_CINEMA_FLOAT)
        return (a->number > b->number) - (a->number < b->number);
    if (type == TC_CINEMA_INTEGER)
        return (a->integer > b->integer) - (a->integer < b->integer);
    return strcmp(a->text, b->text);
}

int tc_cinema_row_compare(const void *a, const void *b, void *cinema)
{
    const tc_cinema *c = cinema;
    const tc_cinema_row *const *one = a, *const *two = b;
    for (size_t i = 0; i < c->n; i++) {
        int order = compare_cells(&(*one)->cell[i], &(*two)->cell[i], c->column[i].type);
        if (order)
            return order;
    }
    return 0;
}

/* What makes two rows the same: key 0 is all parameters, key k > 0 the k-th file. */

static size_t key_first(const tc_cinema *c, size_t key)
{
    return key ? c->n_parameters + key - 1 : 0;
}
static size_t key_end(const tc_cinema *c, size_t key)
{
    return key ? c->n_parameters + key : c->n_parameters;
}

static bool key_same(const tc_cinema *c, const tc_cinema_cell *a, const tc_cinema_cell *b, size_t key)
{
    for (size_t i = key_first(c, key); i < key_end(c, key); i++)
        if (compare_cells(&a[i], &b[i], c->column[i].type) != 0)
            return false;
    return true;
}

static uint64_t mix(uint64_t hash, const void *bytes, size_t n)
{
    const unsigned char *p = bytes;
    for (size_t i = 0; i < n; i++)
        hash = (hash ^ p[i]) * 0x100000001B3u; /* FNV-1a */
    return hash;
}

static uint64_t key_hash(const tc_cinema *c, const tc_cinema_cell *cell, size_t key)
{
    uint64_t hash = mix(0xCBF29CE484222325u, &key, sizeof key);
    for (size_t i = key_first(c, key); i < key_end(c, key); i++) {
        const double number = isnan(cell[i].number) ? 0 : cell[i].number + 0.0; /* -0 and 0 are one */
        hash = mix(hash, &cell[i].missing, 1);
        if (cell[i].missing)
            continue;
        if (cell[i].text)
            hash = mix(hash, cell[i].text, strlen(cell[i].text) + 1);
        else if (c->column[i].type == TC_CINEMA_INTEGER)
            hash = mix(hash, &cell[i].integer, sizeof cell[i].integer);
        else
            hash = mix(hash, &number, sizeof number);
    }
    return hash ^ hash >> 29;
}

/* The row of this run with the same key; SIZE_MAX: none. */
static size_t own_find(const tc_cinema *c, const tc_cinema_cell *cell, size_t key)
{
    if (!c->n_slot || (key && cell[key_first(c, key)].missing))
        return SIZE_MAX;
    size_t mask = c->n_slot - 1;
    for (size_t at = key_hash(c, cell, key) & mask; c->slot[at].row; at = (at + 1) & mask) {
        const tc_cinema_row *row = c->own[c->slot[at].row - 1];
        if (row && c->slot[at].key == key && key_same(c, row->cell, cell, key))
            return c->slot[at].row - 1;
    }
    return SIZE_MAX;
}

static void slot_take(tc_cinema *c, size_t index)
{
    for (size_t key = 0; key <= c->n - c->n_parameters; key++) {
        const tc_cinema_cell *cell = c->own[index]->cell;
        if (key && cell[key_first(c, key)].missing)
            continue;
        size_t mask = c->n_slot - 1, at = key_hash(c, cell, key) & mask;
        while (c->slot[at].row)
            at = (at + 1) & mask;
        c->slot[at] = (tc_cinema_slot){index + 1, key};
        c->n_taken++;
    }
}

/* Room for one row more: rows that were replaced go, the rest finds its slots anew. */
static bool own_grow(tc_cinema *c)
{
    size_t keys = c->n - c->n_parameters + 1;
    if (c->n_own == c->capacity) {
        size_t capacity = c->capacity * 2 + 256;
        tc_cinema_row **own = realloc(c->own, capacity * sizeof *own);
        if (!own)
            return false;
        c->own = own;
        c->capacity = capacity;
    }
    if ((c->n_taken + keys) * 2 <= c->n_slot)
        return true;
    size_t live = 0, n_slot = 1024;
    for (size_t i = 0; i < c->n_own; i++)
        live += c->own[i] != NULL;
    while (n_slot < (live + 1) * keys * 4)
        n_slot *= 2;
    tc_cinema_slot *slot = calloc(n_slot, sizeof *slot);
    if (!slot)
        return false;
    free(c->slot);
    c->slot = slot;
    c->n_slot = n_slot;
    c->n_taken = 0;
    live = 0;
    for (size_t i = 0; i < c->n_own; i++)
        if (c->own[i])
            c->own[live++] = c->own[i];
    c->n_own = live;
    for (size_t i = 0; i < live; i++)
        slot_take(c, i);
    return true;
}

bool tc_cinema_is_replaced(const tc_cinema *c, const tc_cinema_row *row)
{
    for (size_t key = 0; key <= c->n - c->n_parameters; key++)
        if (own_find(c, row->cell, key) != SIZE_MAX)
            return true;
    return false;
}

/* A value as it is kept. */
static tc_status cell_of(tc_cinema_cell *out, const tc_cinema *c, size_t i, const tc_cinema_value *value, tc_error *err)
{
    char why[320];
    const tc_cinema_type type = c->column[i].type;
    *out = (tc_cinema_cell){.missing = true};
    if (value->missing || (type == TC_CINEMA_FLOAT && isnan(value->number)) || (type >= TC_CINEMA_TEXT && !value->text))
        return TC_OK;
    out->missing = false;
    if (type == TC_CINEMA_FLOAT && !isfinite(value->number))
        return tc_cinema_fail(err, TC_E_ARG, "%s: an infinite %s cannot be in a Cinema database; leave it out", c->cdb,
                              c->column[i].name);
    if (type == TC_CINEMA_FLOAT)
        out->number = value->number;
    else if (type == TC_CINEMA_INTEGER)
        out->integer = value->integer;
    else if (!tc_cinema_text_ok(value->text, why, sizeof why))
        return tc_cinema_fail(err, TC_E_ARG, "%s, column %s: %s", c->cdb, c->column[i].name, why);
    else if (type == TC_CINEMA_FILE && *value->text == '/')
        return tc_cinema_fail(err, TC_E_ARG, "%s: %s is a path from the root; give one as seen from that folder",
                              c->cdb, value->text);
    else
        out->text = value->text;
    return TC_OK;
}

tc_status tc_cinema_add(tc_cinema *c, const tc_cinema_value *value, tc_error *err)
{
    tc_cinema_cell cell[TC_CINEMA_COLUMNS_MAX];
    bool any = false;
    for (size_t i = 0; i < c->n; i++) {
        tc_status status = cell_of(&cell[i], c, i, &value[i], err);
        if (status != TC_OK)
            return status;
        any = any || !cell[i].missing;
    }
    if (!any)
        return tc_cinema_fail(err, TC_E_ARG, "%s: a row without any value; give it one", c->cdb);
    tc_cinema_row *row = own_grow(c) ? tc_cinema_row_make(cell, c->n) : NULL;
    if (!row)
        return no_memory(err, c);
    for (size_t key = 0; key <= c->n - c->n_parameters; key++) {
        size_t old = own_find(c, cell, key);
        if (old != SIZE_MAX) {
            free(c->own[old]);
            c->own[old] = NULL;
            c->n_live--;
        }
    }
    c->own[c->n_own++] = row;
    c->n_live++;
    slot_take(c, c->n_own - 1);
    return TC_OK;
}

/* Reading. */

/* Has the first row the names of the columns? */
static tc_status read_header(const tc_cinema *c, tc_csv_reader *reader, tc_error *err)
{
    tc_csv_cell name[TC_CINEMA_COLUMNS_MAX];
    char there[240] = "", here[240] = "";
    const char *why;
    size_t n;
    if (tc_csv_next(reader, name, TC_CINEMA_COLUMNS_MAX, &n, &why) < 0)
        return tc_cinema_fail(err, TC_E_FILE, "%s/data.csv is damaged in its first line: %s; mend it or remove it",
                              c->cdb, why);
    bool same = n == c->n;
    for (size_t i = 0; same && i < n; i++)
        same = !strcmp(name[i].text, c->column[i].name);
    if (same)
        return TC_OK;
    for (size_t i = 0, at = 0; i < n && i < TC_CINEMA_COLUMNS_MAX && at < sizeof there; i++)
        at += (size_t)snprintf(there + at, sizeof there - at, "%s%s", i ? "," : "", name[i].text);
    for (size_t i = 0, at = 0; i < c->n && at < sizeof here; i++)
        at += (size_t)snprintf(here + at, sizeof here - at, "%s%s", i ? "," : "", c->column[i].name);
    return tc_cinema_fail(
        err, TC_E_FILE,
        "%s/data.csv is of another run: it has the columns %s, and this run has %s; give another folder, "
        "or remove the old one",
        c->cdb, there, here);
}

static bool read_cell(tc_cinema_cell *out, tc_cinema_type type, const tc_csv_cell *from)
{
    *out = (tc_cinema_cell){.missing = !from->quoted && !*from->text};
    if (out->missing)
        return true;
    if (type == TC_CINEMA_FLOAT)
        return tc_csv_read_float(&out->number, from->text);
    if (type == TC_CINEMA_INTEGER)
        return tc_csv_read_integer(&out->integer, from->text);
    out->text = from->text;
    return true;
}

tc_status tc_cinema_rows_read(tc_cinema_row ***out, size_t *n_out, const tc_cinema *c, char *text, size_t bytes,
                              tc_error *err)
{
    static const char *const kind[] = {"number", "whole number", "text", "file"};
    tc_csv_reader reader;
    tc_csv_cell value[TC_CINEMA_COLUMNS_MAX];
    tc_cinema_cell cell[TC_CINEMA_COLUMNS_MAX];
    tc_cinema_row **row = NULL;
    size_t n_row = 0, capacity = 0, n;
    const char *why;
    *out = NULL;
    *n_out = 0;
    if (!bytes)
        return TC_OK;
    tc_csv_begin(&reader, text, bytes);
    tc_status status = read_header(c, &reader, err);
    while (status == TC_OK) {
        long line = reader.line;
        int got = tc_csv_next(&reader, value, TC_CINEMA_COLUMNS_MAX, &n, &why);
        if (got == 0)
            break;
        if (got < 0)
            status =
                tc_cinema_fail(err, TC_E_FILE,
                               "%s/data.csv is damaged in line %ld: %s; mend or remove that line, and what it named "
                               "can be added again",
                               c->cdb, line, why);
        else if (n != c->n)
            status =
                tc_cinema_fail(err, TC_E_FILE,
                               "%s/data.csv is damaged in line %ld: %zu values where %zu columns are; mend or remove "
                               "that line, and what it named can be added again",
                               c->cdb, line, n, c->n);
        for (size_t i = 0; status == TC_OK && i < n; i++)
            if (!read_cell(&cell[i], c->column[i].type, &value[i]))
                status =
                    tc_cinema_fail(err, TC_E_FILE,
                                   "%s/data.csv is of another run: in line %ld, column %s, '%.100s' is no %s; give "
                                   "another folder, or remove the old one",
                                   c->cdb, line, c->column[i].name, value[i].text, kind[c->column[i].type]);
        if (status == TC_OK && n_row == capacity) {
            capacity = capacity * 2 + 256;
            tc_cinema_row **more = realloc(row, capacity * sizeof *more);
            if (!more)
                status = no_memory(err, c);
            else
                row = more;
        }
        if (status == TC_OK && !(row[n_row] = tc_cinema_row_make(cell, c->n)))
            status = no_memory(err, c);
        n_row += status == TC_OK;
    }
    if (status != TC_OK) {
        tc_cinema_rows_free(row, n_row);
        return status;
    }
    *out = row;
    *n_out = n_row;
    return TC_OK;
}

/* Writing. */

void tc_cinema_rows_write(tc_csv_text *out, const tc_cinema *c, tc_cinema_row *const *row, size_t n)
{
    char number[40];
    for (size_t i = 0; i < c->n; i++) {
        tc_csv_put(out, ",", i > 0);
        tc_csv_put_value(out, c->column[i].name);
    }
    tc_csv_put(out, "\n", 1);
    for (size_t k = 0; k < n; k++) {
        for (size_t i = 0; i < c->n; i++) {
            const tc_cinema_cell *cell = &row[k]->cell[i];
            tc_csv_put(out, ",", i > 0);
            if (cell->missing)
                continue;
            if (cell->text) {
                tc_csv_put_value(out, cell->text);
                continue;
            }
            if (c->column[i].type == TC_CINEMA_INTEGER)
                snprintf(number, sizeof number, "%lld", cell->integer);
            else
                tc_csv_float(number, cell->number);
            tc_csv_put(out, number, strlen(number));
        }
        tc_csv_put(out, "\n", 1);
    }
}
