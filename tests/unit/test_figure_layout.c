/* test_figure_layout.c: where title, colour bar, triad and axes go, from 200 pixels to 4096. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "figure/font.h"
#include "figure/layout.h"
#include "scene/camera.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const tc_knot KNOT[] = {{-2, 0, 0, 1, 0}, {5.5, 1, 0, 0, 0.5}};
static const double BOUNDS[] = {-1, 2, 0, 1.5, 10, 14};
static const double VIEW[][3] = {{0, 0, 1},      {1, 0, 0},        {0.3, 0.2, 1},  {1, 1, 1},
                                 {-1, 0.4, 0.3}, {-0.5, -0.8, -1}, {0.02, 0.01, 1}};
static const int SIZE[][2] = {{200, 200},  {256, 256},   {320, 200},   {200, 320},  {512, 512},
                              {1024, 768}, {1920, 1080}, {2048, 2048}, {4096, 4096}};

enum { VIEWS = sizeof VIEW / sizeof *VIEW, SIZES = sizeof SIZE / sizeof *SIZE };

typedef struct scene {
    tc_transfer *function;
    tc_camera camera;
    tc_figure figure;
    tc_layout *layout;
} scene;

static int set_up(void **state)
{
    scene *s = calloc(1, sizeof *s);
    s->layout = malloc(sizeof *s->layout);
    *state = s;
    return tc_transfer_from_knots(&s->function, KNOT, 2, NULL) == TC_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    scene *s = *state;
    tc_transfer_destroy(&s->function);
    free(s->layout);
    free(s);
    return 0;
}

/* A full figure, as seen from view v, with the camera fitted to it or as it is after a reset. */
static void make(scene *s, tc_bar bar, int v, const int size[2], bool parallel, bool fit)
{
    const double up[] = {0, 1, 0};
    tc_error err = {0};
    s->figure = (tc_figure){.title = "Title of a figure",
                            .bar = bar,
                            .function = s->function,
                            .bar_title = "p, Pa",
                            .bar_opacity = v % 2,
                            .triad = true,
                            .axes = true,
                            .bounds = BOUNDS,
                            .camera = &s->camera};
    s->camera = (tc_camera){.parallel = parallel};
    tc_camera_reset(&s->camera, BOUNDS, VIEW[v], up, 30, (double)size[0] / size[1]);
    if (fit && tc_figure_fit(&s->camera, &s->figure, BOUNDS, size[0], size[1], &err) != TC_OK)
        fail_msg("%s", err.text);
    if (tc_layout_make(s->layout, &s->figure, size[0], size[1], NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
}

static void check_apart(const tc_layout *l)
{
    for (int i = 0; i < l->n; i++) {
        const tc_item *a = &l->item[i];
        if (a->kind != TC_ITEM_TEXT)
            continue;
        if (a->box.x0 < 0 || a->box.y0 < 0 || a->box.x1 > l->width || a->box.y1 > l->height)
            fail_msg("\"%s\" leaves the picture of %d x %d", a->text, l->width, l->height);
        for (int j = 0; j < l->n; j++) {
            const tc_item *b = &l->item[j];
            if (j != i && b->kind != TC_ITEM_LINE && tc_box_meets(&a->box, &b->box))
                fail_msg("\"%s\" meets \"%s\" in a picture of %d x %d", a->text, b->text, l->width, l->height);
        }
        /* the box is that of the letters as they are drawn */
        tc_path path = {0};
        assert_true(tc_font_add(&path, a->text, a->em, a->x, a->y, a->turned));
        assert_true(path.n > 0);
        for (size_t e = 0; e < path.n; e++)
            for (int k = 0; k < 4; k += 2) {
                double x = path.edge[e][k], y = path.edge[e][k + 1];
                assert_true(x > a->box.x0 - 1e-9 && x < a->box.x1 + 1e-9 && y > a->box.y0 - 1e-9 &&
                            y < a->box.y1 + 1e-9);
            }
        free(path.edge);
    }
}

static int count_texts(const tc_layout *l, int from, int to)
{
    int n = 0;
    for (int i = from; i < to; i++)
        n += l->item[i].kind == TC_ITEM_TEXT;
    return n;
}

static void no_text_meets_another_or_the_edge(void **state)
{
    scene *s = *state;
    for (int z = 0; z < SIZES; z++)
        for (int v = 0; v < VIEWS; v++)
            for (int k = 0; k < 12; k++) {
                make(s, (tc_bar)(k % 4), v, SIZE[z], k / 4 == 1, k / 4 == 2);
                check_apart(s->layout);
            }
}

static void a_fitted_figure_has_all_its_parts(void **state)
{
    scene *s = *state;
    for (int z = 0; z < SIZES; z++)
        for (int v = 0; v < VIEWS; v++)
            for (int k = 0; k < 6; k++) {
                tc_bar bar = (tc_bar)(1 + k % 3);
                make(s, bar, v, SIZE[z], k / 3, true);
                const tc_layout *l = s->layout;
                /* title, three letters of the triad, the bar's title and its labels, of which a lying bar may have
                 * fewer */
                int front = count_texts(l, 0, l->n_front), labels = front - 5;
                if (labels < (bar == TC_BAR_BOTTOM && SIZE[z][0] < 400 ? 2 : 4) || labels > 7)
                    fail_msg("%d labels at the bar %d in %d x %d, view %d", labels, (int)bar, l->width, l->height, v);
                if (SIZE[z][0] < 256 || SIZE[z][1] < 256)
                    continue;
                /* two axes at least, each with a title and two labels */
                int axes = count_texts(l, l->n_front, l->n);
                if (axes < 6)
                    fail_msg("%d texts of axes from view %d in %d x %d", axes, v, l->width, l->height);
            }
}

static void a_fitted_box_keeps_out_of_title_and_bar(void **state)
{
    scene *s = *state;
    for (int v = 0; v < VIEWS; v++)
        for (int k = 0; k < 8; k++) {
            tc_rays rays;
            const int size[] = {640, 480};
            make(s, (tc_bar)(k % 4), v, size, k / 4, true);
            assert_int_equal(tc_rays_from_camera(&rays, &s->camera, size[0], size[1], NULL), TC_OK);
            tc_box box = {1e9, 1e9, -1e9, -1e9};
            for (int c = 0; c < 8; c++) {
                double p[3] = {BOUNDS[c & 1], BOUNDS[2 + (c >> 1 & 1)], BOUNDS[4 + (c >> 2)]}, q[2];
                assert_true(tc_layout_project(q, &rays, p));
                box = (tc_box){fmin(box.x0, q[0]), fmin(box.y0, q[1]), fmax(box.x1, q[0]), fmax(box.y1, q[1])};
            }
            const tc_layout *l = s->layout;
            assert_true(box.x0 > 0 && box.x1 < size[0] && box.y0 > l->top - 1 && box.y1 < size[1]);
            for (int i = 0; i < l->n; i++)
                if (l->item[i].kind == TC_ITEM_STRIP)
                    assert_false(tc_box_meets(&box, &l->item[i].box));
            /* and is as large as it can be: it fills either way */
            assert_true(box.x1 - box.x0 > 0.45 * size[0] || box.y1 - box.y0 > 0.55 * size[1]);
        }
}

/* Ticks of axes stand where the box's own rays go: found by marching a ray through the tick's pixel. */
static void a_tick_is_where_its_value_is(void **state)
{
    scene *s = *state;
    int seen = 0;
    for (int v = 0; v < VIEWS; v++)
        for (int parallel = 0; parallel < 2; parallel++) {
            const int size[] = {800, 800};
            make(s, TC_BAR_NONE, v, size, parallel, false);
            tc_rays rays;
            assert_int_equal(tc_rays_from_camera(&rays, &s->camera, 800, 800, NULL), TC_OK);
            const tc_layout *l = s->layout;
            for (int i = l->n_front; i + 1 < l->n; i++) {
                const tc_item *tick = &l->item[i], *label = &l->item[i + 1];
                char *end;
                if (tick->kind != TC_ITEM_LINE || label->kind != TC_ITEM_TEXT)
                    continue;
                bool minus = !strncmp(label->text, "−", strlen("−"));
                double value = strtod(label->text + (minus ? strlen("−") : 0), &end), nearest = INFINITY;
                if (*end || end == label->text)
                    continue;
                value = minus ? -value : value;
                /* of the twelve edges, the distance of the nearest point with that coordinate from the tick's ray */
                double o[3], d[3];
                tc_rays_pixel(o, d, &rays, tick->box.x0, 800 - tick->box.y0);
                for (int e = 0; e < 12; e++) {
                    int k = e / 4, a = (k + 1) % 3, b = (k + 2) % 3;
                    double p[3], t = 0, off = 0;
                    p[k] = value, p[a] = BOUNDS[2 * a + (e & 1)], p[b] = BOUNDS[2 * b + (e >> 1 & 1)];
                    if (value < BOUNDS[2 * k] - 1e-9 || value > BOUNDS[2 * k + 1] + 1e-9)
                        continue;
                    for (int c = 0; c < 3; c++)
                        t += (p[c] - o[c]) * d[c];
                    for (int c = 0; c < 3; c++)
                        off += pow(p[c] - o[c] - t * d[c], 2);
                    nearest = fmin(nearest, sqrt(off));
                }
                if (!(nearest < 1e-9 * 20))
                    fail_msg("the tick at %s is off by %g in view %d", label->text, nearest, v);
                seen++;
            }
        }
    assert_true(seen > 100);
}

static void the_axes_lie_on_the_outline(void **state)
{
    scene *s = *state;
    for (int v = 0; v < VIEWS; v++)
        for (int parallel = 0; parallel < 2; parallel++) {
            const int size[] = {800, 800};
            make(s, TC_BAR_NONE, v, size, parallel, false);
            tc_rays rays;
            assert_int_equal(tc_rays_from_camera(&rays, &s->camera, 800, 800, NULL), TC_OK);
            double q[8][2];
            for (int c = 0; c < 8; c++) {
                double p[3] = {BOUNDS[c & 1], BOUNDS[2 + (c >> 1 & 1)], BOUNDS[4 + (c >> 2)]};
                assert_true(tc_layout_project(q[c], &rays, p));
            }
            int n = 0;
            for (int i = s->layout->n_front; i < s->layout->n; i++) {
                const tc_item *line = &s->layout->item[i];
                double dx = line->box.x1 - line->box.x0, dy = line->box.y1 - line->box.y0, least = 0, most = 0;
                if (line->kind != TC_ITEM_LINE || hypot(dx, dy) < 3 * s->layout->em)
                    continue;
                n++;
                for (int c = 0; c < 8; c++) { /* all corners lie on one side */
                    double side = (dx * (q[c][1] - line->box.y0) - dy * (q[c][0] - line->box.x0)) / hypot(dx, dy);
                    least = fmin(least, side), most = fmax(most, side);
                }
                assert_true(least > -1e-6 || most < 1e-6);
            }
            assert_true(n >= 2);
        }
}

static void long_texts_are_cut_to_their_place(void **state)
{
    scene *s = *state;
    char text[3000];
    for (size_t i = 0; i + 3 < sizeof text; i += 2)
        memcpy(text + i, i % 10 ? "é" : "x ", 3);
    const int size[] = {512, 512};
    make(s, TC_BAR_RIGHT, 3, size, false, true);
    s->figure.title = s->figure.bar_title = s->figure.axis_title[0] = text;
    assert_int_equal(tc_layout_make(s->layout, &s->figure, 512, 512, NULL, NULL), TC_OK);
    check_apart(s->layout);
    int cut = 0;
    for (int i = 0; i < s->layout->n; i++)
        cut += s->layout->item[i].kind == TC_ITEM_TEXT && strstr(s->layout->item[i].text, "…") != NULL;
    assert_true(cut >= 2);
    assert_true(strstr(s->layout->item[0].text, "…") != NULL);
}

/* Labels that would meet are made fewer: none is missing between others. */
static void a_bar_lacks_no_label(void **state)
{
    static const double range[][2] = {{0, 1}, {1.1e7, 1.9e7}, {-3e-9, 4e-9}, {101300, 101320}, {-0.02, 0.0315}};
    scene *s = *state;
    for (int width = 200; width < 1000; width += 50)
        for (size_t r = 0; r < sizeof range / sizeof *range; r++) {
            const int size[] = {width, 300};
            make(s, TC_BAR_BOTTOM, 3, size, false, true);
            s->figure.has_range = true;
            memcpy(s->figure.range, range[r], sizeof range[r]);
            assert_int_equal(tc_layout_make(s->layout, &s->figure, width, 300, NULL, NULL), TC_OK);
            int n = 0;
            double middle[16] = {0};
            for (int i = 1; i < s->layout->n_front; i++) /* those that follow a tick */
                if (s->layout->item[i].kind == TC_ITEM_TEXT && s->layout->item[i - 1].kind == TC_ITEM_LINE &&
                    !s->layout->item[i - 1].hue)
                    middle[n++] = 0.5 * (s->layout->item[i].box.x0 + s->layout->item[i].box.x1);
            assert_true(n >= 1 && n <= 8);
            for (int i = 2; i < n; i++)
                if (fabs(middle[i] - 2 * middle[i - 1] + middle[i - 2]) > 0.35 * s->layout->em)
                    fail_msg("a label is missing in a bar of a picture %d wide", width);
            for (int i = 0, ticks = 0; i < s->layout->n_front; i++) { /* and as many as there are ticks */
                const tc_item *line = &s->layout->item[i];
                ticks += line->kind == TC_ITEM_LINE && !line->hue;
                if (i + 1 == s->layout->n_front)
                    assert_true(ticks <= n + 8); /* two frames of four lines */
            }
        }
}

static void a_title_a_little_too_long_is_made_smaller(void **state)
{
    scene *s = *state;
    s->figure = (tc_figure){.title = ""};
    assert_int_equal(tc_layout_make(s->layout, &s->figure, 512, 512, NULL, NULL), TC_OK);
    double em = tc_font_em(1.25 * s->layout->em), room = 512 - 2 * s->layout->margin;
    char text[200] = "n";
    while (tc_font_width(text, em) < 1.1 * room)
        strcat(text, "n");
    s->figure.title = text;
    assert_int_equal(tc_layout_make(s->layout, &s->figure, 512, 512, NULL, NULL), TC_OK);
    assert_string_equal(s->layout->item[0].text, text);
    assert_true(s->layout->item[0].em < em);
}

static void warned(void *user, tc_level level, const char *text)
{
    (void)text;
    *(int *)user += level == TC_WARNING;
}

static void what_has_no_room_is_left_out_with_a_warning(void **state)
{
    scene *s = *state;
    int warnings = 0;
    const tc_log log = {.message = warned, .user = &warnings};
    for (int size = 1; size < 200; size++) {
        const int wh[] = {size, size};
        make(s, (tc_bar)(size % 3 + 1), size % VIEWS, wh, false, false);
        check_apart(s->layout);
        warnings = 0;
        assert_int_equal(tc_layout_make(s->layout, &s->figure, size, size, &log, NULL), TC_OK);
        if (size < 40)
            assert_true(warnings >= 3 && count_texts(s->layout, 0, s->layout->n_front) == 0);
    }
    const int wh[] = {400, 400};
    make(s, TC_BAR_NONE, 3, wh, false, false);
    memcpy(s->camera.position, (double[]){0, 1, 12}, sizeof s->camera.position); /* in the box */
    warnings = 0;
    assert_int_equal(tc_layout_make(s->layout, &s->figure, 400, 400, &log, NULL), TC_OK);
    assert_int_equal(warnings, 1);
    assert_int_equal(s->layout->n, s->layout->n_front);
}

/* Where title and bar leave next to nothing the box is not made as small as that. */
static void a_view_without_room_is_lost(void **state)
{
    scene *s = *state;
    static const int small[][2] = {{1, 1}, {16, 16}, {24, 18}, {20, 400}, {400, 20}, {60, 200}, {200, 60}, {120, 90}};
    for (size_t z = 0; z < sizeof small / sizeof *small; z++)
        for (int bar = TC_BAR_NONE; bar <= TC_BAR_BOTTOM; bar++)
            for (int parallel = 0; parallel < 2; parallel++) {
                make(s, (tc_bar)bar, 2, small[z], parallel != 0, false);
                const tc_camera before = s->camera;
                assert_int_equal(tc_figure_fit(&s->camera, &s->figure, BOUNDS, small[z][0], small[z][1], NULL), TC_OK);
                double old = 0, now = 0;
                for (int k = 0; k < 3; k++) {
                    old += pow(before.position[k] - before.focal_point[k], 2);
                    now += pow(s->camera.position[k] - s->camera.focal_point[k], 2);
                }
                assert_true(now < 25 * old && s->camera.parallel_scale <= 5 * before.parallel_scale);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(no_text_meets_another_or_the_edge, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_fitted_figure_has_all_its_parts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_fitted_box_keeps_out_of_title_and_bar, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_tick_is_where_its_value_is, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_axes_lie_on_the_outline, set_up, tear_down),
        cmocka_unit_test_setup_teardown(long_texts_are_cut_to_their_place, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_bar_lacks_no_label, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_title_a_little_too_long_is_made_smaller, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_has_no_room_is_left_out_with_a_warning, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_view_without_room_is_lost, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
