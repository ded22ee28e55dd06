/* test_suite_broken.c: non-manifold and broken meshes: each renders without a lost ray, as the reference defines it,
 * and what was done with it is counted and said. */
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 96, SAID = 8192 };

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

static tc_mesh *mesh_of(const soup *s)
{
    const tc_mesh_arrays arrays = {s->n_vertex, &s->vertex[0][0], s->n_tet, &s->tet[0][0],
                                   s->scalar,   TC_POINT_DATA,    "field"};
    tc_mesh *mesh;
    tc_error err = {0};
    if (tc_mesh_create(&mesh, &arrays, &err) != TC_OK)
        fail_msg("making a mesh: %s", err.text);
    return mesh;
}

/* A number in [0, 1). */
static double next_unit(uint32_t *x)
{
    *x = *x * 1664525u + 1013904223u;
    return (*x >> 8) / 16777216.0;
}

static const double from[][3] = {{0.2, 0.3, 1}, {1, 0, 0}, {-0.5, 1, 0.3}, {0, 0, 1}, {-1, -0.4, -0.6}};
enum { VIEWS = sizeof from / sizeof *from };

static void check_view(const char *what, const tc_mesh *mesh, const tc_camera *camera)
{
    static const tc_knot knot[] = {
        {-2, 0.1, 0.2, 0.9, 0.4}, {0, 0.9, 0.9, 0.2, 2.5}, {1, 0.9, 0.1, 0.1, 0.3}, {4, 0.2, 0.9, 0.3, 3}};
    tc_transfer *tf = suite_function(knot, 4);
    tc_render_options options = suite_options(SIZE, SIZE);
    options.unit_distance = suite_diagonal(mesh) / 4;
    options.opacity_stop = 1;
    suite_check(what, mesh, tf, camera, &options);
    tc_transfer_destroy(&tf);
}

/* Renders from several sides, perspective and parallel, and compares every pixel. */
static void check_views(const char *what, const tc_mesh *mesh)
{
    for (int i = 0; i < VIEWS; i++) {
        char text[128];
        tc_camera camera = suite_camera(mesh, from[i][0], from[i][1], from[i][2], i % 2);
        snprintf(text, sizeof text, "%s, view %d", what, i);
        check_view(text, mesh, &camera);
    }
}

static void take_message(void *user, tc_level level, const char *text)
{
    char *said = user;
    size_t n = strlen(said);
    snprintf(said + n, SAID - n, "%s%s\n", level == TC_WARNING ? "warning: " : "", text);
}

/* Peeled, and in the way that `auto` chooses, which must be `way`: the picture is the reference's, and what the library
 * says on the way holds `sentence` (NULL: nothing is looked for). Gives the report. */
static tc_mesh_report check_both(const char *what, const soup *s, tc_reentry way, const char *sentence)
{
    char said[SAID] = "";
    const tc_log log = {.message = take_message, .user = said};
    const tc_prepare_options ways[2] = {
        {.reentry = TC_REENTRY_PEEL},
        {.reentry = TC_REENTRY_AUTO, .convexify_limit_s = way == TC_REENTRY_PEEL ? 1 : 100}};
    tc_mesh_report report;
    tc_error err = {0};
    tc_mesh *mesh = mesh_of(s);
    for (int i = 0; i < 2; i++) {
        if (tc_mesh_prepare(mesh, &ways[i], &log, &err) != TC_OK)
            fail_msg("preparing: %s", err.text);
        tc_mesh_get_report(&report, mesh);
        if (i == 0 || report.reentry != TC_REENTRY_PEEL)
            check_views(what, mesh);
    }
    suite_say("%s: %s%s", what, report.reentry == TC_REENTRY_PEEL ? "peeled: " : "convexified", report.reentry_why);
    if (sentence && !strstr(said, sentence))
        fail_msg("%s: '%s' is not in what was said:\n%s", what, sentence, said);
    assert_int_equal(report.reentry, way);
    assert_true((way == TC_REENTRY_PEEL) == (report.reentry_why[0] != 0));
    tc_mesh_destroy(&mesh);
    return report;
}

