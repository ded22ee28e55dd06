/* trial.c: measures candidates: errors over rays of a few views, frame times, and the error of one whole picture.
 * Errors are differences from the double-precision reference; ill-posed rays are left out (reference/truth.h). */
#include "study/trial.h"

#include "api/driver.h"
#include "core/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VIEWS = 3, CALIBRATION_PIXELS = 128 * 128, ROUNDS = 5, CHECK_FRAMES = 3, SUSPECTS = 512 };
static const double HOPELESS[ROUNDS] = {3, 2.5, 2, 1.5, 1.5}; /* after so many frames: times the fastest one's */
static const double ROUNDS_MS = 4000;                         /* all frames together are to take not much more */

void tc_trial_finish(tc_trial *trial)
{
    tc_truth_destroy(&trial->truth);
    tc_reference_destroy(&trial->reference);
    tc_image_destroy(&trial->finest);
}

/* True colours of a view's pixels: n drawn from the seed, or the ones listed. */
static tc_status make_truth(tc_truth **out, const tc_rays *rays, double unit, int samples, const uint32_t *pixel,
                            size_t n, tc_trial *p, tc_error *err)
{
    tc_status status = p->reference ? TC_OK : tc_reference_create(&p->reference, p->mesh, p->threads, err);
    if (status != TC_OK)
        return status;
    tc_reference_set_nan_color(p->reference, p->fixed->has_nan_color ? p->fixed->nan_color : NULL);
    status = tc_reference_set_look(p->reference, p->fixed->look, err);
    if (status != TC_OK)
        return status;
    const tc_truth_view view = {.reference = p->reference,
                                .tf = p->tf,
                                .unit = unit,
                                .rays = rays,
                                .pixel = pixel,
                                .n = n,
                                .seed = p->seed,
                                .samples = samples,
                                .threads = p->threads};
    return tc_truth_create(out, &view, err);
}

/* ---------------------------------------------------------------------------------------------------- calibration */

/* View k: the caller's, or the whole mesh from a direction across it and across the other one. */
static void view_camera(tc_camera *out, int k, const tc_trial *p, double aspect)
{
    double to_eye[3], side[3], up[3], length = 0;
    const tc_camera *c = p->camera;
    *out = *c;
    if (k == 0)
        return;
    for (int i = 0; i < 3; i++)
        to_eye[i] = c->position[i] - c->focal_point[i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, l = (i + 2) % 3;
        side[i] = c->view_up[j] * to_eye[l] - c->view_up[l] * to_eye[j];
    }
    for (int i = 0; i < 3; i++)
        length = fmax(length, fabs(side[i]));
    double reach = fmax(fabs(to_eye[0]), fmax(fabs(to_eye[1]), fabs(to_eye[2])));
    if (!(length > 1e-6 * reach)) /* view-up along the view: any direction across it */
        side[0] = -to_eye[2] - to_eye[1], side[1] = to_eye[0], side[2] = to_eye[0];
    if (!(fabs(side[0]) + fabs(side[1]) + fabs(side[2]) > 0))
        side[0] = 0, side[1] = -to_eye[2], side[2] = to_eye[1];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, l = (i + 2) % 3;
        up[i] = to_eye[j] * side[l] - to_eye[l] * side[j];
    }
    tc_camera_reset(out, p->mesh->report.bounds, k == 1 ? side : up, k == 1 ? up : to_eye,
                    c->parallel ? 30 : fmin(c->view_angle, 60), aspect);
}

/* A whole picture of about CALIBRATION_PIXELS of the same shape, one ray a pixel. */
static void small_options(tc_render_options *out, const tc_render_options *fixed)
{
    const double width = fixed->whole_width ? fixed->whole_width : fixed->width;
    const double height = fixed->whole_width ? fixed->whole_height : fixed->height;
    double scale = sqrt((double)CALIBRATION_PIXELS / (width * height));
    *out = *fixed;
    out->width = (int)fmin(fmax(1, round(width * fmin(scale, 1))), CALIBRATION_PIXELS);
    out->height = (int)fmin(fmax(1, round(height * fmin(scale, 1))), CALIBRATION_PIXELS);
    out->whole_width = out->whole_height = out->part_x = out->part_y = 0; /* parts are of the same view */
    out->samples = 1;
    out->count = out->audit = false;
}

static tc_status render(tc_image **image, tc_render_stats *stats, const tc_candidate *c, const tc_camera *camera,
                        const tc_render_options *options, tc_trial *p, tc_error *err)
{
    tc_render_options o = *options;
    tc_candidate_apply(&o, c);
    tc_status status = tc_render(image, stats, p->renderer, p->mesh, p->tf, camera, &o, p->log, err);
    if (status != TC_OK)
        tc_image_destroy(image);
    return status;
}

