/* test_mesh_prepare.c: creating, repairing and linking hand-made meshes, and giving them new values. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh_shapes.h"

static const double TURN = 6.283185307179586;

static shape one_tet(void)
{
    shape s = {0};
    for (int i = 0; i < 4; i++)
        shape_vertex(&s, i == 1, i == 2, i == 3);
    shape_tet(&s, 0, 1, 2, 3);
    return s;
}

static void end(tc_mesh **m, shape *s)
{
    tc_mesh_destroy(m);
    assert_null(*m);
    shape_finish(s);
}

static size_t open_faces(const tc_mesh *m)
{
    size_t n = 0;
    for (size_t i = 0; i < 4 * m->n_tet; i++)
        n += m->neighbour[i] < 0;
    return n;
}

static void a_single_tet_has_four_boundary_faces(void **state)
{
    (void)state;
    shape s = one_tet();
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_AUTO);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, 1);
    assert_int_equal(r.n_boundary_face, 4);
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.reoriented, 0);
    assert_true(r.convex);
    assert_int_equal(r.reentry, TC_REENTRY_CONVEXIFY);
    assert_int_equal(r.n_imaginary, 0);
    assert_true(fabs(r.volume - 1.0 / 6) < 1e-15);
    assert_true(fabs(r.longest_edge - sqrt(2)) < 1e-15);
    end(&m, &s);
}

static void two_tets_on_a_face_are_linked_across_it_only(void **state)
{
    (void)state;
    shape s = one_tet();
    shape_vertex(&s, 1, 1, 1);
    shape_tet(&s, 1, 2, 3, 4);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(open_faces(m), 6);
    assert_int_equal(r.n_boundary_face, 6);
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.reentry, TC_REENTRY_PEEL);
    assert_string_equal(r.reentry_why, "");
    end(&m, &s);
}

static void a_kuhn_grid_is_linked_whole(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {7, 5, 6};
    shape_grid(&s, n, NULL);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, 6 * 7 * 5 * 6);
    assert_int_equal(r.n_vertex, 8 * 6 * 7);
    assert_int_equal(r.n_boundary_face, 4 * (7 * 5 + 5 * 6 + 6 * 7));
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.reoriented, 3 * 7 * 5 * 6); /* odd axis orders make negative Kuhn tets */
    assert_int_equal(r.unlinked_faces, 0);
    assert_true(r.convex);
    assert_true(fabs(r.volume - 7 * 5 * 6) < 1e-10);
    assert_true(fabs(r.longest_edge - sqrt(3)) < 1e-14);
    for (size_t t = 0; t < m->n_tet; t++)
        assert_true(shape_volume6(m, m->tet + 4 * t) > 0);
    end(&m, &s);
}

static void the_result_does_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {14, 14, 14};
    shape_grid(&s, n, NULL);
    tc_mesh *a = shape_mesh(&s, NULL, TC_POINT_DATA), *b = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_prepare_options one = {.reentry = TC_REENTRY_PEEL, .threads = 1},
                       many = {.reentry = TC_REENTRY_PEEL, .threads = 7};
    assert_int_equal(tc_mesh_prepare(a, &one, NULL, NULL), TC_OK);
    assert_int_equal(tc_mesh_prepare(b, &many, NULL, NULL), TC_OK);
    assert_memory_equal(a->tet, b->tet, a->n_tet * 4 * sizeof *a->tet);
    assert_memory_equal(a->neighbour, b->neighbour, a->n_tet * 4 * sizeof *a->tet);
    assert_memory_equal(&a->report.volume, &b->report.volume, sizeof(double));
    tc_mesh_destroy(&b);
    end(&a, &s);
}

