/* test_mesh_convexify.c: imaginary cells between a mesh and its convex hull. Needs the helper tetcast-convexify. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh_shapes.h"

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

typedef bool keep_function(int i, int j, int k);

static void end(tc_mesh **m, shape *s)
{
    tc_mesh_destroy(m);
    shape_finish(s);
}

static double imaginary_volume(const tc_mesh *m)
{
    double sum = 0;
    for (size_t t = m->n_tet; t < m->n_tet + m->n_imaginary; t++) {
        double six = shape_volume6(m, m->tet + 4 * t);
        assert_true(six >= -1e-12);
        sum += six / 6;
    }
    return sum;
}

/* Along a generic line, every point of the hull lies in exactly one cell: entries and exits of cells pair up. */
static double chord(const tc_mesh *m, size_t begin, size_t end_, const double *o, const double *d)
{
    static const uint8_t face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    double sum = 0;
    for (size_t t = begin; t < end_; t++) {
        double in = -INFINITY, out = INFINITY;
        for (int f = 0; f < 4; f++) {
            const double *p[3];
            double u[3], v[3], n[3];
            for (int i = 0; i < 3; i++)
                p[i] = m->vertex + 3 * (size_t)m->tet[4 * t + face[f][i]];
            for (int k = 0; k < 3; k++)
                u[k] = p[1][k] - p[0][k], v[k] = p[2][k] - p[0][k];
            n[0] = u[1] * v[2] - u[2] * v[1], n[1] = u[2] * v[0] - u[0] * v[2], n[2] = u[0] * v[1] - u[1] * v[0];
            double along = 0, height = 0;
            for (int k = 0; k < 3; k++)
                along += n[k] * d[k], height += n[k] * (p[0][k] - o[k]);
            if (along < 0)
                in = fmax(in, height / along);
            else if (along > 0)
                out = fmin(out, height / along);
            else if (height < 0)
                out = -INFINITY;
        }
        if (out > in)
            sum += out - in;
    }
    return sum;
}

/* Real and imaginary cells cover [0, size] x … once: chords add up to the box's on a bundle of lines along z. */
static void check_covers_box_once(const tc_mesh *m, const double *bounds)
{
    for (int i = 1; i < 12; i++) {
        double o[3] = {bounds[0] + (bounds[1] - bounds[0]) * (i * 0.0811 + 0.0123),
                       bounds[2] + (bounds[3] - bounds[2]) * (0.9871 - i * 0.0767), 0};
        const double d[3] = {0, 0, 1};
        double c = chord(m, 0, m->n_tet + m->n_imaginary, o, d);
        assert_true(fabs(c - (bounds[5] - bounds[4])) < 1e-9 * (bounds[5] - bounds[4]));
    }
}

/* No face of a real cell is open inside the box. */
static void check_open_faces_lie_on_box(const tc_mesh *m, const double *bounds)
{
    size_t open = 0;
    for (size_t i = 0; i < 4 * (m->n_tet + m->n_imaginary); i++) {
        if (m->neighbour[i] >= 0)
            continue;
        bool flat = false;
        open++;
        for (int side = 0; side < 6; side++) {
            bool on = true;
            for (size_t c = 0; c < 4; c++)
                on = on &&
                     (c == i % 4 || m->vertex[3 * (size_t)m->tet[i / 4 * 4 + c] + (size_t)side / 2] == bounds[side]);
            flat = flat || on;
        }
        assert_true(flat);
    }
    assert_true(open > 0);
}

static bool comb(int i, int j, int k)
{
    return j == 0 || i % 2 == 0 || (k == 0 && j < 3);
}

static bool cavity(int i, int j, int k)
{
    return !(i > 0 && i < 4 && j > 0 && j < 4 && k > 0 && k < 4);
}

static bool nested_shells(int i, int j, int k)
{
    int a = abs(i - 4), b = abs(j - 4), c = abs(k - 4);
    int far = a > b ? a : b;
    return (far > c ? far : c) % 2 == 0;
}

