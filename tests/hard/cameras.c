/* cameras.c: views that put rays through vertices, along edges and in face planes, and eyes where they should not be.
 */
#include "cameras.h"

#include "core/memory.h"
#include "core/vec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

typedef struct place {
    const tc_mesh *mesh;
    double center[3], diagonal;
    const int32_t *cell; /* a real cell in the middle of the list */
} place;

typedef bool make_view(hard_view *out, const place *p, int size);

static const double *vertex(const place *p, int corner)
{
    return p->mesh->vertex + 3 * (size_t)p->cell[corner];
}

static void middle(double *out, const place *p, const int32_t *tet, int n)
{
    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < n; k++)
        tc_vec_mul_add(out, out, 1.0 / n, p->mesh->vertex + 3 * (size_t)tet[k]);
}

/* The whole mesh in view from direction (x, y, z). */
static void see_whole(hard_view *out, const place *p, double x, double y, double z, double angle, bool parallel)
{
    const double direction[3] = {x, y, z}, up[3] = {0, 1, 0};
    tc_camera_reset(&out->camera, p->mesh->report.bounds, direction, up, angle, 1);
    out->camera.parallel = parallel;
    out->whole = true;
}

/* An eye at `at` that looks at the mesh's middle, past it if that is where it stands. */
static bool stand(hard_view *out, const place *p, const double *at, double angle)
{
    static const double aside[3] = {0.31, -0.22, 0.93};
    double to[3];
    see_whole(out, p, 0, 0, 1, angle, false);
    out->whole = false;
    tc_vec_sub(to, p->center, at);
    if (tc_vec_length(to) < 1e-3 * p->diagonal)
        tc_vec_mul_add(to, to, p->diagonal, aside);
    tc_vec_copy(out->camera.position, at);
    tc_vec_add(out->camera.focal_point, at, to);
    return true;
}

/* Parallel along `direction`, with the middle pixel's ray through `at`; pixels `pitch` apart, an odd number of them. */
static bool along(hard_view *out, const place *p, const double *at, const double *direction, double pitch, int size)
{
    double d[3];
    tc_vec_copy(d, direction);
    if (!(tc_vec_normalize(d) > 0))
        return false;
    see_whole(out, p, -d[0], -d[1], -d[2], 30, true);
    out->width = out->height = size | 1;
    tc_vec_copy(out->camera.focal_point, at);
    tc_vec_mul_add(out->camera.position, at, -2 * p->diagonal, d);
    out->camera.parallel_scale = 0.5 * pitch * out->height;
    return true;
}

/* ---------------------------------------------------------------------------------------------------- ordinary */

static bool front(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.3, 0.4, 1, 30, false);
    return true;
}

static bool side(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, -1, 0.23, 0.11, 30, false);
    return true;
}

static bool oblique(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.5, 0.7, -0.6, 30, true);
    return true;
}

/* ------------------------------------------------------------------------------------------- rays through things */

/* A step of the grid along an axis: the shortest edge of the cell that lies along it, else a part of the whole. */
static double grid_step(const place *p, int axis)
{
    double least = INFINITY;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            double e[3];
            tc_vec_sub(e, vertex(p, i), vertex(p, j));
            if (e[(axis + 1) % 3] == 0 && e[(axis + 2) % 3] == 0 && e[axis] != 0)
                least = fmin(least, fabs(e[axis]));
        }
    return least < p->diagonal ? least : p->diagonal / 32;
}

/* The vertex nearest the mesh's middle. */
static const double *middle_vertex(const place *p)
{
    const double *best = p->mesh->vertex;
    double least = INFINITY;
    for (size_t i = 0; i < p->mesh->n_vertex; i++) {
        double d[3];
        tc_vec_sub(d, p->mesh->vertex + 3 * i, p->center);
        if (tc_vec_length(d) < least) {
            least = tc_vec_length(d);
            best = p->mesh->vertex + 3 * i;
        }
    }
    return best;
}