/* A grid whose cells have points of their own, where some cells are bad and some there twice. */
static shape loose_cells(void)
{
    shape grid = {0}, s = {0};
    const int n[3] = {15, 15, 15};
    shape_grid(&grid, n, NULL);
    for (size_t t = 0; t < grid.n_tet; t++) {
        const size_t from = t * 7919 % grid.n_tet; /* a permutation: points of one place are far apart */
        int32_t v[4];
        for (size_t i = 0; i < 4; i++) {
            const double *p = grid.vertex + 3 * (size_t)grid.tet[4 * from + i];
            v[i] = shape_vertex(&s, t % 11 == 3 && i == 2 ? (double)NAN : p[0], p[1], p[2]);
        }
        shape_tet(&s, v[0], v[1], v[2], t % 7 == 5 ? v[1] : v[3]);
        if (t % 13 == 1)
            shape_tet(&s, v[2], v[0], v[1], v[3]);
    }
    shape_finish(&grid);
    return s;
}

static void repairs_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    shape s = loose_cells();
    double *scalar = malloc(s.n_tet * sizeof *scalar);
    assert_non_null(scalar);
    for (size_t t = 0; t < s.n_tet; t++)
        scalar[t] = (double)t;
    tc_mesh *a = shape_mesh(&s, scalar, TC_CELL_DATA), *b = shape_mesh(&s, scalar, TC_CELL_DATA);
    tc_prepare_options one = {.reentry = TC_REENTRY_PEEL, .threads = 1},
                       many = {.reentry = TC_REENTRY_PEEL, .threads = 7};
    assert_int_equal(tc_mesh_prepare(a, &one, NULL, NULL), TC_OK);
    assert_int_equal(tc_mesh_prepare(b, &many, NULL, NULL), TC_OK);
    shape_check_promises(a);
    tc_mesh_report r = a->report, q = b->report;
    assert_true(r.n_tet > 16384 - 16384 / 4 && r.n_vertex <= 16 * 16 * 16);
    assert_true(r.dropped_degenerate > 1000 && r.dropped_nonfinite > 1000 && r.dropped_duplicate > 1000);
    assert_int_equal(r.n_tet + r.dropped_degenerate + r.dropped_nonfinite + r.dropped_duplicate, s.n_tet);
    assert_int_equal(r.n_vertex + r.merged_vertices + r.unused_vertices, s.n_vertex);
    assert_true(r.dropped_degenerate == q.dropped_degenerate && r.dropped_nonfinite == q.dropped_nonfinite &&
                r.dropped_duplicate == q.dropped_duplicate && r.merged_vertices == q.merged_vertices &&
                r.reoriented == q.reoriented && r.n_component == q.n_component && r.n_tet == q.n_tet &&
                r.n_vertex == q.n_vertex && r.n_boundary_face == q.n_boundary_face);
    assert_memory_equal(a->vertex, b->vertex, a->n_vertex * 3 * sizeof *a->vertex);
    assert_memory_equal(a->scalar, b->scalar, a->n_tet * sizeof *a->scalar);
    assert_memory_equal(a->tet, b->tet, a->n_tet * 4 * sizeof *a->tet);
    assert_memory_equal(a->neighbour, b->neighbour, a->n_tet * 4 * sizeof *a->tet);
    assert_memory_equal(a->vertex_of_source, b->vertex_of_source, s.n_vertex * sizeof *a->vertex_of_source);
    assert_memory_equal(a->tet_of_source, b->tet_of_source, s.n_tet * sizeof *a->tet_of_source);
    for (size_t t = 0; t < s.n_tet; t++)
        if (a->tet_of_source[t] >= 0)
            assert_true(a->scalar[a->tet_of_source[t]] == scalar[t]);
    free(scalar);
    tc_mesh_destroy(&b);
    end(&a, &s);
}

/* Of points that are merged the first gives its value, down to the sign of 0. */
static void another_than_the_first_point_of_a_place_is_kept(void **state)
{
    (void)state;
    shape s = loose_cells();
    double *scalar = malloc(s.n_vertex * sizeof *scalar);
    assert_non_null(scalar);
    for (size_t v = 0; v < s.n_vertex; v++)
        scalar[v] = v % 3 == 1 ? -0.0 : 0.0;
    for (int threads = 1; threads < 8; threads += 3) {
        tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
        const tc_prepare_options options = {.reentry = TC_REENTRY_PEEL, .threads = threads};
        assert_int_equal(tc_mesh_prepare(m, &options, NULL, NULL), TC_OK);
        bool *seen = calloc(m->n_vertex, sizeof *seen);
        assert_non_null(seen);
        size_t minus = 0;
        for (size_t v = 0; v < s.n_vertex; v++) {
            int32_t w = m->vertex_of_source[v];
            if (w < 0 || seen[w])
                continue;
            seen[w] = true;
            minus += v % 3 == 1;
            assert_int_equal(signbit(m->scalar[w]) != 0, v % 3 == 1);
        }
        assert_true(minus > 100 && minus < m->n_vertex - 100);
        free(seen);
        tc_mesh_destroy(&m);
    }
    free(scalar);
    shape_finish(&s);
}

