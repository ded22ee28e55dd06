/* adjacency.c: which tets share a face.
 * Faces are put into one bucket per smallest vertex id (counting sort); each bucket is sorted by the two other ids and
 * linked on its own, so buckets go to threads without locks. With vertices along a space-filling curve a
 * bucket's faces lie close together in memory. */
#include "mesh/adjacency.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/predicate.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

const uint8_t tc_tet_face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

typedef struct entry {
    uint64_t key;      /* middle id, largest id */
    uint32_t opposite; /* vertex */
    uint32_t face;     /* 4 * tet + face */
} entry;

typedef struct build {
    int32_t *neighbour, *tet;
    const uint32_t *start, *item; /* buckets */
    atomic_uchar *duplicate;
    atomic_size_t n_duplicate, n_many, n_one_side;
    atomic_bool no_memory;
} build;

/* Ids of a face ascending; gives the parity of the permutation from its outward order. */
static int face_key(int32_t *key, const int32_t *tet, int f)
{
    int32_t a = tet[tc_tet_face[f][0]], b = tet[tc_tet_face[f][1]], c = tet[tc_tet_face[f][2]], t;
    int parity = 0;
    if (a > b)
        t = a, a = b, b = t, parity ^= 1;
    if (b > c)
        t = b, b = c, c = t, parity ^= 1;
    if (a > b)
        t = a, a = b, b = t, parity ^= 1;
    key[0] = a, key[1] = b, key[2] = c;
    return parity;
}

static int32_t face_min(const int32_t *tet, int f)
{
    int32_t a = tet[tc_tet_face[f][0]], b = tet[tc_tet_face[f][1]], c = tet[tc_tet_face[f][2]];
    a = a < b ? a : b;
    return a < c ? a : c;
}

static bool entry_less(const entry *a, const entry *b)
{
    if (a->key != b->key)
        return a->key < b->key;
    if (a->opposite != b->opposite)
        return a->opposite < b->opposite;
    return a->face < b->face;
}

static int entry_compare(const void *a, const void *b)
{
    return entry_less(a, b) ? -1 : entry_less(b, a);
}

static void entry_sort(entry *e, size_t n)
{
    if (n > 48) {
        qsort(e, n, sizeof *e, entry_compare);
        return;
    }
    for (size_t i = 1; i < n; i++) {
        entry x = e[i];
        size_t j = i;
        for (; j > 0 && entry_less(&x, &e[j - 1]); j--)
            e[j] = e[j - 1];
        e[j] = x;
    }
}

/* One run of entries that are the same face. */
static void link_run(build *b, const entry *e, size_t n)
{
    for (size_t i = 1; i < n; i++)
        if (e[i].opposite == e[i - 1].opposite &&
            !atomic_exchange_explicit(&b->duplicate[e[i].face >> 2], 1, memory_order_relaxed))
            atomic_fetch_add(&b->n_duplicate, 1);
    if (n == 2) {
        uint32_t p = e[0].face, q = e[1].face;
        b->neighbour[p] = (int32_t)(q >> 2);
        b->neighbour[q] = (int32_t)(p >> 2);
        int32_t key[3];
        if (face_key(key, b->tet + 4 * (size_t)(p >> 2), p & 3) == face_key(key, b->tet + 4 * (size_t)(q >> 2), q & 3))
            atomic_fetch_add(&b->n_one_side, 1);
        return;
    }
    for (size_t i = 0; i < n; i++)
        b->neighbour[e[i].face] = -1;
    if (n > 2)
        atomic_fetch_add(&b->n_many, 1);
}

static void link_buckets(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    build *b = context;
    entry local[512], *scratch = NULL;
    size_t capacity = 0;
    for (size_t v = begin; v < end; v++) {
        size_t first = b->start[v], n = b->start[v + 1] - first;
        entry *e = local;
        if (n > sizeof local / sizeof local[0]) {
            if (n > capacity) {
                free(scratch);
                capacity = n;
                scratch = tc_alloc(n, sizeof *scratch);
                if (!scratch) {
                    atomic_store(&b->no_memory, true);
                    return;
                }
            }
            e = scratch;
        }
        for (size_t i = 0; i < n; i++) {
            uint32_t face = b->item[first + i];
            const int32_t *t = b->tet + 4 * (size_t)(face >> 2);
            int32_t key[3];
            face_key(key, t, face & 3);
            e[i] = (entry){(uint64_t)key[1] << 32 | (uint32_t)key[2], (uint32_t)t[face & 3], face};
        }
        entry_sort(e, n);
        for (size_t i = 0, j; i < n; i = j) {
            for (j = i + 1; j < n && e[j].key == e[i].key; j++) {
            }
            link_run(b, e + i, j - i);
        }
    }
    free(scratch);
}

