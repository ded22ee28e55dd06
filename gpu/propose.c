/* propose.c: boundary faces as enlarged screen polygons.
 *
 * A triangle with no sharp corner is enlarged by moving its edges out by a margin (three corners still); a small one
 * becomes the rectangle around it; a long thin one what a square covers that slides over it, since moved edges would
 * meet far away. No pixel is proposed twice for one face, or for one part
 * of a face that is cut (below). The set of proposed pixels is
 * always larger than that of the rays through the face.
 *
 * A line through the eye meets a face before the eye or, where the eye is in the mesh, behind it: behind, the face is
 * seen through the eye, turned by half a turn, at the same place x/w, y/w. A face that crosses the eye's plane, or
 * reaches far beyond the picture, is cut in homogeneous coordinates (Blinn and Newell 1978) by the sides of a cone
 * about the picture's own, once before and once behind the eye; what is left is finite on the screen unless it comes
 * near the eye itself. */
#include "gpu/propose.h"

#include "core/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_CUT = 13,                       /* corners of a triangle cut by four planes: see cut */
    MOST_CORNERS = 2 * 3 * 4 * MOST_CUT, /* that one face may need */
};
static const float MARGIN = 0.0625f;  /* pixels: how far a face is enlarged beside its rounding error */
static const float ROUNDING = 1e-6f;  /* of clip coordinates, relative to their terms */
static const float SMALL = 6.0f;      /* pixels: a face this small becomes a rectangle when it has a sharp corner */
static const float MITRE_SIN = 0.03f; /* sine of the sharpest corner whose edges are moved */
static const float W_MIN = 1e-4f; /* of the largest w: nearer to the eye's plane a place on the screen has no meaning */
static const float BEYOND = 16;   /* half pictures: a face that reaches farther from the middle is cut */
static const float CONE = 2;      /* half pictures: where it is cut */
static const float APART = 8;     /* roundings: how much wider the cone is at the eye */

typedef struct point {
    float x, y;
} point;

typedef struct screen {
    float width, height;
    const float *clip;
    float rounding; /* pixels at w = 1 */
    float apex[2];  /* half widths of the cone at the eye, in clip coordinates */
    float margin;   /* pixels, of the face at hand */
} screen;

static void add(tc_proposals *out, const screen *s, int32_t face, float x, float y)
{
    out->corner[out->n++] = (tc_proposal){x / s->width * 2 - 1, y / s->height * 2 - 1, face};
}

static void add_triangle(tc_proposals *out, const screen *s, int32_t face, point a, point b, point c)
{
    add(out, s, face, a.x, a.y);
    add(out, s, face, b.x, b.y);
    add(out, s, face, c.x, c.y);
}

static void add_quad(tc_proposals *out, const screen *s, int32_t face, point a, point b, point c, point d)
{
    add_triangle(out, s, face, a, b, c);
    add_triangle(out, s, face, a, c, d);
}

static void add_screen(tc_proposals *out, const screen *s, int32_t face)
{
    add_triangle(out, s, face, (point){0, 0}, (point){2 * s->width, 0}, (point){0, 2 * s->height});
}

static float cross(point a, point b)
{
    return a.x * b.y - a.y * b.x;
}

static point minus(point a, point b)
{
    return (point){a.x - b.x, a.y - b.y};
}

static float length_of(point a)
{
    return sqrtf(a.x * a.x + a.y * a.y);
}

/* Corner p between the edges from `before` and to `after` (unit vectors, counter-clockwise), both moved out by the
 * margin. */
static point mitre(const screen *s, point p, point before, point after)
{
    float sine = cross(before, after); /* > MITRE_SIN */
    float k = s->margin / sine;
    return (point){p.x + k * (before.x - after.x), p.y + k * (before.y - after.y)};
}

static int point_compare(const void *a, const void *b)
{
    const point *p = a, *q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return p->y < q->y ? -1 : p->y > q->y;
}

/* The hull of the squares about the corners: what a square that slides over the polygon covers. Without overlap, so
 * that no pixel is proposed twice. (Andrew's monotone chain, 1979.) */
static void add_hull(tc_proposals *out, const screen *s, int32_t face, const point *p, int n_point)
{
    point corner[4 * MOST_CUT], hull[8 * MOST_CUT];
    int n_corner = 4 * n_point;
    for (int i = 0; i < n_corner; i++)
        corner[i] =
            (point){p[i / 4].x + (i & 1 ? s->margin : -s->margin), p[i / 4].y + (i & 2 ? s->margin : -s->margin)};
    qsort(corner, (size_t)n_corner, sizeof *corner, point_compare);
    int n = 0;
    for (int side = 0; side < 2; side++) {
        int first = n;
        for (int i = 0; i < n_corner; i++) {
            point c = corner[side ? n_corner - 1 - i : i];
            while (n - first >= 2 && cross(minus(hull[n - 1], hull[n - 2]), minus(c, hull[n - 2])) <= 0)
                n--;
            hull[n++] = c;
        }
        n--; /* begins the other side */
    }
    for (int i = 2; i < n; i++)
        add_triangle(out, s, face, hull[0], hull[i - 1], hull[i]);
}

