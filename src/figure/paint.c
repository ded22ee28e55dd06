/* paint.c: puts items over the picture. Lines and letters get a soft edge of the opposite ink first, as far as what is
 * behind them is opaque and lacks contrast: on an even background, or a transparent one, there is none.
 * Places are those of the whole picture, of which the image may be a part: a pixel gets the same bits in every part. */
#include "figure/paint.h"

#include "core/memory.h"
#include "figure/font.h"
#include "transfer_functions/transfer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct painter {
    tc_image *image;
    const tc_layout *layout;
    int x0, y0, x1, y1; /* the image's place in the picture */
    bool light;
} painter;

/* A pixel of the picture that lies in the image. */
static float *pixel_at(const painter *p, int x, int y)
{
    return p->image->rgba + 4 * ((size_t)(y - p->y0) * (size_t)p->image->width + (size_t)(x - p->x0));
}

static int lower(int a, int b)
{
    return a < b ? a : b;
}

static int upper(int a, int b)
{
    return a > b ? a : b;
}

static void put(float *p, const float color[3], float a)
{
    if (!(a > 0))
        return;
    for (int c = 0; c < 3; c++)
        p[c] = (a < 1 ? p[c] * (1 - a) : 0) + color[c] * a;
    p[3] = (a < 1 ? p[3] * (1 - a) : 0) + a;
}

/* How much of a soft edge a pixel needs. */
static float lack(const float *p, float ink)
{
    float gray = (0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2]) / fmaxf(p[3], 1e-6f);
    float contrast = fabsf(gray - ink), need = (0.65f - contrast) / 0.35f;
    return 0.8f * fminf(fmaxf(need, 0), 1) * fminf(fmaxf(p[3], 0), 1);
}

static void color_of(float out[3], const painter *p, int hue)
{
    static const float dark[][3] = {{0, 0, 0}, {0.8f, 0.1f, 0.1f}, {0.05f, 0.5f, 0.05f}, {0.1f, 0.25f, 0.9f}};
    static const float light[][3] = {{1, 1, 1}, {1, 0.42f, 0.38f}, {0.45f, 0.9f, 0.4f}, {0.5f, 0.68f, 1}};
    memcpy(out, p->light ? light[hue] : dark[hue], 3 * sizeof *out);
}

/* The ink of one pixel, or its soft edge. */
static void paint_pixel(const painter *p, int x, int y, const float color[3], float a, bool edge)
{
    float *pixel = pixel_at(p, x, y);
    if (a > 0)
        put(pixel, color, edge ? a * lack(pixel, p->light ? 1 : 0) : a);
}

/* A line with flat ends: its pixels by their distance from it. One along rows or columns is moved to whole pixels. */
static void paint_line(const painter *p, const tc_item *item, const float color[3], bool edge)
{
    double x0 = item->box.x0, y0 = item->box.y0, x1 = item->box.x1, y1 = item->box.y1, h = 0.5 * item->width;
    if (fabs(x1 - x0) < 0.5 && fabs(y1 - y0) > 1)
        x0 = x1 = round(0.5 * (x0 + x1) - h) + h;
    else if (fabs(y1 - y0) < 0.5 && fabs(x1 - x0) > 1)
        y0 = y1 = round(0.5 * (y0 + y1) - h) + h;
    double length = hypot(x1 - x0, y1 - y0), soft = edge ? fmax(1.2, 0.8 * item->width) : 0, far = h + soft + 1;
    if (!(length > 0))
        return;
    double ux = (x1 - x0) / length, uy = (y1 - y0) / length;
    int top = (int)fmax(floor(fmin(y0, y1) - far), p->y0), bottom = (int)fmin(ceil(fmax(y0, y1) + far), p->y1);
    for (int y = top; y < bottom; y++) {
        /* the part of the row that may be near */
        double left = fmin(x0, x1) - far, right = fmax(x0, x1) + far;
        if (fabs(uy) > 1e-3) {
            double at = x0 + (y + 0.5 - y0) * ux / uy, reach = far * (1 + fabs(ux)) / fabs(uy) + 1;
            left = fmax(left, at - reach), right = fmin(right, at + reach);
        }
        for (int x = (int)fmax(floor(left), p->x0); x < right && x < p->x1; x++) {
            double dx = x + 0.5 - x0, dy = y + 0.5 - y0, along = dx * ux + dy * uy;
            double beside = h + soft + 0.5 - fabs(dx * uy - dy * ux);
            double before = fmin(along, length - along) + soft + 0.5;
            paint_pixel(p, x, y, color, (float)(fmin(fmax(beside, 0), 1) * fmin(fmax(before, 0), 1)), edge);
        }
    }
}

/* Does any pixel there, of the image, need a soft edge? */
static bool is_lacking(const painter *p, int left, int top, int right, int bottom)
{
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++)
            if (lack(pixel_at(p, x, y), p->light ? 1 : 0) > 0)
                return true;
    return false;
}

