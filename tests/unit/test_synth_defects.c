/* test_synth_defects.c: that the hard cases among the synthetic datasets are as hard as they say: what is wrong with
 * each is found in it, and nothing else. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/vec.h"
#include "datasets_synthetic/synth.h"
#include "mesh/mesh.h"
#include "mesh/predicate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int outward[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}; /* faces of a positive tet */
static const size_t few = 300;

static tc_synth_soup build(const char *name, size_t n_cells)
{
    const tc_synth_generator *g = tc_synth_find(name);
    assert_non_null(g);
    tc_synth_soup soup = {0};
    tc_error err = {0};
    if (g->build(&soup, n_cells ? n_cells : g->default_cells, 1, &err))
        fail_msg("%s: %s", name, err.text);
    return soup;
}

static tc_mesh *prepared(const char *name, size_t n_cells)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    const tc_prepare_options peel = {.reentry = TC_REENTRY_PEEL};
    if (tc_synth_create(&mesh, name, n_cells, 1, &err) || tc_mesh_prepare(mesh, &peel, NULL, &err))
        fail_msg("%s: %s", name, err.text);
    return mesh;
}

/* Calls check for each dataset that can be prepared, with few cells and with its default. */
static void for_all(void (*check)(const char *name, const tc_synth_generator *g, const tc_mesh *mesh))
{
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        const tc_synth_generator *g = tc_synth_find(list[i].name);
        if (g->defects & (TC_SYNTH_NO_CELLS | TC_SYNTH_BAD_INDEX))
            continue;
        for (size_t n_cells = few;; n_cells = 0) {
            tc_mesh *mesh = prepared(list[i].name, n_cells);
            check(list[i].name, g, mesh);
            tc_mesh_destroy(&mesh);
            if (n_cells == 0)
                break;
        }
    }
}

