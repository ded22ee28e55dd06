/* test_mesh_convexity.c: which closed surfaces are called convex (mesh/boundary.c): narrow faces, flat faces, dents of
 * known depth, surfaces that go around themselves. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/boundary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A surface under construction: points and faces, counter-clockwise seen from outside. */
typedef struct surface {
    size_t n_vertex, n_face;
    double *vertex;
    int32_t *face;
} surface;

static surface surface_of(size_t vertices, size_t faces)
{
    surface s = {.vertex = malloc(3 * vertices * sizeof(double)), .face = malloc(3 * faces * sizeof(int32_t))};
    assert_true(s.vertex && s.face);
    return s;
}

static int32_t point(surface *s, double x, double y, double z)
{
    double *p = s->vertex + 3 * s->n_vertex;
    p[0] = x, p[1] = y, p[2] = z;
    return (int32_t)s->n_vertex++;
}

static void face(surface *s, size_t a, size_t b, size_t c)
{
    int32_t *f = s->face + 3 * s->n_face++;
    f[0] = (int32_t)a, f[1] = (int32_t)b, f[2] = (int32_t)c;
}

static void finish(surface *s)
{
    free(s->vertex);
    free(s->face);
}

typedef struct half {
    int32_t lo, hi;
    int64_t id;
} half;

static int half_compare(const void *a, const void *b)
{
    const half *p = a, *q = b;
    if (p->lo != q->lo)
        return p->lo < q->lo ? -1 : 1;
    return p->hi != q->hi ? (p->hi < q->hi ? -1 : 1) : 0;
}

