/* talk.c: messages and progress on stderr. */
#define _POSIX_C_SOURCE 200809L
#include "cli/talk.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define TC_PROGRESS_FIRST_S 0.3 /* work shorter than this draws no progress */
#define TC_PROGRESS_EVERY_S 0.1

double tc_talk_clock_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void tc_line_clear(tc_talk *talk)
{
    if (talk->line_open) {
        fputs("\r\033[K", stderr);
        talk->line_open = false;
    }
}

static void tc_message_print(tc_talk *talk, const char *kind, const char *colour, const char *format, va_list list)
{
    char text[sizeof talk->last];
    vsnprintf(text, sizeof text, format, list);
    if (kind && !strcmp(kind, "error"))
        memcpy(talk->last, text, sizeof text);
    if (talk->muted)
        return;
    tc_line_clear(talk);
    fputs("tetcast: ", stderr);
    if (kind) {
        if (talk->colour)
            fprintf(stderr, "\033[%sm%s:\033[0m ", colour, kind);
        else
            fprintf(stderr, "%s: ", kind);
    }
    if (*talk->about)
        fprintf(stderr, "%s: ", talk->about);
    if (talk->from && kind && !strcmp(kind, "error"))
        fprintf(stderr, "%s: ", talk->from);
    fprintf(stderr, "%s\n", text);
}

#define TC_TALK_VARIADIC(kind, colour)                                                                                 \
    do {                                                                                                               \
        va_list list;                                                                                                  \
        va_start(list, format);                                                                                        \
        tc_message_print(talk, kind, colour, format, list);                                                            \
        va_end(list);                                                                                                  \
    } while (0)

void tc_talk_error(tc_talk *talk, const char *format, ...)
{
    TC_TALK_VARIADIC("error", "1;31");
}

void tc_talk_always(tc_talk *talk, const char *format, ...)
{
    TC_TALK_VARIADIC("warning", "1;33");
}

void tc_talk_warning(tc_talk *talk, const char *format, ...)
{
    if (!talk->quiet)
        TC_TALK_VARIADIC("warning", "1;33");
}

void tc_talk_say(tc_talk *talk, const char *format, ...)
{
    if (!talk->quiet)
        TC_TALK_VARIADIC(NULL, "");
}

void tc_talk_detail(tc_talk *talk, const char *format, ...)
{
    if (talk->verbose)
        TC_TALK_VARIADIC(NULL, "");
}

static void tc_library_message(void *user, tc_level level, const char *text)
{
    if (level == TC_WARNING)
        tc_talk_warning(user, "%s", text);
    else
        tc_talk_detail(user, "%s", text);
}

static void tc_library_progress(void *user, const char *what, double fraction)
{
    tc_talk *talk = user;
    if (!talk->terminal || talk->quiet)
        return;
    double now = tc_talk_clock_s();
    if (now - talk->start_s < TC_PROGRESS_FIRST_S || now - talk->line_at_s < TC_PROGRESS_EVERY_S)
        return;
    talk->line_at_s = now;
    talk->line_open = true;
    if (fraction < 0)
        fprintf(stderr, "\r\033[K%s%s%.60s …", talk->about, *talk->about ? ": " : "", what);
    else
        fprintf(stderr, "\r\033[K%s%s%.60s %3.0f %%", talk->about, *talk->about ? ": " : "", what,
                100 * (fraction < 1 ? fraction : 1));
    fflush(stderr);
}

void tc_talk_init(tc_talk *talk)
{
    const char *no_color = getenv("NO_COLOR"), *term = getenv("TERM");
    memset(talk, 0, sizeof *talk);
    talk->terminal = isatty(STDERR_FILENO) && term && strcmp(term, "dumb") != 0;
    talk->colour = talk->terminal && !(no_color && *no_color);
    talk->start_s = tc_talk_clock_s();
    talk->log.message = tc_library_message;
    talk->log.progress = tc_library_progress;
    talk->log.user = talk;
}

int tc_talk_status(tc_talk *talk, tc_status status, const tc_error *err)
{
    tc_talk_error(talk, "%s", err->text[0] ? err->text : "the work failed and gave no reason");
    return status == TC_E_ARG ? TC_EXIT_USAGE : TC_EXIT_FAILED;
}

int tc_talk_finish(tc_talk *talk, int code)
{
    tc_line_clear(talk);
    const bool now = fflush(stdout) != 0; /* of what failed before the reason is not known any more */
    if (now || ferror(stdout)) {
        tc_talk_error(talk, "stdout could not be written%s%s", now ? ": " : "; its reader may have gone away",
                      now ? strerror(errno) : "");
        return TC_EXIT_FAILED;
    }
    return talk->from && code == TC_EXIT_USAGE ? TC_EXIT_FAILED : code;
}
