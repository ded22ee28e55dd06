/* test_mesh_filling.c: a convexification helper that dies, lies or answers rubbish: nothing that does not fill the hull
 * exactly is taken, the mesh stays as it was and is peeled, and the reason is given. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "helpers/fake_fill.h"
#include "mesh/boundary.h"
#include "mesh_shapes.h"

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* -------------------------------------------------------------------------------------------------------- the fake */

typedef struct fake {
    char folder[64], helper[128], answer[128], before[4096];
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
    snprintf(f->helper, sizeof f->helper, "%s/tetcast-convexify", f->folder);
    snprintf(f->answer, sizeof f->answer, "%s/answer", f->folder);
    if (symlink(TC_BUILD_DIR "/tetcast-fake-fill", f->helper) != 0 || setenv("TETCAST_FAKE_ANSWER", f->answer, 1) != 0)
        return -1;
    return setenv("TETCAST_HELPERS", f->folder, 1);
}

static int fake_teardown(void **state)
{
    fake *f = *state;
    unlink(f->helper);
    unlink(f->answer);
    rmdir(f->folder);
    setenv("TETCAST_HELPERS", f->before, 1);
    free(f);
    return 0;
}

/* --------------------------------------------------------------------------------------------------- a mesh with a gap
 */

enum { ROOM = 64, N = 3 };

/* What the fake is to say. Tets by grid point (id of shape_grid), made local when it is written; from STEINER on:
 * extra. */
typedef struct say {
    fake_answer head;
    double extra[3 * ROOM];
    int32_t tet[4 * ROOM];
    bool local; /* ids are the boundary's numbers already */
} say;

enum { STEINER = 1000 };

static bool ends(int i, int j, int k)
{
    (void)j, (void)k;
    return i != 1;
}

static bool middle(int i, int j, int k)
{
    return !ends(i, j, k);
}

/* A box of 3 x 2 x 1 cubes without the middle two, and what fills it. The frame of TetGen's points is 2^-1: half the
 * extent is 1.5. */
static const int size[3] = {3, 2, 1};
static const double SCALE = 0.5;

static say right_answer(void)
{
    shape s = {0};
    say a = {.head = {.hull_volume = 6 * SCALE * SCALE * SCALE}};
    shape_grid(&s, size, middle);
    assert_true(s.n_tet <= ROOM);
    a.head.n_tet = (int64_t)(4 * s.n_tet);
    memcpy(a.tet, s.tet, 4 * s.n_tet * sizeof *a.tet);
    tc_mesh m = {.vertex = s.vertex};
    for (size_t t = 0; t < s.n_tet; t++) /* positive volumes */
        if (shape_volume6(&m, a.tet + 4 * t) < 0) {
            int32_t k = a.tet[4 * t + 2];
            a.tet[4 * t + 2] = a.tet[4 * t + 3], a.tet[4 * t + 3] = k;
        }
    shape_finish(&s);
    return a;
}

static void add_point(say *a, double x, double y, double z)
{
    double *p = a->extra + a->head.n_extra;
    p[0] = x * SCALE, p[1] = y * SCALE, p[2] = z * SCALE;
    a->head.n_extra += 3;
}

static void add_tet(say *a, int32_t p, int32_t q, int32_t r, int32_t s)
{
    assert_true(a->head.n_tet + 4 <= 4 * ROOM);
    int32_t *t = a->tet + a->head.n_tet;
    t[0] = p, t[1] = q, t[2] = r, t[3] = s;
    a->head.n_tet += 4;
}

/* Tet t becomes four around the first extra point. */
static void split(say *a, int t)
{
    int32_t v[4];
    memcpy(v, a->tet + 4 * t, sizeof v);
    for (int k = 0; k < 4; k++) {
        int32_t w[4] = {v[0], v[1], v[2], v[3]};
        w[k] = STEINER;
        if (k == 0)
            memcpy(a->tet + 4 * t, w, sizeof w);
        else
            add_tet(a, w[0], w[1], w[2], w[3]);
    }
}