static void a_mesh_too_large_for_memory_is_begun_or_spoilt(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {5, 5, 5};
    shape_grid(&s, n, NULL);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_error err = {0};
    const tc_prepare_options options = {.reentry = TC_REENTRY_PEEL};
    assert_int_equal(setenv("TETCAST_MEMORY", "40K", 1), 0);
    assert_int_equal(tc_mesh_prepare(m, &options, NULL, &err), TC_E_MEMORY);
    assert_non_null(strstr(err.text, "750 tetrahedra needs about"));
    assert_false(m->prepared);
    assert_int_equal(setenv("TETCAST_MEMORY", "80K", 1), 0);
    assert_int_equal(tc_mesh_prepare(m, &options, NULL, &err), TC_OK);
    unsetenv("TETCAST_MEMORY");
    shape_check_promises(m);
    end(&m, &s);
}

static void bad_cells_are_dropped_and_counted(void **state)
{
    (void)state;
    shape s = one_tet();
    int32_t nan = shape_vertex(&s, NAN, 0, 0), inf = shape_vertex(&s, 0, -INFINITY, 0),
            twin = shape_vertex(&s, 0, 0, 0);
    shape_vertex(&s, 5, 5, 5); /* no cell uses it */
    shape_tet(&s, 0, 1, 1, 3); /* repeats a vertex */
    shape_tet(&s, 0, 1, 2, nan);
    shape_tet(&s, inf, 1, 2, 3);
    shape_tet(&s, 0, twin, 2, 3); /* repeats one after merging */
    shape_tet(&s, 2, 1, 0, 3);    /* the first cell again, inverted */
    shape_tet(&s, twin, 3, 1, 2); /* and again, by its duplicated point */
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, 1);
    assert_int_equal(r.n_vertex, 4);
    assert_int_equal(r.dropped_degenerate, 2);
    assert_int_equal(r.dropped_nonfinite, 2);
    assert_int_equal(r.dropped_duplicate, 2);
    assert_int_equal(r.merged_vertices, 1);
    assert_int_equal(r.unused_vertices, 3);
    assert_int_equal(r.source_cells, 7);
    const int32_t tets[7] = {0, -1, -1, -1, -1, -1, -1}, vertices[4] = {nan, inf, twin + 1, -1};
    assert_memory_equal(m->tet_of_source, tets, sizeof tets);
    for (int i = 0; i < 3; i++)
        assert_int_equal(m->vertex_of_source[vertices[i]], -1);
    assert_int_equal(m->vertex_of_source[twin], m->vertex_of_source[0]);
    assert_true(r.bounds[1] == 1 && r.bounds[3] == 1 && r.bounds[5] == 1);
    end(&m, &s);
}

static void an_equal_cell_keeps_the_value_of_the_first(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {4, 4, 4};
    shape_grid(&s, n, NULL);
    size_t first = s.n_tet;
    for (size_t t = 0; t < first; t += 3) {
        int32_t v[4];
        memcpy(v, s.tet + 4 * t, sizeof v);
        shape_tet(&s, v[2], v[0], v[3], v[1]);
    }
    double *scalar = malloc(s.n_tet * sizeof *scalar);
    assert_non_null(scalar);
    for (size_t t = 0; t < s.n_tet; t++)
        scalar[t] = (double)t;
    tc_mesh *m = shape_mesh(&s, scalar, TC_CELL_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, first);
    assert_int_equal(r.dropped_duplicate, s.n_tet - first);
    assert_int_equal(r.unlinked_faces, 0);
    assert_true(r.convex);
    for (size_t t = 0; t < s.n_tet; t++)
        if (t < first)
            assert_true(m->scalar[m->tet_of_source[t]] == (double)t);
        else
            assert_int_equal(m->tet_of_source[t], -1);
    free(scalar);
    end(&m, &s);
}

