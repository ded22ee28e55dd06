/* test_read_cells.c: every kind of cell becomes tets that fill it and meet its neighbours. */
#define _GNU_SOURCE

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "read_files.h"

#include <math.h>

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not %.17g", a, b);
}

/* ------------------------------------------------------------------------------------------ single cells */

static void prism(grid *g, int n, double height)
{
    for (int level = 0; level < 2; level++)
        for (int i = 0; i < n; i++)
            add_point(g, cos(2 * M_PI * i / n), sin(2 * M_PI * i / n), level * height);
}

static void check_single(int type, int n, double volume, size_t boundary, const double (*x)[3])
{
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        static grid g;
        memset(&g, 0, sizeof g);
        int id[16];
        for (int i = 0; i < n; i++)
            id[i] = add_point(&g, x[i][0], x[i][1], mirrored ? -x[i][2] : x[i][2]);
        add_cell(&g, type, n, id);
        tc_mesh *m = read_grid(&g, NULL);
        assert_near(mesh_volume(m), volume, 1e-13);
        assert_int_equal(m->source->n_cell, 1);
        assert_int_equal(m->report.source_cells, 1);
        tc_mesh_report r = prepared(m);
        assert_int_equal(r.n_boundary_face, boundary);
        assert_int_equal(r.unlinked_faces, 0);
        assert_int_equal(r.n_component, 1);
        tc_mesh_destroy(&m);
    }
}

