/* octa.c: balls and shells made of an octahedral lattice.
 * In an octant the coordinates u = i + j + k, v = j + k, w = k turn the simplex i, j, k >= 0, i + j + k <= n into
 * n >= u >= v >= w >= 0, which Kuhn's tets of the unit cubes fill exactly (Freudenthal 1942). */
#include "octa.h"

#include "chord.h"
#include "core/memory.h"
#include "core/vec.h"

#include <stdlib.h>

/* Axis walked at each of the three steps, and whether the order is odd. */
static const struct {
    int axis[3];
    bool odd;
} order[6] = {{{0, 1, 2}, false}, {{1, 2, 0}, false}, {{2, 0, 1}, false},
              {{0, 2, 1}, true},  {{1, 0, 2}, true},  {{2, 1, 0}, true}};

static int outer_level(const tc_octa *octa)
{
    return octa->level[octa->n_shell - 1][1];
}

/* Levels for spheres at h apart, each above the one before. */
static void set_levels(tc_octa *octa, double h)
{
    int at = -1;
    for (int s = 0; s < octa->n_shell; s++)
        for (int side = 0; side < 2; side++) {
            double level = octa->r[s][side] > 0 ? fmax(round(octa->r[s][side] / h), 1) : 0;
            at = level > at ? (int)level : at + 1;
            octa->level[s][side] = at;
        }
}

static double count_tets(const void *context, double h)
{
    tc_octa octa = *(const tc_octa *)context;
    set_levels(&octa, h);
    double count = 0;
    for (int s = 0; s < octa.n_shell; s++)
        count += pow(octa.level[s][1], 3) - pow(octa.level[s][0], 3);
    return 8 * count;
}

void tc_octa_resolve(tc_octa *octa, size_t n_cells)
{
    set_levels(octa, tc_synth_fit(count_tets, octa, n_cells, 2 * octa->r[octa->n_shell - 1][1]));
}

/* The shell that the layer from level to level + 1 belongs to, or -1. */
static int shell_of_layer(const tc_octa *octa, int level)
{
    for (int s = 0; s < octa->n_shell; s++)
        if (level >= octa->level[s][0] && level < octa->level[s][1])
            return s;
    return -1;
}

/* Step between the levels of a shell. */
static double level_step(const tc_octa *octa, int s)
{
    return (octa->r[s][1] - octa->r[s][0]) / (octa->level[s][1] - octa->level[s][0]);
}

static void place_on_sphere(double *out, const int *p, double radius)
{
    for (int a = 0; a < 3; a++)
        out[a] = p[a];
    double length = tc_vec_length(out);
    for (int a = 0; a < 3 && length > 0; a++)
        out[a] *= radius / length;
}

typedef struct cage {
    const tc_octa *octa;
    int n;       /* outer level */
    size_t side; /* 2 n + 1 */
    int32_t *id; /* [side][side][side] */
} cage;

static size_t cage_index(const cage *c, const int *p)
{
    return (size_t)(p[0] + c->n) + c->side * ((size_t)(p[1] + c->n) + c->side * (size_t)(p[2] + c->n));
}

/* From (u, v, w) to the point in the octant (bit a: coordinate a is mirrored). */
static void octant_point(int *out, const int *uvw, int octant)
{
    out[0] = uvw[0] - uvw[1];
    out[1] = uvw[1] - uvw[2];
    out[2] = uvw[2];
    for (int a = 0; a < 3; a++)
        if (octant >> a & 1)
            out[a] = -out[a];
}

/* The four corners of the tet of one order in the cube at base, or false when it is outside the octant. */
static bool path_corners(size_t *out, const cage *c, const int *base, int which, int octant)
{
    int at[3] = {base[0], base[1], base[2]}, p[3];
    for (int i = 0;; i++) {
        if (at[1] > at[0] || at[2] > at[1])
            return false;
        octant_point(p, at, octant);
        out[i] = cage_index(c, p);
        if (i == 3)
            break;
        at[order[which].axis[i]]++;
    }
    bool mirrored = (octant & 1) ^ (octant >> 1 & 1) ^ (octant >> 2);
    if (mirrored != order[which].odd) {
        size_t swap = out[1];
        out[1] = out[2];
        out[2] = swap;
    }
    return true;
}