/* Two cubes that share a side, each with points of its own there; -0 on one of them. */
static shape seam(void)
{
    shape s = {0};
    const int n[3] = {1, 1, 1};
    shape_grid(&s, n, NULL);
    shape t = {0};
    shape_grid(&t, n, NULL);
    for (size_t v = 0; v < t.n_vertex; v++) {
        const double *p = t.vertex + 3 * v;
        shape_vertex(&s, p[0] + 1, p[1] == 0 ? -0.0 : p[1], p[2]);
    }
    for (size_t i = 0; i < t.n_tet; i++)
        shape_tet(&s, t.tet[4 * i] + 8, t.tet[4 * i + 1] + 8, t.tet[4 * i + 2] + 8, t.tet[4 * i + 3] + 8);
    shape_finish(&t);
    return s;
}

static void duplicated_points_are_merged_when_their_values_agree(void **state)
{
    (void)state;
    shape s = seam();
    double scalar[16];
    for (size_t v = 0; v < 16; v++)
        scalar[v] = s.vertex[3 * v];
    tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.merged_vertices, 4);
    assert_int_equal(r.n_vertex, 12);
    assert_int_equal(r.n_component, 1);
    assert_true(r.convex);
    end(&m, &s);
}

static void a_jump_along_a_seam_is_kept(void **state)
{
    (void)state;
    shape s = seam();
    double scalar[16];
    for (size_t v = 0; v < 16; v++)
        scalar[v] = v < 8 ? 1 : 2;
    tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.merged_vertices, 0);
    assert_int_equal(r.n_component, 2);
    assert_int_equal(r.n_boundary_face, 24);
    assert_false(r.convex);
    end(&m, &s);
    s = seam(); /* cell data cannot jump at a point: always merged */
    for (size_t t = 0; t < 12; t++)
        scalar[t] = t < 6 ? 1 : 2;
    m = shape_mesh(&s, scalar, TC_CELL_DATA);
    r = shape_prepare(m, TC_REENTRY_PEEL);
    assert_int_equal(r.merged_vertices, 4);
    assert_int_equal(r.n_component, 1);
    end(&m, &s);
}

static void a_face_of_three_cells_is_unlinked(void **state)
{
    (void)state;
    shape s = one_tet();
    shape_vertex(&s, 1, 1, 1);
    shape_vertex(&s, 2, 2, 2);
    shape_tet(&s, 1, 2, 3, 4);
    shape_tet(&s, 1, 2, 3, 5);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.unlinked_faces, 1);
    assert_int_equal(open_faces(m), 12);
    assert_int_equal(r.n_component, 3);
    assert_false(r.convex);
    end(&m, &s);
}

static void two_cells_on_one_side_of_a_face_are_unlinked(void **state)
{
    (void)state;
    for (int turn = 0; turn < 16; turn++) { /* in either winding of the file, and vertices in several orders on the curve */
        shape s = one_tet();
        shape_vertex(&s, 0.55, 0.2, 0.2); /* beyond vertex 1 on the curve, or before it */
        for (size_t i = 0; i < 3 * s.n_vertex; i++)
            s.vertex[i] *= turn >> (1 + i % 3) & 1 ? -1 : 1;
        if (turn & 1)
            shape_tet(&s, 1, 2, 3, 4);
        else
            shape_tet(&s, 2, 1, 3, 4);
        tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
        tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
        shape_check_promises(m);
        assert_int_equal(r.unlinked_faces, 1);
        assert_int_equal(open_faces(m), 8);
        end(&m, &s);
    }
}