static void check_counts(const char *name, const tc_synth_generator *g, const tc_mesh *mesh)
{
    const tc_mesh_report *r = &mesh->report;
    const struct {
        unsigned defect;
        const char *what;
        size_t count;
    } row[] = {
        {TC_SYNTH_DEGENERATE, "repeat a vertex", r->dropped_degenerate},
        {TC_SYNTH_NONFINITE_POINTS, "have a vertex that is not finite", r->dropped_nonfinite},
        {TC_SYNTH_DUPLICATE_CELLS, "are there twice", r->dropped_duplicate},
        {TC_SYNTH_INVERTED, "are inside out", r->reoriented},
        {TC_SYNTH_FLAT, "have no volume", r->zero_volume},
        {TC_SYNTH_DUPLICATE_POINTS, "points were merged", r->merged_vertices},
        {TC_SYNTH_UNUSED_POINTS, "points are not used", r->unused_vertices},
        {TC_SYNTH_SHARED_FACES, "faces are not linked", r->unlinked_faces},
        {TC_SYNTH_NONFINITE_VALUES, "values are not finite", r->nonfinite_scalars},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        if ((row[i].count > 0) != ((g->defects & row[i].defect) != 0))
            fail_msg("%s, %zu tets: %zu %s", name, r->n_tet, row[i].count, row[i].what);
    bool constant = r->scalar_range[0] == r->scalar_range[1];
    bool should = g->defects & (TC_SYNTH_CONSTANT | TC_SYNTH_NO_FIELD);
    if (constant != should && r->nonfinite_scalars < mesh->n_vertex)
        fail_msg("%s, %zu tets: its values are %sconstant", name, r->n_tet, constant ? "" : "not ");
    if ((mesh->field_name == NULL) != ((g->defects & TC_SYNTH_NO_FIELD) != 0))
        fail_msg("%s, %zu tets: its field is %s", name, r->n_tet, mesh->field_name ? mesh->field_name : "missing");
}

static void a_defect_is_missing_or_one_too_many(void **state)
{
    (void)state;
    for_all(check_counts);
}

static void check_convex(const char *name, const tc_synth_generator *g, const tc_mesh *mesh)
{
    bool says = g->promises & TC_SYNTH_CONVEX;
    if (!strcmp(name, "edge-fan") &&
        mesh->n_tet > few) /* rounding of the planes of faces so narrow is taken for dents */
        return;
    if (says != mesh->report.convex)
        fail_msg("%s, %zu tets: says that it is %sconvex", name, mesh->report.n_tet, says ? "" : "not ");
}

static void a_mesh_is_not_as_convex_as_it_says(void **state)
{
    (void)state;
    for_all(check_convex);
}

/* ---------------------------------------------------------------------------------------- what no report counts */

static const double *corner(const tc_mesh *m, size_t tet, int i)
{
    return m->vertex + 3 * (size_t)m->tet[4 * tet + (size_t)i];
}

static double height_over(const tc_mesh *m, size_t tet, int face, const double *p)
{
    const double *a = corner(m, tet, outward[face][0]);
    double e[2][3], n[3], from[3];
    tc_vec_sub(e[0], corner(m, tet, outward[face][1]), a);
    tc_vec_sub(e[1], corner(m, tet, outward[face][2]), a);
    tc_vec_cross(n, e[0], e[1]);
    tc_vec_sub(from, p, a);
    return tc_vec_dot(n, from) / tc_vec_length(n);
}

/* Is p inside a tet by more than depth? */
static bool inside(const tc_mesh *m, size_t tet, const double *p, double depth)
{
    for (int f = 0; f < 4; f++)
        if (!(height_over(m, tet, f, p) < -depth))
            return false;
    return true;
}

static void middle(double *out, const tc_mesh *m, size_t tet)
{
    for (int k = 0; k < 3; k++)
        out[k] = (corner(m, tet, 0)[k] + corner(m, tet, 1)[k] + corner(m, tet, 2)[k] + corner(m, tet, 3)[k]) / 4;
}

/* Exactly. */
static bool strictly_inside(const tc_mesh *m, size_t tet, const double *p)
{
    for (int f = 0; f < 4; f++)
        if (tc_orient3d(corner(m, tet, outward[f][0]), corner(m, tet, outward[f][1]), corner(m, tet, outward[f][2]),
                        p) >= 0)
            return false;
    return true;
}

/* Tets whose middle, and points that, lie in another tet. */
static size_t count_overlaps(const tc_mesh *m)
{
    size_t n = 0;
    double depth = 1e-12 * m->report.longest_edge;
    for (size_t t = 0; t < m->n_tet; t++) {
        double p[3];
        middle(p, m, t);
        for (size_t u = 0; u < m->n_tet; u++)
            n += u != t && inside(m, u, p, depth);
        for (size_t v = 0; v < m->n_vertex; v++)
            n += strictly_inside(m, t, m->vertex + 3 * v);
    }
    return n;
}

/* Boundary faces with a tet just outside. */
static size_t count_touching(const tc_mesh *m)
{
    size_t n = 0;
    double step = 1e-6 * m->report.longest_edge;
    for (size_t i = 0; i < 4 * m->n_tet; i++) {
        if (m->neighbour[i] >= 0)
            continue;
        const double *q[3];
        double e[2][3], normal[3], p[3];
        for (int k = 0; k < 3; k++)
            q[k] = corner(m, i / 4, outward[i % 4][k]);
        tc_vec_sub(e[0], q[1], q[0]);
        tc_vec_sub(e[1], q[2], q[0]);
        tc_vec_cross(normal, e[0], e[1]);
        if (tc_vec_normalize(normal) == 0)
            continue;
        for (int k = 0; k < 3; k++)
            p[k] = (q[0][k] + q[1][k] + q[2][k]) / 3 + step * normal[k];
        bool found = false;
        for (size_t t = 0; t < m->n_tet && !found; t++)
            found = t != i / 4 && inside(m, t, p, 0);
        n += found;
    }
    return n;
}

static void cells_that_should_overlap_or_touch_do_not(void **state)
{
    (void)state;
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        const tc_synth_generator *g = tc_synth_find(list[i].name);
        if (g->defects & (TC_SYNTH_NO_CELLS | TC_SYNTH_BAD_INDEX))
            continue;
        tc_mesh *mesh = prepared(list[i].name, few);
        bool overlap = g->defects & TC_SYNTH_OVERLAPPING, touch = g->defects & TC_SYNTH_TOUCHING_FACES;
        size_t n_overlap = count_overlaps(mesh);
        if ((n_overlap > 0) != overlap)
            fail_msg("%s, %zu tets: %zu overlap", list[i].name, mesh->n_tet, n_overlap);
        size_t n_touch = touch ? count_touching(mesh) : 0;
        if (touch && strcmp(list[i].name, "seam") && n_touch == 0)
            fail_msg("%s, %zu tets: no faces touch", list[i].name, mesh->n_tet);
        tc_mesh_destroy(&mesh);
    }
}

/* Points at the place of another one in the prepared mesh. */
static size_t count_coincident(const tc_mesh *m)
{
    size_t n = 0;
    for (size_t v = 0; v < m->n_vertex; v++)
        for (size_t w = 0; w < v; w++)
            n += memcmp(m->vertex + 3 * v, m->vertex + 3 * w, 3 * sizeof(double)) == 0;
    return n;
}

