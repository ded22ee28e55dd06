/* Views of a scene (cli/batch/views.h). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/views.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static const double bounds[6] = {-1, 1, -1, 1, -1, 1};
static const tc_camera base = {
    .position = {1, 2, 13}, .focal_point = {1, 2, 3}, .view_up = {0, 1, 0}, .view_angle = 30, .parallel_scale = 2};

static char told[2048];

/* JSON with ' for "; what is printed on stderr goes to told. */
static int view_read(tc_views *out, const char *text)
{
    char data[1024];
    tc_talk talk;
    snprintf(data, sizeof data, "%s", text);
    for (char *at = data; *at; at++)
        *at = *at == '\'' ? '"' : *at;
    json_t *json = json_loads(data, JSON_DECODE_ANY, NULL);
    if (!json)
        fail_msg("no JSON: %s", data);
    tc_talk_init(&talk);
    fflush(stderr);
    int saved = dup(2), file = memfd_create("told", 0);
    assert_true(saved >= 0 && file >= 0);
    dup2(file, 2);
    int code = tc_views_read(out, json, "s.json:3: views", &talk);
    fflush(stderr);
    dup2(saved, 2);
    close(saved);
    ssize_t n = pread(file, told, sizeof told - 1, 0);
    told[n > 0 ? n : 0] = 0;
    close(file);
    json_decref(json);
    return code;
}

static void read_well(tc_views *out, const char *text)
{
    if (view_read(out, text) >= 0)
        fail_msg("%s: %s", text, told);
}

static tc_camera camera_of(const tc_views *views, size_t i, size_t n_along, double *phi, double *theta)
{
    tc_camera out;
    tc_talk talk;
    tc_talk_init(&talk);
    assert_int_equal(tc_view_camera(&out, phi, theta, views, i, n_along, &base, bounds, 1, &talk), -1);
    return out;
}

