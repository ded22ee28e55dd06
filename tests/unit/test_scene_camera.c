/* test_scene_camera.c: the camera against values of VTK 9.1 and against hand-computed ones; rays against clip space. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/vec.h"
#include "scene/camera.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define NEAR(a, b, tolerance) near_(a, b, tolerance, #a, __LINE__)

static void near_(double a, double b, double tolerance, const char *what, int line)
{
    if (!(fabs(a - b) <= tolerance)) /* NaN fails, too */
        fail_msg("line %d: %s = %.17g, expected %.17g", line, what, a, b);
}

static void near3(const double *a, double x, double y, double z, double tolerance)
{
    NEAR(a[0], x, tolerance);
    NEAR(a[1], y, tolerance);
    NEAR(a[2], z, tolerance);
}

static const double BOX[6] = {-1, 3, 2, 5, -4, 1};
static const double UP[3] = {0, 1, 0}, FRONT[3] = {0, 0, 1};

static tc_camera front(double aspect)
{
    tc_camera c = {.parallel = false};
    tc_camera_reset(&c, BOX, FRONT, UP, 30, aspect);
    return c;
}

/* The figures come from vtkRenderer::ResetCamera and vtkCamera of VTK 9.1, printed with 17 digits. */
static void camera_moves_otherwise_than_in_vtk(void **state)
{
    (void)state;
    tc_camera c = front(1);
    near3(c.position, 1, 3.5, 12.160254037844387, 1e-13);
    near3(c.focal_point, 1, 3.5, -1.5, 0);
    near3(c.view_up, 0, 1, 0, 0);
    NEAR(c.parallel_scale, 3.5355339059327378, 1e-15);
    tc_camera_azimuth(&c, 30);
    near3(c.position, 7.8301270189221928, 3.5, 10.330127018922195, 1e-13);
    tc_camera_elevation(&c, 20);
    near3(c.position, 7.4182199587116378, 8.1720820438885831, 9.6166830626411812, 1e-13);
    tc_camera_roll(&c, 15);
    near3(c.view_up, 0.21610195296141374, 0.96991174743196917, -0.11212113145935958, 1e-14);
    tc_camera_azimuth(&c, -75);
    near3(c.position, -7.5113086404544962, 11.083467657728621, 6.0266980734949396, 1e-13);
    tc_camera_elevation(&c, 35);
    near3(c.position, -2.3933267356688677, 16.216020589328611, 2.1593297767773802, 1e-13);
    near3(c.view_up, 0.21610195296141374, 0.96991174743196917, -0.11212113145935958, 1e-14);
    tc_camera_zoom(&c, 1.5);
    NEAR(c.view_angle, 20, 1e-13);

    /* A point in normalised device coordinates at aspect 1.5. */
    tc_rays r;
    assert_int_equal(tc_rays_from_camera(&r, &c, 300, 200, NULL), TC_OK);
    const double p[4] = {0.3, 2.5, -1.25, 1};
    double o[4];
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < 4; i++)
            o[i] = r.clip[i] * p[0] + r.clip[4 + i] * p[1] + r.clip[8 + i] * p[2] + r.clip[12 + i] * p[3];
        NEAR(o[0] / o[3], pass ? -0.10634758401575695 : -0.052536199356016396, 1e-13);
        NEAR(o[1] / o[3], pass ? -0.81451246709815339 : -0.40237293348468695, 1e-13);
        c.parallel = true, c.parallel_scale = 2.5;
        tc_camera_zoom(&c, 2);
        NEAR(c.parallel_scale, 1.25, 0);
        assert_int_equal(tc_rays_from_camera(&r, &c, 300, 200, NULL), TC_OK);
    }
}

static void reset_of_a_point_looking_along_up_differs_from_vtk(void **state)
{
    (void)state;
    const double point[6] = {2, 2, 2, 2, 2, 2};
    tc_camera c = {.parallel = false};
    tc_camera_reset(&c, point, UP, UP, 30, 1);
    near3(c.position, 2, 3.9318516525781368, 2, 1e-14);
    near3(c.view_up, 0, 0, 1, 0);
    NEAR(c.parallel_scale, 0.5, 0);
}

