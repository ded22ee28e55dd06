/* test_gpu_gradient.c: packed gradients against closed forms, and against what defines them. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/vec.h"
#include "gpu/pack.h"
#include "gpu/pack_gradient.h"
#include "mesh_shapes.h"
#include "transfer_make.h"

#include <float.h>

/* Of a prepared mesh, in packed units. */
static float *pack(const tc_mesh *mesh, tc_gradient kind, int threads)
{
    float *out = NULL;
    tc_error err = {0};
    tc_pack p;
    if (tc_pack_build(&p, mesh, 1, &err) != TC_OK)
        fail_msg("%s", err.text);
    const tc_pack_units units = {p.scale, p.scalar_lo, p.scalar_hi};
    if (tc_pack_gradient(&out, mesh, kind, &units, threads, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_pack_finish(&p);
    return out;
}

/* Of a gradient in the mesh's own units. */
static void must_be(const float *packed, const tc_mesh *mesh, const double *gradient, double tolerance, size_t at)
{
    tc_pack p;
    assert_int_equal(tc_pack_build(&p, mesh, 1, NULL), TC_OK);
    const double factor = 1 / (p.scale * (p.scalar_hi - p.scalar_lo));
    tc_pack_finish(&p);
    double expected[3], error[3], got[3];
    for (int k = 0; k < 3; k++) {
        expected[k] = gradient[k] * factor;
        got[k] = packed[k];
        error[k] = got[k] - expected[k];
    }
    const double length = tc_vec_length(expected);
    if (!(tc_vec_length(error) <= tolerance * length) || !(fabs(packed[3] - length) <= tolerance * length))
        fail_msg("at %zu: %g %g %g, long %g, not %g %g %g, long %g", at, got[0], got[1], got[2], packed[3], expected[0],
                 expected[1], expected[2], length);
}

static double wavy(const double *x)
{
    return sin(2 * x[0]) + x[1] * x[2] - 0.3 * x[1] * x[1] + 0.1 * x[2];
}

/* A lattice whose inner points are shaken, without some of its cubes: gaps, folds, cells with few neighbours. */
static bool keep_most(int i, int j, int k)
{
    return (i * 7 + j * 5 + k * 3) % 11 != 4;
}

static tc_mesh *shaken(int n, tc_association association, bool with_missing)
{
    const int size[3] = {n, n, n};
    uint64_t seed = 17;
    shape s = {0};
    shape_grid(&s, size, keep_most);
    for (size_t i = 0; i < 3 * s.n_vertex; i++)
        s.vertex[i] += 0.2 * (random01(&seed) - 0.5);
    const size_t n_value = association == TC_CELL_DATA ? s.n_tet : s.n_vertex;
    double *value = malloc(n_value * sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < n_value; i++) {
        double x[3] = {0, 0, 0};
        for (int c = 0; c < 4; c++)
            for (int k = 0; k < 3; k++)
                x[k] += 0.25 * (association == TC_CELL_DATA ? s.vertex[3 * s.tet[4 * i + (size_t)c] + k]
                                                            : s.vertex[3 * i + (size_t)k]);
        value[i] = with_missing && random01(&seed) < 0.05 ? NAN : wavy(x);
    }
    tc_mesh *mesh = shape_mesh(&s, value, association);
    shape_prepare(mesh, TC_REENTRY_PEEL);
    free(value);
    shape_finish(&s);
    return mesh;
}

/* ------------------------------------------------------------------------------------------ what defines them */

static void edges_of(double e[3][3], const tc_mesh *m, size_t cell)
{
    const int32_t *tet = m->tet + 4 * cell;
    for (int i = 0; i < 3; i++)
        tc_vec_sub(e[i], m->vertex + 3 * (size_t)tet[i + 1], m->vertex + 3 * (size_t)tet[0]);
}

static bool known(const tc_mesh *m, size_t cell)
{
    if (m->association == TC_CELL_DATA)
        return isfinite(m->scalar[cell]);
    for (int k = 0; k < 4; k++)
        if (!isfinite(m->scalar[m->tet[4 * cell + (size_t)k]]))
            return false;
    return true;
}

static void centroid(double out[3], const tc_mesh *m, size_t cell)
{
    for (int k = 0; k < 3; k++) {
        out[k] = 0;
        for (int c = 0; c < 4; c++)
            out[k] += 0.25 * m->vertex[3 * (size_t)m->tet[4 * cell + (size_t)c] + (size_t)k];
    }
}

/* A gradient in the mesh's units: from the packed one of a cell. */
static void unpack(double out[3], const float *packed, const tc_mesh *mesh)
{
    tc_pack p;
    assert_int_equal(tc_pack_build(&p, mesh, 1, NULL), TC_OK);
    for (int k = 0; k < 3; k++)
        out[k] = packed[k] * (p.scale * (p.scalar_hi - p.scalar_lo));
    tc_pack_finish(&p);
}

static void a_cell_is_not_the_plane_through_its_values(void **state)
{
    (void)state;
    tc_mesh *m = shaken(5, TC_POINT_DATA, true);
    float *cell = pack(m, TC_GRADIENT_CELL, 0);
    size_t missing = 0;
    for (size_t i = 0; i < m->n_tet; i++) {
        double g[3], e[3][3];
        const int32_t *tet = m->tet + 4 * i;
        if (!known(m, i)) {
            for (int k = 0; k < 4; k++)
                assert_true(cell[4 * i + (size_t)k] == 0);
            missing++;
            continue;
        }
        unpack(g, cell + 4 * i, m);
        edges_of(e, m, i);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(tc_vec_dot(g, e[k]) - (m->scalar[tet[k + 1]] - m->scalar[tet[0]])) <
                        1e-6 * (1 + fabs(g[k])));
    }
    assert_true(missing > 0 && missing == m->report.nonfinite_cells);
    free(cell);
    tc_mesh_destroy(&m);
}

/* The normal equations of the fit hold, and the gradient has nothing across the directions that its centroids span. */
static void cell_data_do_not_have_the_best_plane(void **state)
{
    (void)state;
    tc_mesh *m = shaken(5, TC_CELL_DATA, true);
    float *cell = pack(m, TC_GRADIENT_CELL, 0);
    size_t open = 0, alone = 0;
    for (size_t i = 0; i < m->n_tet; i++) {
        double g[3], x[5][3], s[5], middle[3] = {0, 0, 0}, mean = 0, rest[3] = {0, 0, 0}, span[3][3];
        int n = 0, rank = 0;
        unpack(g, cell + 4 * i, m);
        for (int f = -1; f < 4 && known(m, i); f++) {
            const int32_t of = f < 0 ? (int32_t)i : m->neighbour[4 * i + (size_t)f];
            if (of < 0 || !known(m, (size_t)of))
                continue;
            centroid(x[n], m, (size_t)of);
            s[n++] = m->scalar[of];
        }
        for (int k = 0; k < n; k++) {
            tc_vec_mul_add(middle, middle, 1.0 / n, x[k]);
            mean += s[k] / n;
        }
        double across[3] = {g[0], g[1], g[2]};
        for (int k = 0; k < n; k++) {
            double d[3];
            tc_vec_sub(d, x[k], middle);
            tc_vec_mul_add(rest, rest, tc_vec_dot(d, g) - (s[k] - mean), d);
            for (int r = 0; r < rank; r++)
                tc_vec_mul_add(d, d, -tc_vec_dot(d, span[r]), span[r]);
            if (rank < 3 && tc_vec_length(d) > 1e-9) {
                tc_vec_normalize(d);
                tc_vec_copy(span[rank++], d);
                tc_vec_mul_add(across, across, -tc_vec_dot(across, d), d);
            }
        }
        open += rank < 3 && rank > 0;
        alone += rank == 0;
        if (tc_vec_length(rest) > 1e-6 || tc_vec_length(across) > 1e-6 * tc_vec_length(g))
            fail_msg("cell %zu of %d values in %d directions: %g off, %g across", i, n, rank, tc_vec_length(rest),
                     tc_vec_length(across));
    }
    assert_true(open > 0 && alone >= m->report.nonfinite_cells);
    free(cell);
    tc_mesh_destroy(&m);
}

static void check_means(tc_association association)
{
    tc_mesh *m = shaken(30, association, true); /* several spans of vertices */
    assert_true(m->n_vertex > 20000);
    float *cell = pack(m, TC_GRADIENT_CELL, 1), *vertex = pack(m, TC_GRADIENT_VERTEX, 1);
    double(*sum)[4] = calloc(m->n_vertex, sizeof *sum);
    assert_non_null(sum);
    for (size_t i = 0; i < m->n_tet; i++) {
        const double volume = shape_volume6(m, m->tet + 4 * i);
        for (int k = 0; k < 4 && known(m, i); k++) {
            double *at = sum[m->tet[4 * i + (size_t)k]];
            for (int c = 0; c < 3; c++)
                at[c] += volume * cell[4 * i + (size_t)c];
            at[3] += volume;
        }
    }
    for (size_t v = 0; v < m->n_vertex; v++) {
        const float *g = vertex + 4 * v;
        double expected[3] = {0, 0, 0}, error = 0;
        for (int c = 0; c < 3; c++) {
            expected[c] = sum[v][3] > 0 ? sum[v][c] / sum[v][3] : 0;
            error = fmax(error, fabs(g[c] - expected[c]));
        }
        if (!(error < 1e-5) || !(fabs(tc_vec_length(expected) - g[3]) < 1e-5))
            fail_msg("vertex %zu is off by %g", v, error);
    }
    for (int threads = 2; threads < 6; threads += 3)
        for (int kind = TC_GRADIENT_CELL; kind <= TC_GRADIENT_VERTEX; kind++) {
            float *again = pack(m, (tc_gradient)kind, threads);
            assert_memory_equal(again, kind == TC_GRADIENT_CELL ? cell : vertex,
                                (kind == TC_GRADIENT_CELL ? m->n_tet : m->n_vertex) * 4 * sizeof *again);
            free(again);
        }
    free(sum);
    free(cell);
    free(vertex);
    tc_mesh_destroy(&m);
}

static void a_vertex_is_not_the_mean_around_it(void **state)
{
    (void)state;
    check_means(TC_POINT_DATA);
    check_means(TC_CELL_DATA);
}

/* Imaginary cells are no neighbours, and points of theirs alone have no gradient. */
static void what_fills_gaps_counts(void **state)
{
    (void)state;
    for (int association = TC_POINT_DATA; association <= TC_CELL_DATA; association++) {
        tc_mesh *m = shaken(3, (tc_association)association, false);
        float *cell[2], *vertex[2];
        cell[0] = pack(m, TC_GRADIENT_CELL, 0), vertex[0] = pack(m, TC_GRADIENT_VERTEX, 0);
        const size_t n = m->n_vertex;
        /* one imaginary cell at a boundary face, with a point of its own, far within the bounds */
        size_t open = 0;
        while (m->neighbour[open] >= 0)
            open++;
        const size_t all = m->n_tet + 1;
        m->vertex = realloc(m->vertex, 3 * (n + 1) * sizeof *m->vertex);
        m->tet = realloc(m->tet, 4 * all * sizeof *m->tet);
        m->neighbour = realloc(m->neighbour, 4 * all * sizeof *m->neighbour);
        if (association == TC_POINT_DATA) {
            m->scalar = realloc(m->scalar, (n + 1) * sizeof *m->scalar);
            m->scalar[n] = 0;
        }
        for (int k = 0; k < 3; k++)
            m->vertex[3 * n + (size_t)k] = 1;
        for (int k = 0; k < 4; k++) {
            m->tet[4 * m->n_tet + (size_t)k] = k == 0 ? (int32_t)n : m->tet[4 * (open / 4) + (open + (size_t)k) % 4];
            m->neighbour[4 * m->n_tet + (size_t)k] = k == 0 ? (int32_t)(open / 4) : -1;
        }
        m->neighbour[open] = (int32_t)m->n_tet;
        m->n_imaginary = 1, m->n_vertex++, m->report.n_steiner = 1;
        cell[1] = pack(m, TC_GRADIENT_CELL, 0), vertex[1] = pack(m, TC_GRADIENT_VERTEX, 0);
        assert_memory_equal(cell[0], cell[1], m->n_tet * 4 * sizeof(float));
        assert_memory_equal(vertex[0], vertex[1], n * 4 * sizeof(float));
        for (size_t k = 0; k < 4; k++)
            assert_true(vertex[1][4 * n + k] == 0);
        for (int i = 0; i < 2; i++) {
            free(cell[i]);
            free(vertex[i]);
        }
        tc_mesh_destroy(&m);
    }
}

/* ----------------------------------------------------------------------------------------------- closed forms */

static double linear(const double *x)
{
    return 2 * x[0] - 3 * x[1] + 5 * x[2];
}

static const double slope[3] = {2, -3, 5};

static tc_mesh *one_tet(const double vertex[4][3], const double value[4])
{
    static const int32_t tet[4] = {0, 1, 2, 3};
    const tc_mesh_arrays arrays = {4, &vertex[0][0], 1, tet, value, TC_POINT_DATA, NULL};
    tc_mesh *mesh;
    assert_int_equal(tc_mesh_create(&mesh, &arrays, NULL), TC_OK);
    shape_prepare(mesh, TC_REENTRY_PEEL);
    return mesh;
}

/* Corners are whole numbers of 45 bits, all but in one plane: all that is given is exact, and so can the answer be. */
static void a_thin_tet_has_the_slope_of_rounding(void **state)
{
    (void)state;
    uint64_t seed = 9;
    for (int turn = 0; turn < 300; turn++) {
        double vertex[4][3], value[4];
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++)
                vertex[i][k] = floor(0x1p45 * (random01(&seed) - 0.5));
            vertex[3][k] = vertex[0][k] + vertex[1][k] - vertex[2][k];
            vertex[3][k] += turn % 3 > 0 ? floor(7 * random01(&seed)) - 3 : 0; /* or in it */
        }
        for (int i = 0; i < 4; i++)
            value[i] = linear(vertex[i]);
        tc_mesh *m = one_tet(vertex, value);
        float *cell = pack(m, TC_GRADIENT_CELL, 1), *at = pack(m, TC_GRADIENT_VERTEX, 1);
        if (m->report.zero_volume == 0) {
            must_be(cell, m, slope, 3e-7, 0);
            for (size_t i = 0; i < 4; i++)
                must_be(at + 4 * i, m, slope, 3e-7, i);
        } else {
            assert_true(cell[3] == 0 && at[3] == 0);
        }
        free(cell);
        free(at);
        tc_mesh_destroy(&m);
    }
}