static const double origin[3] = {0, 0, 0};
static const int two[3] = {2, 2, 2}, one[3] = {1, 1, 1};

/* ------------------------------------------------------------------------------------------- faces that fit badly */

static void a_face_of_three_cells_breaks_the_walk(void **state)
{
    (void)state;
    soup *s = new_soup();
    add_block(s, origin, two, 1, 0);
    int32_t p = add_vertex(s, -1, 0.2, 0.1, 0.5), q = add_vertex(s, -1, 0.9, 1.7, 3);
    add_tet(s, 0, 3, 12, p);
    add_tet(s, 0, 3, 12, q);
    tc_mesh_report r =
        check_both("three cells on a face", s, TC_REENTRY_PEEL, "warning: 1 faces have three cells or more");
    assert_int_equal(r.unlinked_faces, 1);
    assert_int_equal(r.faces_of_many, 1);
    assert_int_equal(r.faces_one_side, 0);
    assert_int_equal(r.n_tet, 50);
    free(s);
}

static void two_cells_on_one_side_break_the_walk(void **state)
{
    (void)state;
    soup *s = new_soup();
    int32_t a = add_vertex(s, 0, 0, 0, 0), b = add_vertex(s, 1, 0, 0, 1), c = add_vertex(s, 0, 1, 0, 2);
    int32_t d = add_vertex(s, 0.1, 0.2, 1, 0.5), e = add_vertex(s, 0.7, 0.6, 0.8, 3);
    add_tet(s, a, b, c, d);
    add_tet(s, a, b, c, e);
    tc_mesh_report r =
        check_both("two cells on one side", s, TC_REENTRY_PEEL, "warning: 1 faces lie between two cells on one side");
    assert_int_equal(r.unlinked_faces, 1);
    assert_int_equal(r.faces_of_many, 0);
    assert_int_equal(r.faces_one_side, 1);
    free(s);
}

/* Twelve cells around one edge and a thirteenth to twentieth that share faces with them at random. */
static void many_cells_on_many_faces_break_the_walk(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 2; seed++) {
        soup *s = new_soup();
        uint32_t x = seed * 7700077u;
        for (int v = 0; v < 9; v++) {
            double p[4];
            for (int k = 0; k < 4; k++)
                p[k] = next_unit(&x);
            add_vertex(s, p[0], p[1], p[2], 6 * p[3] - 2);
        }
        for (int t = 0; t < 40; t++) {
            int32_t v[4];
            for (int k = 0; k < 4; k++)
                v[k] = (int32_t)(9 * next_unit(&x));
            add_tet(s, v[0], v[1], v[2], v[3]);
        }
        tc_mesh_report r = check_both("random cells on nine points", s, TC_REENTRY_PEEL, "three cells or more");
        assert_true(r.faces_of_many > 0 && r.faces_one_side > 0 && r.dropped_degenerate > 0);
        assert_int_equal(r.unlinked_faces, r.faces_of_many + r.faces_one_side);
        free(s);
    }
}

/* -------------------------------------------------------------------------------------------------- cells that overlap
 */

static void overlapping_blocks_lose_matter(void **state)
{
    (void)state;
    soup *s = new_soup();
    const double moved[3] = {0.7, 0.3, 0.1};
    add_block(s, origin, two, 1, 0);
    add_block(s, moved, two, 1, 1);
    check_both("overlapping blocks", s, TC_REENTRY_PEEL, "peeling is used");
    free(s);
}

static void one_block_in_another_is_lost(void **state)
{
    (void)state;
    soup *s = new_soup();
    add_block(s, origin, two, 1, 0);
    add_block(s, origin, two, 1, 1);
    tc_mesh_report r = check_both("a block twice, with other values", s, TC_REENTRY_PEEL, "peeling is used");
    assert_int_equal(r.merged_vertices, 0);
    assert_int_equal(r.dropped_duplicate, 0);
    free(s);
}

/* A block within a larger one, which is convex: its cells are seen after those around it, since the ray enters them
 * later. */