/* Marks the corners of all tets (tet NULL) or writes them. */
static void for_tets(const cage *c, int32_t *tet)
{
    size_t corner[4];
    int at[3];
    for (int octant = 0; octant < 8; octant++)
        for (at[0] = 0; at[0] < c->n; at[0]++) {
            if (shell_of_layer(c->octa, at[0]) < 0)
                continue;
            for (at[1] = 0; at[1] <= at[0]; at[1]++)
                for (at[2] = 0; at[2] <= at[1]; at[2]++)
                    for (int which = 0; which < 6; which++) {
                        if (!path_corners(corner, c, at, which, octant))
                            continue;
                        for (int i = 0; i < 4; i++) {
                            if (tet)
                                *tet++ = c->id[corner[i]];
                            else
                                c->id[corner[i]] = 0;
                        }
                    }
        }
}

static void place(double *out, const tc_octa *octa, const int *p, uint64_t index, uint64_t seed)
{
    for (int a = 0; a < 3 && octa->grid > 0; a++)
        out[a] = p[a] * octa->grid;
    if (octa->grid > 0)
        return;
    int level = abs(p[0]) + abs(p[1]) + abs(p[2]);
    int s = shell_of_layer(octa, level);
    bool inner = s >= 0 && (level > octa->level[s][0] || level == 0);
    if (s < 0)
        s = shell_of_layer(octa, level - 1);
    double step = level_step(octa, s);
    place_on_sphere(out, p, octa->r[s][0] + step * (level - octa->level[s][0]));
    for (uint64_t a = 0; a < 3 && inner; a++)
        out[a] += 0.06 * step * tc_synth_noise(seed, 3 * index + a);
}

tc_status tc_octa_build(tc_synth_soup *out, const tc_octa *octa, uint64_t seed, tc_error *err)
{
    int n = outer_level(octa);
    cage c = {octa, n, 2 * (size_t)n + 1, NULL};
    size_t n_point = c.side * c.side * c.side, n_vertex = 0, n_tet = 0;
    c.id = tc_alloc(n_point, sizeof *c.id);
    if (!c.id)
        return tc_fail_memory(err, "the lattice", n_point, sizeof *c.id);
    for (size_t i = 0; i < n_point; i++)
        c.id[i] = -1;
    for_tets(&c, NULL);
    for (size_t i = 0; i < n_point; i++)
        n_vertex += c.id[i] == 0;
    for (size_t l = 0; l < (size_t)n; l++)
        if (shell_of_layer(octa, (int)l) >= 0)
            n_tet += 8 * (3 * l * (l + 1) + 1);
    tc_status status = tc_synth_soup_reserve(out, n_vertex, n_tet, err);
    if (status)
        goto done;

    int p[3];
    int32_t next = 0;
    for (p[2] = -n; p[2] <= n; p[2]++)
        for (p[1] = -n; p[1] <= n; p[1]++)
            for (p[0] = -n; p[0] <= n; p[0]++) {
                size_t at = cage_index(&c, p);
                if (c.id[at] < 0)
                    continue;
                c.id[at] = next;
                place(out->vertex + 3 * (size_t)next, octa, p, at, seed);
                next++;
            }
    for_tets(&c, out->tet);
done:
    free(c.id);
    return status;
}

/* Clips by one triangle of a sphere given in (v, w) of the octant's face u = level. */
static void clip_triangle(tc_span *span, const double *o, const double *d, double radius, int level, int octant,
                          const int vw[3][2])
{
    double q[3][3];
    for (int i = 0; i < 3; i++) {
        int uvw[3] = {level, vw[i][0], vw[i][1]}, p[3];
        octant_point(p, uvw, octant);
        place_on_sphere(q[i], p, radius);
    }
    bool mirrored = (octant & 1) ^ (octant >> 1 & 1) ^ (octant >> 2);
    tc_span_clip(span, o, d, q[0], q[mirrored ? 2 : 1], q[mirrored ? 1 : 2]);
}

static double sphere_chord(const double *o, const double *d, double radius, int level)
{
    tc_span span = tc_span_whole();
    for (int octant = 0; octant < 8; octant++)
        for (int v = 0; v < level; v++)
            for (int w = 0; w <= v; w++) {
                const int lower[3][2] = {{v, w}, {v + 1, w}, {v + 1, w + 1}};
                const int upper[3][2] = {{v, w}, {v + 1, w + 1}, {v, w + 1}};
                clip_triangle(&span, o, d, radius, level, octant, lower);
                if (w < v)
                    clip_triangle(&span, o, d, radius, level, octant, upper);
            }
    return tc_span_length(span);
}

double tc_octa_chord(const tc_octa *octa, const double *origin, const double *direction)
{
    double length = 0;
    for (int s = 0; s < octa->n_shell; s++) {
        length += sphere_chord(origin, direction, octa->r[s][1], octa->level[s][1]);
        if (octa->level[s][0] > 0)
            length -= sphere_chord(origin, direction, octa->r[s][0], octa->level[s][0]);
    }
    return length;
}
