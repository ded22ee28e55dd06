/* test_stereo_parts.c: eyes are not where VTK has them, what lies in the focal plane is not at one place, or halves and
 * colours are swapped. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/picture/stereo.h"

#include <math.h>
#include <string.h>

static const double ASPECT = 1.75;

static tc_camera make_camera(bool parallel)
{
    return (tc_camera){.position = {7.4182199587116378, 8.1720820438885831, 9.6166830626411812},
                       .focal_point = {1, 3.5, -1.5},
                       .view_up = {0, 1, 0},
                       .view_angle = 30,
                       .parallel_scale = 3.5,
                       .parallel = parallel};
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double *out, const double *a, const double *b)
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    const double length = sqrt(dot(out, out));
    for (int i = 0; i < 3; i++)
        out[i] /= length;
}

/* Where a point is in the picture, -1 … 1 each way. */
static void project(double out[2], const tc_camera *c, const double *p)
{
    double forward[3], right[3], up[3], to[3];
    for (int i = 0; i < 3; i++)
        forward[i] = c->focal_point[i] - c->position[i], to[i] = p[i] - c->position[i];
    cross(right, forward, c->view_up);
    cross(up, right, forward);
    const double half = c->parallel ? c->parallel_scale : tan(c->view_angle * acos(-1.0) / 360);
    const double ahead = c->parallel ? 1 : dot(to, forward) / sqrt(dot(forward, forward));
    out[0] = dot(to, right) / (ahead * half * ASPECT) - c->window_center[0];
    out[1] = dot(to, up) / (ahead * half) - c->window_center[1];
}

/* The figures are those of VTK 9.1: the camera's view and frustum with vtkPerspectiveTransform::Stereo(-+1, distance),
 * which vtkCamera takes for an EyeAngle of 2. In parallel projection VTK shears where the eyes are turned here: of
 * second order. */
static void eyes_are_not_vtks(void **state)
{
    (void)state;
    static const double point[3][3] = {{1.5, 4, 0.5}, {-0.5, 2.5, -3}, {1, 3.5, -1.5}};
    static const double vtk[2][2][3][2] = {
        {{{-0.097487459266989401, -0.066783360476282069}, {-0.078811265676718742, -0.055972376500682555}, {0, 0}},
         {{-0.11050874378592192, -0.066783360476282069}, {-0.068212593969648544, -0.055972376500682555}, {0, 0}}},
        {{{-0.08677419176222978, -0.059444283111574681}, {-0.096100771153638131, -0.068251518343605877}, {0, 0}},
         {{-0.098364517823984143, -0.059444283111574681}, {-0.083176977638739963, -0.068251518343605877}, {0, 0}}}};
    for (int parallel = 0; parallel < 2; parallel++) {
        const tc_camera c = make_camera(parallel);
        tc_camera eye[2];
        assert_int_equal(tc_stereo_cameras(eye, &c, 2, ASPECT), 0);
        for (int e = 0; e < 2; e++)
            for (int i = 0; i < 3; i++) {
                double at[2];
                project(at, &eye[e], point[i]);
                for (int k = 0; k < 2; k++)
                    assert_true(fabs(at[k] - vtk[parallel][e][i][k]) < (parallel ? 1e-4 : 1e-14));
            }
    }
}

