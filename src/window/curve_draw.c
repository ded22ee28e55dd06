/* curve_draw.c: the picture of the opacity curve. */
#include "window/curve_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "edit/columns.h"
#include "window/plot.h"

enum { TC_CURVE_TICKS = 64 };

void tc_curve_frame_get(tc_curve_frame *out, const tc_curve *curve)
{
    out->width = gtk_widget_get_width(curve->area);
    out->height = gtk_widget_get_height(curve->area);
    out->left = tc_plot_x(out->width, 0);
    out->right = tc_plot_x(out->width, 1);
    out->top = TC_CURVE_ABOVE;
    out->bottom = fmax(out->height - TC_CURVE_BELOW, TC_CURVE_ABOVE + 1);
}

double tc_curve_y(const tc_curve *curve, const tc_curve_frame *frame, double opacity)
{
    return frame->bottom - tc_axis_place(&curve->axis, opacity) * (frame->bottom - frame->top);
}

double tc_curve_opacity(const tc_curve *curve, const tc_curve_frame *frame, double y)
{
    const double place = (frame->bottom - y) / (frame->bottom - frame->top);
    return tc_axis_value(&curve->axis, fmin(fmax(place, 0), 1));
}

bool tc_curve_middle(double out[2], const tc_curve *curve, const tc_curve_frame *frame, size_t piece)
{
    const tc_document *d = curve->session->document;
    if (piece + 1 >= d->n_point)
        return false;
    const tc_edit_point *a = &d->point[piece], *b = a + 1;
    const double x0 = tc_plot_x(frame->width, a->x), x1 = tc_plot_x(frame->width, b->x);
    if (x1 - x0 < 5 * TC_CURVE_HANDLE)
        return false;
    /* Whatever the sharpness, the curve is half way there. */
    out[0] = x0 + a->midpoint * (x1 - x0);
    out[1] = tc_curve_y(curve, frame, 0.5 * (a->a + b->a));
    return true;
}

static void tc_draw_histogram(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f, const tc_plot_colors *colors)
{
    const tc_histogram *histogram = curve->session->histogram;
    const size_t n = (size_t)fmax(f->right - f->left, 1);
    double *column = histogram ? malloc(n * sizeof *column) : NULL;
    if (!column)
        return;
    const double most = tc_columns_count(column, n, histogram, curve->session->document);
    cairo_move_to(cr, f->left, f->bottom);
    for (size_t i = 0; i < n; i++) {
        const double h = tc_columns_height(histogram, column[i], most, curve->log_counts);
        const double y = f->bottom - h * 0.94 * (f->bottom - f->top);
        cairo_line_to(cr, f->left + (double)i, y);
        cairo_line_to(cr, f->left + (double)i + 1, y);
    }
    cairo_line_to(cr, f->right, f->bottom);
    cairo_close_path(cr);
    tc_plot_ink(cr, &colors->ink, 0.22);
    cairo_fill(cr);
    free(column);
}

static void tc_draw_opacity_axis(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f,
                                 const tc_plot_colors *colors)
{
    tc_axis_tick tick[TC_CURVE_TICKS];
    const int labels = (int)fmax((f->bottom - f->top) / 34, 2);
    const size_t n = tc_axis_ticks(tick, TC_CURVE_TICKS, &curve->axis, labels);
    const double label_height = 14;
    for (size_t i = 0; i < n; i++) {
        const double y = floor(f->bottom - tick[i].place * (f->bottom - f->top)) + 0.5;
        const bool named = tick[i].label[0];
        cairo_set_line_width(cr, 1);
        tc_plot_ink(cr, &colors->ink, 0.6);
        cairo_move_to(cr, f->left - (named ? 5 : 3), y);
        cairo_line_to(cr, f->left, y);
        cairo_stroke(cr);
        if (named) {
            tc_plot_ink(cr, &colors->ink, 0.12);
            cairo_move_to(cr, f->left, y);
            cairo_line_to(cr, f->right, y);
            cairo_stroke(cr);
            tc_plot_ink(cr, &colors->ink, 0.9);
            if (y > f->top + label_height) /* the top has a label of its own */
                tc_plot_text(cr, curve->area, tick[i].label, f->left - 7, y, 1, 0.5);
        }
    }
    const bool hot = curve->hot == TC_PART_TOP || curve->drag == TC_PART_TOP;
    char number[32];
    tc_plot_ink(cr, hot ? &colors->accent : &colors->ink, 1);
    tc_plot_text(cr, curve->area, tc_plot_number(number, curve->axis.top, 4), f->left - 7, f->top, 1, 0.5);
    cairo_move_to(cr, f->left - 5, f->top + 0.5);
    cairo_line_to(cr, f->left, f->top + 0.5);
    cairo_stroke(cr);
}

