/* soup.c: soups that grow tet by tet, and what is done to whole soups.
 * Rotation: Rodrigues 1840. */
#include "soup.h"

#include "core/memory.h"
#include "core/vec.h"

#include <stdlib.h>
#include <string.h>

/* Makes room for one more of size bytes in *array. */
static bool grow(tc_builder *b, void **array, size_t *room, size_t n, size_t size)
{
    if (b->failure)
        return false;
    if (n >= INT32_MAX) {
        b->failure = TC_BUILDER_IDS;
        return false;
    }
    if (n < *room)
        return true;
    size_t more = n < 512 ? 1024 : 2 * n;
    void *p = tc_realloc(*array, more, size);
    if (!p) {
        b->failure = TC_BUILDER_MEMORY;
        return false;
    }
    *array = p;
    *room = more;
    return true;
}

int32_t tc_builder_vertex(tc_builder *b, double x, double y, double z)
{
    tc_synth_soup *s = b->soup;
    void *array = s->vertex;
    bool fits = grow(b, &array, &b->vertex_room, s->n_vertex, 3 * sizeof *s->vertex);
    s->vertex = array;
    if (!fits)
        return 0;
    double *p = s->vertex + 3 * s->n_vertex;
    p[0] = x, p[1] = y, p[2] = z;
    return (int32_t)s->n_vertex++;
}

void tc_builder_tet(tc_builder *b, int32_t v0, int32_t v1, int32_t v2, int32_t v3)
{
    tc_synth_soup *s = b->soup;
    void *array = s->tet;
    bool fits = grow(b, &array, &b->tet_room, s->n_tet, 4 * sizeof *s->tet);
    s->tet = array;
    if (!fits)
        return;
    int32_t *t = s->tet + 4 * s->n_tet++;
    t[0] = v0, t[1] = v1, t[2] = v2, t[3] = v3;
}

void tc_builder_tet_turned(tc_builder *b, int32_t v0, int32_t v1, int32_t v2, int32_t v3, bool odd)
{
    tc_builder_tet(b, v0, v1, odd ? v3 : v2, odd ? v2 : v3);
}

tc_status tc_builder_done(const tc_builder *b, tc_error *err)
{
    if (b->failure == TC_BUILDER_IDS)
        return tc_fail(err, TC_E_ARG,
                       "more than %zu tets with %zu vertices are too many for 32-bit ids; ask for fewer "
                       "cells",
                       b->soup->n_tet, b->soup->n_vertex);
    if (b->failure)
        return tc_fail_memory(err, "a synthetic mesh", 2 * (b->soup->n_vertex + b->soup->n_tet), 24);
    return TC_OK;
}

tc_status tc_soup_append(tc_synth_soup *soup, const tc_synth_soup *more, tc_error *err)
{
    tc_builder b = {.soup = soup};
    int32_t first = (int32_t)soup->n_vertex;
    for (size_t v = 0; v < more->n_vertex; v++)
        tc_builder_vertex(&b, more->vertex[3 * v], more->vertex[3 * v + 1], more->vertex[3 * v + 2]);
    for (size_t t = 0; t < more->n_tet && !b.failure; t++) {
        const int32_t *v = more->tet + 4 * t;
        tc_builder_tet(&b, first + v[0], first + v[1], first + v[2], first + v[3]);
    }
    return tc_builder_done(&b, err);
}

typedef struct place {
    double p[3];
    int32_t vertex;
} place;

static int compare_places(const void *a, const void *b)
{
    const place *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->p[k] != q->p[k])
            return p->p[k] < q->p[k] ? -1 : 1;
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

/* same [n_vertex]: the first vertex at the place of each. */
static tc_status find_same(int32_t *same, const tc_synth_soup *s, tc_error *err)
{
    place *sorted = tc_alloc(s->n_vertex, sizeof *sorted);
    if (!sorted)
        return tc_fail_memory(err, "welding points", s->n_vertex, sizeof *sorted);
    for (size_t v = 0; v < s->n_vertex; v++) {
        tc_vec_copy(sorted[v].p, s->vertex + 3 * v);
        sorted[v].vertex = (int32_t)v;
    }
    qsort(sorted, s->n_vertex, sizeof *sorted, compare_places);
    for (size_t i = 0, first = 0; i < s->n_vertex; i++) {
        for (int k = 0; k < 3; k++)
            if (sorted[i].p[k] != sorted[first].p[k])
                first = i;
        same[sorted[i].vertex] = sorted[first].vertex;
    }
    free(sorted);
    return TC_OK;
}

static bool repeats(const int32_t *v)
{
    return v[0] == v[1] || v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3] || v[2] == v[3];
}

tc_status tc_soup_weld(tc_synth_soup *s, tc_error *err)
{
    int32_t *same = tc_alloc(s->n_vertex, sizeof *same), *number = tc_alloc(s->n_vertex, sizeof *number);
    tc_status status = TC_OK;
    if (!same || !number)
        status = tc_fail_memory(err, "welding points", s->n_vertex, 2 * sizeof *same);
    if (!status)
        status = find_same(same, s, err);
    if (status)
        goto done;
    memset(number, 0xff, s->n_vertex * sizeof *number);
    size_t n_tet = 0, n_vertex = 0;
    for (size_t t = 0; t < s->n_tet; t++) {
        int32_t *w = s->tet + 4 * n_tet;
        for (int k = 0; k < 4; k++)
            w[k] = same[s->tet[4 * t + (size_t)k]];
        if (repeats(w))
            continue;
        for (int k = 0; k < 4; k++)
            number[w[k]] = 0;
        n_tet++;
    }
    for (size_t v = 0; v < s->n_vertex; v++)
        if (number[v] == 0) {
            number[v] = (int32_t)n_vertex;
            tc_vec_copy(s->vertex + 3 * n_vertex++, s->vertex + 3 * v);
        }
    for (size_t i = 0; i < 4 * n_tet; i++)
        s->tet[i] = number[s->tet[i]];
    s->n_tet = n_tet, s->n_vertex = n_vertex;
done:
    free(same);
    free(number);
    return status;
}

tc_status tc_soup_values(tc_synth_soup *s, tc_association association, tc_error *err)
{
    size_t n = association == TC_CELL_DATA ? s->n_tet : s->n_vertex;
    s->association = association;
    s->scalar = tc_alloc(n, sizeof *s->scalar);
    return s->scalar ? TC_OK : tc_fail_memory(err, "the synthetic field", n, sizeof *s->scalar);
}

static void turn(double *out, const double *p, double angle)
{
    const double axis[3] = {1 / sqrt(14), 2 / sqrt(14), 3 / sqrt(14)};
    double along = tc_vec_dot(axis, p) * (1 - cos(angle)), across[3];
    tc_vec_cross(across, axis, p);
    for (int k = 0; k < 3; k++)
        out[k] = cos(angle) * p[k] + sin(angle) * across[k] + along * axis[k];
}

void tc_point_turn(double *out, const double *p)
{
    turn(out, p, 1);
}

void tc_point_turn_back(double *out, const double *p)
{
    turn(out, p, -1);
}
