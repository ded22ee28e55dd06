/* test_gpu_propose.c: proposed pixels against every face asked in double for every pixel; the frame's accuracy. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/vec.h"
#include "gpu/propose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30 };

typedef struct fixture {
    tc_mesh *mesh;
    tc_pack pack;
} fixture;

static fixture make(tc_mesh *mesh)
{
    fixture f = {.mesh = mesh};
    tc_error err = {0};
    const tc_prepare_options options = {.reentry = TC_REENTRY_PEEL};
    if (tc_mesh_prepare(mesh, &options, NULL, &err) != TC_OK || tc_pack_build(&f.pack, mesh, 0, &err) != TC_OK)
        fail_msg("%s", err.text);
    return f;
}

static fixture synth(const char *name, size_t n_cells)
{
    tc_mesh *mesh;
    tc_error err = {0};
    if (tc_synth_create(&mesh, name, n_cells, 2, &err) != TC_OK)
        fail_msg("%s", err.text);
    return make(mesh);
}

/* Needles and flat triangles, some of a millionth of the mesh's size. */
static fixture needles(void)
{
    enum { N = 60 };
    static double vertex[4 * N][3];
    static int32_t tet[N][4];
    uint64_t seed = 11;
    for (int i = 0; i < N; i++) {
        double u[9];
        for (int k = 0; k < 9; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            u[k] = (double)(seed >> 11) * 0x1p-52 - 1;
        }
        const double thin = pow(10, -1 - i % 6);
        for (int v = 0; v < 4; v++) {
            tet[i][v] = 4 * i + v;
            for (int k = 0; k < 3; k++)
                vertex[4 * i + v][k] = u[k] + (v == 1 ? u[3 + k] : v == 2 ? thin * u[6 + k] : 0);
        }
        vertex[4 * i + 3][i % 3] += i % 2 ? thin : 0.1;
    }
    const tc_mesh_arrays arrays = {4 * N, &vertex[0][0], N, &tet[0][0], NULL, TC_POINT_DATA, NULL};
    tc_mesh *mesh;
    assert_int_equal(tc_mesh_create(&mesh, &arrays, NULL), TC_OK);
    return make(mesh);
}

static void finish(fixture *f)
{
    tc_pack_finish(&f->pack);
    tc_mesh_destroy(&f->mesh);
}

/* Whether the ray of the frame (mesh space, double) enters through the face: all crosses positive around it. */
static bool enters(const float *corner, const double *o, const double *u, const double *v)
{
    double p[3][2];
    for (int k = 0; k < 3; k++) {
        double r[3];
        for (int a = 0; a < 3; a++)
            r[a] = corner[3 * k + a] - o[a];
        p[k][0] = tc_vec_dot(r, u);
        p[k][1] = tc_vec_dot(r, v);
    }
    for (int k = 0; k < 3; k++)
        if (!(p[k][0] * p[(k + 1) % 3][1] - p[k][1] * p[(k + 1) % 3][0] > 0))
            return false;
    return true;
}

/* Is the pixel's centre in the triangle, edges included? */
static bool covers(const tc_proposal *t, double x, double y)
{
    int positive = 0, negative = 0;
    for (int k = 0; k < 3; k++) {
        const tc_proposal *a = &t[k], *b = &t[(k + 1) % 3];
        double c = ((double)b->x - a->x) * (y - a->y) - ((double)b->y - a->y) * (x - a->x);
        positive += c > 0;
        negative += c < 0;
    }
    return !positive || !negative;
}