static bool hole(int i, int j, int k)
{
    (void)k;
    return !(i > 1 && i < 4 && j > 1 && j < 4);
}

static bool ends_apart(int i, int j, int k)
{
    (void)j, (void)k;
    return i != 2;
}

static bool touching_along_an_edge(int i, int j, int k)
{
    (void)k;
    return (i < 2) == (j < 2);
}

static void gaps_up_to_the_hull_are_filled(void **state)
{
    (void)state;
    static const struct {
        keep_function *keep;
        int n[3], components;
    } list[] = {{comb, {7, 4, 3}, 1}, {cavity, {5, 5, 5}, 1},     {nested_shells, {9, 9, 9}, 3},
                {hole, {6, 6, 2}, 1}, {ends_apart, {5, 3, 3}, 2}, {touching_along_an_edge, {4, 4, 2}, 2}};
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        shape s = {0};
        shape_grid(&s, list[i].n, list[i].keep);
        size_t cells = s.n_tet / 6;
        double box = list[i].n[0] * list[i].n[1] * list[i].n[2];
        tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
        tc_mesh_report r = shape_prepare(m, TC_REENTRY_CONVEXIFY);
        shape_check_promises(m);
        assert_int_equal(r.reentry, TC_REENTRY_CONVEXIFY);
        assert_string_equal(r.reentry_why, "");
        assert_false(r.convex);
        assert_int_equal(r.n_component, list[i].components);
        assert_int_equal(r.n_tet, s.n_tet);
        assert_int_equal(r.n_imaginary, m->n_imaginary);
        assert_int_equal(r.n_vertex + r.n_steiner, m->n_vertex);
        assert_true(fabs(r.volume - (double)cells) < 1e-9);
        if (list[i].keep != touching_along_an_edge) { /* whose hull is no box */
            assert_true(fabs(imaginary_volume(m) - (box - (double)cells)) < 1e-9);
            check_open_faces_lie_on_box(m, r.bounds);
            check_covers_box_once(m, r.bounds);
        }
        for (size_t v = r.n_vertex; v < m->n_vertex; v++)
            assert_true(m->scalar[v] == 0);
        end(&m, &s);
    }
}

static bool touching_in_a_vertex(int i, int j, int k)
{
    return (i < 2) == (j < 2) && (i < 2) == (k < 2);
}

static void rotate_and_round(shape *s, bool to_float)
{
    for (size_t v = 0; v < s->n_vertex; v++) {
        double *p = s->vertex + 3 * v, x = 0.8 * p[0] - 0.6 * p[1], y = 0.6 * p[0] + 0.8 * p[1];
        p[0] = x, p[1] = 0.28 * y - 0.96 * p[2], p[2] = 0.96 * y + 0.28 * p[2];
        for (int k = 0; k < 3 && to_float; k++)
            p[k] = (float)p[k];
    }
}

/* Sides that are flat but for rounding make slivers of almost no volume: they must link and not fold. */
static void sides_flat_to_rounding_do_not_prevent_filling(void **state)
{
    (void)state;
    keep_function *list[] = {NULL, comb, cavity, touching_in_a_vertex};
    const double size[][2] = {{1, 0}, {1e-30, 0}, {1e30, 0}, {1, 1e7}};
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++)
        for (size_t j = 0; j < 5; j++) {
            shape s = {0};
            const int n[3] = {5, 5, 5};
            shape_grid(&s, n, list[i]);
            rotate_and_round(&s, j == 4);
            for (size_t k = 0; k < 3 * s.n_vertex; k++)
                s.vertex[k] = j < 4 ? s.vertex[k] * size[j][0] + size[j][1] : s.vertex[k];
            tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
            tc_mesh_report r = shape_prepare(m, TC_REENTRY_AUTO);
            shape_check_promises(m);
            assert_int_equal(r.reentry, TC_REENTRY_CONVEXIFY);
            assert_true(r.convex == (!list[i] && j < 4));
            end(&m, &s);
        }
}

