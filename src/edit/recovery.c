/* recovery.c: what is being edited, kept in a file beside its process's lock. */
#define _DEFAULT_SOURCE
#define _POSIX_C_SOURCE 200809L
#include "edit/recovery.h"

#include "edit/fail.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

struct tc_recovery {
    int lock;                      /* -1: not ours */
    char *path, *lock_path, *part; /* part: where a text is written before it is whole */
};

static const char scene_end[] = ".json", lock_end[] = ".lock", part_end[] = ".part";

char *tc_recovery_folder(void)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    const bool given = state && *state == '/';
    if (!given && !(home && *home))
        return NULL;
    const char *base = given ? state : home, *end = given ? "/tetcast" : "/.local/state/tetcast";
    char *folder = malloc(strlen(base) + strlen(end) + 1);
    if (folder) {
        strcpy(folder, base);
        strcat(folder, end);
    }
    return folder;
}

/* Makes the folder and those above it. */
static tc_status folder_make(const char *folder, tc_error *err)
{
    char *path = malloc(strlen(folder) + 1);
    if (!path)
        return tc_edit_no_room(err, "names of files", 3);
    strcpy(path, folder);
    for (char *at = path + 1; *at; at++)
        if (*at == '/') {
            *at = 0;
            mkdir(path, 0700); /* the last one tells */
            *at = '/';
        }
    const bool made = mkdir(path, 0700) == 0 || errno == EEXIST;
    const int reason = errno;
    free(path);
    return made ? TC_OK
                : tc_edit_fail(err, TC_E_FILE,
                               "%s cannot be made, so nothing is kept against a crash: %s; set "
                               "XDG_STATE_HOME to a folder that is writable",
                               folder, strerror(reason));
}

static void recovery_free(tc_recovery *recovery)
{
    if (!recovery)
        return;
    if (recovery->lock >= 0)
        close(recovery->lock);
    free(recovery->path);
    free(recovery->lock_path);
    free(recovery->part);
    free(recovery);
}

static char *joined(const char *folder, const char *stem, size_t length, const char *end)
{
    const size_t room = strlen(folder) + length + strlen(end) + 2;
    char *path = malloc(room);
    if (path)
        snprintf(path, room, "%s/%.*s%s", folder, (int)length, stem, end);
    return path;
}

/* The names of a stem in the folder, not locked; NULL: memory ran out. */
static tc_recovery *recovery_make(const char *folder, const char *stem, size_t length)
{
    tc_recovery *recovery = calloc(1, sizeof *recovery);
    if (!recovery)
        return NULL;
    recovery->lock = -1;
    recovery->path = joined(folder, stem, length, scene_end);
    recovery->lock_path = joined(folder, stem, length, lock_end);
    recovery->part = joined(folder, stem, length, part_end);
    if (recovery->path && recovery->lock_path && recovery->part)
        return recovery;
    recovery_free(recovery);
    return NULL;
}

/* Takes the lock; false, with errno: it is another's, or cannot be made. */
static bool lock_take(tc_recovery *recovery, int how)
{
    recovery->lock = open(recovery->lock_path, O_RDWR | O_CLOEXEC | O_NOFOLLOW | how, 0600);
    if (recovery->lock < 0)
        return false;
    struct stat here, there;
    if (flock(recovery->lock, LOCK_EX | LOCK_NB) == 0 && fstat(recovery->lock, &here) == 0 &&
        stat(recovery->lock_path, &there) == 0 && here.st_ino == there.st_ino)
        return true; /* and nobody removed it meanwhile */
    close(recovery->lock);
    recovery->lock = -1;
    errno = EWOULDBLOCK;
    return false;
}