static double apart(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static void near3(const double a[3], double x, double y, double z, double error)
{
    const double b[3] = {x, y, z};
    if (!(apart(a, b) <= error))
        fail_msg("%.17g %.17g %.17g is not %g %g %g", a[0], a[1], a[2], x, y, z);
}

/* What the renderer needs: a direction, and an up across it. */
static void can_see(const tc_camera *camera)
{
    double dot = 0, up = 0, ahead = apart(camera->position, camera->focal_point);
    for (int i = 0; i < 3; i++) {
        dot += camera->view_up[i] * (camera->focal_point[i] - camera->position[i]);
        up += camera->view_up[i] * camera->view_up[i];
    }
    assert_true(isfinite(ahead) && ahead > 0 && fabs(up - 1) < 1e-12 && fabs(dot / ahead) < 1e-9);
}

static void phi_and_theta_lead_elsewhere(void **state)
{
    (void)state;
    tc_views views;
    double phi, theta;
    read_well(&views, "{'phi': [0, 90, 180, 270], 'theta': [0, 90, -90]}");
    assert_int_equal(tc_views_count(&views, 5), 12);
    tc_camera c = camera_of(&views, 0, 5, &phi, &theta);
    assert_memory_equal(&c, &base, sizeof c);
    assert_true(phi == 0 && theta == 0);
    c = camera_of(&views, 3, 5, &phi, &theta);
    near3(c.position, 11, 2, 3, 0); /* on +x, and exactly */
    near3(c.view_up, 0, 1, 0, 0);
    assert_true(phi == 90 && theta == 0);
    c = camera_of(&views, 6, 5, &phi, &theta);
    near3(c.position, 1, 2, -7, 0);
    c = camera_of(&views, 9, 5, &phi, &theta);
    near3(c.position, -9, 2, 3, 0);
    c = camera_of(&views, 1, 5, &phi, &theta); /* down from the pole */
    near3(c.position, 1, 12, 3, 0);
    near3(c.view_up, 0, 0, -1, 0);
    can_see(&c);
    c = camera_of(&views, 2, 5, &phi, &theta);
    near3(c.position, 1, -8, 3, 0);
    near3(c.view_up, 0, 0, 1, 0);
    can_see(&c);
    c = camera_of(&views, 4, 5, &phi, &theta); /* phi 90, theta 90 */
    near3(c.position, 1, 12, 3, 0);
    near3(c.view_up, -1, 0, 0, 0);
    assert_true(phi == 90 && theta == 90);
    tc_views_finish(&views);
}

static void a_grid_is_not_azimuth_and_elevation(void **state)
{
    (void)state;
    tc_views views;
    read_well(&views, "{'phi': {'from': -70, 'to': 110, 'count': 7}, 'theta': {'from': -80, 'to': 80, 'count': 5}}");
    assert_int_equal(tc_views_count(&views, 1), 35);
    for (size_t i = 0; i < 35; i++) {
        double phi, theta;
        tc_camera wanted = base, c = camera_of(&views, i, 1, &phi, &theta);
        assert_true(phi == -70 + 30.0 * (double)(i / 5) && theta == -80 + 40.0 * (double)(i % 5));
        tc_camera_azimuth(&wanted, phi);
        tc_camera_elevation(&wanted, theta);
        near3(c.position, wanted.position[0], wanted.position[1], wanted.position[2], 1e-13 * 100);
        assert_true(fabs(apart(c.position, c.focal_point) - 10) < 1e-12);
        can_see(&c);
        near3(c.focal_point, 1, 2, 3, 0);
    }
    tc_views_finish(&views);
}

static void a_count_spreads_angles_otherwise(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t n_phi, n_theta;
        double phi[6], theta[6];
    } row[] = {
        {"{'phi': 4}", 4, 1, {0, 90, 180, 270}, {0}},
        {"{'theta': 3}", 1, 3, {0}, {-90, 0, 90}},
        {"{'phi': 1, 'theta': 1}", 1, 1, {0}, {0}},
        {"{'phi': {'from': 0, 'to': 360, 'count': 3}}", 3, 1, {0, 120, 240}, {0}},
        {"{'phi': {'from': 0, 'to': 90, 'count': 3}, 'theta': [10.5]}", 3, 1, {0, 45, 90}, {10.5}},
        {"{'theta': {'from': 60, 'to': 0, 'count': 4}}", 1, 4, {0}, {60, 40, 20, 0}},
        {"{'theta': {'from': 5, 'to': 50, 'count': 1}}", 1, 1, {0}, {5}},
        {"{'orbit': 4}", 4, 1, {0, 90, 180, 270}, {0}},
        {"{'orbit': 3, 'from': 30, 'to': 90, 'elevation': 20}", 3, 1, {30, 60, 90}, {20}},
        {"{'orbit': 2, 'from': 90, 'to': -270}", 2, 1, {90, -90}, {0}},
        {"{'orbit': 6, 'to': 720}", 6, 1, {0, 120, 240, 360, 480, 600}, {0}},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_views views;
        read_well(&views, row[i].text);
        assert_int_equal(tc_views_count(&views, 9), row[i].n_phi * row[i].n_theta);
        for (size_t k = 0; k < row[i].n_phi * row[i].n_theta; k++) {
            double phi, theta;
            camera_of(&views, k, 9, &phi, &theta);
            if (phi != row[i].phi[k / row[i].n_theta] || theta != row[i].theta[k % row[i].n_theta])
                fail_msg("%s: view %zu is at %g, %g", row[i].text, k, phi, theta);
        }
        tc_views_finish(&views);
    }
}

static void an_orbit_is_no_circle(void **state)
{
    (void)state;
    tc_views views;
    double height = 0, step = 0;
    read_well(&views, "{'orbit': 12, 'elevation': 20}");
    for (size_t i = 0; i < 12; i++) {
        double phi, theta;
        tc_camera c = camera_of(&views, i, 1, &phi, &theta), next = camera_of(&views, (i + 1) % 12, 1, NULL, NULL);
        assert_true(phi == 30 * (double)i && theta == 20);
        assert_true(fabs(apart(c.position, base.focal_point) - 10) < 1e-12);
        height = i == 0 ? c.position[1] : height;
        step = i == 0 ? apart(c.position, next.position) : step;
        assert_true(fabs(c.position[1] - height) < 1e-12);
        assert_true(fabs(apart(c.position, next.position) - step) < 1e-12);
        can_see(&c);
    }
    assert_true(fabs(height - 2 - 10 * sin(acos(-1.0) / 9)) < 1e-12);
    tc_views_finish(&views);
    read_well(&views, "{'orbit': true, 'along': 'time', 'to': 90}");
    assert_int_equal(tc_views_count(&views, 7), 7);
    for (size_t i = 0; i < 7; i++) {
        double phi;
        camera_of(&views, i, 7, &phi, NULL);
        assert_true(phi == 15 * (double)i);
    }
    tc_views_finish(&views);
}

