/* curve_edit.c: edits of the document by the opacity curve, whether pointer or keys ask for them. */
#include "window/curve_state.h"

#include <math.h>
#include <stdlib.h>

#include "window/plot.h"

enum { TC_CURVE_POINTS = 1024, TC_CURVE_SHAPE_POINTS = 64 };

void tc_curve_told(tc_curve *curve, const char *what)
{
    curve->telling = true;
    tc_session_edited(curve->session, what);
    curve->telling = false;
    const size_t n = curve->session->document->n_point;
    curve->focus = curve->focus < n ? curve->focus : n - 1;
    tc_curve_describe(curve);
    gtk_widget_queue_draw(curve->area);
}

static void tc_select_none(tc_document *d)
{
    for (size_t i = 0; i < d->n_point; i++)
        d->point[i].selected = false;
}

void tc_curve_select(tc_curve *curve, size_t index)
{
    tc_document *d = curve->session->document;
    tc_select_none(d);
    curve->focus = index < d->n_point ? index : d->n_point - 1;
    d->point[curve->focus].selected = true;
    tc_curve_told(curve, NULL);
}

void tc_curve_shift(tc_curve *curve, double dx, double dy, size_t index)
{
    tc_document *d = curve->session->document;
    if (index >= d->n_point)
        return;
    const double a = d->point[index].a;
    /* The one in hand stays on the axis. */
    const double place = fmin(fmax(tc_axis_place(&curve->axis, a) + dy, 0), 1);
    const double target = dy != 0 ? tc_axis_value(&curve->axis, place) : a;
    size_t n = 0;
    for (size_t i = 0; i < d->n_point; i++)
        n += d->point[i].selected;
    double went[2];
    if (curve->axis.log && n > 1 && a > 0)
        tc_document_scale(d, dx, target / a);
    else
        tc_document_move(went, d, dx, target - a);
}

void tc_curve_bend(tc_curve *curve, size_t piece, double midpoint, double sharpness)
{
    tc_document *d = curve->session->document;
    if (piece + 1 >= d->n_point)
        return;
    tc_edit_point *p = &d->point[piece];
    p->midpoint = fmin(fmax(p->midpoint + midpoint, 0.001), 0.999);
    p->sharpness = fmin(fmax(p->sharpness + sharpness, 0), 1);
}

/* Points thinned along an axis get others between them, so that neighbours are no more than a step of it apart. */
static size_t tc_refine(tc_edit_point *out, size_t capacity, const tc_edit_point *point, size_t n, double step)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        const double length = i + 1 < n && point[i + 1].x > point[i].x ? fabs(point[i + 1].a - point[i].a) : 0;
        const size_t parts = (size_t)fmax(ceil(length / step), 1);
        if (count + parts > capacity)
            return 0;
        for (size_t k = 0; k < parts; k++) {
            const double t = (double)k / (double)parts;
            out[count] = point[i];
            if (k > 0) {
                out[count].x = point[i].x + t * (point[i + 1].x - point[i].x);
                out[count].a = point[i].a + t * (point[i + 1].a - point[i].a);
            }
            count++;
        }
    }
    return count;
}

bool tc_curve_freehand(tc_curve *curve, const double *line, size_t n)
{
    size_t from = 0;
    while (from < n && isnan(line[from]))
        from++;
    size_t to = from;
    while (to < n && !isnan(line[to]))
        to++;
    if (to < from + 2)
        return false;
    const size_t count = to - from;
    double *x = malloc(2 * count * sizeof *x), *a = x ? x + count : NULL;
    tc_edit_point *point = malloc(2 * (size_t)TC_CURVE_POINTS * sizeof *point);
    tc_edit_point *thin = point ? point + TC_CURVE_POINTS : NULL;
    bool done = false;
    if (x && point) {
        for (size_t i = 0; i < count; i++) {
            x[i] = (double)(from + i) / (double)(n - 1);
            a[i] = line[from + i];
        }
        /* Thinned on the axis as it is seen; coarser where the hand shook too much. */
        const tc_axis *axis = &curve->axis;
        /* A factor of 1.5: a line that is straight in opacity is nearly so on the logarithmic axis. */
        const double step = axis->log ? log10(1.5) / axis->decades * (1 - axis->foot) : INFINITY;
        size_t kept = 0, made = 0;
        for (double error = 0.004; !made && error < 1; error *= 2) {
            kept = tc_shape_freehand(thin, TC_CURVE_POINTS, x, a, count, error);
            made = kept ? tc_refine(point, TC_CURVE_POINTS, thin, kept, step) : 0;
        }
        for (size_t i = 0; i < made; i++) {
            point[i].a = tc_axis_value(&curve->axis, point[i].a);
            point[i].midpoint = 0.5;
            point[i].sharpness = 0;
            point[i].selected = false;
        }
        tc_error err = {0};
        tc_select_none(curve->session->document);
        done = made > 0 && !tc_document_replace(curve->session->document, x[0], x[count - 1], point, made, &err);
    }
    free(point);
    free(x);
    return done;
}

void tc_curve_shape(tc_curve *curve, double from, double to, double height)
{
    tc_document *d = curve->session->document;
    from = fmax(from, 0);
    to = fmin(to, 1);
    if (!(to - from > 1e-4))
        return;
    /* Where the curve lies high already, the shape stands upon it, or is cut into it. */
    const double least = fmin(tc_document_opacity(d, from), tc_document_opacity(d, to));
    tc_edit_point point[TC_CURVE_SHAPE_POINTS];
    size_t n;
    const char *what;
    switch (curve->tool) {
    case TC_TOOL_TRAPEZOID:
        n = tc_shape_trapezoid(point, TC_CURVE_SHAPE_POINTS, from, to, 0.5, height, least);
        what = "place trapezoid";
        break;
    case TC_TOOL_STEP:
        n = tc_shape_step(point, TC_CURVE_SHAPE_POINTS, from, to, height, least);
        what = "place step";
        break;
    default:
        n = tc_shape_gaussian(point, TC_CURVE_SHAPE_POINTS, from, to, height, least);
        what = "place Gaussian";
        break;
    }
    tc_error err = {0};
    for (size_t i = 0; i < n; i++)
        point[i].selected = true;
    tc_select_none(d);
    if (!n || tc_document_replace(d, from, to, point, n, &err))
        return;
    for (size_t i = 0; i < d->n_point; i++)
        if (d->point[i].selected) {
            curve->focus = i;
            break;
        }
    tc_curve_told(curve, what);
}

/* The least round number that is not below. */
static double tc_round_up(double value)
{
    static const double round[] = {1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10};
    const double power = pow(10, floor(log10(value)));
    for (size_t i = 0; i < sizeof round / sizeof *round; i++)
        if (value <= round[i] * power * (1 + 1e-9))
            return round[i] * power;
    return 10 * power;
}

void tc_curve_top_set(tc_curve *curve, double top)
{
    if (!(top > 0) || !isfinite(top))
        return;
    curve->axis.top = fmin(fmax(top, 1e-9), 1e9);
    char number[32];
    gtk_editable_set_text(GTK_EDITABLE(curve->top_entry), tc_plot_number(number, curve->axis.top, 4));
    gtk_widget_queue_draw(curve->area);
}

void tc_curve_fit(tc_curve *curve, bool shrink)
{
    const tc_document *d = curve->session->document;
    double most = 0;
    for (size_t i = 0; i < d->n_point; i++)
        most = fmax(most, d->point[i].a);
    if (most > curve->axis.top * (1 + 1e-9) || (shrink && most > 0 && most < 0.2 * curve->axis.top))
        tc_curve_top_set(curve, tc_round_up(most));
}
