/* file.c: files that appear whole or not at all. */
#define _GNU_SOURCE
#include "core/file.h"
#include "core/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
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

/* ------------------------------------------------------------------------------------------------------- drafts */

enum { ATTEMPTS = 100, FULL_BYTES = 1 << 20 };

/* The length of what of target is its folder, with the slash. */
static int folder_length(const char *target)
{
    const char *slash = strrchr(target, '/');
    return slash ? (int)(slash - target) + 1 : 0;
}

/* The name beside target, the same each time; NULL: memory is out. */
static char *name_beside(const char *target)
{
    char *out = NULL;
    const int folder = folder_length(target);
    const char *name = target + folder;
    int made;
    if (strlen(name) + strlen(".tetcast-.tmp") <= NAME_MAX) {
        made = asprintf(&out, "%.*s.tetcast-%s.tmp", folder, target, name);
    } else {
        uint64_t hash = 0xcbf29ce484222325u; /* FNV-1a */
        for (const char *p = name; *p; p++)
            hash = (hash ^ (unsigned char)*p) * 0x100000001b3u;
        made = asprintf(&out, "%.*s.tetcast-%.200s-%016llx.tmp", folder, target, name, (unsigned long long)hash);
    }
    return made < 0 ? NULL : out;
}

/* A file without a name in target's folder; -1: there are none, or no way to name one later. */
static int open_nameless(const char *target)
{
    char *folder = NULL;
    const int n = folder_length(target);
    if (access("/proc/self/fd", X_OK) != 0 || asprintf(&folder, "%.*s", n ? n : 1, n ? target : ".") < 0)
        return -1;
    int fd = open(folder, O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
    free(folder);
    if (fd >= 0)
        flock(fd, LOCK_EX | LOCK_NB); /* see name_it; it has no name: nobody else can have it */
    return fd;
}

/* Does the name still lead to the open file? */
static bool is_file(const char *name, int fd)
{
    struct stat by_name, open_one;
    return fstat(fd, &open_one) == 0 && lstat(name, &by_name) == 0 && by_name.st_dev == open_one.st_dev &&
           by_name.st_ino == open_one.st_ino;
}

/* A name beside target that is this call's alone; NULL: memory is out. */
static char *own_name(const char *target, int attempt)
{
    struct timespec t;
    char *out = NULL;
    clock_gettime(CLOCK_REALTIME, &t);
    return asprintf(&out, "%.*s.tetcast-%ld-%ld-%d.tmp", folder_length(target), target, (long)getpid(), t.tv_nsec,
                    attempt) < 0
               ? NULL
               : out;
}

/* An empty, locked file at draft->part, perhaps what a killed process left there; or, where another one writes there
 * just now or nothing can be locked, under a name of its own. -1 and errno on failure. */
static int open_beside(tc_file_draft *draft)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        int fd = open(draft->part, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd < 0 && errno != EACCES && errno != ELOOP)
            return -1;
        if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) == 0) {
            if (is_file(draft->part, fd) && ftruncate(fd, 0) == 0)
                return fd;
            close(fd); /* it was renamed meanwhile */
            continue;
        }
        if (fd >= 0)
            close(fd);
        char *own = own_name(draft->target, attempt);
        fd = own ? open(own, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666) : -1;
        if (fd < 0) {
            const int code = own ? errno : ENOMEM;
            free(own);
            if (code == EEXIST)
                continue;
            errno = code;
            return -1;
        }
        free(draft->part);
        draft->part = own;
        return fd;
    }
    errno = EEXIST;
    return -1;
}

/* Removes what a killed process left at part. False: a writer that lives has it. */
static bool remove_left(const char *part)
{
    int fd = open(part, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0)
        return errno == ENOENT;
    /* With the lock: nobody else removes or renames it. */
    const bool mine = flock(fd, LOCK_EX | LOCK_NB) == 0;
    const bool gone = mine && (!is_file(part, fd) || unlink(part) == 0);
    close(fd);
    return gone;
}

static void finish_draft(tc_file_draft *draft)
{
    if (draft->fd >= 0)
        close(draft->fd);
    free(draft->path);
    free(draft->target);
    free(draft->part);
    *draft = (tc_file_draft){.fd = -1};
}

