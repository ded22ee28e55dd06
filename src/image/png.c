/* png.c: PNG files, through libpng.
 * PNG specification, second edition (W3C 2003): 11.3.4 textual information, 12.8 filter selection. */
#include "image/png.h"

#include "core/memory.h"
#include "core/wire.h"
#include "image/image.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* zlib's level, with the filter Sub alone: of Blunt Fin in 512 x 512 that is 50 KB in 6.6 ms; level 1 68 KB in 4.9,
 * level 6 45 KB in 10.7, all filters at level 6 43 KB in 15.5. */
enum { LEVEL = 4, PROGRESS_ROWS = 256, MIN_ROOM = 1 << 16 };

/* What a file under way needs, and what goes wrong with it. */
typedef struct encoder {
    tc_png *out;
    size_t room; /* bytes that out->bytes has room for */
    uint8_t *row;
    bool out_of_memory;
    char why[200];
} encoder;

static void on_error(png_structp png, png_const_charp text)
{
    encoder *e = png_get_error_ptr(png);
    snprintf(e->why, sizeof e->why, "%s", text);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png, (void)text; /* of what was checked before */
}

static void on_bytes(png_structp png, png_bytep bytes, size_t n)
{
    encoder *e = png_get_io_ptr(png);
    tc_png *out = e->out;
    if (n > e->room - out->n) {
        size_t room = e->room > SIZE_MAX / 2 ? SIZE_MAX : 2 * e->room;
        room = room < MIN_ROOM ? MIN_ROOM : room;
        room = room - out->n < n ? out->n + n : room;
        uint8_t *more = room >= n ? tc_realloc(out->bytes, room, 1) : NULL;
        if (!more) {
            e->out_of_memory = true;
            png_error(png, "out of memory");
        }
        out->bytes = more;
        e->room = room;
    }
    memcpy(out->bytes + out->n, bytes, n);
    out->n += n;
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

/* One row, un-premultiplied in float and then rounded; 16 bits with the high byte first. */
static void quantise(uint8_t *to, const float *rgba, int width, int channels, int bits)
{
    const float top = bits == 16 ? 65535 : 255;
    for (int x = 0; x < width; x++, rgba += 4) {
        float alpha = clamped(rgba[3]);
        for (int c = 0; c < channels; c++) {
            float v = c == 3 ? alpha : alpha > 0 ? clamped(rgba[c] / alpha) : 0;
            unsigned level = (unsigned)(v * top + 0.5f);
            if (bits == 16)
                *to++ = (uint8_t)(level >> 8);
            *to++ = (uint8_t)level;
        }
    }
}

static bool opaque(const tc_image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        if (image->rgba[4 * i + 3] < 1)
            return false;
    return true;
}

/* tEXt of ASCII, iTXt (not compressed) of other UTF-8; keys as they are given, which png_set_text would not keep. What
 * of a value is not UTF-8 becomes '?', as in the other formats. */
static tc_status put_text(png_structp png, encoder *e, const tc_text_pair *pair)
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
        return TC_E_MEMORY;
    }
    free(e->row); /* held there, so that it is freed where libpng jumps */
    e->row = body;
    png_write_chunk(png, (png_const_bytep)(n_gap == 1 ? "tEXt" : "iTXt"), body, n);
    return TC_OK;
}

/* The whole file; false when libpng or memory gave up. Alone, since libpng's longjmp comes back to it. */
static bool encode(png_structp png, png_infop info, encoder *e, const tc_image *image, int bits,
                   const tc_text_pair *meta, size_t n, const tc_log *log)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    const int channels = opaque(image) ? 3 : 4;
    png_set_write_fn(png, e, on_bytes, on_flush);
    png_set_user_limits(png, TC_IMAGE_MAX_PIXELS, TC_IMAGE_MAX_PIXELS);
    png_set_compression_level(png, LEVEL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, bits,
                 channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (size_t i = 0; i < n; i++)
        if (put_text(png, e, &meta[i]) != TC_OK)
            return false;
    free(e->row);
    e->row = tc_alloc((size_t)image->width, (size_t)channels * (size_t)bits / 8);
    if (!e->row) {
        e->out_of_memory = true;
        return false;
    }
    for (int y = 0; y < image->height; y++) {
        quantise(e->row, image->rgba + 4 * (size_t)image->width * (size_t)y, image->width, channels, bits);
        png_write_row(png, e->row);
        if (y % PROGRESS_ROWS == 0)
            tc_progress(log, "writing image", (double)y / image->height);
    }
    png_write_end(png, NULL);
    return true;
}

tc_status tc_png_encode(tc_png *out, const tc_image *image, int bits, const tc_text_pair *meta, size_t n,
                        const tc_log *log, tc_error *err)
{
    encoder e = {.out = out};
    *out = (tc_png){0};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &e, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool good = info && encode(png, info, &e, image, bits, meta, n, log);
    png_destroy_write_struct(&png, &info);
    free(e.row);
    if (good)
        return TC_OK;
    tc_png_finish(out);
    if (!e.why[0] || e.out_of_memory)
        return tc_fail_memory(err, "a PNG file", (size_t)image->width * (size_t)image->height, 4);
    return tc_fail(err, TC_E_FILE, "libpng says: %s", e.why);
}

void tc_png_finish(tc_png *file)
{
    free(file->bytes);
    *file = (tc_png){0};
}
