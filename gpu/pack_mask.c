/* pack_mask.c: a bit for each real cell: what a selection keeps, and what is transparent under a function. */
#include "gpu/pack_mask.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/field.h"
#include "transfer_functions/transfer.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 16384 }; /* of cells, of whole words: one thread's at a time */
_Static_assert(CHUNK % 32 == 0, "no two threads write to one word");

static size_t words_of(size_t n)
{
    return n > 0 ? (n + 31) / 32 : 1;
}

/* Bits that are set, in 12 operations (Warren, Hacker's Delight, 5-1). */
static size_t bits_of(uint32_t x)
{
    x -= x >> 1 & 0x55555555u;
    x = (x & 0x33333333u) + (x >> 2 & 0x33333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0fu;
    return x * 0x01010101u >> 24;
}

static size_t count_bits(const uint32_t *mask, size_t n)
{
    size_t sum = 0;
    for (size_t i = 0; i < words_of(n); i++)
        sum += bits_of(mask[i]);
    return sum;
}

static tc_status make_mask(uint32_t **out, size_t n, tc_error *err)
{
    *out = tc_calloc(words_of(n), sizeof **out);
    return *out ? TC_OK : tc_fail_memory(err, "a mask of cells", words_of(n), sizeof **out);
}

/* --------------------------------------------------------------------------------------------------- selection */

/* The ranges of a tc_select by their lower ends, and the largest upper end up to each: one of them holds lo … hi if and
 * only if the upper end so far is at least hi where the lower ends pass lo. */
typedef struct ranges {
    int n;
    double *from, *to; /* [n] */
} ranges;

static int compare_ranges(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (p[0] > q[0]) - (p[0] < q[0]);
}

static bool sort_ranges(ranges *out, const tc_select *select)
{
    const size_t n = (size_t)select->n_range;
    double(*pair)[2] = tc_alloc(n, sizeof *pair);
    *out = (ranges){select->n_range, tc_alloc(n, sizeof(double)), tc_alloc(n, sizeof(double))};
    if (pair && out->from && out->to) {
        memcpy(pair, select->range, n * sizeof *pair);
        qsort(pair, n, sizeof *pair, compare_ranges);
        for (size_t i = 0; i < n; i++) {
            out->from[i] = pair[i][0];
            out->to[i] = i > 0 && out->to[i - 1] > pair[i][1] ? out->to[i - 1] : pair[i][1];
        }
    }
    free(pair);
    return pair && out->from && out->to;
}

static void finish_ranges(ranges *r)
{
    free(r->from);
    free(r->to);
}

static bool holds(const ranges *r, double lo, double hi)
{
    int first = 0, n = r->n; /* how many begin at or before lo */
    while (n > 0) {
        const int half = n / 2;
        const bool after = r->from[first + half] <= lo;
        first = after ? first + half + 1 : first;
        n = after ? n - half - 1 : half;
    }
    return first > 0 && r->to[first - 1] >= hi;
}

typedef struct selection {
    uint32_t *mask;
    const tc_mesh *mesh;
    const double *value;
    bool of_cells;
    ranges ranges;
} selection;

static bool keeps(const selection *j, size_t cell)
{
    if (j->of_cells)
        return isfinite(j->value[cell]) && holds(&j->ranges, j->value[cell], j->value[cell]);
    const int32_t *tet = j->mesh->tet + 4 * cell;
    double lo = j->value[tet[0]], hi = lo;
    bool finite = isfinite(lo);
    for (int k = 1; k < 4; k++) {
        const double x = j->value[tet[k]];
        lo = x < lo ? x : lo;
        hi = x > hi ? x : hi;
        finite &= isfinite(x) != 0;
    }
    return finite && holds(&j->ranges, lo, hi);
}

/* Takes what is not kept out of the mask. */
static void select_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const selection *j = context;
    for (size_t i = begin; i < end; i += 32) {
        uint32_t word = 0;
        for (size_t k = i; k < end && k < i + 32; k++)
            word |= (uint32_t)keeps(j, k) << (k & 31);
        j->mask[i / 32] &= word;
    }
}

