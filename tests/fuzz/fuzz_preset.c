/* fuzz_preset.c: colour maps (JSON and XML) and opacity lists from any bytes.
 * Input: a byte of flags, two numbers of the range, then text. Promises: a map without a problem has finite, ordered
 * points; its knots are finite and ordered; written and read again it is the same map. */
#define _GNU_SOURCE
#include "fuzz.h"

#include "transfer_functions/preset.h"
#include "transfer_functions/resolve.h"
#include "transfer_functions/transfer.h"

#include <math.h>
#include <unistd.h>

enum { AS_OPACITY = 1, AS_NAME = 2, LOG = 4, RANGE = 8, WRITE = 16, KIND = 32 };

static void check_preset(const tc_preset *p)
{
    TC_FUZZ_CHECK(p->name && p->n_color > 0);
    for (size_t i = 0; i < p->n_color; i++) {
        TC_FUZZ_CHECK(isfinite(p->color[i].x) && (i == 0 || p->color[i].x >= p->color[i - 1].x));
        for (int c = 0; c < 3; c++)
            TC_FUZZ_CHECK(p->color[i].rgb[c] >= 0 && p->color[i].rgb[c] <= 1);
    }
    for (size_t i = 0; i < p->n_opacity; i++) {
        const tc_opacity_point *o = &p->opacity[i];
        TC_FUZZ_CHECK(isfinite(o->x) && (i == 0 || o->x >= p->opacity[i - 1].x));
        TC_FUZZ_CHECK(o->a >= 0 && isfinite(o->a) && o->midpoint >= 0 && o->midpoint <= 1 && o->sharpness >= 0 &&
                      o->sharpness <= 1);
    }
    for (int c = 0; p->has_nan_color && c < 3; c++)
        TC_FUZZ_CHECK(p->nan_color[c] >= 0 && p->nan_color[c] <= 1);
}

static void check_transfer(const tc_transfer *tf)
{
    size_t n;
    const tc_knot *k = tc_transfer_knots(tf, &n);
    TC_FUZZ_CHECK(n > 0 && tc_transfer_name(tf));
    for (size_t i = 0; i < n; i++) {
        TC_FUZZ_CHECK(isfinite(k[i].s) && (i == 0 || k[i].s >= k[i - 1].s));
        TC_FUZZ_CHECK(k[i].r >= 0 && k[i].r <= 1 && k[i].g >= 0 && k[i].g <= 1 && k[i].b >= 0 && k[i].b <= 1);
        TC_FUZZ_CHECK(k[i].a >= 0 && isfinite(k[i].a));
    }
    double span[2], value[4];
    tc_transfer_span(span, tf);
    TC_FUZZ_CHECK(span[0] < span[1]);
    for (int i = -1; i <= 5; i++) {
        tc_transfer_evaluate(value, tf, span[0] * (1 - i / 4.0) + span[1] * (i / 4.0));
        for (int c = 0; c < 4; c++)
            TC_FUZZ_CHECK(value[c] >= 0 && isfinite(value[c]));
    }
}

static void write_again(const tc_preset *preset, int xml)
{
    char path[64];
    tc_error err = {0};
    tc_preset_list list;
    /* in memory where there is such a folder: writing waits for the disk */
    snprintf(path, sizeof path, "%s/tetcast-fuzz-%d.%s", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp",
             (int)getpid(), xml ? "xml" : "json");
    tc_status status = tc_preset_write(preset, path, &err);
    TC_FUZZ_CHECK(status == TC_OK);
    status = tc_preset_read(&list, path, &err);
    unlink(path);
    TC_FUZZ_CHECK(status == TC_OK && list.n == 1 && !list.preset[0]->problem);
    check_preset(list.preset[0]);
    if (!xml) {
        TC_FUZZ_CHECK(list.preset[0]->n_color == preset->n_color && list.preset[0]->n_opacity == preset->n_opacity);
        for (size_t i = 0; i < preset->n_color; i++)
            TC_FUZZ_CHECK(list.preset[0]->color[i].x == preset->color[i].x);
    }
    tc_preset_list_finish(&list);
}

