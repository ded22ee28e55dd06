/* csv.c: comma-separated values as RFC 4180 has them. */
#define _GNU_SOURCE
#include "cli/batch/csv.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tc_csv_begin(tc_csv_reader *reader, char *text, size_t bytes)
{
    *reader = (tc_csv_reader){text, text + bytes, 1};
    if (bytes >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0)
        reader->at += 3;
}

/* One value at reader->at. Gives what ends it: ',', '\n', or 0 with *why. */
static char csv_value(tc_csv_reader *reader, tc_csv_cell *cell, const char **why)
{
    static const char *const cut = "it ends within a row";
    char *p = reader->at, *end = reader->end, *out = p;
    cell->text = p;
    cell->quoted = p < end && *p == '"';
    if (cell->quoted) {
        for (p++; p < end; *out++ = *p++) {
            if (*p == '"' && (++p == end || *p != '"'))
                break;
            if (*p == '\n')
                reader->line++;
        }
        if (p >= end)
            return *why = cut, 0;
    } else {
        for (; p < end && *p != ',' && *p != '\n' && *p != '\r'; p++)
            if (*p == '"' || !*p)
                return *why = *p ? "a quote stands within a value without quotes" : "it has a zero byte", 0;
        out = p;
    }
    if (p >= end)
        return *why = cut, 0;
    char stop = *p++;
    if (stop == '\r' && p < end && *p == '\n')
        stop = *p++;
    if (stop != ',' && stop != '\n') {
        *why = stop != '\r' ? "something stands between a closing quote and the next comma" : "a line ends without LF";
        return 0;
    }
    if (cell->quoted && memchr(cell->text, 0, (size_t)(out - cell->text)))
        return *why = "it has a zero byte", 0;
    *out = 0;
    reader->at = p;
    return stop;
}

int tc_csv_next(tc_csv_reader *reader, tc_csv_cell *cell, size_t capacity, size_t *n, const char **why)
{
    *n = 0;
    if (reader->at >= reader->end)
        return 0;
    for (;;) {
        tc_csv_cell one;
        char stop = csv_value(reader, &one, why);
        if (!stop)
            return -1;
        if (*n < capacity)
            cell[*n] = one;
        ++*n;
        if (stop == '\n') {
            reader->line++;
            return 1;
        }
    }
}

void tc_csv_put(tc_csv_text *out, const char *bytes, size_t n)
{
    if (!n)
        return;
    if (out->failed || n > SIZE_MAX / 4 - out->n) {
        out->failed = true;
        return;
    }
    if (out->n + n > out->capacity) {
        size_t capacity = (out->n + n) * 2 + 4096;
        char *data = realloc(out->data, capacity);
        if (!data) {
            out->failed = true;
            return;
        }
        out->data = data;
        out->capacity = capacity;
    }
    memcpy(out->data + out->n, bytes, n);
    out->n += n;
}

static bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

void tc_csv_put_value(tc_csv_text *out, const char *text)
{
    size_t n = strlen(text);
    if (n > 0 && !strpbrk(text, ",\"\r\n") && !is_blank(text[0]) && !is_blank(text[n - 1])) {
        tc_csv_put(out, text, n);
        return;
    }
    tc_csv_put(out, "\"", 1);
    for (const char *quote; (quote = strchr(text, '"')) != NULL; text = quote + 1) {
        tc_csv_put(out, text, (size_t)(quote + 1 - text));
        tc_csv_put(out, "\"", 1);
    }
    tc_csv_put(out, text, strlen(text));
    tc_csv_put(out, "\"", 1);
}

/* strtod of the "C" locale, whatever is in force. */
static double plain_strtod(const char *text, char **end)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0) {
        *end = (char *)text;
        return NAN;
    }
    double value = strtod_l(text, end, plain);
    freelocale(plain);
    return value;
}

