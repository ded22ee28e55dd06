/* bvh.c: builds the hierarchy top down.
 * I. Wald, On fast construction of SAH-based bounding volume hierarchies, 2007, section 3: centroids in 16 bins along
 * the widest axis; the cut with the least area x count wins. Below a depth of 40 the median is taken, which bounds the
 * depth by 40 + 31. */
#include "reference/bvh.h"

#include "core/memory.h"
#include "core/parallel.h"

#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { BINS = 16, LEAF = 4, SAH_DEPTH = 40, TASKS_MAX = 1024 };

/* One subtree still to be built: node `at` over order[begin, end). */
typedef struct task {
    uint32_t at, begin, end;
    int depth;
} task;

typedef struct build {
    tc_bvh_node *node;
    uint32_t *order;
    const tc_bvh_box *box;
    atomic_uint_fast32_t n_node;
    task *todo;
} build;

static void box_empty(tc_bvh_box *b)
{
    for (int i = 0; i < 3; i++)
        b->lo[i] = FLT_MAX, b->hi[i] = -FLT_MAX;
}

static void box_join(tc_bvh_box *b, const tc_bvh_box *a)
{
    for (int i = 0; i < 3; i++) {
        b->lo[i] = a->lo[i] < b->lo[i] ? a->lo[i] : b->lo[i];
        b->hi[i] = a->hi[i] > b->hi[i] ? a->hi[i] : b->hi[i];
    }
}

static float box_area(const tc_bvh_box *b)
{
    float x = b->hi[0] - b->lo[0], y = b->hi[1] - b->lo[1], z = b->hi[2] - b->lo[2];
    return x * y + y * z + z * x;
}

static float middle(const tc_bvh_box *b, int axis)
{
    return 0.5f * (b->lo[axis] + b->hi[axis]);
}

static void swap(uint32_t *a, uint32_t *b)
{
    uint32_t t = *a;
    *a = *b, *b = t;
}

/* Puts the k smallest middles of order[begin, end) first (quickselect, median of three). */
static void select_middle(const build *b, uint32_t begin, uint32_t end, uint32_t k, int axis)
{
    uint32_t *o = b->order;
    while (end - begin > 1) {
        float x = middle(&b->box[o[begin]], axis), y = middle(&b->box[o[begin + (end - begin) / 2]], axis);
        float z = middle(&b->box[o[end - 1]], axis);
        float pivot = fmaxf(fminf(x, y), fminf(fmaxf(x, y), z));
        uint32_t less = begin, i = begin, more = end; /* three ways: many middles may be equal */
        while (i < more) {
            float m = middle(&b->box[o[i]], axis);
            if (m < pivot)
                swap(&o[less++], &o[i++]);
            else if (m > pivot)
                swap(&o[--more], &o[i]);
            else
                i++;
        }
        if (k < less)
            end = less;
        else if (k >= more)
            begin = more;
        else
            return;
    }
}

