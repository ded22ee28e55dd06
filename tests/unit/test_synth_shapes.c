/* test_synth_shapes.c: every synthetic dataset, in several sizes and seeds, against its own closed forms and what its
 * row promises. What is wrong with the broken ones is in test_synth_defects.c. */
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
#include <stdlib.h>
#include <string.h>

static const int outward[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}; /* faces of a positive tet */
static const size_t sizes[] = {1, 300, 5000};

static tc_synth_soup build(const char *name, size_t n_cells, uint64_t seed)
{
    const tc_synth_generator *g = tc_synth_find(name);
    assert_non_null(g);
    tc_synth_soup soup = {0};
    tc_error err = {0};
    if (g->build(&soup, n_cells, seed, &err))
        fail_msg("%s: %s", name, err.text);
    return soup;
}

static const double *corner(const tc_synth_soup *s, size_t tet, int i)
{
    int32_t v = s->tet[4 * tet + (size_t)i];
    assert_in_range(v, 0, s->n_vertex - 1);
    return s->vertex + 3 * (size_t)v;
}

static double six_volumes(const tc_synth_soup *s, size_t tet)
{
    double e[3][3], n[3];
    for (int i = 0; i < 3; i++)
        tc_vec_sub(e[i], corner(s, tet, i + 1), corner(s, tet, 0));
    tc_vec_cross(n, e[0], e[1]);
    return tc_vec_dot(n, e[2]);
}

/* Calls check for each dataset that promises all of what, in each size, with two seeds. */
static void for_all(unsigned what,
                    void (*check)(const char *name, size_t n_cells, uint64_t seed, const tc_synth_soup *soup))
{
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
            for (uint64_t seed = 0; seed < 2; seed++) {
                if ((tc_synth_find(list[i].name)->promises & what) != what)
                    continue;
                tc_synth_soup soup = build(list[i].name, sizes[k], seed);
                check(list[i].name, sizes[k], seed, &soup);
                tc_synth_soup_finish(&soup);
            }
}

static void check_positive(const char *name, size_t n_cells, uint64_t seed, const tc_synth_soup *s)
{
    for (size_t t = 0; t < s->n_tet; t++)
        if (tc_orient3d(corner(s, t, 0), corner(s, t, 1), corner(s, t, 2), corner(s, t, 3)) <= 0)
            fail_msg("%s, %zu cells, seed %d: tet %zu is not positive", name, n_cells, (int)seed, t);
}

static void a_tet_is_inverted_or_flat(void **state)
{
    (void)state;
    for_all(TC_SYNTH_POSITIVE, check_positive);
}

static void check_shape(const char *name, size_t n_cells, uint64_t seed, const tc_synth_soup *s)
{
    for (size_t t = 0; t < s->n_tet; t++) {
        double longest = 0, e[3], volume = six_volumes(s, t);
        for (int i = 0; i < 6; i++) {
            static const int edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
            tc_vec_sub(e, corner(s, t, edge[i][0]), corner(s, t, edge[i][1]));
            longest = fmax(longest, tc_vec_length(e));
        }
        if (!(volume > 5e-6 * longest * longest * longest))
            fail_msg("%s, %zu cells, seed %d: tet %zu has six volumes %g, longest edge %g", name, n_cells, (int)seed, t,
                     volume, longest);
    }
}

static void a_tet_of_good_shape_is_almost_flat(void **state)
{
    (void)state;
    for_all(TC_SYNTH_SHAPELY, check_shape);
}

typedef struct face {
    int32_t v[3];
    int side; /* parity of the order in which the tet names its corners: +1 or -1 */
} face;

static int compare_faces(const void *a, const void *b)
{
    return memcmp(((const face *)a)->v, ((const face *)b)->v, sizeof(int32_t[3]));
}

static void swap_corners(face *f, int i, int j)
{
    if (f->v[i] > f->v[j]) {
        int32_t v = f->v[i];
        f->v[i] = f->v[j];
        f->v[j] = v;
        f->side = -f->side;
    }
}

/* All faces, outward, with sorted corners, equal ones together. Caller frees. */
static face *sorted_faces(const tc_synth_soup *s)
{
    face *f = malloc(4 * s->n_tet * sizeof *f);
    assert_non_null(f);
    for (size_t t = 0; t < s->n_tet; t++)
        for (int i = 0; i < 4; i++) {
            face *g = &f[4 * t + (size_t)i];
            g->side = 1;
            for (int k = 0; k < 3; k++)
                g->v[k] = s->tet[4 * t + (size_t)outward[i][k]];
            swap_corners(g, 0, 1), swap_corners(g, 1, 2), swap_corners(g, 0, 1);
        }
    qsort(f, 4 * s->n_tet, sizeof *f, compare_faces);
    return f;
}

