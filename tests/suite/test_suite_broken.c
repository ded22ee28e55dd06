/* test_suite_broken.c: non-manifold and broken meshes: each renders without a lost ray, as the reference defines it,
 * and what was done with it is counted and said. */
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 128 };

/* A mesh under construction: cells of cubes, moved or loose. */
typedef struct soup {
    size_t n_vertex, n_tet;
    double vertex[4096][3], scalar[4096];
    int32_t tet[8192][4];
} soup;

static int32_t add_vertex(soup *s, double x, double y, double z, double value)
{
    assert_true(s->n_vertex < sizeof s->scalar / sizeof *s->scalar);
    double *p = s->vertex[s->n_vertex];
    p[0] = x, p[1] = y, p[2] = z;
    s->scalar[s->n_vertex] = value;
    return (int32_t)s->n_vertex++;
}

static void add_tet(soup *s, int32_t a, int32_t b, int32_t c, int32_t d)
{
    assert_true(s->n_tet < sizeof s->tet / sizeof *s->tet);
    int32_t *t = s->tet[s->n_tet++];
    t[0] = a, t[1] = b, t[2] = c, t[3] = d;
}

/* A field that is smooth in space, so that pieces that fit show no step. */
static double smooth(const double p[3])
{
    return sin(1.3 * p[0]) + cos(1.1 * p[1] + 0.4) + 0.7 * p[2];
}

/* n[0] x n[1] x n[2] cubes of the given edge, six Kuhn tets each, at `at`; `more` is added to the field. Gives the
 * first vertex: id(i, j, k) = first + (k (n[1] + 1) + j) (n[0] + 1) + i. */
static int32_t add_block(soup *s, const double at[3], const int n[3], double edge, double more)
{
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    int32_t first = (int32_t)s->n_vertex;
    for (int k = 0; k <= n[2]; k++)
        for (int j = 0; j <= n[1]; j++)
            for (int i = 0; i <= n[0]; i++) {
                const double p[3] = {at[0] + edge * i, at[1] + edge * j, at[2] + edge * k};
                add_vertex(s, p[0], p[1], p[2], smooth(p) + more);
            }
    for (int cell = 0; cell < n[0] * n[1] * n[2]; cell++)
        for (int o = 0; o < 6; o++) {
            int c[3] = {cell % n[0], cell / n[0] % n[1], cell / n[0] / n[1]};
            int32_t v[4];
            for (int a = 0;; a++) {
                v[a] = first + (c[2] * (n[1] + 1) + c[1]) * (n[0] + 1) + c[0];
                if (a == 3)
                    break;
                c[order[o][a]]++;
            }
            add_tet(s, v[0], v[1], v[2], v[3]);
        }
    return first;
}

static soup *new_soup(void)
{
    soup *s = calloc(1, sizeof *s);
    assert_non_null(s);
    return s;
}

static tc_mesh *mesh_of(const soup *s, tc_reentry reentry)
{
    const tc_mesh_arrays arrays = {s->n_vertex, &s->vertex[0][0], s->n_tet, &s->tet[0][0],
                                   s->scalar,   TC_POINT_DATA,    "field"};
    return suite_mesh(&arrays, reentry);
}

static const double from[][3] = {{0.2, 0.3, 1}, {1, 0, 0}, {-0.5, 1, 0.3}, {0, 0, 1}, {-1, -0.4, -0.6}};
enum { VIEWS = sizeof from / sizeof *from };

/* Renders from several sides, perspective and parallel, and compares every pixel. */
static void check_views(const char *what, const tc_mesh *mesh)
{
    static const tc_knot knot[] = {
        {-2, 0.1, 0.2, 0.9, 0.4}, {0, 0.9, 0.9, 0.2, 2.5}, {1, 0.9, 0.1, 0.1, 0.3}, {4, 0.2, 0.9, 0.3, 3}};
    tc_transfer *tf = suite_function(knot, 4);
    tc_render_options options = suite_options(SIZE, SIZE);
    options.unit_distance = suite_diagonal(mesh) / 4;
    options.opacity_stop = 1;
    for (int i = 0; i < VIEWS; i++) {
        char text[128];
        tc_camera camera = suite_camera(mesh, from[i][0], from[i][1], from[i][2], i % 2);
        snprintf(text, sizeof text, "%s, view %d", what, i);
        suite_check(text, mesh, tf, &camera, &options);
    }
    tc_transfer_destroy(&tf);
}

static tc_mesh_report check_both(const char *what, const soup *s)
{
    tc_mesh_report report;
    tc_mesh *mesh = mesh_of(s, TC_REENTRY_PEEL);
    check_views(what, mesh);
    suite_prepare(mesh, TC_REENTRY_AUTO);
    tc_mesh_get_report(&report, mesh);
    suite_say("%s: %s%s", what, report.reentry == TC_REENTRY_PEEL ? "peeled: " : "convexified", report.reentry_why);
    if (report.reentry != TC_REENTRY_PEEL)
        check_views(what, mesh);
    tc_mesh_destroy(&mesh);
    return report;
}