/* Where to cut order[begin, end), partitioned accordingly; begin < result < end. */
static uint32_t cut(const build *b, uint32_t begin, uint32_t end, int depth)
{
    float lo[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, hi[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
    for (uint32_t i = begin; i < end; i++)
        for (int a = 0; a < 3; a++) {
            float m = middle(&b->box[b->order[i]], a);
            lo[a] = fminf(lo[a], m), hi[a] = fmaxf(hi[a], m);
        }
    int axis = 0;
    for (int a = 1; a < 3; a++)
        if (hi[a] - lo[a] > hi[axis] - lo[axis])
            axis = a;
    uint32_t half = begin + (end - begin) / 2;
    float extent = hi[axis] - lo[axis];
    if (!(extent > 0))
        return half;
    if (depth >= SAH_DEPTH) {
        select_middle(b, begin, end, half, axis);
        return half;
    }

    tc_bvh_box bin[BINS];
    uint32_t count[BINS] = {0};
    float left[BINS], scale = BINS / extent;
    for (int i = 0; i < BINS; i++)
        box_empty(&bin[i]);
    for (uint32_t i = begin; i < end; i++) {
        const tc_bvh_box *x = &b->box[b->order[i]];
        int k = (int)fminf((middle(x, axis) - lo[axis]) * scale, BINS - 1);
        count[k]++;
        box_join(&bin[k], x);
    }
    tc_bvh_box sum;
    box_empty(&sum);
    uint32_t n = 0;
    for (int i = 0; i < BINS - 1; i++) {
        box_join(&sum, &bin[i]);
        n += count[i];
        left[i] = n ? box_area(&sum) * (float)n : 0;
    }
    box_empty(&sum);
    n = 0;
    int best = -1;
    float least = INFINITY;
    for (int i = BINS - 1; i > 0; i--) {
        box_join(&sum, &bin[i]);
        n += count[i];
        if (n == 0 || n == end - begin)
            continue;
        float cost = box_area(&sum) * (float)n + left[i - 1];
        if (cost < least)
            least = cost, best = i;
    }
    if (best < 0) { /* an extent so small that BINS / extent overflowed */
        select_middle(b, begin, end, half, axis);
        return half;
    }
    uint32_t i = begin, j = end;
    while (i < j) {
        int k = (int)fminf((middle(&b->box[b->order[i]], axis) - lo[axis]) * scale, BINS - 1);
        if (k < best)
            i++;
        else
            swap(&b->order[i], &b->order[--j]);
    }
    return i;
}

/* Fills a node; false: a leaf. Otherwise left and right are what remains. */
static bool split(build *b, const task *t, task *left, task *right)
{
    tc_bvh_node *node = &b->node[t->at];
    box_empty(&node->box);
    for (uint32_t i = t->begin; i < t->end; i++)
        box_join(&node->box, &b->box[b->order[i]]);
    if (t->end - t->begin <= LEAF) {
        node->first = t->begin;
        node->count = t->end - t->begin;
        return false;
    }
    uint32_t at = cut(b, t->begin, t->end, t->depth);
    uint32_t child = (uint32_t)atomic_fetch_add(&b->n_node, 2);
    node->first = child;
    node->count = 0;
    *left = (task){child, t->begin, at, t->depth + 1};
    *right = (task){child + 1, at, t->end, t->depth + 1};
    return true;
}

static void build_subtrees(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    build *b = context;
    for (size_t k = begin; k < end; k++) {
        task stack[TC_BVH_STACK], left, right;
        int top = 0;
        stack[top++] = b->todo[k];
        while (top > 0) {
            task t = stack[--top];
            if (split(b, &t, &left, &right)) {
                stack[top++] = right;
                stack[top++] = left;
            }
        }
    }
}

tc_status tc_bvh_build(tc_bvh *out, const tc_bvh_box *box, size_t n, int threads, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (n >= (size_t)1 << 31)
        return tc_fail(err, TC_E_ARG, "the reference caster takes fewer than 2^31 tets; this mesh has %zu", n);
    if (n == 0)
        return TC_OK;
    task *todo = tc_alloc(TASKS_MAX + 1, sizeof *todo);
    tc_bvh_node *node = tc_alloc(2 * n, sizeof *node);
    uint32_t *order = tc_alloc(n, sizeof *order);
    if (!todo || !node || !order) {
        free(todo), free(node), free(order);
        return tc_fail_memory(err, "the reference caster's hierarchy", n, 2 * sizeof *node + sizeof *order);
    }
    for (size_t i = 0; i < n; i++)
        order[i] = (uint32_t)i;
    build b = {.node = node, .order = order, .box = box, .todo = todo};
    atomic_init(&b.n_node, 1);

    /* The largest subtrees are split here until there is work for all threads. */
    size_t n_todo = 1, want = (size_t)tc_threads(threads) * 8;
    if (tc_threads(threads) == 1 || want > TASKS_MAX)
        want = tc_threads(threads) == 1 ? 1 : TASKS_MAX;
    todo[0] = (task){0, 0, (uint32_t)n, 0};
    while (n_todo < want) {
        size_t k = 0;
        for (size_t i = 1; i < n_todo; i++)
            if (todo[i].end - todo[i].begin > todo[k].end - todo[k].begin)
                k = i;
        if (todo[k].end - todo[k].begin < 1024)
            break;
        task left, right, t = todo[k];
        if (!split(&b, &t, &left, &right))
            break;
        todo[k] = left;
        todo[n_todo++] = right;
    }
    tc_parallel_for(n_todo, 1, threads, build_subtrees, &b);
    free(todo);

    out->n_node = (size_t)atomic_load(&b.n_node);
    out->n_item = n;
    out->order = order;
    tc_bvh_node *smaller = tc_realloc(node, out->n_node, sizeof *node);
    out->node = smaller ? smaller : node;
    return TC_OK;
}

void tc_bvh_finish(tc_bvh *bvh)
{
    free(bvh->node);
    free(bvh->order);
    memset(bvh, 0, sizeof *bvh);
}