tc_status tc_pack_mask_select(uint32_t **out, size_t *kept, const tc_mesh *mesh, const tc_select *select, size_t n,
                              int threads, tc_error *err)
{
    tc_status status = make_mask(out, mesh->n_tet, err);
    for (size_t i = 0; status == TC_OK && i < mesh->n_tet; i += 32)
        (*out)[i / 32] = mesh->n_tet - i < 32 ? (1u << (mesh->n_tet - i)) - 1 : UINT32_MAX;
    for (size_t i = 0; status == TC_OK && i < n; i++) {
        const tc_field *field = select[i].field;
        selection j = {.mask = *out,
                       .mesh = mesh,
                       .value = field ? field->value : mesh->scalar,
                       .of_cells = (field ? field->association : mesh->association) == TC_CELL_DATA};
        if (sort_ranges(&j.ranges, &select[i]))
            tc_parallel_for(mesh->n_tet, CHUNK, threads, select_range, &j);
        else
            status = tc_fail_memory(err, "a selection", (size_t)select[i].n_range, 4 * sizeof(double));
        finish_ranges(&j.ranges);
    }
    if (status != TC_OK) {
        free(*out);
        *out = NULL;
        return status;
    }
    if (kept)
        *kept = count_bits(*out, mesh->n_tet);
    return TC_OK;
}

/* --------------------------------------------------------------------------------------------------- empty space */

enum { PLACES = 1024 };                    /* of the lookup table */
static const uint32_t SEARCH = UINT32_MAX; /* the number at a place where there are several */

/* Where a function's attenuation is 0: runs from [i] … to [i], ends included, in order, that do not touch. Scalars are
 * numbered by the run that they lie in, from 1, those in none 0: a cell is transparent if and only if its scalars have
 * one number and it is not 0, since the runs have no holes. `number` holds that of all scalars whose place is the same.
 */
typedef struct runs {
    size_t n;
    double *from, *to;
    double lo, per_place;
    uint32_t number[PLACES];
} runs;

/* Never less for a larger s, also where per_place is infinite or 0. Of NaN anything. */
static int place_of(const runs *r, double s)
{
    const double at = (s - r->lo) * r->per_place;
    return at >= PLACES - 1 ? PLACES - 1 : at > 0 ? (int)at : 0;
}

static void add_run(runs *r, double from, double to)
{
    if (from > to)
        return;
    r->from[r->n] = from;
    r->to[r->n++] = to;
}

/* Of a piece of the function nothing is 0 but what its ends are: a run begins behind or at a knot and ends there. */
static void find_runs(runs *r, const tc_transfer *tf)
{
    const tc_knot *knot = tf->knot;
    bool open = knot[0].a == 0; /* before the first knot its value holds */
    double from = -INFINITY;
    for (size_t i = 0; i < tf->n; i++) {
        const bool clear = knot[i].a == 0;
        if (open && !clear) { /* never the first; up to the knot before, as far as nothing steps up there */
            const bool step = knot[i - 1].s == knot[i].s;
            add_run(r, from, step ? nextafter(knot[i].s, -INFINITY) : knot[i - 1].s);
        }
        if (clear && !open)
            from = i > 0 && knot[i - 1].s == knot[i].s ? nextafter(knot[i].s, INFINITY) : knot[i].s;
        open = clear;
    }
    if (open)
        add_run(r, from, INFINITY);
}

/* A place that holds no end of a run lies in one, or outside of all, for place_of never falls. */
static void number_places(runs *r)
{
    int next = 0;
    for (size_t i = 0; i <= r->n; i++) {
        const int first = i < r->n && r->from[i] != -INFINITY ? place_of(r, r->from[i]) : i < r->n ? -1 : PLACES;
        for (; next < first; next++)
            r->number[next] = 0;
        if (i == r->n)
            break;
        const int last = r->to[i] != INFINITY ? place_of(r, r->to[i]) : PLACES;
        if (first >= 0)
            r->number[first] = SEARCH, next = first + 1;
        for (; next < last; next++)
            r->number[next] = (uint32_t)i + 1;
        if (last < PLACES)
            r->number[last] = SEARCH, next = last + 1;
    }
}

