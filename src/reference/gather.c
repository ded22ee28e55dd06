/* gather.c: what a ray sees of a mesh with a look: the optical models (Max 1995), isosurfaces, light, a second field
 * for colour, and geometry, composited front to back; or
 * where such a ray has a given opacity. Within a cell all values are linear along the ray. */
#include "core/vec.h"
#include "reference/look.h"
#include "reference/segment.h"
#include "reference/shade.h"

#include <math.h>

/* Two cells follow each other, and their values agree, up to rounding: of the scaled length, of the range. */
static const double TOUCH = 1e-12;

/* One ray. */
typedef struct walk {
    const tc_reference *reference;
    const tc_look_ready *ready;
    const tc_look *look;
    const tc_transfer *tf;
    const tc_line *line, *walked;
    double unit, eye[3]; /* eye: against the ray */
    const tc_meeting *meeting;
    size_t n_meeting, met; /* met: how many are composited */
    tc_segment_sum sum;
    double least, most, integral, length; /* of finite scalars; length: scaled */
    double last_t, last_s;                /* where the cell before was left; NAN: no cell, or no value */
    double wanted;                        /* DEPTH: the transmittance whose place is looked for; negative: none */
    bool found;
    double place_t, place_s; /* where it is, scaled, and the scalar there */
} walk;

/* One cell's part of it. */
typedef struct cell {
    const tc_hit *hit;
    bool known;     /* its values are finite */
    double q[2];    /* the colour field at both ends */
    double g[2][3]; /* the gradient there */
    tc_matter matter;
} cell;

static bool projects(tc_model model)
{
    return model == TC_MODEL_MAXIMUM || model == TC_MODEL_MINIMUM || model == TC_MODEL_AVERAGE;
}

static double between(double a, double b, double x)
{
    return x < 0.5 ? a + x * (b - a) : b + (1 - x) * (a - b);
}

/* ------------------------------------------------------------------------------------------------------- a place */

/* A part of the ray from t0 to t1, where the scalar is s0 and s1, has been composited; before it was `before` clear. */
static void find_place(walk *w, double before, double t0, double t1, double s0, double s1)
{
    if (w->found || !(before > w->wanted && w->sum.clear <= w->wanted))
        return;
    double x = w->sum.clear > 0 ? log(before / w->wanted) / log(before / w->sum.clear) : 0;
    w->found = true;
    w->place_t = between(t0, t1, fmin(x, 1));
    w->place_s = between(s0, s1, fmin(x, 1));
}

/* Instead of colours: the distance from the ray's origin and the scalar. */
static void give_place(double rgba[4], const walk *w)
{
    rgba[0] = w->found ? (w->line->start + w->place_t) / w->reference->scale : 0;
    rgba[1] = w->found ? w->place_s : 0;
    rgba[2] = 0;
    rgba[3] = w->found;
}

/* ---------------------------------------------------------------------------------------------------- surfaces */

/* At depth t, where the scalar is s. */
static void add_surface(walk *w, const double color[3], double opacity, double t, double s)
{
    const double before = w->sum.clear;
    for (int c = 0; c < 3; c++)
        w->sum.rgba[c] += w->sum.clear * opacity * color[c];
    w->sum.rgba[3] += w->sum.clear * opacity;
    w->sum.clear *= 1 - opacity;
    find_place(w, before, t, t, s, s);
}

static void add_meeting(walk *w)
{
    const double t = w->meeting[w->met].t;
    uint32_t shape = w->meeting[w->met++].shape;
    const tc_geometry *geometry = &w->look->geometry[w->ready->shapes.triangle[shape].geometry];
    double normal[3], color[3];
    tc_vec_copy(color, geometry->color);
    if (geometry->lit && w->look->shade.gradient != TC_GRADIENT_NONE &&
        tc_shapes_normal(normal, &w->ready->shapes, shape)) {
        tc_lit lit = tc_lit_by(&w->look->shade, normal, w->eye, false);
        tc_lit_color(color, &lit, geometry->color);
    }
    add_surface(w, color, geometry->opacity, t, 0);
}

/* The isosurface at x, from 0 to 1, in the cell. */
static void add_iso(walk *w, const cell *c, const tc_iso *iso, double x)
{
    const tc_shade *shade = &w->look->shade;
    double rgba[4], color[3], g[3];
    if (iso->has_color)
        tc_vec_copy(rgba, iso->color);
    else if (w->look->color_field)
        tc_segment_value(rgba, w->look->color_function, between(c->q[0], c->q[1], x));
    else
        tc_segment_value(rgba, w->tf, iso->value);
    tc_vec_copy(color, rgba);
    if (w->ready->gradient && shade->surfaces) {
        for (int i = 0; i < 3; i++)
            g[i] = -between(c->g[0][i], c->g[1][i], x);
        double steep = tc_vec_length(g);
        if (steep > 0 && isfinite(steep)) {
            tc_lit lit = tc_lit_by(shade, g, w->eye, shade->one_sided);
            tc_lit_color(color, &lit, rgba);
        }
    }
    add_surface(w, color, iso->opacity, between(c->hit->t0, c->hit->t1, x), iso->value);
}

