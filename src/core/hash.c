/* hash.c: 128 bits that tell contents apart: eight lanes of a multiply and rotate round, the one of XXH64 (Y. Collet),
 * each a bijection of the word that comes in, so that one changed word always changes its lane. */
#define _GNU_SOURCE
#include "core/hash.h"
#include "core/memory.h"
#include "core/parallel.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LANES = 8, STRIPE = 8 * LANES, BLOCK = 1 << 16, CHUNK = 16 };

static const uint64_t P1 = 0x9e3779b185ebca87u, P2 = 0xc2b2ae3d27d4eb4fu, P3 = 0x165667b19e3779f9u;

static uint64_t turn(uint64_t x, int n)
{
    return x << n | x >> (64 - n);
}

static uint64_t stir(uint64_t lane, uint64_t word)
{
    return turn(lane + word * P2, 31) * P1;
}

static void add_stripe(uint64_t lane[LANES], const unsigned char *p)
{
    for (int i = 0; i < LANES; i++) {
        uint64_t word;
        memcpy(&word, p + 8 * i, sizeof word);
        lane[i] = stir(lane[i], word);
    }
}

/* murmur3's finalizer (Appleby). */
static uint64_t finish(uint64_t h)
{
    h = (h ^ h >> 33) * 0xff51afd7ed558ccdu;
    h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53u;
    return h ^ h >> 33;
}

tc_hash tc_hash_bytes(const void *data, size_t n, uint64_t seed)
{
    const unsigned char *p = data;
    unsigned char last[STRIPE] = {0};
    uint64_t lane[LANES];
    for (int i = 0; i < LANES; i++)
        lane[i] = seed + P3 * (uint64_t)(i + 1);
    size_t left = n;
    for (; left >= STRIPE; left -= STRIPE, p += STRIPE)
        add_stripe(lane, p);
    if (left > 0) {
        memcpy(last, p, left);
        add_stripe(lane, last);
    }
    tc_hash out = {{(uint64_t)n + P1, (uint64_t)n + P2}};
    for (int i = 0; i < LANES; i++) {
        out.word[0] = stir(out.word[0], lane[i]);
        out.word[1] = stir(out.word[1], lane[LANES - 1 - i] ^ P3);
    }
    out.word[0] = finish(out.word[0]);
    out.word[1] = finish(out.word[1]);
    return out;
}

/* --------------------------------------------------------------------------------------------------- in blocks */

typedef struct blocks {
    tc_hash *hash;             /* [blocks] */
    const unsigned char *data; /* NULL: from fd */
    unsigned char *into;
    int fd;
    uint64_t offset;
    size_t n;
    atomic_int failed; /* errno; -1: the file ended */
} blocks;

static int read_all(int fd, unsigned char *to, size_t n, uint64_t offset)
{
    while (n > 0) {
        ssize_t got = pread(fd, to, n, (off_t)offset);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return got < 0 ? errno : -1;
        to += got, offset += (uint64_t)got, n -= (size_t)got;
    }
    return 0;
}

static void hash_blocks(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    blocks *b = context;
    unsigned char own[BLOCK];
    for (size_t i = begin; i < end && atomic_load(&b->failed) == 0; i++) {
        size_t at = i * BLOCK, length = b->n - at < BLOCK ? b->n - at : BLOCK;
        const unsigned char *from = b->data ? b->data + at : NULL;
        if (!from) {
            unsigned char *to = b->into ? b->into + at : own;
            int failed = read_all(b->fd, to, length, b->offset + at);
            if (failed) {
                atomic_store(&b->failed, failed);
                return;
            }
            from = to;
        }
        b->hash[i] = tc_hash_bytes(from, length, i);
    }
}

static tc_status hash_all(tc_hash *out, blocks *b, int threads, tc_error *err)
{
    size_t n = b->n / BLOCK + (b->n % BLOCK != 0);
    b->hash = tc_alloc(n, sizeof *b->hash);
    if (!b->hash)
        return tc_fail_memory(err, "a hash", n, sizeof *b->hash);
    atomic_init(&b->failed, 0);
    tc_parallel_for(n, CHUNK, threads, hash_blocks, b);
    if (atomic_load(&b->failed) == 0)
        *out = tc_hash_bytes(b->hash, n * sizeof *b->hash, b->n);
    free(b->hash);
    return TC_OK;
}

tc_status tc_hash_array(tc_hash *out, const void *data, size_t n, int threads, tc_error *err)
{
    blocks b = {.data = n ? data : "", .fd = -1, .n = n};
    return hash_all(out, &b, threads, err);
}

tc_status tc_hash_read(tc_hash *out, void *into, int fd, uint64_t offset, size_t n, int threads, const char *name,
                       tc_error *err)
{
    blocks b = {.into = into, .fd = fd, .offset = offset, .n = n};
    tc_status status = hash_all(out, &b, threads, err);
    int failed = status == TC_OK ? atomic_load(&b.failed) : 0;
    if (failed)
        return tc_fail(err, TC_E_FILE, "%s cannot be read: %s", name,
                       failed > 0 ? strerror(failed) : "it is cut short");
    return status;
}

tc_status tc_hash_file(tc_hash *out, uint64_t *bytes, const char *path, int threads, tc_error *err)
{
    struct stat info = {0};
    const char *why = NULL;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0 || fstat(fd, &info) != 0)
        why = strerror(errno);
    else if (!S_ISREG(info.st_mode))
        why = "it is no regular file";
    if (why) {
        tc_fail(err, TC_E_FILE, "%s cannot be read: %s", path, why);
        if (fd >= 0)
            close(fd);
        return TC_E_FILE;
    }
    *bytes = (uint64_t)info.st_size;
    tc_status status = tc_hash_read(out, NULL, fd, 0, (size_t)info.st_size, threads, path, err);
    close(fd);
    return status;
}