static void a_block_inside_another_is_lost(void **state)
{
    (void)state;
    soup *s = new_soup();
    const double inside[3] = {0.6, 0.7, 0.8};
    add_block(s, origin, two, 1, 0);
    add_block(s, inside, one, 0.5, 1);
    check_both("a block inside another", s, TC_REENTRY_PEEL, "peeling is used");
    free(s);
}

/* Cells all linked, one part, that goes around an axis twice and meets itself. */
static void a_ring_wound_twice_is_lost(void **state)
{
    (void)state;
    enum { STEPS = 26 };
    soup *s = new_soup();
    static const int strip[3] = {STEPS, 1, 1};
    add_block(s, origin, strip, 1, 0);
    for (size_t v = 0; v < s->n_vertex; v++) {
        double *p = s->vertex[v], angle = p[0] * 2 * 2 * 3.14159265358979 / STEPS, r = 1 + 0.5 * p[1] + 0.013 * p[0];
        double z = 0.5 * p[2] + 0.007 * p[0];
        s->scalar[v] = 3 * sin(angle * 1.5) + p[1];
        p[0] = r * cos(angle), p[1] = r * sin(angle), p[2] = z;
    }
    tc_mesh_report r = check_both("a ring wound twice", s, TC_REENTRY_PEEL, "peeling is used");
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.unlinked_faces, 0); /* nothing tells that it overlaps but TetGen */
    free(s);
}

/* Overlapping parts whose first sides lie in one plane, cut into triangles in different ways: rounding alone says which
 * is entered first, so colours are ill-posed. Opacity does not depend on the order: nothing may be lost or doubled. */
static void parts_that_begin_in_one_plane_lose_matter(void **state)
{
    (void)state;
    soup *s = new_soup();
    int32_t first;
    add_block(s, origin, two, 1, 0);
    first = add_block(s, origin, two, 1, 1);
    for (size_t v = (size_t)first; v < s->n_vertex; v++)
        s->vertex[v][0] = 2 - s->vertex[v][0]; /* the diagonals of the cubes' sides run the other way */
    tc_renderer *judge;
    const tc_renderer_options options = {.driver = "reference"};
    tc_error err = {0};
    assert_int_equal(tc_renderer_create(&judge, &options, NULL, &err), TC_OK);
    tc_mesh *mesh = mesh_of(s);
    suite_prepare(mesh, TC_REENTRY_PEEL);
    tc_transfer *tf = suite_benchmark(mesh);
    for (int i = 0; i < VIEWS; i++) {
        tc_camera camera = suite_camera(mesh, from[i][0], from[i][1], from[i][2], i % 2);
        tc_render_options render = suite_options(SIZE, SIZE);
        render.opacity_stop = 1;
        render.unit_distance = 1;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &render), *truth;
        tc_verify_result v;
        assert_int_equal(tc_verify(&v, image, SIZE_MAX, 1, mesh, tf, &camera, &render, NULL, &err), TC_OK);
        assert_int_equal(tc_render(&truth, NULL, judge, mesh, tf, &camera, &render, NULL, &err), TC_OK);
        double worst = 0;
        for (size_t k = 3; k < (size_t)4 * SIZE * SIZE; k += 4)
            worst = fmax(worst, fabs((double)image->rgba[k] - truth->rgba[k]));
        suite_say(
            "parts that begin in one plane, view %d: opacity to %.1e, colour to %.1e in well-posed rays, %zu of %zu "
            "ill-posed",
            i, worst, v.max_abs_error, v.ill_posed, v.pixels);
        assert_true(worst < 1e-4);
        assert_true(v.max_abs_error <= SUITE_HALF_STEP);
        tc_image_destroy(&image);
        tc_image_destroy(&truth);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    tc_renderer_destroy(&judge);
    free(s);
}

