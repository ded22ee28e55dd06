/* report.c: how a batch tells of its frames. */
#define _GNU_SOURCE
#include "cli/batch/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { TC_LISTED = 20, TC_BAR = 24 };
#define TC_BAR_EVERY_S 0.1

void tc_report_begin(tc_report *out, tc_talk *talk, bool json, size_t all)
{
    *out = (tc_report){.talk = talk, .json = json, .all = all, .start_s = tc_talk_clock_s()};
}

void tc_report_event(tc_report *r, const char *event, json_t *values)
{
    if (!r->json) {
        json_decref(values);
        return;
    }
    json_t *line = json_object();
    json_object_set_new(line, "event", json_string(event));
    json_object_update(line, values);
    json_decref(values);
    char *text = json_dumps(line, JSON_COMPACT | JSON_REAL_PRECISION(15));
    json_decref(line);
    if (text)
        printf("%s\n", text);
    fflush(stdout); /* who reads it waits for it */
    free(text);
}

static void tc_failure_add(tc_report *r, const char *file, const char *why, size_t frames)
{
    tc_failure *more = realloc(r->failure, (r->n_failure + 1) * sizeof *more);
    if (!more)
        return;
    r->failure = more;
    r->failure[r->n_failure++] = (tc_failure){strdup(file ? file : ""), strdup(why ? why : ""), frames};
}

/* "3 h 20 min", "4 min 10 s", "12 s" */
static void tc_duration_text(char *out, size_t capacity, double seconds)
{
    const double s = seconds < 0 ? 0 : seconds;
    if (s >= 3600)
        snprintf(out, capacity, "%.0f h %02.0f min", floor(s / 3600), floor(fmod(s, 3600) / 60));
    else if (s >= 60)
        snprintf(out, capacity, "%.0f min %02.0f s", floor(s / 60), floor(fmod(s, 60)));
    else
        snprintf(out, capacity, "%.0f s", s);
}

static size_t tc_report_count(const tc_report *r)
{
    return r->done + r->kept + r->failed;
}

void tc_report_bar(tc_report *r, const char *file)
{
    tc_talk *talk = r->talk;
    const double now = tc_talk_clock_s();
    const size_t n = tc_report_count(r);
    if (!talk->terminal || talk->quiet || r->all == 0 || (now - r->line_at_s < TC_BAR_EVERY_S && n < r->all))
        return;
    r->line_at_s = now;
    char bar[TC_BAR + 1], left[64] = "", rate[48] = "";
    const int filled = (int)(TC_BAR * n / r->all);
    for (int i = 0; i < TC_BAR; i++)
        bar[i] = i < filled ? '#' : '.';
    bar[TC_BAR] = 0;
    const double per_s = (double)r->done / fmax(now - r->start_s, 1e-9);
    if (r->done > 1) {
        char text[32];
        tc_duration_text(text, sizeof text, (double)(r->all - n) / per_s);
        snprintf(left, sizeof left, ", %s left", text);
        snprintf(rate, sizeof rate, " %.3g/s", per_s);
    }
    struct winsize size;
    int width = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
    char line[512];
    int used = snprintf(line, sizeof line, "[%s] %zu/%zu%s%s  ", bar, n, r->all, rate, left);
    const char *name = file ? file : "";
    const int room = width - 1 - used, length = (int)strlen(name);
    fprintf(stderr, "\r\033[K%.*s%s", width - 1, line, room > 4 ? (length > room ? name + length - room : name) : "");
    fflush(stderr);
    talk->line_open = true;
}

void tc_report_frame(tc_report *r, tc_frame_end end, size_t number, const char *file, int step, double time,
                     const char *why, double ms, size_t bytes)
{
    static const char *const name[] = {"done", "kept", "failed"};
    r->done += end == TC_FRAME_DONE;
    r->kept += end == TC_FRAME_KEPT;
    if (end == TC_FRAME_FAILED) {
        r->failed++;
        tc_failure_add(r, file, why, 1);
    }
    if (r->json) {
        json_t *values = json_object();
        json_object_set_new(values, "status", json_string(name[end]));
        json_object_set_new(values, "frame", json_integer((json_int_t)number));
        tc_json_text(values, "file", file);
        json_object_set_new(values, "step", json_integer(step));
        tc_json_real(values, "time", time);
        tc_json_measured(values, "write_ms", ms);
        if (bytes > 0)
            json_object_set_new(values, "bytes", json_integer((json_int_t)bytes));
        if (why && *why)
            tc_json_text(values, "error", why);
        json_object_set_new(values, "finished", json_integer((json_int_t)tc_report_count(r)));
        json_object_set_new(values, "frames", json_integer((json_int_t)r->all));
        tc_report_event(r, "frame", values);
    }
    if (r->talk->terminal)
        tc_report_bar(r, file);
    else if (end == TC_FRAME_DONE && !r->json && !r->talk->quiet) /* whatever step is at hand */
        fprintf(stderr, "tetcast: wrote %s (%zu of %zu)\n", file, tc_report_count(r), r->all);
}

