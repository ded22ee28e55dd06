/* fill.c: exact coverage of pixels by polygons: each edge adds its signed area to the pixels that it crosses, a running
 * sum along the row does the rest (as in the rasterisers of font-rs and stb_truetype). */
#include "figure/fill.h"

#include "core/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool tc_path_add(tc_path *path, double x0, double y0, double x1, double y1)
{
    if (path->n == path->capacity) {
        size_t capacity = path->capacity ? 2 * path->capacity : 256;
        double(*edge)[4] = tc_realloc(path->edge, capacity, sizeof *edge);
        if (!edge)
            return false;
        path->edge = edge, path->capacity = capacity;
    }
    double *e = path->edge[path->n++];
    e[0] = x0, e[1] = y0, e[2] = x1, e[3] = y1;
    return true;
}

/* Adds to row [width + 1], whose running sum is coverage, the part (x0, y0) - (x1, y1) of an edge within one row of
 * pixels: height dy, with its sign. */
static void add_row(float *row, int width, double x0, double x1, double dy)
{
    if (x0 > x1) {
        double t = x0;
        x0 = x1, x1 = t;
    }
    if (x0 >= width) /* nothing is right of it */
        return;
    if (x1 <= 0) {
        row[0] += (float)dy;
        return;
    }
    if (x0 < 0) { /* what is left of the picture counts in full from its first pixel on */
        double share = -x0 / (x1 - x0);
        row[0] += (float)(dy * share);
        dy *= 1 - share, x0 = 0;
    }
    if (x1 > width) {
        dy *= (width - x0) / (x1 - x0);
        x1 = width;
    }
    int first = (int)x0, last = (int)ceil(x1) - 1;
    if (last <= first) {
        double covered = dy * (first + 1 - 0.5 * (x0 + x1));
        row[first] += (float)covered;
        row[first + 1] += (float)(dy - covered);
        return;
    }
    double slope = dy / (x1 - x0), before = 0; /* area of the pixels up to here, summed up */
    for (int x = first; x <= last + 1; x++) {
        double area; /* of pixel x */
        if (x == first)
            area = 0.5 * slope * (x + 1 - x0) * (x + 1 - x0);
        else if (x < last)
            area = slope * (x + 0.5 - x0);
        else if (x == last)
            area = dy - 0.5 * slope * (x1 - x) * (x1 - x);
        else
            area = dy;
        row[x] += (float)(area - before);
        before = area;
    }
}

bool tc_path_fill(float *coverage, int x, int y, int width, int height, const tc_path *path)
{
    size_t stride = (size_t)width + 1;
    float *sum = tc_calloc(stride * (size_t)height, sizeof *sum);
    if (!sum)
        return false;
    for (size_t i = 0; i < path->n; i++) {
        const double *e = path->edge[i];
        double sign = e[1] < e[3] ? 1 : -1;
        double xa = (sign > 0 ? e[0] : e[2]) - x, ya = (sign > 0 ? e[1] : e[3]) - y;
        double xb = (sign > 0 ? e[2] : e[0]) - x, yb = (sign > 0 ? e[3] : e[1]) - y;
        if (!(yb > ya) || yb <= 0 || ya >= height)
            continue;
        double slope = (xb - xa) / (yb - ya);
        double low = fmax(ya, 0), high = fmin(yb, height);
        for (int r = (int)low; r < height && r < high; r++) {
            double from = fmax(low, r), to = fmin(high, r + 1);
            if (to > from)
                add_row(sum + stride * (size_t)r, width, xa + slope * (from - ya), xa + slope * (to - ya),
                        sign * (to - from));
        }
    }
    for (int r = 0; r < height; r++) {
        double total = 0;
        for (int c = 0; c < width; c++) {
            total += sum[stride * (size_t)r + (size_t)c];
            double a = fabs(total);
            coverage[(size_t)r * (size_t)width + (size_t)c] = (float)(a > 1 ? 1 : a < 1e-6 ? 0 : a);
        }
    }
    free(sum);
    return true;
}

void tc_fill_grow(float *out, const float *coverage, int width, int height, double radius)
{
    int reach = (int)ceil(radius);
    memcpy(out, coverage, (size_t)width * (size_t)height * sizeof *out);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float *at = coverage + (size_t)y * (size_t)width + (size_t)x;
            if (!(*at > 0) || (x > 0 && x + 1 < width && y > 0 && y + 1 < height && at[-1] >= *at && at[1] >= *at &&
                               at[-width] >= *at && at[width] >= *at))
                continue; /* nothing, or others reach farther */
            for (int v = y > reach ? -reach : -y; v <= reach && y + v < height; v++)
                for (int u = x > reach ? -reach : -x; u <= reach && x + u < width; u++) {
                    float *to = out + (size_t)(y + v) * (size_t)width + (size_t)(x + u);
                    double weight = radius + 0.5 - sqrt(u * u + v * v);
                    if (weight > 0)
                        *to = fmaxf(*to, (float)fmin(weight, 1) * *at);
                }
        }
}
