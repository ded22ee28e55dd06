/* pack.c: the mesh as arrays for the GPU (design: "Record"). */
#include "gpu/pack.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/room.h"
#include "transfer_functions/place.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The corners of face f (opposite vertex f), counter-clockwise seen from outside a positive tet. */
static const int face_corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static void pack_cell(int32_t *out, const int32_t *tet, const int32_t *neighbour)
{
    int32_t sorted[4];
    out[0] = tet[0] ^ tet[1] ^ tet[2] ^ tet[3];
    for (int f = 0; f < 4; f++) {
        int rank = 0;
        for (int k = 0; k < 4; k++)
            rank += tet[f] > tet[k];
        sorted[rank] = neighbour[f] < 0 ? -1 : neighbour[f];
    }
    for (int k = 0; k < 3; k++)
        out[1 + k] = sorted[k] ^ sorted[3];
}

/* Vertices or cells that are one thread's at a time. What is summed up is summed by chunk, and the chunks in order, so
 * that nothing depends on the number of threads. */
enum { CHUNK = 16384 };

static size_t chunks_of(size_t n)
{
    return (n + CHUNK - 1) / CHUNK;
}

typedef struct box {
    double lo[3], hi[3];
} box;

/* What a chunk of cells adds to the extent. */
typedef struct share {
    tc_pack_extent extent; /* held: sums */
    double weight;
} share;

typedef struct work {
    tc_pack *pack;
    const tc_mesh *mesh;
    box *box;      /* of each chunk of vertices */
    share *share;  /* of each chunk of real cells */
    size_t *first; /* of each chunk of cells: how many open faces lie before it */
} work;

static void bound_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const work *j = context;
    box b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = begin; i < end; i++)
        for (int k = 0; k < 3; k++) {
            double x = j->mesh->vertex[3 * i + (size_t)k];
            b.lo[k] = x < b.lo[k] ? x : b.lo[k];
            b.hi[k] = x > b.hi[k] ? x : b.hi[k];
        }
    j->box[begin / CHUNK] = b;
}

static void find_frame(tc_pack *pack, const box *part, size_t n_part)
{
    double d2 = 0;
    for (int k = 0; k < 3; k++) {
        double lo = INFINITY, hi = -INFINITY;
        for (size_t i = 0; i < n_part; i++) {
            lo = fmin(lo, part[i].lo[k]);
            hi = fmax(hi, part[i].hi[k]);
        }
        pack->center[k] = 0.5 * lo + 0.5 * hi;
        d2 = hypot(d2, 0.5 * hi - 0.5 * lo);
    }
    pack->scale = d2 > 0 && isfinite(1 / d2) ? 1 / d2 : 1;
}

/* x mapped; NaN where it is not finite: march.glsl leaves out what it reaches. */
static float map_scalar(double x, double lo, double hi)
{
    return isfinite(x) ? (float)tc_place(x, lo, hi) : NAN;
}

/* map_scalar of n values; in lanes where the range is an ordinary one. */
static void map_scalars(float *out, const double *value, size_t n, double lo, double hi)
{
    const double width = hi - lo;
    if (!(width > 0) || !isfinite(width)) {
        for (size_t i = 0; i < n; i++)
            out[i] = map_scalar(value[i], lo, hi);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        float place = (float)((value[i] - lo) / width);
        out[i] = fabs(value[i]) <= DBL_MAX ? place : NAN;
    }
}

static void vertex_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const work *j = context;
    const tc_pack *pack = j->pack;
    const tc_mesh *mesh = j->mesh;
    bool has_scalar = mesh->association == TC_POINT_DATA && mesh->scalar;
    for (size_t i = begin; i < end; i++) {
        float *v = pack->vertex + 4 * i;
        for (int k = 0; k < 3; k++)
            v[k] = (float)((mesh->vertex[3 * i + (size_t)k] - pack->center[k]) * pack->scale);
        v[3] = has_scalar ? map_scalar(mesh->scalar[i], pack->scalar_lo, pack->scalar_hi) : 0;
    }
}

enum { LEVELS = 7 }; /* runs of 1, 2, … 64 bins */
_Static_assert(1 << (LEVELS - 1) == TC_PACK_BINS, "the longest run is all bins");

/* The longest run within 1, 2, … bins. */
static const unsigned char level_of[TC_PACK_BINS] = {
    0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5,
    5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5, 6,
};

/* An extent in the making. What a cell says of the bins between its least and its greatest scalar costs the same
 * however many they are: two runs of 2^k bins that cover them hold the maxima, and `step` says where whole bins begin
 * and end. */
