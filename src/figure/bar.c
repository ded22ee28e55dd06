/* bar.c: lays out the colour bar: strip, frame, ticks, their labels, and the title along it.
 *
 * Everything is computed upright, in lengths along the bar and across it, away from it to its labels' side, and put
 * into place by `place`. */
#include "figure/layout.h"

#include "figure/font.h"

#include <math.h>
#include <string.h>

enum { MARKS_MAX = 64 };

/* Labelled ticks. */
typedef struct marks {
    int n;
    double at[MARKS_MAX]; /* 0 … 1 along the bar */
    char text[MARKS_MAX][TC_ITEM_TEXT_SIZE];
    int n_minor;
    double minor[TC_TICKS_MINOR_MAX];
} marks;

typedef struct bar {
    tc_layout *l;
    bool lying;
    double start, length; /* along: from its low end */
    double near, sign;    /* across: of its labels' side, and which way labels lie */
    double lo, hi;
} bar;

static void place(double *x, double *y, const bar *b, double along, double across)
{
    double u = b->lying ? b->start + along : b->start - along, v = b->near + b->sign * across;
    *x = b->lying ? u : v;
    *y = b->lying ? v : u;
}

static double share(const bar *b, double value)
{
    if (!(b->hi > b->lo))
        return 0.5;
    if (b->l->figure->log)
        return (log(value) - log(b->lo)) / (log(b->hi) - log(b->lo));
    double half = 0.5 * b->hi - 0.5 * b->lo; /* the whole may be beyond what doubles hold */
    return 0.5 * (0.5 * value - 0.5 * b->lo) / (0.5 * half);
}

static void line(const bar *b, double a0, double c0, double a1, double c1)
{
    double p[4];
    place(&p[0], &p[1], b, a0, c0);
    place(&p[2], &p[3], b, a1, c1);
    tc_layout_line(b->l, p[0], p[1], p[2], p[3]);
}

/* A strip between `across` and the width behind it, away from the labels, in a frame. */
static void strip(const bar *b, double across, double width, bool opacity)
{
    double p[4], h = 0.5 * b->l->line;
    place(&p[0], &p[1], b, 0, across);
    place(&p[2], &p[3], b, b->length, across - width);
    tc_item *item = tc_layout_line(b->l, 0, 0, 0, 0);
    *item = (tc_item){.kind = TC_ITEM_STRIP, .lying = b->lying, .opacity = opacity};
    item->box = (tc_box){fmin(p[0], p[2]), fmin(p[1], p[3]), fmax(p[0], p[2]), fmax(p[1], p[3])};
    line(b, -2 * h, across + h, b->length + 2 * h, across + h);
    line(b, -2 * h, across - width - h, b->length + 2 * h, across - width - h);
    line(b, -h, across, -h, across - width);
    line(b, b->length + h, across, b->length + h, across - width);
}

/* Labels of every stride-th category; false: one alone is left. */
static bool mark_categories(marks *m, const bar *b, size_t stride)
{
    const tc_figure *f = b->l->figure;
    memset(m, 0, sizeof *m);
    for (size_t i = 0; i < f->n_category && m->n < MARKS_MAX; i += stride) {
        const char *name = f->category_name ? f->category_name[i] : NULL;
        m->at[m->n] = ((double)i + 0.5) / (double)f->n_category;
        if (!name || !*name || tc_layout_fit(m->text[m->n], name, b->l->em, 0.22 * b->l->width) <= 0)
            tc_ticks_write(m->text[m->n], f->category[i]);
        m->n++;
    }
    return m->n > 1;
}

/* The marks that a bar may have, fewer with each try; false: there are none fewer. */
static bool mark(marks *m, const bar *b, int fewer)
{
    const tc_figure *f = b->l->figure;
    if (f->n_category > 0)
        return mark_categories(m, b, f->n_category / MARKS_MAX + 1 + (size_t)fewer);
    tc_ticks t;
    tc_ticks_make(&t, b->lo, b->hi, f->log, 7 - fewer);
    *m = (marks){.n = t.n, .n_minor = t.n_minor};
    for (int i = 0; i < t.n; i++) {
        m->at[i] = share(b, t.value[i]);
        memcpy(m->text[i], t.text[i], sizeof t.text[i]);
    }
    for (int i = 0; i < t.n_minor; i++)
        m->minor[i] = share(b, t.minor[i]);
    return fewer < 5;
}

/* Largest size across and along of the labels. */
static void largest(double out[2], const bar *b, const marks *m)
{
    out[0] = out[1] = 0;
    for (int i = 0; i < m->n; i++) {
        double half[2];
        tc_layout_half(half, m->text[i], b->l->em, false);
        out[0] = fmax(out[0], 2 * half[b->lying]);
        out[1] = fmax(out[1], 2 * half[!b->lying]);
    }
}

