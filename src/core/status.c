/* status.c: making and passing errors. */
#include "core/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Makes text one line that does nothing to a terminal: names and words that come from files may hold anything. Control
 * characters become '?' (line ends and tabs blanks), as do the C1 ones, which are two bytes in UTF-8; a character that
 * was cut off at the end goes. */
static void make_plain(char *text)
{
    unsigned char *s = (unsigned char *)text;
    size_t n = 0, start;
    for (; s[n]; n++) {
        if (s[n] == '\n' || s[n] == '\r' || s[n] == '\t')
            s[n] = ' ';
        else if (s[n] < ' ' || s[n] == 0x7f)
            s[n] = '?';
        else if (s[n] == 0xc2 && s[n + 1] >= 0x80 && s[n + 1] < 0xa0)
            s[n] = s[n + 1] = '?';
    }
    for (start = n; start > 0 && n - start < 3 && (s[start - 1] & 0xc0) == 0x80; start--)
        ;
    size_t length = start == 0 ? 0 : s[start - 1] >= 0xf0 ? 4 : s[start - 1] >= 0xe0 ? 3 : s[start - 1] >= 0xc0 ? 2 : 1;
    if (length > n - start + 1)
        s[start - 1] = 0;
}

tc_status tc_fail(tc_error *err, tc_status code, const char *format, ...)
{
    if (err) {
        va_list args;
        va_start(args, format);
        vsnprintf(err->text, sizeof err->text, format, args);
        va_end(args);
        make_plain(err->text);
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
    make_plain(err->text);
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
    make_plain(text);
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
