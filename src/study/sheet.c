/* sheet.c: panels with margins in pixels, so that labels can be placed where nothing else is. */
#include "study/sheet.h"

#include <math.h>
#include <string.h>

const char *const tc_sheet_colour[TC_SHEET_COLOURS] = {"#000000", "#0072B2", "#D55E00", "#009E73",
                                                       "#CC79A7", "#E69F00", "#56B4E9", "#7F7F7F"};

enum {
    PANEL_WIDTH = 620,
    PANEL_HEIGHT = 460,
    SINGLE_WIDTH = 900,
    TITLE_HEIGHT = 44,
    ENTRY_HEIGHT = 21,
    ENTRY_COLUMNS = 4,
    LEFT = 82,
    RIGHT = 22,
    BOTTOM = 56,
    TOP = 34,
    CHARACTER_WIDTH = 7,
    CHARACTER_HEIGHT = 15,
    POINT = 5
};

void tc_sheet_begin(tc_sheet *s, const char *title, int panels, size_t entries)
{
    *s = (tc_sheet){.columns = panels > 1 ? 2 : 1, .rows = (panels + 1) / 2};
    s->width = panels > 1 ? 2 * PANEL_WIDTH : SINGLE_WIDTH;
    s->legend = (int)((entries + ENTRY_COLUMNS - 1) / ENTRY_COLUMNS) * ENTRY_HEIGHT + 14;
    s->height = TITLE_HEIGHT + s->legend + s->rows * PANEL_HEIGHT;
    tc_text_add(&s->body, "set multiplot\nset label 1000 \"%s\" at screen 0.5, screen %.6f center font big\n", title,
                1 - 0.55 * TITLE_HEIGHT / s->height);
}

void tc_axis_fit(tc_axis *axis, const double *value, size_t n)
{
    double lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; i < n; i++)
        if (isfinite(value[i]) && (!axis->log || value[i] > 0)) {
            lo = fmin(lo, value[i]);
            hi = fmax(hi, value[i]);
        }
    if (!(lo <= hi)) {
        axis->lo = axis->log ? 0.1 : 0;
        axis->hi = 1;
    } else if (axis->log) {
        double pad = fmax(0.06 * log10(hi / lo), 0.06);
        axis->lo = lo * pow(10, -pad);
        axis->hi = hi * pow(10, pad);
    } else {
        axis->lo = fmin(0, lo);
        axis->hi = hi > 0 ? 1.08 * hi : 1;
    }
}

static void write_axis(tc_text *out, char name, const tc_axis *a)
{
    tc_text_add(out, "set %clabel \"%s\"\nset %crange [%.9g:%.9g]\n%s logscale %c\n", name, a->label, name, a->lo,
                a->hi, a->log ? "set" : "unset", name);
    if (a->tics)
        tc_text_add(out, "set %ctics %s\n", name, a->tics);
    else if (a->log && a->hi / a->lo < 300) /* within two decades its own tics are too few */
        tc_text_add(out,
                    "set %ctics autofreq\nset %ctics add (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, "
                    "2000, 5000)\nset format %c \"%%g\"\n",
                    name, name, name);
    else
        tc_text_add(out, "set %ctics autofreq\nset format %c \"%s\"\n", name, name,
                    a->log && a->lo < 1e-3 ? "10^{%T}" : "%g");
}

void tc_sheet_panel(tc_sheet *s, const char *title, const tc_axis *x, const tc_axis *y)
{
    const int column = s->panel % s->columns, row = s->panel / s->columns;
    const double wide = (double)s->width / s->columns, floor_at = s->legend + (s->rows - 1 - row) * PANEL_HEIGHT;
    s->panel++;
    s->x = *x;
    s->y = *y;
    s->left = column * wide + LEFT;
    s->right = (column + 1) * wide - RIGHT;
    s->bottom = floor_at + BOTTOM;
    s->top = floor_at + PANEL_HEIGHT - TOP;
    s->n_mark = 0;
    if (s->panel > 1)
        tc_text_add(&s->body, "unset label\n");
    tc_text_add(&s->body,
                "unset arrow\nunset key\nset border 3 lc rgb \"#404040\"\nset tics nomirror out\n"
                "set grid back lc rgb \"#E4E4E4\" lw 1\nset title \"%s\" offset 0,-0.6\n",
                title);
    tc_text_add(&s->body,
                "set lmargin at screen %.6f\nset rmargin at screen %.6f\nset bmargin at screen %.6f\n"
                "set tmargin at screen %.6f\n",
                s->left / s->width, s->right / s->width, s->bottom / s->height, s->top / s->height);
    write_axis(&s->body, 'x', x);
    write_axis(&s->body, 'y', y);
}

static double to_pixel(double value, const tc_axis *a, double from, double to)
{
    double t = a->log ? log(value / a->lo) / log(a->hi / a->lo) : (value - a->lo) / (a->hi - a->lo);
    return from + t * (to - from);
}

static void keep_clear(tc_sheet *s, double left, double bottom, double right, double top)
{
    if (s->n_mark == TC_SHEET_MARKS)
        return;
    const double box[4] = {left, bottom, right, top};
    memcpy(s->mark[s->n_mark++], box, sizeof box);
}

void tc_sheet_mark(tc_sheet *s, double x, double y)
{
    double px = to_pixel(x, &s->x, s->left, s->right), py = to_pixel(y, &s->y, s->bottom, s->top);
    if (isfinite(px) && isfinite(py))
        keep_clear(s, px - POINT, py - POINT, px + POINT, py + POINT);
}

