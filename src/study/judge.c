/* judge.c: the truth of one view, found once for many pictures. */
#include "study/judge.h"

#include "core/memory.h"
#include "reference/truth.h"
#include "study/summary.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 4, AREA_RAYS = 64 }; /* a pixel, 8 x 8: twice as fine as the finest sampling, at none of its places */
/* Rays that err by more are asked whether they are ill-posed. Of those that err by more than DOUBT, far below any
 * bound, as many as decide which one errs most. */
static const double ASKED = 1.0 / 1020, DOUBT = 1e-5;
/* Asking whether a ray is ill-posed takes 19 rays. Of a picture that errs everywhere only the worst share is asked:
 * more would change neither its largest error nor its percentiles to speak of. */
enum { ASKED_LEAST = 256, ASKED_SHARE = 100, ASKED_NEXT = 8 };

typedef enum known { UNKNOWN = 0, WELL_POSED, ILL_POSED } known;

struct tc_judge {
    tc_judge_view view;
    tc_rays rays;
    double unit;
    tc_reference *reference;
    tc_truth *ray, *area; /* NULL before the first picture */
    unsigned char *known; /* [pixels of ray] what is known of each */
};

/* A pixel's error in one picture. */
typedef struct ranked {
    double error;
    uint32_t index; /* in the truth's list */
} ranked;

tc_status tc_judge_create(tc_judge **out, const tc_judge_view *view, tc_error *err)
{
    const tc_render_options *o = view->options;
    *out = NULL;
    tc_judge *j = tc_calloc(1, sizeof *j);
    if (!j)
        return tc_fail_memory(err, "the truth of a view", 1, sizeof *j);
    j->view = *view;
    j->unit = o->unit_distance > 0 ? o->unit_distance : tc_default_unit_distance(view->mesh);
    tc_status status = tc_rays_from_camera(&j->rays, view->camera, o->width, o->height, err);
    if (status == TC_OK)
        status = tc_reference_create(&j->reference, view->mesh, view->threads, err);
    if (status != TC_OK) {
        tc_judge_destroy(&j);
        return status;
    }
    tc_reference_set_nan_color(j->reference, o->has_nan_color ? o->nan_color : NULL);
    status = tc_reference_set_look(j->reference, o->look, err);
    if (status != TC_OK)
        tc_judge_destroy(&j);
    *out = j;
    return status;
}

void tc_judge_destroy(tc_judge **judge)
{
    tc_judge *j = *judge;
    if (!j)
        return;
    tc_truth_destroy(&j->ray);
    tc_truth_destroy(&j->area);
    tc_reference_destroy(&j->reference);
    free(j->known);
    free(j);
    *judge = NULL;
}

/* A truth of n pixels, drawn or listed, with that many rays each. */
static tc_status make_truth(tc_truth **out, const tc_judge *j, const uint32_t *pixel, size_t n, int rays, bool ask,
                            tc_error *err)
{
    const tc_judge_view *v = &j->view;
    const tc_truth_view view = {.reference = j->reference,
                                .tf = v->tf,
                                .unit = j->unit,
                                .rays = &j->rays,
                                .pixel = pixel,
                                .n = n,
                                .seed = v->seed,
                                .samples = rays,
                                .no_judge = !ask,
                                .doubt = DOUBT,
                                .threads = v->threads,
                                .log = v->log};
    return tc_truth_create(out, &view, err);
}

static size_t pixels_asked_for(const tc_judge *j)
{
    const size_t all = (size_t)j->rays.width * (size_t)j->rays.height;
    return j->view.n > 0 && j->view.n < all ? j->view.n : all;
}

/* Errors of all channels, and the largest of each pixel. */
static void find_errors(double *error, ranked *pixel, const tc_truth *truth, const tc_image *image)
{
    const uint32_t *at = tc_truth_pixels(truth);
    for (size_t k = 0, n = tc_truth_count(truth); k < n; k++) {
        const double *color = tc_truth_color(truth, k);
        pixel[k] = (ranked){0, (uint32_t)k};
        for (size_t c = 0; c < CHANNELS; c++) {
            double value = image->rgba[CHANNELS * (size_t)at[k] + c];
            error[CHANNELS * k + c] = isfinite(value) ? fabs(value - color[c]) : FLT_MAX;
            pixel[k].error = fmax(pixel[k].error, error[CHANNELS * k + c]);
        }
    }
}

static int worst_first(const void *a, const void *b)
{
    const ranked *x = a, *y = b;
    return x->error != y->error ? (x->error < y->error) - (x->error > y->error)
                                : (x->index > y->index) - (x->index < y->index);
}

