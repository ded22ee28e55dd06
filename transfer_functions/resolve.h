/* resolve.h: from a colour map and an opacity curve to the knots of a piecewise linear function. */
#ifndef TC_TRANSFER_FUNCTIONS_RESOLVE_H
#define TC_TRANSFER_FUNCTIONS_RESOLVE_H

#include "transfer_functions/preset.h"

/* Attenuation over the place u in [0, 1] within the range (the logarithm's place when log). A = 0.3. */
typedef enum tc_opacity_kind {
    TC_OPACITY_POINTS = 0, /* points, their first to last x laid over the range */
    TC_OPACITY_SCALARS,    /* points whose x are scalars themselves */
    TC_OPACITY_GEOM,       /* A (1e-6 / 255)^(1 - u): PyVista's "geom" */
    TC_OPACITY_SIGMOID     /* A / (1 + exp(-20 (u - 1/2))): PyVista's "sigmoid" */
} tc_opacity_kind;

typedef struct tc_resolve_input {
    const tc_preset *map; /* its opacity points are not looked at */
    tc_opacity_kind kind;
    size_t n_opacity;
    const tc_opacity_point *opacity; /* [n_opacity], x non-decreasing */
    double range[2];                 /* finite, range[0] < range[1]; > 0 when log */
    bool log;
} tc_resolve_input;

/* Knots (owned by the caller, free) that follow both with at most 1e-4 deviation of any colour channel, and of
 * attenuation where that is at most 1 (else 1e-4 of its largest). Errors: TC_E_MEMORY. Cost: O(points + knots). */
tc_status tc_resolve(tc_knot **knot, size_t *n, const tc_resolve_input *input, tc_error *err);

#endif
