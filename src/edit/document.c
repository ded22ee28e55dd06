/* document.c: documents made, copied and compared; their values at a place. */
#include "edit/document.h"

#include "edit/colors.h"
#include "edit/fail.h"
#include "edit/piece.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

tc_status tc_document_create(tc_document **out, const double range[2], tc_error *err)
{
    *out = NULL;
    tc_document *document = calloc(1, sizeof *document);
    tc_edit_point *point = tc_edit_room(NULL, 2, sizeof *point);
    if (document)
        document->kept = tc_edit_colors_create();
    if (!document || !point || !document->kept) {
        free(point);
        tc_document_destroy(&document);
        return tc_edit_no_room(err, "transfer function", 1);
    }
    point[0] = (tc_edit_point){.x = 0, .a = 0, .midpoint = 0.5};
    point[1] = (tc_edit_point){.x = 1, .a = 0.3, .midpoint = 0.5};
    document->point = point;
    document->n_point = 2;
    memcpy(document->range, range, sizeof document->range);
    document->nan_color[3] = 1;
    const tc_status status = tc_document_take_preset(document, "Cool to Warm", NULL, err);
    if (status != TC_OK) {
        tc_document_destroy(&document);
        return status;
    }
    *out = document;
    return TC_OK;
}

tc_status tc_document_copy(tc_document **out, const tc_document *document, tc_error *err)
{
    *out = NULL;
    tc_document *copy = calloc(1, sizeof *copy);
    if (!copy)
        return tc_edit_no_room(err, "transfer function", 1);
    *copy = *document;
    const char *name = document->name ? document->name : "";
    const size_t length = strlen(name) + 1;
    copy->name = tc_edit_room(NULL, length, 1);
    copy->point = tc_edit_room(NULL, document->n_point, sizeof *copy->point);
    copy->color = tc_edit_room(NULL, document->n_color, sizeof *copy->color);
    copy->kept = tc_edit_colors_create();
    if (!copy->name || !copy->point || !copy->color || !copy->kept) {
        tc_document_destroy(&copy);
        return tc_edit_no_room(err, "points of a transfer function", document->n_point + document->n_color);
    }
    memcpy(copy->name, name, length);
    memcpy(copy->point, document->point, document->n_point * sizeof *copy->point);
    memcpy(copy->color, document->color, document->n_color * sizeof *copy->color);
    *out = copy;
    return TC_OK;
}

void tc_document_destroy(tc_document **document)
{
    if (!document || !*document)
        return;
    free((*document)->name);
    free((*document)->point);
    free((*document)->color);
    tc_edit_colors_destroy(&(*document)->kept);
    free(*document);
    *document = NULL;
}

bool tc_document_equal(const tc_document *a, const tc_document *b)
{
    if (a->space != b->space || a->hsv_wrap != b->hsv_wrap || a->n_point != b->n_point || a->n_color != b->n_color ||
        a->range[0] != b->range[0] || a->range[1] != b->range[1] || a->log != b->log ||
        a->unit_distance != b->unit_distance || a->has_nan_color != b->has_nan_color)
        return false;
    for (int c = 0; c < 4; c++)
        if (a->nan_color[c] != b->nan_color[c])
            return false;
    for (size_t i = 0; i < a->n_point; i++) {
        const tc_edit_point *p = &a->point[i], *q = &b->point[i];
        if (p->x != q->x || p->a != q->a || p->midpoint != q->midpoint || p->sharpness != q->sharpness)
            return false;
    }
    for (size_t i = 0; i < a->n_color; i++) {
        const tc_edit_color *p = &a->color[i], *q = &b->color[i];
        if (p->x != q->x || p->rgb[0] != q->rgb[0] || p->rgb[1] != q->rgb[1] || p->rgb[2] != q->rgb[2])
            return false;
    }
    return true;
}

double tc_document_scalar(const tc_document *document, double x)
{
    const double lo = document->range[0], hi = document->range[1];
    if (x == 0 || x == 1)
        return document->range[x == 1];
    return document->log ? exp(log(lo) * (1 - x) + log(hi) * x) : lo * (1 - x) + hi * x;
}

double tc_document_place(const tc_document *document, double scalar)
{
    double lo = document->range[0], hi = document->range[1];
    if (document->log) {
        if (!(scalar > 0))
            return -INFINITY;
        if (scalar == lo || scalar == hi)
            return scalar == hi;
        lo = log(lo);
        hi = log(hi);
        scalar = log(scalar);
    }
    const double width = hi - lo;
    return isfinite(width) ? (scalar - lo) / width : (0.5 * scalar - 0.5 * lo) / (0.5 * hi - 0.5 * lo);
}

double tc_document_opacity(const tc_document *document, double x)
{
    size_t lo = 0, hi = document->n_point; /* the first behind x */
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (document->point[middle].x <= x)
            lo = middle + 1;
        else
            hi = middle;
    }
    if (lo == 0 || lo == document->n_point)
        return document->point[lo ? lo - 1 : 0].a;
    const tc_edit_point *p = &document->point[lo - 1];
    return tc_piece_value(p[0].a, p[1].a, (x - p[0].x) / (p[1].x - p[0].x), (tc_bend){p->midpoint, p->sharpness});
}

void tc_document_color(double rgb[3], const tc_document *document, double x)
{
    tc_edit_colors *own = document->kept ? NULL : tc_edit_colors_create();
    tc_edit_colors_at(rgb, document->kept ? document->kept : own, document, x);
    tc_edit_colors_destroy(&own);
}
