/* trial.h: measures candidates: errors over rays of a few views, frame times, and the error of one whole picture. */
#ifndef TC_STUDY_TRIAL_H
#define TC_STUDY_TRIAL_H

#include "reference/truth.h"
#include "study/candidate.h"

/* What is measured on; all borrowed but what is below the line. */
typedef struct tc_trial {
    tc_renderer *renderer;
    const tc_mesh *mesh;
    const tc_transfer *tf;
    const tc_camera *camera;
    const tc_render_options *fixed; /* as the caller gave them; size and samples of the picture */
    size_t verify;                  /* pixels of the picture that are traced again */
    uint64_t seed;
    int threads;
    const tc_log *log;
    /* made when first needed; tc_trial_finish frees it */
    tc_reference *reference;
    tc_truth *truth;  /* of those pixels */
    tc_image *finest; /* the picture of the exact integrator */
} tc_trial;

void tc_trial_finish(tc_trial *trial);

/* The error of each candidate: largest difference of a channel from the reference over the rays of three small pictures
 * (trial's camera, and the whole mesh from two directions across it), ill-posed rays left out. What cannot be rendered
 * gets INFINITY. *rays: number of rays looked at. Errors: TC_E_MEMORY, TC_E_LOST, TC_E_CANCEL; where no candidate can
 * be rendered, what tc_render said. */
tc_status tc_trial_errors(tc_candidate *candidate, size_t n, size_t *rays, tc_trial *trial, tc_error *err);

/* The frame time of the m candidates in index at trial's camera, size and samples: median of five frames, interleaved,
 * so that what else the machine does hits all alike, after one to warm up. What takes twice as long as the fastest gets
 * fewer frames. Errors: as tc_render. */
tc_status tc_trial_times(tc_candidate *candidate, const size_t *index, size_t m, tc_trial *trial, tc_error *err);

typedef struct tc_trial_check {
    tc_verify_result verify; /* sampled pixels */
    size_t suspects;
    double suspect, error; /* largest error of suspects, and of both */
    double ms;             /* median of three frames; of one where that takes more than a second */
} tc_trial_check;

/* The picture of a candidate: an error over trial->verify of its pixels, and with `suspects` over those of all that
 * differ most from the exact integrator's picture. Errors: as tc_render and tc_verify. */
tc_status tc_trial_picture(tc_trial_check *out, const tc_candidate *candidate, bool suspects, tc_trial *trial,
                           tc_error *err);

#endif