/* A cube side split along different diagonals by its two cubes, closed by a flat cell on the four corners. */
static void a_flat_cell_stays_and_links_its_neighbours(void **state)
{
    (void)state;
    for (int order = 0; order < 24; order++) {
        shape s = {0};
        int32_t a = shape_vertex(&s, 0, 0, 0), b = shape_vertex(&s, 1, 0, 0), c = shape_vertex(&s, 1, 1, 0);
        int32_t d = shape_vertex(&s, 0, 1, 0), top = shape_vertex(&s, 0.5, 0.5, 1),
                low = shape_vertex(&s, 0.5, 0.5, -1);
        shape_tet(&s, a, b, c, top);
        shape_tet(&s, a, c, d, top);
        shape_tet(&s, a, b, d, low);
        shape_tet(&s, b, c, d, low);
        int32_t flat[4] = {a, b, c, d}; /* in each of its 24 orders */
        for (int i = 0, k = order; i < 3; i++) {
            int j = i + k % (4 - i);
            k /= 4 - i;
            int32_t v = flat[i];
            flat[i] = flat[j], flat[j] = v;
        }
        shape_tet(&s, flat[0], flat[1], flat[2], flat[3]);
        tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
        tc_mesh_report r = shape_prepare(m, TC_REENTRY_AUTO);
        shape_check_promises(m);
        assert_int_equal(r.zero_volume, 1);
        assert_int_equal(r.n_tet, 5);
        assert_int_equal(r.unlinked_faces, 0);
        assert_int_equal(open_faces(m), 8);
        assert_int_equal(r.n_component, 1);
        assert_true(r.convex);
        assert_true(fabs(r.volume - 2.0 / 3) < 1e-15);
        end(&m, &s);
    }
}

/* A stack of flat cells between two cubes: each sees mostly other flat ones, and all have to turn together. */
static void a_stack_of_flat_cells_is_linked_through(void **state)
{
    (void)state;
    for (int start = 0; start < 32; start++) {
        shape s = {0};
        int32_t p[4] = {shape_vertex(&s, 0, 0, 0), shape_vertex(&s, 1, 0, 0), shape_vertex(&s, 1, 1, 0),
                        shape_vertex(&s, 0, 1, 0)};
        int32_t top = shape_vertex(&s, 0.5, 0.5, 1), low = shape_vertex(&s, 0.5, 0.5, -1);
        shape_tet(&s, p[0], p[1], p[2], top);
        shape_tet(&s, p[0], p[2], p[3], top);
        /* the square's first corner climbs twice on the spot: points of one place, kept apart by their values */
        int32_t e = shape_vertex(&s, 0, 0, 0), f = shape_vertex(&s, 0, 0, 0);
        int32_t layer[4][4] = {{p[0], p[1], p[2], e}, {p[0], p[2], p[3], e}, {e, p[1], p[2], f}, {e, p[2], p[3], f}};
        for (int i = 0; i < 4; i++) {
            int32_t *v = layer[i];
            if (start >> i & 1)
                shape_tet(&s, v[0], v[1], v[2], v[3]);
            else
                shape_tet(&s, v[1], v[0], v[2], v[3]);
        }
        if (start >> 4 & 1)
            shape_tet(&s, f, p[1], p[2], p[3]);
        else
            shape_tet(&s, p[1], f, p[2], p[3]);
        shape_tet(&s, f, p[1], p[3], low);
        shape_tet(&s, p[1], p[2], p[3], low);
        double scalar[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
        tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
        shape_check_promises(m);
        assert_int_equal(r.zero_volume, 5);
        assert_int_equal(r.unlinked_faces, 0);
        assert_int_equal(r.n_component, 1);
        end(&m, &s);
    }
}

/* A coarse cube beside four fine ones: their common side does not conform. */
static void hanging_nodes_leave_faces_open(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {2, 2, 2};
    shape_grid(&s, n, NULL);
    for (size_t v = 0; v < s.n_vertex; v++)
        s.vertex[3 * v] *= 0.5;
    shape t = {0};
    const int one[3] = {1, 1, 1};
    shape_grid(&t, one, NULL);
    int32_t base = (int32_t)s.n_vertex;
    for (size_t v = 0; v < t.n_vertex; v++)
        shape_vertex(&s, 1 + t.vertex[3 * v], 2 * t.vertex[3 * v + 1], 2 * t.vertex[3 * v + 2]);
    for (size_t i = 0; i < t.n_tet; i++)
        shape_tet(&s, t.tet[4 * i] + base, t.tet[4 * i + 1] + base, t.tet[4 * i + 2] + base, t.tet[4 * i + 3] + base);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.merged_vertices, 4);
    assert_int_equal(r.n_component, 2);
    assert_int_equal(r.n_boundary_face, 48 + 12);
    assert_int_equal(r.unlinked_faces, 0);
    assert_false(r.convex);
    shape_finish(&t);
    end(&m, &s);
}