static void propose_face(tc_proposals *out, const screen *s, int32_t face, const point p[3])
{
    point e[3];
    float l[3], longest = 0;
    for (int i = 0; i < 3; i++) {
        e[i] = minus(p[(i + 1) % 3], p[i]);
        l[i] = length_of(e[i]);
        longest = fmaxf(longest, l[i]);
    }
    float area = cross(e[0], minus(p[2], p[0]));
    if (area < -1 - (0.02f + 4 * s->margin) * (longest + s->margin))
        return; /* clearly looks away */
    float lo_x = fminf(p[0].x, fminf(p[1].x, p[2].x)) - s->margin,
          hi_x = fmaxf(p[0].x, fmaxf(p[1].x, p[2].x)) + s->margin;
    float lo_y = fminf(p[0].y, fminf(p[1].y, p[2].y)) - s->margin,
          hi_y = fmaxf(p[0].y, fmaxf(p[1].y, p[2].y)) + s->margin;
    if (hi_x < 0 || hi_y < 0 || lo_x > s->width || lo_y > s->height)
        return;
    if (floorf(hi_x - 0.5f) < ceilf(lo_x - 0.5f) || floorf(hi_y - 0.5f) < ceilf(lo_y - 0.5f))
        return; /* between the rays */
    if (s->margin > s->width + s->height) {
        add_screen(out, s, face); /* rounding alone spans the picture */
        return;
    }
    bool blunt = area > 0;
    for (int i = 0; i < 3 && blunt; i++) {
        int j = (i + 1) % 3;
        blunt = l[i] > 0 && l[j] > 0 && cross(e[i], e[j]) > MITRE_SIN * l[i] * l[j];
    }
    if (blunt) {
        point u[3];
        for (int i = 0; i < 3; i++)
            u[i] = (point){e[i].x / l[i], e[i].y / l[i]};
        add_triangle(out, s, face, mitre(s, p[0], u[2], u[0]), mitre(s, p[1], u[0], u[1]), mitre(s, p[2], u[1], u[2]));
    } else if (hi_x - lo_x < SMALL || hi_y - lo_y < SMALL) {
        add_quad(out, s, face, (point){lo_x, lo_y}, (point){hi_x, lo_y}, (point){hi_x, hi_y}, (point){lo_x, hi_y});
    } else {
        add_hull(out, s, face, p, 3);
    }
}

/* A place in clip space; z is not needed. */
typedef struct place {
    float x, y, w;
} place;

static place transform(const screen *s, const float *vertex)
{
    const float *m = s->clip;
    return (place){m[0] * vertex[0] + m[4] * vertex[1] + m[8] * vertex[2] + m[12],
                   m[1] * vertex[0] + m[5] * vertex[1] + m[9] * vertex[2] + m[13],
                   m[3] * vertex[0] + m[7] * vertex[1] + m[11] * vertex[2] + m[15]};
}

static point project(const screen *s, place h)
{
    return (point){(h.x / h.w * 0.5f + 0.5f) * s->width, (h.y / h.w * 0.5f + 0.5f) * s->height};
}

/* How far inside side k of the cone: right, left, top, bottom. */
static float inside(const screen *s, place h, int k)
{
    float across = k < 2 ? h.x : h.y;
    return CONE * h.w + s->apex[k / 2] - (k % 2 ? -across : across);
}

/* Cuts the polygon p [*n] by side k. Corners within rounding of the side may lie within and beyond it by turns, as
 * those of no convex polygon do: of n corners up to n / 2 are kept then, with two crossings beside each, so 3 corners
 * become 4, 6, 9 and 13 at most. */
static void cut(place *p, int *n, const screen *s, int k)
{
    place out[MOST_CUT];
    int count = 0;
    for (int i = 0; i < *n; i++) {
        place a = p[i], b = p[(i + 1) % *n];
        float da = inside(s, a, k), db = inside(s, b, k);
        if (da >= 0)
            out[count++] = a;
        if ((da >= 0) != (db >= 0)) {
            float t = da / (da - db);
            out[count++] = (place){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w)};
        }
    }
    assert(count <= MOST_CUT);
    *n = count;
    memcpy(p, out, (size_t)*n * sizeof *p);
}