typedef struct gather {
    float edge[LEVELS][TC_PACK_BINS], edge_range[LEVELS][TC_PACK_BINS]; /* of the run that starts at a bin */
    double held[TC_PACK_BINS], step[TC_PACK_BINS + 1], weight;
} gather;

static float larger(float a, float b)
{
    return a > b ? a : b;
}

static float smaller(float a, float b)
{
    return a < b ? a : b;
}

/* Branches, for few are larger. */
static void gather_run(gather *g, int level, int bin, float edge, float edge_range)
{
    if (edge > g->edge[level][bin])
        g->edge[level][bin] = edge;
    if (edge_range > g->edge_range[level][bin])
        g->edge_range[level][bin] = edge_range;
}

/* Some cells side by side, so that one instruction serves several. */
enum { LANES = 64 };

typedef struct lanes {
    float vertex[4][LANES][4];                           /* x, y, z and scalar of each corner */
    float square[LANES], edge[LANES], edge_range[LANES]; /* of the longest edge; NaN: a scalar is not finite */
    float before[LANES], after[LANES]; /* how far into its first and last bin a cell's scalars reach */
    int32_t first[LANES], last[LANES]; /* these bins */
} lanes;

/* A cell of the bins first … last. */
static void gather_cell(gather *g, const lanes *l, size_t c)
{
    int first = l->first[c], last = l->last[c], level = level_of[last - first];
    float edge = l->edge[c], edge_range = l->edge_range[c];
    double weight = l->square[c];
    g->weight += weight;
    gather_run(g, level, first, edge, edge_range);
    if (first == last) {
        g->held[first] += weight * (double)(l->after[c] - l->before[c]);
        return;
    }
    gather_run(g, level, last + 1 - (1 << level), edge, edge_range);
    g->held[first] += weight * (double)(1 - l->before[c]);
    g->held[last] += weight * (double)l->after[c];
    g->step[first + 1] += weight;
    g->step[last] -= weight;
}

/* Each run's maxima onto its two halves, down to single bins. */
static void gather_finish(tc_pack_extent *out, gather *g)
{
    for (int level = LEVELS - 1; level > 0; level--)
        for (int b = 0; b + (1 << level) <= TC_PACK_BINS; b++)
            for (int half = 0; half < 2; half++)
                gather_run(g, level - 1, b + half * (1 << (level - 1)), g->edge[level][b], g->edge_range[level][b]);
    double whole = 0;
    for (int b = 0; b < TC_PACK_BINS; b++) {
        whole += g->step[b];
        out->edge[b] = g->edge[0][b];
        out->edge_range[b] = g->edge_range[0][b];
        out->held[b] = g->held[b] + (whole > 0x1p-40 * g->weight ? whole : 0); /* less is rounding */
    }
}

static void load_lanes(lanes *l, const float *vertex, const int32_t *tet, size_t n)
{
    for (size_t c = 0; c < n; c++)
        for (int i = 0; i < 4; i++)
            memcpy(l->vertex[i][c], vertex + 4 * (size_t)tet[4 * c + (size_t)i], sizeof l->vertex[i][c]);
}

static void measure_edges(lanes *l)
{
    memset(l->square, 0, sizeof l->square);
    for (int i = 1; i < 4; i++)
        for (int j = 0; j < i; j++)
            for (int c = 0; c < LANES; c++) {
                const float *p = l->vertex[i][c], *q = l->vertex[j][c];
                float x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2], square = x * x + y * y + z * z;
                l->square[c] = larger(square, l->square[c]);
            }
    for (int c = 0; c < LANES; c++)
        l->edge[c] = sqrtf(l->square[c]);
}

/* The bins of cells with scalars from lo to hi, both numbers. */
static void place_lanes(lanes *l, const float lo[LANES], const float hi[LANES])
{
    for (int c = 0; c < LANES; c++) {
        float from = lo[c] * TC_PACK_BINS, to = hi[c] * TC_PACK_BINS;
        int32_t first = (int32_t)from, last = (int32_t)to;
        l->first[c] = first < TC_PACK_BINS ? first : TC_PACK_BINS - 1;
        l->last[c] = last < TC_PACK_BINS ? last : TC_PACK_BINS - 1;
        l->before[c] = from - (float)l->first[c];
        l->after[c] = to - (float)l->last[c];
    }
}