/* By hand: radius = sqrt(16 + 9 + 25) / 2; the angle narrows with the aspect, the scale grows. */
static void narrow_image_cuts_the_box(void **state)
{
    (void)state;
    tc_camera c = front(0.5);
    double radius = sqrt(50) / 2, angle = 2 * atan(tan(acos(-1) / 12) * 0.5);
    NEAR(c.position[2], -1.5 + radius / sin(angle / 2), 1e-12);
    NEAR(c.parallel_scale, radius * 2, 1e-14);
    c = front(2.5);
    NEAR(c.position[2], 12.160254037844387, 1e-13);
    NEAR(c.parallel_scale, radius, 1e-14);
}

static void up_that_the_rule_maps_to_its_opposite_stays_parallel(void **state)
{
    (void)state;
    const double d[3] = {1, -1, 1};
    tc_camera c = {.parallel = false};
    tc_camera_reset(&c, BOX, d, d, 30, 1);
    double n[3];
    tc_vec_sub(n, c.position, c.focal_point);
    tc_vec_normalize(n);
    assert_true(fabs(tc_vec_dot(n, c.view_up)) < 0.9);
    /* The same when a camera with such an up comes from elsewhere. */
    tc_vec_copy(c.view_up, d);
    tc_rays r;
    assert_int_equal(tc_rays_from_camera(&r, &c, 8, 8, NULL), TC_OK);
    for (int i = 0; i < 16; i++)
        assert_true(isfinite(r.clip[i]));
    assert_true(tc_vec_length(r.direction_dx) > 1e-3);
}

static void pixel_and_clip_space_disagree(void **state)
{
    (void)state;
    const double angles[] = {30, 0.01, 170, 1e-8};
    for (int parallel = 0; parallel < 2; parallel++)
        for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
            tc_camera c = front(1.75);
            c.parallel = parallel;
            c.view_angle = angles[a];
            tc_camera_azimuth(&c, 33), tc_camera_elevation(&c, -21), tc_camera_roll(&c, 77);
            tc_rays r;
            assert_int_equal(tc_rays_from_camera(&r, &c, 700, 400, NULL), TC_OK);
            for (int k = 0; k < 200; k++) {
                double X = 0.5 + (k * 37) % 700, Y = 0.5 + (k * 53) % 400, o[3], d[3], p[3];
                tc_rays_pixel(o, d, &r, X, Y);
                NEAR(tc_vec_length(d), 1, 1e-15);
                tc_vec_mul_add(p, o, 3.0 + k * 0.1, d);
                double v[4];
                for (int i = 0; i < 4; i++)
                    v[i] = r.clip[i] * p[0] + r.clip[4 + i] * p[1] + r.clip[8 + i] * p[2] + r.clip[12 + i];
                assert_true(v[3] > 0);
                assert_true(v[2] == 0);
                /* Relative to the view: at 1e-8 degrees the last bits of a world position span pixels. */
                double tolerance = angles[a] < 1e-6 && !parallel ? 1e-4 : 1e-9;
                NEAR(v[0] / v[3], 2 * X / 700 - 1, tolerance);
                NEAR(v[1] / v[3], 2 * Y / 400 - 1, tolerance);
            }
        }
}

/* By hand: eye on +z, y counts from the bottom, 30 degrees vertically, square pixels. */
static void picture_is_upside_down_or_mirrored(void **state)
{
    (void)state;
    tc_camera c = front(1);
    tc_rays r;
    assert_int_equal(tc_rays_from_camera(&r, &c, 400, 200, NULL), TC_OK);
    double o[3], d[3], t = tan(acos(-1) / 12);
    tc_rays_pixel(o, d, &r, 200, 200); /* middle of the top edge */
    near3(o, 1, 3.5, 12.160254037844387, 1e-13);
    NEAR(d[0], 0, 1e-15);
    NEAR(d[1] / -d[2], t, 1e-14);
    tc_rays_pixel(o, d, &r, 400, 100); /* middle of the right edge */
    NEAR(d[0] / -d[2], 2 * t, 1e-14);
    NEAR(d[1], 0, 1e-15);
    c.parallel = true;
    assert_int_equal(tc_rays_from_camera(&r, &c, 400, 200, NULL), TC_OK);
    tc_rays_pixel(o, d, &r, 400, 0); /* lower right corner */
    near3(o, 1 + 2 * c.parallel_scale, 3.5 - c.parallel_scale, -1.5, 1e-13);
    near3(d, 0, 0, -1, 1e-15);
}