static void a_fan_of_many_cells_around_one_vertex_is_linked(void **state)
{
    (void)state;
    enum { N = 3000 };
    shape s = {0};
    int32_t axis = shape_vertex(&s, 0, 0, 0), tip = shape_vertex(&s, 0, 0, 1);
    for (int i = 0; i < N; i++)
        shape_vertex(&s, cos(TURN * i / N), sin(TURN * i / N), 0);
    for (int i = 0; i < N; i++)
        shape_tet(&s, axis, 2 + i, 2 + (i + 1) % N, tip);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(open_faces(m), 2 * N);
    assert_true(r.convex);
    end(&m, &s);
}

static bool all_but_one_corner(int i, int j, int k)
{
    return i + j + k > 0;
}

static void one_missing_corner_is_not_convex(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {6, 6, 6};
    shape_grid(&s, n, all_but_one_corner);
    for (size_t i = 0; i < 3 * s.n_vertex; i++)
        s.vertex[i] /= 3;
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    assert_false(r.convex);
    assert_int_equal(r.unused_vertices, 1);
    end(&m, &s);
}

static void cells_wound_twice_around_an_axis_are_not_convex(void **state)
{
    (void)state;
    /* ten cells around an axis, each 72 degrees wide: every edge of the surface is convex, yet it covers the hull twice
     */
    shape s = {0};
    int32_t low = shape_vertex(&s, 0, 0, -1), tip = shape_vertex(&s, 0, 0, 1);
    double scalar[12] = {0};
    for (int i = 0; i < 10; i++) {
        double angle = TURN * (i % 5) / 5;
        scalar[shape_vertex(&s, cos(angle), sin(angle), 0)] = i; /* so that the second round's points stay apart */
    }
    for (int i = 0; i < 10; i++)
        shape_tet(&s, low, 2 + i, 2 + (i + 1) % 10, tip);
    tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.n_boundary_face, 20);
    assert_int_equal(r.n_component, 1);
    assert_false(r.convex);
    end(&m, &s);
}

static void every_random_soup_of_cells_keeps_the_promises(void **state)
{
    (void)state;
    uint64_t r = 99;
    for (int round = 0; round < 200; round++) {
        shape s = {0};
        int n = 5 + round % 8;
        for (int v = 0; v < n; v++) { /* a tiny grid: coincident, collinear and coplanar points galore */
            r = r * 6364136223846793005u + 1442695040888963407u;
            shape_vertex(&s, (double)(r >> 33 & 1), (double)(r >> 36 & 3), (double)(r >> 41 & 1));
        }
        for (int t = 0; t < 4 * n; t++) {
            int32_t v[4];
            for (int i = 0; i < 4; i++) {
                r = r * 6364136223846793005u + 1442695040888963407u;
                v[i] = (int32_t)((r >> 33) % (uint64_t)n);
            }
            shape_tet(&s, v[0], v[1], v[2], v[3]);
        }
        tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
        tc_prepare_options o = {.reentry = TC_REENTRY_PEEL};
        tc_error err = {0};
        tc_status status = tc_mesh_prepare(m, &o, NULL, &err);
        if (status == TC_OK) {
            shape_check_promises(m);
            assert_int_equal(m->n_tet + m->report.dropped_degenerate + m->report.dropped_duplicate, 4 * n);
            for (size_t t = 0; t < m->n_tet; t++)
                assert_true(shape_volume6(m, m->tet + 4 * t) >= 0);
        } else {
            assert_int_equal(status, TC_E_MESH);
            assert_non_null(strstr(err.text, "repeat a vertex"));
        }
        end(&m, &s);
    }
}

