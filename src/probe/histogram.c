/* histogram.c: how often each value of a mesh comes.
 *
 * Values are taken in parts of a length that depends on their number alone; each part has bins of its own, and these
 * are added up in the order of the parts, so that sums of volumes do not depend on the number of threads. A point's
 * volume is never found: each cell gives a quarter of its own to the bin of each of its corners. */
#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "mesh/mesh.h"
#include "probe/sight.h"

#include <math.h>
#include <stdlib.h>

enum { BINS = 256, BINS_MOST = 65536, VALUES = 16384, PARTS_MOST = 64 };
static const uint32_t NO_BIN = UINT32_MAX;

/* Number and length of the parts of n things. */
typedef struct split {
    size_t n, length, parts;
} split;

static split split_of(size_t n)
{
    const size_t length = n / PARTS_MOST + 1 > VALUES ? n / PARTS_MOST + 1 : VALUES;
    return (split){n, length, (n + length - 1) / length};
}

/* What one part found. */
typedef struct part {
    double lo, hi; /* of the values that can be in a bin */
    uint64_t counted, missing;
} part;

typedef struct count {
    const tc_mesh *mesh;
    bool cells, by_volume, log, seen_only;
    tc_sight sight;
    split values, tets; /* of what passes run over: values, or tets that give volume to points */
    part part[PARTS_MOST];
    size_t n; /* bins; two more follow: below, above */
    double range[2], log_lo, log_span;
    uint32_t *bin;  /* [n_vertex] of each point, NO_BIN; points by volume only */
    double *weight; /* [parts][n + 2] */
} count;

/* ------------------------------------------------------------------------------------------------------- values */

/* Is value i counted? *v gets it. */
static bool take(double *v, const count *j, size_t i)
{
    const tc_mesh *m = j->mesh;
    *v = m->scalar[i];
    if (!j->seen_only)
        return true;
    if (!j->cells)
        return tc_sight_sees(&j->sight, &m->vertex[3 * i]);
    const int32_t *id = &m->tet[4 * i];
    double middle[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++)
        tc_vec_mul_add(middle, middle, 0.25, &m->vertex[3 * (size_t)id[k]]);
    return tc_sight_sees(&j->sight, middle);
}

static void find_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    count *j = context;
    for (size_t p = begin; p < end; p++) {
        const size_t first = p * j->values.length, past = first + j->values.length;
        double lo = INFINITY, hi = -INFINITY, v;
        for (size_t i = first; i < past && i < j->values.n; i++)
            if (take(&v, j, i) && isfinite(v) && (!j->log || v > 0))
                lo = fmin(lo, v), hi = fmax(hi, v);
        j->part[p].lo = lo, j->part[p].hi = hi;
    }
}

/* Number of a finite value's bin. */
static size_t bin_of(const count *j, double v)
{
    const double lo = j->range[0], hi = j->range[1];
    if (v < lo)
        return j->n;
    if (v > hi)
        return j->n + 1;
    double x;
    if (j->log)
        x = (log(v) - j->log_lo) / j->log_span;
    else if (isfinite(hi - lo))
        x = (v - lo) / (hi - lo);
    else
        x = (0.5 * v - 0.5 * lo) / (0.5 * hi - 0.5 * lo);
    const double at = x * (double)j->n;
    return at < (double)j->n ? (size_t)fmax(at, 0) : j->n - 1; /* NaN, of a range of one value: the last */
}

static double volume(const tc_mesh *m, size_t tet)
{
    const int32_t *id = &m->tet[4 * tet];
    const double *a = &m->vertex[3 * (size_t)id[0]];
    double e[3][3], c[3];
    for (int k = 0; k < 3; k++)
        tc_vec_sub(e[k], &m->vertex[3 * (size_t)id[k + 1]], a);
    tc_vec_cross(c, e[0], e[1]);
    const double v = fabs(tc_vec_dot(c, e[2])) / 6;
    return isfinite(v) ? v : 0;
}

