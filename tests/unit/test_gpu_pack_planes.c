/* test_gpu_pack_planes.c: the textures of the paper's arithmetic (Weiler et al. 2003, Table 1), judged from the mesh.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/pack_planes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct fixture {
    tc_mesh *mesh;
    tc_pack pack;
    tc_pack_planes planes;
} fixture;

static fixture fixture_of(tc_mesh *mesh)
{
    fixture f = {.mesh = mesh};
    tc_error err = {0};
    if (tc_mesh_prepare(mesh, NULL, NULL, &err) != TC_OK || tc_pack_build(&f.pack, mesh, 0, &err) != TC_OK ||
        tc_pack_planes_build(&f.planes, mesh, &f.pack, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_int_equal(f.planes.n_cell, f.pack.n_cell);
    return f;
}

static fixture synth(const char *name, size_t n_cells)
{
    tc_mesh *mesh;
    assert_int_equal(tc_synth_create(&mesh, name, n_cells, 3, NULL), TC_OK);
    return fixture_of(mesh);
}

static fixture tets(const double (*vertex)[3], size_t n_vertex, const int32_t (*tet)[4], size_t n_tet,
                    const double *scalar)
{
    const tc_mesh_arrays arrays = {n_vertex, &vertex[0][0], n_tet, &tet[0][0], scalar, TC_POINT_DATA, "f"};
    tc_mesh *mesh;
    assert_int_equal(tc_mesh_create(&mesh, &arrays, NULL), TC_OK);
    return fixture_of(mesh);
}

static void finish(fixture *f)
{
    tc_pack_planes_finish(&f->planes);
    tc_pack_finish(&f->pack);
    tc_mesh_destroy(&f->mesh);
}

static double dot(const float *a, const float *b)
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

/* n(t,i) of a face, and its fourth entry without the sign, less 1. */
static const float *normal_of(const fixture *f, size_t t, size_t i)
{
    return f->planes.normal + 16 * t + 4 * i;
}

static int face_behind(const fixture *f, size_t t, size_t i)
{
    return (int)fabsf(normal_of(f, t, i)[3]) - 1;
}

static void check(const char *name, size_t n_cells)
{
    fixture f = synth(name, n_cells);
    size_t imaginary = 0;
    for (size_t t = 0; t < f.planes.n_cell; t++) {
        const int32_t *tet = f.mesh->tet + 4 * t;
        const float *g = f.planes.scalar + 4 * t;
        imaginary += normal_of(&f, t, 0)[3] < 0;
        for (size_t i = 0; i < 4; i++) {
            const float *n = normal_of(&f, t, i), *v = f.planes.vertex + 16 * t + 4 * i;
            assert_memory_equal(v, f.pack.vertex + 4 * (size_t)tet[i], 3 * sizeof *v);
            assert_true((n[3] < 0) == (t >= f.mesh->n_tet));
            assert_true(fabs(dot(n, n) - 1) < 1e-6);
            for (size_t k = 0; k < 4; k++) { /* the three others lie in the face's plane, this one behind it */
                double above =
                    dot(n, f.planes.vertex + 16 * t + 4 * k) - dot(n, f.planes.vertex + 16 * t + 4 * ((i + 1) & 3));
                if (k == i)
                    assert_true(above < 0);
                else
                    assert_true(fabs(above) < 1e-6);
            }
            double steep = sqrt(dot(g, g));
            if (t < f.mesh->n_tet) /* imaginary ones may be as flat as they like */
                assert_true(fabs(dot(g, v) + (double)g[3] - (double)f.pack.vertex[4 * tet[i] + 3]) <
                            1e-6 * (1 + steep));
            int32_t other = f.planes.neighbour[4 * t + i];
            assert_int_equal(other, f.mesh->neighbour[4 * t + i]);
            if (other < 0) {
                assert_int_equal(face_behind(&f, t, i), 0);
                continue;
            }
            size_t j = (size_t)face_behind(&f, t, i);
            assert_in_range(j, 0, 3);
            assert_int_equal(f.planes.neighbour[4 * (size_t)other + j], (int32_t)t); /* and back */
            assert_int_equal(face_behind(&f, (size_t)other, j), (int)i);
            const float *m = normal_of(&f, (size_t)other, j);
            for (int k = 0; k < 3; k++) /* the same face, seen from the other side */
                assert_true(fabsf(n[k] + m[k]) < 1e-6f);
        }
    }
    assert_int_equal(imaginary, f.mesh->n_imaginary);
    finish(&f);
}

