/* axes.c: lays out the triad, and ticks along edges of the box on the outline of its projection.
 *
 * An edge lies on the outline if one of its two faces is turned to the eye and the other is not. Of those along each
 * axis the lowest is taken, or the leftmost (with the bar at the left: the rightmost) where it rather stands upright.
 */
#include "figure/layout.h"

#include "core/vec.h"
#include "figure/font.h"
#include "scene/camera.h"

#include <math.h>
#include <string.h>

static const char *const NAME[] = {"x", "y", "z"};

static const char *name_of(const tc_figure *f, int axis)
{
    return f->axis_title[axis] ? f->axis_title[axis] : NAME[axis];
}

bool tc_layout_project(double out[2], const tc_rays *rays, const double *p)
{
    double c[4];
    for (int i = 0; i < 4; i++)
        c[i] = rays->clip[i] * p[0] + rays->clip[4 + i] * p[1] + rays->clip[8 + i] * p[2] + rays->clip[12 + i];
    out[0] = 0.5 * (1 + c[0] / c[3]) * rays->width;
    out[1] = 0.5 * (1 - c[1] / c[3]) * rays->height;
    return c[3] > 0 && fabs(out[0]) < 1e7 && fabs(out[1]) < 1e7;
}

/* Is the face on that side of an axis turned to the eye? */
static bool is_seen(const tc_rays *rays, const double *bounds, int axis, int side)
{
    if (rays->parallel)
        return side ? rays->axis[axis] < 0 : rays->axis[axis] > 0;
    return side ? rays->eye[axis] > bounds[2 * axis + 1] : rays->eye[axis] < bounds[2 * axis];
}

/* An edge of the box, in the picture. */
typedef struct edge {
    double p[3], lo, hi; /* p with lo … hi at its axis */
    double a[2], b[2];   /* its ends */
    double out[2];       /* unit vector away from the box */
} edge;

/* The edge for an axis; false: none lies on the outline, or is long enough. */
static bool choose(edge *out, const tc_layout *l, const tc_rays *rays, const double *bounds, const double *middle,
                   int k)
{
    int i = (k + 1) % 3, j = (k + 2) % 3;
    double best = -INFINITY, side_wanted = l->figure->bar == TC_BAR_LEFT ? 1 : -1;
    for (int s = 0; s < 4; s++) {
        edge e = {.lo = bounds[2 * k], .hi = bounds[2 * k + 1]};
        if (is_seen(rays, bounds, i, s & 1) == is_seen(rays, bounds, j, s >> 1))
            continue;
        e.p[i] = bounds[2 * i + (s & 1)], e.p[j] = bounds[2 * j + (s >> 1)];
        e.p[k] = e.lo;
        tc_layout_project(e.a, rays, e.p);
        e.p[k] = e.hi;
        tc_layout_project(e.b, rays, e.p);
        double dx = e.b[0] - e.a[0], dy = e.b[1] - e.a[1], length = hypot(dx, dy);
        if (length < 3 * l->em)
            continue;
        e.out[0] = -dy / length, e.out[1] = dx / length;
        if (e.out[0] * (e.a[0] - middle[0]) + e.out[1] * (e.a[1] - middle[1]) < 0)
            e.out[0] = -e.out[0], e.out[1] = -e.out[1];
        double score = e.out[1] + 0.7 * side_wanted * e.out[0];
        if (score > best)
            best = score, *out = e;
    }
    return best > -INFINITY;
}

static void point_at(double out[2], const tc_rays *rays, const edge *e, int k, double value)
{
    double p[3];
    tc_vec_copy(p, e->p);
    p[k] = value;
    tc_layout_project(out, rays, p);
}

/* How far from the edge the centre of a text stands that lies beyond `from`. */
static double reach(const edge *e, const double half[2], double from)
{
    return from + fabs(e->out[0]) * half[0] + fabs(e->out[1]) * half[1];
}

