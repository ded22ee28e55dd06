/* stream.c: pictures written row by row, into a file that has no name until it is whole (core/file.h). PNG is encoded
 * here (png.c); rows of other formats go to the helper program tetcast-image, which writes them to the same file. */
#define _GNU_SOURCE
#include "image/stream.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/wire.h"
#include "image/call.h"
#include "image/encoding.h"
#include "image/image.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Bytes of PNG that are held before they are written; bytes of rows in one request; rows that TIFF and EXR compress at
 * once; rows between two lines of progress. */
enum { HELD = 1 << 18, BLOCK = 1 << 24, STRIP = 32, PROGRESS_ROWS = 256 };

struct tc_image_stream {
    char *path;
    tc_image_format format;
    int width, height, rows; /* rows: that are written */
    bool opaque, depth, failed;
    size_t glowing, open;
    tc_log log;
    tc_file_draft draft;
    bool out; /* to the standard output instead */
    tc_png *png;
    uint8_t *held; /* [HELD] */
    size_t n_held;
    tc_image_writer own, *writer;
    json_t *begin; /* the request that is to be sent before the first rows; NULL: it is sent */
    bool begun;
    int scratch; /* what the helper writes to where the file is direct; -1 */
};

/* -------------------------------------------------------------------------------------------------------- pixels */

static tc_status fail_pixel(const float *rgba, int width, int first, tc_error *err)
{
    size_t i = 0;
    while (isfinite(rgba[i]))
        i++;
    const float *p = rgba + i / 4 * 4;
    return tc_fail(err, TC_E_ARG, "pixel (%zu, %zu) holds a value that is not finite (%g %g %g %g); not written",
                   i / 4 % (size_t)width, i / 4 / (size_t)width + (size_t)first, (double)p[0], (double)p[1],
                   (double)p[2], (double)p[3]);
}

tc_status tc_image_check_rows(size_t *glowing, size_t *open, const float *rgba, int width, int rows, int first,
                              tc_error *err)
{
    for (int y = 0; y < rows; y++, rgba += 4 * (size_t)width) {
        const size_t n = 4 * (size_t)width;
        unsigned bad = 0, glow = 0, through = 0;
        for (size_t i = 0; i < n; i++) {
            uint32_t bits;
            memcpy(&bits, &rgba[i], sizeof bits);
            bad |= (bits & 0x7f800000u) == 0x7f800000u;
        }
        if (bad)
            return fail_pixel(rgba, width, first + y, err);
        for (size_t i = 0; i < n; i += 4) {
            const float *p = rgba + i;
            const float limit = p[3] + 0.5f / 255;
            const unsigned thin = p[3] < 1;
            glow += thin & (unsigned)((p[0] > limit) | (p[1] > limit) | (p[2] > limit));
            through += thin;
        }
        *glowing += glow;
        *open += through;
    }
    return TC_OK;
}

static void warn_of_losses(const tc_image_stream *s)
{
    if (s->opaque)
        return;
    if (s->format == TC_PNG && s->glowing > 0)
        tc_say(&s->log, TC_WARNING,
               "%s: %zu pixels have more light than opacity, which PNG cannot hold; use .exr or an opaque background",
               s->path, s->glowing);
    if (s->format == TC_JPEG && s->open > 0)
        tc_say(&s->log, TC_WARNING, "%s: JPEG has no transparency; %zu pixels were laid over white", s->path, s->open);
}

/* ----------------------------------------------------------------------------------------------------------- PNG */

static tc_status write_out(const tc_image_stream *s, const void *bytes, size_t n, tc_error *err)
{
    return s->out ? tc_file_write(STDOUT_FILENO, bytes, n, "the standard output", err)
                  : tc_file_write(s->draft.fd, bytes, n, s->path, err);
}

static bool hold(void *context, const void *bytes, size_t n, tc_error *err)
{
    tc_image_stream *s = context;
    const uint8_t *from = bytes;
    while (n > 0) {
        const size_t room = HELD - s->n_held, now = n < room ? n : room;
        memcpy(s->held + s->n_held, from, now);
        s->n_held += now, from += now, n -= now;
        if (s->n_held < HELD)
            break;
        s->n_held = 0;
        if (write_out(s, s->held, HELD, err) != TC_OK)
            return false;
    }
    return true;
}

