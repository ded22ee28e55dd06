/* bench_counters.c: Linux' performance counters, where a process may count itself. */
#define _GNU_SOURCE /* syscall */
#include "bench_counters.h"

#include <linux/perf_event.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static int open_counter(uint64_t config)
{
    struct perf_event_attr attr;
    memset(&attr, 0, sizeof attr);
    attr.size = sizeof attr;
    attr.type = PERF_TYPE_HARDWARE;
    attr.config = config;
    attr.inherit = 1; /* threads that come later are counted, too */
    attr.exclude_kernel = 1;
    attr.exclude_hv = 1;
    return (int)syscall(SYS_perf_event_open, &attr, 0, -1, -1, 0);
}

bool bench_counters_open(bench_counters *out)
{
    out->instructions = open_counter(PERF_COUNT_HW_INSTRUCTIONS);
    out->cycles = open_counter(PERF_COUNT_HW_CPU_CYCLES);
    return out->instructions >= 0 && out->cycles >= 0;
}

void bench_counters_close(bench_counters *counters)
{
    if (counters->instructions >= 0)
        close(counters->instructions);
    if (counters->cycles >= 0)
        close(counters->cycles);
    counters->instructions = counters->cycles = -1;
}

static double read_counter(int descriptor)
{
    uint64_t value = 0;
    return descriptor >= 0 && read(descriptor, &value, sizeof value) == (ssize_t)sizeof value ? (double)value : NAN;
}

void bench_counters_read(const bench_counters *counters, double *instructions, double *cycles)
{
    *instructions = read_counter(counters->instructions);
    *cycles = read_counter(counters->cycles);
}