/* Pixels a part of a grid step apart, one through a vertex: on a grid, rays through all vertices, edges and faces. They
 * stay within the middle half of the mesh's box, as rays in its sides are on no particular side of them. */
static bool along_axis(hard_view *out, const place *p, int axis, int size)
{
    const double *b = p->mesh->report.bounds;
    int s = (axis + 1) % 3, t = (axis + 2) % 3;
    double d[3] = {0, 0, 0}, pitch = grid_step(p, s),
           half = 0.5 * fmin(b[2 * s + 1] - b[2 * s], b[2 * t + 1] - b[2 * t]);
    d[axis] = axis == 1 ? 1 : -1;
    while (pitch * size > half && half > 0)
        pitch /= 2;
    return along(out, p, middle_vertex(p), d, pitch, size);
}

static bool along_x(hard_view *out, const place *p, int size)
{
    return along_axis(out, p, 0, size);
}

static bool along_y(hard_view *out, const place *p, int size)
{
    return along_axis(out, p, 1, size);
}

static bool along_z(hard_view *out, const place *p, int size)
{
    return along_axis(out, p, 2, size);
}

/* As along z, turned by 2e-6 so that rays cross planes of the grid nearly in them, and rolled so that both coordinates
 * of a projected vertex matter: crosses of nearly equal products. */
static bool grazing(hard_view *out, const place *p, int size)
{
    if (!along_axis(out, p, 2, size))
        return false;
    out->camera.position[0] += 2e-6 * 2 * p->diagonal;
    out->camera.view_up[0] = 0.6;
    out->camera.view_up[1] = 0.8;
    out->camera.view_up[2] = 0;
    out->grazing = true;
    return true;
}

static bool along_edge(hard_view *out, const place *p, int size)
{
    double d[3];
    tc_vec_sub(d, vertex(p, 1), vertex(p, 0));
    return along(out, p, vertex(p, 0), d, p->diagonal / 64, size);
}

static bool in_face_plane(hard_view *out, const place *p, int size)
{
    double d[3], e[3], at[3];
    tc_vec_sub(d, vertex(p, 1), vertex(p, 0));
    tc_vec_sub(e, vertex(p, 2), vertex(p, 0));
    tc_vec_mul_add(d, d, 0.375, e);
    middle(at, p, p->cell, 3);
    return along(out, p, at, d, p->diagonal / 96, size);
}

/* In perspective, the middle ray through one vertex from afar: every ray near it meets the cells around it. */
static bool at_vertex(hard_view *out, const place *p, int size)
{
    see_whole(out, p, 0.6, -0.5, 0.7, 30, false);
    out->width = out->height = size | 1;
    double step[3];
    tc_vec_sub(step, vertex(p, 0), out->camera.focal_point);
    tc_vec_add(out->camera.focal_point, out->camera.focal_point, step);
    tc_vec_add(out->camera.position, out->camera.position, step);
    out->camera.view_angle = 4;
    return true;
}

/* -------------------------------------------------------------------------------------------------- eyes in things */

static bool eye_vertex(hard_view *out, const place *p, int size)
{
    (void)size;
    return stand(out, p, vertex(p, 0), 100);
}

static bool eye_edge(hard_view *out, const place *p, int size)
{
    double at[3];
    (void)size;
    middle(at, p, p->cell, 2);
    return stand(out, p, at, 80);
}

static bool eye_face(hard_view *out, const place *p, int size)
{
    double at[3];
    (void)size;
    middle(at, p, p->cell, 3);
    return stand(out, p, at, 80);
}

static bool eye_cell(hard_view *out, const place *p, int size)
{
    double at[3];
    (void)size;
    middle(at, p, p->cell, 4);
    return stand(out, p, at, 90);
}