static void keys_of_a_camera_are_left_aside(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        tc_camera wanted;
    } row[] = {
        {"[{}]", base},
        {"[{'position': [1, 2, 23]}]", {{1, 2, 23}, {1, 2, 3}, {0, 1, 0}, 30, 2, false, 0, 0, {0, 0}}},
        {"[{'focal_point': '0,0,0', 'view_up': [0, 0, 2]}]",
         {{1, 2, 13}, {0, 0, 0}, {0, 0, 2}, 30, 2, false, 0, 0, {0, 0}}},
        {"[{'view_angle': 12.5, 'clipping_range': [1, 20]}]",
         {{1, 2, 13}, {1, 2, 3}, {0, 1, 0}, 12.5, 2, false, 1, 20, {0, 0}}},
        {"[{'parallel': true}]", {{1, 2, 13}, {1, 2, 3}, {0, 1, 0}, 30, 2, true, 0, 0, {0, 0}}},
        {"[{'parallel_scale': 5, 'zoom': 2}]", {{1, 2, 13}, {1, 2, 3}, {0, 1, 0}, 30, 2.5, true, 0, 0, {0, 0}}},
        {"[{'zoom': 2, 'window_center': [0.5, -1]}]",
         {{1, 2, 13}, {1, 2, 3}, {0, 1, 0}, 15, 2, false, 0, 0, {0.5, -1}}},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_views views;
        double phi, theta;
        read_well(&views, row[i].text);
        const tc_camera c = camera_of(&views, 0, 1, &phi, &theta), *w = &row[i].wanted;
        assert_true(isnan(phi) && isnan(theta));
        near3(c.position, w->position[0], w->position[1], w->position[2], 0);
        near3(c.focal_point, w->focal_point[0], w->focal_point[1], w->focal_point[2], 0);
        near3(c.view_up, w->view_up[0], w->view_up[1], w->view_up[2], 0);
        assert_true(c.view_angle == w->view_angle && c.parallel_scale == w->parallel_scale &&
                    c.parallel == w->parallel);
        assert_true(c.clip_near == w->clip_near && c.clip_far == w->clip_far);
        assert_memory_equal(c.window_center, w->window_center, sizeof c.window_center);
        tc_views_finish(&views);
    }
    tc_views views;
    read_well(&views,
              "[{'azimuth': 20, 'elevation': -30, 'roll': 10}, {'direction': [0, -3, 0], 'view_up': [0, 0, 1]}]");
    tc_camera wanted = base, c = camera_of(&views, 0, 1, NULL, NULL);
    tc_camera_azimuth(&wanted, 20);
    tc_camera_elevation(&wanted, -30);
    tc_camera_roll(&wanted, 10);
    assert_memory_equal(c.position, wanted.position, sizeof c.position);
    assert_memory_equal(c.view_up, wanted.view_up, sizeof c.view_up);
    c = camera_of(&views, 1, 1, NULL, NULL); /* the whole box in view: a sphere of radius sqrt(3) */
    near3(c.position, 0, -sqrt(3) / sin(acos(-1.0) / 12), 0, 1e-12);
    near3(c.focal_point, 0, 0, 0, 0);
    can_see(&c);
    tc_views_finish(&views);
}

