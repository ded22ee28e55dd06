/* tetcast_probe.h: what the values of a mesh are: how often each comes, which lie in the picture, which a ray meets.
 * Included by tetcast.h. All of it is found on the CPU; nothing here needs GL. */
#ifndef TETCAST_PROBE_H
#define TETCAST_PROBE_H

#ifndef TETCAST_H
#error "include tetcast.h, which includes this file"
#endif

/* What to count, zero-initialised. */
typedef struct tc_histogram_options {
    int n;           /* bins; 0: 256; at most 65536 */
    bool has_range;  /* else the finite range of what is counted; log: from the least value above 0 */
    double range[2]; /* lo < hi */
    bool log;        /* bins even in the logarithm; values of 0 and less lie below */
    bool by_volume;  /* values weigh what their cells' volume is, a point's a quarter of each cell it is a corner of;
                        else 1 each */
    const tc_camera *camera; /* only what is in this picture: points before the eye, within its clipping range, that
                                project into it; of cell data the cells' middles. NULL: all */
    double aspect;           /* of the picture, width / height; above 0 where there is a camera */
    int threads;             /* 0: all cores; the result is the same bit by bit */
} tc_histogram_options;

typedef struct tc_histogram {
    int n;
    double range[2]; /* that was taken: lo = hi where all values are one, 0 and 0 where there is none */
    bool log;
    double *weight;            /* [n]; a value at range[1] is in the last */
    double most, total;        /* of the bins: the largest, the sum */
    double below, above;       /* weight of finite values outside */
    uint64_t counted, missing; /* values, of which so many are not finite and in no bin */
} tc_histogram;

/* Of the mesh's scalar, in its real cells. The mesh must be prepared. tc_histogram_destroy ends it.
 * Errors: TC_E_ARG (the mesh, n, range, aspect, the camera as of tc_render, a log of nothing above 0: says which),
 * TC_E_MEMORY. Cost: O(vertices) or O(tets), by_volume both, by all cores; up to 64 times n doubles. */
TC_API tc_status tc_mesh_histogram(tc_histogram **out, const tc_mesh *mesh, const tc_histogram_options *options,
                                   tc_error *err);
TC_API void tc_histogram_destroy(tc_histogram **histogram);
/* The value below which the share (0 to 1, others are moved to these) of the weight in the bins lies, linear within its
 * bin: of 0 where the first bin with weight begins, of 1 where the last ends. NaN of no weight, and of a NaN.
 * Cost: O(n). */
TC_API double tc_histogram_percentile(const tc_histogram *histogram, double share);

/* A part of a ray within one cell. */
typedef struct tc_probe_part {
    double depth[2];      /* along the ray, from tc_probe.origin; where it enters and leaves, depth[0] < depth[1] */
    double scalar[2];     /* there; both NaN: a value of the cell is not finite, and the part is taken for clear */
    double transmittance; /* of all parts up to the end of this one; 1 where no function was given */
} tc_probe_part;

typedef struct tc_probe {
    size_t n;
    tc_probe_part *part; /* [n], by depth: a part begins at the very depth at which the one before it ends, unless there
                            is a gap between them; where cells overlap parts do, by depth[0] */
    double origin[3], direction[3]; /* the eye, in parallel projection the ray's point in the eye's plane; unit */
    double opacity;                 /* of all of it, 0 where no function was given */
    double picked;                  /* depth at which half of that is reached; NaN: nothing is seen */
} tc_probe;

/* What the ray through the middle of pixel (x, y), y from the top, of a picture of width x height meets of the real
 * cells, within the camera's clipping range. It goes where tc_render's ray goes, through edges and vertices, too; what
 * a tc_look adds or cuts is not looked at. tf may be NULL. unit_distance 0: the mesh's default. The mesh must be
 * prepared. tc_probe_destroy ends it. Depths and scalars are of double precision, opacity is exact for these.
 * Errors: TC_E_ARG (the mesh, a pixel outside, the unit distance, the camera), TC_E_MEMORY.
 * Cost: every cell is looked at once, by all cores: 1 ms for 200 000; a byte a vertex. */
TC_API tc_status tc_mesh_probe(tc_probe **out, const tc_mesh *mesh, const tc_transfer *tf, double unit_distance,
                               const tc_camera *camera, int width, int height, int x, int y, tc_error *err);
TC_API void tc_probe_destroy(tc_probe **probe);

#endif