static bool paint_text(const painter *p, const tc_item *item, const float color[3], bool edge)
{
    double radius = fmax(1.2, item->em / 11), far = 2 + (edge ? radius : 0);
    int left = (int)fmax(floor(item->box.x0 - far), 0), top = (int)fmax(floor(item->box.y0 - far), 0);
    int width = (int)fmin(ceil(item->box.x1 + far), p->layout->width) - left;
    int height = (int)fmin(ceil(item->box.y1 + far), p->layout->height) - top;
    const int x0 = upper(left, p->x0), y0 = upper(top, p->y0);
    const int x1 = lower(left + width, p->x1), y1 = lower(top + height, p->y1);
    if (x0 >= x1 || y0 >= y1 || (edge && !is_lacking(p, x0, y0, x1, y1)))
        return true;
    size_t pixels = (size_t)width * (size_t)height;
    tc_path path = {0};
    float *coverage = tc_alloc(pixels, sizeof *coverage), *wide = edge ? tc_alloc(pixels, sizeof *wide) : NULL;
    bool fine = coverage && (wide || !edge) &&
                tc_font_add(&path, item->text, item->em, item->x, item->y, item->turned) &&
                tc_path_fill(coverage, left, top, width, height, &path);
    if (fine && edge)
        tc_fill_grow(wide, coverage, width, height, radius);
    for (int y = y0; fine && y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t at = (size_t)(y - top) * (size_t)width + (size_t)(x - left);
            paint_pixel(p, x, y, color, (edge ? wide : coverage)[at], edge);
        }
    free(path.edge);
    free(coverage);
    free(wide);
    return fine;
}

/* One item's soft edge, or the item. */
static bool paint_shape(const painter *p, const tc_item *item, bool edge)
{
    float color[3];
    color_of(color, p, item->hue);
    for (int c = 0; c < 3 && edge; c++)
        color[c] = p->light ? 0 : 1;
    if (item->kind == TC_ITEM_TEXT)
        return paint_text(p, item, color, edge);
    paint_line(p, item, color, edge);
    return true;
}

static void paint_strip(const painter *p, const tc_item *item)
{
    const tc_figure *f = p->layout->figure;
    double range[2];
    tc_layout_range(range, f);
    int x0 = (int)item->box.x0, x1 = (int)item->box.x1, y0 = (int)item->box.y0, y1 = (int)item->box.y1;
    int length = item->lying ? x1 - x0 : y1 - y0, thick = item->lying ? y1 - y0 : x1 - x0;
    int square = thick / 3 > 0 ? thick / 3 : 1;
    for (int i = 0; i < length; i++) {
        double u = (i + 0.5) / length, v[4];
        double s = f->log ? exp((1 - u) * log(range[0]) + u * log(range[1])) : (1 - u) * range[0] + u * range[1];
        if (f->n_category > 0)
            s = f->category[(size_t)(u * (double)f->n_category)];
        tc_transfer_evaluate(v, f->function, s);
        float a = item->opacity ? (float)fmin(fmax(v[3], 0), 1) : 1;
        for (int j = 0; j < thick; j++) {
            int x = item->lying ? x0 + i : x0 + j, y = item->lying ? y0 + j : y1 - 1 - i;
            if (x < p->x0 || y < p->y0 || x >= p->x1 || y >= p->y1)
                continue;
            float *pixel = pixel_at(p, x, y);
            float board = (i / square + j / square) % 2 ? 0.62f : 0.92f;
            for (int c = 0; c < 3; c++)
                pixel[c] = a * (float)v[c] + (1 - a) * board;
            pixel[3] = 1;
        }
    }
}

/* Items from … to: soft edges first, so that none lies over another item, then strips, then ink. */
static bool paint_items(const painter *p, int from, int to)
{
    for (int pass = 0; pass < 3; pass++)
        for (int i = from; i < to; i++) {
            const tc_item *item = &p->layout->item[i];
            bool is_strip = item->kind == TC_ITEM_STRIP;
            if (is_strip && pass == 1)
                paint_strip(p, item);
            if (!is_strip && pass != 1 && !paint_shape(p, item, pass == 0))
                return false;
        }
    return true;
}

tc_status tc_figure_paint(tc_image *image, const tc_layout *layout, bool light, tc_error *err)
{
    const tc_figure *f = layout->figure;
    const painter p = {.image = image,
                       .layout = layout,
                       .x0 = f->part_x,
                       .y0 = f->part_y,
                       .x1 = f->part_x + image->width,
                       .y1 = f->part_y + image->height,
                       .light = light};
    if (!paint_items(&p, layout->n_front, layout->n) || !paint_items(&p, 0, layout->n_front))
        return tc_fail(err, TC_E_MEMORY, "out of memory while a figure of %d x %d pixels was drawn", image->width,
                       image->height);
    return TC_OK;
}