void tc_report_failed(tc_report *r, const char *file, const char *why, size_t frames)
{
    r->failed += frames;
    tc_failure_add(r, file, why, frames);
    if (r->json) {
        json_t *values = json_object();
        tc_json_text(values, "file", file);
        tc_json_text(values, "error", why);
        json_object_set_new(values, "frames_failed", json_integer((json_int_t)frames));
        tc_report_event(r, "failed", values);
    }
}

/* left: frames that were not begun, since the run ended before. */
static void tc_failures_list(const tc_report *r, size_t left)
{
    if (r->failed == 0)
        return;
    tc_talk_error(r->talk, "%zu of %zu frames are missing:", r->failed + left, r->all);
    for (size_t i = 0; i < r->n_failure && i < TC_LISTED; i++) {
        const tc_failure *one = &r->failure[i];
        const bool named = !*one->file || !strncmp(one->why, one->file, strlen(one->file)); /* by the sentence itself */
        fprintf(stderr, "  %s%s%s\n", named ? "" : one->file, named ? "" : ": ", one->why);
    }
    if (r->n_failure > TC_LISTED)
        fprintf(stderr, "  … and %zu more\n", r->n_failure - TC_LISTED);
    if (left > 0)
        fprintf(stderr, "  and %zu that were not begun\n", left);
}

/* What was made, how fast, and within which memory [MiB]. */
static void tc_summary_say(const tc_report *r, double seconds, double self, double helper)
{
    char took[64], kept[64] = "";
    const double rate = 60 * (double)r->done / fmax(seconds, 1e-9);
    tc_duration_text(took, sizeof took, seconds);
    if (r->all == 0) {
        tc_talk_say(r->talk, "none of the frames is of this shard: there are fewer of them than shards");
        return;
    }
    if (r->kept == r->all) {
        tc_talk_say(r->talk, "all %zu frames are there, so none is made; at most %.1f MiB of memory, helpers %.1f MiB",
                    r->all, self, helper);
        return;
    }
    if (r->kept)
        snprintf(kept, sizeof kept, ", %zu were there", r->kept);
    tc_talk_say(r->talk, "%zu of %zu frames made%s, in %s (%.*f a minute); at most %.1f MiB of memory, helpers %.1f MiB",
                r->done, r->all, kept, took, rate < 9.95 ? 1 : 0, rate, self, helper);
}

void tc_report_end(tc_report *r, const char *stopped)
{
    const double seconds = tc_talk_clock_s() - r->start_s;
    size_t self = 0, helper = 0;
    tc_memory_peak(&self, &helper);
    tc_summary_say(r, seconds, (double)self / 1048576, (double)helper / 1048576);
    tc_failures_list(r, stopped ? 0 : r->all - tc_report_count(r));
    if (stopped)
        tc_talk_error(r->talk, "stopped by %s after %zu of %zu frames: the same command with --resume goes on", stopped,
                      tc_report_count(r), r->all);
    json_t *values = json_object();
    json_object_set_new(values, "frames", json_integer((json_int_t)r->all));
    json_object_set_new(values, "done", json_integer((json_int_t)r->done));
    json_object_set_new(values, "kept", json_integer((json_int_t)r->kept));
    json_object_set_new(values, "failed", json_integer((json_int_t)r->failed));
    tc_json_measured(values, "seconds", seconds);
    json_object_set_new(values, "peak_bytes", json_integer((json_int_t)self));
    json_object_set_new(values, "helper_peak_bytes", json_integer((json_int_t)helper));
    if (stopped)
        tc_json_text(values, "stopped", stopped);
    tc_report_event(r, "end", values);
}

void tc_report_finish(tc_report *r)
{
    for (size_t i = 0; i < r->n_failure; i++) {
        free(r->failure[i].file);
        free(r->failure[i].why);
    }
    free(r->failure);
    *r = (tc_report){0};
}