static void a_convex_mesh_needs_no_helper(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {3, 4, 5};
    shape_grid(&s, n, NULL);
    for (size_t k = 0; k < 3 * s.n_vertex; k++)
        s.vertex[k] = s.vertex[k] / 3 + 1e5;
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_CONVEXIFY);
    assert_true(r.convex);
    assert_int_equal(r.reentry, TC_REENTRY_CONVEXIFY);
    assert_int_equal(r.n_imaginary, 0);
    end(&m, &s);
}

/* Tets around one edge, their outer vertices at equal steps around it `turns` times. */
static tc_mesh_report prepare_fan(int n, int turns)
{
    shape s = {0};
    int32_t low = shape_vertex(&s, 0, 0, -1), high = shape_vertex(&s, 0, 0, 1);
    for (int i = 0; i < n; i++)
        shape_vertex(&s, cos(2 * acos(-1) * turns * i / n), sin(2 * acos(-1) * turns * i / n), 0);
    for (int i = 0; i < n; i++)
        shape_tet(&s, low, 2 + i, 2 + (i + 1) % n, high);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    end(&m, &s);
    return r;
}

static void a_fan_of_thousands_has_gaps_and_one_around_twice_has_none(void **state)
{
    (void)state;
    assert_true(prepare_fan(5, 1).convex);
    assert_true(prepare_fan(3000, 1).convex);
    assert_true(prepare_fan(20000, 1).convex);
    assert_false(prepare_fan(5, 2).convex);
    assert_false(prepare_fan(1001, 2).convex);
}

static bool notched(int i, int j, int k)
{
    (void)k;
    return i > 0 || j > 0;
}

static bool teeth(int i, int j, int k)
{
    (void)j;
    return i % 2 == 0 || k == 0;
}

/* 6400 faces and few folds; as many with folds, which would be peeled many times. */
static void one_picture_waits_for_gaps_or_many_are_peeled(void **state)
{
    (void)state;
    static const struct {
        int n[3];
        bool (*keep)(int i, int j, int k);
        size_t pixels;
        tc_reentry asked, got;
    } list[] = {{{40, 40, 1}, notched, 100, TC_REENTRY_AUTO, TC_REENTRY_PEEL},
                {{40, 40, 1}, notched, 100, TC_REENTRY_CONVEXIFY, TC_REENTRY_CONVEXIFY},
                {{40, 40, 1}, notched, 4000000, TC_REENTRY_AUTO, TC_REENTRY_CONVEXIFY},
                {{20, 20, 1}, notched, 100, TC_REENTRY_AUTO, TC_REENTRY_CONVEXIFY},
                {{40, 8, 12}, teeth, 100, TC_REENTRY_AUTO, TC_REENTRY_CONVEXIFY}};
    for (size_t c = 0; c < sizeof list / sizeof *list; c++) {
        shape s = {0};
        tc_error err = {0};
        shape_grid(&s, list[c].n, list[c].keep);
        tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
        tc_prepare_options once = {.reentry = list[c].asked, .once_pixels = list[c].pixels};
        assert_int_equal(tc_mesh_prepare(m, &once, NULL, &err), TC_OK);
        tc_mesh_report r;
        tc_mesh_get_report(&r, m);
        assert_int_equal(r.reentry, list[c].got);
        assert_int_equal(r.reentry_why[0] != 0, list[c].asked == TC_REENTRY_AUTO && list[c].got == TC_REENTRY_PEEL);
        assert_int_equal(shape_prepare(m, TC_REENTRY_AUTO).reentry, TC_REENTRY_CONVEXIFY);
        shape_check_promises(m);
        end(&m, &s);
    }
}