static bool eye_imaginary(hard_view *out, const place *p, int size)
{
    double at[3];
    (void)size;
    if (p->mesh->n_imaginary == 0)
        return false;
    middle(at, p, p->mesh->tet + 4 * (p->mesh->n_tet + p->mesh->n_imaginary / 2), 4);
    return stand(out, p, at, 80);
}

/* An imaginary cell that cannot be reached from outside through imaginary cells. */
static size_t find_cavity(const tc_mesh *m)
{
    size_t n = m->n_tet + m->n_imaginary, top = 0, found = SIZE_MAX;
    uint8_t *reached = tc_calloc(n, 1);
    uint32_t *stack = tc_alloc(n, sizeof *stack);
    for (size_t t = m->n_tet; reached && stack && t < n; t++)
        for (int f = 0; f < 4; f++)
            if (m->neighbour[4 * t + (size_t)f] < 0 && !reached[t]) {
                reached[t] = 1;
                stack[top++] = (uint32_t)t;
            }
    while (top > 0) {
        size_t t = stack[--top];
        for (int f = 0; f < 4; f++) {
            int32_t other = m->neighbour[4 * t + (size_t)f];
            if (other >= 0 && (size_t)other >= m->n_tet && !reached[other]) {
                reached[other] = 1;
                stack[top++] = (uint32_t)other;
            }
        }
    }
    for (size_t t = m->n_tet; reached && stack && t < n && found == SIZE_MAX; t++)
        if (!reached[t])
            found = t;
    free(reached);
    free(stack);
    return found;
}

static bool eye_cavity(hard_view *out, const place *p, int size)
{
    double at[3];
    (void)size;
    size_t cell = find_cavity(p->mesh);
    if (cell == SIZE_MAX)
        return false;
    middle(at, p, p->mesh->tet + 4 * cell, 4);
    return stand(out, p, at, 100);
}

static bool eye_center(hard_view *out, const place *p, int size)
{
    (void)size;
    return stand(out, p, p->center, 120);
}

static bool eye_near(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.2, 0.1, 1, 170, false); /* 1.004 half diagonals away */
    return true;
}

/* In a vertex, looking away from the mesh's middle: most of it is behind the eye. */
static bool eye_away(hard_view *out, const place *p, int size)
{
    (void)size;
    stand(out, p, vertex(p, 2), 150);
    for (int k = 0; k < 3; k++)
        out->camera.focal_point[k] = 2 * out->camera.position[k] - out->camera.focal_point[k];
    return true;
}

/* ---------------------------------------------------------------------------------------------------------- extremes
 */

static bool narrow(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.7, 0.3, 0.9, 0.01, false);
    return true;
}

/* 0.01 degrees from near by: all rays in one cell, or nearly. */
static bool zoomed(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.4, 0.2, 1, 30, false);
    out->camera.view_angle = 0.01;
    return true;
}

static bool wide(hard_view *out, const place *p, int size)
{
    double at[3];
    (void)size;
    middle(at, p, p->cell, 4);
    return stand(out, p, at, 170);
}

static bool far_off(hard_view *out, const place *p, int size)
{
    static const double from[3] = {0.48, 0.36, 0.8};
    (void)size;
    see_whole(out, p, 0, 0, 1, 30, false);
    tc_vec_mul_add(out->camera.position, p->center, 1e6 * p->diagonal, from);
    out->camera.view_angle = 1.1e-6 * 180 / PI;
    return true;
}

static bool up_along_view(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.3, 0.4, 1, 30, false);
    tc_vec_sub(out->camera.view_up, out->camera.focal_point, out->camera.position);
    return true;
}

static bool plane_in_mesh(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.2, 0.9, 0.4, 30, true);
    tc_vec_copy(out->camera.position, out->camera.focal_point);
    tc_vec_mul_add(out->camera.focal_point, out->camera.focal_point, p->diagonal, (const double[3]){-0.2, -0.9, -0.4});
    out->whole = false; /* nothing behind the camera's plane is seen */
    return true;
}