void tc_csv_float(char *out, double value)
{
    if (!isfinite(value)) {
        strcpy(out, isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
        return;
    }
    if (value == 0) {
        strcpy(out, "0.0");
        return;
    }
    /* Fifteen digits give back any number that was written with as many; seventeen any number at all. */
    char text[40], digit[20], *end;
    int n = 0, exponent = 0;
    for (int precision = 15; precision <= 17; precision++) {
        snprintf(text, sizeof text, "%.*e", precision - 1, fabs(value));
        const char *p = text;
        for (n = 0; *p != 'e'; p++) /* all but digits is the locale's decimal point */
            if (*p >= '0' && *p <= '9' && n < precision)
                digit[n++] = *p;
        exponent = atoi(p + 1);
        while (n > 1 && digit[n - 1] == '0')
            n--;
        char plain[48];
        snprintf(plain, sizeof plain, "%.*se%d", n, digit, exponent - n + 1);
        if (precision == 17 || plain_strtod(plain, &end) == fabs(value))
            break;
    }
    const char *sign = value < 0 ? "-" : "";
    if (exponent < -4 || exponent > 15)
        sprintf(out, "%s%c.%.*se%c%02d", sign, digit[0], n > 1 ? n - 1 : 1, n > 1 ? digit + 1 : "0",
                exponent < 0 ? '-' : '+', abs(exponent));
    else if (exponent < 0)
        sprintf(out, "%s0.%.*s%.*s", sign, -exponent - 1, "000", n, digit);
    else if (n <= exponent + 1)
        sprintf(out, "%s%.*s%.*s.0", sign, n, digit, exponent + 1 - n, "000000000000000");
    else
        sprintf(out, "%s%.*s.%.*s", sign, exponent + 1, digit, n - exponent - 1, digit + exponent + 1);
}

bool tc_csv_read_float(double *out, const char *text)
{
    char *end;
    if (!*text || is_blank(*text) || strpbrk(text, "xX("))
        return false;
    *out = plain_strtod(text, &end);
    return !*end && end != text;
}

bool tc_csv_read_integer(long long *out, const char *text)
{
    char *end;
    if (!*text || is_blank(*text))
        return false;
    errno = 0;
    *out = strtoll(text, &end, 10);
    return !*end && end != text && errno == 0;
}

bool tc_csv_like_number(const char *text)
{
    while (is_blank(*text))
        text++;
    size_t n = strlen(text);
    while (n > 0 && is_blank(text[n - 1]))
        n--;
    char *plain = malloc(n + 1), *end;
    if (!plain)
        return true;
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) /* Python reads 1_000 */
        if (text[i] != '_')
            plain[kept++] = text[i];
    plain[kept] = 0;
    bool like = n == 0; /* JavaScript reads a blank text as 0 */
    if (kept > 0) {
        plain_strtod(plain, &end);
        like = !*end;
        if (!like && plain[0] == '0' && plain[1] && strchr("bBoO", plain[1])) /* JavaScript reads 0b11 and 0o17 */
            like = plain[2] && strspn(plain + 2, "01234567") == kept - 2;
    }
    free(plain);
    return like;
}

bool tc_csv_is_utf8(const char *text)
{
    const unsigned char *p = (const unsigned char *)text;
    while (*p) {
        int more = *p < 0x80                 ? 0
                   : *p >= 0xC2 && *p < 0xE0 ? 1
                   : (*p & 0xF0) == 0xE0     ? 2
                   : *p >= 0xF0 && *p < 0xF5 ? 3
                                             : -1;
        if (more < 0)
            return false;
        if ((*p == 0xE0 && p[1] < 0xA0) || (*p == 0xED && p[1] > 0x9F) || (*p == 0xF0 && p[1] < 0x90) ||
            (*p == 0xF4 && p[1] > 0x8F))
            return false;
        for (p++; more > 0; more--, p++)
            if ((*p & 0xC0) != 0x80)
                return false;
    }
    return true;
}