static void add_loose_tets(soup *s, int n, double edge, double value, uint32_t seed)
{
    uint32_t x = seed;
    for (int t = 0; t < n; t++) {
        double c[3] = {next_unit(&x), next_unit(&x), next_unit(&x)};
        int32_t v[4];
        for (int k = 0; k < 4; k++) {
            double p[3];
            for (int a = 0; a < 3; a++)
                p[a] = c[a] + edge * (next_unit(&x) - 0.5);
            v[k] = add_vertex(s, p[0], p[1], p[2], value < 0 ? 6 * next_unit(&x) - 2 : value);
        }
        add_tet(s, v[0], v[1], v[2], v[3]);
    }
}

static void loose_tets_in_a_heap_are_lost(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 2; seed++) {
        soup *s = new_soup();
        add_loose_tets(s, 60, 0.7, -1, seed);
        check_both("a heap of tets", s, TC_REENTRY_PEEL, "peeling is used");
        free(s);
    }
}

/* Length of a line in a tet: between the last entry into its faces' half spaces and the first exit. */
static double chord(const soup *s, const int32_t *tet, const double o[3], const double d[3])
{
    double in = 0, out = 1e300;
    for (int f = 0; f < 4; f++) {
        const double *a = s->vertex[tet[(f + 1) & 3]], *b = s->vertex[tet[(f + 2) & 3]],
                     *c = s->vertex[tet[(f + 3) & 3]];
        double u[3], v[3], n[3], along = 0, height = 0, side = 0;
        for (int k = 0; k < 3; k++)
            u[k] = b[k] - a[k], v[k] = c[k] - a[k];
        n[0] = u[1] * v[2] - u[2] * v[1], n[1] = u[2] * v[0] - u[0] * v[2], n[2] = u[0] * v[1] - u[1] * v[0];
        for (int k = 0; k < 3; k++)
            along += n[k] * d[k], height += n[k] * (a[k] - o[k]), side += n[k] * (s->vertex[tet[f]][k] - a[k]);
        if (side > 0)
            along = -along, height = -height; /* outwards */
        if (along < 0)
            in = fmax(in, height / along);
        else if (along > 0)
            out = fmin(out, height / along);
    }
    return out > in ? out - in : 0;
}

/* The reference left aside: with one attenuation everywhere, opacity tells the sum of all cells' chords. */
static void opacity_is_not_that_of_all_cells(void **state)
{
    (void)state;
    soup *s = new_soup();
    const double moved[3] = {0.31, 0.27, 0.4};
    add_loose_tets(s, 150, 0.5, 1, 5);
    add_block(s, moved, two, 0.3, 0);
    add_block(s, moved, two, 0.3, 0); /* merged and dropped: there once */
    add_block(s, moved, two, 0.2, 0); /* touches the first in parts of three sides */
    size_t n_tet = s->n_tet;
    for (size_t v = 0; v < s->n_vertex; v++)
        s->scalar[v] = 1;
    static const tc_knot knot[] = {{0, 1, 1, 1, 0.4}, {2, 1, 1, 1, 0.4}};
    tc_transfer *tf = suite_function(knot, 2);
    tc_mesh *mesh = mesh_of(s);
    suite_prepare(mesh, TC_REENTRY_PEEL);
    tc_mesh_report r;
    tc_mesh_get_report(&r, mesh);
    assert_int_equal(r.dropped_duplicate, 48);
    tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
    tc_render_options options = suite_options(SIZE, SIZE);
    options.unit_distance = 1;
    options.opacity_stop = 1;
    tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
    double worst = 0;
    int wrong = 0;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double o[3], d[3], sum = 0;
            suite_ray(o, d, &camera, SIZE, SIZE, x, y);
            for (size_t t = 0; t < n_tet; t++)
                if (t < 150 + 48 || t >= 150 + 96) /* the copies are one */
                    sum += chord(s, s->tet[t], o, d);
            double error = fabs(1 - exp(-0.4 * sum) - (double)image->rgba[4 * (y * SIZE + x) + 3]);
            wrong += error > 2e-5;
            worst = fmax(worst, error);
        }
    suite_say("opacity of overlapping cells: worst error %.1e, %d of %d above 2e-5", worst, wrong, SIZE * SIZE);
    assert_true(worst < 2e-5);
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    free(s);
}