static void sizes_flat_boxes_or_offsets_break_the_view(void **state)
{
    (void)state;
    const double sizes[] = {1e-30, 1e-7, 1, 1e7, 1e30}, offsets[] = {0, 1e7, -1e30, 1e30};
    for (size_t s = 0; s < 5; s++)
        for (size_t f = 0; f < 4; f++)
            for (int flat = 0; flat < 8; flat++)
                for (int parallel = 0; parallel < 2; parallel++) {
                    double b[6];
                    for (int i = 0; i < 3; i++) {
                        b[2 * i] = offsets[f];
                        b[2 * i + 1] = offsets[f] + ((flat >> i & 1) ? 0 : sizes[s]);
                    }
                    tc_camera c = {.parallel = parallel};
                    tc_camera_reset(&c, b, FRONT, UP, 30, 1);
                    tc_camera_azimuth(&c, 40), tc_camera_elevation(&c, 20);
                    tc_rays r;
                    tc_error err;
                    if (tc_rays_from_camera(&r, &c, 64, 48, &err) != TC_OK)
                        fail_msg("size %g offset %g: %s", sizes[s], offsets[f], err.text);
                    for (int i = 0; i < 16; i++)
                        assert_true(isfinite(r.clip[i]));
                    double o[3], d[3];
                    tc_rays_pixel(o, d, &r, 10.5, 20.5);
                    for (int i = 0; i < 3; i++)
                        assert_true(isfinite(o[i]) && isfinite(d[i]));
                    NEAR(tc_vec_length(d), 1, 1e-14);
                }
}

/* The same picture of the same box 1e7 away. */
static void offset_moves_the_picture(void **state)
{
    (void)state;
    const double b0[6] = {-0.5, 0.5, -0.5, 0.5, -0.5, 0.5};
    const double b1[6] = {1e7 - 0.5, 1e7 + 0.5, 1e7 - 0.5, 1e7 + 0.5, 1e7 - 0.5, 1e7 + 0.5};
    tc_camera c0 = {.parallel = false}, c1 = c0;
    tc_camera_reset(&c0, b0, FRONT, UP, 30, 1);
    tc_camera_reset(&c1, b1, FRONT, UP, 30, 1);
    tc_camera_azimuth(&c0, 25), tc_camera_azimuth(&c1, 25);
    tc_rays r0, r1;
    assert_int_equal(tc_rays_from_camera(&r0, &c0, 64, 64, NULL), TC_OK);
    assert_int_equal(tc_rays_from_camera(&r1, &c1, 64, 64, NULL), TC_OK);
    for (int i = 0; i < 3; i++) {
        NEAR(r0.eye[i], r1.eye[i] - 1e7, 1e-8);
        NEAR(r0.direction[i], r1.direction[i], 1e-8);
    }
}

static void clipping_planes_are_not_across_the_view(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++)
        for (int clip = 0; clip < 3; clip++) {
            tc_camera c = front(1.3);
            c.parallel = parallel;
            tc_camera_azimuth(&c, 33), tc_camera_elevation(&c, -21);
            tc_vec_mul_add(c.focal_point, c.focal_point, 1.5, UP); /* origins of parallel rays are not before the eye */
            if (clip)
                c.clip_near = clip == 1 ? 0 : 2.5, c.clip_far = 7;
            tc_rays r;
            assert_int_equal(tc_rays_from_camera(&r, &c, 130, 100, NULL), TC_OK);
            double forward[3];
            tc_vec_sub(forward, c.focal_point, c.position);
            tc_vec_normalize(forward);
            for (int k = 0; k < 50; k++) {
                double X = 0.5 + (k * 37) % 130, Y = 0.5 + (k * 53) % 100, o[3], d[3], range[2], p[3];
                tc_rays_pixel(o, d, &r, X, Y);
                tc_rays_range(range, &r, X, Y);
                for (int end = 0; end < 2; end++) {
                    if (end == 1 && !clip) {
                        assert_true(range[1] == INFINITY);
                        continue;
                    }
                    tc_vec_mul_add(p, o, range[end], d);
                    tc_vec_sub(p, p, c.position);
                    NEAR(tc_vec_dot(p, forward), end ? c.clip_far : c.clip_near, 1e-13);
                }
                if (!parallel && !clip)
                    NEAR(range[0], 0, 0);
            }
        }
}

