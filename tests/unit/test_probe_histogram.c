/* test_probe_histogram.c: histograms against a plain count over the mesh, and pictures' values against a projection of
 * another kind. */
#include "test_reference_fixture.h"

#include <stdio.h>

static tc_mesh *prepared(const char *name, size_t cells)
{
    tc_error err = {0};
    tc_mesh *m = NULL;
    if (tc_synth_create(&m, name, cells, 3, &err) != TC_OK ||
        tc_mesh_prepare(m, &(tc_prepare_options){.reentry = TC_REENTRY_PEEL}, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return m;
}

/* A cube of n^3 little cubes with these values at its points, or in its cells. */
static tc_mesh *cube(int n, tc_association association, double (*value)(size_t i))
{
    struct tc_mesh f = kuhn_cube(n);
    const size_t count = association == TC_CELL_DATA ? f.n_tet : f.n_vertex;
    double *scalar = calloc(count, sizeof *scalar);
    tc_mesh *m;
    assert_non_null(scalar);
    for (size_t i = 0; i < count; i++)
        scalar[i] = value(i);
    const tc_mesh_arrays arrays = {f.n_vertex, f.vertex, f.n_tet, f.tet, scalar, association, "x"};
    assert_int_equal(tc_mesh_create(&m, &arrays, NULL), TC_OK);
    assert_int_equal(tc_mesh_prepare(m, &(tc_prepare_options){.reentry = TC_REENTRY_PEEL}, NULL, NULL), TC_OK);
    free(scalar);
    mesh_free(&f);
    return m;
}

static tc_histogram *histogram(const tc_mesh *m, const tc_histogram_options *o)
{
    tc_histogram *h;
    tc_error err;
    if (tc_mesh_histogram(&h, m, o, &err) != TC_OK)
        fail_msg("%s", err.text);
    return h;
}

static double tet_volume(const tc_mesh *m, size_t t)
{
    const double *p[4];
    double a[3], b[3], c[3], n[3];
    for (int k = 0; k < 4; k++)
        p[k] = &m->vertex[3 * (size_t)m->tet[4 * t + (size_t)k]];
    tc_vec_sub(a, p[1], p[0]), tc_vec_sub(b, p[2], p[0]), tc_vec_sub(c, p[3], p[0]);
    tc_vec_cross(n, a, b);
    return fabs(tc_vec_dot(n, c)) / 6;
}

/* Volume around each point, or of each cell. */
static double *weights(const tc_mesh *m, bool by_volume, size_t n)
{
    double *w = calloc(n, sizeof *w);
    assert_non_null(w);
    for (size_t i = 0; i < n && !by_volume; i++)
        w[i] = 1;
    for (size_t t = 0; t < m->n_tet && by_volume; t++)
        for (int k = 0; k < 4; k++)
            w[m->association == TC_CELL_DATA ? t : (size_t)m->tet[4 * t + (size_t)k]] += 0.25 * tet_volume(m, t);
    return w;
}

/* Is p in the picture? Through the pixel that it falls into: the ray of that place goes through p. */
static bool in_picture(const tc_camera *c, double aspect, const double *p)
{
    double axis[3], right[3], up[3], q[3];
    tc_vec_sub(axis, c->focal_point, c->position), tc_vec_normalize(axis);
    tc_vec_cross(right, axis, c->view_up), tc_vec_normalize(right);
    tc_vec_cross(up, right, axis);
    tc_vec_sub(q, p, c->position);
    const double depth = tc_vec_dot(q, axis), near = c->clip_near, far = c->clip_far > 0 ? c->clip_far : INFINITY;
    const double h = c->parallel ? c->parallel_scale : depth * tan(c->view_angle * 3.14159265358979323846 / 360);
    /* vtkCamera: window centre (x, y) is what is in the middle, in halves of the picture */
    const double x = tc_vec_dot(q, right) / (h * aspect) - c->window_center[0];
    const double y = tc_vec_dot(q, up) / h - c->window_center[1];
    return depth > 0 && depth >= near && depth <= far && fabs(x) <= 1 && fabs(y) <= 1;
}

static void compare(const char *what, const tc_mesh *m, const tc_histogram_options *o)
{
    const bool cells = m->association == TC_CELL_DATA;
    const size_t n = cells ? m->n_tet : m->n_vertex, bins = o->n ? (size_t)o->n : 256;
    tc_histogram *h = histogram(m, o);
    double *w = weights(m, o->by_volume, n), *bin = calloc(bins, sizeof *bin), lo = INFINITY, hi = -INFINITY;
    double below = 0, above = 0, total = 0, most = 0, volume = 0;
    bool *seen = calloc(n + 1, sizeof *seen);
    uint64_t counted = 0, missing = 0;
    assert_true(bin && seen);
    for (size_t i = 0; i < n; i++) {
        double p[3] = {0, 0, 0};
        for (int k = 0; k < 4; k++)
            tc_vec_mul_add(p, p, 0.25, &m->vertex[3 * (cells ? (size_t)m->tet[4 * i + (size_t)k] : i)]);
        seen[i] = !o->camera || in_picture(o->camera, o->aspect, p);
        if (seen[i] && isfinite(m->scalar[i]) && !(o->log && m->scalar[i] <= 0))
            lo = fmin(lo, m->scalar[i]), hi = fmax(hi, m->scalar[i]);
    }
    if (o->has_range)
        lo = o->range[0], hi = o->range[1];
    assert_true(h->range[0] == lo && h->range[1] == hi);
    for (size_t i = 0; i < n; i++) {
        const double v = m->scalar[i];
        counted += seen[i];
        missing += seen[i] && !isfinite(v);
        if (!seen[i] || !isfinite(v))
            continue;
        volume += w[i];
        const double x = o->log ? log(v / lo) / log(hi / lo) : (v - lo) / (hi - lo);
        if (v < lo)
            below += w[i];
        else if (v > hi)
            above += w[i];
        else
            bin[(size_t)fmin(x * (double)bins, (double)bins - 1)] += w[i];
    }
    assert_int_equal(h->n, bins);
    assert_true(h->log == o->log && h->counted == counted && h->missing == missing);
    const double rounding = o->by_volume ? 1e-12 * volume : 0;
    NEAR(h->below, below, rounding);
    NEAR(h->above, above, rounding);
    for (size_t i = 0; i < bins; i++) {
        if (!(fabs(h->weight[i] - bin[i]) <= rounding))
            fail_msg("%s: bin %zu holds %.17g, not %.17g", what, i, h->weight[i], bin[i]);
        total += h->weight[i];
        most = fmax(most, h->weight[i]);
    }
    NEAR(h->total, total, 1e-13 * total);
    NEAR(h->most, most, 0);
    assert_true(counted > missing && total > 0);
    free(seen);
    free(bin);
    free(w);
    tc_histogram_destroy(&h);
    assert_null(h);
}

/* No value lies on the edge of a bin, where rounding would decide; some are below 0, some not finite. */
static double scattered(size_t i)
{
    uint64_t seed = i * 77 + 5;
    const double v = uniform(&seed, -1, 9) * uniform(&seed, 0, 1) + 0.00123;
    return i % 41 == 7 ? NAN : i % 53 == 5 ? INFINITY : i % 59 == 1 ? -INFINITY : v;
}

static void a_bin_holds_other_values_than_it_should(void **state)
{
    (void)state;
    for (int k = 0; k < 32; k++) {
        tc_mesh *m = cube(9, k & 1 ? TC_CELL_DATA : TC_POINT_DATA, scattered);
        const tc_histogram_options o = {.n = k & 2 ? 0 : 7,
                                        .has_range = k & 4,
                                        .range = {0.31, 2.7},
                                        .log = k & 8,
                                        .by_volume = k & 16,
                                        .threads = k % 3};
        compare("cube", m, &o);
        tc_mesh_destroy(&m);
    }
    static const char *const names[] = {"ball", "heatsink", "nan-region", "nan-cells", "graded"};
    for (int i = 0; i < 5; i++) {
        tc_mesh *m = prepared(names[i], 4000);
        compare(names[i], m, &(tc_histogram_options){.n = 100, .by_volume = true});
        compare(names[i], m, &(tc_histogram_options){.n = 3});
        tc_mesh_destroy(&m);
    }
}

static void values_outside_of_the_picture_are_counted(void **state)
{
    (void)state;
    static const double from[3] = {0.8, 0.5, 1.3}, up[3] = {0.1, 1, 0};
    for (int k = 0; k < 64; k++) {
        tc_mesh *m = cube(11, k & 1 ? TC_CELL_DATA : TC_POINT_DATA, scattered);
        tc_camera c = {.parallel = (k & 2) != 0};
        tc_camera_reset(&c, m->report.bounds, from, up, 30, 1.3);
        tc_camera_zoom(&c, k & 4 ? 2.5 : 1.2);
        c.window_center[0] = k & 8 ? 0.4 : 0, c.window_center[1] = k & 8 ? -0.3 : 0;
        if (k & 16) { /* the eye is within the cube */
            c.position[0] = 0.53, c.position[1] = 0.61, c.position[2] = 0.47;
            c.view_angle = 80;
        }
        if (k & 32) {
            double away[3];
            tc_vec_sub(away, c.focal_point, c.position);
            c.clip_near = 0.9 * tc_vec_length(away), c.clip_far = 1.05 * tc_vec_length(away) + 0.3;
        }
        const tc_histogram_options o = {.n = 20, .camera = &c, .aspect = k & 4 ? 0.7 : 1.9, .by_volume = k % 3 == 0};
        compare("picture", m, &o);
        tc_mesh_destroy(&m);
    }
}

static void more_threads_give_other_bits(void **state)
{
    (void)state;
    static const char *const names[] = {"ball", "nan-cells"};
    for (int i = 0; i < 2; i++) {
        tc_mesh *m = prepared(names[i], 150000);
        tc_histogram_options o = {.n = 300, .by_volume = true, .threads = 1};
        tc_histogram *one = histogram(m, &o);
        NEAR(one->total + one->below + one->above, i == 0 ? m->report.volume : one->total, 1e-12 * one->total);
        for (int threads = 2; threads < 9; threads += 3) {
            o.threads = threads;
            tc_histogram *other = histogram(m, &o);
            assert_memory_equal(one->weight, other->weight, 300 * sizeof(double));
            assert_true(one->total == other->total && one->counted == other->counted);
            tc_histogram_destroy(&other);
        }
        tc_histogram_destroy(&one);
        tc_mesh_destroy(&m);
    }
}

/* The points that fill gaps have no value: 0 must not be counted for them. */
static void points_of_imaginary_cells_are_counted(void **state)
{
    (void)state;
    tc_mesh *m = prepared("cylinder", 900);
    tc_error err = {0};
    tc_histogram *plain = histogram(m, &(tc_histogram_options){.by_volume = true});
    if (tc_mesh_prepare(m, &(tc_prepare_options){.reentry = TC_REENTRY_CONVEXIFY}, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_true(m->report.n_steiner > 0);
    tc_histogram *filled = histogram(m, &(tc_histogram_options){.by_volume = true});
    assert_true(plain->counted == filled->counted && plain->counted == m->n_vertex - m->report.n_steiner);
    assert_memory_equal(plain->weight, filled->weight, 256 * sizeof(double));
    tc_histogram_destroy(&plain);
    tc_histogram_destroy(&filled);
    tc_mesh_destroy(&m);
}

static double one_to_four(size_t i)
{
    return (double)(i % 4 + 1);
}

static double seven(size_t i)
{
    (void)i;
    return 7;
}

static double nothing(size_t i)
{
    return i % 2 ? NAN : INFINITY;
}

static void percentile_does_not_leave_that_share_below(void **state)
{
    (void)state;
    double weight[6] = {0, 1, 0, 2, 1, 0}; /* of the values 10 to 22, or of 1 to 64 in powers of 2 */
    tc_histogram h = {.n = 6, .range = {10, 22}, .weight = weight, .most = 2, .total = 4};
    const double at[][3] = {{0, 12, 2},    {-1, 12, 2},    {0.125, 13, 3}, {0.25, 14, 4},
                            {0.5, 17, 12}, {0.75, 18, 16}, {1, 20, 32},    {7, 20, 32}};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        h.range[0] = 10, h.range[1] = 22, h.log = false;
        NEAR(tc_histogram_percentile(&h, at[i][0]), at[i][1], 1e-14);
        h.range[0] = 1, h.range[1] = 64, h.log = true; /* linear within a bin all the same */
        NEAR(tc_histogram_percentile(&h, at[i][0]), at[i][2], 1e-13);
    }
    assert_true(isnan(tc_histogram_percentile(&h, NAN)));

    tc_mesh *m = cube(4, TC_CELL_DATA, one_to_four);
    tc_histogram *of_mesh = histogram(m, &(tc_histogram_options){.n = 6});
    NEAR(tc_histogram_percentile(of_mesh, 0.5), 2.5, 1e-14); /* 1, 2, 3, 4 lie in the bins 0, 2, 4, 5 */
    tc_histogram_destroy(&of_mesh);
    tc_mesh_destroy(&m);
}

static void one_value_or_none_has_no_histogram(void **state)
{
    (void)state;
    for (int log = 0; log < 2; log++) {
        tc_mesh *m = cube(3, TC_POINT_DATA, seven);
        tc_histogram *h = histogram(m, &(tc_histogram_options){.n = 5, .log = log});
        assert_true(h->range[0] == 7 && h->range[1] == 7 && h->weight[4] == 64 && h->total == 64 && h->below == 0);
        NEAR(tc_histogram_percentile(h, 0.3), 7, 1e-14);
        tc_histogram_destroy(&h);
        tc_mesh_destroy(&m);
    }
    tc_mesh *m = cube(3, TC_POINT_DATA, nothing);
    tc_histogram *h = histogram(m, &(tc_histogram_options){.n = 5});
    assert_true(h->range[0] == 0 && h->range[1] == 0 && h->total == 0 && h->counted == 64 && h->missing == 64);
    assert_true(isnan(tc_histogram_percentile(h, 0.5)));
    tc_histogram_destroy(&h);
    tc_mesh_destroy(&m);
}

static void what_cannot_be_counted_is_no_error_or_one_without_a_reason(void **state)
{
    (void)state;
    tc_mesh *m = cube(3, TC_POINT_DATA, scattered), *raw, *none = cube(2, TC_CELL_DATA, nothing);
    assert_int_equal(tc_synth_create(&raw, "kuhn", 200, 0, NULL), TC_OK);
    tc_camera camera = {.position = {5, 5, 5}, .view_up = {0, 1, 0}, .view_angle = 30}, away = camera, bad = camera;
    bad.view_angle = 0;
    for (int i = 0; i < 3; i++)
        away.focal_point[i] = 10;
    const struct {
        const tc_mesh *mesh;
        tc_histogram_options o;
        const char *says;
    } wrong[] = {{NULL, {0}, "needed"},
                 {raw, {0}, "tc_mesh_prepare"},
                 {m, {.n = -1}, "-1"},
                 {m, {.n = 65537}, "65536"},
                 {m, {.has_range = true, .range = {1, 1}}, "1 to 1"},
                 {m, {.has_range = true, .range = {0, INFINITY}}, "inf"},
                 {m, {.has_range = true, .range = {0, 1}, .log = true}, "above 0"},
                 {none, {.log = true}, "no value is above 0"},
                 {m, {.log = true, .camera = &away, .aspect = 1}, "in the picture"},
                 {m, {.camera = &camera}, "aspect"},
                 {m, {.camera = &bad, .aspect = 1}, "view angle"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_histogram *h = (tc_histogram *)&h;
        tc_error err = {0};
        assert_int_equal(tc_mesh_histogram(&h, wrong[i].mesh, &wrong[i].o, &err), TC_E_ARG);
        assert_null(h);
        if (!strstr(err.text, wrong[i].says))
            fail_msg("\"%s\" does not say \"%s\"", err.text, wrong[i].says);
    }
    tc_histogram_destroy(NULL);
    tc_mesh_destroy(&m);
    tc_mesh_destroy(&raw);
    tc_mesh_destroy(&none);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bin_holds_other_values_than_it_should),
        cmocka_unit_test(values_outside_of_the_picture_are_counted),
        cmocka_unit_test(more_threads_give_other_bits),
        cmocka_unit_test(points_of_imaginary_cells_are_counted),
        cmocka_unit_test(percentile_does_not_leave_that_share_below),
        cmocka_unit_test(one_value_or_none_has_no_histogram),
        cmocka_unit_test(what_cannot_be_counted_is_no_error_or_one_without_a_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
