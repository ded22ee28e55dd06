/* test_reference_overlap.c: in what order the reference caster sees cells that overlap (overlap.c), against closed
 * forms: runs of cells that share faces, each whole, in the order of entry. */
#include "test_reference_fixture.h"

/* Red at 0, green at 1, blue at 2, and nothing of one in the other: steps between. */
static tc_knot color_knot[] = {{0, 1, 0, 0, 2},     {0.5, 1, 0, 0, 2}, {0.5, 0, 1, 0, 1.5},
                               {1.5, 0, 1, 0, 1.5}, {1.5, 0, 0, 1, 1}, {2, 0, 0, 1, 1}};
static struct tc_transfer colors = {.n = 6, .knot = color_knot};
static const double ATTENUATION[3] = {2, 1.5, 1};

/* A tower of n tets along z around the z axis, from z0 on, each as high as `step`: triangles turned against each other
 * would not be linear along z; here each triangle is the one below moved up, cut into three tets a storey. */
static void add_tower(struct tc_mesh *m, double z0, double step, int n, double value)
{
    static const double at[3][2] = {{-1, -1}, {1, -1}, {0, 1.5}};
    int32_t first = (int32_t)m->n_vertex;
    for (int k = 0; k <= n; k++)
        for (int c = 0; c < 3; c++) {
            double *x = m->vertex + 3 * m->n_vertex++;
            x[0] = at[c][0], x[1] = at[c][1], x[2] = z0 + step * k;
        }
    for (int k = 0; k < n; k++)
        for (int c = 0; c < 3; c++) { /* a0 b0 c0 a1, b0 c0 a1 b1, c0 a1 b1 c1 */
            for (int i = 0; i < 4; i++)
                m->tet[4 * m->n_tet + (size_t)i] = first + 3 * k + c + i;
            m->scalar[m->n_tet++] = value;
        }
}

static struct tc_mesh empty_mesh(void)
{
    struct tc_mesh m = mesh_alloc(200, 200);
    m.n_vertex = m.n_tet = 0;
    m.association = TC_CELL_DATA;
    return m;
}

typedef struct part {
    int color;
    double length;
} part;

/* Traces straight up at (x, y) from z = from, and compares with parts in the order seen. */
static void check(const struct tc_mesh *m, double from, const part *seen, int n, int line)
{
    tc_reference *r = reference_of(m);
    for (int i = 0; i < 20; i++) {
        const double o[3] = {0.3 * sin(i), 0.3 * cos(2.0 * i), from}, up[3] = {0, 0, 1};
        double want[4] = {0, 0, 0, 0}, clear = 1, length = 0;
        for (int k = 0; k < n; k++) {
            double a = -expm1(-ATTENUATION[seen[k].color] * seen[k].length);
            want[seen[k].color] += clear * a;
            clear *= 1 - a;
            length += seen[k].length;
        }
        want[3] = 1 - clear;
        tc_reference_ray ray = trace(r, &colors, o, up, from > -50 ? 0 : -INFINITY);
        near_(ray.length, length, 1e-12, "length", line);
        for (int k = 0; k < 4; k++)
            near_(ray.rgba[k], want[k], 1e-12, "colour", line);
    }
    tc_reference_destroy(&r);
}

#define CHECK(m, from, ...)                                                                                            \
    check(m, from, (const part[]){__VA_ARGS__}, (int)(sizeof((part[]){__VA_ARGS__}) / sizeof(part)), __LINE__)

static void overlapping_runs_are_mixed(void **state)
{
    (void)state;
    struct tc_mesh m = empty_mesh();
    add_tower(&m, 0, 0.25, 8, 0);   /* 0 to 2 */
    add_tower(&m, 1.1, 0.25, 8, 1); /* 1.1 to 3.1 */
    CHECK(&m, -1, {0, 2}, {1, 2});
    CHECK(&m, -100, {0, 2}, {1, 2});
    CHECK(&m, 1.5, {0, 0.5}, {1, 1.6}); /* the eye in both: in the order in which they begin behind it */
    CHECK(&m, 2.3, {1, 0.8});
    add_tower(&m, 0.3, 0.1, 3, 2); /* within the first alone */
    CHECK(&m, -1, {0, 2}, {2, 0.3}, {1, 2});
    mesh_free(&m);
}

static void runs_that_begin_at_one_place_are_seen_in_any_order(void **state)
{
    (void)state;
    struct tc_mesh m = empty_mesh();
    add_tower(&m, 0.5, 0.5, 4, 1);
    add_tower(&m, 0.5, 0.25, 2, 0); /* shorter, but its cells come later */
    add_tower(&m, 0.5, 0.5, 4, 2);
    CHECK(&m, -1, {1, 2}, {0, 0.5}, {2, 2});
    mesh_free(&m);
}