static void expect_refusal(const tc_camera *c, int width, int height, const char *word)
{
    tc_rays r;
    tc_error err = {TC_OK, ""};
    assert_int_equal(tc_rays_from_camera(&r, c, width, height, &err), TC_E_ARG);
    assert_int_equal(err.code, TC_E_ARG);
    if (!strstr(err.text, word))
        fail_msg("\"%s\" does not say \"%s\"", err.text, word);
}

static void a_bad_camera_is_accepted(void **state)
{
    (void)state;
    tc_camera good = front(1), c = good;
    expect_refusal(&good, 0, 5, "0 x 5");
    expect_refusal(&good, 5, -1, "-1");
    tc_vec_copy(c.position, c.focal_point);
    expect_refusal(&c, 8, 8, "position and focal point");
    c = good, c.position[1] = NAN;
    expect_refusal(&c, 8, 8, "position");
    c = good, c.focal_point[2] = INFINITY;
    expect_refusal(&c, 8, 8, "focal point");
    c = good, c.view_up[1] = 0;
    expect_refusal(&c, 8, 8, "view-up");
    c = good, c.view_angle = 180;
    expect_refusal(&c, 8, 8, "180");
    c = good, c.view_angle = NAN;
    expect_refusal(&c, 8, 8, "view angle");
    c = good, c.parallel = true, c.parallel_scale = 0;
    expect_refusal(&c, 8, 8, "parallel scale");
    c = good, c.clip_near = -1, c.clip_far = 5;
    expect_refusal(&c, 8, 8, "near clipping distance -1");
    c = good, c.clip_near = 5, c.clip_far = 5;
    expect_refusal(&c, 8, 8, "far clipping distance 5");
    c = good, c.clip_near = 2; /* no far one */
    expect_refusal(&c, 8, 8, "far clipping distance 0");
    c = good, c.clip_far = INFINITY;
    expect_refusal(&c, 8, 8, "inf");
    c = good, c.clip_near = NAN;
    expect_refusal(&c, 8, 8, "nan");
    c = good, c.view_angle = 200, c.parallel = true; /* the angle does not matter here */
    tc_rays r;
    assert_int_equal(tc_rays_from_camera(&r, &c, 8, 8, NULL), TC_OK);
}

static void reset_keeps_a_clipping_range(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++) {
        tc_camera c;
        memset(&c, 0x7e, sizeof c); /* as a caller's own may be: huge numbers */
        c.parallel = parallel;
        tc_camera_reset(&c, BOX, FRONT, UP, 30, 1);
        assert_true(c.clip_near == 0 && c.clip_far == 0 && c.window_center[0] == 0 && c.window_center[1] == 0);
        assert_true(c.parallel == parallel);
        tc_camera same = {.parallel = parallel};
        tc_camera_reset(&same, BOX, FRONT, UP, 30, 1);
        assert_memory_equal(c.position, same.position, sizeof c.position);
        assert_true(c.view_angle == 30 && c.parallel_scale == same.parallel_scale);
        tc_rays r;
        assert_int_equal(tc_rays_from_camera(&r, &c, 8, 8, NULL), TC_OK);
    }
}

static void nonsense_moves_poison_the_camera(void **state)
{
    (void)state;
    tc_camera c = front(1), before = c;
    tc_camera_azimuth(&c, NAN), tc_camera_elevation(&c, INFINITY), tc_camera_roll(&c, NAN);
    tc_camera_zoom(&c, 0), tc_camera_zoom(&c, -2), tc_camera_zoom(&c, NAN);
    assert_memory_equal(&c, &before, sizeof c);
    const double bad[6] = {1, -1, NAN, 1, 0, INFINITY}, none[3] = {0, 0, 0};
    tc_camera_reset(&c, bad, none, none, NAN, -1);
    tc_rays r;
    assert_int_equal(tc_rays_from_camera(&r, &c, 8, 8, NULL), TC_OK);
}