/* The way of the curve, pixel by pixel, through every point. */
static void tc_trace_curve(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f)
{
    const tc_document *d = curve->session->document;
    const double per_x = f->right - f->left;
    cairo_move_to(cr, f->left, tc_curve_y(curve, f, d->point[0].a));
    for (size_t i = 0; i + 1 < d->n_point; i++) {
        const tc_edit_point *a = &d->point[i], *b = a + 1;
        const int from = (int)floor(a->x * per_x) + 1, to = (int)ceil(b->x * per_x) - 1;
        cairo_line_to(cr, f->left + a->x * per_x, tc_curve_y(curve, f, a->a));
        for (int x = from; x <= to; x++)
            cairo_line_to(cr, f->left + x, tc_curve_y(curve, f, tc_document_opacity(d, x / per_x)));
        cairo_line_to(cr, f->left + b->x * per_x, tc_curve_y(curve, f, b->a));
    }
}

static void tc_draw_curve(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f, const tc_plot_colors *colors)
{
    cairo_save(cr);
    cairo_rectangle(cr, f->left, f->top - 2, f->right - f->left, f->bottom - f->top + 4);
    cairo_clip(cr);
    cairo_pattern_t *gradient = tc_plot_gradient(curve->session->document, f->width, 0.7);
    tc_trace_curve(cr, curve, f);
    cairo_line_to(cr, f->right, f->bottom);
    cairo_line_to(cr, f->left, f->bottom);
    cairo_close_path(cr);
    cairo_set_source(cr, gradient);
    cairo_fill(cr);
    cairo_pattern_destroy(gradient);
    tc_trace_curve(cr, curve, f);
    tc_plot_ink(cr, &colors->paper, 0.7);
    cairo_set_line_width(cr, 4);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke_preserve(cr);
    tc_plot_ink(cr, &colors->ink, 1);
    cairo_set_line_width(cr, curve->hot == TC_PART_LINE && curve->drag == TC_PART_NOTHING ? 2.5 : 1.5);
    cairo_stroke(cr);
    cairo_restore(cr);
}

static void tc_draw_handles(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f, const tc_plot_colors *colors)
{
    const tc_document *d = curve->session->document;
    const tc_curve_part part = curve->drag ? curve->drag : curve->hot;
    const size_t index = curve->drag ? curve->drag_index : curve->hot_index;
    cairo_set_line_width(cr, 1.5);
    for (size_t i = 0; i < d->n_point; i++) {
        double at[2];
        if (!tc_curve_middle(at, curve, f, i) || at[1] < f->top - 1)
            continue;
        const double r = part == TC_PART_MIDDLE && index == i ? 6 : 4.5;
        cairo_move_to(cr, at[0] - r, at[1]);
        cairo_line_to(cr, at[0], at[1] - r);
        cairo_line_to(cr, at[0] + r, at[1]);
        cairo_line_to(cr, at[0], at[1] + r);
        cairo_close_path(cr);
        tc_plot_ink(cr, &colors->paper, 1);
        cairo_fill_preserve(cr);
        tc_plot_ink(cr, part == TC_PART_MIDDLE && index == i ? &colors->accent : &colors->ink, 0.8);
        cairo_stroke(cr);
    }
    const bool focused = gtk_widget_has_focus(curve->area);
    /* Many points, as of freehand lines, are small. */
    const double base = (f->right - f->left) / (double)d->n_point < 3 * TC_CURVE_HANDLE ? 4 : TC_CURVE_HANDLE;
    for (size_t i = 0; i < d->n_point; i++) {
        const tc_edit_point *p = &d->point[i];
        const double x = tc_plot_x(f->width, p->x), y = fmax(tc_curve_y(curve, f, p->a), f->top);
        const double r = (part == TC_PART_POINT && index == i ? 1.5 : 0) + base - (p->selected ? 0 : 0.5);
        cairo_new_path(cr);
        cairo_arc(cr, x, y, r, 0, 2 * G_PI);
        tc_plot_ink(cr, p->selected ? &colors->accent : &colors->paper, 1);
        cairo_fill_preserve(cr);
        tc_plot_ink(cr, &colors->ink, 1);
        cairo_stroke(cr);
        if (focused && i == curve->focus) {
            cairo_arc(cr, x, y, r + 3.5, 0, 2 * G_PI);
            tc_plot_ink(cr, &colors->accent, 1);
            cairo_stroke(cr);
        }
    }
}

static void tc_draw_drag(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f, const tc_plot_colors *colors)
{
    if (curve->drag == TC_PART_RUBBER) {
        const double x = fmin(curve->drag_begin[0], curve->pointer[0]),
                     y = fmin(curve->drag_begin[1], curve->pointer[1]);
        cairo_rectangle(cr, x, y, fabs(curve->drag_begin[0] - curve->pointer[0]),
                        fabs(curve->drag_begin[1] - curve->pointer[1]));
        tc_plot_ink(cr, &colors->accent, 0.2);
        cairo_fill_preserve(cr);
        tc_plot_ink(cr, &colors->accent, 1);
        cairo_set_line_width(cr, 1);
        cairo_stroke(cr);
    }
    if (curve->drag == TC_PART_FREEHAND) {
        bool on = false;
        for (size_t i = 0; i < curve->n_line; i++) {
            const double x = f->left + (double)i, y = f->bottom - curve->line[i] * (f->bottom - f->top);
            if (isnan(y))
                on = false;
            else if (on)
                cairo_line_to(cr, x, y);
            else
                cairo_move_to(cr, x, y);
            on = !isnan(y);
        }
        tc_plot_ink(cr, &colors->accent, 0.8);
        cairo_set_line_width(cr, 2);
        cairo_stroke(cr);
    }
}

