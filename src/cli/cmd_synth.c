/* cmd_synth.c: `tetcast synth`: a synthetic dataset as a VTU file. */
#include "cli/commands.h"
#include "cli/input.h"
#include "cli/json_out.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

typedef struct tc_synth_command {
    const char *output;
    uint64_t cells, seed;
    bool list, json;
} tc_synth_command;

static const tc_option tc_synth_option[] = {
    {"--output", 'o', "FILE.vtu", "where to write it", TC_OPTION_TEXT, .at = offsetof(tc_synth_command, output)},
    {"--cells", 0, "N", "about this many tetrahedra; default the dataset's own number", TC_OPTION_U64,
     .at = offsetof(tc_synth_command, cells), .low = 1, .high = 1e9},
    {"--seed", 0, "S", "of what is random in it; default 1", TC_OPTION_U64, .at = offsetof(tc_synth_command, seed)},
    {"--list", 0, NULL, "name the datasets and their fields", TC_OPTION_FLAG, .at = offsetof(tc_synth_command, list)},
    {"--json", 0, NULL, "the list as JSON", TC_OPTION_FLAG, .at = offsetof(tc_synth_command, json)},
};

static int tc_synth_list_print(bool as_json, tc_talk *talk)
{
    size_t n = 0;
    const tc_synth_info *list = tc_synth_list(&n);
    if (!as_json) {
        for (size_t i = 0; i < n; i++)
            printf("%-21s %s; field: %s\n", list[i].name, list[i].what, list[i].field);
        return TC_EXIT_DONE;
    }
    json_t *json = json_array();
    for (size_t i = 0; i < n; i++) {
        json_t *row = json_object();
        tc_json_text(row, "name", list[i].name);
        tc_json_text(row, "what", list[i].what);
        tc_json_text(row, "field", list[i].field);
        json_array_append_new(json, row);
    }
    int code = tc_json_write(json, "-", talk);
    json_decref(json);
    return code < 0 ? TC_EXIT_DONE : code;
}

static int tc_synth_write(const tc_synth_command *options, const char *name, tc_talk *talk)
{
    tc_error err = {0};
    tc_mesh *mesh = NULL;
    tc_mesh_report report;
    tc_status status = tc_synth_create(&mesh, name, (size_t)options->cells, options->seed, &err);
    if (!status)
        status = tc_mesh_write_vtu(mesh, options->output, &err);
    if (status) {
        tc_mesh_destroy(&mesh);
        return tc_talk_status(talk, status, &err);
    }
    tc_mesh_get_report(&report, mesh);
    tc_talk_say(talk, "%s: %zu points, %zu tets; wrote %s", name, report.n_vertex, report.n_tet, options->output);
    tc_mesh_destroy(&mesh);
    return TC_EXIT_DONE;
}

static int tc_synth_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_synth_command options = {.seed = 1};
    const char *name = NULL;
    int n_argument;
    int code = tc_options_parse(&options, &name, &n_argument, talk, command, argc, argv);
    if (code >= 0)
        return code;
    if (options.list)
        return tc_synth_list_print(options.json, talk);
    if (!name) {
        tc_talk_error(talk, "synth needs the name of a dataset (tetcast synth --list names them)");
        return TC_EXIT_USAGE;
    }
    if (tc_synth_index(name, talk) < 0)
        return TC_EXIT_USAGE;
    if (!options.output) {
        tc_talk_error(talk, "synth needs a file to write: -o %s.vtu", name);
        return TC_EXIT_USAGE;
    }
    const char *dot = strrchr(options.output, '.');
    if (!dot || strcasecmp(dot, ".vtu") != 0) {
        tc_talk_error(talk, "%s: synth writes VTU files, so the name must end in .vtu", options.output);
        return TC_EXIT_USAGE;
    }
    code = tc_output_check(options.output, talk);
    return code < 0 ? tc_synth_write(&options, name, talk) : code;
}

const tc_command tc_command_synth = {
    .name = "synth",
    .arguments = "[NAME]",
    .what = "A synthetic dataset, written as a VTU file.",
    .option = tc_synth_option,
    .n_option = sizeof tc_synth_option / sizeof *tc_synth_option,
    .most = 1,
    .run = tc_synth_run,
};