static void a_cell_is_not_what_its_planes_say(void **state)
{
    (void)state;
    check("kuhn", 1500);
    check("ball", 2000);
    check("shells", 3000);
    check("tet", 0);
}

static void cells_across_two_faces_are_mixed_up(void **state)
{
    (void)state;
    fixture f = synth("two", 0);
    int links = 0;
    for (size_t i = 0; i < 4; i++) {
        int32_t other = f.planes.neighbour[i];
        links += other >= 0;
        if (other >= 0)
            assert_int_equal(f.planes.neighbour[4 * (size_t)other + (size_t)face_behind(&f, 0, i)], 0);
    }
    assert_int_equal(links, 1);
    finish(&f);
}

static void a_cell_without_volume_has_an_endless_gradient(void **state)
{
    (void)state;
    static const double vertex[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}};
    static const int32_t tet[2][4] = {{0, 1, 2, 3}, {0, 1, 2, 4}};
    static const double scalar[5] = {0, 2, 4, 8, 1};
    fixture f = tets(vertex, 5, tet, 2, scalar);
    int flat = 0;
    for (size_t t = 0; t < f.mesh->n_tet; t++) {
        const float *g = f.planes.scalar + 4 * t;
        for (size_t i = 0; i < 4; i++)
            assert_true(isfinite(g[i]) && fabs(dot(normal_of(&f, t, i), normal_of(&f, t, i)) - 1) < 1e-6);
        if (g[0] == 0 && g[1] == 0 && g[2] == 0) {
            assert_true(fabsf(g[3] - (0 + 2 + 4 + 8) / 32.0f) < 1e-6f);
            flat++;
        }
    }
    assert_int_equal(flat, 1);
    finish(&f);
}

static void a_face_without_area_has_a_normal_of_nan(void **state)
{
    (void)state;
    static const double vertex[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    static const int32_t tet[1][4] = {{0, 1, 2, 3}};
    static const double scalar[4] = {0, 1, 2, 3};
    fixture f = tets(vertex, 4, tet, 1, scalar);
    int empty = 0;
    for (size_t i = 0; i < 4; i++) {
        const float *n = normal_of(&f, 0, i);
        double square = dot(n, n);
        assert_true(square == 0 || fabs(square - 1) < 1e-6);
        empty += square == 0;
    }
    assert_int_equal(empty, 1);
    finish(&f);
}

static void a_missing_value_hides_in_a_gradient(void **state)
{
    (void)state;
    static const double vertex[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    static const int32_t tet[2][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    static const double scalar[5] = {NAN, 1, 2, 3, 4};
    fixture f = tets(vertex, 5, tet, 2, scalar);
    int missing = 0;
    for (size_t t = 0; t < 2; t++)
        missing += isnan(f.planes.scalar[4 * t + 3]);
    assert_int_equal(missing, 1);
    finish(&f);
}

static void the_paper_s_bytes_are_not_160(void **state)
{
    (void)state;
    fixture f;
    memset(&f, 0, sizeof f);
    assert_int_equal(16 * sizeof *f.planes.vertex + 16 * sizeof *f.planes.normal + 4 * sizeof *f.planes.neighbour +
                         4 * sizeof *f.planes.scalar,
                     TC_PACK_PLANES_BYTES);
    assert_int_equal(TC_PACK_PLANES_BYTES, 160); /* section 6 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cell_is_not_what_its_planes_say),
        cmocka_unit_test(cells_across_two_faces_are_mixed_up),
        cmocka_unit_test(a_cell_without_volume_has_an_endless_gradient),
        cmocka_unit_test(a_face_without_area_has_a_normal_of_nan),
        cmocka_unit_test(a_missing_value_hides_in_a_gradient),
        cmocka_unit_test(the_paper_s_bytes_are_not_160),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