static void shifted_rays_are_not_those_beside(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++) {
        tc_camera c = front(1.5);
        c.parallel = parallel;
        tc_camera_azimuth(&c, 30), tc_camera_elevation(&c, 20), tc_camera_roll(&c, 15);
        tc_rays r, same, moved;
        assert_int_equal(tc_rays_from_camera(&r, &c, 30, 20, NULL), TC_OK);
        tc_rays_shift(&same, &r, 0, 0);
        assert_memory_equal(same.clip, r.clip, sizeof r.clip);
        assert_memory_equal(same.origin, r.origin, sizeof r.origin);
        assert_memory_equal(same.direction, r.direction, sizeof r.direction);
        moved = r;
        tc_rays_shift(&moved, &moved, 0.375, -0.125);
        for (int k = 0; k < 4; k++) {
            const double X = 7.5 * k + 0.5, Y = 19.5 - 5 * k;
            double o[3], d[3], beside_o[3], beside_d[3], range[2], beside_range[2];
            tc_rays_pixel(o, d, &moved, X, Y);
            tc_rays_pixel(beside_o, beside_d, &r, X + 0.375, Y - 0.125);
            near3(o, beside_o[0], beside_o[1], beside_o[2], 1e-13);
            near3(d, beside_d[0], beside_d[1], beside_d[2], 1e-14);
            tc_rays_range(range, &moved, X, Y);
            tc_rays_range(beside_range, &r, X + 0.375, Y - 0.125);
            NEAR(range[0], beside_range[0], 1e-12);
            /* A point of that ray falls on the pixel's middle. */
            double p[4] = {o[0] + 9 * d[0], o[1] + 9 * d[1], o[2] + 9 * d[2], 1}, at[4] = {0, 0, 0, 0};
            for (int i = 0; i < 16; i++)
                at[i % 4] += moved.clip[i] * p[i / 4];
            NEAR((at[0] / at[3] + 1) * 15, X, 1e-11);
            NEAR((at[1] / at[3] + 1) * 10, Y, 1e-11);
        }
    }
}

/* Where a point is in the picture, -1 … 1 each way. */
static void project(double out[2], const double clip[16], const double *p)
{
    double at[4] = {0, 0, 0, 0};
    for (int i = 0; i < 16; i++)
        at[i % 4] += clip[i] * (i < 12 ? p[i / 4] : 1);
    out[0] = at[0] / at[3], out[1] = at[1] / at[3];
}

/* The figures come from vtkCamera::GetCompositeProjectionTransformMatrix of VTK 9.1 with SetWindowCenter(0.3, -0.2). */
static void a_window_centre_is_not_vtks(void **state)
{
    (void)state;
    static const double point[3][3] = {{1.5, 4, 0.5}, {-0.5, 2.5, -3}, {1, 3.5, -1.5}};
    static const double vtk[2][3][2] = {{{-0.40399810152645582, 0.1332166395237179},
                                         {-0.37351192982318376, 0.14402762349931739},
                                         {-0.30000000000000004, 0.19999999999999982}},
                                        {{-0.39256935479310695, 0.14055571688842528},
                                         {-0.38963887439618905, 0.13174848165639408},
                                         {-0.29999999999999993, 0.19999999999999996}}};
    for (int parallel = 0; parallel < 2; parallel++) {
        const tc_camera c = {.position = {7.4182199587116378, 8.1720820438885831, 9.6166830626411812},
                             .focal_point = {1, 3.5, -1.5},
                             .view_up = {0, 1, 0},
                             .view_angle = 30,
                             .parallel_scale = 3.5,
                             .parallel = parallel,
                             .window_center = {0.3, -0.2}};
        tc_rays r;
        assert_int_equal(tc_rays_from_camera(&r, &c, 350, 200, NULL), TC_OK);
        for (int i = 0; i < 3; i++) {
            double at[2], o[3], d[3], along, off[3];
            project(at, r.clip, point[i]);
            NEAR(at[0], vtk[parallel][i][0], 1e-14);
            NEAR(at[1], vtk[parallel][i][1], 1e-14);
            tc_rays_pixel(o, d, &r, (at[0] + 1) * 175, (at[1] + 1) * 100); /* the ray of that place meets the point */
            tc_vec_sub(off, point[i], o);
            along = tc_vec_dot(off, d);
            tc_vec_mul_add(off, off, -along, d);
            assert_true(tc_vec_length(off) < 1e-12);
        }
    }
}

