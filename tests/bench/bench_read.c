/* bench_read: what memory gives this machine: bytes a second that its threads read from an array far larger than the
 * caches, in order, and 16-byte records a second at random places. JSON on stdout.
 * Usage: bench_read [THREADS] [MEBIBYTES] */
#define _POSIX_C_SOURCE 200809L
#include "bench_scene.h"

#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { THREADS_MOST = 256, RUNS = 5 };

typedef struct part {
    const uint64_t *data; /* [n] */
    size_t from, to, n, places;
    uint64_t sum;
} part;

static void *in_order(void *argument)
{
    part *p = argument;
    uint64_t a = 0, b = 0, c = 0, d = 0;
    for (size_t i = p->from; i + 4 <= p->to; i += 4) {
        a += p->data[i];
        b += p->data[i + 1];
        c += p->data[i + 2];
        d += p->data[i + 3];
    }
    p->sum = a + b + c + d;
    return NULL;
}

static void *at_random(void *argument)
{
    part *p = argument;
    uint64_t sum = 0, state = p->from + 1;
    for (size_t i = 0; i < p->places; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u; /* Knuth */
        size_t at = (size_t)(((state >> 32) * (uint64_t)(p->n / 2)) >> 32) * 2;
        sum += p->data[at] + p->data[at + 1];
    }
    p->sum = sum;
    return NULL;
}

/* Seconds of the fastest of a few runs. */
static double fastest(void *(*body)(void *), part *parts, int threads)
{
    double best = -1;
    for (int run = 0; run < RUNS; run++) {
        pthread_t id[THREADS_MOST];
        double start = bench_now_ms();
        for (int t = 0; t < threads; t++)
            if (pthread_create(&id[t], NULL, body, &parts[t]) != 0) {
                fprintf(stderr, "bench_read: no thread can be started\n");
                exit(1);
            }
        for (int t = 0; t < threads; t++)
            pthread_join(id[t], NULL);
        double s = 1e-3 * (bench_now_ms() - start);
        best = best < 0 || s < best ? s : best;
    }
    return best;
}

int main(int argc, char **argv)
{
    int threads = argc > 1 ? atoi(argv[1]) : 2, mebibytes = argc > 2 ? atoi(argv[2]) : 512;
    if (threads < 1 || threads > THREADS_MOST || mebibytes < 1) {
        fprintf(stderr, "usage: bench_read [THREADS] [MEBIBYTES]\n");
        return 2;
    }
    size_t n = (size_t)mebibytes * (1u << 20) / sizeof(uint64_t), places = n / 16 + 1;
    uint64_t *data = malloc(n * sizeof *data);
    if (!data) {
        fprintf(stderr, "bench_read: no %d MiB of memory\n", mebibytes);
        return 1;
    }
    for (size_t i = 0; i < n; i++)
        data[i] = i;
    part parts[THREADS_MOST];
    for (int t = 0; t < threads; t++)
        parts[t] = (part){.data = data,
                          .from = n / (size_t)threads * (size_t)t,
                          .to = n / (size_t)threads * (size_t)(t + 1),
                          .n = n,
                          .places = places};
    double bytes = (double)n * sizeof *data / fastest(in_order, parts, threads);
    double records = (double)places * threads / fastest(at_random, parts, threads);
    uint64_t sum = 0;
    for (int t = 0; t < threads; t++)
        sum += parts[t].sum;
    json_t *out = json_object();
    json_object_set_new(out, "threads", json_integer(threads));
    json_object_set_new(out, "mebibytes", json_integer(mebibytes));
    bench_set(out, "bytes_per_second", bytes);
    bench_set(out, "records_per_second", records);
    json_object_set_new(out, "sum", json_integer((json_int_t)(sum & 0xff))); /* so that it is read */
    int code = json_dumpf(out, stdout, JSON_INDENT(1)) == 0 && fflush(stdout) == 0 ? 0 : 1;
    json_decref(out);
    free(data);
    return code;
}
