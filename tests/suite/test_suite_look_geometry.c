/* test_suite_look_geometry.c: triangles and lines are not where they belong, or not in order with the volume and with
 * each other. */
#define _GNU_SOURCE
#include "look.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 72, HEIGHT = 64, MOST_SHEETS = 320 };

static const double KAPPA = 1.5; /* of the matter, per unit length */
/* Matter of one colour in all of the data's range; nothing in the picture may be brighter than the function, so it has
 * a white end beyond. */
static const tc_knot fog[3] = {{0, 0.8, 0.6, 0.4, 1}, {90, 0.8, 0.6, 0.4, 1}, {100, 1, 1, 1, 1}};

static double ramp(const double *x)
{
    return 1 + x[0] + 0.3 * x[1] - 0.2 * x[2];
}

static const struct view {
    double direction[3];
    bool parallel;
} views[] = {{{1, 0.3, 0.2}, false}, {{-1, 0.1, -0.3}, true}, {{0.3, 0.5, 1}, true}, {{-0.7, 0.3, -0.4}, false}};
enum { N_VIEW = sizeof views / sizeof *views };

/* ------------------------------------------------------------------------------------------ sheets */

/* Parallelograms of two triangles each: centre, two half sides, colour and opacity. */
typedef struct sheet {
    double centre[3], u[3], v[3], color[3], opacity;
} sheet;

typedef struct sheets {
    int n;
    sheet of[MOST_SHEETS];
    double vertex[MOST_SHEETS][12];
    tc_geometry geometry[MOST_SHEETS];
} sheets;

static const int32_t halves[6] = {0, 1, 2, 2, 1, 3};

static void add_sheet(sheets *s, const sheet *one)
{
    double *at = s->vertex[s->n];
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < 3; k++)
            at[3 * c + k] = one->centre[k] + (c & 1 ? 1 : -1) * one->u[k] + (c & 2 ? 1 : -1) * one->v[k];
    s->geometry[s->n] = (tc_geometry){.n_vertex = 4,
                                      .n_triangle = 2,
                                      .vertex = at,
                                      .triangle = halves,
                                      .color = {one->color[0], one->color[1], one->color[2]},
                                      .opacity = one->opacity,
                                      .width = 1};
    s->of[s->n++] = *one;
}

static const sheet some[] = {
    {{0.4, 0.5, 0.5}, {0, 0.4, 0.1}, {0, -0.1, 0.35}, {0, 0.9, 0.1}, 0.5},     /* within */
    {{0.62, 0.45, 0.5}, {0.1, 0.3, 0}, {0, 0, 0.9}, {1, 0.2, 0}, 0.3},         /* through the side */
    {{1.4, 0.6, 0.6}, {0, 0.7, 0}, {0.1, 0, 0.4}, {0.1, 0, 1}, 0.6},           /* beside the box */
    {{-0.4, 0.2, 0.7}, {0, 0.5, 0.2}, {0.1, -0.1, 0.6}, {0.5, 0.5, 0.1}, 0.7}, /* and on its other side */
    {{0.5, 0.5, 0.3}, {0.2, 0.1, 0.02}, {-0.1, 0.25, 0}, {0.9, 0.8, 1}, 1},    /* opaque, within */
    {{0.5, 0.5, 1.3}, {0.2, 0.1, 0.02}, {-0.1, 0.25, 0}, {0.2, 0.8, 0.3}, 1},  /* opaque, beside */
};
enum { N_SOME = sizeof some / sizeof *some };

