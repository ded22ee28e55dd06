/* adjacency.c: which tets share a face.
 * Faces are put into parts by ranges of their smallest vertex id, one pass over the tets by the threads together. Each
 * part, small enough for a core's cache, is then linked by one thread through a hash table of its faces; parts with
 * faces that more than two tets share, or with equal tets, are sorted instead. With vertices along a space-filling
 * curve the tets of a part lie close together in memory. */
#include "mesh/adjacency.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/predicate.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

const uint8_t tc_tet_face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

enum { PART_VERTICES = 512, MOST_PARTS = 4096, CHUNK = 16384 };

typedef struct entry {
    uint64_t key;             /* middle id, largest id */
    uint32_t least, opposite; /* vertices */
    uint32_t face;            /* 4 * tet + face */
    bool odd, paired;         /* odd: ascending ids wind it inwards */
} entry;

/* One thread's. */
typedef struct scratch {
    entry *entry;
    uint32_t *slot; /* entry + 1, or 0 */
    size_t n_entry, n_slot;
} scratch;

typedef struct build {
    const tc_adjacency_input *in;
    int32_t *neighbour;
    size_t block;          /* tets that one thread goes through at a time */
    int shift;             /* vertex id → part */
    size_t n_part, *start; /* [block][part] where the block's items begin in the part */
    const size_t *part;    /* [n_part + 1] where parts begin */
    uint32_t *item;        /* 2 * tet: its three faces at its least vertex; 2 * tet + 1: the face opposite that */
    scratch *scratch;      /* by worker */
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

/* ------------------------------------------------------------------------------------------------ into parts */

static bool takes_part(const build *b, size_t t)
{
    const int32_t *w = b->neighbour + 4 * t;
    return t >= b->in->first || w[0] < 0 || w[1] < 0 || w[2] < 0 || w[3] < 0;
}

/* The parts of a tet's two items: those of its least and of its second vertex. */
static void parts_of(size_t out[2], const build *b, size_t t)
{
    const int32_t *v = b->in->tet + 4 * t;
    int32_t p = v[0] < v[1] ? v[0] : v[1], q = v[0] < v[1] ? v[1] : v[0];
    int32_t r = v[2] < v[3] ? v[2] : v[3], s = v[2] < v[3] ? v[3] : v[2];
    int32_t least = p < r ? p : r, second = p < r ? (q < r ? q : r) : (s < p ? s : p);
    out[0] = (size_t)least >> b->shift, out[1] = (size_t)second >> b->shift;
}

static size_t block_end(const build *b, size_t block)
{
    size_t end = (block + 1) * b->block;
    return end < b->in->n_tet ? end : b->in->n_tet;
}

static void count_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const build *b = context;
    for (size_t block = begin; block < end; block++) {
        size_t *count = b->start + block * b->n_part, part[2];
        for (size_t t = block * b->block, last = block_end(b, block); t < last; t++)
            if (takes_part(b, t)) {
                parts_of(part, b, t);
                count[part[0]]++;
                count[part[1]]++;
            }
    }
}

static void scatter_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const build *b = context;
    for (size_t block = begin; block < end; block++) {
        size_t *start = b->start + block * b->n_part, part[2];
        for (size_t t = block * b->block, last = block_end(b, block); t < last; t++)
            if (takes_part(b, t)) {
                parts_of(part, b, t);
                b->item[start[part[0]]++] = (uint32_t)(2 * t);
                b->item[start[part[1]]++] = (uint32_t)(2 * t + 1);
            }
    }
}

/* ----------------------------------------------------------------------------------------------- linking a part */

/* Ascending; true when they were exchanged. */
static bool ascend(uint64_t *a, uint64_t *b)
{
    uint64_t x = *a, y = *b;
    bool swap = x > y;
    *a = swap ? y : x, *b = swap ? x : y;
    return swap;
}

