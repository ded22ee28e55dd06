/* tetcast_probe.h: what the values of a mesh are: how often each comes, which lie in the picture, which a ray meets. Included by
 * tetcast.h. All of it is found on the CPU; nothing here needs GL. */
#ifndef TETCAST_PROBE_H
#define TETCAST_PROBE_H

#ifndef TETCAST_H
#error "include tetcast.h, which includes this file"
#endif

/* What to count, zero-initialised. */
typedef struct tc_histogram_options {
    int n;             /* bins; 0: 256; at most 65536 */
    bool has_range;    /* else the finite range of what is counted */
    double range[2];   /* lo < hi */
    bool log;          /* bins even in the logarithm; values of 0 and less lie below */
    bool by_volume;    /* values weigh what their cells' volume is, a point's a quarter of each cell it is a corner of; else 1 each */
    const tc_camera *camera; /* only what is in this picture: points before the eye, within its clipping range, that project into it; of cell data
                                the cells' middles. NULL: all */
    double aspect;           /* of the picture, width / height */
    int threads;             /* 0: all cores; the result is the same bit by bit */
} tc_histogram_options;

typedef struct tc_histogram {
    int n;
    double range[2];
    bool log;
    double *weight;            /* [n]; a value at range[1] is in the last */
    double most, total;        /* of the bins: the largest, the sum */
    double below, above;       /* weight of finite values outside */
    uint64_t counted, missing; /* values, of which so many are not finite and in no bin */
} tc_histogram;

/* Of the mesh's scalar. The mesh must be prepared. Errors: TC_E_ARG (n, range, a log of nothing above 0: says which), TC_E_MEMORY. Cost:
 * O(vertices) or O(tets), by_volume both. */
TC_API tc_status tc_mesh_histogram(tc_histogram **out, const tc_mesh *mesh, const tc_histogram_options *options, tc_error *err);
TC_API void tc_histogram_destroy(tc_histogram **histogram);
/* The value below which the share (0 to 1) of the weight in the bins lies, linear within its bin; NaN of no weight. */
TC_API double tc_histogram_percentile(const tc_histogram *histogram, double share);

/* A part of a ray within one cell. */
typedef struct tc_probe_part {
    double depth[2];     /* along the ray, from the eye (parallel: from the eye's plane); where it enters and leaves */
    double scalar[2];    /* there; NaN: not finite */
    double transmittance;/* that is left behind it, of what lies before; 1 where no function was given */
} tc_probe_part;

typedef struct tc_probe {
    size_t n;
    tc_probe_part *part; /* [n], by depth; gaps of the mesh are gaps between them */
    double origin[3], direction[3]; /* unit */
    double opacity;      /* of all of it */
    double picked;       /* depth at which half of that is reached; NaN: nothing is seen */
} tc_probe;

/* What the ray through the middle of pixel (x, y), y from the top, of a picture of width x height meets, within the camera's clipping range.
 * tf may be NULL. unit_distance 0: the mesh's default. The mesh must be prepared. Errors: TC_E_ARG, TC_E_MEMORY. Cost: every cell is looked
 * at once, by all cores: 1 ms for 200 000. */
TC_API tc_status tc_mesh_probe(tc_probe **out, const tc_mesh *mesh, const tc_transfer *tf, double unit_distance, const tc_camera *camera, int width,
                               int height, int x, int y, tc_error *err);
TC_API void tc_probe_destroy(tc_probe **probe);

#endif
