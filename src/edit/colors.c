/* colors.c: a document's colours as the library interpolates them, kept until they change. */
#include "edit/colors.h"

#include "edit/fail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct tc_edit_colors {
    tc_edit_space space; /* of what is kept, as are color [n] */
    bool hsv_wrap;
    size_t n;
    tc_edit_color *color;
    tc_transfer *function; /* over the unit interval; NULL: nothing is kept */
};

tc_edit_colors *tc_edit_colors_create(void)
{
    return calloc(1, sizeof(tc_edit_colors));
}

static void forget(tc_edit_colors *colors)
{
    tc_transfer_destroy(&colors->function);
    free(colors->color);
    colors->color = NULL;
    colors->n = 0;
}

void tc_edit_colors_destroy(tc_edit_colors **colors)
{
    if (!colors || !*colors)
        return;
    forget(*colors);
    free(*colors);
    *colors = NULL;
}

static bool are_kept(const tc_edit_colors *colors, const tc_document *document)
{
    if (!colors->function || colors->n != document->n_color || colors->space != document->space ||
        colors->hsv_wrap != document->hsv_wrap)
        return false;
    for (size_t i = 0; i < colors->n; i++) {
        const tc_edit_color *p = &colors->color[i], *q = &document->color[i];
        if (p->x != q->x || p->rgb[0] != q->rgb[0] || p->rgb[1] != q->rgb[1] || p->rgb[2] != q->rgb[2])
            return false;
    }
    return true;
}

/* Leaves nothing kept where memory is out. */
static void keep(tc_edit_colors *colors, const tc_document *document)
{
    forget(colors);
    tc_edit_point level[2] = {{.x = 0, .midpoint = 0.5}, {.x = 1, .midpoint = 0.5}};
    tc_document plain = *document;
    plain.point = level;
    plain.n_point = 2;
    char *text = tc_document_text(&plain, true);
    colors->color = tc_edit_room(NULL, document->n_color, sizeof *colors->color);
    if (text && colors->color) {
        const tc_transfer_options options = {.color_map = text, .data_range = {0, 1}};
        tc_error unread;
        if (tc_transfer_create(&colors->function, &options, &unread) == TC_OK) {
            memcpy(colors->color, document->color, document->n_color * sizeof *colors->color);
            colors->n = document->n_color;
            colors->space = document->space;
            colors->hsv_wrap = document->hsv_wrap;
        }
    }
    free(text);
}

static void nearest(double rgb[3], const tc_document *document, double x)
{
    size_t best = 0;
    for (size_t i = 1; i < document->n_color; i++)
        if (fabs(document->color[i].x - x) <= fabs(document->color[best].x - x))
            best = i;
    memcpy(rgb, document->color[best].rgb, sizeof document->color[best].rgb);
}

void tc_edit_colors_at(double rgb[3], tc_edit_colors *colors, const tc_document *document, double x)
{
    if (colors && !are_kept(colors, document))
        keep(colors, document);
    if (!colors || !colors->function) {
        nearest(rgb, document, x);
        return;
    }
    size_t n, lo = 0;
    const tc_knot *knot = tc_transfer_knots(colors->function, &n);
    for (size_t hi = n; lo < hi;) { /* the first behind x */
        const size_t middle = lo + (hi - lo) / 2;
        if (knot[middle].s <= x)
            lo = middle + 1;
        else
            hi = middle;
    }
    const tc_knot *a = &knot[lo > 0 ? lo - 1 : 0], *b = &knot[lo < n ? lo : n - 1];
    const double t = b->s > a->s ? (x - a->s) / (b->s - a->s) : 0;
    rgb[0] = a->r + t * (b->r - a->r);
    rgb[1] = a->g + t * (b->g - a->g);
    rgb[2] = a->b + t * (b->b - a->b);
}