static uint32_t search(const runs *r, double s)
{
    size_t first = 0, n = r->n;
    while (n > 0) {
        const size_t half = n / 2;
        const bool after = r->from[first + half] <= s;
        first = after ? first + half + 1 : first;
        n = after ? n - half - 1 : half;
    }
    return first > 0 && s <= r->to[first - 1] ? (uint32_t)first : 0;
}

static uint32_t number_of(const runs *r, double s)
{
    const uint32_t number = r->number[place_of(r, s)];
    if (!(fabs(s) <= DBL_MAX))
        return 0;
    return number == SEARCH ? search(r, s) : number;
}

typedef struct emptiness {
    uint32_t *mask;
    const tc_mesh *mesh;
    const runs *runs;
    uint32_t *number; /* [n_vertex] with point data */
} emptiness;

static void number_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const emptiness *j = context;
    for (size_t i = begin; i < end; i++)
        j->number[i] = number_of(j->runs, j->mesh->scalar[i]);
}

static void point_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const emptiness *j = context;
    for (size_t i = begin; i < end; i += 32) {
        uint32_t word = 0;
        const size_t n = end - i < 32 ? end - i : 32;
        const int32_t *tet = j->mesh->tet + 4 * i;
        for (size_t k = 0; k < n; k++, tet += 4) {
            const uint32_t a = j->number[tet[0]], b = j->number[tet[1]], c = j->number[tet[2]], d = j->number[tet[3]];
            word |= (uint32_t)((((a ^ b) | (a ^ c) | (a ^ d)) == 0) & (a != 0)) << k;
        }
        j->mask[i / 32] = word;
    }
}

static void cell_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const emptiness *j = context;
    for (size_t i = begin; i < end; i += 32) {
        uint32_t word = 0;
        const size_t n = end - i < 32 ? end - i : 32;
        for (size_t k = 0; k < n; k++)
            word |= (uint32_t)(number_of(j->runs, j->mesh->scalar[i + k]) != 0) << k;
        j->mask[i / 32] = word;
    }
}

static tc_status make_runs(runs *r, const tc_mesh *mesh, const tc_transfer *tf, tc_error *err)
{
    const double *range = mesh->report.scalar_range;
    const double width = range[1] - range[0];
    r->n = 0;
    r->lo = range[0];
    r->per_place = width > 0 ? PLACES / width : 0;
    r->from = tc_alloc(tf->n, sizeof *r->from);
    r->to = tc_alloc(tf->n, sizeof *r->to);
    if (!r->from || !r->to)
        return tc_fail_memory(err, "the empty parts of a function", tf->n, 2 * sizeof *r->from);
    find_runs(r, tf);
    number_places(r);
    return TC_OK;
}

tc_status tc_pack_mask_empty(uint32_t **out, size_t *n_empty, const tc_mesh *mesh, const tc_transfer *transfer,
                             int threads, tc_error *err)
{
    const bool of_cells = mesh->association == TC_CELL_DATA;
    runs r = {0};
    emptiness j = {.mesh = mesh, .runs = &r};
    tc_status status = make_mask(out, mesh->n_tet, err);
    j.mask = *out;
    if (status == TC_OK)
        status = make_runs(&r, mesh, transfer, err);
    if (status == TC_OK && !of_cells && r.n > 0) {
        j.number = tc_alloc(mesh->n_vertex, sizeof *j.number);
        if (!j.number)
            status = tc_fail_memory(err, "a mask of cells", mesh->n_vertex, sizeof *j.number);
    }
    if (status == TC_OK && r.n > 0) {
        if (!of_cells)
            tc_parallel_for(mesh->n_vertex, CHUNK, threads, number_range, &j);
        tc_parallel_for(mesh->n_tet, CHUNK, threads, of_cells ? cell_range : point_range, &j);
    }
    free(j.number);
    free(r.from);
    free(r.to);
    if (status != TC_OK) {
        free(*out);
        *out = NULL;
        return status;
    }
    if (n_empty)
        *n_empty = count_bits(*out, mesh->n_tet);
    return TC_OK;
}
