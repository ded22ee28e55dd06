/* names.c: a picture's name from a template with placeholders. */
#include "cli/batch/names.h"
#include "cli/nearest.h"
#include "cli/picture/step_names.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TC_WIDTH_MOST = 40, TC_DIGITS_SHORTEST = 17 };

typedef enum tc_kind { TC_KIND_REAL, TC_KIND_INT, TC_KIND_LONG, TC_KIND_TEXT } tc_kind;

static const struct {
    const char *name;
    unsigned bit;
    tc_kind kind;
    size_t at;           /* in tc_name_values */
    const char *missing; /* why there may be none */
} tc_placeholder[] = {
    {"time", TC_NAME_TIME, TC_KIND_REAL, offsetof(tc_name_values, time), "the data have no times; use {step}"},
    {"step", TC_NAME_STEP, TC_KIND_INT, offsetof(tc_name_values, step), ""},
    {"frame", TC_NAME_FRAME, TC_KIND_LONG, offsetof(tc_name_values, frame), ""},
    {"phi", TC_NAME_PHI, TC_KIND_REAL, offsetof(tc_name_values, phi),
     "only an orbit or a grid of views has angles; use {view}"},
    {"theta", TC_NAME_THETA, TC_KIND_REAL, offsetof(tc_name_values, theta),
     "only an orbit or a grid of views has angles; use {view}"},
    {"view", TC_NAME_VIEW, TC_KIND_TEXT, offsetof(tc_name_values, view), "there is one view; leave it out"},
    {"tf", TC_NAME_TF, TC_KIND_TEXT, offsetof(tc_name_values, tf), "there is one transfer function; leave it out"},
    {"field", TC_NAME_FIELD, TC_KIND_TEXT, offsetof(tc_name_values, field), "the field has no name; leave it out"},
    {"eye", TC_NAME_EYE, TC_KIND_TEXT, offsetof(tc_name_values, eye), "the picture is of no stereo pair; leave it out"},
    {"kind", TC_NAME_KIND, TC_KIND_TEXT, offsetof(tc_name_values, kind), "there is one kind of picture; leave it out"},
};
enum { TC_PLACEHOLDERS = sizeof tc_placeholder / sizeof *tc_placeholder };

/* A name in the making; too long where length reaches capacity. */
typedef struct tc_name {
    char *at;
    size_t capacity, length;
} tc_name;

static void tc_put(tc_name *name, const char *piece, size_t length)
{
    for (size_t i = 0; i < length; i++, name->length++)
        if (name->length < name->capacity)
            name->at[name->length] = piece[i];
}

void tc_name_number(char *out, size_t capacity, double value)
{
    char text[40];
    int digits = 1;
    if (value == 0 || !isfinite(value)) {
        snprintf(out, capacity, "%g", value + 0.0);
        return;
    }
    for (; digits < TC_DIGITS_SHORTEST; digits++) {
        snprintf(text, sizeof text, "%.*e", digits - 1, value);
        if (strtod(text, NULL) == value)
            break;
    }
    snprintf(text, sizeof text, "%.*e", digits - 1, value);
    const int exponent = atoi(strchr(text, 'e') + 1);
    if (exponent < -4 || exponent >= 16)
        snprintf(out, capacity, "%s", text);
    else
        snprintf(out, capacity, "%.*f", digits - 1 - exponent > 0 ? digits - 1 - exponent : 0, value);
}

static bool tc_is_safe(unsigned char c)
{
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c && strchr("._-", c));
}

void tc_name_safe(char *out, size_t capacity, const char *text)
{
    size_t n = 0;
    const bool dots = !strcmp(text, ".") || !strcmp(text, "..");
    for (const unsigned char *at = (const unsigned char *)text; *at && n + 1 < capacity; at++)
        if ((*at & 0xc0) != 0x80 || at == (const unsigned char *)text) /* of several bytes the first alone */
            out[n++] = tc_is_safe(*at) && !dots ? (char)*at : '_';
    if (n == 0 && capacity > 1)
        out[n++] = '_';
    if (capacity > 0)
        out[n] = 0;
}

/* ------------------------------------------------------------------------------------------------- placeholders */

/* Says what is wrong with {…} at text. */
static void tc_refuse(char *why, size_t capacity, const char *text, size_t known)
{
    const int whole = (int)(strcspn(text, "}") + (strchr(text, '}') != NULL));
    if (known < TC_PLACEHOLDERS && tc_placeholder[known].kind == TC_KIND_TEXT) {
        snprintf(why, capacity, "%.*s is no part of a name: {%s} takes no format", whole, text,
                 tc_placeholder[known].name);
    } else if (known < TC_PLACEHOLDERS) {
        const char *name = tc_placeholder[known].name;
        if (tc_placeholder[known].kind == TC_KIND_REAL)
            snprintf(why, capacity, "%.*s is no part of a name: write {%s}, {%s:.3f} or {%s:06d}", whole, text, name,
                     name, name);
        else
            snprintf(why, capacity, "%.*s is no part of a name: write {%s} or {%s:06d}", whole, text, name, name);
    } else {
        char name[64];
        tc_nearest search = {.name = name};
        snprintf(name, sizeof name, "%.*s", (int)strcspn(text + 1, ":}"), text + 1);
        for (size_t i = 0; i < TC_PLACEHOLDERS; i++)
            tc_nearest_offer(&search, tc_placeholder[i].name);
        snprintf(why, capacity, "%.*s is no part of a name; the nearest is {%s}, and {{ is a brace", whole, text,
                 search.best);
    }
}