/* What vtkCameraInterpolator (VTK 9.1, spline) gives for these four cameras. */
static void a_path_is_not_vtks_spline(void **state)
{
    (void)state;
    static const struct {
        size_t i; /* of 21 views: at i / 20 */
        double position[3], focal_point[3], view_up[3];
    } row[] = {
        {0, {0, 0, 10}, {0, 0, 0}, {0, 1, 0}},
        {2,
         {2.1785714285714288, 0.5714285714285714, 9.3214285714285712},
         {-0.035714285714285719, 0.4642857142857143, -0.035714285714285719},
         {-0.010296557089019708, 0.99509523604657757, 0.098384206606133784}},
        {4, {5, 1, 8}, {0, 1, 0}, {0, 0.98058067569092011, 0.19611613513818393}},
        {9,
         {7.9598214285714288, -0.60044642857142905, 5.0245535714285712},
         {0.58928571428571441, 1.1674107142857142, 0.58928571428571441},
         {0.17186913764855682, 0.97837500059143734, 0.11507978858881533}},
        {10,
         {8.3891428571428577, -0.99114285714285733, 4.3768571428571423},
         {0.71657142857142875, 1.1585714285714286, 0.71657142857142875},
         {0.20865585860362054, 0.97403626274913357, 0.087841285965580065}},
        {14, {9, -2, 1}, {1, 1, 1}, {0.2873478855663455, 0.95782628522115143, 0}},
        {18,
         {4.4999999999999991, -0.54629629629629606, -6.8796296296296315},
         {0.25925925925925919, 0.23148148148148129, 0.25925925925925919},
         {0.075066560696450499, 0.99716341655466667, -0.005489275929501697}},
        {20, {3, 0, -9}, {0, 0, 0}, {0, 1, 0}},
    };
    tc_views views;
    read_well(
        &views,
        "{'path': [{'time': 0, 'position': [0, 0, 10], 'focal_point': [0, 0, 0], 'view_angle': 30},"
        "{'time': 0.2, 'position': [5, 1, 8], 'focal_point': [0, 1, 0], 'view_up': [0, 1, 0.2], 'view_angle': 20},"
        "{'time': 0.7, 'position': [9, -2, 1], 'focal_point': [1, 1, 1], 'view_up': [0.3, 1, 0], 'view_angle': 40},"
        "{'time': 1, 'position': [3, 0, -9], 'focal_point': [0, 0, 0]}], 'count': 21}");
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        const tc_camera c = camera_of(&views, row[k].i, 1, NULL, NULL);
        near3(c.position, row[k].position[0], row[k].position[1], row[k].position[2], 1e-14 * 10);
        near3(c.focal_point, row[k].focal_point[0], row[k].focal_point[1], row[k].focal_point[2], 1e-14);
        near3(c.view_up, row[k].view_up[0], row[k].view_up[1], row[k].view_up[2], 1e-15);
    }
    /* Angles go straight from key to key. */
    for (size_t i = 0; i <= 20; i++) {
        const double u = (double)i / 20;
        const double angle = u <= 0.2 ? 30 - 50 * u : u <= 0.7 ? 20 + 40 * (u - 0.2) : 40 - 100.0 / 3 * (u - 0.7);
        assert_true(fabs(camera_of(&views, i, 1, NULL, NULL).view_angle - angle) < 1e-13);
    }
    tc_views_finish(&views);
}

static void a_path_misses_its_keys_or_has_a_corner(void **state)
{
    (void)state;
    static const double key[4][3] = {{0.1, 0.7, 10}, {10.3, 0, 0.3}, {0, 3.7, -10}, {-10, 0.9, 0}};
    for (int closed = 0; closed < 2; closed++)
        for (size_t n = 2; n <= 4; n++) {
            char text[600] = "{'path': [";
            tc_views views;
            const size_t fine = 300, count = closed ? n * fine : (n - 1) * fine + 1;
            for (size_t k = 0; k < n; k++)
                snprintf(text + strlen(text), sizeof text - strlen(text), "%s{'position': [%.17g, %.17g, %.17g]}",
                         k ? ", " : "", key[k][0], key[k][1], key[k][2]);
            snprintf(text + strlen(text), sizeof text - strlen(text), "], 'count': %zu, 'closed': %s}", count,
                     closed ? "true" : "false");
            read_well(&views, text);
            assert_int_equal(tc_views_count(&views, 3), count);
            for (size_t k = 0; k < n; k++) {
                const tc_camera c = camera_of(&views, k * fine, 3, NULL, NULL);
                assert_memory_equal(c.position, key[k], sizeof c.position);
            }
            /* Differences between neighbours change little: by curvature alone. */
            for (size_t i = 1; i + 1 < count + (closed ? 1 : 0); i++) {
                const tc_camera a = camera_of(&views, i - 1, 3, NULL, NULL), b = camera_of(&views, i, 3, NULL, NULL),
                                c = camera_of(&views, (i + 1) % count, 3, NULL, NULL);
                double bend[3], none[3] = {0};
                for (int x = 0; x < 3; x++)
                    bend[x] = a.position[x] - 2 * b.position[x] + c.position[x];
                assert_true(apart(bend, none) < 200.0 / (double)(fine * fine));
                assert_memory_equal(b.focal_point, base.focal_point, sizeof b.focal_point);
            }
            tc_views_finish(&views);
        }
}

