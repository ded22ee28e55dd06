/* trace.h: one ray through all tets, inside the room. */
#ifndef TC_REFERENCE_TRACE_H
#define TC_REFERENCE_TRACE_H

#include "reference/bvh.h"
#include "reference/reference.h"

/* One more than the largest worker index of tc_parallel_for. */
enum { TC_REFERENCE_WORKERS = 256 };

/* The part of a ray inside one tet: distances from the ray's base in scaled units, scalars at both ends. */
typedef struct tc_hit {
    double t0, t1, s0, s1;
    uint32_t tet;
    uint8_t in, out; /* the faces at t0 and t1, by the rank of the corner opposite among the tet's ids */
    bool left;       /* face `in`, its corners by rank, runs counter-clockwise in the plane of u and v */
    bool flat;       /* for overlap.c: the cell has no volume */
} tc_hit;

typedef struct tc_meeting tc_meeting;       /* shapes.h */
typedef struct tc_look_ready tc_look_ready; /* look.h */

typedef struct tc_scratch {
    tc_hit *hit;
    size_t capacity;
    tc_meeting *meeting; /* [n_meeting] room */
    size_t n_meeting;
    char apart[128 - 2 * sizeof(void *) - 2 * sizeof(size_t)]; /* a cache line of one's own */
} tc_scratch;

struct tc_reference {
    const tc_mesh *mesh;
    /* Vertices are (x - center) * scale; scale is a power of two, so that the box's half diagonal lies in [0.5, 1). */
    double center[3], scale, half_diagonal; /* half_diagonal: scaled */
    double *vertex;                         /* [mesh->n_vertex][3] scaled */
    int32_t (*tet)[4];                      /* [bvh.n_item] vertex ids, ascending, in leaf order */
    tc_bvh bvh;                             /* order: ids of the mesh's tets */
    bool has_nan_color;
    double nan_color[4];
    int samples;         /* rays a pixel; 0: 1 */
    tc_look_ready *look; /* NULL: the plain density emitter */
    tc_scratch *scratch; /* [TC_REFERENCE_WORKERS] */
};

/* A ray in the scaled frame: base is its point nearest the centre, t is counted from there. */
typedef struct tc_line {
    double base[3], u[3], v[3], d[3]; /* orthonormal u, v, d */
    double t_min, t_max;              /* what is seen */
    double start;                     /* t of the origin that it was made with is -start */
    double unsure; /* overlapping runs: by how much their entries are moved against each other (overlap.c); 0 */
    double
        rounding;  /* each vertex is moved at random by up to this along each axis; 0. At most 1e-6: boxes are padded */
    uint32_t draw; /* which random moves */
    double data;   /* values of other fields are moved by this part of their range; 0 */
    bool whole;    /* every cell is a hit, whole: those of no length and those that are not seen too */
} tc_line;

void tc_line_init(tc_line *out, const tc_reference *reference, const double origin[3], const double direction[3],
                  const double range[2]);
/* As tc_reference_trace; shift is added to every scalar. */
tc_status tc_line_trace(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                        const tc_line *line, double shift, int worker);

/* Where a line passes a cell, uncut: depths t[0] <= t[1], but for rounding, and what each corner, by rank of its id,
 * weighs there. */
typedef struct tc_ends {
    int32_t id[4]; /* ascending */
    double t[2], weight[2][4];
} tc_ends;

/* line: the one that the hit was found with. Cost: that of asking a cell. */
void tc_line_ends(tc_ends *out, const tc_reference *reference, const tc_line *line, const tc_hit *hit);

/* Where a line meets a triangle: as with the faces of cells, one of two triangles with a common edge has it.
 *   vertex [][3] scaled; id [3] ascending; salt: tells vertices of different lists apart for tc_line.rounding */
bool tc_line_triangle(double *t, const tc_line *line, const double *vertex, const int32_t id[3], uint32_t salt);

/* Do hits in the order of entry reach into each other? Cost: O(n). */
bool tc_hits_overlap(const tc_hit *hit, size_t n);
/* Orders the hits of a whole line (tc_line.whole) as overlap.c says. unsure: runs are moved by up to this. False: no
 * memory. Cost: O(n log n). */
bool tc_hits_order(tc_hit *hit, size_t n, const tc_reference *reference, double unsure);

#endif