static void another_reentry_redoes_only_the_gaps(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {7, 4, 3};
    shape_grid(&s, n, comb);
    double *scalar = malloc(s.n_vertex * sizeof *scalar);
    assert_non_null(scalar);
    for (size_t v = 0; v < s.n_vertex; v++)
        scalar[v] = s.vertex[3 * v];
    tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
    tc_mesh_report peeled = shape_prepare(m, TC_REENTRY_PEEL);
    assert_int_equal(peeled.n_imaginary, 0);
    uint64_t serial = m->serial;
    shape_prepare(m, TC_REENTRY_PEEL);
    assert_true(m->serial == serial); /* nothing to do */
    size_t bytes = m->n_tet * 4 * sizeof *m->tet;
    int32_t *tet = malloc(bytes), *neighbour = malloc(bytes);
    assert_true(tet && neighbour);
    memcpy(tet, m->tet, bytes);
    memcpy(neighbour, m->neighbour, bytes);
    tc_mesh_report filled = shape_prepare(m, TC_REENTRY_CONVEXIFY);
    shape_check_promises(m);
    assert_true(filled.n_imaginary > 0);
    assert_true(m->serial != serial);
    assert_memory_equal(tet, m->tet, bytes);
    serial = m->serial;
    shape_prepare(m, TC_REENTRY_AUTO);
    assert_true(m->serial == serial); /* filled already */
    shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(m->n_imaginary, 0);
    assert_int_equal(m->n_vertex, peeled.n_vertex);
    assert_memory_equal(tet, m->tet, bytes);
    assert_memory_equal(neighbour, m->neighbour, bytes);
    assert_int_equal(tc_mesh_set_scalar(m, scalar, TC_POINT_DATA, NULL), TC_OK);
    free(tet);
    free(neighbour);
    free(scalar);
    end(&m, &s);
}

/* A folder for a helper of our own, found before the real one; the teardown makes it the real one again. */
typedef struct fake {
    char folder[64], path[128], before[4096];
} fake;

static int fake_setup(void **state)
{
    fake *f = calloc(1, sizeof *f);
    if (!f)
        return -1;
    const char *before = getenv("TETCAST_HELPERS");
    snprintf(f->before, sizeof f->before, "%s", before ? before : "");
    snprintf(f->folder, sizeof f->folder, "/tmp/tetcast-test-XXXXXX");
    *state = f;
    if (!mkdtemp(f->folder))
        return -1;
    snprintf(f->path, sizeof f->path, "%s/tetcast-convexify", f->folder);
    return setenv("TETCAST_HELPERS", f->folder, 1);
}

static int fake_teardown(void **state)
{
    fake *f = *state;
    unlink(f->path);
    rmdir(f->folder);
    setenv("TETCAST_HELPERS", f->before, 1);
    free(f);
    return 0;
}

static void fake_write(const fake *f, const char *script)
{
    FILE *file = fopen(f->path, "w");
    assert_non_null(file);
    fprintf(file, "#!/bin/sh\n%s\n", script);
    fclose(file);
    assert_int_equal(chmod(f->path, 0755), 0);
}

static void a_helper_that_dies_or_hangs_means_peeling(void **state)
{
    shape s = {0};
    const int n[3] = {3, 3, 2};
    shape_grid(&s, n, comb);
    static const char *const script[2] = {"kill -s SEGV $$", "exec sleep 60"};
    static const char *const word[2] = {"signal 11", "0.3 s"};
    for (int i = 0; i < 2; i++) {
        fake_write(*state, script[i]);
        tc_error err = {0};
        tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
        tc_prepare_options o = {.reentry = TC_REENTRY_CONVEXIFY, .convexify_limit_s = 0.3};
        tc_mesh_report r;
        assert_int_equal(tc_mesh_prepare(m, &o, NULL, &err), TC_E_WORKER);
        assert_non_null(strstr(err.text, word[i]));
        o.reentry = TC_REENTRY_AUTO;
        assert_int_equal(tc_mesh_prepare(m, &o, NULL, &err), TC_OK);
        tc_mesh_get_report(&r, m);
        shape_check_promises(m);
        assert_int_equal(r.reentry, TC_REENTRY_PEEL);
        assert_int_equal(r.n_imaginary, 0);
        assert_non_null(strstr(r.reentry_why, word[i]));
        tc_mesh_destroy(&m);
    }
    shape_finish(&s);
}