/* The face of tet u that is face f of tet t. */
static int face_of(const int32_t *tet, size_t t, int f, size_t u)
{
    int32_t key[3], other[3];
    face_key(key, tet + 4 * t, f);
    for (int g = 0; g < 4; g++) {
        face_key(other, tet + 4 * u, g);
        if (key[0] == other[0] && key[1] == other[1] && key[2] == other[2])
            return g;
    }
    return -1;
}

/* Do tet t and its neighbour across face f wind their common face in opposite senses? */
static bool fits(const int32_t *tet, size_t t, int f, size_t u)
{
    int32_t key[3];
    return face_key(key, tet + 4 * t, f) != face_key(key, tet + 4 * u, face_of(tet, t, f, u));
}

/* The zero-volume tets from in->first on. */
typedef struct flats {
    uint32_t *tet, *queue; /* [n] each */
    uint8_t *open;         /* [n_tet]: zero volume, and its orientation is not chosen yet */
    size_t n;
} flats;

/* Neighbours that the orientation of tet t fits, less those that it does not; only those with open[u] == 0 count. */
static int balance_of(const int32_t *tet, const int32_t *neighbour, const uint8_t *open, size_t t)
{
    int balance = 0;
    for (int f = 0; f < 4; f++) {
        int32_t u = neighbour[4 * t + (size_t)f];
        if (u >= 0 && !open[u])
            balance += fits(tet, t, f, (size_t)u) ? 1 : -1;
    }
    return balance;
}

static bool turn_if_better(int32_t *tet, int32_t *neighbour, const uint8_t *open, size_t t)
{
    if (balance_of(tet, neighbour, open, t) >= 0)
        return false;
    int32_t *v = tet + 4 * t, *w = neighbour + 4 * t, k;
    k = v[2], v[2] = v[3], v[3] = k;
    k = w[2], w[2] = w[3], w[3] = k;
    return true;
}

/* Chooses orientations outwards from the tets that have one; a cluster without such neighbours starts anywhere. */
static size_t spread_orientation(const tc_adjacency_input *in, int32_t *neighbour, flats *s)
{
    size_t turned = 0, head = 0, tail = 0;
    for (size_t i = 0; i < s->n; i++) { /* beside one that is fixed: first in the queue */
        bool beside = false;
        for (size_t f = 0; f < 4; f++) {
            int32_t u = neighbour[4 * (size_t)s->tet[i] + f];
            beside = beside || (u >= 0 && !s->open[u]);
        }
        if (beside)
            s->queue[tail++] = s->tet[i];
    }
    for (size_t i = 0; i < tail; i++)
        s->open[s->queue[i]] = 2; /* queued */
    for (size_t seed = 0;;) {
        for (; head < tail; head++) {
            size_t t = s->queue[head];
            turned += turn_if_better(in->tet, neighbour, s->open, t);
            s->open[t] = 0;
            for (size_t f = 0; f < 4; f++) {
                int32_t u = neighbour[4 * t + f];
                if (u >= 0 && s->open[u] == 1)
                    s->open[u] = 2, s->queue[tail++] = (uint32_t)u;
            }
        }
        while (seed < s->n && s->open[s->tet[seed]] != 1)
            seed++;
        if (seed == s->n)
            return turned;
        s->open[s->tet[seed]] = 2;
        s->queue[tail++] = s->tet[seed];
    }
}

/* Zero-volume tets have no orientation of their own: turn each the way that fits its neighbours. */
static tc_status turn_flat(const tc_adjacency_input *in, int32_t *neighbour, size_t *turned, tc_error *err)
{
    flats s = {.tet = tc_alloc(in->n_zero_volume, sizeof *s.tet),
               .queue = tc_alloc(in->n_zero_volume, sizeof *s.queue),
               .open = tc_calloc(in->n_tet, 1)};
    if (!s.tet || !s.queue || !s.open) {
        free(s.tet);
        free(s.queue);
        free(s.open);
        return tc_fail_memory(err, "the list of zero-volume cells", in->n_zero_volume * 8 + in->n_tet, 1);
    }
    for (size_t t = in->first; t < in->n_tet && s.n < in->n_zero_volume; t++) {
        const int32_t *v = in->tet + 4 * t;
        const double *x = in->vertex;
        if (tc_orient3d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], x + 3 * (size_t)v[3]) == 0)
            s.tet[s.n++] = (uint32_t)t, s.open[t] = 1;
    }
    *turned = spread_orientation(in, neighbour, &s);
    for (bool again = true; again;) { /* every turn makes more faces fit, so this ends */
        again = false;
        for (size_t i = 0; i < s.n; i++)
            if (turn_if_better(in->tet, neighbour, s.open, s.tet[i]))
                again = true, ++*turned;
    }
    free(s.tet);
    free(s.queue);
    free(s.open);
    return TC_OK;
}