static size_t check(const fixture *f, const tc_camera *camera)
{
    tc_rays rays;
    tc_frame frame;
    tc_proposals proposals = {0};
    tc_error err = {0};
    if (tc_rays_from_camera(&rays, camera, WIDTH, HEIGHT, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_frame_build(&frame, &rays, f->pack.center, f->pack.scale);
    assert_int_equal(tc_propose(&proposals, &frame, WIDTH, HEIGHT, f->pack.face_corner, f->pack.n_face, &err), TC_OK);
    assert_int_equal(proposals.n % 3, 0);
    size_t *first = calloc(f->pack.n_face + 1, sizeof *first), hits = 0;
    assert_non_null(first);
    for (size_t i = 0; i < proposals.n; i++)
        first[proposals.corner[i].face + 1]++;
    for (size_t i = 0; i < f->pack.n_face; i++)
        first[i + 1] += first[i];
    for (size_t i = 0; i + 1 < proposals.n; i++)
        assert_true(proposals.corner[i].face <= proposals.corner[i + 1].face);
    for (int i = 0; i < WIDTH * HEIGHT && !frame.hidden; i++) {
        double X = i % WIDTH + 0.5, Y = i / WIDTH + 0.5, o[3], d[3], u[3], v[3];
        for (int k = 0; k < 3; k++) {
            o[k] = frame.point[k] + X * frame.point_dx[k] + Y * frame.point_dy[k];
            d[k] = frame.direction[k] + X * frame.direction_dx[k] + Y * frame.direction_dy[k];
        }
        tc_vec_normalize(d);
        tc_vec_cross(u, d, frame.up);
        tc_vec_normalize(u);
        tc_vec_cross(v, u, d);
        for (size_t face = 0; face < f->pack.n_face; face++) {
            if (!enters(f->pack.face_corner + 9 * face, o, u, v))
                continue;
            /* Behind an eye outside the mesh nothing is entered. */
            double depth = 0;
            for (int k = 0; k < 3; k++)
                for (int a = 0; a < 3; a++)
                    depth += (f->pack.face_corner[9 * face + 3 * (size_t)k + (size_t)a] - o[a]) * d[a];
            bool from_eye = !rays.parallel && tc_vec_length(frame.point_dx) == 0;
            if (from_eye && !frame.eye_inside && depth < 0)
                continue;
            hits++;
            bool proposed = false;
            for (size_t k = first[face]; k < first[face + 1] && !proposed; k += 3)
                proposed = covers(proposals.corner + k, X / WIDTH * 2 - 1, Y / HEIGHT * 2 - 1);
            if (!proposed)
                fail_msg("face %zu is entered at pixel %d, %d but was not proposed there", face, i % WIDTH, i / WIDTH);
        }
    }
    free(first);
    tc_proposals_finish(&proposals);
    return hits;
}

static size_t check_views(const fixture *f)
{
    static const double from[4][3] = {{0.3, 0.5, 1}, {1, 0, 0}, {-0.3, 0.2, -0.9}, {0.1, 1, 0.2}};
    static const double distance[] = {0.02, 0.3, 0.6, 1, 3, 1e3, 1e6}; /* of the diagonal */
    tc_mesh_report r;
    tc_mesh_get_report(&r, f->mesh);
    size_t hits = 0;
    for (int k = 0; k < 4; k++) {
        const double up[3] = {0, 0.8, 0.6};
        tc_camera camera = {0};
        tc_camera_reset(&camera, r.bounds, from[k], up, 30, (double)WIDTH / HEIGHT);
        double to[3], diagonal = 2 / f->pack.scale;
        tc_vec_sub(to, camera.position, camera.focal_point);
        tc_vec_normalize(to);
        for (size_t i = 0; i < sizeof distance / sizeof *distance; i++) {
            tc_camera moved = camera;
            tc_vec_mul_add(moved.position, camera.focal_point, distance[i] * diagonal, to);
            moved.view_angle = distance[i] < 1 ? 100 : 60 / distance[i];
            hits += check(f, &moved);
            for (int a = 0; a < 3 && distance[i] < 1; a++) /* looking past the middle, and away */
                moved.focal_point[a] += diagonal * (a == k % 3 ? 1.5 : -0.3);
            if (distance[i] < 1)
                hits += check(f, &moved);
        }
        camera.parallel = true;
        hits += check(f, &camera);
    }
    return hits;
}

static void pixels_that_see_a_face_are_not_proposed(void **state)
{
    (void)state;
    static const char *const names[] = {"kuhn", "ball", "comb"};
    for (int i = 0; i < 3; i++) {
        fixture f = synth(names[i], i == 2 ? 3000 : 600);
        assert_true(check_views(&f) > 5000);
        finish(&f);
    }
}

static void needles_are_not_proposed(void **state)
{
    (void)state;
    fixture f = needles();
    assert_true(check_views(&f) > 500);
    finish(&f);
}

/* Proposals of a face for all pixels, whatever it is. */
static size_t whole_screens(const fixture *f, const tc_camera *camera)
{
    tc_rays rays;
    tc_frame frame;
    tc_proposals proposals = {0};
    size_t n = 0;
    assert_int_equal(tc_rays_from_camera(&rays, camera, 512, 512, NULL), TC_OK);
    tc_frame_build(&frame, &rays, f->pack.center, f->pack.scale);
    assert_int_equal(tc_propose(&proposals, &frame, 512, 512, f->pack.face_corner, f->pack.n_face, NULL), TC_OK);
    for (size_t i = 0; i < proposals.n; i += 3) {
        int far = 0;
        for (size_t k = i; k < i + 3; k++)
            far += proposals.corner[k].x >= 3 || proposals.corner[k].y >= 3;
        n += far == 2;
    }
    tc_proposals_finish(&proposals);
    return n;
}

static void an_eye_inside_asks_all_faces_about_all_pixels(void **state)
{
    (void)state;
    static const double eyes[][3] = {{0.1, 0.2, 0.05}, {-0.6, 0.3, 0.1}, {0.7, -0.2, 0.4}};
    fixture f = synth("ball", 30000);
    for (int e = 0; e < 3; e++)
        for (int parallel = 0; parallel < 2; parallel++) {
            const tc_camera camera = {.position = {eyes[e][0], eyes[e][1], eyes[e][2]},
                                      .focal_point = {0.9, 0.7, -0.3},
                                      .view_up = {0, 1, 0},
                                      .view_angle = 60,
                                      .parallel_scale = 0.5,
                                      .parallel = parallel};
            assert_int_equal(whole_screens(&f, &camera), 0);
        }
    finish(&f);
}

static void eyes_on_the_boundary_or_narrow_views_propose_too_little(void **state)
{
    (void)state;
    static const double eyes[][3] = {{0, 0, 0}, {0.5, 0, 0},     {0.41, 0.37, 1},
                                     {1, 1, 1}, {0.5, 0.5, 0.5}, {0.3, 1, 0.7}};
    static const double to[][3] = {{1, 0.2, 0.3}, {-0.5, 1, 0.9}, {0.5, 0.5, -1}, {0.31, 0.72, 0.4}};
    static const double angles[] = {179, 100, 20, 1e-3, 1e-6, 1e-8};
    fixture f = synth("kuhn", 384);
    size_t hits = 0;
    for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++)
        for (size_t t = 0; t < sizeof to / sizeof *to; t++)
            for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
                const tc_camera camera = {.position = {eyes[e][0], eyes[e][1], eyes[e][2]},
                                          .focal_point = {to[t][0], to[t][1], to[t][2]},
                                          .view_up = {0.1, 1, 0.2},
                                          .view_angle = angles[a]};
                hits += check(&f, &camera);
            }
    assert_true(hits > 50000);
    finish(&f);
}

