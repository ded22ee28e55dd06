/* test_edit_camera: moves of a pointer turn, shift, enlarge and roll the picture as a hand on it would. What is seen of
 * a camera is judged by projecting points, written apart from the code. */
#include "edit/camera_drag.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 800, HEIGHT = 600 };

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double *out, const double *a, const double *b)
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double length(const double *a)
{
    return sqrt(dot(a, a));
}

/* Pixels of a point, y downwards; gives its depth. */
static double project(double out[2], const tc_camera *c, const double *point)
{
    double ahead[3], right[3], up[3], at[3];
    for (int i = 0; i < 3; i++) {
        ahead[i] = c->focal_point[i] - c->position[i];
        at[i] = point[i] - c->position[i];
    }
    cross(right, ahead, c->view_up);
    cross(up, right, ahead);
    const double depth = dot(at, ahead) / length(ahead);
    const double half = c->parallel ? c->parallel_scale : depth * tan(c->view_angle * acos(-1.0) / 360);
    out[0] = WIDTH / 2.0 + dot(at, right) / length(right) / half * HEIGHT / 2;
    out[1] = HEIGHT / 2.0 - dot(at, up) / length(up) / half * HEIGHT / 2;
    return depth;
}

static double distance(const tc_camera *c)
{
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = c->focal_point[i] - c->position[i];
    return length(d);
}

static tc_camera oblique(bool parallel)
{
    tc_camera c = {.position = {3, -4, 7},
                   .focal_point = {0.5, 0.25, -1},
                   .view_up = {0.1, 1, 0.2},
                   .view_angle = 30,
                   .parallel_scale = 2.5,
                   .parallel = parallel};
    return c;
}

static void test_what_lies_before_the_focal_point_goes_along_with_a_turning_hand(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        tc_camera c = oblique(k & 1);
        double point[3], before[2], after[2];
        const double was = distance(&c);
        for (int i = 0; i < 3; i++)
            point[i] = c.focal_point[i] + 0.2 * (c.position[i] - c.focal_point[i]);
        project(before, &c, point);
        tc_camera_orbit(&c, k < 2 ? -5 : 0, k < 2 ? 0 : 5); /* as a hand that goes right; downwards */
        project(after, &c, point);
        assert_true(fabs(distance(&c) - was) < 1e-12 * was);
        assert_true(k < 2 ? after[0] > before[0] + 1 : after[1] > before[1] + 1);
        assert_true(fabs(k < 2 ? after[1] - before[1] : after[0] - before[0]) < 1);
    }
}

static void test_turning_on_over_the_poles_comes_back(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        tc_camera c = oblique(false), first;
        tc_camera_orbit(&c, 0, 0); /* up becomes square to the view */
        first = c;
        for (int i = 0; i < 72; i++) {
            tc_camera_orbit(&c, k ? 5 : 0, k ? 0 : 5);
            assert_true(fabs(length(c.view_up) - 1) < 1e-12);
        }
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(c.position[i] - first.position[i]) < 1e-9);
            assert_true(fabs(c.view_up[i] - first.view_up[i]) < 1e-9);
        }
    }
}

static void test_what_is_shifted_stays_under_the_pointer(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        tc_camera c = oblique(k);
        const tc_camera was = c;
        double after[2];
        tc_camera_pan(&c, 37, -21, HEIGHT);
        project(after, &c, was.focal_point);
        assert_true(fabs(after[0] - (WIDTH / 2.0 + 37)) < 1e-9);
        assert_true(fabs(after[1] - (HEIGHT / 2.0 - 21)) < 1e-9);
        assert_true(fabs(distance(&c) - distance(&was)) < 1e-12);
    }
}