static void units_change_the_slope(void **state)
{
    (void)state;
    static const double size[] = {1, 1e-160, 1e150, 1e308, 1e-300}, high[] = {1, 1.5e307, 1e-300};
    for (size_t u = 0; u < sizeof size / sizeof *size; u++)
        for (size_t h = 0; h < sizeof high / sizeof *high; h++) {
            static const double corner[4][3] = {{-1, -1, -1}, {1, -0.9, -1}, {-0.9, 1, -1}, {0.1, 0.2, 1}};
            double vertex[4][3], value[4], g[3];
            for (int i = 0; i < 4; i++) {
                for (int k = 0; k < 3; k++)
                    vertex[i][k] = corner[i][k] * size[u];
                value[i] = high[h] * linear(corner[i]);
            }
            tc_mesh *m = one_tet(vertex, value);
            /* packed: half a diagonal of the box is one, and so is the values' range */
            const double range = linear(corner[3]) - linear(corner[2]), half = sqrt(3);
            for (int kind = TC_GRADIENT_CELL; kind <= TC_GRADIENT_VERTEX; kind++) {
                float *got = pack(m, (tc_gradient)kind, 1);
                for (int k = 0; k < 3; k++) {
                    g[k] = slope[k] * half / range;
                    if (!(fabs(got[k] - g[k]) < 1e-6))
                        fail_msg("size %g, values %g: %g, not %g", size[u], high[h], (double)got[k], g[k]);
                }
                assert_true(fabs(got[3] - tc_vec_length(g)) < 1e-6);
                free(got);
            }
            tc_mesh_destroy(&m);
        }
}

