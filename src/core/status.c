/* status.c: making and passing errors. */
#include "core/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

tc_status tc_fail(tc_error *err, tc_status code, const char *format, ...)
{
    if (err) {
        va_list args;
        va_start(args, format);
        vsnprintf(err->text, sizeof err->text, format, args);
        va_end(args);
        err->code = code;
    }
    return code;
}

tc_status tc_fail_prefix(tc_error *err, tc_status code, const char *format, ...)
{
    if (!err)
        return code;
    char prefix[sizeof err->text], rest[sizeof err->text];
    va_list args;
    va_start(args, format);
    vsnprintf(prefix, sizeof prefix, format, args);
    va_end(args);
    memcpy(rest, err->text, sizeof rest);
    size_t n = strlen(prefix);
    memcpy(err->text, prefix, n);
    size_t room = sizeof err->text - n - 1, m = strlen(rest);
    if (m > room)
        m = room;
    memcpy(err->text + n, rest, m);
    err->text[n + m] = 0;
    if (err->code == TC_OK)
        err->code = code;
    return err->code;
}

void tc_say(const tc_log *log, tc_level level, const char *format, ...)
{
    if (!log || !log->message)
        return;
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    log->message(log->user, level, text);
}

void tc_progress(const tc_log *log, const char *what, double fraction)
{
    if (log && log->progress)
        log->progress(log->user, what, fraction);
}

const char *tc_version(void)
{
    return TC_VERSION_STRING;
}
