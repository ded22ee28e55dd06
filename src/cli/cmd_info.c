/* cmd_info.c: `tetcast info`: what a file holds and what is wrong with it, as a table or as JSON. */
#include "cli/commands.h"
#include "cli/info_text.h"
#include "cli/input_cache.h"

#include <math.h>

typedef struct tc_info_command {
    tc_input_options source;
    bool json;
} tc_info_command;

static const tc_option tc_info_option[] = {
    TC_INPUT_FIELD_ROWS(tc_info_command, source),
    TC_INPUT_GAP_ROW(tc_info_command, source),
    TC_INPUT_CACHE_ROWS(tc_info_command, source),
    TC_INPUT_THREADS_ROW(tc_info_command, source),
    {"--seed", 0, "S", "of a synthetic dataset; default 1", TC_OPTION_U64,
     .at = TC_INPUT_AT(tc_info_command, source, seed)},
    {"--json", 0, NULL, "as JSON", TC_OPTION_FLAG, .at = offsetof(tc_info_command, json)},
};

static int tc_info_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_info_command options = {.source.seed = 1};
    const char *input;
    int n_argument;
    tc_mesh *mesh = NULL;
    tc_info info = {0};
    int code = tc_options_parse(&options, &input, &n_argument, talk, command, argc, argv);
    if (code < 0)
        code = tc_input_check(&options.source, talk);
    if (code >= 0)
        return code;
    /* A mesh that cannot be rendered is still told about; the exit code then says that it failed. */
    code = tc_input_open(&mesh, &info.seen, &options.source, input, talk);
    if (!mesh)
        return code;
    info.input = input;
    info.prepared = code < 0;
    info.source = tc_mesh_source(mesh);
    tc_mesh_get_report(&info.report, mesh);
    info.unit_distance = tc_default_unit_distance(mesh);
    if (options.json) {
        json_t *json = tc_info_json(&info);
        int wrote = tc_json_write(json, "-", talk);
        json_decref(json);
        code = code < 0 ? wrote : code;
    } else {
        tc_info_print(&info);
    }
    tc_mesh_destroy(&mesh);
    return code < 0 ? TC_EXIT_DONE : code;
}

const tc_command tc_command_info = {
    .name = "info",
    .arguments = "INPUT",
    .what = "Cells by type, arrays and ranges, bounds, defects, convexity, bytes on the GPU.",
    .option = tc_info_option,
    .n_option = sizeof tc_info_option / sizeof *tc_info_option,
    .least = 1,
    .most = 1,
    .run = tc_info_run,
};
