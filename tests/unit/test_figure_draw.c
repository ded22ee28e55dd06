/* test_figure_draw.c: coverage, letters, and the pixels of a figure. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "figure/font.h"
#include "figure/layout.h"
#include "transfer_functions/transfer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint64_t state_of_random = 7;

static double uniform(void)
{
    state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
    return (double)(state_of_random >> 11) * 0x1p-53;
}

/* ---------------------------------------------------------------------------------------------------- coverage */

/* Share of a pixel within a convex polygon, by clipping it to the pixel (Sutherland and Hodgman) and the shoelace
 * formula. */
static double clipped_area(const double (*corner)[2], int n, double x, double y)
{
    double p[64][2];
    memcpy(p, corner, (size_t)n * sizeof *p);
    for (int side = 0; side < 4; side++) {
        double q[64][2];
        int m = 0, axis = side / 2;
        for (int i = 0; i < n; i++) {
            const double *a = p[i], *b = p[(i + 1) % n];
            double limit = (axis ? y : x) + side % 2, da = a[axis] - limit, db = b[axis] - limit;
            if (side % 2)
                da = -da, db = -db;
            if (da >= 0)
                memcpy(q[m++], a, sizeof q[0]);
            if ((da >= 0) != (db >= 0)) {
                q[m][0] = a[0] + (b[0] - a[0]) * da / (da - db);
                q[m][1] = a[1] + (b[1] - a[1]) * da / (da - db);
                m++;
            }
        }
        n = m;
        memcpy(p, q, sizeof p);
    }
    double area = 0;
    for (int i = 0; i < n; i++)
        area += 0.5 * (p[i][0] * p[(i + 1) % n][1] - p[(i + 1) % n][0] * p[i][1]);
    return fabs(area);
}

static void coverage_is_the_area_within_each_pixel(void **state)
{
    (void)state;
    for (int round = 0; round < 300; round++) { /* triangles, in the picture and reaching out of it */
        enum { W = 17, H = 13 };
        double corner[3][2];
        float coverage[W * H];
        tc_path path = {0};
        double size = round % 3 == 0 ? 3 : round % 3 == 1 ? 20 : 300;
        for (int i = 0; i < 3; i++)
            corner[i][0] = 5 + W / 2 + size * (uniform() - 0.5), corner[i][1] = -3 + H / 2 + size * (uniform() - 0.5);
        if (round % 5 == 0) /* along the pixels' edges */
            for (int i = 0; i < 3; i++)
                corner[i][0] = rint(corner[i][0]), corner[i][1] = rint(corner[i][1]);
        for (int i = 0; i < 3; i++)
            assert_true(tc_path_add(&path, corner[i][0], corner[i][1], corner[(i + 1) % 3][0], corner[(i + 1) % 3][1]));
        assert_true(tc_path_fill(coverage, 5, -3, W, H, &path));
        for (int i = 0; i < W * H; i++) {
            double area = clipped_area((const double(*)[2])corner, 3, 5 + i % W, -3 + i / W);
            if (!(fabs(area - coverage[i]) < 1e-5))
                fail_msg("pixel %d, %d of triangle %d: %g, not %g", i % W, i / W, round, coverage[i], area);
        }
        free(path.edge);
    }
}

static void a_grown_dot_is_a_disc(void **state)
{
    (void)state;
    enum { N = 21 };
    float dot[N * N] = {0}, out[N * N];
    dot[10 * N + 10] = 1, dot[0] = 0.5f;
    tc_fill_grow(out, dot, N, N, 3);
    for (int i = 0; i < N * N; i++) {
        double distance = hypot(i % N - 10, i / N - 10), corner = hypot(i % N, i / N);
        double wanted = fmax(fmin(1, fmax(0, 3.5 - distance)), 0.5 * fmin(1, fmax(0, 3.5 - corner)));
        assert_true(fabs(out[i] - wanted) < 1e-6);
    }
}

