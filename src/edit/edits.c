/* edits.c: what a hand does to a document; its points keep their order, and its ends their places. */
#include "edit/document.h"

#include "edit/fail.h"
#include "edit/piece.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double limited(double v, double lo, double hi)
{
    return v > lo ? fmin(v, hi) : lo; /* not a number: lo */
}

/* ------------------------------------------------------------------------------------------------------- moving */

/* Points of either kind: n of `size` bytes, x first. */
typedef struct row {
    char *item;
    size_t n, size, selected; /* offset of the flag */
} row;

static row row_of_points(tc_document *document)
{
    return (row){(char *)document->point, document->n_point, sizeof *document->point,
                 offsetof(tc_edit_point, selected)};
}

static row row_of_colors(tc_document *document)
{
    return (row){(char *)document->color, document->n_color, sizeof *document->color,
                 offsetof(tc_edit_color, selected)};
}

static double *x_of(const row *r, size_t i)
{
    return (double *)(void *)(r->item + i * r->size);
}

static bool is_selected(const row *r, size_t i)
{
    return *(bool *)(r->item + i * r->size + r->selected);
}

/* Is it selected, and no end? */
static bool is_loose(const row *r, size_t i)
{
    return i > 0 && i + 1 < r->n && is_selected(r, i);
}

/* Moves what is loose by dx, or as far as it goes between what is not; gives how far. */
static double slide(const row *r, double dx)
{
    bool any = false;
    if (isnan(dx))
        return 0;
    for (size_t i = 1; i + 1 < r->n; i++) {
        if (!is_loose(r, i))
            continue;
        any = true;
        if (!is_loose(r, i - 1))
            dx = fmax(dx, *x_of(r, i - 1) - *x_of(r, i));
        if (!is_loose(r, i + 1))
            dx = fmin(dx, *x_of(r, i + 1) - *x_of(r, i));
    }
    if (!any || dx == 0)
        return 0;
    /* Sums are rounded: what reaches a neighbour has its x. */
    for (size_t i = 1; i + 1 < r->n; i++)
        if (is_loose(r, i))
            *x_of(r, i) = fmax(*x_of(r, i) + dx, *x_of(r, i - 1));
    for (size_t i = r->n - 1; i-- > 1;)
        if (is_loose(r, i))
            *x_of(r, i) = fmin(*x_of(r, i), *x_of(r, i + 1));
    return dx;
}

void tc_document_move(double went[2], tc_document *document, double dx, double da)
{
    const row points = row_of_points(document);
    bool any = false;
    went[0] = slide(&points, dx);
    for (size_t i = 0; i < document->n_point; i++)
        if (document->point[i].selected) {
            any = true;
            da = fmax(da, -document->point[i].a);
        }
    went[1] = any && isfinite(da) ? da : 0;
    for (size_t i = 0; i < document->n_point; i++) {
        const double a = fmax(0, document->point[i].a + went[1]);
        if (document->point[i].selected && isfinite(a))
            document->point[i].a = a;
    }
}

void tc_document_scale(tc_document *document, double dx, double factor)
{
    const row points = row_of_points(document);
    slide(&points, dx);
    for (size_t i = 0; i < document->n_point; i++) {
        const double a = document->point[i].a * factor;
        if (document->point[i].selected && a >= 0 && isfinite(a))
            document->point[i].a = a;
    }
}

void tc_document_move_colors(tc_document *document, double dx)
{
    const row colors = row_of_colors(document);
    slide(&colors, dx);
}

/* ---------------------------------------------------------------------------------------------- adding, deleting */

/* Where what is new at x goes: behind all at its place, but within the ends. */
static size_t place_in(const row *r, double x)
{
    size_t i = 1;
    while (i + 1 < r->n && *x_of(r, i) <= x)
        i++;
    return i;
}

tc_status tc_document_add_point(tc_document *document, size_t *index, double x, double a, tc_error *err)
{
    tc_edit_point *grown = tc_edit_room(document->point, document->n_point + 1, sizeof *grown);
    if (!grown)
        return tc_edit_no_room(err, "points of a transfer function", document->n_point + 1);
    document->point = grown;
    x = limited(x, 0, 1);
    a = isfinite(a) ? fmax(0, a) : 0;
    const row points = row_of_points(document);
    const size_t at = place_in(&points, x);
    tc_edit_point *before = &grown[at - 1], new = {.x = x, .a = a, .midpoint = 0.5};
    const double width = grown[at].x - before->x;
    if (width > 0) {
        const tc_bend bend = {before->midpoint, before->sharpness};
        const double t = limited((x - before->x) / width, 0, 1);
        if (t < 1) {
            const tc_bend right = tc_piece_part(before->a, grown[at].a, bend, t, 1);
            new.midpoint = right.midpoint;
            new.sharpness = right.sharpness;
        }
        if (t > 0) {
            const tc_bend left = tc_piece_part(before->a, grown[at].a, bend, 0, t);
            before->midpoint = left.midpoint;
            before->sharpness = left.sharpness;
        }
    }
    memmove(grown + at + 1, grown + at, (document->n_point - at) * sizeof *grown);
    grown[at] = new;
    document->n_point++;
    for (size_t i = 0; i < document->n_point; i++)
        grown[i].selected = i == at;
    if (index)
        *index = at;
    return TC_OK;
}

