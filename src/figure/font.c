/* font.c: letters from the outlines of glyphs.inc. There is no hinting but this: heights that most letters share - the
 * baseline, small letters, capitals, with their rounds, which reach a little beyond - are moved to whole pixels. */
#include "figure/font.h"

#include <math.h>
#include <stdlib.h>

typedef struct glyph {
    uint32_t character;
    int advance;
    const char *path; /* m, l, h, v, q: relative */
} glyph;

static const glyph GLYPH[] = {
#include "glyphs.inc"
};

enum { UNITS = 2048, CAP = 1493, SMALL = 1120, ROUND = 29, REPLACEMENT = 0xfffd };

double tc_font_em(double em)
{
    return fmax(1, round(em * CAP / UNITS)) * UNITS / CAP;
}

double tc_font_cap(double em)
{
    return em * CAP / UNITS;
}

/* The next character of *text, which moves on; 0 at its end. */
static uint32_t decode(const char **text)
{
    const unsigned char *p = (const unsigned char *)*text;
    int more = p[0] < 0x80                   ? 0
               : p[0] >= 0xc2 && p[0] < 0xe0 ? 1
               : p[0] >= 0xe0 && p[0] < 0xf0 ? 2
               : p[0] >= 0xf0 && p[0] < 0xf5 ? 3
                                             : -1;
    if (more == 0) {
        *text += p[0] != 0;
        return p[0] == 0 ? 0 : p[0] < 0x20 || p[0] == 0x7f ? ' ' : p[0];
    }
    uint32_t c = more > 0 ? p[0] & (0x3fu >> more) : REPLACEMENT;
    int used = 1;
    for (; used <= more && (p[used] & 0xc0) == 0x80; used++)
        c = c << 6 | (p[used] & 0x3fu);
    *text += used;
    return more < 0 || used <= more ? REPLACEMENT : c;
}

static const glyph *find(uint32_t character)
{
    size_t lo = 0, hi = sizeof GLYPH / sizeof *GLYPH; /* ascending */
    while (hi - lo > 1) {
        size_t middle = (lo + hi) / 2;
        *(GLYPH[middle].character <= character ? &lo : &hi) = middle;
    }
    if (GLYPH[lo].character == character)
        return &GLYPH[lo];
    return character == REPLACEMENT ? &GLYPH[0] : find(REPLACEMENT);
}

double tc_font_width(const char *text, double em)
{
    double sum = 0;
    for (uint32_t c; (c = decode(&text)) != 0;)
        sum += find(c)->advance;
    return sum * em / UNITS;
}

size_t tc_font_count(const char *text)
{
    size_t n = 0;
    while (decode(&text))
        n++;
    return n;
}

size_t tc_font_bytes(const char *text, size_t n)
{
    const char *p = text;
    while (n-- && decode(&p))
        ;
    return (size_t)(p - text);
}

/* Height y of an outline in pixels, moved so that shared heights fall on whole pixels; monotonous. */
static double align(double y, double em)
{
    double unit = em / UNITS, cap = round(CAP * unit), small = round(SMALL * unit);
    double over = ROUND * unit < 0.6 ? 0 : ROUND * unit; /* of rounds; nothing where it would only blur */
    const double from[] = {-ROUND, 0, SMALL, SMALL + ROUND, CAP, CAP + ROUND};
    const double to[] = {-over, 0, small, small + over, cap, cap + over};
    enum { N = sizeof from / sizeof *from };
    if (y <= from[0])
        return to[0] + (y - from[0]) * unit;
    for (int i = 1; i < N; i++)
        if (y <= from[i])
            return to[i - 1] + (to[i] - to[i - 1]) * (y - from[i - 1]) / (from[i] - from[i - 1]);
    return to[N - 1] + (y - from[N - 1]) * unit;
}