static void cells_apart_are_seen_in_another_order_than_that_in_space(void **state)
{
    (void)state;
    struct tc_mesh m = empty_mesh();
    add_tower(&m, 3, 0.5, 2, 0);
    add_tower(&m, 0, 0.5, 2, 1);
    add_tower(&m, 1, 0.5, 4, 2);
    CHECK(&m, -1, {1, 1}, {2, 2}, {0, 1});
    mesh_free(&m);
}

/* A face with a third cell joins nothing: what was one run are two. */
static void a_face_of_three_cells_joins_two_of_them(void **state)
{
    (void)state;
    struct tc_mesh m = empty_mesh();
    add_tower(&m, 0, 1, 3, 0); /* 0 to 3; the triangle at 1 is vertices 3, 4, 5 */
    add_tower(&m, 0.5, 1, 3, 1);
    CHECK(&m, -1, {0, 3}, {1, 3});
    double *x = m.vertex + 3 * m.n_vertex;
    x[0] = 0.1, x[1] = 0, x[2] = 1.2;
    int32_t *t = m.tet + 4 * m.n_tet;
    t[0] = 3, t[1] = 4, t[2] = 5, t[3] = (int32_t)m.n_vertex++;
    m.scalar[m.n_tet++] = 2;
    tc_reference *r = reference_of(&m);
    const double o[3] = {0.1, 0, -1}, up[3] = {0, 0, 1}; /* through the tip: the third cell is 0.2 high */
    tc_reference_ray ray = trace(r, &colors, o, up, 0);
    /* 0 to 1; the second tower, entered at 0.5; then, at 1, the rest of the first tower (its cell comes first), the
     * third */
    const part seen[4] = {{0, 1}, {1, 3}, {0, 2}, {2, 0.2}};
    double want[4] = {0, 0, 0, 0}, clear = 1;
    for (int k = 0; k < 4; k++) {
        double a = -expm1(-ATTENUATION[seen[k].color] * seen[k].length);
        want[seen[k].color] += clear * a;
        clear *= 1 - a;
    }
    for (int k = 0; k < 3; k++)
        NEAR(ray.rgba[k], want[k], 1e-12);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* Flat cells, and cells that the ray meets in an edge alone, keep a run together. */
static void a_cell_of_no_length_breaks_a_run(void **state)
{
    (void)state;
    struct tc_mesh m = mesh_alloc(20, 20);
    static const double x[][3] = {{-1, -1, 0}, {1, -1, 0},     {1, 1, 0},     {-1, 1, 0},    {0, 0, -1},
                                  {0, 0, 1},   {-1, -1, -0.5}, {2, -1, -0.4}, {-1, 2, -0.3}, {0, 0, 3}};
    memcpy(m.vertex, x, sizeof x);
    m.n_vertex = sizeof x / sizeof *x;
    /* a square as two triangles below, a flat tet, the square with the other diagonal above; a tet that overlaps all */
    static const int32_t tet[][4] = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 1, 2, 3},
                                     {0, 1, 3, 5}, {1, 2, 3, 5}, {6, 7, 8, 9}};
    static const double value[] = {0, 0, 2, 1, 1, 2};
    memcpy(m.tet, tet, sizeof tet);
    memcpy(m.scalar, value, sizeof value);
    m.n_tet = sizeof tet / sizeof *tet;
    m.association = TC_CELL_DATA;
    tc_reference *r = reference_of(&m);
    for (int i = 0; i < 50; i++) {
        const double o[3] = {0.2 * sin(i + 0.5), 0.2 * cos(2.0 * i), -5}, up[3] = {0, 0, 1};
        double reach = fmax(fabs(o[0]), fabs(o[1])), a[3], low = 1 - reach;
        tc_reference_ray ray = trace(r, &colors, o, up, 0);
        for (int c = 0; c < 2; c++)
            a[c] = -expm1(-ATTENUATION[c] * low);
        /* below and above as one run, then the other */
        NEAR(ray.rgba[0], a[0], 1e-12);
        NEAR(ray.rgba[1], (1 - a[0]) * a[1], 1e-12);
        a[2] = -expm1(-ATTENUATION[2] * (ray.length - 2 * low));
        NEAR(ray.rgba[2], (1 - a[0]) * (1 - a[1]) * a[2], 1e-12);
        assert_true(ray.length > 2 * low + 1);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* A cube cut in two ways, with common vertices outside and own ones within: cells on one side of common faces. Rays run
 * through vertices, along edges and in the planes of faces of both. Both cuts are seen, every cell once; near edges of
 * the cube they take turns, for faces there belong to four cells. */
static void coincident_grids_are_both_seen_along_edges_and_diagonals(void **state)
{
    (void)state;
    enum { n = 4, side = n + 1, n_tet = 6 * n * n * n };
    uint64_t random = 5;
    struct tc_mesh cube = kuhn_cube(n), m = mesh_alloc(2 * n_tet, 2 * n_tet);
    m.association = TC_CELL_DATA;
    int32_t own = (int32_t)cube.n_vertex, mirrored[side * side * side];
    for (int v = 0; v < (int)cube.n_vertex; v++) {
        int at[3] = {v % side, v / side % side, v / side / side};
        bool outside = false;
        for (int a = 0; a < 3; a++)
            outside = outside || at[a] == 0 || at[a] == n;
        int far = v - at[0] + (n - at[0]); /* the vertex at 1 - x */
        mirrored[v] = outside ? far : own;
        for (int a = 0; a < 3; a++) {
            double place = (double)at[a] / n, jitter = outside ? 0 : 0.15 / n;
            m.vertex[3 * v + a] = place + jitter * uniform(&random, -1, 1);
            if (!outside)
                m.vertex[3 * own + a] = (a == 0 ? 1 - place : place) + jitter * uniform(&random, -1, 1);
        }
        own += !outside;
    }
    for (int i = 0; i < 4 * n_tet; i++) {
        m.tet[i] = cube.tet[i];
        m.tet[4 * n_tet + i] = mirrored[cube.tet[i]];
    }
    for (int i = 0; i < n_tet; i++)
        m.scalar[n_tet + i] = 1;
    m.n_vertex = (size_t)own;
    tc_reference *r = reference_of(&m);
    double alpha = -expm1(-ATTENUATION[0] - ATTENUATION[1]);
    for (int axis = 0; axis < 6; axis++)
        for (int j = 1; j < 32; j++)
            for (int i = 1; i < 32; i++) {
                double o[3] = {i / 32.0, i / 32.0, i / 32.0}, d[3] = {0, 0, 0};
                o[(axis + 1) % 3] = j / 32.0;
                o[axis % 3] = axis < 3 ? -1 : 2;
                d[axis % 3] = axis < 3 ? 1 : -1;
                tc_reference_ray ray = trace(r, &colors, o, d, 0);
                NEAR(ray.length, 2, 1e-9);
                NEAR(ray.rgba[3], alpha, 1e-9);
                NEAR(ray.rgba[0] + ray.rgba[1], alpha, 1e-9);
            }
    tc_reference_destroy(&r);
    mesh_free(&cube);
    mesh_free(&m);
}

/* A flat cell between two cells that lie on one side of it joins them neither way: one would be walked backwards. */
static void a_flat_cell_does_not_turn_the_ray_back(void **state)
{
    (void)state;
    struct tc_mesh m = mesh_alloc(20, 20);
    static const double x[][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 0, 0.5}, {0, 0, 2}};
    memcpy(m.vertex, x, sizeof x);
    m.n_vertex = sizeof x / sizeof *x;
    /* a flat tet; on the two triangles of its one side a high tent, on those of its other side a low one */
    static const int32_t tet[][4] = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 3, 4}, {0, 1, 3, 5}, {1, 2, 3, 5}};
    static const double value[] = {2, 0, 0, 1, 1};
    memcpy(m.tet, tet, sizeof tet);
    memcpy(m.scalar, value, sizeof value);
    m.n_tet = sizeof tet / sizeof *tet;
    m.association = TC_CELL_DATA;
    tc_reference *r = reference_of(&m);
    for (int up = 0; up < 2; up++)
        for (int i = 0; i < 50; i++) {
            double px = 0.2 * sin(i + 0.5), py = 0.2 * cos(2.0 * i), reach = fmax(fabs(px), fabs(py));
            const double o[3] = {px, py, up ? -5 : 5}, d[3] = {0, 0, up ? 1 : -1};
            /* red from below comes first by its cells, from above by its place */
            double red = -expm1(-ATTENUATION[0] * (1 - reach)), green = -expm1(-ATTENUATION[1] * 0.5 * (1 - reach));
            tc_reference_ray ray = trace(r, &colors, o, d, 0);
            NEAR(ray.length, 1.5 * (1 - reach), 1e-12);
            NEAR(ray.rgba[0], red, 1e-12);
            NEAR(ray.rgba[1], (1 - red) * green, 1e-12);
        }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overlapping_runs_are_mixed),
        cmocka_unit_test(runs_that_begin_at_one_place_are_seen_in_any_order),
        cmocka_unit_test(cells_apart_are_seen_in_another_order_than_that_in_space),
        cmocka_unit_test(a_face_of_three_cells_joins_two_of_them),
        cmocka_unit_test(a_cell_of_no_length_breaks_a_run),
        cmocka_unit_test(coincident_grids_are_both_seen_along_edges_and_diagonals),
        cmocka_unit_test(a_flat_cell_does_not_turn_the_ray_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
