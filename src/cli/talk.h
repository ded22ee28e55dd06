/* talk.h: how the program talks: messages and progress on stderr, exit codes from statuses.
 * Colour follows NO_COLOR and the terminal; progress is drawn on a terminal only. */
#ifndef TC_CLI_TALK_H
#define TC_CLI_TALK_H

#include "tetcast.h"

#if defined(__GNUC__)
#define TC_CLI_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define TC_CLI_PRINTF(f, a)
#endif

/* Exit codes of every command but compare (interface of the program). */
enum { TC_EXIT_DONE = 0, TC_EXIT_FAILED = 1, TC_EXIT_USAGE = 2 };

typedef struct tc_talk {
    bool quiet, verbose;
    bool muted;    /* nothing is printed; errors are kept in last all the same */
    bool terminal; /* stderr is one that understands escape codes */
    bool colour;
    bool line_open;   /* a progress line is on the screen */
    double line_at_s; /* when it was last drawn */
    double start_s;   /* when the program began */
    char about[24];   /* stands before each message: "step 3"; "": nothing does */
    const char *from; /* stands before each error: the scene that the values come from, which makes a wrong value failed
                       * work; NULL: the command line */
    char last[1024];  /* the last error's sentence */
    tc_log log;       /* to hand to the library; its user is this struct */
} tc_talk;

/* Fills *talk; it must not move afterwards, since talk->log points to it. */
void tc_talk_init(tc_talk *talk);

/* Seconds of a clock that never goes back. */
double tc_talk_clock_s(void);

void tc_talk_error(tc_talk *talk, const char *format, ...) TC_CLI_PRINTF(2, 3);   /* always */
void tc_talk_always(tc_talk *talk, const char *format, ...) TC_CLI_PRINTF(2, 3);  /* a warning, even with --quiet */
void tc_talk_warning(tc_talk *talk, const char *format, ...) TC_CLI_PRINTF(2, 3); /* not with --quiet */
void tc_talk_say(tc_talk *talk, const char *format, ...) TC_CLI_PRINTF(2, 3);     /* not with --quiet */
void tc_talk_detail(tc_talk *talk, const char *format, ...) TC_CLI_PRINTF(2, 3);  /* only with --verbose */

/* Prints err's sentence. Gives the exit code: TC_E_ARG is a wrong command line, all else failed work. */
int tc_talk_status(tc_talk *talk, tc_status status, const tc_error *err);

/* Ends a progress line and checks that stdout took all that was written. Gives code, or TC_EXIT_FAILED. */
int tc_talk_finish(tc_talk *talk, int code);

#endif
