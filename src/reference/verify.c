/* verify.c: compares pixels of a picture with the reference, once. */
#include "reference/trace.h"
#include "reference/truth.h"

#include <string.h>

/* Tracing and judging as one progress, half each. */
typedef struct halves {
    const tc_log *log;
    double done;
} halves;

static void pass_half(void *user, const char *what, double fraction)
{
    const halves *h = user;
    (void)what;
    tc_progress(h->log, "verify", h->done + 0.5 * fraction);
}

tc_status tc_reference_verify(tc_verify_result *out, tc_image *errors, const tc_image *image, size_t n, uint64_t seed,
                              const tc_reference *reference, const tc_transfer *tf, double unit, const tc_rays *rays,
                              int threads, const tc_log *log, tc_error *err)
{
    halves h = {.log = log};
    const tc_log half = {.progress = pass_half, .user = &h};
    const tc_truth_view view = {.reference = reference,
                                .tf = tf,
                                .unit = unit,
                                .rays = rays,
                                .n = n,
                                .seed = seed,
                                .samples = reference->samples,
                                .threads = threads,
                                .log = &half};
    memset(out, 0, sizeof *out);
    if (image->width != rays->width || image->height != rays->height)
        return tc_fail(err, TC_E_ARG, "the image has %d x %d pixels but the camera was set up for %d x %d",
                       image->width, image->height, rays->width, rays->height);
    tc_truth *truth;
    tc_status status = tc_truth_create(&truth, &view, err);
    if (status != TC_OK)
        return status;
    h.done = 0.5;
    status = tc_truth_compare(out, errors, truth, image, err);
    tc_truth_destroy(&truth);
    if (status == TC_OK)
        tc_progress(log, "verify", 1);
    return status;
}
