/* cmd_compare.c: `tetcast compare`: the difference of two images.
 * Exit codes of its own: 0 same, 1 warn, 2 differ (or a wrong command line), 3 sizes differ, 4 unreadable. */
#include "cli/commands.h"
#include "cli/json_out.h"

#include <math.h>
#include <stdio.h>

enum {
    TC_COMPARE_SAME = 0,
    TC_COMPARE_WARN = 1,
    TC_COMPARE_DIFFER = 2,
    TC_COMPARE_SIZES = 3,
    TC_COMPARE_UNREADABLE = 4
};

typedef struct tc_compare_command {
    double warn, fail;
    bool json;
} tc_compare_command;

static const tc_option tc_compare_option[] = {
    {"--warn", 0, "E", "the images are the same up to this largest difference of a channel; default 1/255",
     TC_OPTION_REAL, .at = offsetof(tc_compare_command, warn), .low = 0, .high = 1e300},
    {"--fail", 0, "E", "and differ above this one; between them it is a warning; default 4/255", TC_OPTION_REAL,
     .at = offsetof(tc_compare_command, fail), .low = 0, .high = 1e300},
    {"--json", 0, NULL, "the figures as JSON", TC_OPTION_FLAG, .at = offsetof(tc_compare_command, json)},
};

static size_t tc_nonfinite_count(const tc_image *image)
{
    size_t n = 4 * (size_t)image->width * (size_t)image->height, count = 0;
    for (size_t i = 0; i < n; i++)
        count += !isfinite(image->rgba[i]);
    return count;
}

static json_t *tc_compare_json(const tc_compare_result *result, size_t nonfinite, const char *verdict)
{
    json_t *json = json_object();
    tc_json_text(json, "verdict", verdict);
    tc_json_real(json, "max_abs", result->max_abs);
    tc_json_real(json, "mean_abs", result->mean_abs);
    tc_json_real(json, "p999_abs", result->p999_abs);
    tc_json_real(json, "rms", result->rms);
    tc_json_count(json, "pixels", result->pixels);
    tc_json_count(json, "covered", result->covered);
    tc_json_count(json, "differing", result->differing);
    tc_json_count(json, "nonfinite", nonfinite);
    json_object_set_new(json, "worst", json_pack("[i,i]", result->worst_x, result->worst_y));
    return json;
}

static int tc_compare_images(const tc_image *a, const tc_image *b, const tc_compare_command *options,
                             const char *const *path, tc_talk *talk)
{
    static const char *const verdict[] = {"same", "warn", "differ"};
    tc_compare_result result;
    tc_error err = {0};
    if (a->width != b->width || a->height != b->height) {
        tc_talk_error(talk, "the sizes differ: %s is %dx%d, %s is %dx%d", path[0], a->width, a->height, path[1],
                      b->width, b->height);
        return TC_COMPARE_SIZES;
    }
    tc_status status = tc_image_compare(&result, a, b, &err);
    if (status) {
        tc_talk_status(talk, status, &err);
        return TC_COMPARE_UNREADABLE;
    }
    size_t nonfinite = tc_nonfinite_count(a) + tc_nonfinite_count(b);
    int code = TC_COMPARE_DIFFER; /* what is not a number differs */
    if (nonfinite == 0 && result.max_abs <= options->warn)
        code = TC_COMPARE_SAME;
    else if (nonfinite == 0 && result.max_abs <= options->fail)
        code = TC_COMPARE_WARN;
    if (options->json) {
        json_t *json = tc_compare_json(&result, nonfinite, verdict[code]);
        if (tc_json_write(json, "-", talk) >= 0)
            code = TC_COMPARE_UNREADABLE;
        json_decref(json);
    } else {
        printf("%s: max %.6g at %d,%d, 99.9 %% below %.6g, mean %.6g, rms %.6g over %zu covered pixels; %zu of %zu "
               "pixels differ by more than 1/255\n",
               verdict[code], result.max_abs, result.worst_x, result.worst_y, result.p999_abs, result.mean_abs,
               result.rms, result.covered, result.differing, result.pixels);
        if (nonfinite)
            printf("%zu values are not finite\n", nonfinite);
    }
    return code;
}

static int tc_compare_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    /* 1e-6: the rounding of 8-bit steps to float */
    tc_compare_command options = {.warn = 1.0 / 255 + 1e-6, .fail = 4.0 / 255 + 1e-6};
    const char *path[2];
    tc_image *image[2] = {NULL, NULL};
    int n_argument, code = tc_options_parse(&options, path, &n_argument, talk, command, argc, argv);
    if (code >= 0)
        return code;
    if (options.warn > options.fail) {
        tc_talk_error(talk, "--warn (%g) must not be above --fail (%g)", options.warn, options.fail);
        return TC_EXIT_USAGE;
    }
    for (int i = 0; i < 2 && code < 0; i++) {
        tc_error err = {0};
        tc_status status = tc_image_read(&image[i], path[i], &err);
        if (status) {
            tc_talk_status(talk, status, &err);
            code = TC_COMPARE_UNREADABLE;
        }
    }
    if (code < 0)
        code = tc_compare_images(image[0], image[1], &options, path, talk);
    tc_image_destroy(&image[0]);
    tc_image_destroy(&image[1]);
    return code;
}

const tc_command tc_command_compare = {
    .name = "compare",
    .arguments = "A B",
    .what = "The difference of two images.",
    .about = "Exit codes: 0 same, 1 warn, 2 differ, 3 the sizes differ, 4 an image cannot be read.",
    .option = tc_compare_option,
    .n_option = sizeof tc_compare_option / sizeof *tc_compare_option,
    .least = 2,
    .most = 2,
    .run = tc_compare_run,
};
