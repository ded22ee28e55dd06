/* stop.c: signals that ask a batch to stop. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/stop.h"

#include <signal.h>
#include <stddef.h>

static volatile sig_atomic_t tc_stop_signal, tc_stop_listens;

static void tc_on_signal(int number)
{
    if (tc_stop_listens)
        tc_stop_signal = number;
    else
        raise(number); /* what it does is as before again, once this function is left */
}

void tc_stop_prepare(void)
{
    struct sigaction action = {.sa_handler = tc_on_signal, .sa_flags = SA_RESTART | SA_RESETHAND}, before;
    sigemptyset(&action.sa_mask);
    static const int number[] = {SIGINT, SIGTERM};
    for (size_t i = 0; i < 2; i++) /* nohup and the like have them ignored */
        if (sigaction(number[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(number[i], &action, NULL);
    struct sigaction ignore = {.sa_handler =
                                   SIG_IGN}; /* a reader of the events that went away is an error of writing */
    sigemptyset(&ignore.sa_mask);
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGXFSZ, &ignore, NULL);
}

void tc_stop_listen(void)
{
    tc_stop_listens = 1;
}

const char *tc_stop_asked(void)
{
    return tc_stop_signal == SIGINT ? "SIGINT" : tc_stop_signal == SIGTERM ? "SIGTERM" : NULL;
}