/* tolerance < 0: what rounding explains. */
static bool is_convex(const surface *s, double tolerance)
{
    tc_boundary b = {.n_face = s->n_face, .n_vertex = s->n_vertex, .face = s->face, .n_component = 1};
    half *edge = malloc(3 * s->n_face * sizeof *edge);
    b.vertex = malloc(s->n_vertex * sizeof *b.vertex);
    b.across = malloc(3 * s->n_face * sizeof *b.across);
    assert_true(edge && b.vertex && b.across);
    for (size_t v = 0; v < s->n_vertex; v++)
        b.vertex[v] = (int32_t)v;
    for (size_t i = 0; i < 3 * s->n_face; i++) {
        int32_t p = s->face[i], q = s->face[i % 3 == 2 ? i - 2 : i + 1];
        edge[i] = (half){p < q ? p : q, p < q ? q : p, (int64_t)i};
    }
    qsort(edge, 3 * s->n_face, sizeof *edge, half_compare);
    for (size_t i = 0; i < 3 * s->n_face; i += 2) { /* closed: each edge has two faces */
        assert_int_equal(half_compare(&edge[i], &edge[i + 1]), 0);
        assert_true(i + 2 == 3 * s->n_face || half_compare(&edge[i], &edge[i + 2]) != 0);
        assert_true(s->face[edge[i].id] != s->face[edge[i + 1].id]); /* in opposite senses */
        b.across[edge[i].id] = edge[i + 1].id, b.across[edge[i + 1].id] = edge[i].id;
    }
    double bounds[6] = {INFINITY, -INFINITY, INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (size_t i = 0; i < 3 * s->n_vertex; i++) {
        bounds[2 * (i % 3)] = fmin(bounds[2 * (i % 3)], s->vertex[i]);
        bounds[2 * (i % 3) + 1] = fmax(bounds[2 * (i % 3) + 1], s->vertex[i]);
    }
    bool convex = tc_boundary_is_convex(&b, s->vertex, tolerance < 0 ? tc_boundary_rounding(bounds) : tolerance);
    free(edge);
    free(b.vertex);
    free(b.across);
    return convex;
}

/* Turns by an angle that no coordinate likes, scales and moves. */
static void turn(surface *s, double size, double offset)
{
    for (size_t v = 0; v < s->n_vertex; v++) {
        double *p = s->vertex + 3 * v, c = cos(1.0), w = sin(1.0);
        double x = c * p[0] - w * p[1], y = w * p[0] + c * p[1];
        p[0] = x * size + offset, p[1] = (c * y - w * p[2]) * size + offset, p[2] = (w * y + c * p[2]) * size + offset;
    }
}

/* Two pyramids over a polygon: corner i is radius[i] away at angle 2 pi turns i / n. */
static surface bipyramid(size_t n, int turns, const double *radius, double top)
{
    surface s = surface_of(n + 2, 2 * n);
    for (size_t i = 0; i < n; i++) {
        double angle = 2 * acos(-1) * turns * (double)i / (double)n, r = radius ? radius[i] : 1;
        point(&s, r * cos(angle), r * sin(angle), 0);
    }
    point(&s, 0, 0, -1);
    point(&s, 0, 0, top);
    for (size_t i = 0; i < n; i++) {
        face(&s, i, (i + 1) % n, n + 1); /* corners in any order: planes are rounded otherwise */
        face(&s, n, (i + 1) % n, i);
    }
    return s;
}

static const double frame[][2] = {{1, 0}, {1e-30, 0}, {1e30, 0}, {1, 1e5}};
enum { FRAMES = sizeof frame / sizeof frame[0] };

static void thousands_of_narrow_faces_around_a_vertex_are_a_dent(void **state)
{
    (void)state;
    static const size_t n[] = {3, 4, 100, 3000, 10000, 20000};
    for (size_t i = 0; i < sizeof n / sizeof n[0]; i++)
        for (int f = 0; f < FRAMES; f++) {
            surface s = bipyramid(n[i], 1, NULL, 1);
            if (f > 0)
                turn(&s, frame[f][0], frame[f][1]);
            assert_true(is_convex(&s, -1));
            finish(&s);
        }
}

/* A corner of the polygon on the line between its neighbours, and a little to both sides. */
static void a_dent_among_narrow_faces_is_missed(void **state)
{
    (void)state;
    for (size_t n = 10; n <= 1000; n *= 10)
        for (int side = -1; side <= 1; side += 2) {
            double *radius = malloc(n * sizeof *radius), flat = cos(2 * acos(-1) / (double)n);
            assert_non_null(radius);
            for (size_t i = 0; i < n; i++)
                radius[i] = i == n / 3 ? flat + side * 2e-13 : 1;
            surface s = bipyramid(n, 1, radius, 1);
            assert_true(is_convex(&s, -1) == (side > 0));
            assert_true(is_convex(&s, 1e-10)); /* less deep than that */
            turn(&s, 1, 0);
            assert_true(is_convex(&s, -1) == (side > 0));
            finish(&s);
            free(radius);
        }
}

/* A lid of n triangles around its middle, flat but for rounding, on a cone; the middle then goes up or down. */
static void a_flat_fan_that_rounding_dents_is_a_dent(void **state)
{
    (void)state;
    static const double move[] = {0, 1e-9, -1e-9};
    for (size_t n = 5; n <= 20000; n *= 63)
        for (int k = 0; k < 3; k++)
            for (int f = 0; f < FRAMES - (k > 0); f++) {
                surface s = bipyramid(n, 1, NULL, move[k]);
                turn(&s, frame[f][0], frame[f][1]);
                if (is_convex(&s, -1) != (k != 2))
                    fail_msg("%zu faces, their middle moved by %g, frame %d", n, move[k], f);
                finish(&s);
            }
}

/* A cube, each face four triangles around its middle, which is moved out by `out`. */
static surface star(double out)
{
    surface s = surface_of(17, 30);
    for (int c = 0; c < 8; c++)
        point(&s, c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1);
    static const uint8_t around[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (size_t side = 0; side < 6; side++) {
        double x[3] = {0, 0, 0};
        x[side / 2] = (side % 2 ? 1 : -1) * (1 + out);
        int32_t middle = point(&s, x[0], x[1], x[2]);
        for (int k = 0; k < 4; k++)
            face(&s, around[side][k], around[side][(k + 1) % 4], (size_t)middle);
    }
    return s;
}

static void a_star_is_convex_or_a_cube_is_not(void **state)
{
    (void)state;
    static const struct {
        double out;
        bool convex;
    } list[] = {{0, true},     {0.2, true},     {1e-9, true},   {0.999, true}, /* at 1 the cube's edges become flat */
                {1.01, false}, {-1e-12, false}, {-1e-9, false}, {-0.3, false},
                {-0.9, false}, {1e-16, true},   {-1e-16, true}};
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++)
        for (int f = 0; f < FRAMES - 1; f++) {
            surface s = star(list[i].out);
            turn(&s, frame[f][0], frame[f][1]);
            if (is_convex(&s, -1) != list[i].convex)
                fail_msg("faces moved out by %g, frame %d: convex is not %d", list[i].out, f, list[i].convex);
            finish(&s);
        }
    surface s = star(-1e-9); /* twelve dents */
    assert_true(is_convex(&s, 1e-8));
    assert_false(is_convex(&s, 1e-10));
    finish(&s);
}

/* No edge of these is reflex. */
static void a_surface_wound_twice_is_convex(void **state)
{
    (void)state;
    for (size_t n = 5; n < 2000; n = 3 * n + 2)
        for (int turns = 2; turns < 4; turns++) {
            surface s = bipyramid(n, turns, NULL, 1);
            assert_false(is_convex(&s, -1));
            finish(&s);
        }
    /* a large loop with a small one within (limaçon), the tips over the small one: the middle lies beside it, where the
     * surface goes around once */
    for (int n = 7; n < 100; n++) {
        surface t = bipyramid((size_t)n, 1, NULL, 1);
        for (int i = 0; i < n; i++) {
            double angle = 2 * acos(-1) * (i + 0.5) / n, radius = 1 + 1.4 * cos(angle);
            t.vertex[3 * i] = radius * cos(angle), t.vertex[3 * i + 1] = radius * sin(angle);
        }
        t.vertex[3 * n] = t.vertex[3 * n + 3] = 0.2;
        assert_false(is_convex(&t, -1));
        finish(&t);
    }
}

/* Cuts face f into three at a point of the cube's top. */
static void cut_top(surface *s, size_t f, double x, double y)
{
    int32_t *v = s->face + 3 * f;
    size_t inner = (size_t)point(s, x, y, 1);
    face(s, (size_t)v[1], (size_t)v[2], inner);
    face(s, (size_t)v[2], (size_t)v[0], inner);
    v[2] = (int32_t)inner;
}

/* Three vertices within the top of a cube, the last one then moved in the plane over a next triangle. */
static void a_lid_folded_in_its_plane_is_convex(void **state)
{
    (void)state;
    for (int folded = 0; folded < 2; folded++)
        for (int f = 0; f < FRAMES - 1; f++) {
            surface s = star(0);
            cut_top(&s, s.n_face - 4, 0, -0.5);                     /* (-1, -1), (1, -1), (0, 0) */
            cut_top(&s, s.n_face - 1, -0.3, -0.45);                 /* (0, 0), (-1, -1), (0, -0.5) */
            cut_top(&s, s.n_face - 1, folded ? 0.1 : -0.1, -0.315); /* (0, -0.5), (0, 0), (-0.3, -0.45) */
            if (f > 0)
                turn(&s, frame[f][0], frame[f][1]);
            assert_true(is_convex(&s, -1) == !folded);
            finish(&s);
        }
}

/* Two walls that meet in a re-entrant edge, which a narrow wall cuts off. */
static void a_narrow_face_hides_a_reflex_edge(void **state)
{
    (void)state;
    static const double width[] = {0.1, 1e-3, 1e-9, 1e-12, 1e-15};
    for (size_t i = 0; i < sizeof width / sizeof width[0]; i++)
        for (int f = 0; f < 2; f++) {
            double w = width[i];
            const double wall[][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1 + w, 1}, {1, 1 + w}, {1, 2}, {0, 2}, {0, 1}};
            enum { n = sizeof wall / sizeof wall[0] };
            surface s = surface_of(2 * n + 2, 4 * n);
            for (int k = 0; k < 2 * n; k++)
                point(&s, wall[k % n][0], wall[k % n][1], k / n);
            point(&s, 0.5, 0.5, 0);
            point(&s, 0.5, 0.5, 1);
            for (size_t k = 0; k < n; k++) {
                size_t l = (k + 1) % n;
                face(&s, k, l, n + k);
                face(&s, n + l, n + k, l);
                face(&s, l, k, 2 * n);
                face(&s, n + k, n + l, 2 * n + 1);
            }
            if (f > 0)
                turn(&s, 1, 0);
            assert_false(is_convex(&s, -1));
            assert_false(is_convex(&s, 1e-7));
            finish(&s);
        }
}