static void test_single_cells_are_not_filled(void **state)
{
    (void)state;
    static const double tet[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const double pyramid[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.3, .4, 1}};
    static const double wedge[][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
    static const double hex[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const double voxel[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    check_single(10, 4, 1. / 6, 4, tet);
    check_single(14, 5, 1. / 3, 6, pyramid);
    check_single(13, 6, 1. / 2, 8, wedge);
    check_single(12, 8, 1, 12, hex);
    check_single(11, 8, 1, 12, voxel);
    static grid g;
    memset(&g, 0, sizeof g);
    prism(&g, 5, 2);
    check_single(15, 10, 5 * sin(2 * M_PI / 5), 16, (const double(*)[3])g.point);
    memset(&g, 0, sizeof g);
    prism(&g, 6, 2);
    check_single(16, 12, 6 * sin(2 * M_PI / 6), 20, (const double(*)[3])g.point);
    check_single(41, 8, 1, 12, hex);
}

static void test_collapsed_hexahedra_keep_repeated_vertices(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    static const int id[8] = {0, 1, 2, 2, 3, 4, 5, 5};
    for (int level = 0; level < 2; level++) {
        add_point(&g, 0, 0, level);
        add_point(&g, 1, 0, level);
        add_point(&g, 0, 1, level);
    }
    add_cell(&g, 12, 8, id);
    tc_mesh *m = read_grid(&g, NULL);
    assert_near(mesh_volume(m), 0.5, 1e-15);
    for (size_t t = 0; t < m->n_tet; t++)
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < a; b++)
                assert_int_not_equal(m->tet[4 * t + (size_t)a], m->tet[4 * t + (size_t)b]);
    assert_int_equal(prepared(m).unlinked_faces, 0);
    tc_mesh_destroy(&m);
}

static void test_flat_cells_are_rendered(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 5; i++)
        add_point(&g, i == 1, i == 2, i == 3 ? 1 : i == 4 ? 7 : 0);
    add_cell(&g, 10, 4, (int[]){0, 1, 2, 3});
    add_cell(&g, 5, 3, (int[]){0, 1, 2});
    add_cell(&g, 3, 2, (int[]){0, 4});
    add_cell(&g, 1, 1, (int[]){4});
    tc_mesh *m = read_grid(&g, NULL);
    assert_int_equal(m->n_tet, 1);
    assert_int_equal(m->n_vertex, 4);
    assert_int_equal(m->source->dropped_cells, 3);
    assert_int_equal(m->source->n_cell_type, 4);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(m->source->cell_type[i].dimension, i == 0 ? 0 : i == 1 ? 1 : i == 2 ? 2 : 3);
    tc_mesh_destroy(&m);
}

/* ------------------------------------------------------------------------------------------ neighbours */

static unsigned random_next(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

enum { N = 4 };

/* A lattice of N^3 jittered cubes; each is a hexahedron, a voxel, a polyhedron, six pyramids, or two wedges. Point
 * numbers are shuffled. seam: points at x = N/2 are there twice, one set for each side. */
static void mixed_lattice(grid *g, unsigned seed, bool seam)
{
    memset(g, 0, sizeof *g);
    const int side = N + 1, n = side * side * side;
    static int number[2 * (N + 1) * (N + 1) * (N + 1)];
    const int total = seam ? n + side * side : n;
    for (int i = 0; i < total; i++)
        number[i] = i;
    for (int i = total - 1; i > 0; i--) {
        const int k = (int)(random_next(&seed) % (unsigned)(i + 1)), t = number[i];
        number[i] = number[k];
        number[k] = t;
    }
    g->n_point = total;
    for (int i = 0; i < n; i++) {
        const int at[3] = {i % side, i / side % side, i / side / side};
        double x[3];
        for (int k = 0; k < 3; k++) {
            const bool border = at[k] == 0 || at[k] == N || (k == 0 && at[0] == N / 2);
            x[k] = at[k] + (border ? 0 : 0.2 * ((double)(random_next(&seed) % 1000) / 1000 - 0.5));
        }
        memcpy(g->point[number[i]], x, sizeof x);
        if (seam && at[0] == N / 2)
            memcpy(g->point[number[n + at[1] + side * at[2]]], x, sizeof x);
    }
    for (int c = 0; c < N * N * N; c++) {
        const int at[3] = {c % N, c / N % N, c / N / N};
        int v[8];
        for (int k = 0; k < 8; k++) {
            const int i = at[0] + (k & 1), j = at[1] + (k >> 1 & 1), l = at[2] + (k >> 2);
            const bool twin = seam && i == N / 2 && at[0] >= N / 2;
            v[k] = number[twin ? n + j + side * l : i + side * (j + side * l)];
        }
        const int hex[8] = {v[0], v[1], v[3], v[2], v[4], v[5], v[7], v[6]};
        static const int face[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                       {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
        /* A column of wedges has the same cut all the way up. */
        if ((at[0] * 5 + at[1] * 3) % 4 == 1) {
            add_cell(g, 13, 6, (int[]){hex[0], hex[1], hex[2], hex[4], hex[5], hex[6]});
            add_cell(g, 13, 6, (int[]){hex[0], hex[2], hex[3], hex[4], hex[6], hex[7]});
            continue;
        }
        int stream[64] = {6}, length = 1;
        double centre[3] = {0, 0, 0};
        switch (random_next(&seed) % 4) {
        case 0:
            add_cell(g, 12, 8, hex);
            break;
        case 1:
            add_cell(g, 11, 8, v);
            break;
        case 2:
            for (int f = 0; f < 6; f++) {
                stream[length++] = 4;
                const int start = (int)(random_next(&seed) % 4), step = random_next(&seed) % 2 ? 1 : 3;
                for (int k = 0; k < 4; k++)
                    stream[length++] = hex[face[f][(start + step * k) % 4]];
            }
            add_polyhedron(g, stream);
            break;
        default:
            for (int k = 0; k < 8; k++)
                for (int d = 0; d < 3; d++)
                    centre[d] += g->point[v[k]][d] / 8;
            const int top = add_point(g, centre[0], centre[1], centre[2]);
            for (int f = 0; f < 6; f++)
                add_cell(g, 14, 5, (int[]){hex[face[f][0]], hex[face[f][3]], hex[face[f][2]], hex[face[f][1]], top});
        }
    }
}

static void test_mixed_neighbours_cut_faces_differently(void **state)
{
    (void)state;
    static grid g;
    for (unsigned seed = 1; seed <= 6; seed++) {
        const bool seam = seed % 2;
        mixed_lattice(&g, seed, seam);
        tc_mesh *m = read_grid(&g, NULL);
        assert_near(mesh_volume(m), N * N * N, 1e-10);
        const tc_mesh_report r = prepared(m);
        assert_int_equal(r.n_boundary_face, 12 * N * N);
        assert_int_equal(r.unlinked_faces, 0);
        assert_int_equal(r.n_component, 1);
        assert_int_equal(r.merged_vertices, seam ? (N + 1) * (N + 1) : 0);
        tc_mesh_destroy(&m);
    }
}

static void test_regular_hexahedra_get_six_tets(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    const int side = 6;
    for (int i = 0; i < side * side * side; i++)
        add_point(&g, i % side, i / side % side, i / side / side);
    for (int k = 0; k < side - 1; k++)
        for (int j = 0; j < side - 1; j++)
            for (int i = 0; i < side - 1; i++) {
                const int o = i + side * (j + side * k), u = side * side;
                add_cell(&g, 12, 8,
                         (int[]){o, o + 1, o + side + 1, o + side, o + u, o + u + 1, o + u + side + 1, o + u + side});
            }
    tc_mesh *m = read_grid(&g, NULL);
    assert_int_equal(m->n_tet, 5 * 125);
    assert_near(mesh_volume(m), 125, 1e-10);
    assert_int_equal(prepared(m).n_boundary_face, 12 * 25);
    tc_mesh_destroy(&m);
}

/* ------------------------------------------------------------------------------------------ polyhedra */

/* A prism over an outline of n points (counter-clockwise), from z to z + 1; lower and upper are the numbers. */
static void outline_prism(grid *g, int n, const int *lower, const int *upper, bool turned)
{
    int stream[512] = {n + 2}, length = 1;
    stream[length++] = n;
    for (int i = 0; i < n; i++)
        stream[length++] = lower[turned ? i : n - 1 - i];
    stream[length++] = n;
    for (int i = 0; i < n; i++)
        stream[length++] = upper[(i + 2) % n];
    for (int i = 0; i < n; i++) {
        const int k = (i + 1) % n;
        stream[length++] = 4;
        stream[length++] = lower[i];
        stream[length++] = lower[k];
        stream[length++] = upper[k];
        stream[length++] = upper[i];
    }
    add_polyhedron(g, stream);
}

static void check_prisms(const double (*outline)[2], int n, double area)
{
    for (unsigned seed = 1; seed <= 2; seed++) {
        static grid g;
        memset(&g, 0, sizeof g);
        int at[64][3];
        int order[192];
        unsigned s = seed;
        for (int i = 0; i < 3 * n; i++)
            order[i] = i;
        for (int i = 3 * n - 1; i > 0; i--) {
            const int k = (int)(random_next(&s) % (unsigned)(i + 1)), t = order[i];
            order[i] = order[k];
            order[k] = t;
        }
        g.n_point = 3 * n;
        for (int i = 0; i < 3 * n; i++) {
            const double x[3] = {outline[i % n][0], outline[i % n][1], i / n};
            memcpy(g.point[order[i]], x, sizeof x);
            at[i % n][i / n] = order[i];
        }
        int level[3][64];
        for (int l = 0; l < 3; l++)
            for (int i = 0; i < n; i++)
                level[l][i] = at[i][l];
        outline_prism(&g, n, level[0], level[1], false);
        outline_prism(&g, n, level[1], level[2], true);
        tc_mesh *m = read_grid(&g, NULL);
        assert_near(mesh_volume(m), 2 * area, 1e-12 * area);
        assert_int_equal(m->source->dropped_cells, 0);
        const tc_mesh_report r = prepared(m);
        assert_int_equal(r.n_boundary_face, 2 * (n - 2) + 4 * n);
        assert_int_equal(r.unlinked_faces, 0);
        tc_mesh_destroy(&m);
    }
}

static void test_polyhedra_that_are_not_convex_are_filled_wrong(void **state)
{
    (void)state;
    static const double dart[][2] = {{0, 0}, {2, 0}, {0.6, 0.6}, {0, 2}};
    static const double ell[][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double you[][2] = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double comb[][2] = {{0, 0}, {5, 0}, {5, 2}, {4, 2}, {4, 1}, {3, 1},
                                     {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    static const double spiral[][2] = {{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2},
                                       {3, 3}, {2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}};
    check_prisms(dart, 4, 1.2);
    check_prisms(ell, 6, 5);
    check_prisms(you, 8, 7);
    check_prisms(comb, 12, 8);
    check_prisms(spiral, 12, 15);
}

static void test_schoenhardt_polyhedron_is_refused(void **state)
{
    (void)state;
    /* Schoenhardt 1928: a twisted prism that has no filling without a point inside. */
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 3; i++)
        add_point(&g, cos(2 * M_PI * i / 3), sin(2 * M_PI * i / 3), 0);
    for (int i = 0; i < 3; i++)
        add_point(&g, cos(2 * M_PI * i / 3 + M_PI / 6), sin(2 * M_PI * i / 3 + M_PI / 6), 1);
    /* Each side quad i, i+1, i+4, i+3 is folded inwards along i -> i+4. */
    int stream[64] = {8, 3, 2, 1, 0, 3, 3, 4, 5}, length = 9;
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3;
        const int t[8] = {3, i, k, k + 3, 3, i, k + 3, i + 3};
        memcpy(stream + length, t, sizeof t);
        length += 8;
    }
    add_polyhedron(&g, stream);
    double closed = 0;
    for (int f = 0, at = 1; f < 8; f++, at += 4) {
        const double *a = g.point[stream[at + 1]], *b = g.point[stream[at + 2]], *c = g.point[stream[at + 3]];
        closed += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) /
                  6;
    }
    tc_mesh *m = read_grid(&g, NULL);
    assert_near(mesh_volume(m), fabs(closed), 1e-14);
    assert_int_equal(m->n_tet, 8);
    assert_int_equal(m->n_vertex, 7);
    assert_true(has_note(m, "inside"));
    assert_int_equal(prepared(m).n_boundary_face, 8);
    tc_mesh_destroy(&m);
}

static void test_points_inside_lose_linear_data(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    char values[1024] = "<DataArray type=\"Float64\" Name=\"f\" format=\"ascii\">";
    for (int i = 0; i < 6; i++) {
        const double angle = 2 * M_PI * (i % 3) / 3 + (i / 3) * M_PI / 6;
        add_point(&g, 2 + cos(angle), sin(angle), i / 3);
        const double *x = g.point[i];
        snprintf(values + strlen(values), sizeof values - strlen(values), "%.17g ", 3 + x[0] - 2 * x[1] + 5 * x[2]);
    }
    strcat(values, "</DataArray>");
    int stream[64] = {8, 3, 2, 1, 0, 3, 3, 4, 5}, length = 9;
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3;
        const int t[8] = {3, i, k, k + 3, 3, i, k + 3, i + 3};
        memcpy(stream + length, t, sizeof t);
        length += 8;
    }
    add_polyhedron(&g, stream);
    const char *path = scratch("inside.vtu");
    write_vtu(path, &g, values, "");
    tc_mesh *m = read_path(path, NULL);
    unlink(path);
    assert_int_equal(m->n_vertex, 7);
    for (size_t i = 0; i < m->n_vertex; i++) {
        const double *x = m->vertex + 3 * i;
        assert_near(m->scalar[i], 3 + x[0] - 2 * x[1] + 5 * x[2], 1e-12);
    }
    tc_mesh_destroy(&m);
}

static void test_open_polyhedra_are_not_counted(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 8; i++)
        add_point(&g, i & 1, i >> 1 & 1, i >> 2);
    add_polyhedron(&g, (int[]){3, 3, 0, 1, 2, 3, 0, 1, 4, 3, 0, 2, 4}); /* a tet without its fourth face */
    add_cell(&g, 10, 4, (int[]){0, 1, 2, 4});
    tc_mesh *m = read_grid(&g, NULL);
    assert_int_equal(m->n_tet, 1);
    assert_int_equal(m->source->dropped_cells, 1);
    assert_true(has_note(m, "not closed"));
    tc_mesh_destroy(&m);
}

static void test_repairs_of_the_reader_are_not_reported(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 8; i++)
        add_point(&g, i & 1, i >> 1 & 1, i >> 2);
    add_point(&g, 5, 5, 5);                   /* of no cell */
    add_point(&g, 6, 6, 6);                   /* of a triangle: left out, but no defect */
    add_cell(&g, 10, 4, (int[]){0, 1, 2, 4}); /* sound */
    add_cell(&g, 10, 4, (int[]){1, 2, 3, 7}); /* turned */
    add_cell(&g, 10, 4, (int[]){4, 5, 5, 7}); /* repeats a point */
    add_cell(&g, 10, 4, (int[]){4, 6, 6, 6}); /* repeats a point */
    add_cell(&g, 5, 3, (int[]){0, 1, 9});
    add_cell(&g, 12, 8, (int[]){0, 1, 1, 0, 2, 3, 3, 2}); /* a hexahedron collapsed to a face */
    tc_mesh *m = read_grid(&g, NULL);
    assert_int_equal(m->n_tet, 2);
    assert_int_equal(m->report.dropped_degenerate, 0); /* before tc_mesh_prepare */
    assert_true(isnan(m->report.ms_convexify));
    tc_mesh_report r = prepared(m);
    assert_int_equal(r.n_tet, 2);
    assert_int_equal(r.dropped_degenerate, 3);
    assert_int_equal(r.reoriented, 1);
    assert_int_equal(r.unused_vertices, 1);
    assert_int_equal(r.merged_vertices, 0);
    assert_true(r.ms_check >= 0);
    assert_true(isnan(r.ms_convexify)); /* peeling: nothing was filled */
    /* Another way over the gaps does not count them again. */
    tc_error err = {0};
    assert_int_equal(tc_mesh_prepare(m, &(tc_prepare_options){.reentry = TC_REENTRY_AUTO, .threads = 1}, NULL, &err),
                     TC_OK);
    assert_int_equal(m->report.dropped_degenerate, 3);
    assert_int_equal(m->report.reoriented, 1);
    tc_mesh_destroy(&m);
}

/* ------------------------------------------------------------------------------------------ curved cells */

/* The ten nodes of a quadratic tet; bulge moves the middles of its edges outwards. */
static void quadratic_tet(grid *g, double bulge, char *values, size_t capacity)
{
    static const double corner[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    memset(g, 0, sizeof *g);
    for (int i = 0; i < 4; i++)
        add_point(g, corner[i][0], corner[i][1], corner[i][2]);
    for (int e = 0; e < 6; e++) {
        double x[3];
        for (int k = 0; k < 3; k++) {
            x[k] = (corner[edge[e][0]][k] + corner[edge[e][1]][k]) / 2;
            x[k] += bulge * (x[k] - 0.5);
        }
        add_point(g, x[0], x[1], x[2]);
    }
    add_cell(g, 24, 10, (int[]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    snprintf(values, capacity, "<DataArray type=\"Float64\" Name=\"f\" format=\"ascii\">");
    for (int i = 0; i < 10; i++) {
        const double *x = g->point[i];
        snprintf(values + strlen(values), capacity - strlen(values), "%.17g ", x[0] * x[0] - x[1] * x[2] + 3);
    }
    snprintf(values + strlen(values), capacity - strlen(values), "</DataArray>");
}

static void test_refinement_loses_quadratic_data(void **state)
{
    (void)state;
    static grid g;
    char values[1024];
    quadratic_tet(&g, 0, values, sizeof values);
    const char *path = scratch("quadratic.vtu");
    write_vtu(path, &g, values, "");
    for (int level = 0; level <= 3; level++) {
        const tc_read_options options = {.refine = level};
        tc_mesh *m = read_path(path, &options);
        assert_int_equal(m->n_tet, 1 << (3 * level));
        assert_true(m->source->linearised);
        assert_int_equal(m->source->refine, level);
        assert_near(mesh_volume(m), 8. / 6, 1e-13);
        for (size_t i = 0; i < m->n_vertex; i++) {
            const double *x = m->vertex + 3 * i;
            assert_near(m->scalar[i], x[0] * x[0] - x[1] * x[2] + 3, 1e-12);
        }
        assert_int_equal(prepared(m).n_boundary_face, 4 << (2 * level));
        tc_mesh_destroy(&m);
    }
    unlink(path);
}

static void test_refinement_does_not_follow_the_curve(void **state)
{
    (void)state;
    static grid g;
    char values[1024];
    quadratic_tet(&g, 0.3, values, sizeof values);
    const char *path = scratch("bulge.vtu");
    write_vtu(path, &g, values, "");
    double volume[5];
    for (int level = 0; level < 5; level++) {
        const tc_read_options options = {.refine = level};
        tc_mesh *m = read_path(path, &options);
        volume[level] = mesh_volume(m);
        tc_mesh_destroy(&m);
    }
    unlink(path);
    /* Straight pieces of a smooth surface: the error falls by 4 a level. */
    for (int level = 1; level < 4; level++) {
        const double ratio = (volume[level] - volume[level - 1]) / (volume[level + 1] - volume[level]);
        assert_true(ratio > 3.3 && ratio < 4.7);
    }
}

/* Straight-sided cells of higher order: refined they must fill the same volume, with a boundary of four times the
 * faces. */
static void test_orders_and_shapes_have_other_parameters(void **state)
{
    (void)state;
    static const double tet[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    static const double hex[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const double wedge[6][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
    static const double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5, .5, 1}};
    /* Further nodes: means of corners. */
    static const char *const tet_nodes[] = {"01", "12", "02", "03", "13", "23"};
    static const char *const hex_nodes[] = {"01", "12", "23",   "03",   "45",   "56",   "67",   "47",   "04",      "15",
                                            "26", "37", "0347", "1256", "0145", "2367", "0123", "4567", "01234567"};
    static const char *const wedge_nodes[] = {"01", "12", "02", "34",   "45",   "35",
                                              "03", "14", "25", "0134", "1245", "0235"};
    static const char *const pyramid_nodes[] = {"01", "12",   "23",  "03",  "04",  "14",  "24",
                                                "34", "0123", "014", "124", "234", "034", ""};
    static const struct {
        int type, n_corner, n_more;
        const double (*corner)[3];
        const char *const *more;
        double volume;
        size_t boundary;
    } cells[] = {
        {24, 4, 6, tet, tet_nodes, 8. / 6, 4},
        {71, 4, 6, tet, tet_nodes, 8. / 6, 4},
        {78, 4, 6, tet, tet_nodes, 8. / 6, 4},
        {25, 8, 12, hex, hex_nodes, 1, 12},
        {29, 8, 19, hex, hex_nodes, 1, 12},
        {33, 8, 16, hex, hex_nodes, 1, 12},
        {72, 8, 19, hex, hex_nodes, 1, 12},
        {79, 8, 19, hex, hex_nodes, 1, 12},
        {26, 6, 9, wedge, wedge_nodes, .5, 8},
        {31, 6, 6, wedge, wedge_nodes, .5, 8},
        {32, 6, 12, wedge, wedge_nodes, .5, 8},
        {73, 6, 12, wedge, wedge_nodes, .5, 8},
        {80, 6, 12, wedge, wedge_nodes, .5, 8},
        {27, 5, 8, pyramid, pyramid_nodes, 1. / 3, 6},
        {37, 5, 14, pyramid, pyramid_nodes, 1. / 3, 6},
    };
    for (size_t c = 0; c < sizeof cells / sizeof *cells; c++) {
        static grid g;
        memset(&g, 0, sizeof g);
        int id[32];
        for (int i = 0; i < cells[c].n_corner; i++)
            id[i] = add_point(&g, cells[c].corner[i][0], cells[c].corner[i][1], cells[c].corner[i][2]);
        for (int i = 0; i < cells[c].n_more; i++) {
            double x[3] = {.5, .5, .25}; /* the middle of the pyramid */
            const char *of = cells[c].more[i];
            for (int k = 0; of[0] && k < 3; k++) {
                x[k] = 0;
                for (const char *p = of; *p; p++)
                    x[k] += cells[c].corner[*p - '0'][k] / (double)strlen(of);
            }
            id[cells[c].n_corner + i] = add_point(&g, x[0], x[1], x[2]);
        }
        add_cell(&g, cells[c].type, cells[c].n_corner + cells[c].n_more, id);
        for (int level = 0; level < 2; level++) {
            const tc_read_options options = {.refine = 2 * level};
            tc_mesh *m = read_grid(&g, &options);
            assert_true(m->source->linearised);
            assert_near(mesh_volume(m), cells[c].volume, 1e-12);
            const tc_mesh_report r = prepared(m);
            assert_int_equal(r.n_boundary_face, cells[c].boundary << (4 * level));
            assert_int_equal(r.unlinked_faces, 0);
            tc_mesh_destroy(&m);
        }
    }
}

static void test_refine_on_straight_cells_is_silent(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 4; i++)
        add_point(&g, i == 1, i == 2, i == 3);
    add_cell(&g, 10, 4, (int[]){0, 1, 2, 3});
    const tc_read_options options = {.refine = 2};
    tc_mesh *m = read_grid(&g, &options);
    assert_int_equal(m->n_tet, 1);
    assert_int_equal(m->source->refine, 0);
    assert_true(has_note(m, "no cell is curved"));
    tc_mesh_destroy(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_single_cells_are_not_filled),
        cmocka_unit_test(test_collapsed_hexahedra_keep_repeated_vertices),
        cmocka_unit_test(test_flat_cells_are_rendered),
        cmocka_unit_test(test_mixed_neighbours_cut_faces_differently),
        cmocka_unit_test(test_regular_hexahedra_get_six_tets),
        cmocka_unit_test(test_polyhedra_that_are_not_convex_are_filled_wrong),
        cmocka_unit_test(test_schoenhardt_polyhedron_is_refused),
        cmocka_unit_test(test_points_inside_lose_linear_data),
        cmocka_unit_test(test_open_polyhedra_are_not_counted),
        cmocka_unit_test(test_repairs_of_the_reader_are_not_reported),
        cmocka_unit_test(test_refinement_loses_quadratic_data),
        cmocka_unit_test(test_refinement_does_not_follow_the_curve),
        cmocka_unit_test(test_orders_and_shapes_have_other_parameters),
        cmocka_unit_test(test_refine_on_straight_cells_is_silent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
