/* values.c: a unit cube with values that are missing, constant, not finite or beyond a float's range, and with
 * coordinates that are not finite. */
#include "box.h"
#include "chord.h"
#include "soup.h"

#include <math.h>

static tc_status build_cube(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_box box = tc_box_unit(n_cells, 3, seed);
    return tc_box_build(out, &box, err);
}

/* A ball around the middle of the cube. */
static bool in_region(const double *p)
{
    double x = p[0] - 0.5, y = p[1] - 0.5, z = p[2] - 0.5;
    return x * x + y * y + z * z < 0.09;
}

/* About one in n. */
static bool one_in(uint64_t seed, uint64_t index, int n)
{
    return (tc_synth_noise(~seed, index) + 1) * n < 2 || index == 40;
}

/* A NaN or an infinity of either sign, in turn. */
static double not_finite(size_t index)
{
    return index % 3 == 0 ? NAN : index % 3 == 1 ? INFINITY : -INFINITY;
}

typedef double value_at(const double *p, uint64_t seed, size_t index);

static double nan_region(const double *p, uint64_t seed, size_t index)
{
    (void)seed, (void)index;
    return in_region(p) ? NAN : tc_field_linear(p);
}

static double nan_scattered(const double *p, uint64_t seed, size_t index)
{
    return one_in(seed, index, 40) ? NAN : tc_field_linear(p);
}

static double nan_all(const double *p, uint64_t seed, size_t index)
{
    (void)p, (void)seed, (void)index;
    return NAN;
}

static double inf_region(const double *p, uint64_t seed, size_t index)
{
    (void)seed, (void)index;
    return in_region(p) ? p[2] > 0.5 ? INFINITY : -INFINITY : tc_field_linear(p);
}

static double inf_scattered(const double *p, uint64_t seed, size_t index)
{
    return one_in(seed, index, 40) ? not_finite(index) : tc_field_linear(p);
}

/* The middle of tet t. */
static void tet_middle(double *out, const tc_synth_soup *s, size_t t)
{
    for (size_t k = 0; k < 3; k++) {
        out[k] = 0;
        for (size_t i = 0; i < 4; i++)
            out[k] += s->vertex[3 * (size_t)s->tet[4 * t + i] + k] / 4;
    }
}

static tc_status build_values(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_association association,
                              value_at *value, tc_error *err)
{
    tc_status status = build_cube(out, n_cells, seed, err);
    if (!status)
        status = tc_soup_values(out, association, err);
    if (status)
        return status;
    if (association == TC_POINT_DATA)
        for (size_t v = 0; v < out->n_vertex; v++)
            out->scalar[v] = value(out->vertex + 3 * v, seed, v);
    else
        for (size_t t = 0; t < out->n_tet; t++) {
            double p[3];
            tet_middle(p, out, t);
            out->scalar[t] = value(p, seed, t);
        }
    return TC_OK;
}

enum { cube = TC_SYNTH_SOUND | TC_SYNTH_CONVEX };

#define VALUES(id, association, value)                                                                                 \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build_values(out, n_cells, seed, association, value, err);                                              \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {6000, build_##id, tc_field_linear, NULL, cube, TC_SYNTH_NONFINITE_VALUES};

VALUES(nan_region, TC_POINT_DATA, nan_region)
VALUES(nan_scattered, TC_POINT_DATA, nan_scattered)
VALUES(nan_all, TC_POINT_DATA, nan_all)
VALUES(nan_cells, TC_CELL_DATA, nan_region)
VALUES(inf_region, TC_POINT_DATA, inf_region)
VALUES(inf_scattered, TC_POINT_DATA, inf_scattered)

/* Coordinates that are not finite at about one vertex in 80: nothing is seen of the cells around it. */
static tc_status build_points(tc_synth_soup *out, size_t n_cells, uint64_t seed, bool infinite, tc_error *err)
{
    tc_status status = build_cube(out, n_cells, seed, err);
    if (!status)
        status = tc_soup_values(out, TC_POINT_DATA, err);
    for (size_t v = 0; v < out->n_vertex && !status; v++) {
        out->scalar[v] = tc_field_linear(out->vertex + 3 * v);
        if (one_in(seed, v, 80))
            out->vertex[3 * v + v % 3] = infinite ? (v % 2 ? INFINITY : -INFINITY) : NAN;
    }
    return status;
}

static tc_status build_nan_coordinates(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    return build_points(out, n_cells, seed, false, err);
}

static tc_status build_inf_coordinates(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    return build_points(out, n_cells, seed, true, err);
}

static double constant(const double *p)
{
    (void)p;
    return 0.7;
}

static double huge(const double *p)
{
    return 1e300 * (tc_field_linear(p) - 0.3);
}

static double tiny(const double *p)
{
    return 1e-300 * (tc_field_linear(p) - 0.3);
}

static double far_from_zero(const double *p)
{
    return 1e9 + tc_field_linear(p);
}

enum { broken_points = TC_SYNTH_SIZED | TC_SYNTH_SEEDED };

const tc_synth_generator tc_synth_nan_coordinates = {
    6000, build_nan_coordinates, tc_field_linear,
    NULL, broken_points,         TC_SYNTH_NONFINITE_POINTS | TC_SYNTH_UNUSED_POINTS};
const tc_synth_generator tc_synth_inf_coordinates = {
    6000, build_inf_coordinates, tc_field_linear,
    NULL, broken_points,         TC_SYNTH_NONFINITE_POINTS | TC_SYNTH_UNUSED_POINTS};
const tc_synth_generator tc_synth_no_field = {6000, build_cube, NULL, tc_chord_unit_cube, cube, TC_SYNTH_NO_FIELD};
const tc_synth_generator tc_synth_constant = {6000, build_cube, constant, tc_chord_unit_cube, cube, TC_SYNTH_CONSTANT};
const tc_synth_generator tc_synth_values_1e300 = {6000, build_cube, huge, tc_chord_unit_cube, cube, 0};
const tc_synth_generator tc_synth_values_1e_300 = {6000, build_cube, tiny, tc_chord_unit_cube, cube, 0};
const tc_synth_generator tc_synth_values_offset_1e9 = {6000, build_cube, far_from_zero, tc_chord_unit_cube, cube, 0};