static bool one_pixel(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.3, 0.4, 1, 30, false);
    out->width = out->height = 1;
    return true;
}

static bool one_row(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.3, 0.4, 1, 30, false);
    out->width = 16384;
    out->height = 1;
    out->camera.view_angle /= 16384;
    return true;
}

/* --------------------------------------------------------------------------------------------------------- clipping */

static bool clip(hard_view *out, const place *p, double near, double far, bool parallel)
{
    see_whole(out, p, 0.3, 0.4, 1, 30, parallel);
    double to[3];
    tc_vec_sub(to, out->camera.focal_point, out->camera.position);
    double distance = tc_vec_length(to);
    out->camera.clip_near = near == 0 ? 0 : distance + near * p->diagonal;
    out->camera.clip_far = distance + far * p->diagonal;
    out->whole = false;
    return true;
}

static bool clip_near(hard_view *out, const place *p, int size)
{
    (void)size;
    return clip(out, p, -0.03, 10, false);
}

static bool clip_far(hard_view *out, const place *p, int size)
{
    (void)size;
    return clip(out, p, 0, 0.05, false);
}

static bool clip_slab(hard_view *out, const place *p, int size)
{
    (void)size;
    return clip(out, p, -0.02, 0.03, true);
}

static bool large(hard_view *out, const place *p, int size)
{
    (void)size;
    see_whole(out, p, 0.31, 0.42, 1, 24, false);
    out->width = out->height = 4096;
    return true;
}

static const struct {
    const char *name;
    make_view *make;
    bool large;
} views[] = {
    {"front", front, false},
    {"side", side, false},
    {"oblique, parallel", oblique, false},
    {"along x, on the grid", along_x, false},
    {"along y, on the grid", along_y, false},
    {"along z, on the grid", along_z, false},
    {"along an edge", along_edge, false},
    {"in a face's plane", in_face_plane, false},
    {"through a vertex", at_vertex, false},
    {"eye on a vertex", eye_vertex, false},
    {"eye on an edge", eye_edge, false},
    {"eye in a face", eye_face, false},
    {"eye in a cell", eye_cell, false},
    {"eye in an imaginary cell", eye_imaginary, false},
    {"eye in a cavity", eye_cavity, false},
    {"eye in the middle", eye_center, false},
    {"eye near, 170 degrees", eye_near, false},
    {"eye looking away", eye_away, false},
    {"0.01 degrees, from afar", narrow, false},
    {"0.01 degrees, from near", zoomed, false},
    {"170 degrees, inside", wide, false},
    {"1e6 diagonals away", far_off, false},
    {"view-up along the view", up_along_view, false},
    {"parallel, plane in the mesh", plane_in_mesh, false},
    {"clipped near", clip_near, false},
    {"clipped far", clip_far, false},
    {"clipped to a slab, parallel", clip_slab, false},
    {"1 x 1", one_pixel, false},
    {"16384 x 1", one_row, false},
    {"grazing planes of the grid", grazing, false},
    {"4096 x 4096", large, true},
};
enum { N_VIEW = sizeof views / sizeof *views };

size_t hard_view_count(void)
{
    return N_VIEW;
}

const char *hard_view_name(size_t index)
{
    return views[index].name;
}

bool hard_view_is_large(size_t index)
{
    return views[index].large;
}

bool hard_view_make(hard_view *out, size_t index, const hard_mesh *mesh, int size)
{
    const tc_mesh *m = mesh->mesh;
    const double *b = m->report.bounds;
    place p = {.mesh = m, .diagonal = mesh->diagonal};
    for (int k = 0; k < 3; k++)
        p.center[k] = 0.5 * b[2 * k] + 0.5 * b[2 * k + 1];
    p.cell = m->tet + 4 * (m->n_tet / 2);
    memset(out, 0, sizeof *out);
    out->name = views[index].name;
    out->width = out->height = size;
    return views[index].make(out, &p, size);
}