/* Where the ray meets the sheet; 0: nowhere, 1: there, -1: within 1e-3 of its rim, or almost along it. */
static int meet(double *t, const sheet *s, const double *o, const double *d)
{
    double n[3], to[3], side[2] = {0, 0}, along = 0, across = 0, uu = 0, vv = 0, uv = 0, rest[3], a = 0, b = 0;
    for (int k = 0; k < 3; k++)
        n[k] = s->u[(k + 1) % 3] * s->v[(k + 2) % 3] - s->u[(k + 2) % 3] * s->v[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        along += n[k] * d[k], to[k] = s->centre[k] - o[k], across += n[k] * to[k];
    double size = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (fabs(along) < 0.03 * size)
        return -1;
    *t = across / along;
    for (int k = 0; k < 3; k++) {
        rest[k] = o[k] + *t * d[k] - s->centre[k];
        uu += s->u[k] * s->u[k], vv += s->v[k] * s->v[k], uv += s->u[k] * s->v[k];
        a += rest[k] * s->u[k], b += rest[k] * s->v[k];
    }
    double whole = uu * vv - uv * uv;
    side[0] = fabs((a * vv - b * uv) / whole), side[1] = fabs((b * uu - a * uv) / whole);
    double most = fmax(side[0], side[1]);
    return most < 0.999 ? 1 : most < 1.001 ? -1 : 0;
}

static int nearer(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (p[0] > q[0]) - (p[0] < q[0]);
}

static void over(double sum[4], const double color[3], double opacity)
{
    double left = (1 - sum[3]) * opacity;
    for (int k = 0; k < 3; k++)
        sum[k] += left * color[k];
    sum[3] += left;
}

/* What the ray sees; false: it is too near to a rim to be asked. */
static bool expected(double sum[4], const sheets *s, const double *o, const double *d)
{
    static const double matter[3] = {0.8, 0.6, 0.4};
    double chord[2], met[MOST_SHEETS][2], from;
    int n = 0;
    const bool in = look_chord(chord, o, d, NULL, 0);
    for (int i = 0; i < s->n; i++) {
        const int there = meet(&met[n][0], &s->of[i], o, d);
        met[n][1] = i;
        if (there < 0 || (there > 0 && in && fmin(fabs(met[n][0] - chord[0]), fabs(met[n][0] - chord[1])) < 1e-4))
            return false;
        n += there;
    }
    qsort(met, (size_t)n, sizeof *met, nearer);
    memset(sum, 0, 4 * sizeof *sum);
    from = chord[0];
    for (int i = 0; i <= n; i++) {
        double to = i < n ? fmin(fmax(met[i][0], chord[0]), chord[1]) : chord[1];
        if (in && to > from)
            over(sum, matter, 1 - exp(-KAPPA * (to - from)));
        from = fmax(from, to);
        if (i < n)
            over(sum, s->of[(int)met[i][1]].color, s->of[(int)met[i][1]].opacity);
        if (i > 0 && i < n && met[i][0] - met[i - 1][0] < 1e-5)
            return false;
    }
    return true;
}

static tc_render_options options_of(const tc_look *look)
{
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.unit_distance = 1 / KAPPA;
    options.opacity_stop = 1;
    options.look = look;
    return options;
}

static void check_sheets(const char *what, const sheets *s, int n_view, int most_steps)
{
    tc_mesh *mesh = look_box(5, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 3);
    const tc_look look = {.n_geometry = s->n, .geometry = s->geometry};
    double worst = 0;
    size_t seen = 0;
    for (int v = 0; v < n_view; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_render_options options = options_of(&look);
        for (int steps = 0; steps <= most_steps; steps += 3) {
            options.steps_per_pass = steps;
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                double origin[3], direction[3], sum[4];
                suite_ray(origin, direction, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
                if (!expected(sum, s, origin, direction))
                    continue;
                seen++;
                for (int k = 0; k < 4; k++)
                    worst = fmax(worst, fabs(sum[k] - image->rgba[4 * i + k]));
            }
            tc_image_destroy(&image);
        }
    }
    suite_say("%s: off by %.2g at most, %zu rays", what, worst, seen);
    assert_true(seen > (size_t)n_view * WIDTH * HEIGHT / 2);
    assert_true(worst < 3e-5);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void sheets_are_out_of_order(void **state)
{
    (void)state;
    static sheets s;
    const int first[] = {0, 4, 0}, end[] = {4, 6, 6};
    const char *what[] = {"translucent sheets", "opaque sheets", "both"};
    for (int i = 0; i < 3; i++) {
        s.n = 0;
        for (int k = first[i]; k < end[i]; k++)
            add_sheet(&s, &some[k]);
        check_sheets(what[i], &s, i < 2 ? 1 : N_VIEW, i < 2 ? 0 : 3);
    }
}

/* Of two at one place the first one is the nearer. */
static void sheets_at_one_place_change_their_order(void **state)
{
    (void)state;
    static sheets s;
    tc_mesh *mesh = look_box(2, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 3);
    tc_camera camera = suite_camera(mesh, 0.1, 0.2, 1, false);
    for (int first = 0; first < 2; first++) {
        sheet one = {{0.5, 0.5, 1.2}, {0.3, 0, 0}, {0, 0.3, 0}, {1, 0, 0}, 0.5};
        s.n = 0;
        one.color[0] = first, one.color[1] = 1 - first;
        add_sheet(&s, &one);
        one.color[0] = 1 - first, one.color[1] = first;
        add_sheet(&s, &one);
        const tc_look look = {.n_geometry = s.n, .geometry = s.geometry};
        tc_render_options options = options_of(&look);
        options.unit_distance = 1e9;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        const float *middle = image->rgba + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
        assert_true(fabs(middle[first ? 0 : 1] - 0.5) < 1e-6 && fabs(middle[first ? 1 : 0] - 0.25) < 1e-6);
        tc_image_destroy(&image);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* More fragments than there was room for, and many behind one another. */
static void a_stack_loses_layers(void **state)
{
    (void)state;
    static sheets s;
    s.n = 0;
    for (int i = 0; i < 160; i++) {
        const double at = 0.15 + 0.7 * (i * 37 % 160) / 160;
        const sheet one = {{at, 0.5, 0.5}, {0, 0.45, 0}, {0, 0, 0.45}, {i % 2, 0.5, i % 3 / 2.0}, 0.02};
        add_sheet(&s, &one);
    }
    check_sheets("160 layers", &s, 2, 0);
}

/* ------------------------------------------------------------------------------------------ the reference */

static void fill_some(sheets *s, const double *bounds)
{
    s->n = 0;
    for (int i = 0; i < N_SOME; i++) {
        sheet one = some[i];
        for (int k = 0; k < 3; k++) {
            double size = bounds[2 * k + 1] - bounds[2 * k];
            one.centre[k] = bounds[2 * k] + size * one.centre[k];
            one.u[k] *= size, one.v[k] *= size;
        }
        add_sheet(s, &one);
        s->geometry[i].lit = i % 2 == 0;
    }
}

/* Compares with the reference all pixels of a view of sheets that light falls on; one shows its back. look: what else
 * there is to see. */
static void check_reference(const char *what, tc_mesh *mesh, const tc_camera *camera, int samples, tc_look look)
{
    static sheets s;
    static const int32_t turned[6] = {0, 2, 1, 1, 2, 3};
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    tc_transfer *tf = suite_benchmark(mesh);
    fill_some(&s, report.bounds);
    s.geometry[4].triangle = turned;
    const tc_light light[2] = {{.head = true, .color = {0.5, 0.4, 0.3}},
                               {.direction = {1, 2, 3}, .color = {0.3, 0.4, 0.5}}};
    look.n_geometry = s.n;
    look.geometry = s.geometry;
    const bool volume = look.shade.volume;
    tc_shade_defaults(&look.shade);
    look.shade.gradient = TC_GRADIENT_CELL;
    look.shade.volume = volume;
    look.shade.surfaces = false;
    look.shade.n_light = 2;
    look.shade.light = light;
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.samples = samples;
    options.look = &look;
    tc_image *image = suite_render(NULL, mesh, tf, camera, &options);
    const tc_verify_result result =
        suite_verify(what, SUITE_HALF_STEP, WIDTH * HEIGHT, image, mesh, tf, camera, &options);
    assert_int_equal(result.pixels, WIDTH * HEIGHT);
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
}

static void lit_sheets_among_gaps_differ_from_the_reference(void **state)
{
    (void)state;
    const tc_look nothing = {0};
    tc_mesh *mesh = suite_synth("heatsink", 3000, TC_REENTRY_CONVEXIFY);
    tc_camera camera = suite_camera(mesh, 0.8, 0.5, 1, false);
    check_reference("gaps filled", mesh, &camera, 1, nothing);
    suite_prepare(mesh, TC_REENTRY_PEEL);
    check_reference("gaps peeled", mesh, &camera, 1, nothing);
    check_reference("four rays a pixel", mesh, &camera, 4, nothing);
    tc_mesh_destroy(&mesh);
}

/* The eye amidst the sheets, a camera that cuts them, matter cut by a plane (which leaves geometry whole), isosurfaces.
 */
static void sheets_and_what_else_there_is_differ_from_the_reference(void **state)
{
    (void)state;
    const tc_look nothing = {0};
    const tc_plane plane = {{1, 0.2, 0.1}, 0.5};
    const tc_iso iso[2] = {{.value = 1.45, .opacity = 0.5}, {.value = 1.7, .opacity = 0.4}};
    const tc_look more = {.n_plane = 1, .plane = &plane, .n_iso = 2, .iso = iso};
    const tc_look alone = {.model = TC_MODEL_SURFACES, .n_iso = 2, .iso = iso};
    tc_mesh *mesh = look_box(5, ramp, TC_POINT_DATA);
    tc_camera camera = suite_camera(mesh, 0.8, 0.5, 1, true);
    check_reference("beside isosurfaces, matter cut", mesh, &camera, 1, more);
    check_reference("surfaces alone", mesh, &camera, 1, alone);
    check_reference("in a lit volume", mesh, &camera, 1, (tc_look){.shade = {.volume = true}});
    check_reference("light that nothing absorbs", mesh, &camera, 1, (tc_look){.model = TC_MODEL_EMISSION});
    check_reference("before a largest value", mesh, &camera, 1, (tc_look){.model = TC_MODEL_MAXIMUM});
    camera.clip_near = 3, camera.clip_far = 3.6;
    check_reference("between planes of the camera", mesh, &camera, 1, nothing);
    camera = suite_camera(mesh, 0.8, 0.5, 1, false);
    const double eye[3] = {0.47, 0.55, 0.8};
    for (int k = 0; k < 3; k++) {
        camera.focal_point[k] += eye[k] - camera.position[k];
        camera.position[k] = eye[k];
    }
    camera.view_angle = 100;
    check_reference("the eye among them", mesh, &camera, 1, nothing);
    tc_mesh_destroy(&mesh);
}

/* Each pixel is that of 4 rays, or that of 16. */
static void adaptive_sampling_sees_other_geometry(void **state)
{
    (void)state;
    static sheets s;
    tc_mesh *mesh = look_box(3, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 3);
    tc_camera camera = suite_camera(mesh, 0.8, 0.5, 1, false);
    s.n = 0;
    for (int i = 0; i < N_SOME; i++)
        add_sheet(&s, &some[i]);
    const tc_look look = {.n_geometry = s.n, .geometry = s.geometry};
    tc_render_options options = options_of(&look);
    const int samples[3] = {4, 16, TC_SAMPLES_ADAPTIVE};
    tc_image *image[3];
    size_t as[2] = {0, 0};
    for (int i = 0; i < 3; i++) {
        options.samples = samples[i];
        image[i] = suite_render(NULL, mesh, tf, &camera, &options);
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double off[2] = {0, 0};
        for (int k = 0; k < 8; k++)
            off[k / 4] = fmax(off[k / 4], fabs(image[2]->rgba[4 * i + k % 4] - image[k / 4]->rgba[4 * i + k % 4]));
        assert_true(fmin(off[0], off[1]) < 1e-6);
        as[0] += off[0] < off[1], as[1] += off[1] < off[0];
    }
    assert_true(as[0] > 500 && as[1] > 100);
    for (int i = 0; i < 3; i++)
        tc_image_destroy(&image[i]);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* ------------------------------------------------------------------------------------------ lines */

static double distance(const double *p, const double *a, const double *b)
{
    double along[2] = {b[0] - a[0], b[1] - a[1]}, to[2] = {p[0] - a[0], p[1] - a[1]};
    double t = (along[0] * to[0] + along[1] * to[1]) / (along[0] * along[0] + along[1] * along[1]);
    t = fmin(fmax(t, 0), 1);
    return hypot(to[0] - t * along[0], to[1] - t * along[1]);
}

/* Lines before the mesh, along the view's plane: in parallel projection pixels are known. */
static void a_line_has_another_width(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(2, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 3);
    const double vertex[] = {-0.2, 0.1, 2, 1.1, 0.7, 2.5, 0.5, 0.9, 2, 0.5, 0.2, 2, -5, 0.4, 2, 9, 0.45, 2};
    const int32_t line[] = {0, 1, 2, 3, 4, 5};
    const double widths[] = {0.7, 1, 3, 6.5};
    tc_camera camera = suite_camera(mesh, 0, 0, 1, true);
    const double pixel = 2 * camera.parallel_scale / HEIGHT;
    size_t seen = 0, wrong = 0;
    for (int w = 0; w < 4; w++) {
        const tc_geometry g = {.n_vertex = 6,
                               .n_line = 3,
                               .vertex = vertex,
                               .line = line,
                               .color = {1, 0, 1},
                               .opacity = 1,
                               .width = widths[w]};
        const tc_look look = {.n_geometry = 1, .geometry = &g};
        const tc_render_options options = options_of(&look);
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const double p[2] = {i % WIDTH + 0.5, i / WIDTH + 0.5};
            double least = INFINITY;
            for (int k = 0; k < 3; k++) {
                double end[2][2];
                for (int e = 0; e < 2; e++) {
                    const double *x = vertex + 3 * line[2 * k + e];
                    end[e][0] = WIDTH / 2.0 + (x[0] - camera.focal_point[0]) / pixel;
                    end[e][1] = HEIGHT / 2.0 - (x[1] - camera.focal_point[1]) / pixel;
                }
                least = fmin(least, distance(p, end[0], end[1]));
            }
            if (fabs(least - widths[w] / 2) < 0.005)
                continue;
            const bool on = least < widths[w] / 2, is = image->rgba[4 * i + 1] < 1e-6f && image->rgba[4 * i] == 1;
            seen += on;
            wrong += on != is;
        }
        tc_image_destroy(&image);
    }
    suite_say("%zu of %zu pixels of lines are wrong", wrong, seen);
    assert_int_equal(wrong, 0);
    assert_true(seen > 1000);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* White lines in black matter: what is left of their light tells how deep they lie. */
static void a_line_lies_at_another_depth(void **state)
{
    (void)state;
    static const tc_knot black[3] = {{0, 0, 0, 0, 1}, {90, 0, 0, 0, 1}, {100, 1, 1, 1, 1}};
    tc_mesh *mesh = look_box(4, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(black, 3);
    const double vertex[] = {0.2, 0.3, 0.9, 0.8, 0.6, 0.1, 0.7, 0.2, 0.9, 0.1, 0.6, -30};
    const int32_t lines[2][2] = {{0, 1}, {2, 3}};
    double worst = 0;
    size_t seen = 0;
    for (int view = 0; view < 4; view++) {
        const int k = view % 2;
        const tc_geometry g = {.n_vertex = 4,
                               .n_line = 1,
                               .vertex = vertex,
                               .line = lines[k],
                               .color = {1, 1, 1},
                               .opacity = 0.999,
                               .width = 1};
        const tc_look look = {.n_geometry = 1, .geometry = &g};
        tc_camera camera = suite_camera(mesh, 0.2, 0.1, 1, view / 2);
        const tc_render_options options = options_of(&look);
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            double o[3], d[3], t[2];
            suite_ray(o, d, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
            if (!(image->rgba[4 * i] > 0.02) || !look_chord(t, o, d, NULL, 0))
                continue;
            /* Where the ray passes the line closest. */
            double best = INFINITY, at = 0;
            for (int n = 0; n <= 4000; n++) {
                double x[3], along = 0, square = 0;
                for (int c = 0; c < 3; c++) {
                    const double a = vertex[6 * k + c], b = vertex[6 * k + 3 + c];
                    x[c] = a + (b - a) * n / 4000.0 * (k ? 0.04 : 1) - o[c];
                    along += x[c] * d[c], square += x[c] * x[c];
                }
                if (square - along * along < best)
                    best = square - along * along, at = along;
            }
            if (at < t[0] + 0.1 || at > t[1])
                continue;
            seen++;
            worst = fmax(worst, fabs(-log(image->rgba[4 * i] / 0.999) / KAPPA - (at - t[0])));
        }
        tc_image_destroy(&image);
    }
    suite_say("lines lie at most %.2g of the box's side from their depth, %zu pixels", worst, seen);
    assert_true(seen > 50);
    assert_true(worst < 0.08); /* their width, nearer to the eye */
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* ------------------------------------------------------------------------------------------ absence */

static void geometry_stays_behind(void **state)
{
    (void)state;
    static sheets s;
    tc_mesh *mesh = look_box(3, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 3);
    tc_camera camera = suite_camera(mesh, 0.3, 0.2, 1, false);
    tc_render_options options = options_of(NULL);
    s.n = 0;
    for (int i = 0; i < N_SOME; i++)
        add_sheet(&s, &some[i]);
    const tc_look look = {.n_geometry = s.n, .geometry = s.geometry};
    tc_render_stats before, with, after;
    tc_image *plain = suite_render(&before, mesh, tf, &camera, &options);
    options.look = &look;
    tc_image *shown = suite_render(&with, mesh, tf, &camera, &options);
    assert_true(suite_difference(plain, shown) > 0.1);
    for (int i = 0; i < s.n; i++)
        s.geometry[i].opacity = 0;
    tc_image *unseen = suite_render(&after, mesh, tf, &camera, &options);
    assert_true(suite_difference(plain, unseen) == 0);
    if (suite_is_gpu()) {
        const double nodes = 32.0 * WIDTH * HEIGHT, textures = 28.0 * WIDTH * HEIGHT;
        assert_true(with.gpu_bytes_other >= before.gpu_bytes_other + nodes + textures);
        assert_true(after.gpu_bytes_other == before.gpu_bytes_other);
        assert_null(strstr(after.effects, "geometry"));
        assert_non_null(strstr(with.effects, "geometry"));
    }
    tc_image_destroy(&plain);
    tc_image_destroy(&shown);
    tc_image_destroy(&unseen);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* More fragments than a buffer holds: said, and the next picture is as it should be. */
static void too_many_fragments_are_drawn(void **state)
{
    (void)state;
    static sheets s;
    tc_mesh *mesh = look_box(2, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 3);
    tc_camera camera = suite_camera(mesh, 0.3, 0.2, 1, false);
    tc_image *image;
    tc_error err = {0};
    assert_int_equal(setenv("TETCAST_GL_TEXELS", "6000", 1), 0);
    tc_renderer *renderer = suite_renderer(NULL);
    unsetenv("TETCAST_GL_TEXELS");
    s.n = 0;
    for (int i = 0; i < 20; i++)
        add_sheet(&s, &some[1]);
    tc_look look = {.n_geometry = s.n, .geometry = s.geometry};
    tc_render_options options = options_of(&look);
    assert_int_equal(tc_render(&image, NULL, renderer, mesh, tf, &camera, &options, NULL, &err), TC_E_MEMORY);
    assert_non_null(strstr(err.text, "fragments"));
    look.n_geometry = 1;
    tc_image *one = suite_render_by(NULL, renderer, mesh, tf, &camera, &options);
    tc_image *other = suite_render(NULL, mesh, tf, &camera, &options);
    assert_true(suite_difference(one, other) == 0);
    tc_image_destroy(&one);
    tc_image_destroy(&other);
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Arrays that change in place, and back. */
static void moved_vertices_are_not_seen(void **state)
{
    (void)state;
    static sheets s;
    tc_mesh *mesh = look_box(3, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 3);
    tc_camera camera = suite_camera(mesh, 0.3, 0.2, 1, false);
    s.n = 0;
    add_sheet(&s, &some[0]);
    const tc_look look = {.n_geometry = 1, .geometry = s.geometry};
    const tc_render_options options = options_of(&look);
    tc_image *first = suite_render(NULL, mesh, tf, &camera, &options);
    s.vertex[0][2] += 0.5;
    tc_image *moved = suite_render(NULL, mesh, tf, &camera, &options);
    s.vertex[0][2] -= 0.5;
    tc_image *again = suite_render(NULL, mesh, tf, &camera, &options);
    assert_true(suite_difference(first, moved) > 0.05);
    assert_true(suite_difference(first, again) == 0);
    tc_image_destroy(&first);
    tc_image_destroy(&moved);
    tc_image_destroy(&again);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sheets_are_out_of_order),
        cmocka_unit_test(a_stack_loses_layers),
        cmocka_unit_test(lit_sheets_among_gaps_differ_from_the_reference),
        cmocka_unit_test(sheets_at_one_place_change_their_order),
        cmocka_unit_test(sheets_and_what_else_there_is_differ_from_the_reference),
        cmocka_unit_test(adaptive_sampling_sees_other_geometry),
        cmocka_unit_test(a_line_has_another_width),
        cmocka_unit_test(a_line_lies_at_another_depth),
        cmocka_unit_test(geometry_stays_behind),
        cmocka_unit_test(too_many_fragments_are_drawn),
        cmocka_unit_test(moved_vertices_are_not_seen),
    };
    const struct CMUnitTest with_triangles[] = {
        cmocka_unit_test(sheets_are_out_of_order),     cmocka_unit_test(sheets_at_one_place_change_their_order),
        cmocka_unit_test(a_stack_loses_layers),        cmocka_unit_test(geometry_stays_behind),
        cmocka_unit_test(moved_vertices_are_not_seen),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    /* The reference draws no lines, and is not its own judge. */
    const int failed =
        suite_is_gpu() ? cmocka_run_group_tests(tests, NULL, NULL) : cmocka_run_group_tests(with_triangles, NULL, NULL);
    suite_end();
    return failed;
}