/* A point just outside boundary face f lies in some tet: what should be one face is two that do not match. */
static bool covered_outside(const tc_synth_soup *s, const face *f)
{
    const double *a = s->vertex + 3 * (size_t)f->v[0], *b = s->vertex + 3 * (size_t)f->v[1];
    const double *c = s->vertex + 3 * (size_t)f->v[2];
    double e[2][3], n[3], p[3];
    tc_vec_sub(e[0], b, a);
    tc_vec_sub(e[1], c, a);
    tc_vec_cross(n, e[0], e[1]);
    double k = f->side * 1e-5 * tc_vec_length(e[0]) / tc_vec_length(n);
    for (int i = 0; i < 3; i++)
        p[i] = (a[i] + b[i] + c[i]) / 3 + k * n[i];
    for (size_t t = 0; t < s->n_tet; t++) {
        bool in = true;
        for (int i = 0; i < 4 && in; i++) {
            const double *q = corner(s, t, outward[i][0]);
            double g[3][3], m[3];
            tc_vec_sub(g[0], corner(s, t, outward[i][1]), q);
            tc_vec_sub(g[1], corner(s, t, outward[i][2]), q);
            tc_vec_sub(g[2], p, q);
            tc_vec_cross(m, g[0], g[1]);
            in = tc_vec_dot(m, g[2]) < 0;
        }
        if (in)
            return true;
    }
    return false;
}

static void check_conforming(const char *name, size_t n_cells, uint64_t seed, const tc_synth_soup *s)
{
    face *f = sorted_faces(s);
    size_t n = 4 * s->n_tet;
    bool shapely = tc_synth_find(name)->promises & TC_SYNTH_SHAPELY; /* no gap is as thin as the step outside */
    for (size_t i = 0; i < n;) {
        size_t j = i + 1;
        while (j < n && compare_faces(&f[i], &f[j]) == 0)
            j++;
        if (j - i > 2 || (j - i == 2 && f[i].side == f[i + 1].side))
            fail_msg("%s, %zu cells, seed %d: a face has %zu tets, or two on one side", name, n_cells, (int)seed,
                     j - i);
        if (j - i == 1 && n_cells <= 300 && shapely && covered_outside(s, &f[i]))
            fail_msg("%s, %zu cells, seed %d: two faces touch without matching", name, n_cells, (int)seed);
        i = j;
    }
    free(f);
}

static void neighbours_do_not_share_whole_faces(void **state)
{
    (void)state;
    for_all(TC_SYNTH_CONFORMING, check_conforming);
}

/* Length of the line within one tet: clip by the four planes. */
static double tet_chord(const tc_synth_soup *s, size_t tet, const double *o, const double *d)
{
    double t0 = -HUGE_VAL, t1 = HUGE_VAL;
    for (int i = 0; i < 4; i++) {
        const double *a = corner(s, tet, outward[i][0]);
        double e[2][3], n[3], from[3];
        tc_vec_sub(e[0], corner(s, tet, outward[i][1]), a);
        tc_vec_sub(e[1], corner(s, tet, outward[i][2]), a);
        tc_vec_cross(n, e[0], e[1]);
        tc_vec_sub(from, a, o);
        double along = tc_vec_dot(n, d), to = tc_vec_dot(n, from);
        if (along > 0)
            t1 = fmin(t1, to / along);
        else if (along < 0)
            t0 = fmax(t0, to / along);
        else if (to < 0)
            return 0;
    }
    return t1 > t0 ? t1 - t0 : 0;
}

/* The tets that are left of a dataset once it is prepared: none twice, inside out or without volume by repetition. */
static tc_mesh *prepared(const char *name, size_t n_cells, uint64_t seed)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    const tc_prepare_options peel = {.reentry = TC_REENTRY_PEEL};
    if (tc_synth_create(&mesh, name, n_cells, seed, &err) || tc_mesh_prepare(mesh, &peel, NULL, &err))
        fail_msg("%s, %zu cells: %s", name, n_cells, err.text);
    return mesh;
}

static void check_chords(const char *name, size_t n_cells, uint64_t seed, const tc_synth_soup *soup)
{
    (void)soup;
    const tc_synth_generator *g = tc_synth_find(name);
    if (!g->chord)
        return;
    tc_mesh *mesh = prepared(name, n_cells, seed);
    const tc_synth_soup s = {
        .n_vertex = mesh->n_vertex, .n_tet = mesh->n_tet, .vertex = mesh->vertex, .tet = mesh->tet};
    const double *b = mesh->report.bounds;
    double size[3] = {b[1] - b[0], b[3] - b[2], b[5] - b[4]}, longest = 0, far = 0;
    for (int k = 0; k < 6; k++)
        far = fmax(far, fabs(b[k]));
    for (uint64_t line = 0; line < 40; line++) {
        double o[3], d[3], sum = 0;
        for (uint64_t a = 0; a < 3; a++) {
            o[a] = b[2 * a] + size[a] * 0.5 * (1 + tc_synth_noise(line, a));
            d[a] = line < 3 ? line == a : tc_synth_noise(line, 3 + a) * size[a];
        }
        tc_vec_normalize(d);
        for (size_t t = 0; t < s.n_tet; t++)
            sum += tet_chord(&s, t, o, d);
        double chord = g->chord(o, d, n_cells);
        if (!(fabs(chord - sum) < 1e-9 * tc_vec_length(size) + 1e-14 * far))
            fail_msg("%s, %zu cells, seed %d: line %d is %.12g long by formula, %.12g by its tets", name, n_cells,
                     (int)seed, (int)line, chord, sum);
        longest = fmax(longest, sum);
    }
    assert_true(longest > 0);
    tc_mesh_destroy(&mesh);
}