tc_status tc_recovery_open(tc_recovery **out, const char *folder, tc_error *err)
{
    enum { TRIES = 1000 };
    *out = NULL;
    const tc_status status = folder_make(folder, err);
    if (status)
        return status;
    for (int i = 0; i < TRIES; i++) {
        char stem[64];
        const int length = snprintf(stem, sizeof stem, "edit-%ld-%d", (long)getpid(), i);
        tc_recovery *recovery = recovery_make(folder, stem, (size_t)length);
        if (!recovery)
            return tc_edit_no_room(err, "names of files", 3);
        /* What a process of the same number left is not ours to write over. */
        if (access(recovery->path, F_OK) != 0 && lock_take(recovery, O_CREAT)) {
            *out = recovery;
            return TC_OK;
        }
        const int reason = errno;
        const bool taken = access(recovery->lock_path, F_OK) == 0 || access(recovery->path, F_OK) == 0;
        recovery_free(recovery);
        if (!taken)
            return tc_edit_fail(err, TC_E_FILE,
                                "%s cannot be written to, so nothing is kept against a crash: %s; set "
                                "XDG_STATE_HOME to a folder that is writable",
                                folder, strerror(reason));
    }
    return tc_edit_fail(err, TC_E_FILE, "%s is full of files of other windows: remove those named edit-*", folder);
}

/* Is it a name that ends so? *length gets that of what stands before. */
static bool ends_in(size_t *length, const char *name, const char *end)
{
    const size_t n = strlen(name), e = strlen(end);
    if (n <= e || strncmp(name, "edit-", 5) != 0 || strcmp(name + n - e, end) != 0)
        return false;
    *length = n - e;
    return true;
}

/* A newer one that is left over in place of *best; what is locked without a file is removed. */
static tc_status look_at(tc_recovery **best, const char *folder, const char *name, tc_error *err)
{
    size_t length;
    const bool scene = ends_in(&length, name, scene_end);
    if (!scene && !ends_in(&length, name, lock_end))
        return TC_OK;
    tc_recovery *one = recovery_make(folder, name, length);
    if (!one)
        return tc_edit_no_room(err, "names of files", 3);
    const bool there = access(one->path, F_OK) == 0;
    if ((scene || !there) && lock_take(one, scene ? O_CREAT : 0)) {
        const time_t time = tc_recovery_time(one);
        if (time == 0)
            tc_recovery_close(&one, false);
        else if (!*best || time > tc_recovery_time(*best)) {
            tc_recovery_close(best, true);
            *best = one;
            one = NULL;
        }
    }
    tc_recovery_close(&one, true);
    return TC_OK;
}

tc_status tc_recovery_claim(tc_recovery **out, const char *folder, tc_error *err)
{
    *out = NULL;
    DIR *dir = opendir(folder);
    if (!dir)
        return TC_OK;
    tc_status status = TC_OK;
    for (const struct dirent *entry; status == TC_OK && (entry = readdir(dir));)
        status = look_at(out, folder, entry->d_name, err);
    closedir(dir);
    if (status)
        tc_recovery_close(out, true);
    return status;
}

tc_status tc_recovery_save(tc_recovery *recovery, const char *text, tc_error *err)
{
    const int descriptor = open(recovery->part, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
    const size_t length = strlen(text);
    size_t done = 0;
    int reason = descriptor < 0 ? errno : 0;
    while (done < length && !reason) {
        const ssize_t wrote = write(descriptor, text + done, length - done);
        if (wrote > 0)
            done += (size_t)wrote;
        else if (errno != EINTR)
            reason = errno;
    }
    if (descriptor >= 0 && close(descriptor) != 0 && !reason)
        reason = errno;
    if (!reason && rename(recovery->part, recovery->path) != 0)
        reason = errno;
    if (!reason)
        return TC_OK;
    unlink(recovery->part);
    return tc_edit_fail(err, TC_E_FILE, "%s cannot be written, so the last changes are not kept against a crash: %s",
                        recovery->path, strerror(reason));
}

const char *tc_recovery_path(const tc_recovery *recovery)
{
    return recovery->path;
}

time_t tc_recovery_time(const tc_recovery *recovery)
{
    struct stat about;
    return stat(recovery->path, &about) == 0 && S_ISREG(about.st_mode) ? about.st_mtime : 0;
}

void tc_recovery_close(tc_recovery **recovery, bool keep)
{
    if (!recovery || !*recovery)
        return;
    tc_recovery *one = *recovery;
    if (one->lock >= 0) {
        unlink(one->part);
        if (!keep)
            unlink(one->path);
        if (!keep || access(one->path, F_OK) != 0)
            unlink(one->lock_path);
    }
    recovery_free(one);
    *recovery = NULL;
}
