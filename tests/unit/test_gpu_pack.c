/* test_gpu_pack.c: the packed records, judged from the mesh alone. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/vec.h"
#include "gpu/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static tc_mesh *synth(const char *name, size_t n_cells)
{
    tc_mesh *mesh;
    tc_error err = {0};
    const tc_prepare_options options = {.reentry = TC_REENTRY_AUTO};
    if (tc_synth_create(&mesh, name, n_cells, 3, &err) != TC_OK || tc_mesh_prepare(mesh, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return mesh;
}

static tc_pack pack_of(const tc_mesh *mesh)
{
    tc_pack pack;
    tc_error err = {0};
    if (tc_pack_build(&pack, mesh, 0, &err) != TC_OK)
        fail_msg("%s", err.text);
    return pack;
}

/* What the shader does (mesh.glsl), from the record alone. */
static int32_t fourth(const tc_pack *p, int32_t cell, const int32_t *face)
{
    return p->cell[TC_PACK_CELL_INTS * cell] ^ face[0] ^ face[1] ^ face[2];
}

/* The neighbour opposite vertex v, whose face is given, XOR the one opposite the vertex of the largest number. */
static int32_t other(const tc_pack *p, int32_t cell, int32_t v, const int32_t *face)
{
    int rank = (v > face[0]) + (v > face[1]) + (v > face[2]);
    return rank < 3 ? p->cell[TC_PACK_CELL_INTS * cell + 1 + rank] : 0;
}

/* The cell behind `exit` of who came from `from` through `entry`. */
static int32_t behind(const tc_pack *p, int32_t cell, int32_t from, const int32_t *entry, const int32_t *exit)
{
    return from ^ other(p, cell, fourth(p, cell, entry), entry) ^ other(p, cell, fourth(p, cell, exit), exit);
}

static void check_records(const char *name, size_t n_cells)
{
    tc_mesh *mesh = synth(name, n_cells);
    tc_pack p = pack_of(mesh);
    assert_int_equal(p.n_cell, mesh->n_tet + mesh->n_imaginary);
    assert_int_equal(p.n_real, mesh->n_tet);
    assert_int_equal(p.n_vertex, mesh->n_vertex);
    size_t outside = 0;
    for (size_t i = 0; i < p.n_cell; i++) {
        const int32_t *tet = mesh->tet + 4 * i, *neighbour = mesh->neighbour + 4 * i;
        int32_t face[4][3];
        for (int f = 0; f < 4; f++) {
            for (int k = 0; k < 3; k++)
                face[f][k] = tet[(f + 1 + k) & 3];
            assert_int_equal(fourth(&p, (int32_t)i, face[f]), tet[f]);
            outside += neighbour[f] < 0;
        }
        for (int f = 0; f < 16; f++) /* from each to each, and back */
            assert_int_equal(
                behind(&p, (int32_t)i, neighbour[f / 4] < 0 ? -1 : neighbour[f / 4], face[f / 4], face[f % 4]),
                neighbour[f % 4] < 0 ? -1 : neighbour[f % 4]);
    }
    assert_int_equal(p.n_face, outside);
    tc_pack_finish(&p);
    tc_mesh_destroy(&mesh);
}

static void a_step_leads_to_another_vertex_or_cell(void **state)
{
    (void)state;
    check_records("kuhn", 1500);
    check_records("shells", 3000);
    check_records("two", 0);
    check_records("tet", 0);
}

static void boundary_faces_look_inside(void **state)
{
    (void)state;
    tc_mesh *mesh = synth("ball", 3000); /* convex around the origin */
    tc_pack p = pack_of(mesh);
    for (size_t i = 0; i < p.n_face; i++) {
        const int32_t *face = p.face + 4 * i;
        double ab[3], ac[3], normal[3], at[3];
        const double *a = mesh->vertex + 3 * face[0], *b = mesh->vertex + 3 * face[1], *c = mesh->vertex + 3 * face[2];
        tc_vec_sub(ab, b, a);
        tc_vec_sub(ac, c, a);
        tc_vec_cross(normal, ab, ac);
        for (int k = 0; k < 3; k++)
            at[k] = (a[k] + b[k] + c[k]) / 3;
        assert_true(tc_vec_dot(normal, at) > 0);
        const int32_t *neighbour = mesh->neighbour + 4 * face[3], *tet = mesh->tet + 4 * face[3];
        for (int f = 0; f < 4; f++)
            assert_true((neighbour[f] < 0) >= (tet[f] == fourth(&p, face[3], face)));
        for (int k = 0; k < 3; k++)
            assert_memory_equal(p.face_corner + 9 * i + 3 * k, p.vertex + 4 * face[k], 3 * sizeof(float));
    }
    tc_pack_finish(&p);
    tc_mesh_destroy(&mesh);
}