/* Overlapping cubes, a seam of duplicated points, a face of three cells: TetGen refuses, crashes or is not asked. */
static void boundaries_that_cannot_be_filled_mean_peeling(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        shape s = {0}, t = {0};
        const int n[3] = {2, 2, 2};
        shape_grid(&s, n, NULL);
        shape_grid(&t, n, NULL);
        size_t first = s.n_vertex;
        for (size_t v = 0; v < t.n_vertex && kind < 2; v++) {
            const double *p = t.vertex + 3 * v;
            double shift = kind == 0 ? 0.7 : 2;
            shape_vertex(&s, p[0] + shift, p[1] + (kind == 0 ? 0.3 : 0), p[2] + (kind == 0 ? 0.1 : 0));
        }
        for (size_t i = 0; i < t.n_tet && kind < 2; i++) {
            int32_t v[4];
            for (size_t c = 0; c < 4; c++)
                v[c] = t.tet[4 * i + c] + (int32_t)first;
            shape_tet(&s, v[0], v[1], v[2], v[3]);
        }
        if (kind == 2) {
            int32_t p = shape_vertex(&s, -1, 0.2, 0.1), q = shape_vertex(&s, -1, 0.9, 1.7);
            shape_tet(&s, 0, 3, 12, p); /* one triangle of the side x = 0, twice more */
            shape_tet(&s, 0, 3, 12, q);
        }
        double *scalar = malloc(s.n_vertex * sizeof *scalar);
        assert_non_null(scalar);
        for (size_t v = 0; v < s.n_vertex; v++)
            scalar[v] = v < first ? 1 : 2;
        tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
        tc_mesh_report r = shape_prepare(m, TC_REENTRY_AUTO);
        shape_check_promises(m);
        assert_int_equal(r.reentry, TC_REENTRY_PEEL);
        assert_true(strlen(r.reentry_why) > 20);
        assert_int_equal(r.n_tet, s.n_tet);
        tc_error err = {0};
        tc_prepare_options o = {.reentry = TC_REENTRY_CONVEXIFY};
        tc_status status = tc_mesh_prepare(m, &o, NULL, &err);
        assert_true(status == TC_E_MESH || status == TC_E_WORKER);
        assert_non_null(strstr(err.text, "depth peeling"));
        free(scalar);
        shape_finish(&t);
        end(&m, &s);
    }
}

/* A real curvilinear mesh of flow past a fin, made anew: cells of very different sizes around a slot. */
static void a_graded_mesh_with_a_slot_is_filled(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {12, 10, 8};
    shape_grid(&s, n, NULL);
    for (size_t v = 0; v < s.n_vertex; v++) {
        double *p = s.vertex + 3 * v, r = 1 + pow(p[0] / 12, 4) * 20, angle = 3.0 * p[1] / 10;
        double z = pow(10, p[2] / 2 - 4); /* 1e-4 to 1 */
        p[0] = r * cos(angle), p[1] = r * sin(angle), p[2] = z;
    }
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_CONVEXIFY);
    shape_check_promises(m);
    assert_true(r.n_imaginary > 0);
    assert_true(imaginary_volume(m) > 0);
    end(&m, &s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaps_up_to_the_hull_are_filled),
        cmocka_unit_test(sides_flat_to_rounding_do_not_prevent_filling),
        cmocka_unit_test(a_convex_mesh_needs_no_helper),
        cmocka_unit_test(a_fan_of_thousands_has_gaps_and_one_around_twice_has_none),
        cmocka_unit_test(one_picture_waits_for_gaps_or_many_are_peeled),
        cmocka_unit_test(another_reentry_redoes_only_the_gaps),
        cmocka_unit_test_setup_teardown(a_helper_that_dies_or_hangs_means_peeling, fake_setup, fake_teardown),
        cmocka_unit_test(boundaries_that_cannot_be_filled_mean_peeling),
        cmocka_unit_test(a_graded_mesh_with_a_slot_is_filled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