static void measure_vertex_values(lanes *l)
{
    float lo[LANES], hi[LANES];
    for (int c = 0; c < LANES; c++) {
        float s[4] = {l->vertex[0][c][3], l->vertex[1][c][3], l->vertex[2][c][3], l->vertex[3][c][3]};
        float least = smaller(smaller(s[0], s[1]), smaller(s[2], s[3]));
        float most = larger(larger(s[0], s[1]), larger(s[2], s[3]));
        float unknown = (s[0] + s[1] + s[2] + s[3]) * 0; /* 0, or NaN */
        l->edge_range[c] = l->edge[c] * (most - least) + unknown;
        lo[c] = larger(least, 0); /* a number in any case */
        hi[c] = larger(most, 0);
    }
    place_lanes(l, lo, hi); /* apart, so that no branch keeps the compiler from lanes */
}

static void measure_cell_values(lanes *l, const float *value, size_t n)
{
    float at[LANES] = {0};
    for (size_t c = 0; c < n; c++) {
        l->edge_range[c] = value[c] * 0; /* 0, or NaN */
        at[c] = larger(value[c], 0);
    }
    place_lanes(l, at, at);
}

/* Values of cells, and what each chunk adds to the extent. */
static void extent_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const work *j = context;
    const tc_pack *pack = j->pack;
    share *s = &j->share[begin / CHUNK];
    gather g = {0};
    lanes l = {0};
    for (size_t i = begin; i < end; i += LANES) {
        size_t n = end - i < LANES ? end - i : LANES;
        load_lanes(&l, pack->vertex, j->mesh->tet + 4 * i, n);
        measure_edges(&l);
        if (pack->cell_scalar) {
            map_scalars(pack->cell_scalar + i, j->mesh->scalar + i, n, pack->scalar_lo, pack->scalar_hi);
            measure_cell_values(&l, pack->cell_scalar + i, n);
        } else {
            measure_vertex_values(&l);
        }
        for (size_t c = 0; c < n; c++)
            if (!isnan(l.edge_range[c]))
                gather_cell(&g, &l, c);
    }
    gather_finish(&s->extent, &g);
    s->weight = g.weight;
}

static void sum_extent(tc_pack_extent *out, const share *part, size_t n_part)
{
    double weight = 0;
    for (size_t i = 0; i < n_part; i++) {
        weight += part[i].weight;
        for (int b = 0; b < TC_PACK_BINS; b++) {
            out->edge[b] = fmaxf(out->edge[b], part[i].extent.edge[b]);
            out->edge_range[b] = fmaxf(out->edge_range[b], part[i].extent.edge_range[b]);
            out->held[b] += part[i].extent.held[b];
        }
    }
    for (int b = 0; b < TC_PACK_BINS; b++)
        out->held[b] = weight > 0 ? out->held[b] / weight : 0;
}

/* Writes an open face's corners, the least by place first: two open faces at one place, as where cells overlap, then
 * give a ray the same depth to the last bit, and not its rounding but their numbers tell which is entered first. */
static void pack_face(int32_t *face, float *corner, const tc_pack *pack, const int32_t *tet, int f)
{
    int first = 0;
    const float *at[3];
    for (int k = 0; k < 3; k++)
        at[k] = pack->vertex + 4 * (size_t)tet[face_corner[f][k]];
    for (int k = 1; k < 3; k++) {
        const float *p = at[k], *q = at[first];
        if (p[0] != q[0] ? p[0] < q[0] : p[1] != q[1] ? p[1] < q[1] : p[2] < q[2])
            first = k;
    }
    for (int k = 0; k < 3; k++) {
        int from = (first + k) % 3;
        face[k] = tet[face_corner[f][from]];
        memcpy(corner + 3 * k, at[from], 3 * sizeof *corner);
    }
}

static void count_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const work *j = context;
    size_t n = 0;
    for (size_t i = 4 * begin; i < 4 * end; i++)
        n += j->mesh->neighbour[i] < 0;
    j->first[begin / CHUNK] = n;
}

static void cell_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const work *j = context;
    tc_pack *pack = j->pack;
    int32_t *face = pack->face + TC_PACK_FACE_INTS * j->first[begin / CHUNK];
    float *corner = pack->face_corner + 9 * j->first[begin / CHUNK];
    for (size_t i = begin; i < end; i++) {
        const int32_t *tet = j->mesh->tet + 4 * i, *neighbour = j->mesh->neighbour + 4 * i;
        pack_cell(pack->cell + TC_PACK_CELL_INTS * i, tet, neighbour);
        for (int f = 0; f < 4; f++)
            if (neighbour[f] < 0) {
                pack_face(face, corner, pack, tet, f);
                corner += 9;
                face[3] = (int32_t)i;
                face += TC_PACK_FACE_INTS;
            }
    }
}

