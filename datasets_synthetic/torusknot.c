/* torusknot.c: a square tube along a trefoil, the (2, 3) knot on a torus: closed, knotted, and never convex. The frame
 * is the torus's own: its normal is perpendicular to every curve on it and closes after one round. */
#include "core/vec.h"
#include "lattice.h"

static const double big = 1, small = 0.45, half = 0.16;
static const double pi = 3.14159265358979323846;
static const double tube[3] = {16, 0.32, 0.32}; /* lengths along and across */

static double divisions(int axis, double h)
{
    return fmax(axis == 0 ? 60 : 1, round(tube[axis] / h));
}

static double count_tets(const void *context, double h)
{
    (void)context;
    return 6 * divisions(0, h) * divisions(1, h) * divisions(2, h);
}

typedef struct knot {
    size_t n[3];
    uint64_t seed;
} knot;

static void place(const void *context, double *out, const size_t *vertex)
{
    const knot *k = context;
    double at[3];
    uint64_t index = vertex[0] + (uint64_t)k->n[0] * (vertex[1] + (uint64_t)(k->n[1] + 1) * vertex[2]);
    bool within[3]; /* not on a side of the tube */
    for (int a = 1; a < 3; a++)
        within[a] = vertex[a] > 0 && vertex[a] < k->n[a];
    within[0] = within[1] && within[2];
    for (int a = 0; a < 3; a++) {
        at[a] = (double)vertex[a];
        if (within[a])
            at[a] += 0.1 * tc_synth_noise(k->seed, 3 * index + (uint64_t)a);
        at[a] /= (double)k->n[a];
    }
    double t = 2 * pi * at[0], c2 = cos(2 * t), s2 = sin(2 * t), c3 = cos(3 * t), s3 = sin(3 * t), r = big + small * c3;
    double tangent[3] = {-3 * small * s3 * c2 - 2 * r * s2, -3 * small * s3 * s2 + 2 * r * c2, 3 * small * c3};
    const double normal[3] = {c3 * c2, c3 * s2, s3};
    double binormal[3];
    tc_vec_normalize(tangent);
    tc_vec_cross(binormal, tangent, normal);
    out[0] = r * c2, out[1] = r * s2, out[2] = small * s3;
    tc_vec_mul_add(out, out, half * (2 * at[1] - 1), normal);
    tc_vec_mul_add(out, out, half * (2 * at[2] - 1), binormal);
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    double h = tc_synth_fit(count_tets, NULL, n_cells, 2 * tube[0]);
    knot k = {{(size_t)divisions(0, h), (size_t)divisions(1, h), (size_t)divisions(2, h)}, seed};
    tc_lattice lattice = {{k.n[0], k.n[1], k.n[2]}, true, NULL, place, &k, TC_SPLIT_KUHN};
    return tc_lattice_build(out, &lattice, err);
}

static double field(const double *p)
{
    return sin(3 * atan2(p[1], p[0])) + p[2];
}

const tc_synth_generator tc_synth_torusknot = {40000, build, field, NULL, TC_SYNTH_SOUND, 0};
