/* parallel.c: loops over all cores, and a clock. */
#define _GNU_SOURCE
#include "core/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <time.h>

enum { MAX_THREADS = 256 };

typedef struct job {
    atomic_size_t next;
    size_t n, chunk;
    tc_range_function *body;
    void *context;
} job;

typedef struct worker {
    job *job;
    int index;
    pthread_t thread;
} worker;

int tc_threads(int request)
{
    int n = request;
    if (n <= 0) {
        cpu_set_t set;
        n = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    }
    return n < 1 ? 1 : n > MAX_THREADS ? MAX_THREADS : n;
}

static void *run(void *argument)
{
    worker *w = argument;
    job *j = w->job;
    for (;;) {
        size_t begin = atomic_fetch_add(&j->next, j->chunk);
        if (begin >= j->n)
            return NULL;
        size_t end = j->n - begin < j->chunk ? j->n : begin + j->chunk;
        j->body(j->context, begin, end, w->index);
    }
}

void tc_parallel_for(size_t n, size_t chunk, int threads, tc_range_function *body, void *context)
{
    if (n == 0)
        return;
    if (chunk == 0)
        chunk = 1;
    int count = tc_threads(threads);
    size_t chunks = (n - 1) / chunk + 1;
    if ((size_t)count > chunks)
        count = (int)chunks;
    job j = {.n = n, .chunk = chunk, .body = body, .context = context};
    atomic_init(&j.next, 0);
    worker workers[MAX_THREADS];
    int started = 1;
    for (; started < count; started++) {
        workers[started] = (worker){.job = &j, .index = started};
        if (pthread_create(&workers[started].thread, NULL, run, &workers[started]) != 0)
            break;
    }
    workers[0] = (worker){.job = &j, .index = 0};
    run(&workers[0]);
    for (int i = 1; i < started; i++)
        pthread_join(workers[i].thread, NULL);
}

double tc_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}