/* Asks the reference about those of pixel [n] of which nothing is known yet. */
static tc_status ask(tc_judge *j, const ranked *pixel, size_t n, const tc_image *image, tc_error *err)
{
    tc_truth *truth = NULL;
    tc_image *errors = NULL;
    tc_verify_result result;
    size_t m = 0;
    const uint32_t *at = tc_truth_pixels(j->ray);
    uint32_t *list = tc_alloc(n, sizeof *list), *index = tc_alloc(n, sizeof *index);
    tc_status status = list && index ? TC_OK : tc_fail_memory(err, "pixels", n, sizeof *list);
    for (size_t i = 0; i < n && status == TC_OK; i++)
        if (j->known[pixel[i].index] == UNKNOWN) {
            index[m] = pixel[i].index;
            list[m++] = at[pixel[i].index];
        }
    if (status == TC_OK && m > 0) {
        status = tc_image_create(&errors, image->width, image->height, err);
        if (status == TC_OK)
            status = make_truth(&truth, j, list, m, 1, true, err);
        if (status == TC_OK)
            status = tc_truth_compare(&result, errors, truth, image, err);
        for (size_t i = 0; i < m && status == TC_OK; i++) /* alpha 0.5: ill-posed */
            j->known[index[i]] = errors->rgba[CHANNELS * (size_t)list[i] + 3] < 0.75f ? ILL_POSED : WELL_POSED;
    }
    tc_truth_destroy(&truth);
    tc_image_destroy(&errors);
    free(list);
    free(index);
    return status;
}

/* Leaves ill-posed pixels out of error: gives how many channels are left. */
static size_t leave_out(tc_study_row *row, double *error, const tc_judge *j, const ranked *asked, size_t n_asked,
                        size_t n)
{
    for (size_t i = 0; i < n_asked; i++) {
        if (j->known[asked[i].index] != ILL_POSED)
            continue;
        row->ill_posed++;
        row->ill_posed_error =
            isnan(row->ill_posed_error) ? asked[i].error : fmax(row->ill_posed_error, asked[i].error);
        for (size_t c = 0; c < CHANNELS; c++)
            error[CHANNELS * asked[i].index + c] = -1;
    }
    size_t left = 0;
    for (size_t i = 0; i < CHANNELS * n; i++)
        if (error[i] >= 0)
            error[left++] = error[i];
    return left;
}

static void reduce(tc_study_row *row, double *error, size_t n)
{
    double sum = 0;
    if (n == 0)
        return;
    for (size_t i = 0; i < n; i++)
        sum += error[i];
    row->mean_error = sum / (double)n;
    row->max_error = tc_percentile(error, n, 1); /* sorts */
    row->p9999_error = error[n - 1 - (n - 1) / 10000];
    row->p999_error = error[n - 1 - (n - 1) / 1000];
}

/* Asks the worst of pixel [n], sorted; n_asked gets how many. */
static tc_status ask_worst(size_t *n_asked, tc_judge *j, const ranked *pixel, size_t n, const tc_image *image,
                           tc_error *err)
{
    const size_t most = n / ASKED_SHARE > ASKED_LEAST ? n / ASKED_SHARE : ASKED_LEAST;
    size_t begin = 0, end = 0;
    while (end < n && end < most && pixel[end].error > ASKED)
        end++;
    for (bool settled = false; !settled;) {
        tc_status status = ask(j, pixel + begin, end - begin, image, err);
        if (status != TC_OK)
            return status;
        for (; begin < end; begin++)
            settled = settled || j->known[pixel[begin].index] == WELL_POSED;
        while (end < n && end < most && end - begin < ASKED_NEXT && pixel[end].error > DOUBT)
            end++;
        settled = settled || end == begin;
    }
    *n_asked = begin;
    return TC_OK;
}

static tc_status judge(tc_study_row *row, tc_judge *j, const tc_image *image, bool area, tc_error *err)
{
    tc_truth **truth = area ? &j->area : &j->ray;
    tc_status status = TC_OK;
    if (!*truth) {
        size_t n = pixels_asked_for(j);
        status =
            make_truth(truth, j, NULL, area ? (n + AREA_RAYS - 1) / AREA_RAYS : n, area ? AREA_RAYS : 1, false, err);
    }
    if (status == TC_OK && !area && !j->known) {
        j->known = tc_calloc(tc_truth_count(*truth), 1);
        status = j->known ? TC_OK : tc_fail_memory(err, "pixels", tc_truth_count(*truth), 1);
    }
    if (status != TC_OK)
        return status;
    const size_t n = tc_truth_count(*truth);
    size_t n_asked = 0, left = CHANNELS * n;
    double *error = tc_alloc(n, CHANNELS * sizeof *error);
    ranked *pixel = tc_alloc(n, sizeof *pixel);
    if (!error || !pixel) {
        status = tc_fail_memory(err, "errors", n, CHANNELS * sizeof *error);
        goto done;
    }
    find_errors(error, pixel, *truth, image);
    snprintf(row->truth, sizeof row->truth, "%s", area ? "area" : "ray");
    row->pixels = (int64_t)n;
    if (!area) {
        qsort(pixel, n, sizeof *pixel, worst_first);
        status = ask_worst(&n_asked, j, pixel, n, image, err);
        if (status != TC_OK)
            goto done;
        row->ill_posed = 0;
        left = leave_out(row, error, j, pixel, n_asked, n);
    }
    reduce(row, error, left);
done:
    free(error);
    free(pixel);
    return status;
}

tc_status tc_judge_ray(tc_study_row *row, tc_judge *j, const tc_image *image, tc_error *err)
{
    return judge(row, j, image, false, err);
}

tc_status tc_judge_area(tc_study_row *row, tc_judge *j, const tc_image *image, tc_error *err)
{
    return judge(row, j, image, true, err);
}