/* Faces with corners within rounding of several sides of the cone, near its apex: each cut finds corners within and
 * beyond it by turns, so that nine are left in the end, more than a convex polygon has. */
static void corners_at_the_cones_sides_overflow(void **state)
{
    (void)state;
    static const float faces[][9] = {
        {0x1p-148f, 0x1p-149f, -0x1.a36e2ep-14f, -0x1.041896p-4f, -0x1.ba29c8p-5f, 0x1.0346dcp-5f, 0x1p-149f,
         -0x1p-149f, 0x1.1ad42cp-9f},
        {0x1.780002p-31f, -0x1.526664p-32f, -0x1.a36ddp-14f, -0x1.916874p-14f, -0x1.916876p-14f, -0x1.b573eap-15f,
         -0x1.a2d0e4p-3f, -0x1.a2d0e6p-3f, 0x1.a2680ap-4f},
        {0x1.11f0c6p-7f, -0x1.ac083p-3f, 0x1.ab9f56p-4f, 0x1.620002p-29f, -0x1.62p-29f, -0x1.a36cccp-14f, -0x1p-149f,
         -0x1p-149f, -0x1.a36e2ep-14f},
        {-0x1.c08302p-18f, -0x1.c08304p-18f, -0x1.956a16p-14f, 0x1.2a7efcp-11f, -0x1.72229p-12f, 0x1.8346dcp-13f, 0, 0,
         -0x1.a36e2ep-14f},
        {-0x1.fa5e34p-2f, -0x1.fa5e36p-2f, 0x1.fa29c8p-3f, 0x1.d80004p-30f, -0x1.d8p-30f, -0x1.a36d42p-14f,
         -0x1.4aa8f6p-27f, 0x1.4e0004p-27f, -0x1.a368f6p-14f},
        {-0x1.eb8522p-16f, -0x1.7f62b8p-17f, -0x1.65fd8ap-14f, -0x1.af1a9ep-2f, -0x1.af1a9ep-2f, 0x1.aee632p-3f,
         0x1.7c0002p-30f, -0x1.9a6668p-32f, -0x1.a36d7p-14f},
        {-0x1.d58102p-3f, 0x1.d58108p-3f, 0x1.d5182ap-4f, -0x1.05a1c8p-4f, -0x1.05a1cap-4f, 0x1.04d012p-5f,
         0x1.300002p-32f, -0x1.1dc28cp-33f, -0x1.a36e08p-14f},
    };
    enum { N = sizeof faces / sizeof faces[0] };
    const tc_frame frame = {.clip = {[0] = 1, [5] = 1, [11] = 1}, .eye_inside = true}; /* mesh space is x, y, w */
    tc_proposals proposals = {0};
    assert_int_equal(tc_propose(&proposals, &frame, WIDTH, HEIGHT, faces[0], N, NULL), TC_OK);
    assert_int_equal(proposals.n, 3 * N); /* so near the eye they may be anywhere: the screen, once each */
    for (size_t i = 0; i < proposals.n; i++)
        assert_int_equal(proposals.corner[i].face, i / 3);
    tc_proposals_finish(&proposals);
}

