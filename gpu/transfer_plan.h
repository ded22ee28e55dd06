/* transfer_plan.h: which integrator a picture is made with, and how finely, from what is known of function and mesh. */
#ifndef TC_GPU_TRANSFER_PLAN_H
#define TC_GPU_TRANSFER_PLAN_H

#include "gpu/transfer_gpu.h"

typedef struct tc_transfer_plan {
    tc_integrator integrator;       /* TABLE, INTEGRAL or EXACT */
    double span[2];                 /* scalars that nodes, pieces or entries span */
    int nodes;                      /* INTEGRAL */
    bool dense, twice;              /* as tc_job has them */
    int order;                      /* INTEGRAL: 1 or 2 */
    double split, hard, hard_depth; /* INTEGRAL, as tc_job has them */
} tc_transfer_plan;

/* why [capacity] gets the reason, or stays as it is where the caller asked for it. Errors: TC_E_ARG (EXACT for more
 * knots than can be integrated one by one). Cost: O(knots x TC_PACK_BINS). */
tc_status tc_transfer_plan_make(tc_transfer_plan *out, char *why, size_t capacity,
                                const tc_transfer_gpu_request *request, tc_error *err);

#endif
