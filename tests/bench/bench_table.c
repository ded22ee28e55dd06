/* bench_table: time of the pre-integration table, incremental against entry by entry: in 8 bits the paper's, in floats
 * that of the colour's drift.
 * Usage: bench_table [s_front s_back length]. Entry by entry takes k integrals of length dl for each entry of slice k
 * (the samples per dl that the incremental way has); it is timed on a few of the s_back rows and scaled by their
 * number. */
#include "core/parallel.h"
#include "transfer_functions/drift.h"

#include <stdio.h>
#include <stdlib.h>

static double best_of(const tc_transfer *tf, tc_table_options options, int runs)
{
    double best = -1;
    for (int i = 0; i < runs; i++) {
        tc_table table;
        tc_error err;
        tc_status status = options.format == TC_TABLE_8 ? tc_table_build(&table, tf, &options, &err)
                                                        : tc_drift_build(&table, tf, &options, &err);
        if (status != TC_OK) {
            fprintf(stderr, "bench_table: %s\n", err.text);
            exit(1);
        }
        best = best < 0 || table.ms < best ? table.ms : best;
        tc_table_finish(&table);
    }
    return best;
}

int main(int argc, char **argv)
{
    tc_table_options options = {.size = {128, 128, 256}, .span = {0, 1}, .length_max = 5};
    for (int i = 0; i < 3 && i + 1 < argc; i++)
        options.size[i] = atoi(argv[i + 1]);
    static const tc_knot smooth[] = {
        {0, 0.23, 0.3, 0.75, 0}, {0.5, 0.87, 0.87, 0.87, 0.15}, {1, 0.71, 0.02, 0.15, 0.3}};
    tc_knot many[33];
    for (int i = 0; i < 33; i++)
        many[i] =
            (tc_knot){i / 32.0, (i * 7 % 33) / 32.0, (i * 5 % 33) / 32.0, (i * 11 % 33) / 32.0, (i * 13 % 9) / 9.0};
    const struct {
        const char *name;
        const tc_knot *knot;
        size_t n;
    } function[2] = {{"3 knots", smooth, 3}, {"33 knots", many, 33}};
    static const tc_table_format format[3] = {TC_TABLE_8, TC_TABLE_16F, TC_TABLE_32F};
    printf("table %d x %d x %d, milliseconds, best of 5\n", options.size[0], options.size[1], options.size[2]);
    printf("%-10s %6s %10s %10s %16s %8s\n", "function", "bits", "1 thread", "2 threads", "entry by entry", "ratio");
    for (int f = 0; f < 2; f++) {
        tc_transfer *tf = NULL;
        tc_error err;
        if (tc_transfer_from_knots(&tf, function[f].knot, function[f].n, &err) != TC_OK) {
            fprintf(stderr, "bench_table: %s\n", err.text);
            return 1;
        }
        for (int b = 0; b < 3; b++) {
            options.format = format[b];
            options.threads = 1;
            const double one = best_of(tf, options, 5);
            options.threads = 2;
            const double two = best_of(tf, options, 5);
            tc_table_options slow = options;
            slow.threads = 1;
            slow.entry_by_entry = true;
            slow.size[1] = options.size[1] < 9 ? options.size[1] : 9; /* rows spread evenly over s_back */
            const double separate = best_of(tf, slow, 1) * options.size[1] / slow.size[1];
            printf("%-10s %6d %10.2f %10.2f %16.0f %8.0f\n", function[f].name, (int)format[b], one, two, separate,
                   separate / one);
        }
        tc_transfer_destroy(&tf);
    }
    return 0;
}