static void a_closed_path_that_begins_late_loses_its_way_back(void **state)
{
    (void)state;
    tc_views views;
    read_well(&views,
              "{'path': [{'time': 0.25, 'position': [0, 0, 10]}, {'time': 0.75, 'position': [0, 0, 20]}], 'count': 8, "
              "'closed': true}");
    static const double z[8] = {15, 0, 10, 0, 15, 0, 20, 0}; /* 0: not looked at */
    for (size_t i = 0; i < 8; i += 2)
        near3(camera_of(&views, i, 1, NULL, NULL).position, 0, 0, z[i], 1e-13);
    tc_views_finish(&views);
}

static void a_direction_loses_what_the_scene_says(void **state)
{
    (void)state;
    tc_views views;
    tc_camera c, own = base;
    tc_talk talk;
    tc_talk_init(&talk);
    own.parallel = true;
    own.clip_near = 3;
    own.clip_far = 9;
    own.window_center[1] = 0.25;
    read_well(&views, "[{'direction': [1, 0, 0], 'view_angle': 60}]");
    assert_int_equal(tc_view_camera(&c, NULL, NULL, &views, 0, 1, &own, bounds, 0.5, &talk), -1);
    assert_true(c.parallel && c.clip_near == 3 && c.clip_far == 9 && c.window_center[1] == 0.25 && c.view_angle == 60);
    assert_true(fabs(c.parallel_scale - 2 * sqrt(3)) < 1e-12); /* of a picture half as wide as high */
    can_see(&c);
    tc_views_finish(&views);
}

static void a_path_along_time_has_not_a_view_a_step(void **state)
{
    (void)state;
    tc_views views;
    read_well(&views,
              "{'path': [{'position': [0, 0, 10]}, {'position': [0, 0, 20], 'parallel': false}], 'along': 'time'}");
    for (size_t n = 1; n < 6; n++) {
        assert_int_equal(tc_views_count(&views, n), n);
        near3(camera_of(&views, 0, n, NULL, NULL).position, 0, 0, 10, 0);
        if (n > 1)
            near3(camera_of(&views, n - 1, n, NULL, NULL).position, 0, 0, 20, 0);
    }
    near3(camera_of(&views, 1, 3, NULL, NULL).position, 0, 0, 15, 1e-13);
    tc_views_finish(&views);
    tc_talk talk;
    tc_talk_init(&talk);
    read_well(&views, "{'cameras': [{}, {'azimuth': 90}], 'along': 'time'}");
    assert_int_equal(tc_views_check(&views, 2, &talk), -1);
    near3(camera_of(&views, 1, 2, NULL, NULL).position, 11, 2, 3, 1e-13);
    tc_camera c;
    assert_int_equal(tc_views_check(&views, 3, &talk), TC_EXIT_FAILED);
    assert_int_equal(tc_view_camera(&c, NULL, NULL, &views, 2, 3, &base, bounds, 1, &talk), TC_EXIT_FAILED);
    tc_views_finish(&views);
}

