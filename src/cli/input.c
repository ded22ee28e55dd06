/* input.c: from the INPUT of a command line to a mesh. */
#define _GNU_SOURCE
#include "cli/input.h"
#include "cli/nearest.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TC_SYNTH_PREFIX "synth:"

const tc_choice tc_reentry_choice[] = {
    {"auto", TC_REENTRY_AUTO, false},
    {"convexify", TC_REENTRY_CONVEXIFY, false},
    {"peel", TC_REENTRY_PEEL, false},
    {NULL, 0, false},
};

const char *tc_reentry_name(tc_reentry reentry)
{
    return tc_reentry_choice[reentry].name;
}

int tc_input_check(const tc_input_options *options, tc_talk *talk)
{
    if (options->cell_data && options->point_data) {
        tc_talk_error(talk, "--cell-data and --point-data exclude each other: give one");
        return TC_EXIT_USAGE;
    }
    if (options->has_time && options->has_step) {
        tc_talk_error(talk, "--time and --step exclude each other: give one");
        return TC_EXIT_USAGE;
    }
    return -1;
}

int tc_synth_index(const char *name, tc_talk *talk)
{
    size_t n = 0;
    const tc_synth_info *list = tc_synth_list(&n);
    tc_nearest search = {.name = name};
    for (size_t i = 0; i < n; i++) {
        if (!strcmp(list[i].name, name))
            return (int)i;
        tc_nearest_offer(&search, list[i].name);
    }
    tc_talk_error(talk, "there is no synthetic dataset '%s'; the nearest is '%s' (tetcast synth --list names them)",
                  name, search.best ? search.best : "none");
    return -1;
}

/* synth:NAME[:CELLS] */
static int tc_synth_load(tc_mesh **out, const tc_input_options *options, const char *text, tc_talk *talk)
{
    char name[64];
    tc_error err = {0};
    unsigned long long cells = 0;
    const char *colon = strchr(text, ':');
    size_t length = colon ? (size_t)(colon - text) : strlen(text);
    snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), text);
    if (colon) {
        char *end;
        errno = 0;
        cells = strtoull(colon + 1, &end, 10);
        if (end == colon + 1 || *end || errno || strchr(colon, '-') || cells == 0 || cells > 1000000000ull) {
            tc_talk_error(talk, "'%s%s': after the second colon comes the number of cells, 1 to 1000000000",
                          TC_SYNTH_PREFIX, text);
            return TC_EXIT_USAGE;
        }
    }
    if (tc_synth_index(name, talk) < 0)
        return TC_EXIT_USAGE;
    if (options->field || options->cell_data || options->has_time || options->has_step)
        tc_talk_warning(talk, "a synthetic dataset has one field and no time: --field, --cell-data, --time and --step "
                              "are without effect");
    tc_status status = tc_synth_create(out, name, (size_t)cells, options->seed, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

bool tc_input_is_synthetic(const char *input)
{
    return !strncmp(input, TC_SYNTH_PREFIX, strlen(TC_SYNTH_PREFIX));
}

tc_read_options tc_input_read_options(const tc_input_options *options)
{
    return (tc_read_options){
        .field = options->field,
        .association = options->cell_data    ? TC_CELL_DATA
                       : options->point_data ? TC_POINT_DATA
                                             : TC_ANY_DATA,
        .has_time = options->has_time,
        .has_step = options->has_step,
        .time = options->time,
        .step = options->step,
        .refine = options->refine,
        .idle_limit_s = options->idle_limit,
        .keep_reader = options->keep_reader,
    };
}

tc_prepare_options tc_input_prepare_options(const tc_input_options *options)
{
    return (tc_prepare_options){
        .reentry = (tc_reentry)options->reentry, .threads = options->threads, .once_pixels = options->once_pixels};
}

int tc_input_load(tc_mesh **out, double *ms_read, const tc_input_options *options, const char *input, tc_talk *talk)
{
    tc_error err = {0};
    *ms_read = NAN;
    if (tc_input_is_synthetic(input))
        return tc_synth_load(out, options, input + strlen(TC_SYNTH_PREFIX), talk);
    if (access(input, R_OK) != 0) {
        tc_talk_error(talk, "%s cannot be read: %s%s", input, strerror(errno),
                      errno == ENOENT ? "; check the path (synthetic datasets are written synth:NAME)" : "");
        return TC_EXIT_FAILED;
    }
    tc_read_options read = tc_input_read_options(options);
    double start = tc_talk_clock_s();
    tc_status status = tc_mesh_read(out, input, &read, &talk->log, &err);
    *ms_read = 1e3 * (tc_talk_clock_s() - start);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

int tc_input_step(tc_mesh **mesh, bool *moved, double *ms_read, const tc_input_options *options, const char *input,
                  tc_talk *talk)
{
    tc_error err = {0};
    tc_mesh *other = NULL;
    tc_read_options read = tc_input_read_options(options);
    double start = tc_talk_clock_s();
    tc_status status = tc_mesh_read_values(&other, *mesh, input, &read, &talk->log, &err);
    *ms_read = 1e3 * (tc_talk_clock_s() - start);
    *moved = status == TC_E_MOVED;
    if (status && !*moved)
        return tc_talk_status(talk, status, &err);
    if (*moved) {
        tc_mesh_destroy(mesh);
        *mesh = other;
    }
    return -1;
}

int tc_input_prepare(tc_mesh *mesh, const tc_input_options *options, tc_talk *talk)
{
    tc_error err = {0};
    tc_prepare_options prepare = tc_input_prepare_options(options);
    tc_status status = tc_mesh_prepare(mesh, &prepare, &talk->log, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

void tc_input_stem(char *out, size_t capacity, const char *input)
{
    char *real = NULL;
    if (tc_input_is_synthetic(input)) {
        const char *name = input + strlen(TC_SYNTH_PREFIX);
        snprintf(out, capacity, "%.*s", (int)strcspn(name, ":"), name);
        return;
    }
    size_t length = strlen(input);
    while (length > 1 && input[length - 1] == '/')
        length--;
    size_t from = length;
    while (from > 0 && input[from - 1] != '/')
        from--;
    if (!strncmp(input + from, ".", length - from) || !strncmp(input + from, "..", length - from)) {
        real = realpath(input, NULL); /* a folder given as "." is named by its own name */
        const char *slash = real ? strrchr(real, '/') : NULL;
        snprintf(out, capacity, "%s", slash && slash[1] ? slash + 1 : "picture");
        free(real);
        return;
    }
    size_t end = length;
    for (size_t i = from + 1; i < length; i++)
        if (input[i] == '.')
            end = i;
    snprintf(out, capacity, "%.*s", (int)(end - from), input + from);
}