/* Names the file where only libpng was heard of. */
static tc_status told(tc_status status, const tc_image_stream *s, tc_error *err)
{
    if (status != TC_OK && err && !strstr(err->text, " cannot be written: "))
        tc_fail_prefix(err, status, "%s cannot be written: ", s->path);
    return status;
}

static tc_status begin_png(tc_image_stream *s, const tc_image_encoding *how, const tc_image_stream_plan *plan,
                           tc_error *err)
{
    const tc_png_plan png = {.width = s->width,
                             .height = s->height,
                             .opaque = s->opaque,
                             .bits = how->bits,
                             .level = how->level,
                             .meta = plan->meta,
                             .n = plan->n,
                             .sink = hold,
                             .context = s};
    s->held = tc_alloc(HELD, 1);
    if (!s->held)
        return tc_fail_memory(err, s->path, HELD, 1);
    return told(tc_png_begin(&s->png, &png, err), s, err);
}

static tc_status put_png(tc_image_stream *s, const float *rgba, int rows, tc_error *err)
{
    const size_t row = 4 * (size_t)s->width;
    size_t glowing = 0, open = 0; /* of the row */
    tc_status status = TC_OK;
    for (int y = 0; y < rows && status == TC_OK; y++, rgba += row) {
        const bool again = y > 0 && memcmp(rgba, rgba - row, row * sizeof *rgba) == 0; /* background above and below */
        if (!again) {
            glowing = open = 0;
            status = tc_image_check_rows(&glowing, &open, rgba, s->width, 1, s->rows, err);
        }
        s->glowing += glowing;
        s->open += open;
        if (status == TC_OK)
            status = told(again ? tc_png_again(s->png, err) : tc_png_row(s->png, rgba, err), s, err);
        if (s->rows % PROGRESS_ROWS == 0)
            tc_progress(&s->log, "writing image", (double)s->rows / s->height);
        s->rows += status == TC_OK;
    }
    return status;
}

static tc_status end_png(tc_image_stream *s, tc_error *err)
{
    tc_status status = told(tc_png_end(s->png, err), s, err);
    if (status == TC_OK)
        status = write_out(s, s->held, s->n_held, err);
    return status;
}

/* ----------------------------------------------------------------------------------------------- the other formats */

/* The request to begin; NULL when memory is out. */
static json_t *make_begin(const tc_image_stream *s, const tc_image_encoding *how, const tc_image_stream_plan *plan)
{
    char file[64];
    json_t *pairs = json_array();
    for (size_t i = 0; pairs && i < plan->n; i++)
        if (json_array_append_new(pairs, json_pack("[s,o]", plan->meta[i].key, tc_wire_string(plan->meta[i].value))) !=
            0) {
            json_decref(pairs);
            return NULL;
        }
    tc_image_helper_path(file, s->scratch >= 0 ? s->scratch : s->draft.fd);
    return json_pack("{s:s,s:s,s:s,s:i,s:i,s:i,s:i,s:b,s:b,s:o}", "do", "begin", "file", file, "format",
                     tc_image_format_name(s->format), "width", s->width, "height", s->height, "bits", how->bits,
                     "quality", how->quality, "opaque", s->opaque, "depth", s->depth, "meta", pairs);
}

static tc_status begin_other(tc_image_stream *s, const tc_image_encoding *how, const tc_image_stream_plan *plan,
                             tc_error *err)
{
    if (s->draft.direct && (s->scratch = tc_wire_file()) < 0)
        return tc_fail(err, TC_E_FILE, "%s cannot be written: no file for what is encoded can be made", s->path);
    s->begin = make_begin(s, how, plan);
    if (!s->begin)
        return tc_fail_memory(err, "the texts of an image", plan->n, 256);
    return tc_image_helper_start(s->writer, err);
}

/* One request; says so if the disk is full. */
static tc_status ask(tc_image_stream *s, json_t *request, const tc_array *array, size_t n, tc_error *err)
{
    tc_reply reply = {0};
    tc_status status = request ? tc_image_helper_call(&reply, s->writer, request, array, n, &s->log, err)
                               : tc_fail_memory(err, "a message", 1, 256);
    tc_reply_finish(&reply);
    if (status == TC_OK)
        return TC_OK;
    tc_status full = s->scratch < 0 ? tc_file_draft_full(&s->draft, err) : TC_OK;
    return full != TC_OK ? full : told(status, s, err);
}