static void a_camera_without_direction_is_made(void **state)
{
    (void)state;
    static const char *const row[] = {
        "[{'position': [1, 2, 3]}]",
        "{'path': [{'position': [1, 2, 3]}, {}], 'count': 3}",
        "{'path': [{'parallel': true}, {}], 'count': 3}",
        "{'path': [{}, {'clipping_range': [1, 2]}], 'count': 3}",
        "{'path': [{'position': [1, 2, 4]}, {'position': [1, 2, 2]}], 'count': 3}",
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_views views;
        tc_camera c;
        tc_talk talk;
        tc_talk_init(&talk);
        read_well(&views, row[i]);
        if (tc_view_camera(&c, NULL, NULL, &views, views.kind == TC_VIEWS_PATH, 1, &base, bounds, 1, &talk) !=
            TC_EXIT_FAILED)
            fail_msg("%s", row[i]);
        tc_views_finish(&views);
    }
}

static void a_name_is_not_the_views_own(void **state)
{
    (void)state;
    tc_views views;
    char name[32];
    read_well(&views, "[{'name': 'front'}, {}]");
    tc_view_name(name, sizeof name, &views, 0);
    assert_string_equal(name, "front");
    tc_view_name(name, sizeof name, &views, 1);
    assert_string_equal(name, "0002");
    tc_views_finish(&views);
    read_well(&views, "{'orbit': 2, 'names': ['east', 'west']}");
    tc_view_name(name, sizeof name, &views, 1);
    assert_string_equal(name, "west");
    tc_views_finish(&views);
    read_well(&views, "null");
    assert_int_equal(tc_views_count(&views, 7), 1);
    const tc_camera c = camera_of(&views, 0, 7, NULL, NULL);
    assert_memory_equal(&c, &base, sizeof c);
    tc_views_finish(&views);
}