/* ----------------------------------------------------------------------------------------------------- letters */

static void every_letter_has_an_outline_of_its_own(void **state)
{
    static const char *const texts[] = {"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789",
                                        "!\"#$%&'()*+,-./:;<=>?@[\\]^_`{|}~",
                                        "äöüßéèñøåçšžłőğ",
                                        "αβγδεζηθλμνξπρστφχψωΔΓΛΩΣΦΨ",
                                        "абвгдежзийклмнопрстуфхцчшщъыьэюяЖ",
                                        "−×÷±·°µ²³⁰¹⁴⁵⁶⁷⁸⁹⁻₀₁₂…–—“”‘’∂∇∞≈≤≥∫√∑∏→€‰"};
    (void)state;
    tc_path missing = {0};
    assert_true(tc_font_add(&missing, "\xef\xbf\xbd", 100, 0, 0, false));
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++)
        for (const char *s = texts[t]; *s;) {
            char one[8] = "";
            size_t n = tc_font_bytes(s, 1);
            memcpy(one, s, n);
            s += n;
            tc_path path = {0};
            assert_true(tc_font_add(&path, one, 100, 0, 0, false));
            if (path.n < 4 || (path.n == missing.n && !memcmp(path.edge, missing.edge, path.n * sizeof *path.edge)))
                fail_msg("\"%s\" has no outline", one);
            /* contours are closed: signed lengths cancel out */
            double dx = 0, dy = 0;
            for (size_t e = 0; e < path.n; e++)
                dx += path.edge[e][2] - path.edge[e][0], dy += path.edge[e][3] - path.edge[e][1];
            assert_true(fabs(dx) < 1e-9 && fabs(dy) < 1e-9);
            free(path.edge);
        }
    free(missing.edge);
}

static void broken_text_is_drawn_as_replacement(void **state)
{
    static const char *const broken[] = {"a\xff", "a\xc3",         "a\xe2\x82",    "a\xe5\x81",
                                         "a\xc0", "a\xf4\x8f\xbf", "a\xe2\x98\x83" /* ☃ */};
    (void)state;
    double wanted = tc_font_width("a\xef\xbf\xbd", 100);
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        assert_int_equal(tc_font_count(broken[i]), 2);
        assert_true(tc_font_width(broken[i], 100) == wanted);
    }
    assert_true(tc_font_width("a\tb\n", 100) == tc_font_width("a b ", 100));
}

