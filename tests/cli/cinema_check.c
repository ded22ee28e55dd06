/* cinema_check FOLDER.cdb [--files]: does a Cinema database keep the rules of Spec D (dietrich), version 1.2, and of
 * RFC 4180? Written apart from what writes them. Row 1 is the header. Prints each breach as "row R, column C:
 * SENTENCE".
 *   --files  what FILE columns name is there, is not empty, and lies inside the folder or has a relative path
 * Beyond the specification: floats have a decimal point, and texts have no blanks at their ends outside of quotes.
 * Exit 0: none, and what was seen; 1: breaches; 2: wrong command line. */
#define _GNU_SOURCE
#include <ctype.h>
#include <limits.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { COLUMNS_MAX = 256 };
typedef enum kind { EMPTY, INTEGER, FLOAT, STRING } kind;

typedef struct column {
    char *name;
    kind type; /* of the first value that is not empty */
    long from; /* its row */
    bool file;
} column;

static column col[COLUMNS_MAX];
static int n_col;
static long breaches, row_now = 1;
static const char *cdb;
static bool files;

__attribute__((format(printf, 2, 3))) static void breach(int at, const char *format, ...)
{
    va_list rest;
    breaches++;
    if (row_now > 0)
        printf("row %ld, column %d: ", row_now, at + 1);
    va_start(rest, format);
    vprintf(format, rest);
    va_end(rest);
    putchar('\n');
}

/* An integer: [+-]digits. A float: [+-](digits[.digits]|.digits)[e[+-]digits], or nan, inf, infinity. */
static kind kind_of(const char *s)
{
    const char *p = s + (*s == '+' || *s == '-');
    if (!strcasecmp(p, "nan") || !strcasecmp(p, "inf") || !strcasecmp(p, "infinity"))
        return FLOAT;
    size_t before = strspn(p, "0123456789"), after = 0;
    if (before && !p[before])
        return INTEGER;
    p += before;
    if (*p == '.') {
        after = strspn(++p, "0123456789");
        p += after;
    }
    if (before + after == 0)
        return STRING;
    if (*p == 'e' || *p == 'E') {
        p++;
        p += *p == '+' || *p == '-';
        size_t digits = strspn(p, "0123456789");
        if (!digits)
            return STRING;
        p += digits;
    }
    return *p ? STRING : FLOAT;
}

static const char *word(kind k)
{
    return k == INTEGER ? "an integer" : k == FLOAT ? "a float" : "a string";
}

static void check_name(int at, char *name)
{
    if (at >= COLUMNS_MAX) {
        breach(at, "more columns than this program can check (%d)", COLUMNS_MAX);
        return;
    }
    col[at] = (column){.name = strdup(name), .file = strncmp(name, "FILE", 4) == 0};
    n_col = at + 1;
    if (!*name)
        breach(at, "the column has no name");
    else if (kind_of(name) != STRING)
        breach(at, "the name '%s' is a number and no string", name);
    for (int i = 0; i < at; i++)
        if (*name && strcmp(col[i].name, name) == 0)
            breach(at, "the name '%s' is that of column %d, too", name, i + 1);
    if (at > 0 && col[at - 1].file && !col[at].file)
        breach(at, "the column '%s' comes after a FILE column", name);
}

static void check_file(int at, const char *value)
{
    struct stat info;
    char path[PATH_MAX], real[PATH_MAX], root[PATH_MAX];
    if (strstr(value, "://"))
        return;
    int n = *value == '/' ? snprintf(path, sizeof path, "%s", value) : snprintf(path, sizeof path, "%s/%s", cdb, value);
    if (n >= (int)sizeof path || stat(path, &info) != 0)
        breach(at, "the file '%s' is not there", value);
    else if (!S_ISREG(info.st_mode))
        breach(at, "'%s' is no file", value);
    else if (info.st_size == 0)
        breach(at, "the file '%s' is empty", value);
    else if (*value == '/' && realpath(path, real) && realpath(cdb, root) &&
             (strncmp(real, root, strlen(root)) != 0 || real[strlen(root)] != '/'))
        breach(at, "the file '%s' lies outside of the database and has a path from the root", value);
}

static void check_value(int at, const char *value, bool quoted)
{
    if (at >= n_col || (!*value && !quoted)) /* too many values are said at the row's end */
        return;
    kind type = kind_of(value);
    column *c = &col[at];
    bool nan = strcasecmp(value, "nan") == 0;
    if (c->type == EMPTY) {
        c->type = type;
        c->from = row_now;
    }
    if (c->file && type != STRING)
        breach(at, "'%s' is %s and no path of a file", value, word(type));
    else if (type != c->type && !(nan && c->type == STRING))
        breach(at, "'%s' is %s, but the column is one of %ss since row %ld", value, word(type),
               strchr(word(c->type), ' ') + 1, c->from);
    else if (type == FLOAT && !strchr(value, '.') && !isalpha((unsigned char)value[strlen(value) - 1]))
        breach(at, "the float '%s' has no decimal point", value);
    if (c->file && files && type == STRING)
        check_file(at, value);
}