static tc_status ask_for(tc_image_stream *s, const char *what, const tc_array *array, size_t n, tc_error *err)
{
    json_t *request = json_pack("{s:s}", "do", what);
    tc_status status = ask(s, request, array, n, err);
    json_decref(request);
    return status;
}

static tc_status begun(tc_image_stream *s, tc_error *err)
{
    if (!s->begin)
        return TC_OK;
    tc_status status = ask(s, s->begin, NULL, 0, err);
    s->begun = status == TC_OK;
    json_decref(s->begin);
    s->begin = NULL;
    return status;
}

static tc_status put_other(tc_image_stream *s, const float *rgba, const float *depth, int rows, tc_error *err)
{
    const size_t row = 4 * (size_t)s->width, fit = BLOCK / (row * sizeof *rgba);
    const int block = fit < STRIP ? STRIP : (int)(fit / STRIP * STRIP);
    tc_status status = begun(s, err);
    for (int y = 0, n; y < rows && status == TC_OK; y += n) {
        n = block - s->rows % STRIP; /* to the end of a strip, whatever came before */
        n = n < rows - y ? n : rows - y;
        const tc_array array[2] = {
            {"rgba", TC_F32, (size_t)n * row, rgba + (size_t)y * row},
            {"depth", TC_F32, (size_t)n * (size_t)s->width, depth ? depth + (size_t)y * (size_t)s->width : NULL}};
        tc_progress(&s->log, "writing image", (double)s->rows / s->height);
        status = tc_image_check_rows(&s->glowing, &s->open, array[0].data, s->width, n, s->rows, err);
        if (status == TC_OK)
            status = ask_for(s, "rows", array, depth ? 2 : 1, err);
        s->rows += status == TC_OK ? n : 0;
    }
    return status;
}

/* What the helper wrote to a file of its own goes to where it cannot be taken back. */
static tc_status copy_scratch(const tc_image_stream *s, tc_error *err)
{
    uint8_t *buffer = tc_alloc(HELD, 1);
    tc_status status = buffer ? TC_OK : tc_fail_memory(err, s->path, HELD, 1);
    off_t at = 0;
    ssize_t n = 0;
    while (status == TC_OK && (n = pread(s->scratch, buffer, HELD, at)) > 0) {
        status = write_out(s, buffer, (size_t)n, err);
        at += n;
    }
    if (status == TC_OK && n < 0)
        status = tc_fail(err, TC_E_FILE, "%s cannot be written: what was encoded cannot be read back", s->path);
    free(buffer);
    return status;
}

static tc_status end_other(tc_image_stream *s, tc_error *err)
{
    tc_status status = ask_for(s, "end", NULL, 0, err);
    s->begun = status != TC_OK;
    return status == TC_OK && s->scratch >= 0 ? copy_scratch(s, err) : status;
}

/* ------------------------------------------------------------------------------------------------------- streams */

static void destroy(tc_image_stream *s)
{
    if (s->begun && s->writer->worker && s->writer != &s->own) { /* one that dies with us needs no word */
        tc_error ignored;
        json_t *request = json_pack("{s:s}", "do", "drop");
        tc_reply reply = {0};
        if (request)
            (void)tc_image_helper_call(&reply, s->writer, request, NULL, 0, NULL, &ignored);
        tc_reply_finish(&reply);
        json_decref(request);
    }
    tc_worker_stop(&s->own.worker);
    tc_png_destroy(&s->png);
    tc_file_draft_drop(&s->draft);
    if (s->scratch >= 0)
        close(s->scratch);
    json_decref(s->begin);
    free(s->held);
    free(s->path);
    free(s);
}

/* All that can be said before anything is begun. */
static tc_status check(tc_image_format *format, tc_image_encoding *how, const tc_image_stream_plan *plan, tc_error *err)
{
    if (!plan->path || (plan->n > 0 && !plan->meta))
        return tc_fail(err, TC_E_ARG, "an image with pixels and a path are needed for writing");
    if (plan->width < 1 || plan->height < 1 || (int64_t)plan->width * plan->height > TC_IMAGE_MAX_PIXELS)
        return tc_fail(err, TC_E_ARG, "an image of %d x %d cannot be written; 1 x 1 to %d pixels in all can",
                       plan->width, plan->height, TC_IMAGE_MAX_PIXELS);
    tc_status status = tc_image_format_of(format, plan->path, err);
    if (status == TC_OK)
        status = tc_image_encoding_fill(how, *format, plan->encoding, plan->path, err);
    if (status == TC_OK)
        status = tc_image_meta_check(plan->meta, plan->n, err);
    if (status == TC_OK && strcmp(plan->path, "-") == 0 && isatty(STDOUT_FILENO))
        status = tc_fail(err, TC_E_ARG, "the image is not written to a terminal; redirect the standard output");
    return status;
}

