/* png.c: PNG files, through libpng.
 * PNG specification, second edition (W3C 2003): 11.3.4 textual information, 12.8 filter selection. */
#include "image/png.h"

#include "core/memory.h"
#include "core/wire.h"
#include "image/image.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* What libpng and zlib need for twenty renders of 512 x 512 in 8 bits, RGB and RGBA, and the mean size: Sub or Up,
 * whichever leaves the smaller differences in the row, and runs alone (Z_RLE): 2.4 ms, 65 KB. Up alone and runs: 2.3
 * ms, 71 KB; Sub, Up or Paeth and runs: 2.9 ms, 60 KB. Sub or Up at level 1 of zlib: 2.6 ms, 73 KB; at level 4: 4.7 ms,
 * 57 KB. Sub alone at level 4: 4.7 ms, 67 KB. libpng's own choice of Sub or Up costs 1.1 ms more. */

struct tc_png {
    png_structp png;
    png_infop info;
    int width, channels, bits;
    size_t pixel;         /* bytes */
    uint8_t *row, *above; /* of the file: the next one, and the one before it */
    bool filtered, below; /* below: a row was written */
    tc_png_sink *sink;
    void *context;
    tc_error *err; /* of the call under way */
    bool out_of_memory, sink_failed;
    char why[200];
};

static void on_error(png_structp png, png_const_charp text)
{
    tc_png *e = png_get_error_ptr(png);
    snprintf(e->why, sizeof e->why, "%s", text);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png, (void)text; /* of what was checked before */
}

static void on_bytes(png_structp png, png_bytep bytes, size_t n)
{
    tc_png *e = png_get_io_ptr(png);
    if (!e->sink(e->context, bytes, n, e->err)) {
        e->sink_failed = true;
        png_error(png, "the file ends");
    }
}

static void on_flush(png_structp png)
{
    (void)png;
}

static float clamped(float v)
{
    v = v > 0 ? v : 0;
    return v < 1 ? v : 1;
}

static uint8_t *put_level(uint8_t *to, float v, bool wide)
{
    const int level = (int)(v * (wide ? 65535.0f : 255.0f) + 0.5f);
    if (wide)
        *to++ = (uint8_t)(level >> 8); /* the high byte first */
    *to++ = (uint8_t)level;
    return to;
}

/* One row, un-premultiplied in float and then rounded. */
static inline void quantise(uint8_t *to, const float *rgba, int width, bool opaque, bool wide)
{
    for (int x = 0; x < width; x++, rgba += 4) {
        const float alpha = opaque ? 1 : clamped(rgba[3]);
        for (int c = 0; c < 3; c++)
            to = put_level(to, alpha == 1 ? clamped(rgba[c]) : alpha > 0 ? clamped(rgba[c] / alpha) : 0, wide);
        if (!opaque)
            to = put_level(to, alpha, wide);
    }
}

/* tEXt of ASCII, iTXt (not compressed) of other UTF-8; keys as they are given, which png_set_text would not keep. What
 * of a value is not UTF-8 becomes '?', as in the other formats. */
static bool put_text(tc_png *e, const tc_text_pair *pair)
{
    json_t *text = tc_wire_string(pair->value);
    const char *value = text ? json_string_value(text) : "";
    size_t n_key = strlen(pair->key), n_value = strlen(value), n_gap = 1;
    for (size_t i = 0; i < n_value; i++)
        if ((unsigned char)value[i] >= 0x80)
            n_gap = 5; /* end of key, not compressed, method, no language, no translated key */
    size_t n = n_key + n_gap + n_value;
    uint8_t *body = text ? tc_calloc(n, 1) : NULL;
    if (body) {
        memcpy(body, pair->key, n_key);
        memcpy(body + n_key + n_gap, value, n_value);
    }
    json_decref(text);
    if (!body) {
        e->out_of_memory = true;
        return false;
    }
    free(e->row); /* held there, so that it is freed where libpng jumps */
    e->row = body;
    png_write_chunk(e->png, (png_const_bytep)(n_gap == 1 ? "tEXt" : "iTXt"), body, n);
    return true;
}

/* How much of a row is left by Sub, and by Up: bytes as signed numbers, without their signs. */
static unsigned amount(const uint8_t *row, const uint8_t *from, size_t n)
{
    unsigned sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += (unsigned)abs((int8_t)(row[i] - from[i]));
    return sum;
}