/* A tet on a flat one, and values of points or cells. */
static void a_flat_tet_counts_among_others(void **state)
{
    (void)state;
    static const double vertex[5][3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {3, 3, 0}};
    static const int32_t tet[2][4] = {{0, 1, 2, 3}, {1, 2, 0, 4}};
    const double at_point[5] = {0, 8, -12, 20, 77}, at_cell[2] = {1, 4};
    tc_mesh_arrays arrays = {5, &vertex[0][0], 2, &tet[0][0], at_point, TC_POINT_DATA, NULL};
    tc_mesh *m;
    assert_int_equal(tc_mesh_create(&m, &arrays, NULL), TC_OK);
    assert_int_equal(shape_prepare(m, TC_REENTRY_PEEL).zero_volume, 1);
    const size_t flat = (size_t)m->tet_of_source[1], other = 1 - flat, tip = (size_t)m->vertex_of_source[4];
    float *cell = pack(m, TC_GRADIENT_CELL, 1), *at = pack(m, TC_GRADIENT_VERTEX, 1);
    must_be(cell + 4 * other, m, slope, 1e-6, other);
    assert_true(cell[4 * flat + 3] == 0);
    for (size_t v = 0; v < 5; v++)
        if (v != tip)
            must_be(at + 4 * v, m, slope, 1e-6, v);
    assert_true(at[4 * tip + 3] == 0);
    free(cell);
    free(at);
    tc_mesh_destroy(&m);

    arrays.scalar = at_cell, arrays.association = TC_CELL_DATA;
    assert_int_equal(tc_mesh_create(&m, &arrays, NULL), TC_OK);
    shape_prepare(m, TC_REENTRY_PEEL);
    assert_int_equal(m->neighbour[4 * flat] + m->neighbour[4 * flat + 1] + m->neighbour[4 * flat + 2] +
                         m->neighbour[4 * flat + 3],
                     (int)other - 3); /* they are linked */
    double from[3], to[3], g[3];
    centroid(from, m, other);
    centroid(to, m, flat);
    tc_vec_sub(g, to, from); /* the least gradient that makes up for 3 on this way */
    const double square = tc_vec_dot(g, g);
    for (int k = 0; k < 3; k++)
        g[k] *= 3 / square;
    cell = pack(m, TC_GRADIENT_CELL, 1), at = pack(m, TC_GRADIENT_VERTEX, 1);
    for (size_t i = 0; i < 2; i++)
        must_be(cell + 4 * i, m, g, 1e-6, i);
    for (size_t v = 0; v < 5; v++) /* also at the tip, around which there is no volume */
        must_be(at + 4 * v, m, g, 1e-6, v);
    free(cell);
    free(at);
    tc_mesh_destroy(&m);
}

