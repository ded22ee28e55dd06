/* graded.c: cells of good shape whose sizes go from 1e-6 to 1: cubes one in another, each smaller than the one around
 * it by the same factor, and the layers between them cut into prisms and these into tets by the order of their
 * vertices. */
#include "box.h"
#include "cubeskin.h"
#include "soup.h"

#include <math.h>

static const double smallest = 1e-6;

/* Squares along an edge, and layers, for about n_cells tets as wide as they are thick. */
static void sizes(size_t *n, size_t *n_layer, size_t n_cells)
{
    for (*n = 2;; ++*n) {
        double skin = 12 * (double)*n * (double)*n;
        *n_layer = (size_t)fmax(4, round(((double)n_cells / skin - 1) / 3));
        double next = (double)*n + 1, wanted = log(smallest) / log(1 - 1.6 / next); /* layers for one square more */
        if (12 * next * next * (3 * wanted + 1) > (double)n_cells)
            return;
    }
}

/* The three tets of the prism over a face; inner and outer: first vertex of the layer below and above. */
static void prism(tc_builder *b, const int32_t *face, int32_t inner, int32_t outer)
{
    int32_t v[3] = {face[0], face[1], face[2]};
    bool odd = false;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < 2 - pass; i++)
            if (v[i] > v[i + 1]) {
                int32_t swap = v[i];
                v[i] = v[i + 1], v[i + 1] = swap;
                odd = !odd;
            }
    tc_builder_tet_turned(b, inner + v[0], inner + v[1], inner + v[2], outer + v[2], odd);
    tc_builder_tet_turned(b, inner + v[0], inner + v[1], outer + v[1], outer + v[2], !odd);
    tc_builder_tet_turned(b, inner + v[0], outer + v[0], outer + v[1], outer + v[2], odd);
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    size_t n, n_layer;
    sizes(&n, &n_layer, n_cells);
    tc_cubeskin skin;
    tc_status status = tc_cubeskin_build(&skin, n, err);
    tc_builder b = {.soup = out};
    for (size_t l = 0; l <= n_layer && !status && !b.failure; l++) {
        double scale = pow(smallest, (double)(n_layer - l) / (double)n_layer);
        for (size_t v = 0; v < skin.n_vertex; v++)
            tc_builder_vertex(&b, scale * skin.vertex[3 * v], scale * skin.vertex[3 * v + 1],
                              scale * skin.vertex[3 * v + 2]);
    }
    int32_t middle = tc_builder_vertex(&b, 0, 0, 0), step = (int32_t)skin.n_vertex;
    for (size_t f = 0; f < skin.n_face && !status; f++) {
        const int32_t *v = skin.face + 3 * f;
        tc_builder_tet(&b, middle, v[0], v[1], v[2]);
        for (size_t l = 0; l < n_layer && !b.failure; l++)
            prism(&b, v, step * (int32_t)l, step * (int32_t)(l + 1));
    }
    tc_cubeskin_finish(&skin);
    return status ? status : tc_builder_done(&b, err);
}

enum { promises = TC_SYNTH_POSITIVE | TC_SYNTH_SHAPELY | TC_SYNTH_CONFORMING | TC_SYNTH_CONVEX | TC_SYNTH_SIZED };

const tc_synth_generator tc_synth_graded = {20000, build, tc_field_linear, tc_cubeskin_chord, promises, 0};
