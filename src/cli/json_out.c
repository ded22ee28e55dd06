/* json_out.c: JSON to a file beside its final name, then renamed; or to stdout. */
#define _GNU_SOURCE
#include "cli/json_out.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define TC_JSON_FLAGS (JSON_INDENT(2) | JSON_REAL_PRECISION(12))

void tc_json_text(json_t *object, const char *key, const char *text)
{
    if (!text || !*text)
        return;
    json_t *string = json_string(text);
    if (!string) { /* not UTF-8: keep what is ASCII */
        char *copy = strdup(text);
        for (char *c = copy; c && *c; c++)
            if ((unsigned char)*c >= 0x80)
                *c = '?';
        string = copy ? json_string(copy) : NULL;
        free(copy);
    }
    json_object_set_new(object, key, string);
}

void tc_json_real(json_t *object, const char *key, double value)
{
    if (isfinite(value))
        json_object_set_new(object, key, json_real(value));
}

void tc_json_measured(json_t *object, const char *key, double value)
{
    if (value >= 0)
        tc_json_real(object, key, value);
}

void tc_json_count(json_t *object, const char *key, uint64_t value)
{
    json_object_set_new(object, key, json_integer((json_int_t)value));
}

void tc_json_measured_count(json_t *object, const char *key, int64_t value)
{
    if (value >= 0)
        tc_json_count(object, key, (uint64_t)value);
}

json_t *tc_json_reals(const double *value, size_t n)
{
    json_t *array = json_array();
    for (size_t i = 0; i < n; i++)
        json_array_append_new(array, isfinite(value[i]) ? json_real(value[i]) : json_null());
    return array;
}

static int tc_write_failed(tc_talk *talk, const char *path)
{
    tc_talk_error(talk, "%s could not be written: %s", path, strerror(errno));
    return TC_EXIT_FAILED;
}

/* Writes to an open stream and closes it. */
static bool tc_json_put(const json_t *json, FILE *stream, bool close)
{
    errno = 0;
    bool good = json_dumpf(json, stream, TC_JSON_FLAGS) == 0 && fputc('\n', stream) != EOF && fflush(stream) == 0;
    int first = errno;
    if (close && fclose(stream) != 0 && good) {
        good = false;
        first = errno;
    }
    errno = first ? first : EIO;
    return good;
}

/* Beside `target`, then renamed onto it. */
static int tc_json_replace(const json_t *json, const char *target, tc_talk *talk)
{
    char *beside = NULL;
    int code = TC_EXIT_FAILED;
    if (asprintf(&beside, "%s.XXXXXX", target) < 0) {
        beside = NULL;
        return tc_write_failed(talk, target);
    }
    int fd = mkstemp(beside);
    FILE *stream = fd < 0 ? NULL : fdopen(fd, "w");
    if (!stream) {
        tc_write_failed(talk, target);
        if (fd >= 0)
            close(fd);
    } else {
        mode_t mask = umask(0);
        umask(mask);
        bool good = fchmod(fd, 0666 & ~mask) == 0;
        good = tc_json_put(json, stream, true) && good;
        if (good && rename(beside, target) == 0)
            code = -1;
        else
            tc_write_failed(talk, target);
    }
    if (code != -1 && fd >= 0)
        unlink(beside);
    free(beside);
    return code;
}

int tc_json_write(const json_t *json, const char *path, tc_talk *talk)
{
    struct stat info;
    if (!strcmp(path, "-"))
        return tc_json_put(json, stdout, false) ? -1 : TC_EXIT_FAILED; /* tc_talk_finish says why */
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode)) {
        FILE *device = fopen(path, "w"); /* a device or a pipe is written to, never replaced */
        if (!device)
            return tc_write_failed(talk, path);
        return tc_json_put(json, device, true) ? -1 : tc_write_failed(talk, path);
    }
    char *real = realpath(path, NULL); /* a link keeps pointing to its file */
    int code = tc_json_replace(json, real ? real : path, talk);
    free(real);
    return code;
}

int tc_output_check(const char *path, tc_talk *talk)
{
    struct stat info;
    if (!strcmp(path, "-"))
        return -1;
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode)) {
            tc_talk_error(talk, "%s is a folder: give the name of a file in it", path);
            return TC_EXIT_FAILED;
        }
        if (!S_ISREG(info.st_mode))
            return -1;
    }
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
    if (!folder) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    int code = -1;
    if (access(folder, W_OK | X_OK) != 0) {
        tc_talk_error(talk, "%s cannot be written: folder %s: %s%s", path, folder, strerror(errno),
                      errno == ENOENT ? "; make it first" : "");
        code = TC_EXIT_FAILED;
    }
    free(folder);
    return code;
}