static tc_mesh *gap_mesh(void)
{
    shape s = {0};
    shape_grid(&s, size, ends);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_finish(&s);
    return m;
}

/* Writes the answer; m: prepared for peeling, names the boundary's points. */
static void write_answer(const fake *f, const say *a, const tc_mesh *m)
{
    say b = *a;
    tc_boundary boundary;
    assert_int_equal(tc_boundary_build(&boundary, m, m->n_tet, NULL), TC_OK);
    int32_t local[64];
    memset(local, 0xff, sizeof local);
    for (size_t v = 0; v < boundary.n_vertex; v++) {
        const double *p = m->vertex + 3 * (size_t)boundary.vertex[v];
        local[(int)((p[2] * (size[1] + 1) + p[1]) * (size[0] + 1) + p[0])] = (int32_t)v;
    }
    for (int64_t i = 0; i < b.head.n_tet && !a->local; i++) {
        int32_t id = b.tet[i];
        b.tet[i] = id >= STEINER ? id - STEINER + (int32_t)boundary.n_vertex : id < 0 || id >= 24 ? id : local[id];
    }
    tc_boundary_finish(&boundary);
    FILE *file = fopen(f->answer, "wb");
    assert_non_null(file);
    size_t n_extra = (size_t)b.head.n_extra, n_tet = (size_t)b.head.n_tet;
    assert_int_equal(fwrite(&b.head, sizeof b.head, 1, file), 1);
    assert_int_equal(fwrite(b.extra, sizeof *b.extra, n_extra, file), n_extra);
    assert_int_equal(fwrite(b.tet, sizeof *b.tet, n_tet, file), n_tet);
    assert_int_equal(fclose(file), 0);
}

typedef struct arrays {
    size_t n_vertex, n_tet;
    void *vertex, *tet, *neighbour, *scalar;
} arrays;

static void *copy_of(const void *from, size_t bytes)
{
    void *to = malloc(bytes);
    assert_non_null(to);
    return memcpy(to, from, bytes);
}

static arrays keep(const tc_mesh *m)
{
    return (arrays){m->n_vertex,
                    m->n_tet,
                    copy_of(m->vertex, m->n_vertex * 24),
                    copy_of(m->tet, m->n_tet * 16),
                    copy_of(m->neighbour, m->n_tet * 16),
                    copy_of(m->scalar, m->n_vertex * 8)};
}

static void check_kept(arrays *a, const tc_mesh *m)
{
    assert_int_equal(m->n_vertex, a->n_vertex);
    assert_int_equal(m->n_tet, a->n_tet);
    assert_int_equal(m->n_imaginary, 0);
    assert_memory_equal(m->vertex, a->vertex, m->n_vertex * 24);
    assert_memory_equal(m->tet, a->tet, m->n_tet * 16);
    assert_memory_equal(m->neighbour, a->neighbour, m->n_tet * 16);
    assert_memory_equal(m->scalar, a->scalar, m->n_vertex * 8);
    free(a->vertex);
    free(a->tet);
    free(a->neighbour);
    free(a->scalar);
}

/* Prepares with that answer; the mesh must then be peeled, unchanged, for a reason that holds `word`. */
static void check_refused(const fake *f, const say *a, const char *word)
{
    tc_mesh *m = gap_mesh();
    shape_prepare(m, TC_REENTRY_PEEL);
    arrays before = keep(m);
    write_answer(f, a, m);
    tc_error err = {0};
    tc_prepare_options o = {.reentry = TC_REENTRY_CONVEXIFY, .convexify_limit_s = 0.5};
    tc_status status = tc_mesh_prepare(m, &o, NULL, &err);
    assert_true(status == TC_E_MESH || status == TC_E_WORKER);
    if (!strstr(err.text, word))
        fail_msg("'%s' is not in: %s", word, err.text);
    o.reentry = TC_REENTRY_AUTO;
    assert_int_equal(tc_mesh_prepare(m, &o, NULL, &err), TC_OK);
    tc_mesh_report r;
    tc_mesh_get_report(&r, m);
    assert_int_equal(r.reentry, TC_REENTRY_PEEL);
    if (!strstr(r.reentry_why, word))
        fail_msg("'%s' is not in: %s", word, r.reentry_why);
    assert_int_equal(r.n_imaginary, 0);
    assert_int_equal(r.n_steiner, 0);
    assert_false(r.convex);
    shape_check_promises(m);
    check_kept(&before, m);
    tc_mesh_destroy(&m);
}

