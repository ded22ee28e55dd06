/* bench_counters.h: instructions and cycles of this process and of the threads it starts, in user space. */
#ifndef TC_BENCH_COUNTERS_H
#define TC_BENCH_COUNTERS_H

#include <stdbool.h>

typedef struct bench_counters {
    int instructions, cycles; /* file descriptors, -1: not to be had */
} bench_counters;

/* Before the threads are started that are to be counted. False where the machine or its settings refuse. */
bool bench_counters_open(bench_counters *out);
void bench_counters_close(bench_counters *counters);
/* Counts so far, NaN where they are not to be had. Differences of two readings are counts of what was between. */
void bench_counters_read(const bench_counters *counters, double *instructions, double *cycles);

#endif
