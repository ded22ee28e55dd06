/* step_names.c: --step FROM:TO[:STRIDE], and the name of each step's picture. */
#include "cli/picture/step_names.h"
#include "cli/options.h"

#include <math.h>
#include <stdio.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Digits that a width or a precision may have, and the most of both. */
enum { TC_DIGITS = 2, TC_WIDTH_MOST = 40, TC_PRECISION_MOST = 17 };

/* One number between colons; "" where `has` says that there is none. */
static bool tc_part_parse(int *out, bool *has, const char *text, size_t length)
{
    char part[16];
    *has = length > 0;
    if (length == 0)
        return true;
    if (length >= sizeof part)
        return false;
    memcpy(part, text, length);
    part[length] = 0;
    return part[0] != ' ' && part[0] != '+' && tc_parse_int(out, part);
}

bool tc_step_range_parse(tc_step_range *out, const char *text, char *why)
{
    tc_step_range range = {.there = true, .stride = 1};
    const char *first = strchr(text, ':'), *second = first ? strchr(first + 1, ':') : NULL;
    const char *end = text + strlen(text);
    bool has_stride;
    if (!first || !tc_part_parse(&range.from, &range.has_from, text, (size_t)(first - text)) ||
        !tc_part_parse(&range.to, &range.has_to, first + 1, (size_t)((second ? second : end) - first - 1)))
        return false;
    if (second && (!tc_part_parse(&range.stride, &has_stride, second + 1, (size_t)(end - second - 1)) || !has_stride))
        return false;
    if (range.stride < 1) {
        snprintf(why, 64, "a stride of 1 or more");
        return false;
    }
    *out = range;
    return true;
}

size_t tc_step_range_list(int *step, size_t capacity, const tc_step_range *range, size_t n_time, char *why,
                          size_t capacity_why)
{
    const long long n = n_time > 0 ? (long long)n_time : 1;
    long long end[2] = {range->has_from ? range->from : 0, range->has_to ? range->to : n - 1};
    for (int k = 0; k < 2; k++) {
        const long long asked = end[k];
        if (end[k] < 0)
            end[k] += n;
        if (end[k] >= 0 && end[k] < n)
            continue;
        if (n_time == 0)
            snprintf(why, capacity_why, "has no time steps, so there is no step %lld", asked);
        else
            snprintf(why, capacity_why, "has %lld time steps (0 to %lld), so there is no step %lld", n, n - 1, asked);
        return 0;
    }
    if (end[0] > end[1]) {
        snprintf(why, capacity_why, "has no steps from %lld to %lld: the first lies behind the last", end[0], end[1]);
        return 0;
    }
    size_t count = (size_t)((end[1] - end[0]) / range->stride) + 1;
    for (size_t i = 0; i < count && i < capacity; i++)
        step[i] = (int)(end[0] + (long long)i * range->stride);
    return count;
}

/* A name in the making; too long where length reaches capacity. */
typedef struct tc_text {
    char *at;
    size_t capacity, length;
} tc_text;

static void tc_put(tc_text *text, const char *piece, size_t length)
{
    for (size_t i = 0; i < length; i++, text->length++)
        if (text->length + 1 < text->capacity)
            text->at[text->length] = piece[i];
}

static size_t tc_digits(int *out, const char *text, int most)
{
    size_t n = strspn(text, "0123456789");
    *out = n > 0 && n <= TC_DIGITS ? atoi(text) : -1;
    return n <= TC_DIGITS && *out <= most ? n : SIZE_MAX;
}

bool tc_number_format_parse(tc_number_format *out, const char **end, const char *text, bool whole)
{
    *out = (tc_number_format){.precision = -1, .kind = whole ? 'd' : 'g'};
    if (*text == ':') {
        text++;
        out->zero = *text == '0';
        text += out->zero;
        size_t n = tc_digits(&out->width, text, TC_WIDTH_MOST);
        if (n == SIZE_MAX)
            return false;
        text += n;
        if (*text == '.' && !whole) {
            n = tc_digits(&out->precision, text + 1, TC_PRECISION_MOST);
            if (n == 0 || n == SIZE_MAX)
                return false;
            text += 1 + n;
        }
        if (*text == 'd' || (!whole && *text && strchr("efg", *text)))
            out->kind = *text++;
    }
    if (*text != '}' || (out->kind == 'd' && out->precision >= 0))
        return false;
    *end = text + 1;
    if (out->width < 0)
        out->width = 0;
    if (out->precision < 0)
        out->precision = out->kind == 'g' ? 9 : 6;
    return true;
}