/* Is every point of a set of generic ones in exactly one cell of the mesh, and the sum of volumes the box's? */
static void check_exact(const tc_mesh *m)
{
    double sum = 0;
    for (size_t t = 0; t < m->n_tet + m->n_imaginary; t++)
        sum += shape_volume6(m, m->tet + 4 * t) / 6;
    assert_true(fabs(sum - 6) < 1e-12);
    for (int i = 0; i < 60; i++) {
        const double p[3] = {3 * fmod(0.017 + i * 0.6180339887, 1), 2 * fmod(0.031 + i * 0.7548776662, 1),
                             fmod(0.043 + i * 0.5698402909, 1)};
        tc_mesh probe = {.n_vertex = 5};
        int in = 0;
        for (size_t t = 0; t < m->n_tet + m->n_imaginary; t++) {
            double x[15];
            static const int32_t part[4][4] = {{4, 1, 2, 3}, {0, 4, 2, 3}, {0, 1, 4, 3}, {0, 1, 2, 4}};
            bool inside = true;
            for (int c = 0; c < 4; c++)
                memcpy(x + 3 * c, m->vertex + 3 * (size_t)m->tet[4 * t + (size_t)c], 24);
            memcpy(x + 12, p, 24);
            probe.vertex = x;
            for (int c = 0; c < 4; c++)
                inside = inside && shape_volume6(&probe, part[c]) > 0;
            in += inside;
        }
        assert_int_equal(in, 1);
    }
}

/* Prepares with that answer; true: it was taken, and is right. */
static bool taken(const fake *f, const say *a)
{
    tc_mesh *m = gap_mesh();
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    write_answer(f, a, m);
    arrays before = keep(m);
    r = shape_prepare(m, TC_REENTRY_AUTO);
    shape_check_promises(m);
    bool yes = r.reentry == TC_REENTRY_CONVEXIFY;
    if (yes)
        check_exact(m);
    shape_prepare(m, TC_REENTRY_PEEL);
    check_kept(&before, m);
    tc_mesh_destroy(&m);
    return yes;
}

/* -------------------------------------------------------------------------------------------------------- the tests */

/* Four cells between the side x = 0 and a new point (x, 1, 0.5). */
static void add_hat(say *a, double x)
{
    add_point(a, x, 1, 0.5);
    for (int j = 0; j < 2; j++) { /* the side's two squares: (0, j..j+1, 0..1), diagonal from (j, 0) to (j + 1, 1) */
        int32_t p = 4 * j, q = 4 * (j + 1), r = 12 + 4 * j, s = 12 + 4 * (j + 1);
        add_tet(a, q, p, s, STEINER);
        add_tet(a, s, p, r, STEINER);
    }
}

static void right_answers_are_refused(void **state)
{
    say a = right_answer();
    assert_true(taken(*state, &a));
    add_point(&a, 1.75, 0.5, 0.25); /* cell 0 of the middle: x from 1 to 2, y and z below */
    split(&a, 0);
    assert_true(taken(*state, &a));
    a = right_answer(); /* a point on the side x = 0 that rounding has put beyond it: a hat as below, all but flat */
    add_hat(&a, -1e-15);
    assert_true(taken(*state, &a));
}