static void hopeless_input_gives_a_sentence(void **state)
{
    (void)state;
    tc_error err = {0};
    tc_mesh *m = NULL;
    shape s = one_tet();
    tc_mesh_arrays a = {.n_vertex = 4, .vertex = s.vertex, .n_tet = 1, .tet = s.tet};
    s.tet[2] = 4;
    assert_int_equal(tc_mesh_create(&m, &a, &err), TC_E_MESH);
    assert_null(m);
    assert_non_null(strstr(err.text, "tetrahedron 0 names vertex 4"));
    s.tet[2] = -1;
    assert_int_equal(tc_mesh_create(&m, &a, &err), TC_E_MESH);
    s.tet[2] = 2;
    a.scalar = s.vertex;
    assert_int_equal(tc_mesh_create(&m, &a, &err), TC_E_ARG); /* point or cell data? */
    a.scalar = NULL, a.vertex = NULL;
    assert_int_equal(tc_mesh_create(&m, &a, &err), TC_E_ARG);
    a.n_tet = SIZE_MAX / 2;
    assert_int_equal(tc_mesh_create(&m, &a, &err), TC_E_ARG);
    a = (tc_mesh_arrays){0};
    assert_int_equal(tc_mesh_create(&m, &a, &err), TC_OK);
    assert_int_equal(tc_mesh_prepare(m, NULL, NULL, &err), TC_E_MESH);
    assert_non_null(strstr(err.text, "no tetrahedra"));
    tc_mesh_destroy(&m);
    a = (tc_mesh_arrays){.n_vertex = 4, .vertex = s.vertex, .n_tet = 1, .tet = s.tet};
    s.vertex[5] = NAN;
    assert_int_equal(tc_mesh_create(&m, &a, &err), TC_OK);
    assert_int_equal(tc_mesh_prepare(m, NULL, NULL, &err), TC_E_MESH);
    assert_non_null(strstr(err.text, "not finite"));
    tc_prepare_options o = {.reentry = (tc_reentry)9};
    assert_int_equal(tc_mesh_prepare(m, &o, NULL, &err), TC_E_ARG);
    end(&m, &s);
}

