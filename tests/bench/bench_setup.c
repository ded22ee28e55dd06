/* bench_setup: each part of setting up a mesh once, and the pre-integration tables once, on one thread: what counts.sh counts
 * instructions of.
 * Usage: bench_setup [NAME [CELLS]]. Prints the tets and entries that the counts are divided by, and milliseconds. */
#include "gpu/pack.h"
#include "transfer_functions/drift.h"

#include <stdio.h>
#include <stdlib.h>

static void give_up(const tc_error *err)
{
    fprintf(stderr, "bench_setup: %s\n", err->text);
    exit(1);
}

int main(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "kuhn";
    const size_t n_cells = argc > 2 ? strtoull(argv[2], NULL, 10) : 100000;
    const tc_prepare_options prepare = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    tc_error err = {0};
    tc_mesh *mesh = NULL;
    tc_pack pack, values;
    if (tc_synth_create(&mesh, name, n_cells, 0, &err) != TC_OK || tc_mesh_prepare(mesh, &prepare, NULL, &err) != TC_OK ||
        tc_pack_build(&pack, mesh, 1, &err) != TC_OK || tc_pack_scalars(&values, mesh, 1, &err) != TC_OK)
        give_up(&err);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    printf("tets %zu\n", report.n_tet);
    printf("ms check %.1f order %.1f adjacency %.1f pack %.1f values %.1f\n", report.ms_check, report.ms_order,
           report.ms_adjacency, pack.ms, values.ms);
    tc_pack_finish(&pack);
    tc_pack_finish(&values);
    tc_mesh_destroy(&mesh);

    static const tc_knot knot[] = {
        {0, 0.23, 0.3, 0.75, 0}, {0.5, 0.87, 0.87, 0.87, 0.15}, {1, 0.71, 0.02, 0.15, 0.3}};
    tc_table_options options = {
        .size = {128, 128, 256}, .span = {0, 1}, .length_max = 5, .format = TC_TABLE_8, .threads = 1};
    tc_transfer *tf = NULL;
    tc_table table, drift;
    if (tc_transfer_from_knots(&tf, knot, 3, &err) != TC_OK || tc_table_build(&table, tf, &options, &err) != TC_OK)
        give_up(&err);
    options.format = TC_TABLE_16F;
    if (tc_drift_build(&drift, tf, &options, &err) != TC_OK)
        give_up(&err);
    printf("entries %d\n", 128 * 128 * 256);
    printf("ms table %.1f drift %.1f\n", table.ms, drift.ms);
    tc_table_finish(&table);
    tc_table_finish(&drift);
    tc_transfer_destroy(&tf);
    return 0;
}
