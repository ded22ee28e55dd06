/* summary.c: medians, percentiles and the Pareto front of error against time. */
#include "study/summary.h"

#include "core/memory.h"
#include "study/settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int double_order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double tc_median(double *value, size_t n)
{
    if (n == 0)
        return NAN;
    qsort(value, n, sizeof *value, double_order);
    return n % 2 ? value[n / 2] : 0.5 * (value[n / 2 - 1] + value[n / 2]);
}

double tc_percentile(double *value, size_t n, double share)
{
    if (n == 0)
        return NAN;
    qsort(value, n, sizeof *value, double_order);
    double rank = ceil(share * (double)n - 1e-9 * (double)n);
    size_t k = rank < 1 ? 0 : rank > (double)n ? n - 1 : (size_t)rank - 1;
    return value[k];
}

void tc_front(bool *front, const double *time, const double *error, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        front[i] = !isnan(time[i]) && !isnan(error[i]);
        for (size_t j = 0; j < n && front[i]; j++)
            front[i] = !(time[j] <= time[i] && error[j] <= error[i] && (time[j] < time[i] || error[j] < error[i]));
    }
}

static double most(double a, double b)
{
    return isnan(a) || b > a ? b : a;
}

static bool same_pair(const tc_study_row *a, const tc_study_row *b)
{
    return !strcmp(a->scene, b->scene) && !strcmp(a->function, b->function);
}

static void add(int64_t *sum, int64_t value)
{
    if (value >= 0)
        *sum = *sum < 0 ? value : *sum + value;
}

/* One setting over the rows of its pair. value [n] is scratch. */
static void sum_setting(tc_sum *out, const tc_study_row *row, size_t n, const tc_study_row *pair, const char *setting,
                        double *value)
{
    double error_sum = 0, pixels = 0, steps = 0, rays = 0;
    size_t n_time = 0, n_ratio = 0;
    tc_study_row *to = &out->row;
    out->views = 0;
    for (size_t i = 0; i < n; i++) {
        const tc_study_row *r = &row[i];
        if (!same_pair(r, pair) || strcmp(r->setting, setting) != 0)
            continue;
        if (out->views++ == 0) {
            *to = *r;
            to->view = -1;
            to->azimuth = to->elevation = NAN;
            to->pixels = to->ill_posed = to->steps = to->fragments = to->rays = to->rays_lost = -1;
        }
        if (!isnan(r->ms_median))
            value[n_time++] = r->ms_median;
        to->ms_min = isnan(to->ms_min) || r->ms_min < to->ms_min ? r->ms_min : to->ms_min;
        to->ms_max = most(to->ms_max, r->ms_max);
        to->max_error = most(to->max_error, r->max_error);
        to->p9999_error = most(to->p9999_error, r->p9999_error);
        to->p999_error = most(to->p999_error, r->p999_error);
        to->ill_posed_error = most(to->ill_posed_error, r->ill_posed_error);
        to->bytes_table = most(to->bytes_table, r->bytes_table);
        to->bytes_state = most(to->bytes_state, r->bytes_state);
        add(&to->pixels, r->pixels);
        add(&to->ill_posed, r->ill_posed);
        add(&to->steps, r->steps);
        add(&to->fragments, r->fragments);
        add(&to->rays, r->rays);
        add(&to->rays_lost, r->rays_lost);
        if (!isnan(r->mean_error) && r->pixels > 0) {
            error_sum += r->mean_error * (double)(r->pixels - (r->ill_posed > 0 ? r->ill_posed : 0));
            pixels += (double)(r->pixels - (r->ill_posed > 0 ? r->ill_posed : 0));
        }
        if (!isnan(r->steps_per_ray) && r->rays > 0) {
            steps += r->steps_per_ray * (double)r->rays;
            rays += (double)r->rays;
        }
    }
    to->ms_median = tc_median(value, n_time);
    to->mean_error = pixels > 0 ? error_sum / pixels : NAN;
    to->steps_per_ray = rays > 0 ? steps / rays : NAN;
    for (size_t i = 0; i < n; i++) {
        if (!same_pair(&row[i], pair) || strcmp(row[i].setting, setting) != 0)
            continue;
        for (size_t j = 0; j < n; j++)
            if (same_pair(&row[j], pair) && row[j].view == row[i].view && !strcmp(row[j].setting, "default") &&
                row[j].ms_median > 0 && !isnan(row[i].ms_median)) {
                value[n_ratio++] = row[i].ms_median / row[j].ms_median;
                break;
            }
    }
    out->time_ratio = tc_median(value, n_ratio);
}

/* Marks the front among sum [n], which are one pair's. scratch [2 n], front [n]. */
static void mark_front(tc_sum *sum, size_t n, double *scratch, bool *front)
{
    for (size_t i = 0; i < n; i++) {
        bool counts = !strcmp(sum[i].row.truth, "ray") && sum[i].row.rays_lost <= 0;
        scratch[i] = counts ? sum[i].row.ms_median : NAN;
        scratch[n + i] = counts ? sum[i].row.max_error : NAN;
    }
    tc_front(front, scratch, scratch + n, n);
    for (size_t i = 0; i < n; i++)
        sum[i].front = front[i];
}

tc_status tc_summary_build(tc_summary *out, const tc_study_row *row, size_t n, tc_error *err)
{
    size_t n_setting, room = n > 2 * TC_STUDY_SETTINGS ? n : 2 * TC_STUDY_SETTINGS;
    const tc_study_setting *setting = tc_study_settings(&n_setting);
    *out = (tc_summary){0, tc_calloc(n, sizeof *out->sum)}; /* n rows are of n settings at most */
    double *scratch = tc_alloc(room, sizeof *scratch);
    if (!out->sum || !scratch) {
        free(scratch);
        tc_summary_finish(out);
        return tc_fail_memory(err, "the summary of a study", n, sizeof *out->sum);
    }
    for (size_t i = 0; i < n; i++) {
        bool seen = false;
        bool front[TC_STUDY_SETTINGS];
        for (size_t j = 0; j < i && !seen; j++)
            seen = same_pair(&row[i], &row[j]);
        if (seen)
            continue;
        size_t first = out->n;
        for (size_t k = 0; k < n_setting; k++) {
            tc_sum *sum = &out->sum[out->n < n ? out->n : n - 1];
            if (out->n == n)
                break;
            memset(sum, 0, sizeof *sum);
            sum_setting(sum, row, n, &row[i], setting[k].name, scratch);
            out->n += sum->views > 0;
        }
        mark_front(out->sum + first, out->n - first, scratch, front);
    }
    free(scratch);
    return TC_OK;
}

void tc_summary_finish(tc_summary *summary)
{
    free(summary->sum);
    *summary = (tc_summary){0};
}
