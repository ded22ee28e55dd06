/* sort.c: items by 64-bit keys.
 * One pass over all, by the threads together, puts items into bins by the highest bits in which keys differ. Then each
 * bin, small enough for a core's cache, is one thread's: again by its highest bits, and by insertion where few are
 * left. */
#include "mesh/sort.h"

#include "core/memory.h"
#include "core/parallel.h"

#include <stdlib.h>
#include <string.h>

enum { TOP_BITS = 11, BITS = 8, FEW = 24, ALONE = 1 << 15 };

typedef struct items {
    uint64_t *key;
    uint32_t *id;
} items;

static items items_at(items a, size_t i)
{
    return (items){a.key + i, a.id + i};
}

/* How many low bits there are up to the highest one set. */
static int width_of(uint64_t x)
{
    int n = 0;
    for (; x; x >>= 1)
        n++;
    return n;
}

/* `to` may be `from`. */
static void insertion(items to, items from, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint64_t key = from.key[i];
        uint32_t id = from.id[i];
        size_t j = i;
        for (; j > 0 && to.key[j - 1] > key; j--)
            to.key[j] = to.key[j - 1], to.id[j] = to.id[j - 1];
        to.key[j] = key, to.id[j] = id;
    }
}

/* Sorts a; the result lies in b where over, else in a. The other is scratch. */
static void sort_bin(items a, items b, size_t n, bool over)
{
    uint64_t differ = 0;
    for (size_t i = 1; i < n && n > FEW; i++)
        differ |= a.key[i] ^ a.key[0];
    if (n <= FEW || differ == 0) {
        insertion(over ? b : a, a, n);
        return;
    }
    int top = width_of(differ), bits = width_of(n / 8);
    bits = bits > BITS ? BITS : bits;
    bits = bits > top ? top : bits;
    const int shift = top - bits;
    const uint64_t mask = ((uint64_t)1 << bits) - 1;
    size_t start[(1 << BITS) + 1] = {0};
    for (size_t i = 0; i < n; i++)
        start[(a.key[i] >> shift & mask) + 1]++;
    for (size_t k = 0; k < mask; k++)
        start[k + 1] += start[k];
    for (size_t i = 0; i < n; i++) {
        size_t at = start[a.key[i] >> shift & mask]++;
        b.key[at] = a.key[i], b.id[at] = a.id[i];
    }
    for (size_t k = 0, begin = 0; k <= mask; begin = start[k++]) /* start[k] is now where bin k ends */
        if (start[k] > begin)
            sort_bin(items_at(b, begin), items_at(a, begin), start[k] - begin, !over);
}

typedef struct sort {
    items from, to;
    size_t n, block; /* items, and how many of them are a block */
    int shift, bits;
    uint64_t *differ;  /* by block */
    size_t *start;     /* [block][1 << bits] */
    const size_t *bin; /* [(1 << bits) + 1] where bins begin */
} sort;

static size_t block_end(const sort *s, size_t block)
{
    size_t end = (block + 1) * s->block;
    return end < s->n ? end : s->n;
}

static void differ_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const sort *s = context;
    for (size_t block = begin; block < end; block++) {
        uint64_t differ = 0;
        for (size_t i = block * s->block, last = block_end(s, block); i < last; i++)
            differ |= s->from.key[i] ^ s->from.key[0];
        s->differ[block] = differ;
    }
}

static size_t bin_of(const sort *s, size_t i)
{
    return s->from.key[i] >> s->shift & (((size_t)1 << s->bits) - 1);
}

static void count_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const sort *s = context;
    for (size_t block = begin; block < end; block++) {
        size_t *count = s->start + (block << s->bits);
        for (size_t i = block * s->block, last = block_end(s, block); i < last; i++)
            count[bin_of(s, i)]++;
    }
}

static void scatter_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const sort *s = context;
    for (size_t block = begin; block < end; block++) {
        size_t *start = s->start + (block << s->bits);
        for (size_t i = block * s->block, last = block_end(s, block); i < last; i++) {
            size_t at = start[bin_of(s, i)]++;
            s->to.key[at] = s->from.key[i], s->to.id[at] = s->from.id[i];
        }
    }
}

static void bin_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const sort *s = context;
    for (size_t k = begin; k < end; k++)
        sort_bin(items_at(s->to, s->bin[k]), items_at(s->from, s->bin[k]), s->bin[k + 1] - s->bin[k], true);
}

tc_status tc_sort_keys(uint64_t *key, uint32_t *id, size_t n, int threads, tc_error *err)
{
    tc_status status = TC_OK;
    const size_t n_block = n < ALONE ? 1 : (size_t)tc_threads(threads), n_bin = (size_t)1 << TOP_BITS;
    items copy = {tc_alloc(n, sizeof *copy.key), tc_alloc(n, sizeof *copy.id)};
    uint64_t *differ = tc_calloc(n_block, sizeof *differ);
    size_t *start = tc_calloc(n_block, n_bin * sizeof *start), *bin = tc_alloc(n_bin + 1, sizeof *bin);
    if (!copy.key || !copy.id || !differ || !start || !bin) {
        status = tc_fail_memory(err, "sorting cells", n, sizeof *key + sizeof *id);
        goto done;
    }
    sort s = {.from = {key, id}, .to = copy, .n = n, .differ = differ, .start = start, .bin = bin};
    if (n < ALONE) {
        sort_bin(s.from, s.to, n, false);
        goto done;
    }
    s.block = (n - 1) / n_block + 1;
    tc_parallel_for(n_block, 1, threads, differ_range, &s);
    uint64_t all = 0;
    for (size_t b = 0; b < n_block; b++)
        all |= differ[b];
    const int top = width_of(all);
    s.bits = top < TOP_BITS ? top : TOP_BITS;
    s.shift = top - s.bits;
    tc_parallel_for(n_block, 1, threads, count_range, &s);
    size_t sum = 0;
    for (size_t k = 0; k < (size_t)1 << s.bits; k++) {
        bin[k] = sum;
        for (size_t b = 0; b < n_block; b++) {
            size_t count = start[(b << s.bits) + k];
            start[(b << s.bits) + k] = sum;
            sum += count;
        }
    }
    bin[(size_t)1 << s.bits] = sum;
    tc_parallel_for(n_block, 1, threads, scatter_range, &s);
    tc_parallel_for((size_t)1 << s.bits, 1, threads, bin_range, &s);
done:
    free(copy.key);
    free(copy.id);
    free(differ);
    free(start);
    free(bin);
    return status;
}