static void an_eye_among_overlapping_cells_sees_another_order(void **state)
{
    (void)state;
    soup *s = new_soup();
    const double moved[3] = {0.7, 0.3, 0.1}, eye[3] = {1.21, 1.13, 0.97};
    add_block(s, origin, two, 1, 0);
    add_block(s, moved, two, 1, 1);
    add_loose_tets(s, 20, 3, -1, 9);
    tc_mesh *mesh = mesh_of(s);
    suite_prepare(mesh, TC_REENTRY_PEEL);
    for (int i = 0; i < VIEWS; i += 2) {
        tc_camera camera = suite_camera(mesh, from[i][0], from[i][1], from[i][2], false);
        for (int k = 0; k < 3; k++) {
            camera.focal_point[k] += eye[k] - camera.position[k];
            camera.position[k] = eye[k];
        }
        camera.view_angle = 70;
        check_view("eye among overlapping cells", mesh, &camera);
    }
    tc_mesh_destroy(&mesh);
    free(s);
}

/* ------------------------------------------------------------------------------------ sides that meet but do not join
 */

/* The coarse and the fine side lie in one plane and share no face: a crack of no width, which rays leave and enter at
 * one depth. */
static void hanging_nodes_show_a_crack(void **state)
{
    (void)state;
    soup *s = new_soup();
    const int four[3] = {4, 4, 4};
    const double beside[3] = {2, 0, 0}, tilt = 0.3;
    add_block(s, origin, two, 1, 0);
    add_block(s, beside, four, 0.5, 0);
    tc_mesh_report r = check_both("hanging nodes", s, TC_REENTRY_PEEL, "peeling is used");
    assert_int_equal(r.merged_vertices, 9);
    assert_int_equal(r.n_component, 2);
    for (size_t v = 0; v < s->n_vertex; v++) { /* the plane between is no longer one of coordinates' */
        double *p = s->vertex[v], x = p[0];
        p[0] = x * cos(tilt) - p[1] * sin(tilt);
        p[1] = x * sin(tilt) + p[1] * cos(tilt);
    }
    check_both("hanging nodes, tilted", s, TC_REENTRY_PEEL, "peeling is used");
    /* A field that both sides hold alike: the crack must not show at all. */
    static const tc_knot knot[] = {{-3, 0.1, 0.2, 0.9, 0.2}, {3, 0.9, 0.9, 0.2, 1.5}};
    soup *whole = new_soup();
    const int three[3] = {4, 2, 2};
    add_block(whole, origin, three, 1, 0);
    for (int i = 0; i < 2; i++) {
        soup *at = i ? s : whole;
        for (size_t v = 0; v < at->n_vertex; v++) {
            double *p = at->vertex[v], x = p[0];
            p[0] = i ? x * cos(tilt) + p[1] * sin(tilt) : x;
            p[1] = i ? p[1] * cos(tilt) - x * sin(tilt) : p[1];
            at->scalar[v] = p[0] - 2 + 0.3 * p[1] - 0.2 * p[2];
        }
    }
    tc_transfer *tf = suite_function(knot, 2);
    tc_mesh *a = mesh_of(s), *b = mesh_of(whole);
    suite_prepare(a, TC_REENTRY_PEEL);
    suite_prepare(b, TC_REENTRY_AUTO);
    for (int i = 0; i < VIEWS; i++) {
        tc_camera camera = suite_camera(b, from[i][0], from[i][1], from[i][2], i % 2);
        tc_render_options options = suite_options(SIZE, SIZE);
        options.unit_distance = 1;
        options.integrator = TC_INTEGRATOR_EXACT;
        tc_image *p = suite_render(NULL, a, tf, &camera, &options), *q = suite_render(NULL, b, tf, &camera, &options);
        double difference = suite_difference(p, q);
        suite_say("hanging nodes beside a mesh without: largest difference %.1e", difference);
        assert_true(difference < 1e-4);
        tc_image_destroy(&p);
        tc_image_destroy(&q);
    }
    tc_mesh_destroy(&a);
    tc_mesh_destroy(&b);
    tc_transfer_destroy(&tf);
    free(s);
    free(whole);
}

