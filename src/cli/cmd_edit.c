/* cmd_edit.c: `tetcast edit`: checks what can be checked without a window, and becomes tetcast-edit, the program that
 * has one. */
#define _GNU_SOURCE
#include "cli/edit_command.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TC_EDIT_PROGRAM "tetcast-edit"

/* Where helper programs are: in the folders of $TETCAST_HELPERS, beside this program, or as installed. *out from
 * malloc. False: not there; places names where it was looked for. */
static bool tc_edit_locate(char **out, char *places, size_t capacity)
{
    static const char *const below[] = {"/../libexec/tetcast", "/../lib/tetcast", ""};
    char *self = realpath("/proc/self/exe", NULL), *slash = self ? strrchr(self, '/') : NULL;
    const char *folder = secure_getenv("TETCAST_HELPERS");
    size_t used = 0;
    *out = NULL;
    *places = 0;
    if (slash)
        *slash = 0;
    for (size_t i = 0; !*out;) {
        char *path = NULL;
        int length;
        if (folder && *folder) {
            length = (int)strcspn(folder, ":");
            if (asprintf(&path, "%.*s/" TC_EDIT_PROGRAM, length, folder) < 0)
                path = NULL;
            used += (size_t)snprintf(places + used, capacity - used, "%s%.*s", used ? ", " : "", length, folder);
            folder += length + (folder[length] == ':');
        } else if (slash && i < sizeof below / sizeof *below) {
            if (asprintf(&path, "%s%s/" TC_EDIT_PROGRAM, self, below[i]) < 0)
                path = NULL;
            used += (size_t)snprintf(places + used, capacity - used, "%s%s%s", used ? ", " : "", self, below[i]);
            i++;
        } else {
            break;
        }
        used = used < capacity ? used : capacity - 1;
        if (path && access(path, X_OK) == 0)
            *out = path;
        else
            free(path);
    }
    free(self);
    return *out != NULL;
}

static bool tc_is_set(const char *name)
{
    const char *value = getenv(name);
    return value && *value;
}

/* Only returns when it could not be run. */
static int tc_edit_become(const char *path, tc_talk *talk, int argc, char **argv)
{
    char **word = calloc((size_t)argc + 3, sizeof *word);
    int n = 0;
    if (!word) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    word[n++] = argv[0];
    if (talk->quiet)
        word[n++] = "--quiet";
    if (talk->verbose)
        word[n++] = "--verbose";
    for (int i = 1; i < argc; i++)
        word[n++] = argv[i];
    fflush(stdout);
    execv(path, word);
    tc_talk_error(talk, "%s could not be started: %s", path, strerror(errno));
    free(word);
    return TC_EXIT_FAILED;
}

static int tc_edit_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_edit_command values = {0};
    const char *input = NULL;
    char *path = NULL, places[1024];
    int n_input = 0;
    int code = tc_options_parse(&values, &input, &n_input, talk, command, argc, argv);
    tc_render_command_finish(&values.render);
    if (code >= 0)
        return code;
    if (!tc_edit_locate(&path, places, sizeof places))
        tc_talk_error(talk,
                      "the program " TC_EDIT_PROGRAM
                      " of the window was not found (searched %s): it is built where GTK 4 "
                      "is; install libgtk-4-dev and build again",
                      places);
    else if (!tc_is_set("DISPLAY") && !tc_is_set("WAYLAND_DISPLAY"))
        tc_talk_error(talk,
                      "there is no display to open a window on: neither DISPLAY nor WAYLAND_DISPLAY is set; run it "
                      "in a desktop, by ssh -X, or under xvfb-run (tetcast render makes pictures without one)");
    else
        tc_edit_become(path, talk, argc, argv);
    free(path);
    return TC_EXIT_FAILED;
}

static const tc_option tc_edit_option[] = {
    {.kind = TC_OPTION_HEADING, .help = "Window"},
    {"--trace", 0, "FILE", "write what happened when, in the Trace Event Format (Perfetto, chrome://tracing)",
     TC_OPTION_TEXT, .at = offsetof(tc_edit_command, trace)},
};

const tc_command tc_command_edit = {
    .name = "edit",
    .arguments = "INPUT",
    .what = "A window in which a transfer function is made, over the live picture.",
    .about =
        "INPUT and the options are those of render; what it begins with. No picture is written but from the window.",
    .own = tc_edit_option,
    .n_own = sizeof tc_edit_option / sizeof *tc_edit_option,
    .option = tc_render_option,
    .n_option = TC_N_RENDER_OPTION,
    .also = tc_look_option,
    .n_also = TC_N_LOOK_OPTION,
    .also_at = offsetof(tc_edit_command, render) + offsetof(tc_render_command, look),
    .given = offsetof(tc_edit_command, render) + offsetof(tc_render_command, given) + 1,
    .least = 1,
    .most = 1,
    .run = tc_edit_run,
};