static tc_status open_draft(tc_file_draft *out, const char *path, bool named, tc_error *err)
{
    struct stat info;
    tc_status status;
    *out = (tc_file_draft){.fd = -1};
    const bool exists = stat(path, &info) == 0;
    if (!exists && errno == ENAMETOOLONG)
        return fail_write(err, path, errno);
    if (*path == 0 || path[strlen(path) - 1] == '/' || (exists && S_ISDIR(info.st_mode)))
        return fail_write(err, *path ? path : "a file without a name", *path ? EISDIR : ENOENT);
    out->direct = exists && !S_ISREG(info.st_mode);
    out->replace = exists && !out->direct;
    out->mode = exists ? info.st_mode & 07777 : 0;
    out->path = tc_strdup(path);
    out->target = out->replace ? realpath(path, NULL) : tc_strdup(path);
    if (out->replace && !out->target && errno == ENOENT) { /* it went meanwhile */
        out->replace = false;
        out->target = tc_strdup(path);
    }
    out->part = out->target ? name_beside(out->target) : NULL;
    if (!out->path || !out->part) {
        status = out->replace && !out->target && errno != ENOMEM ? fail_write(err, path, errno)
                                                                 : tc_fail_memory(err, path, strlen(path), 3);
        finish_draft(out);
        return status;
    }
    if (out->direct)
        out->fd = open(path, O_WRONLY | O_CLOEXEC);
    else if (named || (out->fd = open_nameless(out->target)) < 0)
        out->named = (out->fd = open_beside(out)) >= 0;
    if (out->fd >= 0)
        return TC_OK;
    status = fail_write(err, path, errno);
    finish_draft(out);
    return status;
}

tc_status tc_file_draft_open(tc_file_draft *out, const char *path, tc_error *err)
{
    return open_draft(out, path, false, err);
}

tc_status tc_file_draft_open_named(tc_file_draft *out, const char *path, tc_error *err)
{
    return open_draft(out, path, true, err);
}

/* A nameless file, which is locked, gets its name; 0, or errno. It can be linked once only: nobody may take it away at
 * part before it is renamed, hence the locks. */
static int name_it(tc_file_draft *draft)
{
    char self[64];
    snprintf(self, sizeof self, "/proc/self/fd/%d", draft->fd);
    if (!draft->replace && linkat(AT_FDCWD, self, AT_FDCWD, draft->target, AT_SYMLINK_FOLLOW) == 0) {
        remove_left(draft->part);
        return 0;
    }
    if (!draft->replace && errno != EEXIST)
        return errno;
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (linkat(AT_FDCWD, self, AT_FDCWD, draft->part, AT_SYMLINK_FOLLOW) == 0) {
            const int code = rename(draft->part, draft->target) == 0 ? 0 : errno;
            if (code != 0)
                unlink(draft->part);
            return code;
        }
        if (errno != EEXIST)
            return errno;
        if (remove_left(draft->part))
            continue;
        char *own = own_name(draft->target, attempt);
        if (!own)
            return ENOMEM;
        free(draft->part);
        draft->part = own;
    }
    return EEXIST;
}

tc_status tc_file_draft_keep(tc_file_draft *draft, tc_error *err)
{
    tc_status status = TC_OK;
    if (draft->replace && fchmod(draft->fd, draft->mode) != 0)
        status = fail_write(err, draft->path, errno);
    if (status == TC_OK && !draft->direct) {
        const int code = draft->named ? rename(draft->part, draft->target) != 0 ? errno : 0 : name_it(draft);
        if (code != 0)
            status = fail_write(err, draft->path, code);
        else
            draft->named = false;
    }
    if (status != TC_OK) {
        tc_file_draft_drop(draft);
        return status;
    }
    const int fd = draft->fd;
    draft->fd = -1;
    if (close(fd) != 0)
        status = fail_write(err, draft->path, errno);
    finish_draft(draft);
    return status;
}

void tc_file_draft_drop(tc_file_draft *draft)
{
    if (!draft->path)
        return;
    if (draft->named)
        unlink(draft->part);
    finish_draft(draft);
}

tc_status tc_file_draft_full(const tc_file_draft *draft, tc_error *err)
{
    void *zeros = tc_calloc(FULL_BYTES, 1);
    tc_status status = TC_OK;
    if (zeros && !draft->direct && lseek(draft->fd, 0, SEEK_END) >= 0)
        status = tc_file_write(draft->fd, zeros, FULL_BYTES, draft->path, err);
    free(zeros);
    return status;
}

tc_status tc_file_replace(const char *path, const void *data, size_t bytes, tc_error *err)
{
    const tc_file_part part = {data, bytes};
    return tc_file_replace_parts(path, &part, 1, err);
}

tc_status tc_file_replace_parts(const char *path, const tc_file_part *part, size_t n, tc_error *err)
{
    tc_file_draft draft;
    tc_status status = tc_file_draft_open(&draft, path, err);
    for (size_t i = 0; i < n && status == TC_OK; i++)
        status = tc_file_write(draft.fd, part[i].data, part[i].bytes, path, err);
    if (status == TC_OK)
        return tc_file_draft_keep(&draft, err);
    tc_file_draft_drop(&draft);
    return status;
}

/* ------------------------------------------------------------------------------------------------------ reading */

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