static void values_that_are_not_finite_are_counted_and_left_out_of_the_range(void **state)
{
    (void)state;
    shape s = one_tet();
    const double some[4] = {NAN, -3, INFINITY, 7}, none[4] = {NAN, NAN, INFINITY, -INFINITY};
    tc_mesh *m = shape_mesh(&s, some, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    assert_int_equal(r.nonfinite_scalars, 2);
    assert_int_equal(r.nonfinite_cells, 1);
    assert_true(r.scalar_range[0] == -3 && r.scalar_range[1] == 7);
    const double cell = NAN, known = 2;
    assert_int_equal(tc_mesh_set_scalar(m, &cell, TC_CELL_DATA, NULL), TC_OK);
    tc_mesh_get_report(&r, m);
    assert_int_equal(r.nonfinite_cells, 1);
    assert_int_equal(tc_mesh_set_scalar(m, &known, TC_CELL_DATA, NULL), TC_OK);
    tc_mesh_get_report(&r, m);
    assert_int_equal(r.nonfinite_cells, 0);
    assert_int_equal(tc_mesh_set_scalar(m, none, TC_POINT_DATA, NULL), TC_OK);
    tc_mesh_get_report(&r, m);
    assert_int_equal(r.nonfinite_scalars, 4);
    assert_true(r.scalar_range[0] == 0 && r.scalar_range[1] == 0);
    end(&m, &s);
}

static void new_values_come_in_the_order_of_the_source(void **state)
{
    (void)state;
    shape s = seam();
    double scalar[16] = {0}, cell[12];
    tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
    tc_error err = {0};
    shape_prepare(m, TC_REENTRY_PEEL);
    uint64_t geometry = m->serial, values = m->scalar_serial;
    for (size_t v = 0; v < 16; v++)
        scalar[v] = s.vertex[3 * v] + 10 * s.vertex[3 * v + 2];
    assert_int_equal(tc_mesh_set_scalar(m, scalar, TC_POINT_DATA, &err), TC_OK);
    assert_true(m->serial == geometry && m->scalar_serial != values);
    for (size_t v = 0; v < m->n_vertex; v++)
        assert_true(m->scalar[v] == m->vertex[3 * v] + 10 * m->vertex[3 * v + 2]);
    scalar[15] += 1; /* point 15 lies alone; 1 and 8 are one */
    assert_int_equal(tc_mesh_set_scalar(m, scalar, TC_POINT_DATA, &err), TC_OK);
    scalar[8] += 1;
    double before = m->scalar[m->vertex_of_source[8]];
    assert_int_equal(tc_mesh_set_scalar(m, scalar, TC_POINT_DATA, &err), TC_E_MESH);
    assert_non_null(strstr(err.text, "points 1 and 8"));
    assert_true(m->scalar[m->vertex_of_source[8]] == before);
    for (size_t t = 0; t < 12; t++)
        cell[t] = (double)t;
    assert_int_equal(tc_mesh_set_scalar(m, cell, TC_CELL_DATA, &err), TC_OK);
    assert_int_equal(m->report.association, TC_CELL_DATA);
    assert_true(m->report.scalar_range[1] == 11);
    for (size_t t = 0; t < 12; t++)
        assert_true(m->scalar[m->tet_of_source[t]] == cell[t]);
    assert_int_equal(tc_mesh_set_scalar(m, cell, TC_ANY_DATA, &err), TC_E_ARG);
    end(&m, &s);
}

static void two_meshes_never_share_a_serial(void **state)
{
    (void)state;
    shape s = one_tet();
    tc_mesh *a = shape_mesh(&s, NULL, TC_POINT_DATA), *b = shape_mesh(&s, NULL, TC_POINT_DATA);
    assert_true(a->serial != b->serial && a->scalar_serial != b->scalar_serial);
    uint64_t before = a->serial;
    shape_prepare(a, TC_REENTRY_PEEL);
    assert_true(a->serial != before && a->serial != b->serial);
    assert_null(tc_mesh_source(a));
    tc_mesh_destroy(&b);
    end(&a, &s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_single_tet_has_four_boundary_faces),
        cmocka_unit_test(two_tets_on_a_face_are_linked_across_it_only),
        cmocka_unit_test(a_kuhn_grid_is_linked_whole),
        cmocka_unit_test(the_result_does_not_depend_on_the_number_of_threads),
        cmocka_unit_test(repairs_depend_on_the_number_of_threads),
        cmocka_unit_test(another_than_the_first_point_of_a_place_is_kept),
        cmocka_unit_test(a_mesh_too_large_for_memory_is_begun_or_spoilt),
        cmocka_unit_test(bad_cells_are_dropped_and_counted),
        cmocka_unit_test(an_equal_cell_keeps_the_value_of_the_first),
        cmocka_unit_test(duplicated_points_are_merged_when_their_values_agree),
        cmocka_unit_test(a_jump_along_a_seam_is_kept),
        cmocka_unit_test(a_face_of_three_cells_is_unlinked),
        cmocka_unit_test(two_cells_on_one_side_of_a_face_are_unlinked),
        cmocka_unit_test(a_flat_cell_stays_and_links_its_neighbours),
        cmocka_unit_test(a_stack_of_flat_cells_is_linked_through),
        cmocka_unit_test(hanging_nodes_leave_faces_open),
        cmocka_unit_test(a_fan_of_many_cells_around_one_vertex_is_linked),
        cmocka_unit_test(one_missing_corner_is_not_convex),
        cmocka_unit_test(cells_wound_twice_around_an_axis_are_not_convex),
        cmocka_unit_test(every_random_soup_of_cells_keeps_the_promises),
        cmocka_unit_test(hopeless_input_gives_a_sentence),
        cmocka_unit_test(values_that_are_not_finite_are_counted_and_left_out_of_the_range),
        cmocka_unit_test(new_values_come_in_the_order_of_the_source),
        cmocka_unit_test(two_meshes_never_share_a_serial),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