static void a_helper_that_goes_wrong_ends_the_work(void **state)
{
    static const struct {
        int way;
        const char *word;
    } list[] = {{FAKE_CRASH, "signal 11"}, {FAKE_ABORT, "signal 6"},   {FAKE_EXIT, "3"},
                {FAKE_SPIN, "0.5 s"},      {FAKE_SILENT, "no answer"}, {FAKE_THROW, "internal error"},
                {FAKE_MOVE, "moved"},      {FAKE_NAN, "moved"},        {FAKE_SHORT, "without points"},
                {FAKE_TYPES, "without"},   {FAKE_NO_TETS, "without"},  {FAKE_NO_VOLUME, "volumes"},
                {FAKE_CROOKED, "without"}};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        say a = right_answer();
        a.head.way = list[i].way;
        check_refused(*state, &a, list[i].word);
    }
}

static void a_helper_that_takes_all_memory_ends_the_work(void **state)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    skip(); /* they need address space: there is no limit */
#endif
    say a = right_answer();
    a.head.way = FAKE_SWALLOW;
    check_refused(*state, &a, "ran out of memory");
}

static void wrong_arrays_are_taken(void **state)
{
    const fake *f = *state;
    say a = right_answer();
    a.tet[5] = 24 + 7;
    check_refused(f, &a, "names point");
    a = right_answer(), a.tet[5] = -1;
    check_refused(f, &a, "names point -1");
    a = right_answer(), a.tet[5] = INT32_MIN;
    check_refused(f, &a, "names point");
    a = right_answer(), a.tet[5] = a.tet[4];
    check_refused(f, &a, "repeats a point");
    a = right_answer(), a.head.n_tet -= 1;
    check_refused(f, &a, "without points and tetrahedra");
    a = right_answer(), a.head.n_tet = 0;
    check_refused(f, &a, "do not fill");
    a = right_answer(), a.head.hull_volume *= 1 + 1e-8;
    check_refused(f, &a, "volumes");
    a = right_answer(), a.head.hull_volume = -a.head.hull_volume;
    check_refused(f, &a, "volumes");
}

static void cells_that_do_not_fill_the_gap_are_taken(void **state)
{
    const fake *f = *state;
    say a;
    for (int t = 0; t < 12; t++) {
        a = right_answer();
        a.head.n_tet -= 4; /* one is missing */
        if (t < 11)
            memcpy(a.tet + 4 * t, a.tet + a.head.n_tet, 4 * sizeof *a.tet);
        check_refused(f, &a, "do not fill");
        a = right_answer(); /* one is inside out */
        int32_t k = a.tet[4 * t];
        a.tet[4 * t] = a.tet[4 * t + 1], a.tet[4 * t + 1] = k;
        check_refused(f, &a, "negative volume");
        a = right_answer(); /* one is there twice */
        add_tet(&a, a.tet[4 * t], a.tet[4 * t + 1], a.tet[4 * t + 2], a.tet[4 * t + 3]);
        check_refused(f, &a, "do not fit");
    }
}

static void added_points_may_lie_anywhere(void **state)
{
    const fake *f = *state;
    say a = right_answer();
    add_point(&a, 1.5, 1, 0.5);
    check_refused(f, &a, "none of its tetrahedra");
    a = right_answer();
    add_point(&a, 1.75, 0.5, NAN);
    split(&a, 0);
    check_refused(f, &a, "not finite");
    a = right_answer(); /* beside the cell that it splits */
    add_point(&a, 1.25, 0.5, 0.75);
    split(&a, 0);
    check_refused(f, &a, "negative volume");
    a = right_answer(); /* within real cells */
    add_point(&a, 0.5, 0.5, 0.25);
    split(&a, 0);
    check_refused(f, &a, "negative volume");
    /* A hat on the side x = 0, convex with the box, volume right: it would only make the frame larger. */
    a = right_answer();
    add_hat(&a, -0.5);
    a.head.hull_volume = (6 + 2 * 0.5 / 3) * SCALE * SCALE * SCALE;
    check_refused(f, &a, "outside the mesh's bounds");
}