/* Do labels of an axis keep clear of each other? */
static bool is_clear(const tc_layout *l, const tc_rays *rays, const edge *e, int k, const tc_ticks *t, double from)
{
    tc_box before = {0};
    for (int i = 0; i < t->n; i++) {
        double q[2], half[2];
        point_at(q, rays, e, k, t->value[i]);
        tc_layout_half(half, t->text[i], l->em, false);
        double d = reach(e, half, from), x = q[0] + d * e->out[0], y = q[1] + d * e->out[1], pad = 0.25 * l->em;
        tc_box box = {x - half[0] - pad, y - half[1] - pad, x + half[0] + pad, y + half[1] + pad};
        if (i && tc_box_meets(&box, &before))
            return false;
        before = box;
    }
    return true;
}

static bool is_taken(const tc_layout *l, const double p[2])
{
    tc_box dot = {p[0], p[1], p[0] + 1e-9, p[1] + 1e-9};
    for (int i = 0; i < l->n_taken; i++)
        if (tc_box_meets(&dot, &l->taken[i]))
            return true;
    return false;
}

/* A line but for what parts of the figure cover. */
static void lay_line(tc_layout *l, const double a[2], const double b[2])
{
    double from = 0;
    while (from < 1) {
        double to = 1, next = 2; /* the first part that covers something behind `from` */
        for (int i = 0; i < l->n_taken; i++) {
            const double lo[2] = {l->taken[i].x0, l->taken[i].y0}, hi[2] = {l->taken[i].x1, l->taken[i].y1};
            double in = from, out = 1;
            for (int c = 0; c < 2; c++) {
                double d = b[c] - a[c], t0 = (lo[c] - a[c]) / d, t1 = (hi[c] - a[c]) / d;
                if (d != 0)
                    in = fmax(in, fmin(t0, t1)), out = fmin(out, fmax(t0, t1));
                else if (a[c] <= lo[c] || a[c] >= hi[c])
                    out = -1;
            }
            if (in < out && in < to)
                to = in, next = out;
        }
        if (to > from)
            tc_layout_line(l, a[0] + from * (b[0] - a[0]), a[1] + from * (b[1] - a[1]), a[0] + to * (b[0] - a[0]),
                           a[1] + to * (b[1] - a[1]));
        from = next;
    }
}

static void lay_axis(tc_layout *l, const tc_rays *rays, const edge *e, int k)
{
    double tick = round(0.45 * l->em), from = tick + l->gap, deepest = from;
    tc_ticks t;
    for (int most = 7; most >= 2; most--) {
        tc_ticks_make(&t, e->lo, e->hi, false, most);
        if (is_clear(l, rays, e, k, &t, from))
            break;
    }
    lay_line(l, e->a, e->b);
    for (int i = 0; i < t.n; i++) {
        double q[2], half[2];
        point_at(q, rays, e, k, t.value[i]);
        if (is_taken(l, q))
            continue;
        tc_layout_line(l, q[0], q[1], q[0] + tick * e->out[0], q[1] + tick * e->out[1]);
        tc_layout_half(half, t.text[i], l->em, false);
        double d = reach(e, half, from), x = q[0] + d * e->out[0], y = q[1] + d * e->out[1];
        if (tc_layout_text(l, t.text[i], l->em, x, y, false))
            deepest = fmax(deepest, 2 * d - from);
    }
    /* The title beyond the labels, in the middle or near it. */
    static const double along[] = {0.5, 0.42, 0.58, 0.34, 0.66, 0.25, 0.75, 0.15, 0.85};
    char title[TC_ITEM_TEXT_SIZE];
    double em = tc_layout_fit(title, name_of(l->figure, k), l->em, 0.5 * l->width), half[2];
    if (em <= 0)
        return;
    tc_layout_half(half, title, em, false);
    double d = reach(e, half, deepest + l->gap);
    for (size_t i = 0; i < sizeof along / sizeof *along; i++) {
        double x = e->a[0] + along[i] * (e->b[0] - e->a[0]) + d * e->out[0];
        double y = e->a[1] + along[i] * (e->b[1] - e->a[1]) + d * e->out[1];
        if (tc_layout_text(l, title, em, x, y, false))
            return;
    }
}

