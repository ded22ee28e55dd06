/* series.c: which files a scene's data are over time. */
#define _GNU_SOURCE
#include "cli/batch/series.h"
#include "cli/nearest.h"

#include <dirent.h>
#include <errno.h>
#include <glob.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { TC_GAPS_NAMED = 8, TC_DIGITS_MOST = 18 };

static int tc_out_of_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

static bool tc_is_digit(char c)
{
    return c >= '0' && c <= '9';
}

int tc_natural_compare(const char *a, const char *b)
{
    const char *whole_a = a, *whole_b = b;
    while (*a && *b) {
        if (tc_is_digit(*a) && tc_is_digit(*b)) {
            a += strspn(a, "0");
            b += strspn(b, "0");
            const size_t na = strspn(a, "0123456789"), nb = strspn(b, "0123456789");
            const int order = na != nb ? (na < nb ? -1 : 1) : strncmp(a, b, na);
            if (order != 0)
                return order;
            a += na;
            b += nb;
        } else if (*a != *b) {
            break;
        } else {
            a++;
            b++;
        }
    }
    if (*a != *b)
        return (unsigned char)*a < (unsigned char)*b ? -1 : 1;
    return strcmp(whole_a, whole_b); /* they differ by leading zeros at most */
}

static bool tc_is_there(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0;
}

/* Takes path over. */
static int tc_path_add(tc_series *out, char *path, tc_talk *talk)
{
    char **more = path && out->n < INT_MAX ? realloc(out->path, (out->n + 1) * sizeof *more) : NULL;
    if (!more) {
        free(path);
        return tc_out_of_memory(talk);
    }
    out->path = more;
    out->path[out->n++] = path;
    return -1;
}

/* -------------------------------------------------------------------------------------------------- nothing there */

/* Says that nothing is at path, whose bytes before `plain` are no pattern: which folder, and what in it is nearest. */
static int tc_refuse_absent(const char *path, size_t plain, bool pattern, tc_talk *talk)
{
    size_t length = plain;
    while (length > 0 && path[length - 1] != '/')
        length--;
    char *folder = length > 0 ? strndup(path, length) : strdup("."), *best = NULL;
    char *name = strndup(path + length, strcspn(path + length, "/"));
    tc_nearest search = {.name = name};
    unsigned distance = 0;
    DIR *dir = folder && name ? opendir(folder) : NULL;
    for (struct dirent *entry; dir && (entry = readdir(dir));) {
        if (entry->d_name[0] == '.')
            continue;
        search.best = NULL;
        tc_nearest_offer(&search, entry->d_name);
        if (best && (search.distance > distance ||
                     (search.distance == distance && tc_natural_compare(entry->d_name, best) >= 0)))
            continue;
        free(best);
        best = strdup(entry->d_name);
        distance = search.distance;
    }
    if (!folder || !name) {
        tc_out_of_memory(talk);
    } else if (!dir) {
        tc_talk_error(talk, "%s: the folder %s cannot be read: %s; check the path", path, folder, strerror(errno));
    } else {
        tc_talk_error(talk, "%s: %s in the folder %s; %s%s%s", path,
                      pattern ? "no file matches" : "there is no such file", folder,
                      best ? "the nearest there is '" : "it is empty", best ? best : "", best ? "'" : "");
    }
    if (dir)
        closedir(dir);
    free(folder);
    free(name);
    free(best);
    return TC_EXIT_FAILED;
}

/* ------------------------------------------------------------------------------------------------------- patterns */

/* The files that match a pattern of glob's, sorted by names; those in `files` are its to be freed with globfree. */
static int tc_files_find(glob_t *files, const char *pattern, tc_talk *talk)
{
    const int result = glob(pattern, GLOB_NOSORT, NULL, files);
    if (result == 0 || result == GLOB_NOMATCH)
        return -1;
    return tc_out_of_memory(talk); /* GLOB_ABORTED is not given without GLOB_ERR */
}

static int tc_by_name(const void *a, const void *b)
{
    return tc_natural_compare(*(char *const *)a, *(char *const *)b);
}