/* Of two flat tets alone at a point, of different slopes, it is the plain mean. */
static void flat_tets_alone_are_no_mean(void **state)
{
    (void)state;
    static const double vertex[6][3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {3, 3, 0}, {9, 5, 0}, {1, 1, 4}};
    static const int32_t tet[3][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}, {0, 1, 2, 5}};
    const double value[3] = {1, 5, 2};
    const tc_mesh_arrays arrays = {6, &vertex[0][0], 3, &tet[0][0], value, TC_CELL_DATA, NULL};
    tc_mesh *m;
    assert_int_equal(tc_mesh_create(&m, &arrays, NULL), TC_OK);
    assert_int_equal(shape_prepare(m, TC_REENTRY_PEEL).zero_volume, 2);
    float *cell = pack(m, TC_GRADIENT_CELL, 1), *at = pack(m, TC_GRADIENT_VERTEX, 1);
    const float *a = cell + 4 * m->tet_of_source[0], *b = cell + 4 * m->tet_of_source[1];
    const float *got = at + 4 * m->vertex_of_source[3], *full = cell + 4 * m->tet_of_source[2];
    assert_true(fabsf(a[0] - b[0]) > 0.1F && fabsf(a[0] - full[0]) > 0.1F);
    for (int v = 0; v < 3; v++) /* where there is a volume, too, it alone counts */
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(at[4 * m->vertex_of_source[v] + k] - full[k]) < 1e-6F);
    for (int k = 0; k < 3; k++)
        assert_true(fabsf(got[k] - (a[k] + b[k]) / 2) < 1e-6F);
    free(cell);
    free(at);
    tc_mesh_destroy(&m);
}

