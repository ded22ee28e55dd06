/* color_path.c: the shortest way between two colours by perceived difference.
 * M. Zeyen et al., Color Interpolation for Non-Euclidean Color Spaces, IEEE VIS 2018: Dijkstra's algorithm over a grid
 * of colours; difference CIEDE2000 after G. Sharma, W. Wu, E. Dalal 2005 (their equations in the comments). Grid of
 * 17^3 and 26 neighbours as in VTK's "Lab/CIEDE2000". */
#include "transfer_functions/color_space.h"

#include "core/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 17, NODES = SIDE * SIDE * SIDE };

static const double pi = 3.14159265358979323846;

static double hue_of(double b, double a)
{
    if (a == 0 && b == 0)
        return 0;
    const double h = atan2(b, a);
    return h < 0 ? h + 2 * pi : h;
}

double tc_color_difference(const double lab_a[3], const double lab_b[3])
{
    const double degree = pi / 180, power25 = 6103515625.0;                                   /* 25^7 */
    const double chroma_mean = 0.5 * (hypot(lab_a[1], lab_a[2]) + hypot(lab_b[1], lab_b[2])); /* eq. 2, 3 */
    const double c7 = pow(chroma_mean, 7), g = 0.5 * (1 - sqrt(c7 / (c7 + power25)));         /* eq. 4 */
    const double a1 = (1 + g) * lab_a[1], a2 = (1 + g) * lab_b[1];                            /* eq. 5 */
    const double chroma1 = hypot(a1, lab_a[2]), chroma2 = hypot(a2, lab_b[2]);                /* eq. 6 */
    const double hue1 = hue_of(lab_a[2], a1), hue2 = hue_of(lab_b[2], a2);                    /* eq. 7 */
    const double product = chroma1 * chroma2;
    double turn = hue2 - hue1, hue_mean = hue1 + hue2; /* eq. 10, 14 */
    if (product == 0) {
        turn = 0;
    } else if (fabs(turn) <= pi) {
        hue_mean *= 0.5;
    } else {
        turn += turn > 0 ? -2 * pi : 2 * pi;
        hue_mean = 0.5 * (hue_mean < 2 * pi ? hue_mean + 2 * pi : hue_mean - 2 * pi);
    }
    const double d_light = lab_b[0] - lab_a[0], d_chroma = chroma2 - chroma1, d_hue = 2 * sqrt(product) * sin(turn / 2);
    const double light = 0.5 * (lab_a[0] + lab_b[0]) - 50, chroma = 0.5 * (chroma1 + chroma2);
    const double t = 1 - 0.17 * cos(hue_mean - 30 * degree) + 0.24 * cos(2 * hue_mean) +
                     0.32 * cos(3 * hue_mean + 6 * degree) - 0.20 * cos(4 * hue_mean - 63 * degree); /* eq. 15 */
    const double bell = (hue_mean / degree - 275) / 25, theta = 30 * degree * exp(-bell * bell);     /* eq. 16 */
    const double m7 = pow(chroma, 7), rotation = -sin(2 * theta) * 2 * sqrt(m7 / (m7 + power25));    /* eq. 17, 21 */
    const double l = d_light / (1 + 0.015 * light * light / sqrt(20 + light * light));               /* eq. 18 */
    const double c = d_chroma / (1 + 0.045 * chroma), h = d_hue / (1 + 0.015 * chroma * t);          /* eq. 19, 20 */
    return sqrt(fmax(0, l * l + c * c + h * h + rotation * c * h));                                  /* eq. 22 */
}

/* Binary heap of nodes by distance, with each node's place in it. */
typedef struct search {
    double distance[NODES], lab[NODES][3];
    int next[NODES]; /* towards the end of the way */
    int heap[NODES], place[NODES], n;
} search;

static void put(search *s, int at, int node)
{
    s->heap[at] = node;
    s->place[node] = at;
}

static void sift_up(search *s, int at)
{
    const int node = s->heap[at];
    for (; at > 0 && s->distance[s->heap[(at - 1) / 2]] > s->distance[node]; at = (at - 1) / 2)
        put(s, at, s->heap[(at - 1) / 2]);
    put(s, at, node);
}

static int take_nearest(search *s)
{
    const int nearest = s->heap[0], node = s->heap[--s->n];
    int at = 0;
    for (int child; (child = 2 * at + 1) < s->n; at = child) {
        if (child + 1 < s->n && s->distance[s->heap[child + 1]] < s->distance[s->heap[child]])
            child++;
        if (s->distance[s->heap[child]] >= s->distance[node])
            break;
        put(s, at, s->heap[child]);
    }
    if (s->n > 0)
        put(s, at, node);
    return nearest;
}

static int node_of(const double rgb[3])
{
    int node = 0;
    for (int c = 2; c >= 0; c--)
        node = node * SIDE + (int)(fmax(0, fmin(1, rgb[c])) * (SIDE - 1) + 0.5);
    return node;
}

static void color_of(double rgb[3], int node)
{
    for (int c = 0; c < 3; c++, node /= SIDE)
        rgb[c] = node % SIDE / (double)(SIDE - 1);
}

static void relax(search *s, int node)
{
    const int at[3] = {node % SIDE, node / SIDE % SIDE, node / SIDE / SIDE};
    for (int i = 0; i < 27; i++) {
        const int to[3] = {at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1};
        if (i == 13 || to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= SIDE || to[1] >= SIDE || to[2] >= SIDE)
            continue;
        const int other = to[0] + SIDE * (to[1] + SIDE * to[2]);
        const double distance = s->distance[node] + tc_color_difference(s->lab[node], s->lab[other]);
        if (distance >= s->distance[other])
            continue;
        s->distance[other] = distance;
        s->next[other] = node;
        if (s->place[other] < 0)
            put(s, s->n++, other);
        sift_up(s, s->place[other]);
    }
}

tc_status tc_color_path(tc_color_point **point, size_t *n, const double a[3], const double b[3], tc_error *err)
{
    *point = NULL;
    *n = 0;
    search *s = tc_calloc(1, sizeof *s);
    if (!s)
        return tc_fail_memory(err, "a colour path", 1, sizeof *s);
    for (int i = 0; i < NODES; i++) {
        double rgb[3];
        color_of(rgb, i);
        tc_color_rgb_to_lab(s->lab[i], rgb);
        s->distance[i] = INFINITY;
        s->place[i] = -1;
    }
    const int start = node_of(a), end = node_of(b);
    s->distance[end] = 0;
    put(s, s->n++, end);
    while (s->n > 0) {
        const int node = take_nearest(s);
        if (node == start)
            break;
        relax(s, node);
    }
    size_t count = 1;
    for (int node = start; node != end; node = s->next[node])
        count++;
    tc_color_point *path = tc_calloc(count, sizeof *path);
    if (!path) {
        free(s);
        return tc_fail_memory(err, "a colour path", count, sizeof *path);
    }
    int node = start;
    for (size_t i = 0; i < count; i++, node = node == end ? end : s->next[node]) {
        color_of(path[i].rgb, node);
        path[i].x = start == end ? 0 : 1 - s->distance[node] / s->distance[start];
        path[i].midpoint = 0.5;
    }
    free(s);
    *point = path;
    *n = count;
    return TC_OK;
}