static void a_seam_is_crossed_wrongly(void **state)
{
    (void)state;
    soup *s = new_soup();
    const double beside[3] = {2, 0, 0};
    add_block(s, origin, two, 1, 0);
    add_block(s, beside, two, 1, 1);
    tc_mesh_report r = check_both("a seam", s, TC_REENTRY_PEEL, "peeling is used");
    assert_int_equal(r.merged_vertices, 0);
    assert_int_equal(r.n_component, 2);
    for (size_t v = 0; v < s->n_vertex; v++) /* the same with values that agree: one mesh */
        s->scalar[v] = smooth(s->vertex[v]);
    r = check_both("a closed seam", s, TC_REENTRY_CONVEXIFY, NULL);
    assert_int_equal(r.merged_vertices, 9);
    assert_int_equal(r.n_component, 1);
    assert_true(r.convex);
    free(s);
}

/* A ring of eight blocks, all joined but the last to the first. */
static void a_boundary_that_touches_itself_is_crossed_wrongly(void **state)
{
    (void)state;
    static const double at[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    soup *s = new_soup();
    for (int b = 0; b < 8; b++) {
        const double corner[3] = {at[b][0], at[b][1], 0};
        int32_t first = add_block(s, corner, one, 1, 0);
        for (int32_t v = first; v < first + 8; v++)
            if (b == 7 && s->vertex[v][1] < 1.5)
                s->scalar[v] += 0.5; /* the seam between the last and the first */
    }
    tc_mesh_report r = check_both("a ring that touches itself", s, TC_REENTRY_PEEL, "peeling is used");
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.unlinked_faces, 0);
    free(s);

    s = new_soup(); /* blocks that meet in edges and in a vertex alone */
    for (int b = 0; b < 4; b++) {
        static const double place[4][3] = {{0, 0, 0}, {1, 1, 0}, {0, 1, 1}, {2, 2, 1}};
        add_block(s, place[b], one, 1, 0);
    }
    r = check_both("blocks that meet in edges", s, TC_REENTRY_CONVEXIFY, NULL);
    assert_int_equal(r.n_component, 4);
    free(s);
}

/* Two blocks at less and less distance: the gap's two sides are told apart as long as their coordinates are. */
static void thin_gaps_are_crossed_wrongly(void **state)
{
    (void)state;
    static const double gap[] = {1e-3, 1e-6, 3e-8, 1e-10, 1e-14};
    for (size_t i = 0; i < sizeof gap / sizeof *gap; i++) {
        char what[64];
        soup *s = new_soup();
        const double beside[3] = {2 + gap[i], 0, 0};
        add_block(s, origin, two, 1, 0);
        add_block(s, beside, two, 1, 1);
        for (size_t v = 0; v < s->n_vertex; v++) { /* no side along an axis */
            double *p = s->vertex[v], x = p[0];
            p[0] = 0.8 * x - 0.6 * p[2];
            p[2] = 0.6 * x + 0.8 * p[2];
        }
        tc_mesh *mesh = mesh_of(s);
        suite_prepare(mesh, TC_REENTRY_PEEL);
        snprintf(what, sizeof what, "a gap of %g", gap[i]);
        check_views(what, mesh);
        tc_mesh_destroy(&mesh);
        free(s);
    }
}

/* --------------------------------------------------------------------------------------- cells that are dropped or
 * turned */