/* Proposes the part of a face before the eye (side 1) or behind it (side -1); true: all of the screen. */
static bool propose_part(tc_proposals *out, screen *s, int32_t face, const place corner[3], float side)
{
    place p[MOST_CUT];
    int n = 3;
    for (int i = 0; i < 3; i++)
        p[i] = (place){side * corner[i].x, side * corner[i].y, side * corner[i].w};
    for (int k = 0; k < 4 && n > 0; k++)
        cut(p, &n, s, k);
    if (n == 0)
        return false;
    float nearest = INFINITY;
    for (int i = 0; i < n; i++)
        nearest = fminf(nearest, p[i].w);
    s->margin = MARGIN + s->rounding / fmaxf(nearest, W_MIN);
    if (!(nearest > W_MIN) || s->margin > s->width + s->height) {
        add_screen(out, s, face); /* it comes near the eye: it may be anywhere */
        return true;
    }
    point at[MOST_CUT];
    float area = 0, around = 0, lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < n; i++) {
        at[i] = project(s, p[i]);
        lo[0] = fminf(lo[0], at[i].x - s->margin), hi[0] = fmaxf(hi[0], at[i].x + s->margin);
        lo[1] = fminf(lo[1], at[i].y - s->margin), hi[1] = fmaxf(hi[1], at[i].y + s->margin);
    }
    for (int i = 0; i < n; i++) {
        point e = minus(at[(i + 1) % n], at[i]);
        area += cross(minus(at[i], at[0]), e);
        around += length_of(e);
    }
    if (hi[0] < 0 || hi[1] < 0 || lo[0] > s->width || lo[1] > s->height)
        return false;
    if (area < -1 - (0.02f + 4 * s->margin) * (around + s->margin))
        return false; /* clearly looks away */
    add_hull(out, s, face, at, n);
    return false;
}

/* Rounding errors of clip coordinates: on the screen, in pixels where w = 1, and at the eye. */
static void measure_rounding(screen *s)
{
    float terms[2] = {0, 0};
    for (int k = 0; k < 4; k++)
        for (int row = 0; row < 2; row++)
            terms[row] += fabsf(s->clip[4 * k + row]);
    s->rounding = ROUNDING * 0.5f * fmaxf(terms[0] * s->width, terms[1] * s->height);
    for (int row = 0; row < 2; row++)
        s->apex[row] = fmaxf(CONE * W_MIN, APART * ROUNDING * terms[row]);
}

/* The pixels that hold all corners, a pixel more, within the image. */
static void bound(tc_proposals *out, int width, int height)
{
    float lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < out->n; i++) {
        const float at[2] = {(out->corner[i].x + 1) * 0.5f * (float)width,
                             (out->corner[i].y + 1) * 0.5f * (float)height};
        for (int k = 0; k < 2; k++) {
            lo[k] = fminf(lo[k], at[k]);
            hi[k] = fmaxf(hi[k], at[k]);
        }
    }
    memset(out->rect, 0, sizeof out->rect);
    const int size[2] = {width, height};
    int first[2], last[2];
    for (int k = 0; k < 2; k++) {
        if (!(hi[k] > 0 && lo[k] < (float)size[k]))
            return;
        first[k] = lo[k] > 1 ? (int)lo[k] - 1 : 0;
        last[k] = hi[k] + 2 < (float)size[k] ? (int)hi[k] + 2 : size[k];
        out->rect[k] = first[k];
        out->rect[2 + k] = last[k] - first[k];
    }
}

tc_status tc_propose(tc_proposals *out, const tc_frame *frame, int width, int height, const float *corner,
                     size_t n_face, tc_error *err)
{
    screen s = {.width = (float)width, .height = (float)height, .clip = frame->clip};
    measure_rounding(&s);
    out->n = 0;
    for (size_t i = 0; i < n_face; i++) {
        if (out->n + MOST_CORNERS > out->capacity) {
            size_t capacity = 2 * (out->n + MOST_CORNERS) + 3 * (n_face - i);
            tc_proposal *grown = tc_realloc(out->corner, capacity, sizeof *grown);
            if (!grown)
                return tc_fail_memory(err, "the proposed first hits", capacity, sizeof *grown);
            out->corner = grown;
            out->capacity = capacity;
        }
        place h[3];
        float least = INFINITY, most = -INFINITY, across = 0;
        for (int k = 0; k < 3; k++) {
            h[k] = transform(&s, corner + 9 * i + 3 * (size_t)k);
            least = fminf(least, h[k].w);
            most = fmaxf(most, h[k].w);
            across = fmaxf(across, fmaxf(fabsf(h[k].x), fabsf(h[k].y)));
        }
        bool before = least > W_MIN, behind = most < -W_MIN;
        float nearest = before ? least : -most;
        if (behind && !frame->eye_inside)
            continue;
        if ((before || behind) && across <= BEYOND * nearest) {
            const point p[3] = {project(&s, h[0]), project(&s, h[1]), project(&s, h[2])};
            s.margin = MARGIN + s.rounding / nearest;
            propose_face(out, &s, (int32_t)i, p);
            continue;
        }
        bool all = !behind && propose_part(out, &s, (int32_t)i, h, 1);
        if (!all && !before && frame->eye_inside)
            propose_part(out, &s, (int32_t)i, h, -1);
    }
    bound(out, width, height);
    return TC_OK;
}

void tc_proposals_finish(tc_proposals *proposals)
{
    free(proposals->corner);
    memset(proposals, 0, sizeof *proposals);
}