/* One candidate in one view: raises its error. `mixed`: exact is another candidate, so running integrals that went on
 * as exact are it again. */
static tc_status raise_error(tc_candidate *c, const tc_camera *camera, const tc_render_options *options, bool mixed,
                             tc_truth *truth, tc_trial *p, tc_error *err)
{
    tc_image *image = NULL;
    tc_render_stats stats;
    tc_verify_result result;
    if (c->error == INFINITY)
        return TC_OK;
    tc_status status = render(&image, &stats, c, camera, options, p, err);
    if (status == TC_E_ARG ||
        (status == TC_OK && mixed && c->integrator == TC_INTEGRATOR_INTEGRAL && !strcmp(stats.integrator, "exact"))) {
        c->error = INFINITY; /* not for this function, as exact with very many knots; or not of its own */
        tc_image_destroy(&image);
        return TC_OK;
    }
    if (status == TC_OK)
        status = tc_truth_compare(&result, NULL, truth, image, err);
    if (status == TC_OK)
        c->error = isnan(c->error) ? result.max_abs_error : fmax(c->error, result.max_abs_error);
    tc_image_destroy(&image);
    return status;
}

tc_status tc_trial_errors(tc_candidate *candidate, size_t n, size_t *rays, tc_trial *p, tc_error *err)
{
    bool mixed = false;
    tc_status status = TC_OK;
    *rays = 0;
    for (size_t i = 0; i < n; i++)
        mixed = mixed || candidate[i].integrator == TC_INTEGRATOR_EXACT;
    for (int k = 0; k < VIEWS && status == TC_OK; k++) {
        tc_camera camera;
        tc_render_options options;
        tc_rays around;
        tc_truth *truth = NULL;
        double unit;
        small_options(&options, p->fixed);
        view_camera(&camera, k, p, (double)options.width / options.height);
        size_t pixels = (size_t)options.width * (size_t)options.height;
        status = tc_render_resolve(&unit, &around, p->mesh, p->tf, &camera, &options, err);
        if (status == TC_OK)
            status = make_truth(&truth, &around, unit, 1, NULL, pixels, p, err);
        for (size_t i = 0; i < n && status == TC_OK; i++) {
            status = raise_error(&candidate[i], &camera, &options, mixed, truth, p, err);
            tc_progress(p->log, "calibrate", ((double)k + (double)(i + 1) / (double)n) / VIEWS);
        }
        *rays += pixels;
        tc_truth_destroy(&truth);
    }
    if (status == TC_OK && tc_candidate_best(candidate, n) == n)
        return tc_fail(err, TC_E_GL, "no setting could be rendered");
    return status;
}

/* ---------------------------------------------------------------------------------------------------------- times */