/* Adds the faces of an item that take part. */
static size_t add_faces(entry *e, const build *b, uint32_t item)
{
    size_t t = item >> 1, n = 0;
    const int32_t *tet = b->in->tet + 4 * t;
    uint64_t v[4]; /* id, and its place in the tet */
    for (size_t i = 0; i < 4; i++)
        v[i] = (uint64_t)(uint32_t)tet[i] << 2 | i;
    bool odd = ascend(&v[0], &v[1]);
    odd ^= ascend(&v[2], &v[3]);
    odd ^= ascend(&v[0], &v[2]);
    odd ^= ascend(&v[1], &v[3]);
    odd ^= ascend(&v[1], &v[2]);
    for (int k = item & 1 ? 0 : 1; k < (item & 1 ? 1 : 4); k++) { /* the face opposite the k-th least vertex */
        uint32_t face = (uint32_t)(4 * t + (v[k] & 3));
        if (t < b->in->first && b->neighbour[face] >= 0)
            continue;
        uint64_t least = v[k == 0 ? 1 : 0], middle = v[k < 2 ? 2 : 1], most = v[k < 3 ? 3 : 2];
        e[n++] = (entry){.key = (middle >> 2) << 32 | most >> 2,
                         .least = (uint32_t)(least >> 2),
                         .opposite = (uint32_t)(v[k] >> 2),
                         .face = face,
                         .odd = odd ^ (k & 1)};
    }
    return n;
}

static void link_pair(build *b, const entry *p, const entry *q)
{
    b->neighbour[p->face] = (int32_t)(q->face >> 2);
    b->neighbour[q->face] = (int32_t)(p->face >> 2);
}

/* False, and of no effect that counts, when a face has three tets or two tets are equal. */
static bool link_by_hash(build *b, entry *e, size_t n, uint32_t *slot, size_t n_slot)
{
    size_t one_side = 0;
    memset(slot, 0, n_slot * sizeof *slot);
    for (size_t i = 0; i < n; i++) {
        uint64_t h = (e[i].key ^ (uint64_t)e[i].least * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
        size_t s = (size_t)(h ^ h >> 32) & (n_slot - 1);
        b->neighbour[e[i].face] = -1;
        for (; slot[s]; s = (s + 1) & (n_slot - 1)) {
            entry *other = &e[slot[s] - 1];
            if (other->key != e[i].key || other->least != e[i].least)
                continue;
            if (other->paired || other->opposite == e[i].opposite)
                return false;
            other->paired = true;
            link_pair(b, other, &e[i]);
            one_side += other->odd == e[i].odd;
            break;
        }
        if (!slot[s])
            slot[s] = (uint32_t)i + 1;
    }
    if (one_side > 0)
        atomic_fetch_add(&b->n_one_side, one_side);
    return true;
}

static int entry_compare(const void *x, const void *y)
{
    const entry *a = x, *b = y;
    if (a->least != b->least)
        return a->least < b->least ? -1 : 1;
    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    if (a->opposite != b->opposite)
        return a->opposite < b->opposite ? -1 : 1;
    return a->face < b->face ? -1 : a->face > b->face;
}

/* One run of entries that are the same face. */
static void link_run(build *b, const entry *e, size_t n)
{
    for (size_t i = 1; i < n; i++)
        if (e[i].opposite == e[i - 1].opposite &&
            !atomic_exchange_explicit(&b->duplicate[e[i].face >> 2], 1, memory_order_relaxed))
            atomic_fetch_add(&b->n_duplicate, 1);
    if (n == 2) {
        link_pair(b, &e[0], &e[1]);
        if (e[0].odd == e[1].odd)
            atomic_fetch_add(&b->n_one_side, 1);
        return;
    }
    for (size_t i = 0; i < n; i++)
        b->neighbour[e[i].face] = -1;
    if (n > 2)
        atomic_fetch_add(&b->n_many, 1);
}

static void link_by_sorting(build *b, entry *e, size_t n)
{
    qsort(e, n, sizeof *e, entry_compare);
    for (size_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && e[j].key == e[i].key && e[j].least == e[i].least; j++) {
        }
        link_run(b, e + i, j - i);
    }
}