static void positions_are_rounded_more_than_once(void **state)
{
    (void)state;
    static const double vertex[5][3] = {{1e7, 1e7, 1e7},
                                        {1e7 + 1, 1e7, 1e7},
                                        {1e7, 1e7 + 1, 1e7},
                                        {1e7, 1e7, 1e7 + 2},
                                        {1e7 + 0.3, 1e7 + 0.4, 1e7 + 0.7}};
    static const int32_t tet[4][4] = {{0, 1, 2, 4}, {0, 1, 3, 4}, {0, 2, 3, 4}, {1, 2, 3, 4}};
    static const double scalar[5] = {-3, NAN, 5, INFINITY, 1};
    const tc_mesh_arrays arrays = {5, &vertex[0][0], 4, &tet[0][0], scalar, TC_POINT_DATA, "f"};
    tc_mesh *mesh;
    assert_int_equal(tc_mesh_create(&mesh, &arrays, NULL), TC_OK);
    assert_int_equal(tc_mesh_prepare(mesh, NULL, NULL, NULL), TC_OK);
    tc_pack p = pack_of(mesh);
    double half = 0.5 * sqrt(1 + 1 + 4);
    assert_true(fabs(p.scale * half - 1) < 1e-12);
    assert_true(p.scalar_lo == -3 && p.scalar_hi == 5);
    for (int i = 0; i < 5; i++) {
        const double center[3] = {1e7 + 0.5, 1e7 + 0.5, 1e7 + 1};
        const float *v = p.vertex + 4 * mesh->vertex_of_source[i];
        for (int k = 0; k < 3; k++)
            assert_true(fabs(v[k] - (vertex[i][k] - center[k]) / half) <= 0x1p-24);
        if (isfinite(scalar[i]))
            assert_true(v[3] == (float)((scalar[i] + 3) / 8));
        else
            assert_true(isnan(v[3]));
    }
    tc_pack_finish(&p);
    tc_mesh_destroy(&mesh);
}

static void cell_data_belong_to_other_cells(void **state)
{
    (void)state;
    tc_mesh *mesh = synth("kuhn", 500);
    double *value = malloc(mesh->n_tet_source * sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < mesh->n_tet_source; i++)
        value[i] = (double)i;
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_CELL_DATA, NULL), TC_OK);
    tc_pack p = pack_of(mesh);
    assert_non_null(p.cell_scalar);
    for (size_t i = 0; i < mesh->n_tet_source; i++)
        assert_true(p.cell_scalar[mesh->tet_of_source[i]] == (float)((double)i / (double)(mesh->n_tet_source - 1)));
    for (size_t i = 0; i < p.n_vertex; i++)
        assert_true(p.vertex[4 * i + 3] == 0);
    free(value);
    tc_pack_finish(&p);
    tc_mesh_destroy(&mesh);
}

static void check_same(const tc_pack *a, const tc_pack *b)
{
    assert_int_equal(a->n_cell, b->n_cell);
    assert_int_equal(a->n_real, b->n_real);
    assert_int_equal(a->n_vertex, b->n_vertex);
    assert_memory_equal(a->vertex, b->vertex, a->n_vertex * TC_PACK_VERTEX_FLOATS * sizeof(float));
    assert_memory_equal(a->center, b->center, sizeof a->center);
    assert_true(a->scale == b->scale && a->scalar_lo == b->scalar_lo && a->scalar_hi == b->scalar_hi);
    assert_memory_equal(&a->extent, &b->extent, sizeof a->extent);
    if (a->cell_scalar)
        assert_memory_equal(a->cell_scalar, b->cell_scalar, a->n_real * sizeof(float));
    assert_true(!a->cell_scalar == !b->cell_scalar);
}

/* More than one chunk of cells, with gaps; the second time with other values, of cells. */
static void the_pack_depends_on_threads_or_values_packed_alone_differ(void **state)
{
    (void)state;
    tc_mesh *mesh = synth("shells", 40000);
    double *value = malloc(mesh->n_tet_source * sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < mesh->n_tet_source; i++)
        value[i] = i % 1000 == 7 ? (double)NAN : cos((double)i);
    for (int round = 0; round < 2; round++) {
        tc_pack one, many, alone;
        assert_int_equal(tc_pack_build(&one, mesh, 1, NULL), TC_OK);
        assert_int_equal(tc_pack_build(&many, mesh, 5, NULL), TC_OK);
        assert_int_equal(tc_pack_scalars(&alone, mesh, 3, NULL), TC_OK);
        check_same(&one, &many);
        check_same(&one, &alone);
        assert_int_equal(one.n_face, many.n_face);
        assert_memory_equal(one.cell, many.cell, one.n_cell * TC_PACK_CELL_INTS * sizeof *one.cell);
        assert_memory_equal(one.face, many.face, one.n_face * TC_PACK_FACE_INTS * sizeof *one.face);
        assert_memory_equal(one.face_corner, many.face_corner, one.n_face * 9 * sizeof *one.face_corner);
        double held = 0;
        for (int b = 0; b < TC_PACK_BINS; b++)
            held += one.extent.held[b];
        assert_true(held > 0 || round == 1); /* a cell of one value takes no share of a bin */
        assert_null(alone.cell);
        assert_null(alone.face);
        tc_pack_finish(&one);
        tc_pack_finish(&many);
        tc_pack_finish(&alone);
        assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_CELL_DATA, NULL), TC_OK);
    }
    free(value);
    tc_mesh_destroy(&mesh);
}

static void an_unprepared_mesh_is_packed(void **state)
{
    (void)state;
    tc_mesh *mesh;
    tc_pack p;
    tc_error err = {0};
    assert_int_equal(tc_synth_create(&mesh, "two", 0, 0, NULL), TC_OK);
    assert_int_equal(tc_pack_build(&p, mesh, 0, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "tc_mesh_prepare"));
    tc_mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_leads_to_another_vertex_or_cell),
        cmocka_unit_test(boundary_faces_look_inside),
        cmocka_unit_test(positions_are_rounded_more_than_once),
        cmocka_unit_test(cell_data_belong_to_other_cells),
        cmocka_unit_test(the_pack_depends_on_threads_or_values_packed_alone_differ),
        cmocka_unit_test(an_unprepared_mesh_is_packed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