static void tc_draw_marks(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f, const tc_plot_colors *colors)
{
    const tc_document *d = curve->session->document;
    cairo_set_line_width(cr, 1);
    tc_plot_ink(cr, &colors->accent, 0.5);
    for (size_t i = 0; i < curve->n_mark; i++) {
        const double place = tc_document_place(d, curve->mark[i]);
        if (!(place >= 0 && place <= 1))
            continue;
        cairo_move_to(cr, tc_plot_x(f->width, place), f->bottom - 9);
        cairo_line_to(cr, tc_plot_x(f->width, place), f->bottom);
    }
    cairo_stroke(cr);
    const double place = curve->n_mark ? tc_document_place(d, curve->picked) : NAN;
    if (!(place >= 0 && place <= 1))
        return;
    const double x = tc_plot_x(f->width, place);
    char number[32];
    tc_plot_ink(cr, &colors->accent, 1);
    cairo_set_line_width(cr, 1.5);
    cairo_move_to(cr, x, f->top);
    cairo_line_to(cr, x, f->bottom);
    cairo_stroke(cr);
    cairo_move_to(cr, x, f->bottom - 9);
    cairo_line_to(cr, x - 5, f->bottom + 1);
    cairo_line_to(cr, x + 5, f->bottom + 1);
    cairo_close_path(cr);
    cairo_fill(cr);
    const bool leftward = place > 0.8;
    tc_plot_text(cr, curve->area, tc_plot_number(number, curve->picked, 5), x + (leftward ? -4 : 4), f->bottom - 12,
                 leftward ? 1 : 0, 1);
}

/* Scalar and opacity of what is pointed at, or dragged. */
static void tc_draw_readout(cairo_t *cr, const tc_curve *curve, const tc_curve_frame *f, const tc_plot_colors *colors)
{
    const tc_document *d = curve->session->document;
    double place, opacity;
    if (curve->drag == TC_PART_POINT || (!curve->drag && curve->hot == TC_PART_POINT)) {
        const size_t i = curve->drag ? curve->drag_index : curve->hot_index;
        if (i >= d->n_point)
            return;
        place = d->point[i].x;
        opacity = d->point[i].a;
    } else if (curve->hovered && curve->pointer[0] >= f->left && curve->pointer[0] <= f->right) {
        place = tc_plot_place(f->width, curve->pointer[0]);
        opacity = tc_document_opacity(d, place);
    } else
        return;
    char scalar[32], a[32], text[128];
    snprintf(text, sizeof text, "%s: %s", tc_plot_number(scalar, tc_document_scalar(d, place), 5),
             tc_plot_number(a, opacity, 4));
    if (curve->drag == TC_PART_MIDDLE && curve->drag_index < d->n_point) {
        const tc_edit_point *p = &d->point[curve->drag_index];
        snprintf(text, sizeof text, "midpoint %s, sharpness %s", tc_plot_number(scalar, p->midpoint, 3),
                 tc_plot_number(a, p->sharpness, 3));
    }
    /* Away from the pointer. */
    const bool left = curve->pointer[0] > 0.5 * (f->left + f->right);
    tc_plot_ink(cr, &colors->ink, 0.9);
    tc_plot_text(cr, curve->area, text, left ? f->left + 8 : f->right - 8, f->top + 3, left ? 0 : 1, 0);
}

void tc_curve_draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, gpointer user)
{
    (void)area, (void)width, (void)height;
    const tc_curve *curve = user;
    tc_curve_frame f;
    tc_curve_frame_get(&f, curve);
    tc_plot_colors colors;
    tc_plot_colors_get(&colors, curve->area);
    cairo_rectangle(cr, f.left, f.top, f.right - f.left, f.bottom - f.top);
    tc_plot_ink(cr, &colors.paper, 1);
    cairo_fill(cr);
    tc_draw_histogram(cr, curve, &f, &colors);
    tc_draw_curve(cr, curve, &f, &colors);
    tc_draw_opacity_axis(cr, curve, &f, &colors);
    cairo_rectangle(cr, f.left + 0.5, f.top + 0.5, f.right - f.left - 1, f.bottom - f.top - 1);
    tc_plot_ink(cr, gtk_widget_has_focus(curve->area) ? &colors.accent : &colors.ink, 0.6);
    cairo_set_line_width(cr, 1);
    cairo_stroke(cr);
    tc_plot_scalar_axis(cr, curve->area, curve->session->document, f.width, f.bottom);
    tc_draw_marks(cr, curve, &f, &colors);
    tc_draw_handles(cr, curve, &f, &colors);
    tc_draw_drag(cr, curve, &f, &colors);
    tc_draw_readout(cr, curve, &f, &colors);
}