static void resolve(const tc_preset *p, int flags, const double range[2])
{
    tc_knot *knot = NULL;
    size_t n = 0;
    tc_error err = {0};
    tc_transfer *tf = NULL;
    static const tc_opacity_point line[2] = {{0, 0, 0.5, 0}, {1, 0.3, 0.5, 0}};
    tc_resolve_input input = {.map = p,
                              .kind = p->n_opacity == 0 && flags & KIND ? TC_OPACITY_GEOM : TC_OPACITY_POINTS,
                              .n_opacity = p->n_opacity ? p->n_opacity : 2,
                              .opacity = p->n_opacity ? p->opacity : line,
                              .range = {range[0], range[1]},
                              .log = flags & LOG && range[0] > 0};
    if (p->n_opacity && flags & KIND)
        input.kind = TC_OPACITY_SCALARS;
    if (tc_resolve(&knot, &n, &input, &err) == TC_OK && tc_transfer_from_knots(&tf, knot, n, &err) == TC_OK)
        check_transfer(tf);
    else
        TC_FUZZ_CHECK(err.text[0]);
    tc_transfer_destroy(&tf);
    free(knot);
}

static void from_text(const char *text, int flags, const double range[2])
{
    tc_error err = {0};
    tc_transfer *tf = NULL;
    tc_transfer_options options = {.has_range = flags & RANGE, .log = flags & LOG};
    if (access(text, F_OK) == 0 || strchr(text, '/')) /* a file of this machine */
        return;
    if (flags & AS_NAME)
        options.color_map = text;
    else
        options.opacity = text;
    memcpy(options.range, range, sizeof options.range);
    memcpy(options.data_range, range, sizeof options.data_range);
    if (tc_transfer_create(&tf, &options, &err) == TC_OK)
        check_transfer(tf);
    else
        TC_FUZZ_CHECK(!tf && err.code != TC_OK && err.text[0] && !strchr(err.text, '\n'));
    tc_transfer_destroy(&tf);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tc_fuzz_input in = {data, size};
    int flags = tc_fuzz_u8(&in);
    double range[2] = {tc_fuzz_real(&in), tc_fuzz_real(&in)};
    tc_error err = {0};
    tc_preset_list list;
    if (flags & (AS_OPACITY | AS_NAME)) {
        char *text = tc_fuzz_text(&in, 0);
        from_text(text, flags, range);
        free(text);
        return 0;
    }
    if (!(isfinite(range[0]) && isfinite(range[1]) && range[0] < range[1]))
        range[0] = 1, range[1] = 3;
    uint8_t *copy = malloc(in.n ? in.n : 1); /* exactly as long, so that reading past the end is seen */
    if (!copy)
        abort();
    if (in.n)
        memcpy(copy, in.data, in.n);
    tc_status status = tc_preset_parse(&list, (const char *)copy, in.n, "input", &err);
    free(copy);
    if (status != TC_OK) {
        TC_FUZZ_CHECK(list.n == 0 && strstr(err.text, "input") && !strchr(err.text, '\n'));
        return 0;
    }
    TC_FUZZ_CHECK(list.n > 0);
    for (size_t i = 0; i < list.n; i++) {
        const tc_preset *chosen;
        if (tc_preset_choose(&chosen, &list, list.preset[i]->name, "input", &err) != TC_OK)
            TC_FUZZ_CHECK(err.text[0]);
        if (list.preset[i]->problem)
            continue;
        check_preset(list.preset[i]);
        if (i < 4)
            resolve(list.preset[i], flags, range);
        if (i == 0 && flags & WRITE)
            write_again(list.preset[i], flags & LOG);
    }
    tc_preset_list_finish(&list);
    return 0;
}