/* Cells within real material, and cells of their own: their faces are open, or belong to three. */
static void cells_in_real_cells_are_taken(void **state)
{
    const fake *f = *state;
    say a = right_answer();
    for (int k = 0; k < 4; k++) {
        static const double p[4][3] = {{0.1, 0.1, 0.1}, {0.6, 0.2, 0.1}, {0.2, 0.7, 0.2}, {0.3, 0.3, 0.8}};
        add_point(&a, p[k][0], p[k][1], p[k][2]);
    }
    add_tet(&a, STEINER, STEINER + 1, STEINER + 2, STEINER + 3);
    check_refused(f, &a, "do not fill");
    tc_mesh *m = gap_mesh();
    shape_prepare(m, TC_REENTRY_PEEL);
    for (size_t t = 0; t < m->n_tet; t++) { /* a real cell again, as an imaginary one */
        int32_t v[4];
        for (int c = 0; c < 4; c++) {
            const double *p = m->vertex + 3 * (size_t)m->tet[4 * t + (size_t)c];
            v[c] = (int32_t)((p[2] * (size[1] + 1) + p[1]) * (size[0] + 1) + p[0]);
        }
        a = right_answer();
        add_tet(&a, v[0], v[1], v[2], v[3]);
        check_refused(f, &a, "do not fi");
    }
    tc_mesh_destroy(&m);
}

static uint32_t next_random(uint32_t *x)
{
    *x ^= *x << 13, *x ^= *x >> 17, *x ^= *x << 5;
    return *x;
}

/* Random cells, and the right ones with some corners, cells and orientations changed: what is taken fills the hull
 * exactly. */
static void random_answers_are_taken(void **state)
{
    uint32_t seed = 12345;
    int n_taken = 0;
    for (int run = 0; run < 200; run++) {
        say a = right_answer();
        if (run % 4 == 0) {
            a.head.n_tet = 4 * (int64_t)(1 + next_random(&seed) % 40);
            for (int64_t i = 0; i < a.head.n_tet; i++)
                a.tet[i] = (int32_t)(next_random(&seed) % 24);
        }
        for (uint32_t k = next_random(&seed) % 3; k > 0; k--) {
            int64_t i = next_random(&seed) % (uint32_t)a.head.n_tet, j = i / 4 * 4 + next_random(&seed) % 4;
            int32_t v = a.tet[i];
            if (next_random(&seed) % 2)
                a.tet[i] = (int32_t)(next_random(&seed) % 24);
            else
                a.tet[i] = a.tet[j], a.tet[j] = v;
        }
        n_taken += taken(*state, &a);
    }
    assert_in_range(n_taken, 20, 80); /* those that were changed in nothing */
}

/* The real mesh overlaps itself: there is no answer that is right. */
static void overlapping_cells_can_be_filled(void **state)
{
    const fake *f = *state;
    shape s = {0};
    shape_grid(&s, size, NULL);
    int32_t first = (int32_t)s.n_vertex;
    const double inner[4][3] = {{0.3, 0.3, 0.2}, {2.4, 0.5, 0.3}, {0.7, 1.6, 0.4}, {1.1, 0.9, 0.8}};
    for (int k = 0; k < 4; k++)
        shape_vertex(&s, inner[k][0], inner[k][1], inner[k][2]);
    shape_tet(&s, first, first + 1, first + 2, first + 3);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_prepare(m, TC_REENTRY_PEEL);
    say nothing = {.head = {.hull_volume = 6 * SCALE * SCALE * SCALE}, .local = true};
    FILE *file = fopen(f->answer, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(&nothing.head, sizeof nothing.head, 1, file), 1);
    assert_int_equal(fclose(file), 0);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_AUTO);
    assert_int_equal(r.reentry, TC_REENTRY_PEEL);
    assert_non_null(strstr(r.reentry_why, "do not fill"));
    tc_mesh_destroy(&m);
    shape_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(right_answers_are_refused, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(a_helper_that_goes_wrong_ends_the_work, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(a_helper_that_takes_all_memory_ends_the_work, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(wrong_arrays_are_taken, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(cells_that_do_not_fill_the_gap_are_taken, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(added_points_may_lie_anywhere, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(cells_in_real_cells_are_taken, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(random_answers_are_taken, fake_setup, fake_teardown),
        cmocka_unit_test_setup_teardown(overlapping_cells_can_be_filled, fake_setup, fake_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