static bool make_room(scratch *s, size_t n_entry, size_t n_slot)
{
    if (n_entry > s->n_entry) {
        free(s->entry);
        s->entry = tc_alloc(n_entry, sizeof *s->entry);
        s->n_entry = s->entry ? n_entry : 0;
    }
    if (n_slot > s->n_slot) {
        free(s->slot);
        s->slot = tc_alloc(n_slot, sizeof *s->slot);
        s->n_slot = s->slot ? n_slot : 0;
    }
    return s->n_entry >= n_entry && s->n_slot >= n_slot;
}

static void link_parts(void *context, size_t begin, size_t end, int worker)
{
    build *b = context;
    scratch *s = &b->scratch[worker];
    for (size_t part = begin; part < end; part++) {
        size_t n_item = b->part[part + 1] - b->part[part], n = 0, n_slot = 16;
        while (n_slot < 4 * n_item) /* half of an entry for each slot, on average */
            n_slot *= 2;
        if (!make_room(s, 3 * n_item, n_slot)) {
            atomic_store(&b->no_memory, true);
            return;
        }
        for (size_t i = 0; i < n_item; i++)
            n += add_faces(s->entry + n, b, b->item[b->part[part] + i]);
        if (n >= n_slot || !link_by_hash(b, s->entry, n, s->slot, n_slot))
            link_by_sorting(b, s->entry, n);
    }
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

/* Puts the faces into parts. */
static tc_status divide(build *b, size_t **part, size_t n_block, int threads, tc_error *err)
{
    const tc_adjacency_input *in = b->in;
    *part = tc_alloc(b->n_part + 1, sizeof **part);
    b->start = tc_calloc(n_block, b->n_part * sizeof *b->start);
    if (!*part || !b->start)
        return tc_fail_memory(err, "linking cells", n_block * b->n_part, sizeof *b->start);
    tc_parallel_for(n_block, 1, threads, count_range, b);
    size_t sum = 0;
    for (size_t p = 0; p < b->n_part; p++) {
        (*part)[p] = sum;
        for (size_t block = 0; block < n_block; block++) {
            size_t count = b->start[block * b->n_part + p];
            b->start[block * b->n_part + p] = sum;
            sum += count;
        }
    }
    (*part)[b->n_part] = sum;
    b->part = *part;
    b->item = tc_alloc(sum, sizeof *b->item);
    if (!b->item)
        return tc_fail_memory(err, "linking cells", sum, sizeof *b->item);
    tc_parallel_for(n_block, 1, in->threads, scatter_range, b);
    return TC_OK;
}

tc_status tc_adjacency_build(int32_t *neighbour, uint8_t *duplicate, tc_adjacency_result *result,
                             const tc_adjacency_input *in, tc_error *err)
{
    tc_status status = TC_OK;
    const size_t n_worker = (size_t)tc_threads(in->threads), n_block = in->n_tet < CHUNK ? 1 : n_worker;
    size_t *part = NULL;
    *result = (tc_adjacency_result){0};
    build b = {.in = in, .neighbour = neighbour, .block = in->n_tet / n_block + 1};
    size_t vertices = PART_VERTICES;
    while (in->n_vertex / vertices >= MOST_PARTS)
        vertices *= 2;
    for (size_t i = vertices; i > 1; i /= 2)
        b.shift++;
    b.n_part = in->n_vertex / vertices + 1;
    b.scratch = tc_calloc(n_worker, sizeof *b.scratch);
    b.duplicate = tc_calloc(in->n_tet, sizeof *b.duplicate);
    atomic_init(&b.n_duplicate, 0);
    atomic_init(&b.n_many, 0);
    atomic_init(&b.n_one_side, 0);
    atomic_init(&b.no_memory, false);
    if (!b.scratch || !b.duplicate) {
        status = tc_fail_memory(err, "linking cells", in->n_tet, sizeof *b.duplicate);
        goto done;
    }
    status = divide(&b, &part, n_block, in->threads, err);
    if (status != TC_OK)
        goto done;
    tc_parallel_for(b.n_part, 1, (int)n_worker, link_parts, &b);
    if (atomic_load(&b.no_memory)) {
        status = tc_fail_memory(err, "linking the faces around some vertices", in->n_tet, 2 * sizeof(entry));
        goto done;
    }
    result->duplicates = atomic_load(&b.n_duplicate);
    result->many = atomic_load(&b.n_many);
    if (duplicate && result->duplicates == 0)
        memset(duplicate, 0, in->n_tet);
    for (size_t t = 0; duplicate && result->duplicates > 0 && t < in->n_tet; t++)
        duplicate[t] = atomic_load_explicit(&b.duplicate[t], memory_order_relaxed);
    if (atomic_load(&b.n_one_side) > 0 && result->duplicates == 0) {
        if (in->n_zero_volume > 0)
            status = turn_flat(in, neighbour, &result->reoriented, err);
        if (status == TC_OK)
            result->one_side = unlink_one_side(in->tet, neighbour, in->n_tet);
    }
done:
    for (size_t i = 0; b.scratch && i < n_worker; i++) {
        free(b.scratch[i].entry);
        free(b.scratch[i].slot);
    }
    free(b.scratch);
    free(b.start);
    free(b.item);
    free(b.duplicate);
    free(part);
    return status;
}

/* ---------------------------------------------------------------------------------------------------- components */

/* A forest: each tet leads to one before it, or is a root. */
typedef struct forest {
    atomic_int *parent;
    const int32_t *neighbour;
    size_t n;
    atomic_size_t roots;
} forest;

static int root_of(const forest *j, int t)
{
    for (;;) {
        int p = atomic_load_explicit(&j->parent[t], memory_order_relaxed);
        if (p == t)
            return t;
        int q = atomic_load_explicit(&j->parent[p], memory_order_relaxed);
        if (q == p)
            return p;
        /* what another thread may have put there meanwhile leads to the same root */
        atomic_store_explicit(&j->parent[t], q, memory_order_relaxed);
        t = q;
    }
}

/* The first neighbour before each tet needs no search for roots. */
static void plant_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const forest *j = context;
    for (size_t t = begin; t < end; t++) {
        int least = (int)t;
        for (int f = 0; f < 4; f++) {
            int u = j->neighbour[4 * t + (size_t)f];
            least = u >= 0 && u < least ? u : least;
        }
        atomic_store_explicit(&j->parent[t], least, memory_order_relaxed);
    }
}

