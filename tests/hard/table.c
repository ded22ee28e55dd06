/* table.c: the results of a run, added up and written. */
#define _POSIX_C_SOURCE 200809L
#include "table.h"

#include "core/file.h"
#include "core/memory.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct hard_table {
    char context[32];
    hard_row *row, total;
    size_t n_row, row_room;
    hard_result *result;
    size_t n_result, result_room;
};

tc_status hard_table_create(hard_table **out, const char *context, tc_error *err)
{
    *out = tc_calloc(1, sizeof **out);
    if (!*out)
        return tc_fail_memory(err, "the table", 1, sizeof **out);
    snprintf((*out)->context, sizeof(*out)->context, "%s", context);
    return TC_OK;
}

void hard_table_destroy(hard_table **table)
{
    if (!*table)
        return;
    free((*table)->row);
    free((*table)->result);
    free(*table);
    *table = NULL;
}

static bool grow(void **array, size_t n, size_t *room, size_t size)
{
    if (n < *room)
        return true;
    size_t more = *room ? 2 * *room : 64;
    void *grown = tc_realloc(*array, more, size);
    if (!grown)
        return false;
    *array = grown;
    *room = more;
    return true;
}

tc_status hard_table_begin(hard_table *t, const hard_mesh *mesh, tc_error *err)
{
    if (!grow((void **)&t->row, t->n_row, &t->row_room, sizeof *t->row))
        return tc_fail_memory(err, "the table", t->n_row, sizeof *t->row);
    hard_row *row = &t->row[t->n_row++];
    memset(row, 0, sizeof *row);
    snprintf(row->mesh, sizeof row->mesh, "%s", mesh->name);
    hard_mesh_treatment(row->treatment, sizeof row->treatment, mesh);
    row->cells = mesh->mesh ? mesh->report.n_tet : 0;
    return TC_OK;
}

static void add_result(hard_row *row, const hard_result *r)
{
    hard_result *s = &row->sum;
    row->cases++;
    row->failed += r->failure[0] != 0;
    s->rays += r->rays;
    s->lost += r->lost;
    s->broken += r->broken;
    s->judged += r->judged;
    s->wrong += r->wrong;
    s->doubtful += r->doubtful;
    s->cycles += r->cycles;
    s->lengths += r->lengths;
    s->jumps += r->jumps;
    s->pixels += r->pixels;
    s->ill_posed += r->ill_posed;
    s->chords += r->chords;
    s->ill_chord += r->ill_chord;
    s->compared += r->compared;
    s->ill_compared += r->ill_compared;
    s->length_error = fmax(s->length_error, r->length_error);
    s->real_error = fmax(s->real_error, r->real_error);
    s->walk_error = fmax(s->walk_error, r->walk_error);
    s->picture_error = fmax(s->picture_error, r->picture_error);
    s->alpha_error = fmax(s->alpha_error, r->alpha_error);
    s->difference = fmax(s->difference, r->difference);
}

tc_status hard_table_add(hard_table *t, const hard_result *r, tc_error *err)
{
    if (!grow((void **)&t->result, t->n_result, &t->result_room, sizeof *t->result))
        return tc_fail_memory(err, "the table", t->n_result, sizeof *t->result);
    t->result[t->n_result++] = *r;
    add_result(&t->row[t->n_row - 1], r);
    add_result(&t->total, r);
    return TC_OK;
}

void hard_table_refuse(hard_table *t)
{
    t->row[t->n_row - 1].refused++;
    t->total.refused++;
}

void hard_table_used(size_t out[3], const hard_table *t)
{
    out[0] = out[1] = out[2] = 0;
    for (size_t i = 0; i < t->n_result; i++) {
        const hard_result *r = &t->result[i];
        bool seen[3] = {!r->rays, !r->rays, !r->rays};
        for (size_t k = 0; k < i; k++) {
            const hard_result *q = &t->result[k];
            seen[0] = seen[0] || (q->rays && !strcmp(q->mesh, r->mesh));
            seen[1] = seen[1] || (q->rays && !strcmp(q->view, r->view));
            seen[2] = seen[2] || (q->rays && !strcmp(q->function, r->function));
        }
        for (int k = 0; k < 3; k++)
            out[k] += !seen[k];
    }
}

const hard_row *hard_table_total(const hard_table *t)
{
    return &t->total;
}

/* ---------------------------------------------------------------------------------------------------------- markdown
 */