tc_status tc_image_stream_begin(tc_image_stream **out, tc_image_writer *writer, const tc_image_stream_plan *plan,
                                tc_error *err)
{
    tc_image_format format;
    tc_image_encoding how;
    *out = NULL;
    tc_status status = check(&format, &how, plan, err);
    if (status != TC_OK)
        return status;
    tc_image_stream *s = tc_calloc(1, sizeof *s);
    char *path = tc_strdup(plan->path);
    if (!s || !path) {
        free(s);
        free(path);
        return tc_fail_memory(err, plan->path, 1, sizeof *s);
    }
    *s = (tc_image_stream){.path = path,
                           .format = format,
                           .width = plan->width,
                           .height = plan->height,
                           .opaque = plan->opaque,
                           .depth = how.depth,
                           .out = strcmp(path, "-") == 0,
                           .draft = {.fd = -1},
                           .scratch = -1};
    s->log = plan->log ? *plan->log : s->log;
    s->writer = writer ? writer : &s->own;
    if (!s->out)
        status = tc_file_draft_open(&s->draft, path, err);
    if (status == TC_OK)
        status = format == TC_PNG ? begin_png(s, &how, plan, err) : begin_other(s, &how, plan, err);
    if (status == TC_OK)
        *out = s;
    else
        destroy(s);
    return status;
}

tc_status tc_image_stream_put(tc_image_stream *stream, const float *rgba, const float *depth, int rows, tc_error *err)
{
    tc_image_stream *s = stream;
    if (s->failed)
        return tc_fail(err, TC_E_ARG, "%s takes no more rows after an error", s->path);
    if (!rgba || rows < 1 || rows > s->height - s->rows || s->depth != (depth != NULL))
        return tc_fail(err, TC_E_ARG, "%s has %d rows left to be written, and %d were given", s->path,
                       s->height - s->rows, rows);
    tc_status status = s->format == TC_PNG ? put_png(s, rgba, rows, err) : put_other(s, rgba, depth, rows, err);
    s->failed = status != TC_OK;
    return status;
}

bool tc_image_stream_is_direct(const tc_image_stream *stream)
{
    return stream->out || stream->draft.direct;
}

tc_status tc_image_stream_open(tc_image_stream **out, const char *path, int width, int height, bool opaque,
                               const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n, const tc_log *log,
                               tc_error *err)
{
    if (!out)
        return tc_fail(err, TC_E_ARG, "tc_image_stream_open: out is NULL");
    *out = NULL;
    if (encoding && encoding->depth)
        return tc_fail(err, TC_E_ARG, "an image that is written in rows cannot hold depth");
    const tc_image_stream_plan plan = {path, width, height, opaque, encoding, meta, n, log};
    return tc_image_stream_begin(out, NULL, &plan, err);
}

tc_status tc_image_stream_rows(tc_image_stream *stream, const float *rgba, int rows, tc_error *err)
{
    if (!stream)
        return tc_fail(err, TC_E_ARG, "tc_image_stream_rows: stream is NULL");
    return tc_image_stream_put(stream, rgba, NULL, rows, err);
}

tc_status tc_image_stream_close(tc_image_stream **stream, bool keep, tc_error *err)
{
    tc_image_stream *s = stream ? *stream : NULL;
    tc_status status = TC_OK;
    if (!s)
        return keep ? tc_fail(err, TC_E_ARG, "tc_image_stream_close: there is no stream") : TC_OK;
    if (keep && s->failed)
        status = tc_fail(err, TC_E_FILE, "%s was not written, since rows of it failed", s->path);
    else if (keep && s->rows < s->height)
        status = tc_fail(err, TC_E_ARG, "%s was not written: only %d of its %d rows were given", s->path, s->rows,
                         s->height);
    else if (keep)
        status = s->format == TC_PNG ? end_png(s, err) : end_other(s, err);
    if (keep && status == TC_OK && !s->out)
        status = tc_file_draft_keep(&s->draft, err);
    if (keep && status == TC_OK)
        warn_of_losses(s);
    destroy(s);
    *stream = NULL;
    return status;
}