/* The same edge behind a strip of more narrow walls than are looked at. */
static void many_narrow_faces_hide_a_reflex_edge(void **state)
{
    (void)state;
    enum { STRIP = 50, n = STRIP + 9 };
    const double w = 1e-9;
    double wall[n][2] = {{0, 1}, {0, 0}, {1, 0}, {2, 0}, {2, 1}};
    for (int k = 0; k <= STRIP; k++)
        wall[5 + k][0] = 1 + w * (STRIP - k) / STRIP, wall[5 + k][1] = 1 + w * k / STRIP;
    wall[n - 3][0] = 1, wall[n - 3][1] = 2;
    wall[n - 2][0] = 0.5, wall[n - 2][1] = 2;
    wall[n - 1][0] = 0, wall[n - 1][1] = 2;
    surface s = surface_of(2 * n + 2, 4 * n);
    for (int k = 0; k < 2 * n; k++)
        point(&s, wall[k % n][0], wall[k % n][1], k / n);
    point(&s, 0.5, 0.5, 0);
    point(&s, 0.5, 0.5, 1);
    for (size_t k = 0; k < n; k++) {
        size_t l = (k + 1) % n;
        face(&s, k, l, n + k);
        face(&s, n + l, n + k, l);
        face(&s, l, k, 2 * n);
        face(&s, n + k, n + l, 2 * n + 1);
    }
    assert_false(is_convex(&s, 1e-7));
    finish(&s);
}

