/* fill.h: shapes of straight edges as coverage of pixels. */
#ifndef TC_FIGURE_FILL_H
#define TC_FIGURE_FILL_H

#include "core/status.h"

/* Pixels, y down; pixel (0, 0) covers 0 … 1. */
typedef struct tc_box {
    double x0, y0, x1, y1;
} tc_box;

static inline bool tc_box_meets(const tc_box *a, const tc_box *b)
{
    return a->x0 < b->x1 && b->x0 < a->x1 && a->y0 < b->y1 && b->y0 < a->y1;
}

/* Edges of closed contours. Zero-initialise; free(edge) ends it. */
typedef struct tc_path {
    size_t n, capacity;
    double (*edge)[4]; /* x0 y0 x1 y1 */
} tc_path;

/* false: memory is out. */
bool tc_path_add(tc_path *path, double x0, double y0, double x1, double y1);

/* Share of each pixel [height][width] from (x, y) on that lies within the contours, which must not overlap with
 * opposite senses; exact for what does not overlap. Edges outside are taken into account. false: memory is out. */
bool tc_path_fill(float *coverage, int x, int y, int width, int height, const tc_path *path);
/* The largest of coverage within radius pixels, with a soft rim; out [height][width] may not be coverage. */
void tc_fill_grow(float *out, const float *coverage, int width, int height, double radius);

#endif