static const double origin[3] = {0, 0, 0};
static const int two[3] = {2, 2, 2};

static void a_face_of_three_cells(void **state)
{
    (void)state;
    soup *s = new_soup();
    add_block(s, origin, two, 1, 0);
    int32_t p = add_vertex(s, -1, 0.2, 0.1, 0.5), q = add_vertex(s, -1, 0.9, 1.7, 3);
    add_tet(s, 0, 3, 12, p);
    add_tet(s, 0, 3, 12, q);
    tc_mesh_report r = check_both("three cells on a face", s);
    assert_int_equal(r.unlinked_faces, 1);
    free(s);
}

static void two_on_one_side(void **state)
{
    (void)state;
    soup *s = new_soup();
    int32_t a = add_vertex(s, 0, 0, 0, 0), b = add_vertex(s, 1, 0, 0, 1), c = add_vertex(s, 0, 1, 0, 2);
    int32_t d = add_vertex(s, 0.1, 0.2, 1, 0.5), e = add_vertex(s, 0.7, 0.6, 0.8, 3);
    add_tet(s, a, b, c, d);
    add_tet(s, a, b, c, e);
    tc_mesh_report r = check_both("two cells on one side", s);
    assert_int_equal(r.unlinked_faces, 1);
    free(s);
}

static void overlapping_blocks(void **state)
{
    (void)state;
    soup *s = new_soup();
    const double moved[3] = {0.7, 0.3, 0.1};
    add_block(s, origin, two, 1, 0);
    add_block(s, moved, two, 1, 1);
    check_both("overlapping blocks", s);
    free(s);
}

static void the_same_block_twice(void **state)
{
    (void)state;
    soup *s = new_soup();
    add_block(s, origin, two, 1, 0);
    add_block(s, origin, two, 1, 1);
    check_both("one block in another", s);
    free(s);
}

static void hanging_nodes(void **state)
{
    (void)state;
    soup *s = new_soup();
    const int four[3] = {4, 4, 4};
    const double beside[3] = {2, 0, 0};
    add_block(s, origin, two, 1, 0);
    add_block(s, beside, four, 0.5, 0);
    check_both("hanging nodes", s);
    free(s);
}

static void a_seam(void **state)
{
    (void)state;
    soup *s = new_soup();
    const double beside[3] = {2, 0, 0};
    add_block(s, origin, two, 1, 0);
    add_block(s, beside, two, 1, 1);
    check_both("a seam", s);
    free(s);
}

/* Plates as thin as 1e-9 with as thin gaps, near the middle, back to front in the file: only their depths tell which is
 * nearer. Each is opaque enough to hide much of the next. */
static void thin_plates_are_seen_in_the_order_of_the_file(void **state)
{
    (void)state;
    enum { PLATES = 12 };
    soup *s = new_soup();
    static const double tops[2] = {-1, 1};
    for (int k = 0; k < 2; k++) { /* the bounds */
        int32_t a = add_vertex(s, 2, 2, tops[k], 0), b = add_vertex(s, 2.1, 2, tops[k], 0);
        int32_t c = add_vertex(s, 2, 2.1, tops[k], 0), d = add_vertex(s, 2, 2, 0.9 * tops[k], 0);
        add_tet(s, a, b, c, d);
    }
    for (int k = 0; k < PLATES; k++) {
        double z = (2 * k - PLATES) * 1e-9, value = k % 2 ? 1 : 2 + k % 3;
        int32_t a = add_vertex(s, -2, -2, z, value), b = add_vertex(s, 2, -2, z, value);
        int32_t c = add_vertex(s, -2, 2, z, value), d = add_vertex(s, -2, -2, z + 1e-9, value);
        add_tet(s, a, b, c, d);
    }
    static const tc_knot knot[] = {{0, 0, 0, 0, 0},
                                   {1, 0.9, 0.1, 0.1, 4e8},
                                   {2, 0.1, 0.9, 0.1, 4e8},
                                   {3, 0.1, 0.1, 0.9, 4e8},
                                   {4, 0.9, 0.9, 0.1, 4e8}};
    tc_transfer *tf = suite_function(knot, 5);
    tc_mesh *mesh = mesh_of(s, TC_REENTRY_PEEL);
    for (int i = 0; i < 2; i++) {
        tc_camera camera = suite_camera(mesh, 0, 0, i ? -1 : 1, true);
        tc_render_options options = suite_options(SIZE, SIZE);
        options.unit_distance = 1;
        options.opacity_stop = 1;
        suite_check(i ? "thin plates from behind" : "thin plates", mesh, tf, &camera, &options);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    free(s);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_face_of_three_cells),
        cmocka_unit_test(two_on_one_side),
        cmocka_unit_test(overlapping_blocks),
        cmocka_unit_test(the_same_block_twice),
        cmocka_unit_test(hanging_nodes),
        cmocka_unit_test(a_seam),
        cmocka_unit_test(thin_plates_are_seen_in_the_order_of_the_file),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
