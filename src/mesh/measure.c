/* measure.c: what the report says about size and values. */
#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>

/* Tets with a corner whose value is not finite. */
static size_t count_unknown(const tc_mesh *m)
{
    size_t n = 0;
    for (size_t t = 0; t < m->n_tet; t++) {
        const int32_t *v = m->tet + 4 * t;
        n += !(isfinite(m->scalar[v[0]]) && isfinite(m->scalar[v[1]]) && isfinite(m->scalar[v[2]]) &&
               isfinite(m->scalar[v[3]]));
    }
    return n;
}

enum { VALUES = 16384, PARTS_MOST = 64 };

/* Least, most and number of the values that are not finite, of each part of them. */
typedef struct ranges {
    const double *value;
    size_t n, part; /* values, and how many are one part */
    struct {
        double lo, hi;
        size_t bad;
    } of[PARTS_MOST];
} ranges;

static void range_of_parts(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    ranges *j = context;
    for (size_t p = begin; p < end; p++) {
        size_t first = p * j->part, last = first + j->part < j->n ? first + j->part : j->n, bad = 0;
        double lo = INFINITY, hi = -INFINITY;
        for (size_t i = first; i < last; i++) { /* no branch: several at a time */
            double s = j->value[i];
            bool finite = fabs(s) < INFINITY; /* false for NaN */
            double low = finite ? s : INFINITY, high = finite ? s : -INFINITY;
            bad += !finite;
            lo = low < lo ? low : lo;
            hi = high > hi ? high : hi;
        }
        j->of[p].lo = lo;
        j->of[p].hi = hi;
        j->of[p].bad = bad;
    }
}

void tc_mesh_measure_scalar(tc_mesh *m)
{
    /* Steiner points come last and carry no value */
    size_t n = m->association == TC_CELL_DATA ? m->n_tet : m->n_vertex - m->report.n_steiner, bad = 0;
    ranges j = {.value = m->scalar, .n = n, .part = n / PARTS_MOST + 1};
    j.part = j.part > VALUES ? j.part : VALUES;
    size_t parts = (n + j.part - 1) / j.part;
    tc_parallel_for(parts, 1, 0, range_of_parts, &j);
    double lo = INFINITY, hi = -INFINITY;
    for (size_t p = 0; p < parts; p++) {
        lo = fmin(lo, j.of[p].lo);
        hi = fmax(hi, j.of[p].hi);
        bad += j.of[p].bad;
    }
    m->report.association = m->association;
    m->report.nonfinite_scalars = bad;
    m->report.nonfinite_cells = bad == 0 || m->association == TC_CELL_DATA ? bad : count_unknown(m);
    m->report.scalar_range[0] = lo <= hi ? lo : 0;
    m->report.scalar_range[1] = lo <= hi ? hi : 0;
}

enum { CHUNK = 4096 };

typedef struct sums {
    const double *vertex;
    const int32_t *tet;
    double scale;      /* to size 1, a power of two: no square overflows */
    double (*part)[2]; /* of each chunk: longest edge squared, six volumes, both scaled */
} sums;

static void measure_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const sums *j = context;
    double longest = 0, volume = 0;
    for (size_t t = begin; t < end; t++) {
        double e[6][3], c[3];
        const int32_t *v = j->tet + 4 * t;
        const double *a = j->vertex + 3 * (size_t)v[0];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                e[i][k] = j->scale * (j->vertex[3 * (size_t)v[i + 1] + (size_t)k] - a[k]);
        tc_vec_sub(e[3], e[1], e[0]);
        tc_vec_sub(e[4], e[2], e[0]);
        tc_vec_sub(e[5], e[2], e[1]);
        for (int i = 0; i < 6; i++) {
            double square = tc_vec_dot(e[i], e[i]);
            longest = square > longest && isfinite(square) ? square : longest;
        }
        tc_vec_cross(c, e[0], e[1]);
        double six = fabs(tc_vec_dot(c, e[2]));
        volume += isfinite(six) ? six : 0;
    }
    j->part[begin / CHUNK][0] = longest;
    j->part[begin / CHUNK][1] = volume;
}

static void measure_bounds(tc_mesh *m)
{
    double *b = m->report.bounds;
    bool any = false;
    for (int k = 0; k < 6; k++)
        b[k] = 0;
    for (size_t v = 0; v < m->n_vertex - m->report.n_steiner; v++) {
        const double *p = m->vertex + 3 * v;
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            continue;
        for (int k = 0; k < 3; k++) {
            b[2 * k] = any && b[2 * k] < p[k] ? b[2 * k] : p[k];
            b[2 * k + 1] = any && b[2 * k + 1] > p[k] ? b[2 * k + 1] : p[k];
        }
        any = true;
    }
}

tc_status tc_mesh_measure(tc_mesh *m, int threads, tc_error *err)
{
    tc_mesh_report *r = &m->report;
    measure_bounds(m);
    double extent = 0;
    int exponent = 0;
    for (int k = 0; k < 3; k++) {
        double e = r->bounds[2 * k + 1] - r->bounds[2 * k];
        extent = e > extent ? e : extent;
    }
    if (extent > 0 && isfinite(extent))
        frexp(extent, &exponent);
    size_t n_part = (m->n_tet + CHUNK - 1) / CHUNK;
    sums j = {.vertex = m->vertex, .tet = m->tet, .scale = ldexp(1, -exponent)};
    if (!isfinite(j.scale)) /* smaller than any normal number */
        j.scale = 1, exponent = 0;
    j.part = tc_alloc(n_part, sizeof *j.part);
    if (!j.part)
        return tc_fail_memory(err, "measuring the mesh", n_part, sizeof *j.part);
    tc_parallel_for(m->n_tet, CHUNK, threads, measure_range, &j);
    double longest = 0, volume = 0;
    for (size_t i = 0; i < n_part; i++) {
        longest = j.part[i][0] > longest ? j.part[i][0] : longest;
        volume += j.part[i][1];
    }
    r->longest_edge = ldexp(sqrt(longest), exponent);
    r->volume = ldexp(volume / 6, 3 * exponent);
    free(j.part);
    return TC_OK;
}

double tc_default_unit_distance(const tc_mesh *mesh)
{
    const double *b = mesh->report.bounds;
    double diagonal = hypot(hypot(b[1] - b[0], b[3] - b[2]), b[5] - b[4]);
    double cells = (double)(mesh->report.source_cells ? mesh->report.source_cells : mesh->report.n_tet);
    double unit = cells > 0 ? diagonal / cbrt(cells) : diagonal;
    return unit > 0 && isfinite(unit) ? unit : 1;
}
