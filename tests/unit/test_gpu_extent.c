/* How large cells are by the scalars they hold (tc_pack_extent), against cell by cell and bin by bin. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "datasets_synthetic/synth.h"
#include "gpu/pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The definition, in doubles but for the scalars. */
static void measure(tc_pack_extent *out, const tc_pack *pack, const tc_mesh *mesh)
{
    double weight = 0;
    memset(out, 0, sizeof *out);
    for (size_t t = 0; t < pack->n_real; t++) {
        double square = 0, lo = INFINITY, hi = -INFINITY;
        bool known = true;
        for (int i = 0; i < 4; i++) {
            const float *p = pack->vertex + 4 * (size_t)mesh->tet[4 * t + (size_t)i];
            double s = (double)(pack->cell_scalar ? pack->cell_scalar[t] : p[3]);
            known = known && !isnan(s);
            lo = fmin(lo, s);
            hi = fmax(hi, s);
            for (int j = 0; j < i; j++) {
                const float *q = pack->vertex + 4 * (size_t)mesh->tet[4 * t + (size_t)j];
                double d2 = 0;
                for (int k = 0; k < 3; k++)
                    d2 += ((double)p[k] - (double)q[k]) * ((double)p[k] - (double)q[k]);
                square = fmax(square, d2);
            }
        }
        if (!known)
            continue;
        weight += square;
        for (int b = 0; b < TC_PACK_BINS; b++) {
            double from = fmax(lo * TC_PACK_BINS, b), to = fmin(hi * TC_PACK_BINS, b + 1);
            bool last = b == TC_PACK_BINS - 1 && lo >= 1; /* the end belongs to the last bin */
            if (!last && (lo * TC_PACK_BINS >= b + 1 || hi * TC_PACK_BINS < b))
                continue;
            out->edge[b] = fmaxf(out->edge[b], (float)sqrt(square));
            out->edge_range[b] = fmaxf(out->edge_range[b], (float)(sqrt(square) * (hi - lo)));
            out->held[b] += square * fmax(to - from, 0);
        }
    }
    for (int b = 0; b < TC_PACK_BINS && weight > 0; b++)
        out->held[b] /= weight;
}

static void must_be_near(double is, double should, const char *what, int kind, int bin)
{
    if (!(fabs(is - should) <= 2e-6 * fabs(should) + 1e-12))
        fail_msg("values %d: %s of bin %d is %.9g instead of %.9g", kind, what, bin, is, should);
}

/* Values that change much or little within cells, at the ends of the range, on the edges of bins, or are not finite. */
static double value_of(int kind, size_t i, size_t n)
{
    double noise = (double)(i * 2654435761u % 1000003) / 1000002, smooth = (double)i / (double)n;
    switch (kind) {
    case 0:
        return noise;
    case 1:
        return smooth;
    case 2:
        return i % 5 ? noise : NAN;
    case 3:
        return i % 11 ? floor(64 * smooth) / 64 : 1;
    case 4:
        return i == 7 ? 1 : 0;
    case 5:
        return pow(noise, 8);
    default:
        return i % 3 ? 0.25 : 1;
    }
}

static void a_bin_is_not_what_its_cells_say(void **state)
{
    (void)state;
    static const char *const name[] = {"kuhn", "heatsink"};
    for (int kind = 0; kind < 14; kind++) {
        tc_mesh *mesh = NULL;
        tc_error err = {0};
        tc_association association = kind % 2 ? TC_CELL_DATA : TC_POINT_DATA;
        assert_int_equal(tc_synth_create(&mesh, name[kind % 3 == 0], 4000, 1, &err), TC_OK);
        size_t n = association == TC_CELL_DATA ? mesh->n_tet : mesh->n_vertex;
        double *value = malloc(n * sizeof *value);
        assert_non_null(value);
        for (size_t i = 0; i < n; i++)
            value[i] = value_of(kind / 2, i, n);
        assert_int_equal(tc_mesh_set_scalar(mesh, value, association, &err), TC_OK);
        free(value);
        assert_int_equal(tc_mesh_prepare(mesh, &(tc_prepare_options){.reentry = TC_REENTRY_PEEL}, NULL, &err), TC_OK);
        tc_pack pack;
        tc_pack_extent should;
        assert_int_equal(tc_pack_scalars(&pack, mesh, 2, &err), TC_OK);
        measure(&should, &pack, mesh);
        for (int b = 0; b < TC_PACK_BINS; b++) {
            must_be_near((double)pack.extent.edge[b], (double)should.edge[b], "edge", kind, b);
            must_be_near((double)pack.extent.edge_range[b], (double)should.edge_range[b], "edge_range", kind, b);
            must_be_near(pack.extent.held[b], should.held[b], "held", kind, b);
        }
        tc_pack_finish(&pack);
        tc_mesh_destroy(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_bin_is_not_what_its_cells_say)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
