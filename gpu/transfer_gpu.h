/* transfer_gpu.h: chooses an integrator and keeps its textures for the transfer function in force. */
#ifndef TC_GPU_TRANSFER_GPU_H
#define TC_GPU_TRANSFER_GPU_H

#include "gpu/job.h"

typedef struct tc_transfer_gpu_request {
    const tc_transfer *transfer;
    const tc_transfer *pieces; /* set by tc_transfer_gpu_ensure: whose linear pieces stand for it */
    const tc_render_options *options;
    double scalar[2];  /* what the packed scalars 0 and 1 stand for */
    double length_max; /* longest segment in unit distances */
    const tc_pack_extent *extent;
    double length_unit; /* mesh space → unit distances */
    bool cell_data;
    bool pieces_only; /* an effect needs the function piece by piece */
    bool numbers;     /* what is made of it are not colours: knots are left out where nothing changes */
    int threads;
} tc_transfer_gpu_request;

typedef struct tc_transfer_gpu {
    tc_gpu_transfer textures;
    uint64_t serial;      /* of the transfer function uploaded; 0: none */
    tc_transfer *thin;    /* a function of fewer knots that stands for it in pieces */
    uint64_t thin_serial; /* of the function that it stands for */
    bool thin_numbers;    /* … for numbers */
    bool thinned;         /* its pieces are uploaded */
    bool numbers;         /* … of the one for numbers */
    tc_integrator integrator;
    tc_table_format format;
    int size[3]; /* of the table; nodes */
    int n_piece;
    bool steps;      /* in the pieces, or the means beside a table of floats */
    double rounding; /* of the integrals of extinction */
    double hard;     /* as tc_job's: pieces stand beside the nodes */
    int intervals;   /* of the means beside a table of floats */
    double scalar[2], length_max, span[2], mean[4];
    double most[3]; /* largest r, g, b of the function, for a table of floats */
} tc_transfer_gpu;

/* Builds and uploads what changed; sets job's integrator, extend, map, texel and mean. Errors: TC_E_ARG, TC_E_MEMORY,
 * TC_E_GL. */
tc_status tc_transfer_gpu_ensure(tc_transfer_gpu *transfer, tc_job *job, const tc_transfer_gpu_request *request,
                                 const tc_gl *gl, tc_render_stats *stats, tc_error *err);
void tc_transfer_gpu_finish(tc_transfer_gpu *transfer, const tc_gl *gl);

#endif
