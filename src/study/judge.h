/* judge.h: the errors of many pictures of one view. */
#ifndef TC_STUDY_JUDGE_H
#define TC_STUDY_JUDGE_H

#include "core/status.h"

typedef struct tc_judge tc_judge;

/* What a judge is made for; all borrowed for its life. */
typedef struct tc_judge_view {
    const tc_mesh *mesh;
    const tc_transfer *tf;
    const tc_camera *camera;
    const tc_render_options *options; /* size, unit distance, missing values */
    size_t n;                         /* pixels, chosen with seed; 0: all */
    uint64_t seed;
    int threads;
    const tc_log *log;
} tc_judge_view;

/* Errors: TC_E_ARG, TC_E_MEMORY. Cost: nothing before the first picture. */
tc_status tc_judge_create(tc_judge **out, const tc_judge_view *view, tc_error *err);
void tc_judge_destroy(tc_judge **judge);
/* Fills truth, pixels, ill_posed and the errors of row. By the ray through a pixel's middle: the reference colour of
 * each pixel is found once for all pictures. */
tc_status tc_judge_ray(tc_study_row *row, tc_judge *judge, const tc_image *image, tc_error *err);
/* By the mean of 8 x 8 rays over the pixel's area, of a 64th as many pixels. None is ill-posed. */
tc_status tc_judge_area(tc_study_row *row, tc_judge *judge, const tc_image *image, tc_error *err);

#endif
