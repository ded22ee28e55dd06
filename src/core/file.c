/* file.c: files that appear whole or not at all. */
#define _GNU_SOURCE
#include "core/file.h"
#include "core/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static tc_status fail_write(tc_error *err, const char *name, int code)
{
    const char *remedy = "";
    if (code == ENOSPC || code == EDQUOT || code == EFBIG)
        remedy = "; free some space or choose another place";
    else if (code == ENOENT || code == ENOTDIR)
        remedy = "; make its folder first";
    else if (code == EACCES || code == EPERM || code == EROFS)
        remedy = "; choose a folder that you may write to";
    else if (code == EISDIR)
        remedy = "; give a file name, not a folder";
    return tc_fail(err, TC_E_FILE, "%s cannot be written: %s%s", name, strerror(code), remedy);
}

tc_status tc_file_write(int fd, const void *data, size_t bytes, const char *name, tc_error *err)
{
    const char *p = data;
    while (bytes > 0) {
        ssize_t n = write(fd, p, bytes < (1u << 30) ? bytes : (1u << 30));
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return fail_write(err, name, n < 0 ? errno : ENOSPC);
        p += n, bytes -= (size_t)n;
    }
    return TC_OK;
}

/* Opens a new file beside target; *path is its name, which the caller frees. -1 and errno on failure. */
static int open_beside(char **path, const char *target)
{
    const char *slash = strrchr(target, '/');
    int folder = slash ? (int)(slash - target) + 1 : 0;
    for (int attempt = 0;; attempt++) {
        struct timespec t;
        clock_gettime(CLOCK_REALTIME, &t);
        if (asprintf(path, "%.*s.tetcast-%ld-%ld-%d.tmp", folder, target, (long)getpid(), t.tv_nsec, attempt) < 0) {
            *path = NULL;
            errno = ENOMEM;
            return -1;
        }
        int fd = open(*path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0)
            return fd;
        int code = errno;
        free(*path);
        *path = NULL;
        errno = code;
        if (code != EEXIST || attempt >= 100)
            return -1;
    }
}

static tc_status write_parts(int fd, const tc_file_part *part, size_t n, const char *name, tc_error *err)
{
    tc_status status = TC_OK;
    for (size_t i = 0; i < n && status == TC_OK; i++)
        status = tc_file_write(fd, part[i].data, part[i].bytes, name, err);
    return status;
}

static tc_status write_directly(const char *path, const tc_file_part *part, size_t n, tc_error *err)
{
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0)
        return fail_write(err, path, errno);
    tc_status status = write_parts(fd, part, n, path, err);
    if (close(fd) != 0 && status == TC_OK)
        status = fail_write(err, path, errno);
    return status;
}

tc_status tc_file_replace(const char *path, const void *data, size_t bytes, tc_error *err)
{
    const tc_file_part part = {data, bytes};
    return tc_file_replace_parts(path, &part, 1, err);
}

tc_status tc_file_replace_parts(const char *path, const tc_file_part *part, size_t n, tc_error *err)
{
    struct stat info;
    char *target = NULL, *beside = NULL;
    tc_status status;
    bool exists = stat(path, &info) == 0;
    if (*path == 0 || path[strlen(path) - 1] == '/' || (exists && S_ISDIR(info.st_mode)))
        return fail_write(err, *path ? path : "a file without a name", *path ? EISDIR : ENOENT);
    if (exists && !S_ISREG(info.st_mode))
        return write_directly(path, part, n, err);
    target = exists ? realpath(path, NULL) : tc_strdup(path);
    if (!target)
        return fail_write(err, path, errno);
    int fd = open_beside(&beside, target);
    if (fd < 0) {
        status = fail_write(err, path, errno);
        goto done;
    }
    status = write_parts(fd, part, n, path, err);
    if (exists && fchmod(fd, info.st_mode & 07777) != 0 && status == TC_OK)
        status = fail_write(err, path, errno);
    if (close(fd) != 0 && status == TC_OK)
        status = fail_write(err, path, errno);
    if (status == TC_OK && rename(beside, target) != 0)
        status = fail_write(err, path, errno);
    if (status != TC_OK)
        unlink(beside);
done:
    free(beside);
    free(target);
    return status;
}

tc_status tc_file_read(void **data, size_t *bytes, const char *path, tc_error *err)
{
    struct stat info;
    size_t room, have = 0;
    char *p = NULL;
    tc_status status = TC_OK;
    *data = NULL;
    *bytes = 0;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0 || fstat(fd, &info) != 0 || S_ISDIR(info.st_mode)) {
        status = tc_fail(err, TC_E_FILE, "%s cannot be read: %s", path,
                         strerror(fd >= 0 && S_ISDIR(info.st_mode) ? EISDIR : errno));
        goto done;
    }
    room = info.st_size > 0 ? (size_t)info.st_size + 1 : 65536;
    for (;;) {
        if (!p || have == room) { /* pipes and growing files do not say their size */
            if (p && __builtin_mul_overflow(room, (size_t)2, &room))
                room = SIZE_MAX;
            char *more = tc_realloc(p, room, 1);
            if (!more) {
                status = tc_fail_memory(err, path, room, 1);
                goto done;
            }
            p = more;
        }
        ssize_t n = read(fd, p + have, room - have);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0) {
            status = tc_fail(err, TC_E_FILE, "%s cannot be read: %s", path, strerror(errno));
            goto done;
        }
        if (n == 0)
            break;
        have += (size_t)n;
    }
    *data = p;
    *bytes = have;
    p = NULL;
done:
    if (fd >= 0)
        close(fd);
    free(p);
    return status;
}
