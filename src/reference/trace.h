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
} tc_hit;

typedef struct tc_scratch {
    tc_hit *hit;
    size_t capacity;
    char apart[128 - sizeof(tc_hit *) - sizeof(size_t)]; /* a cache line of one's own */
} tc_scratch;

struct tc_reference {
    const tc_mesh *mesh;
    /* Vertices are (x - center) * scale; scale is a power of two, so that the box's half diagonal lies in [0.5, 1). */
    double center[3], scale, half_diagonal; /* half_diagonal: scaled */
    double *vertex;                         /* [mesh->n_vertex][3] scaled */
    int32_t (*tet)[4];                      /* [bvh.n_item] vertex ids, ascending, in leaf order */
    tc_bvh bvh;                             /* order: ids of the mesh's tets */
    tc_scratch *scratch;                    /* [TC_REFERENCE_WORKERS] */
};

/* A ray in the scaled frame: base is its point nearest the centre, t is counted from there. */
typedef struct tc_line {
    double base[3], u[3], v[3], d[3]; /* orthonormal u, v, d */
    double t_min;
} tc_line;

void tc_line_init(tc_line *out, const tc_reference *reference, const double origin[3], const double direction[3],
                  double t_min);
/* As tc_reference_trace; shift is added to every scalar. */
tc_status tc_line_trace(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                        const tc_line *line, double shift, int worker);

#endif