/* ------------------------------------------------------------------------------------------------------ volume */

/* The volume of the cell from x0 to x1, where the scalar is s0 and s1. */
static void add_volume(walk *w, const cell *c, double x0, double x1, double s0, double s1)
{
    const double length = (x1 - x0) * (c->hit->t1 - c->hit->t0) / w->reference->scale / w->unit;
    const double before = w->sum.clear, t0 = c->hit->t0, t1 = c->hit->t1;
    if (projects(w->look->model) || w->look->model == TC_MODEL_SURFACES)
        return;
    if (c->known)
        tc_segment_add_matter(&w->sum, &c->matter, s0, s1, between(c->q[0], c->q[1], x0), between(c->q[0], c->q[1], x1),
                              length);
    else if (w->reference->has_nan_color)
        tc_segment_add_matter_constant(&w->sum, &c->matter, w->reference->nan_color, length);
    find_place(w, before, between(t0, t1, x0), between(t0, t1, x1), c->known ? s0 : 0, c->known ? s1 : 0);
}

/* The light on the cell at one end. */
static tc_lit light_end(const walk *w, const double gradient[3])
{
    const tc_shade *shade = &w->look->shade;
    tc_lit plain = tc_lit_none();
    double n[3], steep = tc_vec_length(gradient);
    if (!(steep > 0) || !isfinite(steep))
        return plain;
    for (int i = 0; i < 3; i++)
        n[i] = -gradient[i];
    tc_lit lit = tc_lit_by(shade, n, w->eye, shade->one_sided);
    return tc_lit_mix(&lit, &plain, steep / (steep + shade->magnitude * w->ready->range / w->ready->diagonal));
}

/* Values at both ends of the cell's part that is seen. */
static void find_ends(const walk *w, cell *c)
{
    const tc_field *field = w->look->color_field;
    const tc_hit *hit = c->hit;
    bool points = field && field->association != TC_CELL_DATA;
    bool smooth = w->ready->gradient && w->ready->smooth;
    tc_ends ends;
    double weight[2][4];
    if (points || smooth) {
        tc_line_ends(&ends, w->reference, w->walked, hit);
        double span = ends.t[1] - ends.t[0];
        for (int k = 0; k < 2; k++) {
            double x = span > 0 ? fmin(fmax(((k ? hit->t1 : hit->t0) - ends.t[0]) / span, 0), 1) : k;
            for (int i = 0; i < 4; i++)
                weight[k][i] = between(ends.weight[0][i], ends.weight[1][i], x);
        }
    }
    for (int k = 0; k < 2; k++) {
        c->q[k] = field && !points ? field->value[hit->tet] : 0;
        for (int i = 0; points && i < 4; i++)
            c->q[k] += weight[k][i] * field->value[ends.id[i]]; /* 0 of what is not finite is not finite either */
        c->q[k] += w->line->data * w->ready->color_range;
        for (int a = 0; a < 3; a++) {
            c->g[k][a] = w->ready->gradient && !smooth ? w->ready->gradient[3 * (size_t)hit->tet + (size_t)a] : 0;
            for (int i = 0; smooth && i < 4; i++)
                c->g[k][a] += weight[k][i] * w->ready->gradient[3 * (size_t)ends.id[i] + (size_t)a];
        }
    }
    c->known = isfinite(hit->s0) && isfinite(hit->s1) && isfinite(c->q[0]) && isfinite(c->q[1]);
}

static void find_matter(const walk *w, cell *c)
{
    const tc_model model = w->look->model;
    c->matter = (tc_matter){.opacity = w->tf, .color = w->look->color_function, .emission = model == TC_MODEL_EMISSION};
    if (!w->look->color_field)
        c->matter.color = NULL;
    tc_lit lit = tc_lit_none();
    if (w->ready->gradient && w->look->shade.volume && c->known) {
        tc_lit a = light_end(w, c->g[0]), b = light_end(w, c->g[1]);
        lit = tc_lit_mix(&a, &b, 0.5);
    }
    for (int i = 0; i < 3; i++) {
        bool fixed = model == TC_MODEL_ABSORPTION || model == TC_MODEL_XRAY;
        c->matter.gain[i] = fixed ? 0 : lit.gain[i];
        c->matter.glow[i] = lit.glow[i] + (model == TC_MODEL_XRAY ? lit.gain[i] : 0);
    }
}

static void measure(walk *w, const tc_hit *hit)
{
    double length = hit->t1 - hit->t0;
    w->least = fmin(w->least, fmin(hit->s0, hit->s1));
    w->most = fmax(w->most, fmax(hit->s0, hit->s1));
    w->integral += length * (0.5 * hit->s0 + 0.5 * hit->s1);
    w->length += length;
}

/* ------------------------------------------------------------------------------------------------------ the ray */

static bool agree(const walk *w, double s0, double s1)
{
    return fabs(s1 - s0) <= TOUCH * w->ready->range;
}