static size_t unlink_one_side(const int32_t *tet, int32_t *neighbour, size_t n_tet)
{
    size_t n = 0;
    for (size_t t = 0; t < n_tet; t++)
        for (int f = 0; f < 4; f++) {
            int32_t u = neighbour[4 * t + (size_t)f];
            if (u < 0 || (size_t)u < t || fits(tet, t, f, (size_t)u))
                continue;
            neighbour[4 * (size_t)u + (size_t)face_of(tet, t, f, (size_t)u)] = -1;
            neighbour[4 * t + (size_t)f] = -1;
            n++;
        }
    return n;
}

tc_status tc_adjacency_build(int32_t *neighbour, uint8_t *duplicate, tc_adjacency_result *result,
                             const tc_adjacency_input *in, tc_error *err)
{
    tc_status status = TC_OK;
    size_t n_item = 0;
    uint32_t *item = NULL, *start = tc_calloc(in->n_vertex + 2, sizeof *start);
    atomic_uchar *mark = tc_calloc(in->n_tet, sizeof *mark);
    *result = (tc_adjacency_result){0};
    if (!start || !mark) {
        status = tc_fail_memory(err, "linking cells", in->n_vertex + in->n_tet, sizeof *start);
        goto done;
    }
    /* counts go two places up: after the scatter start[v] is where bucket v begins */
    for (size_t t = 0; t < in->n_tet; t++)
        for (int f = 0; f < 4; f++)
            if (t >= in->first || neighbour[4 * t + (size_t)f] < 0)
                start[face_min(in->tet + 4 * t, f) + 2]++, n_item++;
    for (size_t v = 0; v < in->n_vertex; v++)
        start[v + 2] += start[v + 1];
    item = tc_alloc(n_item, sizeof *item);
    if (!item) {
        status = tc_fail_memory(err, "linking cells", n_item, sizeof *item);
        goto done;
    }
    for (size_t t = 0; t < in->n_tet; t++)
        for (int f = 0; f < 4; f++)
            if (t >= in->first || neighbour[4 * t + (size_t)f] < 0)
                item[start[face_min(in->tet + 4 * t, f) + 1]++] = (uint32_t)(4 * t + (size_t)f);

    build b = {.neighbour = neighbour, .tet = in->tet, .start = start, .item = item, .duplicate = mark};
    atomic_init(&b.n_duplicate, 0);
    atomic_init(&b.n_many, 0);
    atomic_init(&b.n_one_side, 0);
    atomic_init(&b.no_memory, false);
    tc_parallel_for(in->n_vertex, 1024, in->threads, link_buckets, &b);
    if (atomic_load(&b.no_memory)) {
        status = tc_fail_memory(err, "linking the faces around one vertex", n_item, sizeof(entry));
        goto done;
    }
    result->duplicates = atomic_load(&b.n_duplicate);
    result->many = atomic_load(&b.n_many);
    if (duplicate)
        for (size_t t = 0; t < in->n_tet; t++)
            duplicate[t] = atomic_load_explicit(&mark[t], memory_order_relaxed);
    if (atomic_load(&b.n_one_side) > 0 && result->duplicates == 0) {
        if (in->n_zero_volume > 0)
            status = turn_flat(in, neighbour, &result->reoriented, err);
        if (status == TC_OK)
            result->one_side = unlink_one_side(in->tet, neighbour, in->n_tet);
    }
done:
    free(start);
    free(item);
    free(mark);
    return status;
}

tc_status tc_adjacency_components(size_t *out, const int32_t *neighbour, size_t n_tet, tc_error *err)
{
    size_t n = 0;
    uint8_t *seen = tc_calloc(n_tet, 1);
    int32_t *stack = tc_alloc(n_tet, sizeof *stack);
    if (!seen || !stack) {
        free(seen);
        free(stack);
        return tc_fail_memory(err, "counting parts", n_tet, 5);
    }
    for (size_t root = 0; root < n_tet; root++) {
        if (seen[root])
            continue;
        n++;
        size_t top = 0;
        stack[top++] = (int32_t)root;
        seen[root] = 1;
        while (top > 0) {
            const int32_t *w = neighbour + 4 * (size_t)stack[--top];
            for (int f = 0; f < 4; f++)
                if (w[f] >= 0 && (size_t)w[f] < n_tet && !seen[w[f]])
                    seen[w[f]] = 1, stack[top++] = w[f];
        }
    }
    *out = n;
    free(seen);
    free(stack);
    return TC_OK;
}