/* One value from p on, into out: gives where the comma, the line's end or the file's end is. */
static const char *take(const char *p, const char *end, char *out, bool *quoted, int at)
{
    *quoted = p < end && *p == '"';
    if (!*quoted) {
        bool told = false;
        const char *start = p;
        for (; p < end && *p != ',' && *p != '\n' && !(*p == '\r' && p + 1 < end && p[1] == '\n'); *out++ = *p++) {
            if (!told && (*p == '"' || *p == '\r' || !*p)) {
                breach(at, *p == '"'    ? "a quote stands within a value without quotes"
                           : *p == '\r' ? "a carriage return stands alone"
                                        : "a zero byte");
                told = true;
            }
        }
        if (p > start && (isspace((unsigned char)*start) || isspace((unsigned char)p[-1])))
            breach(at, "a blank stands beside a comma or at a line's end");
    } else {
        for (p++;; *out++ = *p++) {
            if (p >= end) {
                breach(at, "a quote is not closed");
                break;
            }
            if (*p == '"' && (p + 1 == end || p[1] != '"')) {
                p++;
                break;
            }
            p += *p == '"';
        }
        if (p < end && *p != ',' && *p != '\n' && !(*p == '\r' && p + 1 < end && p[1] == '\n')) {
            breach(at, "something stands after a closing quote");
            while (p < end && *p != ',' && *p != '\n')
                p++;
        }
    }
    *out = 0;
    return p;
}

static void check_rows(const char *p, const char *end)
{
    char *value = malloc((size_t)(end - p) + 1);
    long lf = 0, crlf = 0;
    if (!value)
        exit(2);
    for (row_now = 1; p < end; row_now++) {
        int n = 0;
        bool quoted = false, blank = *p == '\n' || (*p == '\r' && p + 1 < end && p[1] == '\n');
        for (;; p++) {
            p = take(p, end, value, &quoted, n);
            if (row_now == 1)
                check_name(n, value);
            else
                check_value(n, value, quoted);
            n++;
            if (p >= end || *p != ',')
                break;
        }
        if (row_now > 1 && blank && n_col > 1)
            breach(0, "the row is empty");
        else if (row_now > 1 && n != n_col)
            breach(n < n_col ? n : n_col, "the row has %d values, the header %d", n, n_col);
        if (p < end) {
            crlf += *p == '\r';
            lf += *p == '\n';
            p += *p == '\r' ? 2 : 1;
        }
        if (lf && crlf) {
            breach(n - 1, "lines end with LF and with CRLF");
            lf = crlf = 0;
        }
    }
    free(value);
}

static void check_utf8(const unsigned char *p, const unsigned char *end)
{
    for (row_now = 1; p < end; p++) {
        row_now += *p == '\n';
        if (*p < 0x80)
            continue;
        int more = *p >= 0xF0 && *p <= 0xF4 ? 3 : *p >= 0xE0 && *p < 0xF0 ? 2 : *p >= 0xC2 && *p < 0xE0 ? 1 : 0;
        unsigned long code = *p & (0x3Fu >> more);
        bool good = more > 0 && end - p > more;
        for (int i = 1; good && i <= more; i++) {
            good = (p[i] & 0xC0) == 0x80;
            code = code << 6 | (p[i] & 0x3Fu);
        }
        if (good)
            good = code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF) &&
                   code >= (more == 1   ? 0x80u
                            : more == 2 ? 0x800u
                                        : 0x10000u);
        if (!good) {
            breaches++;
            printf("line %ld: the byte 0x%02x is not UTF-8\n", row_now, *p);
            return;
        }
        p += more;
    }
}

int main(int argc, char **argv)
{
    struct stat info;
    char path[PATH_MAX];
    files = argc == 3 && strcmp(argv[2], "--files") == 0;
    if (argc != 2 && !files) {
        fprintf(stderr, "usage: cinema_check FOLDER.cdb [--files]\n");
        return 2;
    }
    cdb = argv[1];
    row_now = 0;
    size_t length = strlen(cdb);
    while (length > 1 && cdb[length - 1] == '/')
        length--;
    if (length < 5 || strncmp(cdb + length - 4, ".cdb", 4) != 0 || cdb[length - 5] == '/')
        breach(0, "the name of %s does not end in .cdb", cdb);
    snprintf(path, sizeof path, "%s/data.csv", cdb);
    FILE *file = NULL;
    if (stat(cdb, &info) != 0 || !S_ISDIR(info.st_mode))
        breach(0, "%s is no folder", cdb);
    else if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || !(file = fopen(path, "rb")))
        breach(0, "%s is no file that can be read", path);
    if (!file)
        return 1;
    char *text = malloc((size_t)info.st_size + 1);
    if (!text)
        return 2;
    size_t bytes = fread(text, 1, (size_t)info.st_size, file);
    fclose(file);
    const char *start = text;
    check_utf8((unsigned char *)text, (unsigned char *)text + bytes);
    if (bytes >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) {
        row_now = 0;
        breach(0, "%s begins with a byte-order mark, which becomes part of the first name", path);
        start += 3;
    }
    check_rows(start, text + bytes);
    long rows = row_now - 2;
    row_now = 0;
    if (start == text + bytes)
        breach(0, "%s has no header", path);
    else if (rows < 1)
        breach(0, "%s has no row", path);
    if (breaches == 0)
        printf("%ld rows, %d columns\n", rows, n_col);
    for (int i = 0; i < n_col; i++)
        free(col[i].name);
    free(text);
    return breaches ? 1 : 0;
}
