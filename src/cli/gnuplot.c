/* gnuplot.c: one script, run in its folder. */
#define _GNU_SOURCE
#include "cli/gnuplot.h"

#include <errno.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

bool tc_gnuplot_run(const char *folder, const char *script, tc_talk *talk)
{
    char program[] = "gnuplot", file[256];
    char *const arguments[] = {program, file, NULL};
    posix_spawn_file_actions_t actions;
    pid_t child;
    int how = 0;
    if (strlen(script) >= sizeof file) {
        tc_talk_warning(talk, "the name of %s is too long to draw it", script);
        return false;
    }
    strcpy(file, script);
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed == 0) {
        failed = posix_spawn_file_actions_addchdir_np(&actions, folder);
        if (failed == 0)
            failed = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", 0, 0);
        if (failed == 0)
            failed = posix_spawnp(&child, program, &actions, NULL, arguments, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    if (failed != 0) {
        tc_talk_warning(
            talk,
            "the plots are not drawn, because gnuplot cannot be run (%s); install gnuplot and draw them with "
            "cd %s && gnuplot *.gp",
            strerror(failed), folder);
        return false;
    }
    while (waitpid(child, &how, 0) < 0 && errno == EINTR)
        ;
    if (!WIFEXITED(how) || WEXITSTATUS(how) != 0) {
        tc_talk_warning(talk, "gnuplot could not draw %s/%s", folder, script);
        return false;
    }
    return true;
}