/* A smooth body of squares stretched: faces narrow in all ways, squares flat but for rounding. */
static void stretching_a_convex_body_dents_it(void **state)
{
    (void)state;
    enum { n = 40 };
    static const double by[][3] = {{1, 1, 1}, {1e-4, 1, 1}, {1, 1, 1e-4}, {1e-3, 1, 1e3}, {1e3, 1, 1e-3}};
    for (size_t i = 0; i < sizeof by / sizeof by[0]; i++)
        for (int f = 0; f < FRAMES; f++) {
            surface s = surface_of(n * n + 2, 2 * n * n);
            for (int k = 0; k < n; k++)
                for (int j = 0; j < n; j++) {
                    double up = acos(-1) * (k + 1) / (n + 1), around = 2 * acos(-1) * j / n;
                    point(&s, sin(up) * cos(around) * by[i][0], sin(up) * sin(around) * by[i][1], -cos(up) * by[i][2]);
                }
            size_t low = (size_t)point(&s, 0, 0, -by[i][2]), high = (size_t)point(&s, 0, 0, by[i][2]);
            for (size_t j = 0; j < n; j++) {
                size_t l = (j + 1) % n;
                face(&s, l, j, low);
                face(&s, (n - 1) * n + j, (n - 1) * n + l, high);
                for (size_t k = 0; k + 1 < n; k++) {
                    face(&s, n * k + j, n * k + l, n * (k + 1) + j);
                    face(&s, n * (k + 1) + l, n * (k + 1) + j, n * k + l);
                }
            }
            if (f > 0)
                turn(&s, frame[f][0], frame[f][1]);
            if (!is_convex(&s, -1))
                fail_msg("stretched by %g, %g, %g, frame %d: not convex", by[i][0], by[i][1], by[i][2], f);
            finish(&s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thousands_of_narrow_faces_around_a_vertex_are_a_dent),
        cmocka_unit_test(a_dent_among_narrow_faces_is_missed),
        cmocka_unit_test(a_flat_fan_that_rounding_dents_is_a_dent),
        cmocka_unit_test(a_star_is_convex_or_a_cube_is_not),
        cmocka_unit_test(a_surface_wound_twice_is_convex),
        cmocka_unit_test(a_lid_folded_in_its_plane_is_convex),
        cmocka_unit_test(a_narrow_face_hides_a_reflex_edge),
        cmocka_unit_test(many_narrow_faces_hide_a_reflex_edge),
        cmocka_unit_test(stretching_a_convex_body_dents_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