static void a_slope_is_too_long_for_a_float(void **state)
{
    (void)state;
    static const double vertex[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-30}};
    static const double value[4] = {0, 0, 0, 1}, equal[4] = {3, 3, 3, 3};
    tc_mesh *m = one_tet(vertex, value);
    for (int kind = TC_GRADIENT_CELL; kind <= TC_GRADIENT_VERTEX; kind++) {
        float *g = pack(m, (tc_gradient)kind, 1);
        assert_true(g[0] == 0 && g[1] == 0 && fabs(g[2] / 1e18 - 1) < 1e-6 && fabs(g[3] / 1e18 - 1) < 1e-6);
        free(g);
    }
    tc_mesh_destroy(&m);
    m = one_tet(vertex, equal);
    float *g = pack(m, TC_GRADIENT_CELL, 1);
    for (int k = 0; k < 4; k++)
        assert_true(g[k] == 0);
    free(g);
    tc_mesh_destroy(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cell_is_not_the_plane_through_its_values),
        cmocka_unit_test(cell_data_do_not_have_the_best_plane),
        cmocka_unit_test(a_vertex_is_not_the_mean_around_it),
        cmocka_unit_test(what_fills_gaps_counts),
        cmocka_unit_test(a_thin_tet_has_the_slope_of_rounding),
        cmocka_unit_test(units_change_the_slope),
        cmocka_unit_test(a_flat_tet_counts_among_others),
        cmocka_unit_test(flat_tets_alone_are_no_mean),
        cmocka_unit_test(a_slope_is_too_long_for_a_float),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