tc_status tc_layout_axes(tc_layout *l, tc_error *err)
{
    const tc_figure *f = l->figure;
    tc_rays rays;
    tc_status status = tc_rays_from_camera(&rays, f->camera, l->width, l->height, err);
    if (status != TC_OK)
        return status;
    double middle[2] = {0, 0};
    for (int c = 0; c < 8; c++) {
        double p[3] = {f->bounds[c & 1], f->bounds[2 + (c >> 1 & 1)], f->bounds[4 + (c >> 2)]}, q[2];
        if (!tc_layout_project(q, &rays, p)) {
            tc_say(l->log, TC_WARNING,
                   "a part of the box lies behind the camera, or far outside of the picture; axes are left out");
            return TC_OK;
        }
        middle[0] += q[0] / 8, middle[1] += q[1] / 8;
    }
    int n = 0;
    for (int k = 0; k < 3; k++) {
        edge e = {0};
        if (!choose(&e, l, &rays, f->bounds, middle, k))
            continue;
        lay_axis(l, &rays, &e, k);
        n++;
    }
    if (n == 0)
        tc_say(l->log, TC_WARNING,
               "no edge of the box is long enough in this view, or it is seen from inside; axes are left out");
    return TC_OK;
}

tc_status tc_layout_triad(tc_layout *l, tc_error *err)
{
    tc_rays rays;
    tc_status status = tc_rays_from_camera(&rays, l->figure->camera, l->width, l->height, err);
    if (status != TC_OK)
        return status;
    double side = round(5 * l->em), arm = 1.6 * l->em;
    tc_box box = {l->margin, l->height - l->margin - side, l->margin + side, l->height - l->margin};
    if (side + 2 * l->margin > 0.5 * l->width || side + 2 * l->margin > 0.5 * l->height) {
        tc_say(l->log, TC_WARNING, "the picture of %d x %d pixels has no room for a triad; it is left out", l->width,
               l->height);
        return TC_OK;
    }
    double cx = round(0.5 * (box.x0 + box.x1)), cy = round(0.5 * (box.y0 + box.y1)), tip[3][3];
    for (int k = 0; k < 3; k++) {
        /* right and up of the view are those of its pixels */
        const double *dx = rays.parallel ? rays.origin_dx : rays.direction_dx;
        const double *dy = rays.parallel ? rays.origin_dy : rays.direction_dy;
        tip[k][0] = arm * dx[k] / tc_vec_length(dx);
        tip[k][1] = -arm * dy[k] / tc_vec_length(dy);
        tip[k][2] = rays.axis[k]; /* away from the eye */
    }
    int order[3] = {0, 1, 2}; /* farthest first */
    for (int i = 0; i < 3; i++)
        for (int j = i + 1; j < 3; j++)
            if (tip[order[j]][2] > tip[order[i]][2]) {
                int t = order[i];
                order[i] = order[j], order[j] = t;
            }
    for (int i = 0; i < 3; i++) {
        int k = order[i];
        tc_item *item = tc_layout_line(l, cx, cy, cx + tip[k][0], cy + tip[k][1]);
        item->width = 2 * l->line;
        item->hue = k + 1;
    }
    for (int i = 2; i >= 0; i--) { /* beyond the tip, or beside it; the nearest first */
        static const double turn[] = {0, 0.7, -0.7, 1.4, -1.4, 2.1, -2.1, 3.14};
        int k = order[i];
        double length = hypot(tip[k][0], tip[k][1]), angle = length > 0.1 * arm ? atan2(tip[k][1], tip[k][0]) : 0;
        if (length <= 0.1 * arm) { /* to or from the eye: away from the two others */
            int a = (k + 1) % 3, b = (k + 2) % 3;
            angle = atan2(-tip[a][1] - tip[b][1], -tip[a][0] - tip[b][0]);
        }
        for (size_t j = 0; j < sizeof turn / sizeof *turn; j++) {
            double x = cx + tip[k][0] + 0.75 * l->em * cos(angle + turn[j]);
            double y = cy + tip[k][1] + 0.75 * l->em * sin(angle + turn[j]);
            tc_item *text = tc_layout_text(l, NAME[k], l->em, x, y, false);
            if (text)
                break;
        }
    }
    tc_layout_take(l, box.x0, box.y0, box.x1, box.y1);
    return TC_OK;
}
