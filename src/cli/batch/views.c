/* views.c: the cameras of a scene's views.
 * Paths: cubic Hermite pieces with the tangents of Catmull and Rom 1974, for keys at any times: those that Kochanek and
 * Bartels 1984 have for tension, bias and continuity 0 (vtkKochanekSpline, in vtkCameraInterpolator). */
#include "cli/batch/views.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

size_t tc_views_count(const tc_views *views, size_t n_along)
{
    if (views->kind == TC_VIEWS_NONE)
        return 1;
    return views->along ? n_along : views->n;
}

int tc_views_check(const tc_views *views, size_t n_along, tc_talk *talk)
{
    if (views->kind != TC_VIEWS_LIST || !views->along || views->n == n_along)
        return -1;
    tc_talk_error(talk, "%s has %zu cameras along time, and there are %zu steps: give each step one", views->called,
                  views->n, n_along);
    return TC_EXIT_FAILED;
}

bool tc_view_is_named(const tc_views *views, size_t i)
{
    return i < views->n_name && views->name[i];
}

void tc_view_name(char *out, size_t capacity, const tc_views *views, size_t i)
{
    if (tc_view_is_named(views, i))
        snprintf(out, capacity, "%s", views->name[i]);
    else
        snprintf(out, capacity, "%04zu", i + 1);
}

bool tc_view_is_free(const tc_views *views, size_t i)
{
    const unsigned own = TC_VIEW_POSITION | TC_VIEW_FOCAL_POINT | TC_VIEW_SCALE | TC_VIEW_ZOOM | TC_VIEW_CLIPPING |
                         TC_VIEW_WINDOW;
    return views->kind != TC_VIEWS_PATH && (views->kind != TC_VIEWS_LIST || !(views->key[i].has & own));
}

/* ------------------------------------------------------------------------------------------------------- vectors */