static void join_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const forest *j = context;
    for (size_t t = begin; t < end; t++)
        for (int f = 0; f < 4; f++) {
            int a = (int)t, b = j->neighbour[4 * t + (size_t)f];
            if (b < 0 || b >= a)
                continue;
            for (;;) {
                a = root_of(j, a), b = root_of(j, b);
                if (a == b)
                    break;
                int more = a > b ? a : b, less = a > b ? b : a;
                if (atomic_compare_exchange_strong(&j->parent[more], &(int){more}, less))
                    break;
            }
        }
}

static void root_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    forest *j = context;
    size_t n = 0;
    for (size_t t = begin; t < end; t++)
        n += atomic_load_explicit(&j->parent[t], memory_order_relaxed) == (int)t;
    atomic_fetch_add(&j->roots, n);
}

tc_status tc_adjacency_components(size_t *out, const int32_t *neighbour, size_t n_tet, int threads, tc_error *err)
{
    forest j = {.parent = tc_alloc(n_tet, sizeof *j.parent), .neighbour = neighbour, .n = n_tet};
    atomic_init(&j.roots, 0);
    if (!j.parent)
        return tc_fail_memory(err, "counting parts", n_tet, sizeof *j.parent);
    tc_parallel_for(n_tet, CHUNK, threads, plant_range, &j);
    tc_parallel_for(n_tet, CHUNK, threads, join_range, &j);
    tc_parallel_for(n_tet, CHUNK, threads, root_range, &j);
    *out = atomic_load(&j.roots);
    free(j.parent);
    return TC_OK;
}