static tc_status check_mesh(const tc_mesh *mesh, tc_error *err)
{
    size_t n = mesh->n_tet + mesh->n_imaginary;
    if (!mesh->prepared || !mesh->neighbour)
        return tc_fail(err, TC_E_ARG, "the mesh was not prepared; call tc_mesh_prepare first");
    if (n > INT32_MAX)
        return tc_fail(err, TC_E_MESH, "%zu cells are more than this version can address (%d)", n, INT32_MAX);
    return TC_OK;
}

tc_status tc_pack_scalars(tc_pack *out, const tc_mesh *mesh, int threads, tc_error *err)
{
    memset(out, 0, sizeof *out);
    tc_status status = check_mesh(mesh, err);
    if (status != TC_OK)
        return status;
    double start = tc_now_ms();
    bool cell_data = mesh->association == TC_CELL_DATA && mesh->scalar;
    size_t vertex_chunks = chunks_of(mesh->n_vertex), cell_chunks = chunks_of(mesh->n_tet);
    out->n_cell = mesh->n_tet + mesh->n_imaginary;
    out->n_real = mesh->n_tet;
    out->n_vertex = mesh->n_vertex;
    out->scalar_lo = mesh->report.scalar_range[0];
    out->scalar_hi = mesh->report.scalar_range[1];
    out->vertex = tc_alloc(mesh->n_vertex, TC_PACK_VERTEX_FLOATS * sizeof *out->vertex);
    out->cell_scalar = cell_data ? tc_alloc(mesh->n_tet, sizeof *out->cell_scalar) : NULL;
    work j = {.pack = out,
              .mesh = mesh,
              .box = tc_alloc(vertex_chunks, sizeof *j.box),
              .share = tc_calloc(cell_chunks, sizeof *j.share)};
    if (!out->vertex || (cell_data && !out->cell_scalar) || !j.box || !j.share) {
        tc_pack_finish(out);
        status = tc_fail_memory(err, "the packed values", mesh->n_vertex * 4 + mesh->n_tet, sizeof(float));
    } else {
        tc_parallel_for(mesh->n_vertex, CHUNK, threads, bound_range, &j);
        find_frame(out, j.box, vertex_chunks);
        tc_parallel_for(mesh->n_vertex, CHUNK, threads, vertex_range, &j);
        tc_parallel_for(mesh->n_tet, CHUNK, threads, extent_range, &j);
        sum_extent(&out->extent, j.share, cell_chunks);
        out->ms = tc_now_ms() - start;
    }
    free(j.box);
    free(j.share);
    return status;
}

tc_status tc_pack_build(tc_pack *out, const tc_mesh *mesh, int threads, tc_error *err)
{
    memset(out, 0, sizeof *out);
    tc_status status = tc_room_check(2 * (16 * (mesh->n_tet + mesh->n_imaginary) + 16 * mesh->n_vertex), err,
                                     "rendering %zu cells", mesh->n_tet + mesh->n_imaginary); /* GL copies it */
    if (status == TC_OK)
        status = tc_pack_scalars(out, mesh, threads, err);
    if (status != TC_OK)
        return status;
    double start = tc_now_ms();
    size_t n = out->n_cell, n_chunk = chunks_of(n), faces = 0;
    work j = {.pack = out, .mesh = mesh, .first = tc_alloc(n_chunk, sizeof *j.first)};
    if (j.first)
        tc_parallel_for(n, CHUNK, threads, count_range, &j);
    for (size_t i = 0; j.first && i < n_chunk; i++) {
        size_t count = j.first[i];
        j.first[i] = faces;
        faces += count;
    }
    out->n_face = faces;
    out->cell = tc_alloc(n, TC_PACK_CELL_INTS * sizeof *out->cell);
    out->face = tc_alloc(faces, TC_PACK_FACE_INTS * sizeof *out->face);
    out->face_corner = tc_alloc(faces, 9 * sizeof *out->face_corner);
    if (!j.first || !out->cell || !out->face || !out->face_corner) {
        tc_pack_finish(out);
        status = tc_fail_memory(err, "the packed mesh", n, TC_PACK_CELL_INTS * sizeof *out->cell);
    } else {
        tc_parallel_for(n, CHUNK, threads, cell_range, &j);
        out->ms += tc_now_ms() - start;
    }
    free(j.first);
    return status;
}

void tc_pack_finish(tc_pack *pack)
{
    free(pack->cell);
    free(pack->vertex);
    free(pack->face);
    free(pack->face_corner);
    free(pack->cell_scalar);
    memset(pack, 0, sizeof *pack);
}