static void print_row(FILE *f, const hard_row *row, const char *name)
{
    const hard_result *s = &row->sum;
    fprintf(f, "| %s | %zu | %zu | %lld | %lld | %zu | %zu | %.1e | %.1e | %.1e | %.1e | %.1e | %zu of %zu | %s |\n",
            name, row->cells, row->cases, (long long)s->rays, (long long)s->lost, s->wrong, s->cycles, s->length_error,
            s->real_error, s->picture_error, s->alpha_error, s->difference, s->ill_posed, s->pixels, row->treatment);
}

tc_status hard_table_write_markdown(const hard_table *t, const char *path, tc_error *err)
{
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    if (!f)
        return tc_fail_memory(err, "the table", t->n_row, 256);
    fprintf(
        f, "| mesh | cells | cases | rays | lost | other cells | closed paths | length | real length | picture | alpha "
           "| same picture | ill-posed | treatment |\n"
           "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n");
    for (size_t i = 0; i < t->n_row; i++)
        print_row(f, &t->row[i], t->row[i].mesh);
    print_row(f, &t->total, "**all**");
    if (fclose(f) != 0) {
        free(text);
        return tc_fail_memory(err, "the table", t->n_row, 256);
    }
    tc_status status = tc_file_replace(path, text, n, err);
    free(text);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- JSON
 */

static json_t *json_of(const hard_result *r)
{
    return json_pack("{s:I s:I s:I s:I s:I s:I s:I s:I s:f s:f s:f s:I s:I s:I s:f s:I s:I s:f s:I s:I s:f}", "rays",
                     (json_int_t)r->rays, "rays_lost", (json_int_t)r->lost, "broken_cells", (json_int_t)r->broken,
                     "judged", (json_int_t)r->judged, "judged_lengths", (json_int_t)r->lengths, "other_cells",
                     (json_int_t)r->wrong, "doubtful", (json_int_t)r->doubtful, "closed_paths", (json_int_t)r->cycles,
                     "length_error", r->length_error, "real_length_error", r->real_error, "walk_error", r->walk_error,
                     "jumping_lengths", (json_int_t)r->jumps, "pixels", (json_int_t)r->pixels, "ill_posed",
                     (json_int_t)r->ill_posed, "picture_error", r->picture_error, "chords", (json_int_t)r->chords,
                     "ill_posed_chords", (json_int_t)r->ill_chord, "alpha_error", r->alpha_error, "compared",
                     (json_int_t)r->compared, "ill_posed_compared", (json_int_t)r->ill_compared, "difference",
                     r->difference);
}

static json_t *json_of_row(const hard_row *row)
{
    json_t *o = json_of(&row->sum);
    json_object_set_new(o, "mesh", json_string(row->mesh));
    json_object_set_new(o, "treatment", json_string(row->treatment));
    json_object_set_new(o, "cells", json_integer((json_int_t)row->cells));
    json_object_set_new(o, "cases", json_integer((json_int_t)row->cases));
    json_object_set_new(o, "failed", json_integer((json_int_t)row->failed));
    json_object_set_new(o, "refused", json_integer((json_int_t)row->refused));
    return o;
}

tc_status hard_table_write_json(const hard_table *t, const char *path, tc_error *err)
{
    json_t *meshes = json_array(), *cases = json_array();
    for (size_t i = 0; i < t->n_row; i++)
        json_array_append_new(meshes, json_of_row(&t->row[i]));
    for (size_t i = 0; i < t->n_result; i++) {
        const hard_result *r = &t->result[i];
        json_t *o = json_of(r);
        json_object_set_new(o, "mesh", json_string(r->mesh));
        json_object_set_new(o, "view", json_string(r->view));
        json_object_set_new(o, "function", json_string(r->function));
        if (r->relation[0])
            json_object_set_new(o, "relation", json_string(r->relation));
        if (r->failure[0])
            json_object_set_new(o, "failure", json_string(r->failure));
        json_array_append_new(cases, o);
    }
    json_t *root = json_pack("{s:s s:o s:o s:o}", "context", t->context, "total", json_of_row(&t->total), "meshes",
                             meshes, "cases", cases);
    char *text = root ? json_dumps(root, JSON_INDENT(1)) : NULL;
    tc_status status = text ? tc_file_replace(path, text, strlen(text), err)
                            : tc_fail_memory(err, "the table", t->n_result, sizeof *t->result);
    free(text);
    json_decref(root);
    return status;
}