static void a_boundary_does_not_touch_itself_in_points_of_its_own(void **state)
{
    (void)state;
    static const char *const name[] = {"seam-jump", "crack", "slit", "slit-ring", "touch-edge-apart"};
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        tc_mesh *mesh = prepared(name[i], few);
        if (count_coincident(mesh) == 0)
            fail_msg("%s: all points were merged", name[i]);
        tc_mesh_destroy(&mesh);
    }
    tc_mesh *seam = prepared("seam", few);
    assert_int_equal(count_coincident(seam), 0);
    tc_mesh_destroy(&seam);
}

static void rounding_does_not_fold_a_sliver(void **state)
{
    (void)state;
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        const tc_synth_generator *g = tc_synth_find(list[i].name);
        if (!(g->defects & TC_SYNTH_ROUNDS_INVERTED))
            continue;
        tc_mesh *m = prepared(list[i].name, 0);
        const double *b = m->report.bounds, half[3] = {(b[1] - b[0]) / 2, (b[3] - b[2]) / 2, (b[5] - b[4]) / 2};
        size_t folded = 0;
        for (size_t t = 0; t < m->n_tet; t++) {
            double p[4][3];
            for (int c = 0; c < 4; c++)
                for (int k = 0; k < 3; k++)
                    p[c][k] = (float)((corner(m, t, c)[k] - (b[2 * k] + half[k])) / tc_vec_length(half));
            folded += tc_orient3d(p[0], p[1], p[2], p[3]) < 0;
        }
        if (folded < m->n_tet / 100)
            fail_msg("%s: rounding inverts %zu of %zu tets", list[i].name, folded, m->n_tet);
        tc_mesh_destroy(&m);
    }
}

/* Smallest height of a tet as a share of its longest edge. */
static double flatness(const tc_mesh *m, size_t tet)
{
    double longest = 0, lowest = HUGE_VAL;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            double e[3];
            tc_vec_sub(e, corner(m, tet, i), corner(m, tet, j));
            longest = fmax(longest, tc_vec_length(e));
        }
    for (int f = 0; f < 4; f++)
        lowest = fmin(lowest, fabs(height_over(m, tet, f, corner(m, tet, f))));
    return lowest / longest;
}

static void a_cell_is_not_as_thin_as_its_name_says(void **state)
{
    (void)state;
    static const char *const kind[] = {"needle", "wedge", "cap", "sliver"};
    static const char *const aspect[] = {"1e3", "1e5", "1e8"};
    for (size_t i = 0; i < 4; i++)
        for (size_t j = 0; j < 3; j++) {
            char name[32];
            snprintf(name, sizeof name, "%s-%s", kind[i], aspect[j]);
            tc_mesh *m = prepared(name, 0);
            double a = atof(aspect[j]);
            size_t thin = 0;
            for (size_t t = 0; t < m->n_tet; t++) {
                double f = flatness(m, t) * a;
                thin += f > 0.1 && f < 3;
            }
            if (thin < m->n_tet / 20)
                fail_msg("%s: %zu of %zu tets are of that aspect", name, thin, m->n_tet);
            tc_mesh_destroy(&m);
        }
}

static void shortest_and_longest(double *shortest, double *longest, const tc_mesh *m)
{
    *shortest = HUGE_VAL, *longest = 0;
    for (size_t t = 0; t < m->n_tet; t++)
        for (int i = 1; i < 4; i++) {
            double e[3];
            tc_vec_sub(e, corner(m, t, i), corner(m, t, i - 1));
            *shortest = fmin(*shortest, tc_vec_length(e));
            *longest = fmax(*longest, tc_vec_length(e));
        }
}

static void graded_cells_are_of_one_size(void **state)
{
    (void)state;
    static const char *const name[] = {"graded", "graded-planes"};
    for (int i = 0; i < 2; i++) {
        tc_mesh *m = prepared(name[i], 0);
        double shortest, longest;
        shortest_and_longest(&shortest, &longest, m);
        assert_true(longest / shortest > 9e5);
        tc_mesh_destroy(&m);
    }
}

static void a_fan_has_few_cells_around_its_middle(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t vertices; /* in all tets */
    } fan[] = {{"vertex-fan", 1}, {"edge-fan", 2}};
    for (int i = 0; i < 2; i++) {
        tc_synth_soup s = build(fan[i].name, 0);
        size_t *uses = calloc(s.n_vertex, sizeof *uses), all = 0;
        assert_non_null(uses);
        for (size_t k = 0; k < 4 * s.n_tet; k++)
            uses[s.tet[k]]++;
        for (size_t v = 0; v < s.n_vertex; v++)
            all += uses[v] == s.n_tet;
        assert_int_equal(all, fan[i].vertices);
        assert_true(s.n_tet >= 10000);
        free(uses);
        tc_synth_soup_finish(&s);
    }
}

