/* main.c: finds the command and runs it. */
#include "cli/commands.h"
#include "cli/nearest.h"

#include <stdio.h>
#include <string.h>

static const tc_command *const tc_command_list[] = {
    &tc_command_render, &tc_command_batch, &tc_command_edit, &tc_command_explain, &tc_command_study, &tc_command_info, &tc_command_compare, &tc_command_synth, &tc_command_backends,
};
#define TC_N_COMMAND (sizeof tc_command_list / sizeof *tc_command_list)

static void tc_usage_print(FILE *stream)
{
    fprintf(stream, "Usage: tetcast COMMAND [arguments]\n\n"
                    "Renders finite-element volumes by casting rays through their tetrahedra.\n\nCommands:\n");
    for (size_t i = 0; i < TC_N_COMMAND; i++)
        fprintf(stream, "  %-10s %s\n", tc_command_list[i]->name, tc_command_list[i]->what);
    fprintf(stream, "\n  --quiet, --verbose, --help and --version work everywhere;\n"
                    "  tetcast COMMAND --help lists a command's options.\n");
}

static const tc_command *tc_command_find(const char *name, tc_talk *talk)
{
    tc_nearest search = {.name = name};
    for (size_t i = 0; i < TC_N_COMMAND; i++) {
        if (!strcmp(name, tc_command_list[i]->name))
            return tc_command_list[i];
        tc_nearest_offer(&search, tc_command_list[i]->name);
    }
    if (name[0] == '-')
        tc_talk_error(talk, "there is no option '%s' before the command (tetcast --help tells more)", name);
    else
        tc_talk_error(talk, "there is no command '%s'; the nearest is '%s' (tetcast --help lists them)", name,
                      search.best);
    return NULL;
}

/* tetcast help [COMMAND] */
static int tc_help_run(tc_talk *talk, int argc, char **argv)
{
    if (argc < 2) {
        tc_usage_print(stdout);
        return TC_EXIT_DONE;
    }
    const tc_command *command = tc_command_find(argv[1], talk);
    if (!command)
        return TC_EXIT_USAGE;
    tc_command_help(command);
    return TC_EXIT_DONE;
}

static int tc_dispatch(tc_talk *talk, int argc, char **argv)
{
    int i = 1;
    for (; i < argc && argv[i][0] == '-'; i++) {
        const char *word = argv[i];
        if (!strcmp(word, "--help") || !strcmp(word, "-h")) {
            tc_usage_print(stdout);
            return TC_EXIT_DONE;
        } else if (!strcmp(word, "--version")) {
            tc_version_print();
            return TC_EXIT_DONE;
        } else if (!strcmp(word, "--quiet") || !strcmp(word, "-q")) {
            talk->quiet = true;
        } else if (!strcmp(word, "--verbose") || !strcmp(word, "-v")) {
            talk->verbose = true;
        } else {
            break;
        }
    }
    if (i == argc) {
        tc_usage_print(stderr);
        return TC_EXIT_USAGE;
    }
    if (!strcmp(argv[i], "help"))
        return tc_help_run(talk, argc - i, argv + i);
    const tc_command *command = tc_command_find(argv[i], talk);
    return command ? command->run(talk, command, argc - i, argv + i) : TC_EXIT_USAGE;
}

int main(int argc, char **argv)
{
    tc_talk talk;
    tc_talk_init(&talk);
    return tc_talk_finish(&talk, tc_dispatch(&talk, argc, argv));
}