/* The scalars at a cell's ends as isosurfaces see them. Where a ray runs through an edge or a vertex, one place has
 * values that differ in the last digit from cell to cell, or along a cell that it only touches: the value with which
 * the ray came there holds, or a surface there would be missed or met several times. */
static void find_sides(double s[2], walk *w, const tc_hit *hit)
{
    bool follows = fabs(hit->t0 - w->last_t) <= TOUCH && agree(w, w->last_s, hit->s0);
    s[0] = follows ? w->last_s : hit->s0;
    s[1] = follows && hit->t1 - hit->t0 <= TOUCH && agree(w, s[0], hit->s1) ? s[0] : hit->s1;
    w->last_t = hit->t1;
    w->last_s = s[1];
}

static void add_cell(walk *w, const cell *c)
{
    const tc_hit *hit = c->hit;
    double side[2];
    find_sides(side, w, hit); /* NAN where values are not finite: no surface, and none to follow */
    const bool up = side[0] < side[1];
    const int n_iso = c->known ? w->look->n_iso : 0;
    int i = up ? 0 : n_iso - 1;
    double x = 0, s = hit->s0;
    for (;;) {
        double end = 1, s_end = hit->s1;
        const tc_iso *iso = NULL;
        for (; i >= 0 && i < n_iso && !iso; i += iso ? 0 : up ? 1 : -1)
            if ((side[0] < w->ready->iso[i].value) != (side[1] < w->ready->iso[i].value))
                iso = &w->ready->iso[i];
        if (iso) {
            end = (0.5 * iso->value - 0.5 * hit->s0) / (0.5 * hit->s1 - 0.5 * hit->s0);
            end = end >= x ? fmin(end, 1) : x, s_end = iso->value;
        }
        bool meets = false;
        if (w->met < w->n_meeting && w->meeting[w->met].t < hit->t1) {
            double at = fmax((w->meeting[w->met].t - hit->t0) / (hit->t1 - hit->t0), x);
            meets = iso ? at < end : true;
            if (meets)
                end = fmin(at, 1), s_end = between(hit->s0, hit->s1, end);
        }
        add_volume(w, c, x, end, s, s_end);
        x = end, s = s_end;
        if (meets) {
            add_meeting(w);
        } else if (iso) {
            add_iso(w, c, iso, x);
            i += up ? 1 : -1;
        } else {
            return;
        }
    }
}

/* 1 - opacity, as far as there is a ray behind it to tell. Products of what surfaces leave reach it to rounding. */
static double wanted_of(const tc_look *look)
{
    if (look->model != TC_MODEL_DEPTH)
        return -1;
    return fmax(1 - (look->depth_opacity > 0 ? look->depth_opacity : 0.5), 1e-16) * (1 + 1e-13);
}

/* The colour of what was measured lies behind all that was composited. */
static void add_projection(walk *w)
{
    double value = w->look->model == TC_MODEL_MAXIMUM ? w->most : w->least, rgba[4];
    if (!(w->length > TOUCH)) /* met in a point, up to rounding */
        return;
    if (w->look->model == TC_MODEL_AVERAGE)
        value = fmin(fmax(w->integral / w->length, w->least), w->most);
    tc_segment_value(rgba, w->tf, value);
    add_surface(w, rgba, 1, NAN, value);
}

tc_status tc_look_gather(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                         const tc_hit *hit, size_t n, const tc_line *line, const tc_line *walked, int worker)
{
    tc_scratch *scratch = &reference->scratch[worker];
    walk w = {.reference = reference,
              .ready = reference->look,
              .look = reference->look->look,
              .tf = tf,
              .line = line,
              .walked = walked,
              .unit = unit,
              .eye = {-line->d[0], -line->d[1], -line->d[2]},
              .sum = {.clear = 1},
              .least = INFINITY,
              .most = -INFINITY,
              .last_t = NAN,
              .wanted = wanted_of(reference->look->look)};
    if (!tc_shapes_meet(&w.n_meeting, scratch, &w.ready->shapes, line))
        return TC_E_MEMORY;
    w.meeting = scratch->meeting;
    for (size_t i = 0; i < n; i++) {
        cell c = {.hit = &hit[i]};
        if (w.ready->kept && !w.ready->kept[c.hit->tet])
            continue;
        out->length += (c.hit->t1 - c.hit->t0) / reference->scale;
        out->segments++;
        if (!(w.sum.clear > 1e-18)) /* what is behind cannot be told */
            continue;
        while (w.met < w.n_meeting && w.meeting[w.met].t <= c.hit->t0)
            add_meeting(&w);
        find_ends(&w, &c);
        find_matter(&w, &c);
        if (c.known)
            measure(&w, c.hit);
        add_cell(&w, &c);
    }
    while (w.met < w.n_meeting && w.sum.clear > 1e-18)
        add_meeting(&w);
    if (projects(w.look->model))
        add_projection(&w);
    for (int i = 0; i < 4; i++)
        out->rgba[i] = w.sum.rgba[i];
    if (w.look->model == TC_MODEL_DEPTH)
        give_place(out->rgba, &w);
    return TC_OK;
}