static void faces_that_look_away_are_proposed(void **state)
{
    (void)state;
    fixture f = synth("ball", 3000);
    tc_mesh_report r;
    tc_mesh_get_report(&r, f.mesh);
    const double from[3] = {0.3, 0.2, 1}, up[3] = {0, 1, 0};
    tc_camera camera = {0};
    tc_camera_reset(&camera, r.bounds, from, up, 30, 1);
    tc_rays rays;
    tc_frame frame;
    tc_proposals proposals = {0};
    assert_int_equal(tc_rays_from_camera(&rays, &camera, 1024, 1024, NULL), TC_OK);
    tc_frame_build(&frame, &rays, f.pack.center, f.pack.scale);
    assert_int_equal(tc_propose(&proposals, &frame, 1024, 1024, f.pack.face_corner, f.pack.n_face, NULL), TC_OK);
    size_t faces = 0;
    for (size_t i = 0; i < proposals.n; i++)
        faces += i == 0 || proposals.corner[i].face != proposals.corner[i - 1].face;
    assert_true(faces >= f.pack.n_face / 4 && faces <= f.pack.n_face * 6 / 10);
    /* The whole mesh behind the eye: nothing. */
    for (int a = 0; a < 3; a++)
        camera.focal_point[a] = 2 * camera.position[a] - camera.focal_point[a];
    assert_int_equal(tc_rays_from_camera(&rays, &camera, 1024, 1024, NULL), TC_OK);
    tc_frame_build(&frame, &rays, f.pack.center, f.pack.scale);
    assert_true(frame.hidden);
    tc_proposals_finish(&proposals);
    finish(&f);
}

/* ----------------------------------------------------------------------------------------------------- frame */

/* Distance of the point o (mesh space) from the world's line, in half diagonals. */
static double off_line(const double *o, const double *origin, const double *direction, const tc_pack *p)
{
    double world[3], along[3], off[3];
    for (int k = 0; k < 3; k++)
        world[k] = o[k] / p->scale + p->center[k] - origin[k];
    double t = tc_vec_dot(world, direction);
    for (int k = 0; k < 3; k++)
        along[k] = t * direction[k];
    tc_vec_sub(off, world, along);
    return tc_vec_length(off) * p->scale;
}