/* {…} at *text, which moves behind it. values NULL: it is only checked. Gives its bit, 0: it is wrong. */
static unsigned tc_braces_put(tc_name *out, const char **text, const tc_name_values *values, char *why,
                              size_t capacity_why)
{
    const char *name = *text + 1, *end = NULL;
    const size_t length = strcspn(name, ":}");
    size_t i = 0;
    while (i < TC_PLACEHOLDERS &&
           (strlen(tc_placeholder[i].name) != length || strncmp(name, tc_placeholder[i].name, length) != 0))
        i++;
    const tc_kind kind = i < TC_PLACEHOLDERS ? tc_placeholder[i].kind : TC_KIND_TEXT;
    tc_number_format format;
    const bool good =
        i < TC_PLACEHOLDERS &&
        (kind == TC_KIND_TEXT ? name[length] == '}'
                              : tc_number_format_parse(&format, &end, name + length, kind != TC_KIND_REAL));
    if (!good) {
        tc_refuse(why, capacity_why, *text, i);
        return 0;
    }
    *text = kind == TC_KIND_TEXT ? name + length + 1 : end;
    if (!values)
        return tc_placeholder[i].bit;

    char piece[512];
    const char *field = (const char *)values + tc_placeholder[i].at;
    double number = 0;
    bool there = true;
    int n = 0;
    if (kind == TC_KIND_TEXT) {
        const char *value = *(const char *const *)field;
        there = value != NULL;
        if (there)
            tc_name_safe(piece, sizeof piece, value);
        n = there ? (int)strlen(piece) : 0;
    } else {
        number = kind == TC_KIND_REAL  ? *(const double *)field
                 : kind == TC_KIND_INT ? (double)*(const int *)field
                                       : (double)*(const long long *)field;
        there = isfinite(number);
        if (kind == TC_KIND_REAL && name[length] == '}') {
            tc_name_number(piece, sizeof piece, number);
            n = (int)strlen(piece);
        } else {
            n = tc_number_format_write(piece, sizeof piece, &format, number + 0.0);
        }
    }
    if (!there) {
        snprintf(why, capacity_why, "{%s} has no value here: %s", tc_placeholder[i].name, tc_placeholder[i].missing);
        return 0;
    }
    tc_put(out, piece, n > 0 && (size_t)n < sizeof piece ? (size_t)n : 0);
    return tc_placeholder[i].bit;
}

/* printf's %d, %4d, %04d, %.4d at *text, which moves behind it. False where it is none of them. */
static bool tc_percent_put(tc_name *out, const char **text, const tc_name_values *values)
{
    const char *at = *text + 1;
    const bool zero = *at == '0', point = *at == '.';
    at += zero || point;
    char *end;
    const size_t digits = strspn(at, "0123456789");
    const long width = digits > 0 && digits <= 3 ? strtol(at, &end, 10) : 0;
    at += digits;
    if (*at != 'd' || digits > 3 || width > TC_WIDTH_MOST || ((zero || point) && digits == 0))
        return false;
    *text = at + 1;
    if (values) {
        char piece[64];
        int n = zero    ? snprintf(piece, sizeof piece, "%0*lld", (int)width, values->number)
                : point ? snprintf(piece, sizeof piece, "%.*lld", (int)width, values->number)
                        : snprintf(piece, sizeof piece, "%*lld", (int)width, values->number);
        tc_put(out, piece, (size_t)n);
    }
    return true;
}

/* The whole template; values NULL: it is only checked. */
static bool tc_walk(tc_name *out, unsigned *uses, const char *pattern, const tc_name_values *values, char *why,
                    size_t capacity_why)
{
    *uses = 0;
    for (const char *at = pattern; *at;) {
        if (strchr("{}%", *at) && at[1] == at[0]) {
            tc_put(out, at, 1);
            at += 2;
        } else if (*at == '{') {
            unsigned bit = tc_braces_put(out, &at, values, why, capacity_why);
            if (bit == 0)
                return false;
            *uses |= bit;
        } else if (*at == '}') {
            snprintf(why, capacity_why, "a } stands alone; }} is a brace");
            return false;
        } else if (*at == '%') {
            if (!tc_percent_put(out, &at, values)) {
                snprintf(why, capacity_why, "%.*s begins no number: write %%d, %%04d or %%.4d, and %%%% for a per cent",
                         (int)(at[1] ? 1 + strspn(at + 1, "0123456789.-+ ") + 1 : 1), at);
                return false;
            }
            *uses |= TC_NAME_NUMBER;
        } else {
            tc_put(out, at++, 1);
        }
    }
    return true;
}

bool tc_name_make(char *out, size_t capacity, const char *pattern, const tc_name_values *values, char *why,
                  size_t capacity_why)
{
    tc_name name = {out, capacity, 0};
    unsigned uses;
    if (!tc_walk(&name, &uses, pattern, values, why, capacity_why))
        return false;
    if (name.length >= capacity) {
        snprintf(why, capacity_why, "a name of it has more than %zu characters", capacity > 0 ? capacity - 1 : 0);
        return false;
    }
    out[name.length] = 0;
    return true;
}

unsigned tc_name_uses(const char *pattern, char *why, size_t capacity_why)
{
    tc_name none = {NULL, 0, 0};
    unsigned uses;
    if (capacity_why > 0)
        *why = 0;
    return tc_walk(&none, &uses, pattern, NULL, why, capacity_why) ? uses : 0;
}