static int order_double(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(const double *value, size_t n)
{
    double sorted[ROUNDS];
    memcpy(sorted, value, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, order_double);
    return n % 2 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
}

static tc_status one_time(double *ms, const tc_candidate *c, tc_trial *p, tc_error *err)
{
    tc_render_options o = *p->fixed;
    tc_image *image = NULL;
    tc_render_stats stats;
    o.count = o.audit = false;
    tc_status status = render(&image, &stats, c, p->camera, &o, p, err);
    tc_image_destroy(&image);
    *ms = stats.ms_frame;
    return status;
}

tc_status tc_trial_times(tc_candidate *candidate, const size_t *index, size_t m, tc_trial *p, tc_error *err)
{
    double ms[TC_CANDIDATE_MAX][ROUNDS], total = 0, warm;
    size_t frames[TC_CANDIDATE_MAX] = {0};
    bool out[TC_CANDIDATE_MAX] = {false};
    for (size_t k = 0; k < m; k++) { /* compiles, and grows what is too small */
        tc_status status = one_time(&warm, &candidate[index[k]], p, err);
        if (status != TC_OK)
            return status;
    }
    for (int round = 0; round < ROUNDS; round++) {
        double least = INFINITY;
        if (round > 1 && total * (round + 1) / round > ROUNDS_MS)
            break;
        for (size_t k = 0; k < m; k++) {
            if (out[k])
                continue;
            tc_status status = one_time(&ms[k][round], &candidate[index[k]], p, err);
            if (status != TC_OK)
                return status;
            total += ms[k][round];
            frames[k]++;
            least = fmin(least, median(ms[k], frames[k]));
        }
        for (size_t k = 0; k < m; k++)
            out[k] = out[k] || median(ms[k], frames[k]) > HOPELESS[round] * least;
        tc_progress(p->log, "time", (double)(round + 1) / ROUNDS);
    }
    tc_progress(p->log, "time", 1);
    for (size_t k = 0; k < m; k++)
        candidate[index[k]].ms = median(ms[k], frames[k]);
    return TC_OK;
}

/* -------------------------------------------------------------------------------------------------------- picture */

typedef struct suspect {
    double difference;
    uint32_t pixel;
} suspect;

/* Sinks the root of a heap whose least is at the root. */
static void sink(suspect *heap, size_t n)
{
    for (size_t at = 0, child = 1; child < n; at = child, child = 2 * at + 1) {
        if (child + 1 < n && heap[child + 1].difference < heap[child].difference)
            child++;
        if (heap[at].difference <= heap[child].difference)
            return;
        suspect held = heap[at];
        heap[at] = heap[child];
        heap[child] = held;
    }
}

/* The largest difference of a channel. */
static double differ(const float *a, const float *b)
{
    double most = 0;
    for (int i = 0; i < 4; i++)
        most = isfinite(a[i]) ? fmax(most, fabs((double)a[i] - (double)b[i])) : FLT_MAX;
    return most;
}

/* Pixels that differ most; gives their number. Pixels that do not differ are none. */
static size_t find_suspects(uint32_t pixel[SUSPECTS], const tc_image *a, const tc_image *b)
{
    suspect heap[SUSPECTS] = {{0}};
    size_t all = (size_t)a->width * (size_t)a->height, n = 0;
    for (size_t i = 0; i < all; i++) {
        double d = differ(&a->rgba[4 * i], &b->rgba[4 * i]);
        if (d > heap[0].difference) {
            heap[0] = (suspect){d, (uint32_t)i};
            sink(heap, SUSPECTS);
        }
    }
    for (size_t i = 0; i < SUSPECTS; i++)
        if (heap[i].difference > 0)
            pixel[n++] = heap[i].pixel;
    return n;
}

static tc_status check_suspects(tc_trial_check *out, const tc_image *image, const tc_rays *rays, double unit,
                                tc_trial *p, tc_error *err)
{
    uint32_t pixel[SUSPECTS];
    tc_truth *truth = NULL;
    tc_verify_result result;
    size_t n = find_suspects(pixel, image, p->finest);
    if (n == 0)
        return TC_OK;
    tc_status status = make_truth(&truth, rays, unit, p->fixed->samples, pixel, n, p, err);
    if (status == TC_OK)
        status = tc_truth_compare(&result, NULL, truth, image, err);
    tc_truth_destroy(&truth);
    if (status != TC_OK)
        return status;
    out->suspects = n;
    out->suspect = result.max_abs_error;
    out->error = fmax(out->error, out->suspect);
    return TC_OK;
}

/* The picture in which nothing is chosen but exactness: whatever the caller fixed of the integrator. NULL where the
 * function has too many knots for it. */
static tc_status render_finest(tc_trial *p, tc_error *err)
{
    static const tc_candidate exact = {.integrator = TC_INTEGRATOR_EXACT, .stop = 1};
    tc_render_options o = *p->fixed;
    tc_render_stats stats;
    o.count = o.audit = false;
    o.integral_order = 0;
    o.integral_split = 0;
    o.state_format = TC_STATE_32F;
    tc_status status = p->finest ? TC_OK : render(&p->finest, &stats, &exact, p->camera, &o, p, err);
    return status == TC_E_ARG ? TC_OK : status;
}

tc_status tc_trial_picture(tc_trial_check *out, const tc_candidate *candidate, bool suspects, tc_trial *p,
                           tc_error *err)
{
    tc_render_options o = *p->fixed;
    tc_image *image = NULL;
    tc_render_stats stats;
    tc_rays rays;
    double unit, ms[CHECK_FRAMES];
    size_t frames = 0;
    memset(out, 0, sizeof *out);
    o.count = o.audit = false;
    tc_status status = tc_render_resolve(&unit, &rays, p->mesh, p->tf, p->camera, &o, err);
    if (status == TC_OK && suspects)
        status = render_finest(p, err);
    for (; frames < CHECK_FRAMES && status == TC_OK; frames++) {
        if (frames > 0 && ms[frames - 1] > ROUNDS_MS / CHECK_FRAMES)
            break;
        tc_image_destroy(&image);
        status = render(&image, &stats, candidate, p->camera, &o, p, err);
        ms[frames] = stats.ms_frame;
    }
    if (status == TC_OK && !p->truth)
        status = make_truth(&p->truth, &rays, unit, o.samples, NULL, p->verify, p, err);
    if (status == TC_OK)
        status = tc_truth_compare(&out->verify, NULL, p->truth, image, err);
    out->verify.rays_lost = 0; /* tc_render fails where one is */
    out->error = out->verify.max_abs_error;
    if (status == TC_OK && suspects && p->finest)
        status = check_suspects(out, image, &rays, unit, p, err);
    if (status == TC_OK)
        out->ms = median(ms, frames);
    tc_image_destroy(&image);
    return status;
}