/* How many pixels of a box lie over others, or outside of the panel. */
static double covered(const tc_sheet *s, const double box[4])
{
    double sum = 0;
    for (size_t i = 0; i < s->n_mark; i++) {
        double w = fmin(box[2], s->mark[i][2]) - fmax(box[0], s->mark[i][0]);
        double h = fmin(box[3], s->mark[i][3]) - fmax(box[1], s->mark[i][1]);
        sum += w > 0 && h > 0 ? w * h : 0;
    }
    sum += 1e3 * (fmax(0, s->left + 3 - box[0]) + fmax(0, box[2] - s->right) + fmax(0, s->bottom + 3 - box[1]) +
                  fmax(0, box[3] - s->top));
    return sum;
}

void tc_sheet_label(tc_sheet *s, double x, double y, const char *text, const char *colour)
{
    enum { DIRECTIONS = 16, RADII = 7 };
    const double px = to_pixel(x, &s->x, s->left, s->right), py = to_pixel(y, &s->y, s->bottom, s->top);
    const double w = CHARACTER_WIDTH * (double)strlen(text), pi = acos(-1.0);
    double best[4] = {0}, least = INFINITY, far = 0;
    if (!isfinite(px) || !isfinite(py))
        return;
    for (int r = 0; r < RADII; r++)
        for (int d = 0; d < DIRECTIONS; d++) {
            double radius = 10 + 13.0 * r, angle = 2 * pi * d / DIRECTIONS, c = cos(angle), n = sin(angle);
            double cx = px + radius * c + (c > 0.3 ? 0.5 * w : c < -0.3 ? -0.5 * w : 0), cy = py + radius * n;
            double box[4] = {cx - 0.5 * w, cy - 0.5 * CHARACTER_HEIGHT, cx + 0.5 * w, cy + 0.5 * CHARACTER_HEIGHT};
            double cost = covered(s, box) + 4 * r;
            if (cost < least) {
                least = cost;
                far = radius;
                memcpy(best, box, sizeof best);
            }
        }
    keep_clear(s, best[0], best[1], best[2], best[3]);
    tc_text_add(&s->body, "set label \"%s\" at screen %.6f, screen %.6f left front font small tc rgb \"%s\"\n", text,
                best[0] / s->width, 0.5 * (best[1] + best[3]) / s->height, colour);
    if (far > 15) { /* to the nearest place of the box */
        double ex = fmax(best[0], fmin(px, best[2])), ey = fmax(best[1] + 2, fmin(py, best[3] - 2));
        tc_text_add(
            &s->body,
            "set arrow from screen %.6f, screen %.6f to screen %.6f, screen %.6f nohead back lw 0.7 lc rgb \"%s\"\n",
            px / s->width, py / s->height, ex / s->width, ey / s->height, colour);
    }
}

void tc_sheet_legend(tc_sheet *s, const tc_entry *entry, size_t n)
{
    const double margin = 30, wide = (s->width - 2 * margin) / ENTRY_COLUMNS, sample = 34;
    tc_text_add(&s->body,
                "unset label\nunset arrow\nunset title\nunset xlabel\nunset ylabel\nunset border\nunset tics\n"
                "unset grid\nunset logscale\nset xrange [0:1]\nset yrange [0:1]\n");
    for (size_t i = 0; i < n; i++) {
        const tc_entry *e = &entry[i];
        double x = margin + wide * (double)(i % ENTRY_COLUMNS),
               y = (s->legend - 12 - ENTRY_HEIGHT * ((double)(i / ENTRY_COLUMNS) + 0.4)) / s->height;
        if (e->width > 0)
            tc_text_add(&s->body,
                        "set arrow from screen %.6f, screen %.6f to screen %.6f, screen %.6f nohead lw %g dt %d lc rgb "
                        "\"%s\"\n",
                        x / s->width, y, (x + sample) / s->width, y, e->width, e->dash ? e->dash : 1, e->colour);
        if (e->point)
            tc_text_add(&s->body, "set label \"\" at screen %.6f, screen %.6f point pt %d ps 1.1 lc rgb \"%s\"\n",
                        (x + 0.5 * sample) / s->width, y, e->point, e->colour);
        tc_text_add(&s->body, "set label \"%s\" at screen %.6f, screen %.6f left font legend\n", e->title,
                    (x + sample + 8) / s->width, y);
    }
    tc_text_add(&s->body, "plot NaN notitle\n");
}

void tc_sheet_end(tc_text *out, tc_sheet *s, const char *stem)
{
    tc_text_add(out, "# draws %s.svg and %s.png\nset encoding utf8\n%s", stem, stem, s->data.text ? s->data.text : "");
    tc_text_add(out,
                "big = \",18\"\nsmall = \",12\"\nlegend = \",13\"\nset terminal svg size %d,%d font \"Helvetica,13\" "
                "background rgb \"white\"\nset output \"%s.svg\"\n",
                s->width, s->height, stem);
    tc_text_add(out, "%sunset multiplot\nreset\nset encoding utf8\n", s->body.text ? s->body.text : "");
    tc_text_add(out,
                "big = \",13\"\nsmall = \",8.5\"\nlegend = \",9.5\"\nset terminal pngcairo size %d,%d font "
                "\"sans,9.5\"\nset output \"%s.png\"\n",
                s->width, s->height, stem);
    tc_text_add(out, "%sunset multiplot\n", s->body.text ? s->body.text : "");
    out->failed = out->failed || s->body.failed || s->data.failed;
    tc_text_finish(&s->data);
    tc_text_finish(&s->body);
}