/* Do labels keep clear of each other? */
static bool is_clear(const bar *b, const marks *m)
{
    for (int i = 0; i + 1 < m->n; i++) {
        double h0[2], h1[2];
        tc_layout_half(h0, m->text[i], b->l->em, false);
        tc_layout_half(h1, m->text[i + 1], b->l->em, false);
        double space = (m->at[i + 1] - m->at[i]) * b->length;
        if (space < h0[!b->lying] + h1[!b->lying] + 0.6 * b->l->em)
            return false;
    }
    return true;
}

/* Ticks and labels, those standing at the strip; widest: across the bar. */
static void lay_marks(const bar *b, const marks *m, double tick, double widest)
{
    tc_layout *l = b->l;
    for (int i = 0; i < m->n; i++) {
        double x, y, at = m->at[i] * b->length;
        /* a tick's middle, on whole pixels */
        double middle = fmin(fmax(floor(at - 0.5 * l->line + 0.5), 0), b->length - l->line) + 0.5 * l->line;
        line(b, middle, l->line, middle, l->line + tick);
        place(&x, &y, b, at, l->line + tick + l->gap + 0.5 * widest);
        if (!b->lying) {
            double half[2];
            tc_layout_half(half, m->text[i], l->em, false);
            x += b->sign * (half[0] - 0.5 * widest);
        }
        tc_layout_text(l, m->text[i], l->em, x, y, false);
    }
    for (int i = 0; i < m->n_minor; i++) {
        double at = floor(m->minor[i] * b->length) + 0.5 * l->line;
        if (at < b->length)
            line(b, at, l->line, at, l->line + floor(0.6 * tick));
    }
}

void tc_layout_bar(tc_layout *l)
{
    const tc_figure *f = l->figure;
    bar b = {.l = l, .lying = f->bar == TC_BAR_BOTTOM};
    double range[2];
    tc_layout_range(range, f);
    b.lo = range[0], b.hi = range[1];

    double em = l->em, tick = round(0.35 * em), thick = round(1.2 * em), second = f->bar_opacity ? thick + l->gap : 0;
    marks m;
    double size[2];
    mark(&m, &b, 0);
    largest(size, &b, &m);
    double half_label = 0.5 * size[1], corner = f->triad ? round(5.2 * em) : 0; /* the triad's, lower left */
    if (b.lying) {
        double left = l->margin + corner + fmax(half_label, f->triad ? 0.8 * em : 0),
               right = l->width - l->margin - half_label;
        b.length = floor(fmin(right - left, 0.7 * l->width));
        b.start = round(fmin(fmax(0.5 * (l->width - b.length), left), right - b.length));
    } else {
        double above = l->top + half_label;
        double below = l->height - l->margin - (f->bar == TC_BAR_LEFT ? fmax(corner, half_label) : half_label);
        b.length = floor(fmin(below - above, 0.75 * l->height));
        b.start = round(fmax(fmin(0.5 * (l->height + b.length), below), above + b.length));
    }
    for (int fewer = 1; !is_clear(&b, &m) && mark(&m, &b, fewer); fewer++)
        ;
    largest(size, &b, &m);

    char title[TC_ITEM_TEXT_SIZE] = "";
    double title_em = 0;
    if (f->bar_title && *f->bar_title && b.length > 0)
        title_em = tc_layout_fit(title, f->bar_title, em, b.length);
    double title_room = title_em > 0 ? 1.3 * em + l->gap : 0;
    double across = second + thick + tick + l->gap + size[0] + title_room; /* all of it */
    double all = b.lying ? l->height - l->top : l->width;
    if (b.length < 4 * em || across + l->margin > 0.5 * all) {
        tc_say(l->log, TC_WARNING,
               "the picture of %d x %d pixels has no room for a colour bar with letters of %.0f pixels; it is left out",
               l->width, l->height, em);
        return;
    }
    /* Labels lie to the picture's edge where the bar is upright at the right, or at the bottom. */
    b.sign = f->bar == TC_BAR_LEFT ? -1 : 1;
    double outer = l->margin + across - second - thick; /* of the labels' side of the strip, from the picture's edge */
    b.near = round(f->bar == TC_BAR_LEFT ? outer : (b.lying ? l->height : l->width) - outer);

    strip(&b, 0, thick, false);
    if (f->bar_opacity)
        strip(&b, -thick - l->gap, thick, true);
    lay_marks(&b, &m, tick, size[0]);
    if (title_em > 0) {
        double x, y;
        place(&x, &y, &b, 0.5 * b.length, l->line + tick + l->gap + size[0] + l->gap + 0.65 * em);
        if (!tc_layout_text(l, title, title_em, x, y, !b.lying))
            tc_say(l->log, TC_WARNING, "there is no room for the colour bar's title \"%s\"; it is left out",
                   f->bar_title);
    }
    double p[4];
    place(&p[0], &p[1], &b, -half_label, across - second - thick);
    place(&p[2], &p[3], &b, b.length + half_label, -second - thick - l->gap);
    tc_layout_take(l, fmin(p[0], p[2]), fmin(p[1], p[3]), fmax(p[0], p[2]), fmax(p[1], p[3]));
}