/* Where a line along z meets a tet: false when it misses it. */
static bool column(double *z0, double *z1, const tc_mesh *m, size_t tet, double x, double y)
{
    *z0 = -HUGE_VAL, *z1 = HUGE_VAL;
    for (int f = 0; f < 4; f++) {
        const double p[3] = {x, y, 0}, q[3] = {x, y, 1};
        double at = height_over(m, tet, f, p), slope = height_over(m, tet, f, q) - at;
        if (slope > 0)
            *z1 = fmin(*z1, -at / slope);
        else if (slope < 0)
            *z0 = fmax(*z0, -at / slope);
        else if (at > 0)
            return false;
    }
    return *z0 < *z1;
}

static void a_visibility_cycle_has_an_order(void **state)
{
    (void)state;
    static const char *const name[] = {"cycle", "cycle-ring"};
    for (int i = 0; i < 2; i++) {
        tc_mesh *m = prepared(name[i], 0);
        size_t n = m->n_tet;
        assert_in_range(n, 3, 12);
        bool over[12][12] = {{0}};
        const double *b = m->report.bounds;
        for (int row = 0; row < 400; row++)
            for (int at = 0; at < 400; at++) {
                double x = b[0] + (b[1] - b[0]) * (at + 0.5) / 400, y = b[2] + (b[3] - b[2]) * (row + 0.5) / 400;
                double lo[12], hi[12];
                bool hit[12];
                for (size_t t = 0; t < n; t++)
                    hit[t] = column(&lo[t], &hi[t], m, t, x, y);
                for (size_t t = 0; t < n; t++)
                    for (size_t u = 0; u < n; u++)
                        over[t][u] = over[t][u] || (t != u && hit[t] && hit[u] && lo[t] > hi[u]);
            }
        for (size_t t = 0; t < n; t++) {
            size_t below = 0, above = 0;
            for (size_t u = 0; u < n; u++) {
                below += over[t][u], above += over[u][t];
                if (over[t][u] && over[u][t])
                    fail_msg("%s: two tets cross", name[i]);
            }
            if (below == 0 || above == 0)
                fail_msg("%s: a tet is at an end of the order", name[i]);
        }
        tc_mesh_destroy(&m);
    }
}

static void sizes_and_offsets_are_not_those_of_the_name(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double at, size; /* bounds along x */
    } row[] = {{"size-1e-30", 0, 1e-30},       {"size-1e-20", 0, 1e-20},       {"size-1e20", 0, 1e20},
               {"size-1e30", 0, 1e30},         {"offset-1e7", 1e7, 1},         {"comb-size-1e-30", 0, 1.97e-30},
               {"comb-size-1e30", 0, 1.97e30}, {"comb-offset-1e7", 1e7, 1.97}, {"rod-1e-4", 0, 1}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_mesh *m = prepared(row[i].name, few);
        assert_true(m->report.bounds[0] == row[i].at);
        if (fabs(m->report.bounds[1] - row[i].at - row[i].size) > 1e-8 * row[i].size)
            fail_msg("%s reaches to %.17g", row[i].name, m->report.bounds[1]);
        tc_mesh_destroy(&m);
    }
    tc_mesh *rod = prepared("rod-1e-4", few);
    assert_true(rod->report.bounds[3] == 1e-4 && rod->report.bounds[5] == 1e-4);
    tc_mesh_destroy(&rod);
}

static void a_mesh_that_cannot_be_is_made(void **state)
{
    (void)state;
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    assert_int_equal(tc_synth_create(&mesh, "bad-index", 0, 1, &err), TC_E_MESH);
    assert_null(mesh);
    assert_non_null(strstr(err.text, "names vertex"));
    assert_int_equal(tc_synth_create(&mesh, "no-cells", 0, 1, &err), TC_OK);
    assert_int_equal(tc_mesh_prepare(mesh, NULL, NULL, &err), TC_E_MESH);
    assert_non_null(strstr(err.text, "no tetrahedra"));
    tc_mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_defect_is_missing_or_one_too_many),
        cmocka_unit_test(a_mesh_is_not_as_convex_as_it_says),
        cmocka_unit_test(cells_that_should_overlap_or_touch_do_not),
        cmocka_unit_test(a_boundary_does_not_touch_itself_in_points_of_its_own),
        cmocka_unit_test(rounding_does_not_fold_a_sliver),
        cmocka_unit_test(a_cell_is_not_as_thin_as_its_name_says),
        cmocka_unit_test(graded_cells_are_of_one_size),
        cmocka_unit_test(a_fan_has_few_cells_around_its_middle),
        cmocka_unit_test(a_visibility_cycle_has_an_order),
        cmocka_unit_test(sizes_and_offsets_are_not_those_of_the_name),
        cmocka_unit_test(a_mesh_that_cannot_be_is_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