static void rays_of_the_frame_are_beside_the_cameras(void **state)
{
    (void)state;
    fixture f = synth("kuhn", 300);
    static const double distance[] = {0, 0.2, 0.49, 0.51, 0.99, 1.01, 30, 1e4, 1e6};
    double diagonal = 2 / f.pack.scale;
    for (size_t i = 0; i < sizeof distance / sizeof *distance; i++)
        for (int parallel = 0; parallel < 2; parallel++) {
            const double to[3] = {0.36, 0.48, 0.8};
            tc_camera camera = {.focal_point = {0.5, 0.5, 0.5},
                                .view_up = {0, 1, 0},
                                .parallel = parallel,
                                .parallel_scale = 1,
                                .view_angle = distance[i] < 1 ? 60 : 40 / distance[i]};
            tc_vec_mul_add(camera.position, camera.focal_point, distance[i] * diagonal, to);
            if (distance[i] == 0)
                tc_vec_mul_add(camera.focal_point, camera.position, -1, to);
            tc_rays rays;
            tc_frame frame;
            assert_int_equal(tc_rays_from_camera(&rays, &camera, 300, 200, NULL), TC_OK);
            tc_frame_build(&frame, &rays, f.pack.center, f.pack.scale);
            if (!parallel && fabs(distance[i] - 0.5) > 0.02)
                assert_true(frame.eye_inside == (distance[i] < 0.5));
            assert_false(frame.hidden);
            if (fabs(distance[i] - 0.5) > 0.005) { /* the plane of an eye outside cuts nothing here */
                assert_true(frame.clip_near == (distance[i] < 0.5));
                assert_false(frame.clip_far || frame.ahead);
            }
            double tolerance = 1e-12 + 4e-15 * distance[i]; /* what an eye so far away keeps of its digits */
            for (int k = 0; k < 20; k++) {
                double X = (k * 97) % 300 + 0.5, Y = (k * 61) % 200 + 0.5, origin[3], direction[3], o[3], d[3], off[3];
                tc_rays_pixel(origin, direction, &rays, X, Y);
                for (int a = 0; a < 3; a++) {
                    o[a] = frame.point[a] + X * frame.point_dx[a] + Y * frame.point_dy[a];
                    d[a] = frame.direction[a] + X * frame.direction_dx[a] + Y * frame.direction_dy[a];
                }
                tc_vec_normalize(d);
                assert_true(off_line(o, origin, direction, &f.pack) <= tolerance);
                assert_true(tc_vec_length(o) < 4); /* coordinates stay small however far the eye is */
                tc_vec_cross(off, d, direction);
                assert_true(tc_vec_length(off) < 1e-12);
                assert_true(tc_vec_dot(d, direction) > 0);
                tc_vec_cross(off, d, frame.up);
                assert_true(tc_vec_length(off) > 0.1);
            }
        }
    finish(&f);
}

static void clip_space_is_beside_the_rays(void **state)
{
    (void)state;
    fixture f = synth("kuhn", 300);
    for (int parallel = 0; parallel < 2; parallel++) {
        const tc_camera camera = {.position = {3, 2, 5},
                                  .focal_point = {0.5, 0.5, 0.5},
                                  .view_up = {0, 1, 0},
                                  .parallel = parallel,
                                  .parallel_scale = 1,
                                  .view_angle = 30};
        tc_rays rays;
        tc_frame frame;
        assert_int_equal(tc_rays_from_camera(&rays, &camera, 300, 200, NULL), TC_OK);
        tc_frame_build(&frame, &rays, f.pack.center, f.pack.scale);
        for (int k = 0; k < 20; k++) {
            double X = (k * 97) % 300 + 0.5, Y = (k * 61) % 200 + 0.5, origin[3], direction[3], m[3], clip[4];
            tc_rays_pixel(origin, direction, &rays, X, Y);
            for (int a = 0; a < 3; a++) /* a point on the ray, mesh space */
                m[a] = (origin[a] + (4 + 0.1 * k) * direction[a] - f.pack.center[a]) * f.pack.scale;
            for (int row = 0; row < 4; row++)
                clip[row] = (double)frame.clip[row] * m[0] + (double)frame.clip[4 + row] * m[1] +
                            (double)frame.clip[8 + row] * m[2] + (double)frame.clip[12 + row];
            assert_true(clip[3] > 0);
            assert_true(fabs((clip[0] / clip[3] + 1) * 150 - X) < 0.01);
            assert_true(fabs((clip[1] / clip[3] + 1) * 100 - Y) < 0.01);
        }
    }
    finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_that_see_a_face_are_not_proposed),
        cmocka_unit_test(needles_are_not_proposed),
        cmocka_unit_test(an_eye_inside_asks_all_faces_about_all_pixels),
        cmocka_unit_test(eyes_on_the_boundary_or_narrow_views_propose_too_little),
        cmocka_unit_test(corners_at_the_cones_sides_overflow),
        cmocka_unit_test(faces_that_look_away_are_proposed),
        cmocka_unit_test(rays_of_the_frame_are_beside_the_cameras),
        cmocka_unit_test(clip_space_is_beside_the_rays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