static int better_filter(const tc_png *e)
{
    const size_t n = (size_t)e->width * e->pixel;
    const unsigned up = amount(e->row, e->above, n);
    return up == 0 || up <= amount(e->row + e->pixel, e->row, n - e->pixel) ? PNG_FILTER_UP : PNG_FILTER_SUB;
}

/* Each alone, since libpng's longjmp comes back to it. */
static bool begin(tc_png *e, const tc_png_plan *plan)
{
    if (setjmp(png_jmpbuf(e->png)))
        return false;
    png_set_write_fn(e->png, e, on_bytes, on_flush);
    png_set_user_limits(e->png, TC_IMAGE_MAX_PIXELS, TC_IMAGE_MAX_PIXELS);
    png_set_compression_level(e->png, plan->level == TC_PNG_RUNS ? 1 : plan->level);
    if (plan->level == TC_PNG_RUNS)
        png_set_compression_strategy(e->png, Z_RLE);
    /* Up has to be among those of the first row, so that libpng keeps the row above. */
    png_set_filter(e->png, PNG_FILTER_TYPE_BASE, e->filtered ? PNG_FILTER_SUB | PNG_FILTER_UP : PNG_FILTER_NONE);
    png_set_IHDR(e->png, e->info, (png_uint_32)plan->width, (png_uint_32)plan->height, plan->bits,
                 plan->opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(e->png, e->info);
    for (size_t i = 0; i < plan->n; i++)
        if (!put_text(e, &plan->meta[i]))
            return false;
    free(e->row);
    e->row = tc_alloc((size_t)e->width, e->pixel);
    e->above = tc_alloc((size_t)e->width, e->pixel);
    e->out_of_memory = !e->row || !e->above;
    return !e->out_of_memory;
}

static bool put_row(tc_png *e)
{
    if (setjmp(png_jmpbuf(e->png)))
        return false;
    if (e->filtered && e->below)
        png_set_filter(e->png, PNG_FILTER_TYPE_BASE, better_filter(e));
    png_write_row(e->png, e->row);
    uint8_t *free_row = e->above;
    e->above = e->row, e->row = free_row;
    e->below = true;
    return true;
}

static bool end(tc_png *e)
{
    if (setjmp(png_jmpbuf(e->png)))
        return false;
    png_write_end(e->png, NULL);
    return true;
}

static tc_status result(const tc_png *e, bool good, tc_error *err)
{
    if (good)
        return TC_OK;
    if (e->sink_failed)
        return TC_E_FILE; /* err is filled */
    if (!e->why[0] || e->out_of_memory)
        return tc_fail_memory(err, "a PNG file", (size_t)e->width, 8);
    return tc_fail(err, TC_E_FILE, "libpng says: %s", e->why);
}

tc_status tc_png_begin(tc_png **out, const tc_png_plan *plan, tc_error *err)
{
    tc_png *e = tc_calloc(1, sizeof *e);
    *out = NULL;
    if (!e)
        return tc_fail_memory(err, "a PNG file", 1, sizeof *e);
    e->sink = plan->sink, e->context = plan->context, e->err = err;
    e->width = plan->width, e->bits = plan->bits, e->channels = plan->opaque ? 3 : 4;
    e->pixel = (size_t)e->channels * (size_t)e->bits / 8;
    e->filtered = plan->level != 0;
    e->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, e, on_error, on_warning);
    e->info = e->png ? png_create_info_struct(e->png) : NULL;
    tc_status status = result(e, e->info && begin(e, plan), err);
    if (status == TC_OK)
        *out = e;
    else
        tc_png_destroy(&e);
    return status;
}

tc_status tc_png_row(tc_png *png, const float *rgba, tc_error *err)
{
    const bool wide = png->bits == 16;
    png->err = err;
    if (png->channels == 3)
        quantise(png->row, rgba, png->width, true, wide);
    else
        quantise(png->row, rgba, png->width, false, wide);
    return result(png, put_row(png), err);
}

tc_status tc_png_again(tc_png *png, tc_error *err)
{
    png->err = err;
    memcpy(png->row, png->above, (size_t)png->width * png->pixel);
    return result(png, put_row(png), err);
}

tc_status tc_png_end(tc_png *png, tc_error *err)
{
    png->err = err;
    return result(png, end(png), err);
}

void tc_png_destroy(tc_png **png)
{
    if (!*png)
        return;
    png_destroy_write_struct(&(*png)->png, &(*png)->info);
    free((*png)->row);
    free((*png)->above);
    free(*png);
    *png = NULL;
}