static void the_focal_plane_has_parallax(void **state)
{
    (void)state;
    tc_camera c = make_camera(false), eye[2];
    c.window_center[0] = 0.1, c.window_center[1] = -0.3;
    assert_int_equal(tc_stereo_cameras(eye, &c, 7, ASPECT), 0);
    double forward[3], right[3], up[3], apart[3];
    for (int i = 0; i < 3; i++)
        forward[i] = c.focal_point[i] - c.position[i], apart[i] = eye[1].position[i] - eye[0].position[i];
    cross(right, forward, c.view_up);
    cross(up, right, forward);
    const double distance = sqrt(dot(forward, forward));
    assert_true(fabs(dot(apart, right) - 2 * distance * tan(3.5 * acos(-1.0) / 180)) < 1e-12);
    for (int k = 0; k < 5; k++) {
        double p[3], at[2], left[2], right_at[2];
        for (int i = 0; i < 3; i++)
            p[i] = c.focal_point[i] + (k - 2) * right[i] + 0.7 * k * up[i];
        project(at, &c, p), project(left, &eye[0], p), project(right_at, &eye[1], p);
        assert_true(fabs(left[0] - at[0]) < 1e-13 && fabs(right_at[0] - at[0]) < 1e-13);
        assert_true(fabs(left[1] - at[1]) < 1e-13 && fabs(right_at[1] - at[1]) < 1e-13);
    }
    c.view_up[0] = forward[0], c.view_up[1] = forward[1], c.view_up[2] = forward[2]; /* along the view */
    assert_int_equal(tc_stereo_cameras(eye, &c, 2, ASPECT), 0);
    assert_true(isfinite(eye[0].position[0]) && eye[0].position[0] != eye[1].position[0]);
    memcpy(c.focal_point, c.position, sizeof c.position);
    assert_int_equal(tc_stereo_cameras(eye, &c, 2, ASPECT), -1);
}

static void halves_or_colours_are_swapped(void **state)
{
    (void)state;
    enum { W = 3, H = 2 };
    tc_image *left, *right, *out;
    assert_int_equal(tc_image_create(&left, W, H, NULL), TC_OK);
    assert_int_equal(tc_image_create(&right, W, H, NULL), TC_OK);
    for (int i = 0; i < 4 * W * H; i++)
        left->rgba[i] = 0.01f * (float)i, right->rgba[i] = 0.5f - 0.005f * (float)i;
    for (int kind = TC_STEREO_SIDE_BY_SIDE; kind <= TC_STEREO_ANAGLYPH; kind++) {
        const bool beside = kind == TC_STEREO_SIDE_BY_SIDE, below = kind == TC_STEREO_TOP_BOTTOM;
        assert_int_equal(tc_stereo_combine(&out, left, right, (tc_stereo)kind, NULL), TC_OK);
        assert_int_equal(out->width, beside ? 2 * W : W);
        assert_int_equal(out->height, below ? 2 * H : H);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const float *l = left->rgba + 4 * (y * W + x), *r = right->rgba + 4 * (y * W + x);
                const float *first = out->rgba + 4 * (y * out->width + x);
                const float *second = out->rgba + 4 * ((below ? y + H : y) * out->width + (beside ? x + W : x));
                if (beside || below) {
                    assert_memory_equal(first, l, 4 * sizeof *l);
                    assert_memory_equal(second, r, 4 * sizeof *r);
                } else {
                    assert_true(first[0] == l[0] && first[1] == r[1] && first[2] == r[2]);
                    assert_true(first[3] == fmaxf(l[3], r[3]));
                }
            }
        tc_image_destroy(&out);
    }
    tc_error err = {0};
    assert_int_equal(tc_stereo_combine(&out, left, right, TC_STEREO_PAIR, &err), TC_E_ARG);
    assert_null(out);
    tc_image_destroy(&right);
    assert_int_equal(tc_image_create(&right, W, H + 1, NULL), TC_OK);
    assert_int_equal(tc_stereo_combine(&out, left, right, TC_STEREO_ANAGLYPH, &err), TC_E_ARG);
    tc_image_destroy(&left);
    tc_image_destroy(&right);
}

static void names_of_eyes_are_one(void **state)
{
    (void)state;
    static const char *const row[][3] = {{"a.png", "a_left.png", "a_right.png"},
                                         {"b.d/a", "b.d/a_left", "b.d/a_right"},
                                         {"{eye}/a.exr", "left/a.exr", "right/a.exr"},
                                         {"x{eye}{step}.png", "xleft{step}.png", "xright{step}.png"}};
    char name[64];
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int eye = 0; eye < 2; eye++) {
            assert_true(tc_stereo_name(name, sizeof name, row[i][0], eye));
            assert_string_equal(name, row[i][1 + eye]);
        }
    assert_false(tc_stereo_name(name, 10, "a.png", 0));
    assert_true(tc_stereo_name(name, 11, "a.png", 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eyes_are_not_vtks),
        cmocka_unit_test(the_focal_plane_has_parallax),
        cmocka_unit_test(halves_or_colours_are_swapped),
        cmocka_unit_test(names_of_eyes_are_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