tc_status tc_document_add_color(tc_document *document, size_t *index, double x, const double rgb[3], tc_error *err)
{
    tc_edit_color *grown = tc_edit_room(document->color, document->n_color + 1, sizeof *grown);
    if (!grown)
        return tc_edit_no_room(err, "colours of a transfer function", document->n_color + 1);
    document->color = grown;
    x = limited(x, 0, 1);
    const row colors = row_of_colors(document);
    const size_t at = place_in(&colors, x);
    memmove(grown + at + 1, grown + at, (document->n_color - at) * sizeof *grown);
    grown[at] = (tc_edit_color){.x = x};
    for (int c = 0; c < 3; c++)
        grown[at].rgb[c] = limited(rgb[c], 0, 1);
    document->n_color++;
    for (size_t i = 0; i < document->n_color; i++)
        grown[i].selected = i == at;
    if (index)
        *index = at;
    return TC_OK;
}

/* Leaves out what is loose; gives how many stay. */
static size_t delete_loose(const row *r)
{
    size_t kept = 0;
    for (size_t i = 0; i < r->n; i++)
        if (!is_loose(r, i))
            memmove(r->item + kept++ * r->size, r->item + i * r->size, r->size);
    return kept;
}

void tc_document_delete_points(tc_document *document)
{
    const row points = row_of_points(document);
    document->n_point = delete_loose(&points);
}

void tc_document_delete_colors(tc_document *document)
{
    const row colors = row_of_colors(document);
    document->n_color = delete_loose(&colors);
}

/* ---------------------------------------------------------------------------------------------------- replacing */

static bool is_same(double a, double b)
{
    return fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b));
}

/* The part of the piece that begins at p, from t on or up to it. */
static tc_bend part_of(const tc_edit_point *p, double x, bool behind)
{
    const double t = limited((x - p[0].x) / (p[1].x - p[0].x), 0, 1);
    const tc_bend bend = {p->midpoint, p->sharpness}, line = {0.5, 0};
    if (t <= 0 || t >= 1)
        return behind == (t <= 0) ? bend : line;
    return tc_piece_part(p[0].a, p[1].a, bend, behind ? t : 0, behind ? 1 : t);
}

/* Into out, what stays before `from`: the curve up to there, a point at its end unless what comes begins there. Gives
 * their number. */
static size_t keep_before(tc_edit_point *out, const tc_document *document, double from, const tc_edit_point *next)
{
    const tc_edit_point *point = document->point;
    const bool meets = next && next->x <= from;
    size_t n = 0;
    if (from <= 0) {
        if (!meets)
            out[n++] = (tc_edit_point){.x = 0, .a = point[0].a, .midpoint = 0.5};
        return n;
    }
    while (point[n].x < from) {
        out[n] = point[n];
        n++;
    }
    double a = point[n].a;
    if (point[n].x > from) {
        const tc_bend bend = part_of(&point[n - 1], from, false);
        a = tc_document_opacity(document, from);
        out[n - 1].midpoint = bend.midpoint;
        out[n - 1].sharpness = bend.sharpness;
    }
    if (!meets || !is_same(next->a, a))
        out[n++] = (tc_edit_point){.x = from, .a = a, .midpoint = 0.5};
    return n;
}

/* The same of what stays behind `to`, where out has n already. */
static size_t keep_after(tc_edit_point *out, size_t n, const tc_document *document, double to)
{
    const tc_edit_point *point = document->point;
    const size_t count = document->n_point;
    if (to >= 1) {
        if (n == 0 || out[n - 1].x < 1)
            out[n++] = (tc_edit_point){.x = 1, .a = point[count - 1].a, .midpoint = 0.5};
        return n;
    }
    size_t i = 0; /* the first behind */
    while (point[i].x <= to)
        i++;
    tc_edit_point edge = point[i - 1];
    if (edge.x < to) {
        const tc_bend bend = part_of(&point[i - 1], to, true);
        edge = (tc_edit_point){to, tc_document_opacity(document, to), bend.midpoint, bend.sharpness, false};
    }
    if (n > 0 && out[n - 1].x >= to && is_same(out[n - 1].a, edge.a)) {
        out[n - 1].midpoint = edge.midpoint;
        out[n - 1].sharpness = edge.sharpness;
    } else {
        out[n++] = edge;
    }
    memcpy(out + n, point + i, (count - i) * sizeof *out);
    return n + count - i;
}

tc_status tc_document_replace(tc_document *document, double from, double to, const tc_edit_point *point, size_t n,
                              tc_error *err)
{
    const double begin = limited(fmin(from, to), 0, 1), end = limited(fmax(from, to), 0, 1);
    const size_t most = document->n_point + 2 > SIZE_MAX - n ? SIZE_MAX : document->n_point + 2 + n;
    tc_edit_point *out = tc_edit_room(NULL, most, sizeof *out);
    if (!out)
        return tc_edit_no_room(err, "points of a transfer function", most);
    size_t count = keep_before(out, document, begin, n > 0 ? point : NULL);
    for (size_t i = 0; i < n; i++) {
        const tc_edit_point *p = &point[i];
        const double least = i > 0 ? out[count - 1].x : begin;
        out[count++] = (tc_edit_point){.x = limited(p->x, least, end),
                                       .a = isfinite(p->a) ? fmax(0, p->a) : 0,
                                       .midpoint = limited(p->midpoint, 0, 1),
                                       .sharpness = limited(p->sharpness, 0, 1),
                                       .selected = p->selected};
    }
    count = keep_after(out, count, document, end);
    free(document->point);
    document->point = out;
    document->n_point = count;
    return TC_OK;
}