/* Puts values into bins; of points by volume only the bins' numbers are found. */
static void count_values(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    count *j = context;
    for (size_t p = begin; p < end; p++) {
        const size_t first = p * j->values.length, past = first + j->values.length;
        double *weight = j->weight + p * (j->n + 2), v;
        for (size_t i = first; i < past && i < j->values.n; i++) {
            const bool counted = take(&v, j, i), there = counted && isfinite(v);
            j->part[p].counted += counted;
            j->part[p].missing += counted && !there;
            if (j->bin)
                j->bin[i] = there ? (uint32_t)bin_of(j, v) : NO_BIN;
            else if (there)
                weight[bin_of(j, v)] += j->by_volume ? volume(j->mesh, i) : 1;
        }
    }
}

static void give_volumes(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    count *j = context;
    for (size_t p = begin; p < end; p++) {
        const size_t first = p * j->tets.length, past = first + j->tets.length;
        double *weight = j->weight + p * (j->n + 2);
        for (size_t t = first; t < past && t < j->tets.n; t++) {
            const double quarter = 0.25 * volume(j->mesh, t);
            for (int k = 0; k < 4; k++) {
                const uint32_t bin = j->bin[j->mesh->tet[4 * t + (size_t)k]];
                if (bin != NO_BIN)
                    weight[bin] += quarter;
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------------- histogram */

static tc_status check(const tc_mesh *mesh, const tc_histogram_options *o, tc_error *err)
{
    if (!mesh || !o)
        return tc_fail(err, TC_E_ARG, "for a histogram a mesh and options are needed");
    if (!mesh->prepared)
        return tc_fail(err, TC_E_ARG, "the mesh was not prepared; call tc_mesh_prepare first");
    if (o->n < 0 || o->n > BINS_MOST)
        return tc_fail(err, TC_E_ARG, "a histogram of %d bins cannot be made; use 1 to %d, or 0 for %d", o->n,
                       BINS_MOST, BINS);
    if (!o->has_range)
        return TC_OK;
    if (!isfinite(o->range[0]) || !isfinite(o->range[1]) || !(o->range[0] < o->range[1]))
        return tc_fail(err, TC_E_ARG, "a histogram's range must be finite and ascending, not %g to %g", o->range[0],
                       o->range[1]);
    if (o->log && !(o->range[0] > 0))
        return tc_fail(err, TC_E_ARG, "a logarithmic histogram's range must be above 0, not %g to %g", o->range[0],
                       o->range[1]);
    return TC_OK;
}

/* Range of what is counted where none was asked for. */
static tc_status resolve_range(count *j, const tc_histogram_options *o, tc_error *err)
{
    j->range[0] = o->range[0], j->range[1] = o->range[1];
    if (!o->has_range) {
        double lo = INFINITY, hi = -INFINITY;
        tc_parallel_for(j->values.parts, 1, o->threads, find_range, j);
        for (size_t p = 0; p < j->values.parts; p++)
            lo = fmin(lo, j->part[p].lo), hi = fmax(hi, j->part[p].hi);
        if (o->log && !(lo <= hi))
            return tc_fail(err, TC_E_ARG, "no value%s is above 0, so there is no logarithmic histogram; count linearly",
                           j->seen_only ? " in the picture" : "");
        j->range[0] = lo <= hi ? lo : 0;
        j->range[1] = lo <= hi ? hi : 0;
    }
    if (o->log)
        j->log_lo = log(j->range[0]), j->log_span = log(j->range[1]) - j->log_lo;
    return TC_OK;
}

static void sum_up(tc_histogram *h, const count *j, size_t parts)
{
    for (size_t p = 0; p < parts; p++) {
        const double *weight = j->weight + p * (j->n + 2);
        for (size_t i = 0; i < j->n; i++)
            h->weight[i] += weight[i];
        h->below += weight[j->n], h->above += weight[j->n + 1];
    }
    for (size_t i = 0; i < j->n; i++) {
        h->most = fmax(h->most, h->weight[i]);
        h->total += h->weight[i];
    }
    for (size_t p = 0; p < j->values.parts; p++)
        h->counted += j->part[p].counted, h->missing += j->part[p].missing;
}

tc_status tc_mesh_histogram(tc_histogram **out, const tc_mesh *mesh, const tc_histogram_options *options, tc_error *err)
{
    if (!out)
        return tc_fail(err, TC_E_ARG, "no place to put the histogram");
    *out = NULL;
    tc_status status = check(mesh, options, err);
    if (status != TC_OK)
        return status;
    count j = {.mesh = mesh,
               .cells = mesh->association == TC_CELL_DATA,
               .by_volume = options->by_volume,
               .log = options->log,
               .seen_only = options->camera != NULL,
               .n = options->n ? (size_t)options->n : BINS};
    if (j.seen_only)
        status = tc_sight_init(&j.sight, options->camera, options->aspect, err);
    /* points that only imaginary cells have come last, and carry no value */
    j.values = split_of(j.cells ? mesh->n_tet : mesh->n_vertex - mesh->report.n_steiner);
    j.tets = split_of(mesh->n_tet);
    if (status == TC_OK)
        status = resolve_range(&j, options, err);
    if (status != TC_OK)
        return status;

    const bool give = j.by_volume && !j.cells;
    const size_t parts = give && j.tets.parts > j.values.parts ? j.tets.parts : j.values.parts;
    tc_histogram *h = tc_calloc(1, sizeof *h);
    j.weight = tc_calloc(parts * (j.n + 2), sizeof *j.weight);
    j.bin = give ? tc_alloc(mesh->n_vertex, sizeof *j.bin) : NULL;
    if (h)
        h->weight = tc_calloc(j.n, sizeof *h->weight);
    if (!h || !h->weight || !j.weight || (give && !j.bin)) {
        status = tc_fail_memory(err, "a histogram", parts * (j.n + 2), sizeof *j.weight);
        goto done;
    }
    h->n = (int)j.n;
    h->log = j.log;
    h->range[0] = j.range[0], h->range[1] = j.range[1];
    tc_parallel_for(j.values.parts, 1, options->threads, count_values, &j);
    if (give)
        tc_parallel_for(j.tets.parts, 1, options->threads, give_volumes, &j);
    sum_up(h, &j, parts);
done:
    free(j.weight);
    free(j.bin);
    if (status != TC_OK)
        tc_histogram_destroy(&h);
    *out = h;
    return status;
}

void tc_histogram_destroy(tc_histogram **histogram)
{
    if (!histogram || !*histogram)
        return;
    free((*histogram)->weight);
    free(*histogram);
    *histogram = NULL;
}

/* Where bin i begins; n: where the last ends. */
static double edge(const tc_histogram *h, int i)
{
    const double lo = h->range[0], hi = h->range[1], x = (double)i / h->n;
    if (i == 0 || i == h->n)
        return i == 0 ? lo : hi;
    return h->log ? exp((1 - x) * log(lo) + x * log(hi)) : (1 - x) * lo + x * hi;
}

double tc_histogram_percentile(const tc_histogram *h, double share)
{
    if (!h || !(h->total > 0) || isnan(share))
        return NAN;
    const double target = fmin(fmax(share, 0), 1) * h->total;
    double below = 0;
    int i = 0, last = h->n - 1;
    while (!(h->weight[last] > 0))
        last--;
    for (; i < last && !(h->weight[i] > 0 && below + h->weight[i] >= target); i++)
        below += h->weight[i];
    const double x = share >= 1 ? 1 : fmin(fmax((target - below) / h->weight[i], 0), 1);
    return (1 - x) * edge(h, i) + x * edge(h, i + 1);
}