static double tc_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void tc_cross(double out[3], const double a[3], const double b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Makes v a unit vector; false: it is next to nothing, and stays. */
static bool tc_unit(double v[3], double least)
{
    const double length = hypot(hypot(v[0], v[1]), v[2]);
    if (!(length > least) || isinf(length))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

/* Cosine and sine, exact at whole quarters of a turn. */
static void tc_turn_of(double *c, double *s, double degrees)
{
    static const double quarter[4] = {1, 0, -1, 0};
    const double rest = remainder(degrees, 360);
    if (fmod(rest, 90) == 0) {
        const int q = ((int)(rest / 90) + 4) % 4;
        *c = quarter[q];
        *s = quarter[(q + 3) % 4];
        return;
    }
    *c = cos(rest * acos(-1.0) / 180);
    *s = sin(rest * acos(-1.0) / 180);
}

/* Turns v about a unit axis (Rodrigues). */
static void tc_turn(double v[3], const double axis[3], double degrees)
{
    double c, s, across[3];
    tc_turn_of(&c, &s, degrees);
    tc_cross(across, axis, v);
    const double along = tc_dot(axis, v) * (1 - c);
    for (int i = 0; i < 3; i++)
        v[i] = c * v[i] + s * across[i] + along * axis[i];
}

/* -------------------------------------------------------------------------------------------------------- angles */

/* base, turned about the view-up by phi, then raised by theta, its view-up with it. */
static void tc_angles_apply(tc_camera *out, const tc_camera *base, double phi, double theta)
{
    double arm[3], ahead[3], up[3], side[3];
    *out = *base;
    for (int i = 0; i < 3; i++) {
        arm[i] = base->position[i] - base->focal_point[i];
        ahead[i] = -arm[i];
        up[i] = base->view_up[i];
    }
    if (!tc_unit(up, 0) || !tc_unit(ahead, 0))
        return;
    tc_cross(side, up, ahead);
    if (!tc_unit(side, 1e-9)) { /* it looks along its up: take another, as the renderer does */
        const double other[3] = {-up[2], up[0], up[1]};
        memcpy(up, other, sizeof up);
    }
    tc_turn(arm, up, phi);
    for (int i = 0; i < 3; i++)
        ahead[i] = -arm[i];
    tc_cross(side, up, ahead); /* minus the view's right */
    tc_unit(side, 0);
    tc_turn(arm, side, theta);
    tc_turn(up, side, theta);
    tc_unit(up, 0);
    for (int i = 0; i < 3; i++)
        out->position[i] = base->focal_point[i] + arm[i];
    memcpy(out->view_up, up, sizeof up);
}

/* Angle i of an orbit along n steps. */
static double tc_orbit_angle(const tc_views *views, size_t i, size_t n)
{
    const double turn = views->to - views->from;
    const bool again = turn != 0 && fmod(turn, 360) == 0;
    const size_t parts = again ? n : n > 1 ? n - 1 : 1;
    return views->from + turn * (double)i / (double)parts;
}

/* ---------------------------------------------------------------------------------------------------------- keys */

/* What a camera's keys change in base. Gives -1, or the exit code of an error that was printed. */
static int tc_keys_apply(tc_camera *out, const tc_views *views, size_t i, const tc_camera *base, const double bounds[6],
                         double aspect, tc_talk *talk)
{
    const tc_view_keys *keys = &views->key[i];
    const unsigned has = keys->has;
    *out = *base;
    if (has & TC_VIEW_ANGLE)
        out->view_angle = keys->view_angle;
    if (has & TC_VIEW_DIRECTION) {
        tc_camera_reset(out, bounds, keys->direction, has & TC_VIEW_UP ? keys->view_up : base->view_up, out->view_angle,
                        aspect);
        out->clip_near = base->clip_near;
        out->clip_far = base->clip_far;
        memcpy(out->window_center, base->window_center, sizeof out->window_center);
    }
    if (has & TC_VIEW_POSITION)
        memcpy(out->position, keys->position, sizeof out->position);
    if (has & TC_VIEW_FOCAL_POINT)
        memcpy(out->focal_point, keys->focal_point, sizeof out->focal_point);
    if (has & TC_VIEW_UP)
        memcpy(out->view_up, keys->view_up, sizeof out->view_up);
    if (has & TC_VIEW_PARALLEL)
        out->parallel = keys->parallel;
    if (has & TC_VIEW_SCALE) {
        out->parallel = true;
        out->parallel_scale = keys->parallel_scale;
    }
    if (!memcmp(out->position, out->focal_point, sizeof out->position)) {
        tc_talk_error(
            talk, "%s[%zu]: the camera's position %g,%g,%g is also its focal point, so there is no direction to look",
            views->called, i, out->position[0], out->position[1], out->position[2]);
        return TC_EXIT_FAILED;
    }
    if (has & TC_VIEW_AZIMUTH)
        tc_camera_azimuth(out, keys->azimuth);
    if (has & TC_VIEW_ELEVATION)
        tc_camera_elevation(out, keys->elevation);
    if (has & TC_VIEW_ROLL)
        tc_camera_roll(out, keys->roll);
    if (has & TC_VIEW_ZOOM)
        tc_camera_zoom(out, keys->zoom);
    if (has & TC_VIEW_CLIPPING) {
        out->clip_near = keys->clipping_range[0];
        out->clip_far = keys->clipping_range[1];
    }
    if (has & TC_VIEW_WINDOW)
        memcpy(out->window_center, keys->window_center, sizeof out->window_center);
    return -1;
}

/* ---------------------------------------------------------------------------------------------------------- path */

/* Four keys in turn round a place on a path: the piece is from [1] to [2]. */
typedef struct tc_piece {
    size_t key[4];
    tc_camera camera[4];
    double time[4];
    bool rests[2]; /* at its beginning, its end: there is no key beyond */
    double s;      /* 0 … 1 within it */
} tc_piece;

/* Fills a piece but for its cameras. u: 0 … 1 along the path. */
static void tc_piece_find(tc_piece *out, const tc_views *views, double u)
{
    const size_t n = views->n_key;
    const double first = views->key[0].time, last = views->key[n - 1].time;
    if (views->closed && u < first)
        u += 1;
    if (!views->closed)
        u = fmin(fmax(u, first), last);
    size_t low = 0, high = n; /* the last key at or before u */
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (views->key[middle].time <= u)
            low = middle;
        else
            high = middle;
    }
    if (!views->closed && low == n - 1)
        low--;
    for (int k = 0; k < 4; k++) {
        const size_t at = low + n + (size_t)k - 1; /* n more than it is */
        out->key[k] = at % n;
        out->time[k] = views->key[at % n].time + ((double)(at / n) - 1);
    }
    out->rests[0] = !views->closed && low == 0;
    out->rests[1] = !views->closed && low + 2 >= n;
    out->s = (u - out->time[1]) / (out->time[2] - out->time[1]);
}

/* The spline through three numbers of each key at `at` bytes into the camera. */
static void tc_spline(double out[3], const tc_piece *piece, size_t at)
{
    const double s = piece->s, h = piece->time[2] - piece->time[1];
    const double *p[4];
    for (int k = 0; k < 4; k++)
        p[k] = (const double *)((const char *)&piece->camera[k] + at);
    for (int i = 0; i < 3; i++) {
        const double begin = piece->rests[0] ? 0 : (p[2][i] - p[0][i]) / (piece->time[2] - piece->time[0]);
        const double end = piece->rests[1] ? 0 : (p[3][i] - p[1][i]) / (piece->time[3] - piece->time[1]);
        out[i] = (2 * s - 3) * s * s * p[1][i] + p[1][i] + (3 - 2 * s) * s * s * p[2][i] +
                 h * (((s - 2) * s + 1) * s * begin + (s - 1) * s * s * end);
    }
}

static double tc_between(const tc_piece *piece, double a, double b)
{
    return a == b ? a : (1 - piece->s) * a + piece->s * b;
}

/* The place on a path, 0 … 1, of view i of n. */
static double tc_path_place(const tc_views *views, size_t i, size_t n)
{
    if (views->closed)
        return (double)i / (double)n;
    return n > 1 ? (double)i / (double)(n - 1) : 0;
}

static int tc_path_apply(tc_camera *out, const tc_views *views, double u, const tc_camera *base, const double bounds[6],
                         double aspect, tc_talk *talk)
{
    tc_piece piece;
    tc_piece_find(&piece, views, u);
    for (int k = 0; k < 4; k++) {
        int code = tc_keys_apply(&piece.camera[k], views, piece.key[k], base, bounds, aspect, talk);
        if (code >= 0)
            return code;
        tc_unit(piece.camera[k].view_up, 0);
    }
    const tc_camera *a = &piece.camera[1], *b = &piece.camera[2];
    if (a->parallel != b->parallel || (a->clip_far > 0) != (b->clip_far > 0)) {
        tc_talk_error(talk, "%s: camera %zu has %s and camera %zu has not: give all of them one, or none",
                      views->called,
                      piece.key[a->parallel != b->parallel ? (a->parallel ? 1 : 2) : (a->clip_far > 0 ? 1 : 2)],
                      a->parallel != b->parallel ? "a parallel projection" : "a clipping range",
                      piece.key[a->parallel != b->parallel ? (a->parallel ? 2 : 1) : (a->clip_far > 0 ? 2 : 1)]);
        return TC_EXIT_FAILED;
    }
    *out = *a;
    tc_spline(out->position, &piece, offsetof(tc_camera, position));
    tc_spline(out->focal_point, &piece, offsetof(tc_camera, focal_point));
    tc_spline(out->view_up, &piece, offsetof(tc_camera, view_up));
    if (!tc_unit(out->view_up, 1e-9)) /* half-way between opposite ones */
        memcpy(out->view_up, piece.s < 0.5 ? a->view_up : b->view_up, sizeof out->view_up);
    out->view_angle = tc_between(&piece, a->view_angle, b->view_angle);
    out->parallel_scale = tc_between(&piece, a->parallel_scale, b->parallel_scale);
    out->clip_near = tc_between(&piece, a->clip_near, b->clip_near);
    out->clip_far = tc_between(&piece, a->clip_far, b->clip_far);
    for (int i = 0; i < 2; i++)
        out->window_center[i] = tc_between(&piece, a->window_center[i], b->window_center[i]);
    if (!memcmp(out->position, out->focal_point, sizeof out->position)) {
        tc_talk_error(talk,
                      "%s: between cameras %zu and %zu the eye meets its focal point, so there is no direction to look",
                      views->called, piece.key[1], piece.key[2]);
        return TC_EXIT_FAILED;
    }
    return -1;
}

/* --------------------------------------------------------------------------------------------------------- whole */

int tc_view_camera(tc_camera *out, double *phi, double *theta, const tc_views *views, size_t i, size_t n_along,
                   const tc_camera *base, const double bounds[6], double aspect, tc_talk *talk)
{
    const size_t n = tc_views_count(views, n_along);
    double angle[2] = {NAN, NAN};
    int code = -1;
    switch (views->kind) {
    case TC_VIEWS_NONE:
        *out = *base;
        break;
    case TC_VIEWS_LIST:
        *out = *base;
        code = i < views->n_key ? -1 : tc_views_check(views, n_along, talk);
        if (code < 0)
            code = tc_keys_apply(out, views, i, base, bounds, aspect, talk);
        break;
    case TC_VIEWS_PATH:
        code = tc_path_apply(out, views, tc_path_place(views, i, n), base, bounds, aspect, talk);
        break;
    case TC_VIEWS_ORBIT:
    case TC_VIEWS_GRID:
        angle[0] = views->along ? tc_orbit_angle(views, i, n) : views->phi[i / views->n_theta];
        angle[1] = views->along ? views->elevation : views->theta[i % views->n_theta];
        tc_angles_apply(out, base, angle[0], angle[1]);
        break;
    }
    if (phi)
        *phi = angle[0];
    if (theta)
        *theta = angle[1];
    return code;
}