static bool tc_is_file(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

/* text with what glob takes for a pattern escaped, behind what is in out. */
static void tc_glob_escape(char *out, const char *text)
{
    out += strlen(out);
    for (; *text; text++) {
        if (strchr("*?[]\\", *text))
            *out++ = '\\';
        *out++ = *text;
    }
    *out = 0;
}

/* A pattern with * ? [; path is that of it, its first `folder` bytes are no part of the pattern. */
static int tc_wild_add(tc_series *out, const char *path, size_t folder, tc_talk *talk)
{
    glob_t files = {0};
    const size_t before = out->n;
    char *lead = strndup(path, folder), *pattern = malloc(folder + strlen(path) + 1);
    int code = lead && pattern ? -1 : tc_out_of_memory(talk);
    if (code < 0) {
        *pattern = 0;
        tc_glob_escape(pattern, lead);
        strcat(pattern, path + folder);
        code = tc_files_find(&files, pattern, talk);
    }
    free(lead);
    free(pattern);
    for (size_t i = 0; i < files.gl_pathc && code < 0; i++)
        if (tc_is_file(files.gl_pathv[i]))
            code = tc_path_add(out, strdup(files.gl_pathv[i]), talk);
    globfree(&files);
    if (code < 0 && out->n == before)
        return tc_refuse_absent(path, folder + strcspn(path + folder, "*?["), true, talk);
    if (code < 0)
        qsort(out->path + before, out->n - before, sizeof *out->path, tc_by_name);
    return code;
}

/* A pattern with one number in it. */
typedef struct tc_numbered {
    const char *text;
    char *before, *after; /* what stands around the number */
    size_t plain;         /* bytes of the text before the number */
    int width;            /* digits at least; 0: any, without leading zeros */
} tc_numbered;

/* Bytes of a number's format at text, which begins with %; 0: it is none. */
static size_t tc_format_length(int *width, const char *text)
{
    const bool padded = text[1] == '0' || text[1] == '.';
    const char *at = text + 1 + padded;
    const size_t digits = padded ? strspn(at, "0123456789") : 0;
    *width = digits > 0 && digits <= 2 ? atoi(at) : 0;
    if (at[digits] != 'd' || *width > TC_DIGITS_MOST || digits > 2 || (padded && digits == 0))
        return 0;
    return (size_t)(at - text) + digits + 1;
}

/* Splits a path at its number, which is not in its first `folder` bytes. False: it has none, or more than one, or a
 * wrong one, which why says then. */
static bool tc_numbered_split(tc_numbered *out, const char *path, size_t folder, char *why, size_t capacity)
{
    char *into = out->before;
    bool found = false;
    out->text = path;
    memcpy(into, path, folder);
    into += folder;
    for (const char *at = path + folder; *at;) {
        int width;
        size_t length = *at == '%' ? tc_format_length(&width, at) : 0;
        if (at[0] == '%' && at[1] == '%') {
            *into++ = '%';
            at += 2;
        } else if (*at != '%') {
            *into++ = *at++;
        } else if (length == 0 || found) {
            if (found)
                snprintf(why, capacity, "has two numbers; a series has one");
            else
                snprintf(why, capacity, "has a %% that begins no number: write %%d or %%04d, and %%%% for a per cent");
            return false;
        } else {
            *into = 0;
            into = out->after;
            out->width = width;
            out->plain = (size_t)(at - path);
            at += length;
            found = true;
        }
    }
    *into = 0;
    return found;
}

/* A file of a numbered series. */
typedef struct tc_part {
    long long number;
    char *path;
} tc_part;

static int tc_by_number(const void *a, const void *b)
{
    const long long x = ((const tc_part *)a)->number, y = ((const tc_part *)b)->number;
    return (x > y) - (x < y);
}

/* The number of a file of the series; -1: it is none of it. */
static long long tc_number_of(const tc_numbered *p, const char *path)
{
    const size_t before = strlen(p->before), after = strlen(p->after), length = strlen(path);
    if (length <= before + after || strncmp(path, p->before, before) != 0 ||
        strcmp(path + length - after, p->after) != 0)
        return -1;
    const char *digits = path + before;
    const size_t n = length - before - after;
    if (strspn(digits, "0123456789") < n || n > TC_DIGITS_MOST || n < (size_t)p->width ||
        (n > 1 && n > (size_t)p->width && *digits == '0'))
        return -1;
    return strtoll(digits, NULL, 10);
}

/* Warns of numbers that are left out: those by which the others would go on in the series' smallest stride. */
static void tc_gaps_tell(const char *pattern, const tc_part *part, size_t n, tc_talk *talk)
{
    long long stride = LLONG_MAX, missing = 0;
    char list[TC_GAPS_NAMED * 24] = "";
    size_t length = 0;
    for (size_t i = 1; i < n; i++)
        if (part[i].number - part[i - 1].number < stride)
            stride = part[i].number - part[i - 1].number;
    for (size_t i = 1; i < n; i++) {
        const long long gone = (part[i].number - part[i - 1].number - 1) / stride;
        for (long long k = 1; k <= gone && missing + k <= TC_GAPS_NAMED; k++)
            length += (size_t)snprintf(list + length, sizeof list - length, "%s%lld", missing + k > 1 ? ", " : "",
                                       part[i - 1].number + k * stride);
        missing += gone;
    }
    if (missing > TC_GAPS_NAMED)
        tc_talk_warning(talk, "%s: of the numbers %lld to %lld there are no files for %s and %lld more", pattern,
                        part[0].number, part[n - 1].number, list, missing - TC_GAPS_NAMED);
    else if (missing > 0)
        tc_talk_warning(talk, "%s: of the numbers %lld to %lld there %s for %s", pattern, part[0].number,
                        part[n - 1].number, missing > 1 ? "are no files" : "is no file", list);
}

/* The files of a series from among those that glob gives, by number. */
static int tc_numbered_take(tc_series *out, const tc_numbered *pattern, const glob_t *files, tc_talk *talk)
{
    size_t n = 0;
    tc_part *part = calloc(files->gl_pathc + 1, sizeof *part);
    if (!part)
        return tc_out_of_memory(talk);
    for (size_t i = 0; i < files->gl_pathc; i++) {
        const long long number = tc_number_of(pattern, files->gl_pathv[i]);
        if (number >= 0 && tc_is_there(files->gl_pathv[i]))
            part[n++] = (tc_part){number, files->gl_pathv[i]};
    }
    qsort(part, n, sizeof *part, tc_by_number);
    int code = n > 0 ? -1 : tc_refuse_absent(pattern->text, pattern->plain, true, talk);
    for (size_t i = 0; i < n && code < 0; i++)
        code = tc_path_add(out, strdup(part[i].path), talk);
    if (code < 0)
        tc_gaps_tell(pattern->text, part, n, talk);
    free(part);
    return code;
}

/* A pattern with %d; path and folder as of tc_wild_add. */
static int tc_numbered_add(tc_series *out, const char *path, size_t folder, tc_talk *talk)
{
    const size_t room = strlen(path) + 1;
    char why[128] = "";
    tc_numbered pattern = {.before = malloc(room), .after = malloc(room)};
    char *wild = malloc(2 * room + 8);
    glob_t files = {0};
    int code = -1;
    if (!pattern.before || !pattern.after || !wild) {
        code = tc_out_of_memory(talk);
    } else if (!tc_numbered_split(&pattern, path, folder, why, sizeof why)) {
        if (*why)
            tc_talk_error(talk, "%s %s", path, why);
        code = *why ? TC_EXIT_FAILED : tc_refuse_absent(pattern.before, strlen(pattern.before), false, talk);
    } else {
        *wild = 0;
        tc_glob_escape(wild, pattern.before);
        strcat(wild, "[0-9]*");
        tc_glob_escape(wild, pattern.after);
        code = tc_files_find(&files, wild, talk);
        if (code < 0)
            code = tc_numbered_take(out, &pattern, &files, talk);
        globfree(&files);
    }
    free(pattern.before);
    free(pattern.after);
    free(wild);
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

/* One text of the data, behind what is in *out. alone: it is not of a list. */
static int tc_data_add(tc_series *out, const char *folder, const char *text, bool alone, tc_talk *talk)
{
    char *path = NULL;
    const bool synthetic = !strncmp(text, "synth:", 6);
    const bool led = folder && *folder && *text != '/' && !synthetic;
    const size_t lead = led ? strlen(folder) + 1 : 0;
    if (asprintf(&path, "%s%s%s", led ? folder : "", led ? "/" : "", text) < 0)
        return tc_out_of_memory(talk);
    if (synthetic || tc_is_there(path) || (!alone && !strpbrk(text, "%*?[")))
        return tc_path_add(out, path, talk);
    int code;
    out->of_files = true;
    if (strchr(text, '%'))
        code = tc_numbered_add(out, path, lead, talk);
    else if (strpbrk(text, "*?["))
        code = tc_wild_add(out, path, lead, talk);
    else
        code = tc_refuse_absent(path, strlen(path), false, talk);
    free(path);
    return code;
}

static int tc_refuse_data(tc_talk *talk)
{
    tc_talk_error(talk,
                  "data takes the name of a file, a pattern of names (run_%%04d.vtu, run_*.vtu), or a list of them");
    return TC_EXIT_FAILED;
}

/* Is one of the paths there? */
static int tc_list_check(const tc_series *series, tc_talk *talk)
{
    for (size_t i = 0; i < series->n; i++)
        if (!strncmp(series->path[i], "synth:", 6) || tc_is_there(series->path[i]))
            return -1;
    return tc_refuse_absent(series->path[0], strlen(series->path[0]), false, talk);
}

static int tc_times_take(tc_series *out, const json_t *times, tc_talk *talk)
{
    if (times && !json_is_null(times) && !out->of_files) {
        tc_talk_error(talk,
                      "times belong to a series of files, and %s is one file with times of its own: leave them out",
                      out->path[0]);
        return TC_EXIT_FAILED;
    }
    if (!out->of_files)
        return -1;
    out->time = malloc(out->n * sizeof *out->time);
    if (!out->time)
        return tc_out_of_memory(talk);
    for (size_t i = 0; i < out->n; i++)
        out->time[i] = (double)i;
    if (!times || json_is_null(times))
        return -1;
    if (!json_is_array(times) || json_array_size(times) != out->n) {
        tc_talk_error(talk, "times takes a list of as many numbers as there are files: %zu, not %zu", out->n,
                      json_array_size(times));
        return TC_EXIT_FAILED;
    }
    for (size_t i = 0; i < out->n; i++) {
        const json_t *value = json_array_get(times, i);
        out->time[i] = json_number_value(value);
        if (!json_is_number(value) || !isfinite(out->time[i]) || (i > 0 && !(out->time[i] > out->time[i - 1]))) {
            tc_talk_error(talk, "times[%zu] is no number above the one before it: times ascend", i);
            return TC_EXIT_FAILED;
        }
    }
    return -1;
}

int tc_series_make(tc_series *out, const json_t *data, const json_t *times, const char *folder, tc_talk *talk)
{
    *out = (tc_series){.of_files = json_is_array(data)};
    int code = -1;
    if (json_is_string(data) && json_string_length(data) > 0) {
        code = tc_data_add(out, folder, json_string_value(data), true, talk);
    } else if (json_array_size(data) > 0) {
        for (size_t i = 0; i < json_array_size(data) && code < 0; i++) {
            const json_t *one = json_array_get(data, i);
            code = json_is_string(one) && json_string_length(one) > 0
                       ? tc_data_add(out, folder, json_string_value(one), false, talk)
                       : tc_refuse_data(talk);
        }
        if (code < 0)
            code = tc_list_check(out, talk);
    } else {
        code = tc_refuse_data(talk);
    }
    return code < 0 ? tc_times_take(out, times, talk) : code;
}

void tc_series_finish(tc_series *series)
{
    for (size_t i = 0; i < series->n; i++)
        free(series->path[i]);
    free(series->path);
    free(series->time);
    *series = (tc_series){0};
}