static void broken_cells_change_the_picture(void **state)
{
    (void)state;
    soup *s = new_soup(), *plain = new_soup();
    add_block(plain, origin, two, 1, 0);
    add_block(s, origin, two, 1, 0);
    for (size_t t = 0; t < 48; t += 3) { /* copies, with their corners in another order */
        const int32_t *v = s->tet[t];
        add_tet(s, v[2], v[0], v[3], v[1]);
    }
    for (size_t t = 0; t < 48; t += 2) { /* inside out */
        int32_t *v = s->tet[t], k = v[0];
        v[0] = v[1], v[1] = k;
    }
    add_tet(s, 0, 1, 2, 2);
    add_tet(s, 5, 5, 5, 5);
    int32_t again = add_vertex(s, 1, 0, 0, smooth((const double[3]){1, 0, 0})); /* where 1 is */
    add_tet(s, 0, 1, 3, again);
    add_tet(s, 0, 1, 3, 4); /* flat, on the side z = 0; its faces are partly those of cells there */
    int32_t bad = add_vertex(s, NAN, 0, 0, 1);
    add_tet(s, 0, 1, 3, bad);
    tc_mesh_report r = check_both("broken cells", s, TC_REENTRY_CONVEXIFY, "16 cells are there more than once");
    assert_int_equal(r.dropped_duplicate, 16);
    assert_int_equal(r.dropped_degenerate, 3);
    assert_int_equal(r.dropped_nonfinite, 1);
    assert_int_equal(r.zero_volume, 1);
    assert_int_equal(r.merged_vertices, 1);
    assert_int_equal(r.n_tet, 49);
    tc_mesh *a = mesh_of(s), *b = mesh_of(plain);
    suite_prepare(a, TC_REENTRY_PEEL);
    suite_prepare(b, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(b);
    tc_camera camera = suite_camera(b, 1, 0.7, 0.4, false);
    tc_render_options options = suite_options(SIZE, SIZE);
    options.unit_distance = 1;
    tc_image *p = suite_render(NULL, a, tf, &camera, &options), *q = suite_render(NULL, b, tf, &camera, &options);
    double difference = suite_difference(p, q);
    suite_say("broken cells beside the mesh without: largest difference %.1e", difference);
    assert_true(difference < 1e-5);
    tc_image_destroy(&p);
    tc_image_destroy(&q);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&a);
    tc_mesh_destroy(&b);
    free(s);
    free(plain);
}

/* Nothing is left: a sentence, not a picture. */
static void a_mesh_of_broken_cells_alone_is_rendered(void **state)
{
    (void)state;
    soup *s = new_soup();
    for (int v = 0; v < 4; v++)
        add_vertex(s, v == 1, v == 2, v == 3 ? NAN : 0, v);
    add_tet(s, 0, 1, 2, 3);
    add_tet(s, 0, 1, 1, 2);
    tc_mesh *mesh = mesh_of(s);
    tc_error err = {0};
    assert_int_equal(tc_mesh_prepare(mesh, NULL, NULL, &err), TC_E_MESH);
    assert_non_null(strstr(err.text, "none of the 2 tetrahedra can be rendered"));
    tc_mesh_destroy(&mesh);
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
    tc_mesh *mesh = mesh_of(s);
    suite_prepare(mesh, TC_REENTRY_PEEL);
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
        cmocka_unit_test(a_face_of_three_cells_breaks_the_walk),
        cmocka_unit_test(two_cells_on_one_side_break_the_walk),
        cmocka_unit_test(many_cells_on_many_faces_break_the_walk),
        cmocka_unit_test(overlapping_blocks_lose_matter),
        cmocka_unit_test(one_block_in_another_is_lost),
        cmocka_unit_test(a_block_inside_another_is_lost),
        cmocka_unit_test(a_ring_wound_twice_is_lost),
        cmocka_unit_test(parts_that_begin_in_one_plane_lose_matter),
        cmocka_unit_test(loose_tets_in_a_heap_are_lost),
        cmocka_unit_test(opacity_is_not_that_of_all_cells),
        cmocka_unit_test(an_eye_among_overlapping_cells_sees_another_order),
        cmocka_unit_test(hanging_nodes_show_a_crack),
        cmocka_unit_test(a_seam_is_crossed_wrongly),
        cmocka_unit_test(a_boundary_that_touches_itself_is_crossed_wrongly),
        cmocka_unit_test(thin_gaps_are_crossed_wrongly),
        cmocka_unit_test(broken_cells_change_the_picture),
        cmocka_unit_test(a_mesh_of_broken_cells_alone_is_rendered),
        cmocka_unit_test(thin_plates_are_seen_in_the_order_of_the_file),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