static void test_what_is_under_the_wheel_stays_there_and_all_is_larger(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        tc_camera c = oblique(k), other = c;
        double point[3], before[2], after[2], middle[2];
        tc_camera_pan(&other, -150, 90, HEIGHT); /* its focal point is 150 right of and 90 above the first one's */
        memcpy(point, other.focal_point, sizeof point);
        project(before, &c, point);
        const double first[3] = {c.focal_point[0], c.focal_point[1], c.focal_point[2]};
        tc_camera_approach(&c, 1.7, before[0], before[1], WIDTH, HEIGHT);
        project(after, &c, point);
        project(middle, &c, first);
        assert_true(fabs(after[0] - before[0]) < 1e-9 && fabs(after[1] - before[1]) < 1e-9);
        const double wanted[2] = {before[0] + 1.7 * (WIDTH / 2.0 - before[0]),
                                  before[1] + 1.7 * (HEIGHT / 2.0 - before[1])};
        assert_true(fabs(middle[0] - wanted[0]) < 1e-9 && fabs(middle[1] - wanted[1]) < 1e-9);
    }
}

static void test_no_factor_that_is_none_moves_the_eye(void **state)
{
    (void)state;
    static const double wrong[] = {0, -1, NAN, INFINITY};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_camera c = oblique(false);
        const tc_camera was = c;
        tc_camera_approach(&c, wrong[i], NAN, NAN, WIDTH, HEIGHT);
        assert_memory_equal(&c, &was, sizeof c);
    }
}

static void test_what_is_rolled_stays_under_the_pointer(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        tc_camera c = oblique(k), other = c;
        double point[3], after[2];
        const double from[2] = {WIDTH / 2.0 + 200, HEIGHT / 2.0}, angle = 0.6;
        const double to[2] = {WIDTH / 2.0 + 200 * cos(angle), HEIGHT / 2.0 + 200 * sin(angle)};
        tc_camera_pan(&other, -200, 0, HEIGHT);
        memcpy(point, other.focal_point, sizeof point);
        tc_camera_twist(&c, from[0], from[1], to[0], to[1], WIDTH, HEIGHT);
        project(after, &c, point);
        assert_true(fabs(after[0] - to[0]) < 1e-9 && fabs(after[1] - to[1]) < 1e-9);
    }
}

static void test_from_each_side_all_of_the_box_is_seen(void **state)
{
    (void)state;
    static const double bounds[6] = {-1, 3, 2, 2.5, -7, 4};
    for (int k = 0; k < 12; k++) {
        tc_camera c = oblique(k >= 6);
        const int axis = k % 6 / 2;
        const bool negative = k & 1;
        c.clip_near = 0.5;
        c.clip_far = 100;
        tc_camera_stand(&c, axis, negative, bounds, (double)WIDTH / HEIGHT);
        for (int i = 0; i < 3; i++) {
            const double off = c.position[i] - c.focal_point[i];
            assert_true(i == axis ? (negative ? off < -1e-3 : off > 1e-3) : fabs(off) < 1e-9);
        }
        for (int corner = 0; corner < 8; corner++) {
            double point[3], at[2];
            for (int i = 0; i < 3; i++)
                point[i] = bounds[2 * i + (corner >> i & 1)];
            assert_true(project(at, &c, point) > 0);
            assert_true(at[0] > 0 && at[0] < WIDTH && at[1] > 0 && at[1] < HEIGHT);
        }
        assert_true(c.parallel == (k >= 6));
        assert_true(c.clip_near == 0.5 && c.clip_far == 100);
        assert_true(c.view_up[axis == 2 ? 1 : 2] > 0.99);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_lies_before_the_focal_point_goes_along_with_a_turning_hand),
        cmocka_unit_test(test_turning_on_over_the_poles_comes_back),
        cmocka_unit_test(test_what_is_shifted_stays_under_the_pointer),
        cmocka_unit_test(test_what_is_under_the_wheel_stays_there_and_all_is_larger),
        cmocka_unit_test(test_no_factor_that_is_none_moves_the_eye),
        cmocka_unit_test(test_what_is_rolled_stays_under_the_pointer),
        cmocka_unit_test(test_from_each_side_all_of_the_box_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