int tc_number_format_write(char *out, size_t capacity, const tc_number_format *f, double value)
{
    const int w = f->width, p = f->precision;
    switch (f->kind) {
    case 'd':
        value = round(value) + 0.0; /* -0 becomes 0 */
        return f->zero ? snprintf(out, capacity, "%0*.0f", w, value) : snprintf(out, capacity, "%*.0f", w, value);
    case 'e':
        return f->zero ? snprintf(out, capacity, "%0*.*e", w, p, value) : snprintf(out, capacity, "%*.*e", w, p, value);
    case 'f':
        return f->zero ? snprintf(out, capacity, "%0*.*f", w, p, value) : snprintf(out, capacity, "%*.*f", w, p, value);
    default:
        return f->zero ? snprintf(out, capacity, "%0*.*g", w, p, value) : snprintf(out, capacity, "%*.*g", w, p, value);
    }
}

enum { TC_PLACEHOLDERS = 2 };
static const struct {
    const char *name;
    bool whole;
} tc_placeholder[TC_PLACEHOLDERS] = {{"{step", true}, {"{time", false}};

/* {step…} or {time…} at text. False where it is neither. */
static bool tc_field_put(tc_text *name, const char **text, int step, double time)
{
    for (size_t i = 0; i < TC_PLACEHOLDERS; i++) {
        size_t length = strlen(tc_placeholder[i].name);
        char number[400];
        tc_number_format format;
        if (strncmp(*text, tc_placeholder[i].name, length) != 0)
            continue;
        if (!tc_number_format_parse(&format, text, *text + length, tc_placeholder[i].whole))
            return false;
        int n = tc_number_format_write(number, sizeof number, &format, tc_placeholder[i].whole ? step : time);
        tc_put(name, number, n > 0 && (size_t)n < sizeof number ? (size_t)n : 0);
        return true;
    }
    return false;
}

/* Where the extension of a name begins; its end when it has none. */
static size_t tc_extension_at(const char *name)
{
    const char *dot = strrchr(name, '.'), *slash = strrchr(name, '/');
    return dot && (!slash || dot > slash) ? (size_t)(dot - name) : strlen(name);
}

bool tc_step_name(char *out, size_t capacity, const char *pattern, int step, double time, char *why,
                  size_t capacity_why)
{
    tc_text name = {out, capacity, 0};
    bool told = false;
    for (const char *at = pattern; *at;) {
        if ((at[0] == '{' || at[0] == '}') && at[1] == at[0]) {
            tc_put(&name, at, 1);
            at += 2;
        } else if (!strncmp(at, "{eye}", 5)) { /* stereo_options.h */
            tc_put(&name, at, 5);
            at += 5;
        } else if (*at == '{') {
            const char *from = at;
            if (!tc_field_put(&name, &at, step, time)) {
                snprintf(why, capacity_why,
                         "%.*s is no part of a name; there are {step}, {step:04d}, {time}, {time:06d}, {time:.3f}, and "
                         "{{ for a brace",
                         (int)(strcspn(from, "}") + (strchr(from, '}') != NULL)), from);
                return false;
            }
            told = true;
        } else if (*at == '}') {
            snprintf(why, capacity_why, "a } stands alone; }} is a brace");
            return false;
        } else {
            tc_put(&name, at++, 1);
        }
    }
    if (name.length < capacity)
        out[name.length] = 0;
    if (!told && name.length < capacity) {
        char number[32];
        size_t dot = tc_extension_at(out), n = (size_t)snprintf(number, sizeof number, "_%04d", step);
        if (name.length + n < capacity) {
            memmove(out + dot + n, out + dot, name.length - dot + 1);
            memcpy(out + dot, number, n);
        }
        name.length += n;
    }
    if (name.length < capacity)
        return true;
    snprintf(why, capacity_why, "a name of it has more than %zu characters", capacity - 1);
    return false;
}

bool tc_step_is_in_name(const char *pattern)
{
    for (const char *at = pattern; (at = strchr(at, '{')); at += at[1] == '{' ? 2 : 1)
        for (size_t i = 0; i < TC_PLACEHOLDERS; i++)
            if (!strncmp(at, tc_placeholder[i].name, strlen(tc_placeholder[i].name)))
                return true;
    return false;
}
