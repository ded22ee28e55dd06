/* survey.c: tc_mesh_survey: asks the helper program tetcast-read what the meshes of several steps will be like.
 *
 * Request, one for each step, so that one which the helper dies of costs no other: {"do": "survey", "path", "field"?,
 * "association": 0..2, "time"?, "step"?, "refine", "keep": true}.
 * Result: {"range": [lo, hi], absent when nothing is finite, "bounds": [6 numbers], "solid_cells", "time"?}. */
#include "read.h"

#include "core/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* n numbers of a list. */
static bool take_numbers(double *out, const json_t *list, size_t n)
{
    if (json_array_size(list) != n)
        return false;
    for (size_t i = 0; i < n; i++)
        out[i] = json_number_value(json_array_get(list, i));
    return true;
}

static tc_status take(tc_survey *out, const tc_reply *reply, tc_error *err)
{
    const json_t *range = json_object_get(reply->json, "range"), *time = json_object_get(reply->json, "time");
    tc_survey s = {.range = {INFINITY, -INFINITY}, .time = time ? json_number_value(time) : NAN};
    const json_int_t cells = json_integer_value(json_object_get(reply->json, "solid_cells"));
    if (!take_numbers(s.bounds, json_object_get(reply->json, "bounds"), 6) ||
        (range && !take_numbers(s.range, range, 2)) || cells <= 0)
        return tc_fail(err, TC_E_WORKER, "tetcast-read gave an answer that is no survey; is it of another version?");
    s.source_cells = (size_t)cells;
    *out = s;
    return TC_OK;
}

/* As much of a sentence as fits, in whole UTF-8 characters. */
static void note_failure(tc_survey *out, tc_status status, const char *text)
{
    *out = (tc_survey){.status = status};
    size_t n = strlen(text);
    if (n >= sizeof out->why)
        for (n = sizeof out->why - 1; n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80;)
            n--;
    memcpy(out->why, text, n);
    out->why[n] = 0;
}

static tc_status survey_step(tc_survey *out, tc_worker **worker, const char *path, const tc_read_options *options,
                             const tc_log *log, tc_error *err)
{
    json_t *request;
    tc_reply reply = {0};
    tc_status status = tc_read_request(&request, "survey", path, options, err);
    if (status)
        return status;
    if (json_object_set_new(request, "all_ranges", json_boolean(!options->field)) ||
        json_object_set_new(request, "keep", json_true()))
        status = tc_fail_memory(err, "a request", 1, 256);
    if (!status)
        status = tc_read_call(&reply, worker, request, path, options, log, err);
    if (!status)
        status = take(out, &reply, err);
    tc_reply_finish(&reply);
    json_decref(request);
    return status;
}

/* One step of each path, or of the only one; step NULL: that of options. */
static tc_status survey_all(tc_survey *out, const char *const *path, bool one_path, const int *step, size_t n,
                            const tc_read_options *options, const tc_log *log, tc_error *err)
{
    static const tc_read_options defaults = {0};
    tc_read_options one = options ? *options : defaults;
    tc_status status = tc_read_check(&one, err);
    if (status)
        return status;
    tc_worker *worker = NULL;
    size_t failed = 0;
    tc_error first = {0};
    for (size_t i = 0; i < n; i++) {
        tc_error why = {0};
        if (step) {
            one.has_time = false;
            one.has_step = true;
            one.step = step[i];
        }
        if (n > 1)
            tc_progress(log, "surveying", (double)i / (double)n);
        status = survey_step(&out[i], &worker, path[one_path ? 0 : i], &one, log, &why);
        if (status) {
            note_failure(&out[i], status, why.text);
            if (failed++ == 0)
                first = why;
        }
    }
    tc_worker_stop(&worker);
    return n > 0 && failed == n ? tc_fail(err, first.code, "%s", first.text) : TC_OK;
}

tc_status tc_mesh_survey(tc_survey *out, const int *step, size_t n_step, const char *path,
                         const tc_read_options *options, const tc_log *log, tc_error *err)
{
    if (!out || !path || (!step && n_step != 1))
        return tc_fail(err, TC_E_ARG, "tc_mesh_survey: out or path is NULL, or step with %zu steps", n_step);
    return survey_all(out, &path, true, step, n_step, options, log, err);
}

tc_status tc_mesh_survey_files(tc_survey *out, const char *const *path, size_t n, const tc_read_options *options,
                               const tc_log *log, tc_error *err)
{
    if (!out || !path)
        return tc_fail(err, TC_E_ARG, "tc_mesh_survey_files: out or path is NULL");
    return survey_all(out, path, false, NULL, n, options, log, err);
}
