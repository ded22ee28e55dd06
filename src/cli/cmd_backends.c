/* cmd_backends.c: `tetcast backends`: OpenGL contexts and drivers, and why one is missing. */
#include "cli/commands.h"
#include "cli/json_out.h"

#include <stdio.h>

#define TC_BACKENDS_MAX 32

static const tc_option tc_backends_option[] = {
    {"--json", 0, NULL, "as JSON", TC_OPTION_FLAG, .at = 0},
};

static json_t *tc_backends_json(const tc_backend_info *info, size_t n)
{
    json_t *list = json_array();
    for (size_t i = 0; i < n; i++) {
        json_t *row = json_object();
        tc_json_text(row, "kind", info[i].kind);
        tc_json_text(row, "name", info[i].name);
        json_object_set_new(row, "works", json_boolean(info[i].works));
        tc_json_text(row, "why", info[i].why);
        json_array_append_new(list, row);
    }
    return list;
}

static int tc_backends_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    bool as_json = false;
    int n_argument;
    size_t n = 0;
    tc_error err = {0};
    tc_backend_info info[TC_BACKENDS_MAX];
    int code = tc_options_parse(&as_json, NULL, &n_argument, talk, command, argc, argv);
    if (code >= 0)
        return code;
    tc_status status = tc_backends(info, TC_BACKENDS_MAX, &n, &err);
    if (status)
        return tc_talk_status(talk, status, &err);
    if (as_json) {
        json_t *json = tc_backends_json(info, n);
        code = tc_json_write(json, "-", talk);
        json_decref(json);
        return code < 0 ? TC_EXIT_DONE : code;
    }
    for (size_t i = 0; i < n; i++)
        printf("%-8s %-10s %-7s %s\n", info[i].kind, info[i].name, info[i].works ? "works" : "missing", info[i].why);
    return TC_EXIT_DONE;
}

const tc_command tc_command_backends = {
    .name = "backends",
    .arguments = "",
    .what = "OpenGL contexts and drivers of this machine, and why one is missing.",
    .option = tc_backends_option,
    .n_option = sizeof tc_backends_option / sizeof *tc_backends_option,
    .run = tc_backends_run,
};