static void the_closed_form_is_not_the_length_inside_the_tets(void **state)
{
    (void)state;
    for_all(0, check_chords);
}

static void a_mesh_has_far_from_the_asked_number_of_cells(void **state)
{
    (void)state;
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        const tc_synth_generator *g = tc_synth_find(list[i].name);
        if (!(g->promises & TC_SYNTH_SIZED))
            continue;
        size_t asked[2] = {g->default_cells, 60000};
        for (int k = 0; k < 2; k++) {
            tc_synth_soup s = build(list[i].name, asked[k], 0);
            if (fabs((double)s.n_tet / (double)asked[k] - 1) > 0.15)
                fail_msg("%s: asked for %zu tets, made %zu", list[i].name, asked[k], s.n_tet);
            tc_synth_soup_finish(&s);
        }
    }
}

static void equal_seeds_differ_or_unequal_ones_agree(void **state)
{
    (void)state;
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        tc_synth_soup a = build(list[i].name, 3000, 7), b = build(list[i].name, 3000, 7),
                      c = build(list[i].name, 3000, 8);
        assert_int_equal(a.n_vertex, b.n_vertex);
        assert_int_equal(a.n_tet, b.n_tet);
        assert_memory_equal(a.vertex, b.vertex, 3 * a.n_vertex * sizeof *a.vertex);
        assert_memory_equal(a.tet, b.tet, 4 * a.n_tet * sizeof *a.tet);
        assert_int_equal(a.n_tet, c.n_tet);
        if (tc_synth_find(list[i].name)->promises & TC_SYNTH_SEEDED)
            assert_memory_not_equal(a.vertex, c.vertex, 3 * a.n_vertex * sizeof *a.vertex);
        tc_synth_soup_finish(&a);
        tc_synth_soup_finish(&b);
        tc_synth_soup_finish(&c);
    }
}

static void a_field_is_constant_or_not_finite(void **state)
{
    (void)state;
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        const tc_synth_generator *g = tc_synth_find(list[i].name);
        if (g->defects & (TC_SYNTH_CONSTANT | TC_SYNTH_NONFINITE_VALUES | TC_SYNTH_NO_FIELD))
            continue;
        tc_synth_soup s = build(list[i].name, 3000, 1);
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (size_t v = 0; v < s.n_vertex; v++) {
            double f = s.scalar ? s.scalar[v] : g->field(s.vertex + 3 * v);
            assert_true(isfinite(f));
            lo = fmin(lo, f);
            hi = fmax(hi, f);
        }
        assert_true(hi > lo);
        tc_synth_soup_finish(&s);
    }
}

static void a_size_beyond_32_bit_ids_is_tried(void **state)
{
    (void)state;
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        tc_mesh *mesh = NULL;
        tc_error err = {0};
        assert_int_equal(tc_synth_create(&mesh, list[i].name, SIZE_MAX / 2, 0, &err), TC_E_ARG);
        assert_null(mesh);
        assert_non_null(strstr(err.text, "too many"));
    }
}

static void an_unknown_name_does_not_name_some_known(void **state)
{
    (void)state;
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    assert_int_equal(tc_synth_create(&mesh, "kuhm", 0, 0, &err), TC_E_ARG);
    assert_null(mesh);
    assert_non_null(strstr(err.text, "'kuhm'"));
    size_t n;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < 11; i++)
        assert_non_null(strstr(err.text, list[i].name));
    assert_non_null(strstr(err.text, "--list"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tet_is_inverted_or_flat),
        cmocka_unit_test(a_tet_of_good_shape_is_almost_flat),
        cmocka_unit_test(neighbours_do_not_share_whole_faces),
        cmocka_unit_test(the_closed_form_is_not_the_length_inside_the_tets),
        cmocka_unit_test(a_mesh_has_far_from_the_asked_number_of_cells),
        cmocka_unit_test(equal_seeds_differ_or_unequal_ones_agree),
        cmocka_unit_test(a_field_is_constant_or_not_finite),
        cmocka_unit_test(a_size_beyond_32_bit_ids_is_tried),
        cmocka_unit_test(an_unknown_name_does_not_name_some_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