static void a_part_has_other_rays_than_the_whole(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++) {
        tc_camera c = front(1.5);
        c.parallel = parallel;
        c.window_center[0] = -0.2;
        c.clip_near = 1, c.clip_far = 20;
        tc_camera_azimuth(&c, 30), tc_camera_elevation(&c, 20);
        tc_rays whole, part, nested;
        assert_int_equal(tc_rays_from_camera(&whole, &c, 300, 200, NULL), TC_OK);
        tc_rays_part(&part, &whole, 0, 0, 300, 200);
        assert_memory_equal(&part, &whole, sizeof part);
        tc_rays_part(&part, &whole, 70, 30, 50, 40); /* rows 30 … 69 from above: 130 … 169 from below */
        tc_rays_part(&nested, &whole, 60, 20, 100, 90);
        tc_rays_part(&nested, &nested, 10, 10, 50, 40);
        assert_int_equal(part.width, 50);
        assert_int_equal(part.height, 40);
        assert_memory_equal(part.whole_clip, whole.clip, sizeof whole.clip);
        for (int shifted = 0; shifted < 2; shifted++) {
            for (int k = 0; k < 5; k++) {
                const double X = 12 * k + 0.5, Y = 39.5 - 9 * k;
                double o[3], d[3], range[2], whole_o[3], whole_d[3], whole_range[2], at[2], p[3];
                tc_rays_pixel(whole_o, whole_d, &whole, X + 70, Y + 130);
                tc_rays_range(whole_range, &whole, X + 70, Y + 130);
                for (int n = 0; n < 2; n++) {
                    const tc_rays *rays = n ? &nested : &part;
                    tc_rays_pixel(o, d, rays, X, Y);
                    tc_rays_range(range, rays, X, Y);
                    assert_memory_equal(o, whole_o, sizeof o);
                    assert_memory_equal(d, whole_d, sizeof d);
                    assert_memory_equal(range, whole_range, sizeof range);
                    tc_vec_mul_add(p, o, 9, d);
                    project(at, rays->clip, p);
                    NEAR((at[0] + 1) * 25, X, 1e-10);
                    NEAR((at[1] + 1) * 20, Y, 1e-10);
                    project(at, rays->whole_clip, p);
                    NEAR((at[0] + 1) * 150, X + 70, 1e-10);
                    NEAR((at[1] + 1) * 100, Y + 130, 1e-10);
                }
            }
            tc_rays_shift(&whole, &whole, 0.375, -0.125);
            tc_rays_shift(&part, &part, 0.375, -0.125);
            tc_rays_shift(&nested, &nested, 0.375, -0.125);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_moves_otherwise_than_in_vtk),
        cmocka_unit_test(reset_of_a_point_looking_along_up_differs_from_vtk),
        cmocka_unit_test(narrow_image_cuts_the_box),
        cmocka_unit_test(up_that_the_rule_maps_to_its_opposite_stays_parallel),
        cmocka_unit_test(pixel_and_clip_space_disagree),
        cmocka_unit_test(picture_is_upside_down_or_mirrored),
        cmocka_unit_test(sizes_flat_boxes_or_offsets_break_the_view),
        cmocka_unit_test(offset_moves_the_picture),
        cmocka_unit_test(clipping_planes_are_not_across_the_view),
        cmocka_unit_test(a_bad_camera_is_accepted),
        cmocka_unit_test(reset_keeps_a_clipping_range),
        cmocka_unit_test(shifted_rays_are_not_those_beside),
        cmocka_unit_test(nonsense_moves_poison_the_camera),
        cmocka_unit_test(a_window_centre_is_not_vtks),
        cmocka_unit_test(a_part_has_other_rays_than_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