/* Digits and capitals are sharp above and below: their rows there are all or nothing. */
static void letters_stand_on_whole_pixels(void **state)
{
    (void)state;
    for (double size = 8; size < 60; size *= 1.13) {
        double em = tc_font_em(size), cap = tc_font_cap(em);
        assert_true(fabs(cap - rint(cap)) < 1e-9 && fabs(em - size) < 1);
        tc_box box;
        tc_font_extent(&box, "HEIT17", em);
        assert_true(fabs(box.y1) < 1e-9 && fabs(box.y0 + rint(cap)) < 1e-9);
        tc_font_extent(&box, "xzvw", em);
        assert_true(fabs(box.y1) < 1e-9 && fabs(box.y0 - rint(box.y0)) < 1e-9);
        if (size < 30) { /* rounds do not reach out by a fraction of a pixel */
            tc_font_extent(&box, "o", em);
            assert_true(fabs(box.y1 - rint(box.y1)) < 1e-9 && fabs(box.y0 - rint(box.y0)) < 1e-9);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- the figure */

static const tc_knot KNOT[] = {
    {0, 0, 0, 1, 0}, {1, 0, 1, 0, 0.25}, {2, 0.5, 0.5, 0, 0.5}, {2, 1, 0, 0, 1}, {4, 1, 0, 1, 1}};
static const double BOUNDS[] = {-1, 2, 0, 1.5, 10, 14};

typedef struct scene {
    tc_transfer *function;
    tc_image *image;
    tc_camera camera;
    tc_figure figure;
} scene;

static int set_up(void **state)
{
    static const double direction[] = {0.5, 0.4, 1}, up[] = {0, 1, 0};
    scene *s = calloc(1, sizeof *s);
    *state = s;
    if (tc_transfer_from_knots(&s->function, KNOT, 5, NULL) != TC_OK ||
        tc_image_create(&s->image, 480, 360, NULL) != TC_OK)
        return -1;
    tc_camera_reset(&s->camera, BOUNDS, direction, up, 30, 480.0 / 360);
    s->figure = (tc_figure){.title = "Title",
                            .bar = TC_BAR_RIGHT,
                            .function = s->function,
                            .bar_title = "p, Pa",
                            .bar_opacity = true,
                            .triad = true,
                            .axes = true,
                            .bounds = BOUNDS,
                            .camera = &s->camera};
    return 0;
}

static int tear_down(void **state)
{
    scene *s = *state;
    tc_transfer_destroy(&s->function);
    tc_image_destroy(&s->image);
    free(s);
    return 0;
}

static void paint_all(tc_image *image, float r, float g, float b, float a)
{
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
        float *p = image->rgba + 4 * i;
        p[0] = r, p[1] = g, p[2] = b, p[3] = a;
    }
}

static void draw(scene *s)
{
    tc_error err = {0};
    if (tc_figure_draw(s->image, &s->figure, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
}

static float *at(const tc_image *image, int x, int y)
{
    return image->rgba + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
}

static void an_empty_figure_changes_no_bit(void **state)
{
    scene *s = *state;
    size_t bytes = sizeof(float) * 4 * 480 * 360;
    for (size_t i = 0; i < bytes / sizeof(float); i++)
        s->image->rgba[i] = (float)uniform();
    float *before = malloc(bytes);
    memcpy(before, s->image->rgba, bytes);
    s->figure = (tc_figure){0};
    draw(s);
    s->figure = (tc_figure){.title = "", .bar_title = "p", .axis_title = {"a", "b", "c"}};
    draw(s);
    assert_memory_equal(before, s->image->rgba, bytes);
    free(before);
}

/* Pixels change where items are, within the reach of their soft edges, and nowhere else; what is drawn twice is the
 * same. */
static void pixels_change_at_items_alone(void **state)
{
    scene *s = *state;
    tc_layout *l = malloc(sizeof *l);
    s->figure.ink = TC_INK_DARK;
    paint_all(s->image, 0.5f, 0.5f, 0.5f, 1); /* where letters have soft edges */
    draw(s);
    assert_int_equal(tc_layout_make(l, &s->figure, 480, 360, NULL, NULL), TC_OK);
    for (int y = 0; y < 360; y++)
        for (int x = 0; x < 480; x++) {
            const float *p = at(s->image, x, y);
            bool changed = p[0] != 0.5f || p[1] != 0.5f || p[2] != 0.5f || p[3] != 1, near = false;
            for (int i = 0; changed && i < l->n && !near; i++) {
                const tc_box *b = &l->item[i].box;
                near = x + 4 > fmin(b->x0, b->x1) && x - 3 < fmax(b->x0, b->x1) && y + 4 > fmin(b->y0, b->y1) &&
                       y - 3 < fmax(b->y0, b->y1);
            }
            if (changed && !near)
                fail_msg("pixel %d, %d changed, where nothing is", x, y);
        }
    for (int i = 0; i < l->n; i++) { /* and every text has ink: as much as its outlines hold */
        const tc_item *text = &l->item[i];
        if (text->kind != TC_ITEM_TEXT)
            continue;
        int dark = 0;
        for (int y = (int)text->box.y0; y < text->box.y1; y++)
            for (int x = (int)text->box.x0; x < text->box.x1; x++)
                dark += at(s->image, x, y)[0] < 0.35f;
        assert_true(dark >= 3);
    }
    free(l);
}

/* The whole ink of a title on white is the area of its letters. */
static void ink_is_as_much_as_letters_have(void **state)
{
    scene *s = *state;
    tc_layout *l = malloc(sizeof *l);
    s->figure = (tc_figure){.title = "Quantité Ω"};
    paint_all(s->image, 1, 1, 1, 1);
    draw(s);
    assert_int_equal(tc_layout_make(l, &s->figure, 480, 360, NULL, NULL), TC_OK);
    tc_path path = {0};
    double area = 0, ink = 0;
    assert_true(tc_font_add(&path, l->item[0].text, l->item[0].em, l->item[0].x, l->item[0].y, false));
    for (size_t i = 0; i < path.n; i++)
        area += 0.5 * (path.edge[i][0] * path.edge[i][3] - path.edge[i][2] * path.edge[i][1]);
    for (size_t i = 0; i < 480 * 360; i++)
        ink += 1 - s->image->rgba[4 * i];
    print_message("    ink %.3f, area %.3f\n", ink, fabs(area));
    assert_true(fabs(ink - fabs(area)) < 1e-3 * ink && ink > 100);
    free(path.edge);
    free(l);
}

static void the_bar_has_the_functions_colours_at_its_ticks(void **state)
{
    scene *s = *state;
    tc_layout *l = malloc(sizeof *l);
    for (int k = 0; k < 6; k++) {
        s->figure.bar = (tc_bar)(1 + k % 3);
        s->figure.has_range = s->figure.log = k >= 3;
        s->figure.range[0] = 0.01, s->figure.range[1] = 4;
        paint_all(s->image, 1, 1, 1, 1);
        draw(s);
        assert_int_equal(tc_layout_make(l, &s->figure, 480, 360, NULL, NULL), TC_OK);
        const tc_item *strip = NULL;
        int ticks = 0;
        for (int i = 0; i < l->n_front; i++)
            if (l->item[i].kind == TC_ITEM_STRIP && !l->item[i].opacity)
                strip = &l->item[i];
        assert_non_null(strip);
        for (int i = 1; i < l->n_front; i++) { /* a label follows its tick */
            const tc_item *tick = &l->item[i - 1], *label = &l->item[i];
            char *end;
            double value = strtod(label->text, &end), v[4];
            if (tick->kind != TC_ITEM_LINE || label->kind != TC_ITEM_TEXT || *end || tick->hue)
                continue;
            int x = strip->lying ? (int)tick->box.x0 : (int)(0.5 * (strip->box.x0 + strip->box.x1));
            int y = strip->lying ? (int)(0.5 * (strip->box.y0 + strip->box.y1)) : (int)tick->box.y0;
            x = x < strip->box.x0 ? (int)strip->box.x0 : x >= strip->box.x1 ? (int)strip->box.x1 - 1 : x;
            y = y < strip->box.y0 ? (int)strip->box.y0 : y >= strip->box.y1 ? (int)strip->box.y1 - 1 : y;
            tc_transfer_evaluate(v, s->function, value);
            double away = 0, below[4];
            tc_transfer_evaluate(below, s->function, value * (1 - 1e-9)); /* at the step either colour may be there */
            double away_below = 0;
            for (int c = 0; c < 3; c++) {
                away = fmax(away, fabs(at(s->image, x, y)[c] - v[c]));
                away_below = fmax(away_below, fabs(at(s->image, x, y)[c] - below[c]));
            }
            if (!(fmin(away, away_below) < 0.03)) /* a pixel's width of the scale */
                fail_msg("colour at %s of bar %d is off by %g", label->text, k, away);
            ticks++;
        }
        assert_true(ticks >= 4);
    }
    free(l);
}

static void categories_are_equal_bands_with_their_names(void **state)
{
    static const double value[] = {-1, 0.5, 1.5, 3, 17};
    static const char *const name[] = {"air", "steel", NULL, "",
                                       "a very long name of a material indeed, with more words"};
    static const char *const wanted[] = {"air", "steel", "1.5", "3", "a very lon"};
    scene *s = *state;
    tc_layout *l = malloc(sizeof *l);
    s->figure.n_category = 5, s->figure.category = value, s->figure.category_name = name;
    s->figure.axes = s->figure.bar_opacity = false;
    draw(s);
    assert_int_equal(tc_layout_make(l, &s->figure, 480, 360, NULL, NULL), TC_OK);
    int strips = 0, found = 0;
    for (int i = 0; i < l->n; i++) {
        const tc_box *b = &l->item[i].box;
        for (int k = 0; k < 5 && l->item[i].kind == TC_ITEM_TEXT; k++)
            found += !strncmp(l->item[i].text, wanted[k], strlen(wanted[k]));
        if (l->item[i].kind != TC_ITEM_STRIP)
            continue;
        strips++;
        for (int y = (int)b->y0; y < b->y1; y++) {
            double v[4], u = (b->y1 - y - 0.5) / (b->y1 - b->y0);
            tc_transfer_evaluate(v, s->function, value[(int)(5 * u)]);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(at(s->image, (int)b->x0 + 2, y)[c] - v[c]) < 1e-6);
        }
    }
    assert_int_equal(strips, 1);
    assert_int_equal(found, 5);
    /* more than can be labelled: every so many are */
    double many[500];
    for (int i = 0; i < 500; i++)
        many[i] = i;
    s->figure.n_category = 500, s->figure.category = many, s->figure.category_name = NULL;
    for (int bar = TC_BAR_RIGHT; bar <= TC_BAR_BOTTOM; bar++) {
        s->figure.bar = (tc_bar)bar;
        assert_int_equal(tc_layout_make(l, &s->figure, 480, 360, NULL, NULL), TC_OK);
        int labels = 0;
        for (int i = 1; i < l->n; i++)
            labels += l->item[i].kind == TC_ITEM_TEXT && l->item[i - 1].kind == TC_ITEM_LINE && !l->item[i - 1].hue;
        assert_true(labels > 5 && labels < 30);
    }
    free(l);
}

static void the_opacity_strip_shows_the_board_where_it_is_transparent(void **state)
{
    scene *s = *state;
    tc_layout *l = malloc(sizeof *l);
    draw(s);
    assert_int_equal(tc_layout_make(l, &s->figure, 480, 360, NULL, NULL), TC_OK);
    int seen = 0;
    for (int i = 0; i < l->n; i++) {
        const tc_box *b = &l->item[i].box;
        if (l->item[i].kind != TC_ITEM_STRIP || !l->item[i].opacity)
            continue;
        seen++;
        int grays = 0, reds = 0;
        for (int x = (int)b->x0; x < b->x1; x++) {
            const float *low = at(s->image, x, (int)b->y1 - 1), *high = at(s->image, x, (int)b->y0);
            grays += fabsf(low[0] - low[1]) < 0.02f && low[0] > 0.5f;
            reds += high[0] == 1 && high[1] == 0;
            assert_true(low[3] == 1 && high[3] == 1);
        }
        assert_true(grays == (int)(b->x1 - b->x0) && reds == grays);
    }
    assert_int_equal(seen, 1);
    free(l);
}

static void ink_follows_the_background(void **state)
{
    static const struct {
        float rgba[4];
        tc_ink ink;
        float wanted;
    } row[] = {{{1, 1, 1, 1}, TC_INK_AUTO, 0},  {{0, 0, 0, 1}, TC_INK_AUTO, 1},
               {{0, 0, 0, 0}, TC_INK_AUTO, 0},  {{0.3f, 0.3f, 0.4f, 1}, TC_INK_AUTO, 1},
               {{0, 0, 0, 0}, TC_INK_LIGHT, 1}, {{0, 0, 0, 1}, TC_INK_DARK, 0}};
    scene *s = *state;
    for (size_t r = 0; r < sizeof row / sizeof *row; r++) {
        paint_all(s->image, row[r].rgba[0], row[r].rgba[1], row[r].rgba[2], row[r].rgba[3]);
        for (int y = 20; y < 340; y++) /* a picture in the middle, as dark as can be, does not count */
            for (int x = 20; x < 460; x++)
                memcpy(at(s->image, x, y), (float[]){0, 0, 0, y >= 80}, 4 * sizeof(float));
        for (int y = 20; y < 80; y++)
            for (int x = 20; x < 460; x++)
                memcpy(at(s->image, x, y), row[r].rgba, 4 * sizeof(float));
        s->figure = (tc_figure){.title = "IIIII", .ink = row[r].ink, .text_size = 24};
        draw(s);
        int full = 0;
        for (int i = 0; i < 480 * 80; i++) {
            const float *p = s->image->rgba + 4 * i;
            full += p[0] == row[r].wanted && p[1] == row[r].wanted && p[2] == row[r].wanted && p[3] == 1;
        }
        if (row[r].wanted != row[r].rgba[0] || row[r].rgba[3] == 0)
            assert_true(full > 10 && full < 1000);
    }
}

/* On a transparent picture there is ink and nothing else: colours stay premultiplied, and no soft edge is seen. */
static void a_transparent_picture_stays_premultiplied(void **state)
{
    scene *s = *state;
    s->figure.triad = false; /* whose arrows have colours */
    s->figure.bar = TC_BAR_NONE;
    draw(s);
    int partial = 0;
    for (size_t i = 0; i < 480 * 360; i++) {
        const float *p = s->image->rgba + 4 * i;
        assert_true(p[0] == 0 && p[1] == 0 && p[2] == 0 && p[3] >= 0 && p[3] <= 1);
        partial += p[3] > 0.1f && p[3] < 0.9f;
    }
    assert_true(partial > 100); /* antialiased */
}

static void what_cannot_be_drawn_is_refused_and_changes_nothing(void **state)
{
    scene *s = *state;
    const tc_figure good = s->figure;
    static const double flipped[] = {2, -1, 0, 1, 0, 1};
    tc_camera blind = s->camera;
    memcpy(blind.focal_point, blind.position, sizeof blind.position);
    tc_figure bad[11];
    for (size_t i = 0; i < 11; i++)
        bad[i] = good;
    bad[0].function = NULL;
    bad[1].camera = NULL;
    bad[2].bounds = NULL;
    bad[3].bounds = flipped;
    bad[4].camera = &blind;
    bad[5].has_range = true, bad[5].range[0] = 1, bad[5].range[1] = 0;
    bad[6].log = true; /* the function begins at 0 */
    bad[7].text_size = -3;
    bad[9].n_category = 2;
    bad[10].n_category = 1, bad[10].category = (const double[]){INFINITY};
    bad[8].has_range = true, bad[8].range[1] = NAN;
    for (size_t i = 0; i < 11; i++) {
        tc_error err = {0};
        assert_int_equal(tc_figure_draw(s->image, &bad[i], NULL, &err), TC_E_ARG);
        assert_true(strlen(err.text) > 20);
    }
    for (size_t i = 0; i < 4 * 480 * 360; i++)
        assert_true(s->image->rgba[i] == 0);
}

/* Over a picture that has every kind of background, so that there are soft edges. */
static void a_part_is_drawn_otherwise_than_the_whole(void **state)
{
    static const int size[][2] = {{480, 50}, {97, 61}, {480, 1}, {1, 360}};
    scene *s = *state;
    s->figure.title = "Parts of one";
    s->figure.ink = TC_INK_LIGHT;
    for (int i = 0; i < 480 * 360; i++) {
        float *p = s->image->rgba + 4 * i, a = (float)(i / 480 % 7) / 6;
        p[0] = a * (float)uniform(), p[1] = a * (float)uniform(), p[2] = a, p[3] = a;
    }
    tc_image *before, *parts;
    assert_int_equal(tc_image_create(&before, 480, 360, NULL), TC_OK);
    assert_int_equal(tc_image_create(&parts, 480, 360, NULL), TC_OK);
    memcpy(before->rgba, s->image->rgba, 480 * 360 * 4 * sizeof(float));
    draw(s);
    assert_true(memcmp(before->rgba, s->image->rgba, 480 * 360 * 4 * sizeof(float)) != 0);
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        memset(parts->rgba, 0, 480 * 360 * 4 * sizeof(float));
        for (int y = 0; y < 360; y += size[k][1])
            for (int x = 0; x < 480; x += size[k][0]) {
                const int width = x + size[k][0] < 480 ? size[k][0] : 480 - x;
                const int height = y + size[k][1] < 360 ? size[k][1] : 360 - y;
                tc_figure figure = s->figure;
                tc_image *part;
                assert_int_equal(tc_image_create(&part, width, height, NULL), TC_OK);
                for (int row = 0; row < height; row++)
                    memcpy(at(part, 0, row), at(before, x, y + row), (size_t)width * 4 * sizeof(float));
                figure.whole_width = 480, figure.whole_height = 360;
                figure.part_x = x, figure.part_y = y;
                assert_int_equal(tc_figure_draw(part, &figure, NULL, NULL), TC_OK);
                for (int row = 0; row < height; row++)
                    memcpy(at(parts, x, y + row), at(part, 0, row), (size_t)width * 4 * sizeof(float));
                tc_image_destroy(&part);
            }
        assert_memory_equal(parts->rgba, s->image->rgba, 480 * 360 * 4 * sizeof(float));
    }
    tc_image_destroy(&before);
    tc_image_destroy(&parts);
}

static void a_wrong_part_is_drawn(void **state)
{
    static const int wrong[][4] = {
        {0, 0, 1, 0}, {480, 0, 0, 0}, {500, 400, 30, 0}, {500, 400, 0, 50}, {500, 400, -1, 0}};
    scene *s = *state;
    for (size_t i = 0; i <= sizeof wrong / sizeof *wrong; i++) {
        tc_error err = {0};
        tc_figure figure = s->figure;
        const bool automatic = i == sizeof wrong / sizeof *wrong;
        figure.ink = automatic ? TC_INK_AUTO : TC_INK_DARK;
        figure.whole_width = automatic ? 500 : wrong[i][0], figure.whole_height = automatic ? 400 : wrong[i][1];
        figure.part_x = automatic ? 0 : wrong[i][2], figure.part_y = automatic ? 0 : wrong[i][3];
        assert_int_equal(tc_figure_draw(s->image, &figure, NULL, &err), TC_E_ARG);
        assert_non_null(strstr(err.text, automatic ? "ink" : "part"));
    }
    for (size_t i = 0; i < 4 * 480 * 360; i++)
        assert_true(s->image->rgba[i] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coverage_is_the_area_within_each_pixel),
        cmocka_unit_test(a_grown_dot_is_a_disc),
        cmocka_unit_test(every_letter_has_an_outline_of_its_own),
        cmocka_unit_test(broken_text_is_drawn_as_replacement),
        cmocka_unit_test(letters_stand_on_whole_pixels),
        cmocka_unit_test_setup_teardown(an_empty_figure_changes_no_bit, set_up, tear_down),
        cmocka_unit_test_setup_teardown(pixels_change_at_items_alone, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ink_is_as_much_as_letters_have, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_bar_has_the_functions_colours_at_its_ticks, set_up, tear_down),
        cmocka_unit_test_setup_teardown(categories_are_equal_bands_with_their_names, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_opacity_strip_shows_the_board_where_it_is_transparent, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ink_follows_the_background, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_transparent_picture_stays_premultiplied, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_cannot_be_drawn_is_refused_and_changes_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_part_is_drawn_otherwise_than_the_whole, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_wrong_part_is_drawn, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