static void wrong_views_are_taken(void **state)
{
    (void)state;
    static const char *const row[][2] = {
        {"3", "views takes a list of cameras"},
        {"'front'", "views takes a list of cameras"},
        {"[]", "views takes a list of 1 to"},
        {"{}", "views takes a list of cameras"},
        {"[3]", "views[0] takes a camera"},
        {"[{}, {'postion': [1, 2, 3]}]", "views[1] has no key 'postion'; the nearest is 'position'"},
        {"[{'time': 0.5}]", "views[0] has no key 'time'"},
        {"[{'position': [1, 2]}]", "views[0].position takes a list of 3 numbers"},
        {"[{'position': [1, 2, '3']}]", "views[0].position takes a list of 3 numbers"},
        {"[{'position': '1,2'}]", "views[0].position takes a list of 3 numbers"},
        {"[{'position': [1, 2, 3, 4]}]", "views[0].position takes a list of 3 numbers"},
        {"[{'view_angle': 180}]", "views[0].view_angle takes a number above 0 and at most 179.999"},
        {"[{'view_angle': '30'}]", "views[0].view_angle takes"},
        {"[{'zoom': 0}]", "views[0].zoom takes a number above 0"},
        {"[{'parallel': 1}]", "views[0].parallel takes true or false"},
        {"[{'view_up': [0, 0, 0]}]", "views[0].view_up takes a direction"},
        {"[{'direction': [0, 0, 0]}]", "views[0].direction takes a direction"},
        {"[{'direction': [0, 0, 1], 'position': [0, 0, 1]}]", "both position and direction"},
        {"[{'position': [1, 1, 1], 'focal_point': [1, 1, 1]}]", "views[0]: position and focal_point are the same"},
        {"[{'clipping_range': [2, 1]}]", "views[0].clipping_range takes"},
        {"[{'name': ''}]", "views[0].name takes a text"},
        {"[{'name': 'a b'}, {'name': 'a_b'}]", "two views are called 'a_b'"},
        {"[{'name': '0002'}, {}]", "two views are called '0002'"},
        {"{'orbt': 12}", "the nearest is 'orbit'"},
        {"{'orbit': 0}", "views.orbit takes a whole number from 1"},
        {"{'orbit': 1.5}", "views.orbit takes a whole number from 1"},
        {"{'orbit': true}", "views.orbit takes a whole number from 1"},
        {"{'orbit': 1000001}", "views.orbit takes a whole number from 1"},
        {"{'orbit': 3, 'elevaton': 20}", "views has no key 'elevaton'; the nearest is 'elevation'"},
        {"{'orbit': 3, 'from': '0'}", "views.from takes a number of degrees"},
        {"{'orbit': 3, 'names': ['a']}", "views.names takes a list of as many texts as there are views, 3"},
        {"{'orbit': 1, 'names': [2]}", "views.names[0] takes a text"},
        {"{'orbit': 3, 'along': 'time'}", "views.orbit takes true beside"},
        {"{'orbit': true, 'along': 'times'}", "views.along takes \"time\""},
        {"{'orbit': true, 'along': 'time', 'names': []}", "views.names does not go with"},
        {"{'orbit': 3, 'phi': 2}", "both orbit and phi"},
        {"{'phi': 3, 'along': 'time'}", "views.along does not go with phi"},
        {"{'phi': []}", "views.phi takes a list of 1 to"},
        {"{'phi': [1, 'x']}", "views.phi takes a list of 1 to"},
        {"{'theta': 'all'}", "views.theta takes a list of degrees"},
        {"{'theta': {'from': 1, 'to': 2}}", "views.theta.count takes a whole number"},
        {"{'theta': {'from': 1, 'count': 2}}", "views.theta takes {\"from\""},
        {"{'theta': {'from': 1, 'to': 2, 'cuont': 2}}", "views.theta has no key 'cuont'; the nearest is 'count'"},
        {"{'phi': 10000, 'theta': 1000}", "views has 10000000 views"},
        {"{'path': [{}], 'count': 2}", "views.path takes a list of 2 to"},
        {"{'path': 'cameras.pvcc', 'count': 2}", "views.path takes a list of 2 to"},
        {"{'path': [{}, {}]}", "views.count takes a whole number"},
        {"{'path': [{}, {}], 'count': 0}", "views.count takes a whole number"},
        {"{'path': [{}, {}], 'count': 2, 'closed': 1}", "views.closed takes true or false"},
        {"{'path': [{}, {'name': 'x'}], 'count': 2}", "views.path[1] has no key 'name'"},
        {"{'path': [{'time': 0}, {}], 'count': 2}", "1 of its 2 cameras have a time"},
        {"{'path': [{'time': 0.5}, {'time': 0.5}], 'count': 2}", "views.path[1].time is 0.5"},
        {"{'path': [{'time': 0}, {'time': 1.5}], 'count': 2}", "views.path[1].time takes"},
        {"{'path': [{'time': 0}, {'time': 1}], 'count': 2, 'closed': true}", "views.path is closed"},
        {"{'path': [{}, {}], 'count': 2, 'along': 'time'}", "views.count does not go with"},
        {"{'cameras': [{}], 'names': ['a']}", "views has no key 'names'"},
        {"{'cameras': {}}", "views.cameras takes a list of 1 to"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_views views;
        if (view_read(&views, row[i][0]) != TC_EXIT_FAILED || !strstr(told, row[i][1]))
            fail_msg("%s: %s", row[i][0], told);
        assert_non_null(strstr(told, "s.json:3: views"));
        assert_true(strchr(told, '\n') == told + strlen(told) - 1); /* one line */
        tc_views_finish(&views);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phi_and_theta_lead_elsewhere),
        cmocka_unit_test(a_grid_is_not_azimuth_and_elevation),
        cmocka_unit_test(a_count_spreads_angles_otherwise),
        cmocka_unit_test(an_orbit_is_no_circle),
        cmocka_unit_test(keys_of_a_camera_are_left_aside),
        cmocka_unit_test(a_path_is_not_vtks_spline),
        cmocka_unit_test(a_path_misses_its_keys_or_has_a_corner),
        cmocka_unit_test(a_closed_path_that_begins_late_loses_its_way_back),
        cmocka_unit_test(a_direction_loses_what_the_scene_says),
        cmocka_unit_test(a_path_along_time_has_not_a_view_a_step),
        cmocka_unit_test(a_camera_without_direction_is_made),
        cmocka_unit_test(a_name_is_not_the_views_own),
        cmocka_unit_test(wrong_views_are_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