/* Where outlines go: a path, or the box of them. */
typedef struct pen {
    tc_path *path;
    tc_box *box;
    double em, x, y, at; /* of the text's start; of the letter, along it */
    bool turned, any;
} pen;

static bool edge(pen *p, const double *a, const double *b)
{
    double q[2][2];
    for (int i = 0; i < 2; i++) {
        double along = p->at + (i ? b : a)[0] * p->em / UNITS, up = align((i ? b : a)[1], p->em);
        q[i][0] = p->turned ? p->x - up : p->x + along;
        q[i][1] = p->turned ? p->y - along : p->y - up;
    }
    if (p->box) {
        tc_box *o = p->box;
        for (int i = 0; i < 2; i++) {
            o->x0 = p->any ? fmin(o->x0, q[i][0]) : q[i][0], o->x1 = p->any ? fmax(o->x1, q[i][0]) : q[i][0];
            o->y0 = p->any ? fmin(o->y0, q[i][1]) : q[i][1], o->y1 = p->any ? fmax(o->y1, q[i][1]) : q[i][1];
            p->any = true;
        }
    }
    return !p->path || tc_path_add(p->path, q[0][0], q[0][1], q[1][0], q[1][1]);
}

/* A quadratic curve in straight parts that leave it by less than a twentieth of a pixel. */
static bool curve(pen *p, const double *a, const double *b, const double *c)
{
    double bend = hypot(a[0] - 2 * b[0] + c[0], a[1] - 2 * b[1] + c[1]) * p->em / UNITS;
    int n = 1 + (int)fmin(100, sqrt(bend / 4 / 0.05));
    double from[2] = {a[0], a[1]};
    for (int i = 1; i <= n; i++) {
        double t = (double)i / n, to[2];
        for (int k = 0; k < 2; k++)
            to[k] = (1 - t) * (1 - t) * a[k] + 2 * t * (1 - t) * b[k] + t * t * c[k];
        if (!edge(p, from, to))
            return false;
        from[0] = to[0], from[1] = to[1];
    }
    return true;
}

static bool draw(pen *p, const glyph *g)
{
    double at[2] = {0, 0}, start[2] = {0, 0};
    for (const char *s = g->path; *s;) {
        char command = *s++, *end;
        double v[4] = {0};
        int n = command == 'q' ? 4 : command == 'h' || command == 'v' ? 1 : 2;
        for (int i = 0; i < n; i++) {
            v[i] = (double)strtol(s, &end, 10);
            s = end;
        }
        if (command == 'm') {
            /* closes the contour before; its start is on the way */
            if ((start[0] != at[0] || start[1] != at[1]) && !edge(p, at, start))
                return false;
            start[0] = at[0] += v[0], start[1] = at[1] += v[1];
            continue;
        }
        double middle[2] = {at[0] + v[0], at[1] + v[1]};
        double to[2] = {at[0] + (command == 'v'   ? 0
                                 : command == 'q' ? v[2]
                                                  : v[0]),
                        at[1] + (command == 'h'   ? 0
                                 : command == 'q' ? v[3]
                                 : command == 'v' ? v[0]
                                                  : v[1])};
        if (!(command == 'q' ? curve(p, at, middle, to) : edge(p, at, to)))
            return false;
        at[0] = to[0], at[1] = to[1];
    }
    return true;
}

static bool write_text(pen *p, const char *text)
{
    for (uint32_t c; (c = decode(&text)) != 0;) {
        const glyph *g = find(c);
        if (!draw(p, g))
            return false;
        p->at += g->advance * p->em / UNITS;
    }
    return true;
}

void tc_font_extent(tc_box *out, const char *text, double em)
{
    *out = (tc_box){0};
    pen p = {.box = out, .em = em};
    write_text(&p, text);
}

bool tc_font_add(tc_path *path, const char *text, double em, double x, double y, bool turned)
{
    pen p = {.path = path, .em = em, .x = x, .y = y, .turned = turned};
    return write_text(&p, text);
}
