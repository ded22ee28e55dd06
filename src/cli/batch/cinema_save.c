/* cinema_save.c: a Cinema database on disk: opening, the lock, merging and writing.
 * The file beside data.csv that is to become it (.data.csv.new) is the lock, too: whoever holds flock() on the file of
 * that name may write it and rename it. Who waited for it finds, when the lock is his, that the name is gone or another
 * file's, and begins anew. A process that was killed leaves the file without a lock, and the next save takes it over.
 * It is a file and not the folder, since over NFS a folder's lock holds on one machine only. */
#define _GNU_SOURCE
#include "cli/batch/cinema_table.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const char table_name[] = "data.csv", beside_name[] = ".data.csv.new";
enum { LOCK_WAIT_S = 60 };

static tc_status fail_code(tc_error *err, const tc_cinema *c, const char *what, int code)
{
    const char *remedy = code == ENOSPC || code == EDQUOT || code == EFBIG  ? "; free some space and run it again"
                         : code == EACCES || code == EPERM || code == EROFS ? "; choose a folder that you may write to"
                         : code == ENOENT || code == ENOTDIR                ? "; make its folder first"
                                                                            : "";
    return tc_cinema_fail(err, TC_E_FILE, "%s/%s cannot be %s: %s%s", c->cdb, table_name, what, strerror(code), remedy);
}

static double clock_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* 0: locked; EWOULDBLOCK: after all that time not; another code: locks do not work. */
static int wait_for_lock(int file, double until)
{
    for (;;) {
        if (flock(file, LOCK_EX | LOCK_NB) == 0)
            return 0;
        if ((errno != EWOULDBLOCK && errno != EINTR) || clock_s() > until)
            return errno == EINTR ? EWOULDBLOCK : errno;
        nanosleep(&(struct timespec){0, 5000000}, NULL);
    }
}

static bool is_no_lock(int code)
{
    return code == ENOLCK || code == EOPNOTSUPP || code == ENOSYS || code == EINVAL || code == EBADF;
}

/* Opens and locks the empty file that is to become data.csv. */
static tc_status begin(int *out, const tc_cinema *c, int folder, tc_error *err)
{
    const double until = clock_s() + LOCK_WAIT_S;
    for (;;) {
        struct stat held, named;
        int file = openat(folder, beside_name, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (file < 0)
            return fail_code(err, c, "written", errno);
        int code = wait_for_lock(file, until);
        bool ours = code == 0 || (is_no_lock(code) && c->alone);
        bool same = ours && fstat(file, &held) == 0 && fstatat(folder, beside_name, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
                    held.st_dev == named.st_dev && held.st_ino == named.st_ino;
        if (same && ftruncate(file, 0) == 0) {
            *out = file;
            return TC_OK;
        }
        if (same)
            code = errno;
        close(file);
        if (same)
            return fail_code(err, c, "written", code);
        if (code == EWOULDBLOCK || (ours && clock_s() > until))
            return tc_cinema_fail(
                err, TC_E_FILE,
                "%s/%s cannot be written: another process has held %s for %d s; end that process and run "
                "it again",
                c->cdb, table_name, beside_name, LOCK_WAIT_S);
        if (is_no_lock(code))
            return tc_cinema_fail(
                err, TC_E_FILE,
                "%s is on a file system without locks (%s), where shards would lose each other's rows; run "
                "one process at a time, or choose another file system",
                c->cdb, strerror(code));
        if (!ours && code != ESTALE)
            return fail_code(err, c, "locked", code);
    }
}

/* Reads all of data.csv; a file that is not there is empty. The caller frees *text. */
static tc_status read_table(char **text, size_t *bytes, mode_t *mode, const tc_cinema *c, int folder, tc_error *err)
{
    struct stat info;
    *text = NULL;
    *bytes = 0;
    *mode = 0;
    int file = openat(folder, table_name, O_RDONLY | O_CLOEXEC);
    if (file < 0 && errno == ENOENT)
        return TC_OK;
    if (file < 0)
        return fail_code(err, c, "read", errno);
    int code = fstat(file, &info) != 0 ? errno : !S_ISREG(info.st_mode) ? EISDIR : 0;
    size_t size = code ? 0 : (size_t)info.st_size;
    char *data = code ? NULL : malloc(size + 1);
    if (!code && !data)
        code = ENOMEM;
    while (!code && *bytes < size) {
        ssize_t got = read(file, data + *bytes, size - *bytes);
        if (got > 0)
            *bytes += (size_t)got;
        else if (got == 0)
            break;
        else if (errno != EINTR)
            code = errno;
    }
    close(file);
    if (code) {
        free(data);
        return fail_code(err, c, "read", code);
    }
    *mode = info.st_mode & 07777;
    *text = data;
    return TC_OK;
}

/* Is a file that the row names not there, or empty? */
static bool is_without_file(const tc_cinema *c, const tc_cinema_row *row, int folder)
{
    struct stat info;
    for (size_t i = c->n_parameters; i < c->n; i++)
        if (!row->cell[i].missing && !strstr(row->cell[i].text, "://") &&
            (fstatat(folder, row->cell[i].text, &info, 0) != 0 || info.st_size == 0))
            return true;
    return false;
}

/* Leaves of the rows that were read those that stay. */
static size_t keep_others(tc_cinema_row **row, size_t n, const tc_cinema *c, int folder)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        if (tc_cinema_is_replaced(c, row[i]) || (c->drop_missing && is_without_file(c, row[i], folder)))
            free(row[i]);
        else
            row[kept++] = row[i];
    }
    return kept;
}

/* Writes the table into the locked file and gives it its name. */
static tc_status write_table(const tc_csv_text *table, mode_t mode, const tc_cinema *c, int folder, int file,
                             tc_error *err)
{
    for (size_t done = 0; done < table->n;) {
        ssize_t put = write(file, table->data + done, table->n - done);
        if (put > 0)
            done += (size_t)put;
        else if (put == 0 || errno != EINTR)
            return fail_code(err, c, "written", put == 0 ? ENOSPC : errno);
    }
    if (mode)
        (void)!fchmod(file, mode);                             /* another user's file keeps its rows, if not its mode */
    if (fsync(file) != 0 && errno != EINVAL && errno != EROFS) /* a full disk may show only now */
        return fail_code(err, c, "written", errno);
    if (renameat(folder, beside_name, folder, table_name) != 0)
        return fail_code(err, c, "written", errno);
    return TC_OK;
}

tc_status tc_cinema_save(tc_cinema *c, tc_error *err)
{
    tc_cinema_row **other = NULL, **all = NULL;
    tc_csv_text table = {0};
    char *old = NULL, *text = NULL;
    size_t n_old = 0, n_other = 0, n = 0;
    int file = -1;
    mode_t mode;
    bool named = false;
    int folder = open(c->cdb, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return fail_code(err, c, "written", errno);
    tc_status status = begin(&file, c, folder, err);
    if (status == TC_OK)
        status = read_table(&old, &n_old, &mode, c, folder, err);
    if (status != TC_OK)
        goto done;
    if (n_old && !(text = malloc(n_old))) {
        status = fail_code(err, c, "written", ENOMEM);
        goto done;
    }
    if (n_old)
        memcpy(text, old, n_old); /* reading changes it */
    status = tc_cinema_rows_read(&other, &n_other, c, text, n_old, err);
    if (status != TC_OK)
        goto done;
    n_other = keep_others(other, n_other, c, folder);
    all = malloc((n_other + c->n_live + 1) * sizeof *all);
    if (all) {
        for (; n < n_other; n++)
            all[n] = other[n];
        for (size_t i = 0; i < c->n_own; i++)
            if (c->own[i])
                all[n++] = c->own[i];
        qsort_r(all, n, sizeof *all, tc_cinema_row_compare, c);
        tc_cinema_rows_write(&table, c, all, n);
    }
    if (!all || table.failed)
        status = fail_code(err, c, "written", ENOMEM);
    else if (n == 0 && unlinkat(folder, table_name, 0) != 0 && errno != ENOENT)
        status = fail_code(err, c, "removed", errno);
    else if (n > 0 && (table.n != n_old || memcmp(table.data, old, n_old) != 0)) {
        status = write_table(&table, mode, c, folder, file, err);
        named = status == TC_OK;
    }
    if (status == TC_OK)
        c->n_others = n_other;
done:
    if (file >= 0 && !named)
        unlinkat(folder, beside_name, 0);
    if (file >= 0)
        close(file);
    close(folder);
    tc_cinema_rows_free(other, n_other);
    free(all);
    free(old);
    free(text);
    free(table.data);
    return status;
}

/* Are these columns of a database? */
static tc_status check_columns(const tc_cinema *c, const tc_cinema_column *column, size_t n, tc_error *err)
{
    if (n < 1 || n > TC_CINEMA_COLUMNS_MAX)
        return tc_cinema_fail(err, TC_E_ARG, "%s: %zu columns; give 1 to %d", c->cdb, n, TC_CINEMA_COLUMNS_MAX);
    bool files = false;
    for (size_t i = 0; i < n; i++) {
        const char *name = column[i].name;
        const size_t length = strlen(name);
        char why[320];
        if (!tc_cinema_text_ok(name, why, sizeof why))
            return tc_cinema_fail(err, TC_E_ARG, "%s, name of column %zu: %s", c->cdb, i + 1, why);
        if (strspn(name, " \t\r\n") || strchr(" \t\r\n", name[length - 1]))
            return tc_cinema_fail(err, TC_E_ARG, "%s: the column '%s' has a blank at an end; leave it out", c->cdb,
                                  name);
        for (size_t k = 0; k < i; k++)
            if (!strcmp(column[k].name, name))
                return tc_cinema_fail(err, TC_E_ARG, "%s: two columns are called %s; rename one", c->cdb, name);
        if ((column[i].type == TC_CINEMA_FILE) != !strncmp(name, "FILE", 4))
            return tc_cinema_fail(err, TC_E_ARG,
                                  "%s: the column %s is%s of files; the names of these, and of no others, "
                                  "begin with FILE",
                                  c->cdb, name, column[i].type == TC_CINEMA_FILE ? "" : " not");
        if (files && column[i].type != TC_CINEMA_FILE)
            return tc_cinema_fail(err, TC_E_ARG, "%s: the column %s comes after files; put files last", c->cdb, name);
        files = column[i].type == TC_CINEMA_FILE;
    }
    if (column[0].type == TC_CINEMA_FILE)
        return tc_cinema_fail(err, TC_E_ARG, "%s: there is no column of a parameter; give one before the files",
                              c->cdb);
    return TC_OK;
}

/* Tries whether the table can be written, and reads it. */
static tc_status look(tc_cinema *c, tc_error *err)
{
    tc_cinema_row **row = NULL;
    char *text = NULL;
    size_t bytes = 0, n = 0;
    int file = -1;
    mode_t mode;
    if (mkdir(c->cdb, 0777) != 0 && errno != EEXIST)
        return tc_cinema_fail(err, TC_E_FILE, "the folder %s cannot be made: %s; %s", c->cdb, strerror(errno),
                              errno == ENOENT ? "make the one around it first" : "choose another place");
    int folder = open(c->cdb, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return fail_code(err, c, "written", errno);
    tc_status status = begin(&file, c, folder, err);
    if (status == TC_OK)
        status = read_table(&text, &bytes, &mode, c, folder, err);
    if (status == TC_OK)
        status = tc_cinema_rows_read(&row, &n, c, text, bytes, err);
    if (status == TC_OK)
        c->n_others = n;
    if (file >= 0) {
        unlinkat(folder, beside_name, 0);
        close(file);
    }
    close(folder);
    tc_cinema_rows_free(row, n);
    free(text);
    return status;
}

tc_status tc_cinema_open(tc_cinema **out, const char *cdb, const tc_cinema_column *column, size_t n, bool alone,
                         tc_error *err)
{
    *out = NULL;
    tc_cinema *c = calloc(1, sizeof *c);
    size_t length = strlen(cdb);
    while (length > 1 && cdb[length - 1] == '/')
        length--;
    if (!c || !(c->cdb = strndup(cdb, length))) {
        free(c);
        return tc_cinema_fail(err, TC_E_MEMORY, "memory ran out for the table of %s; free some", cdb);
    }
    c->alone = alone;
    tc_status status = TC_OK;
    if (length < 5 || strcmp(c->cdb + length - 4, ".cdb") != 0 || c->cdb[length - 5] == '/')
        status = tc_cinema_fail(err, TC_E_ARG, "%s is no name of a Cinema database; give one that ends in .cdb", cdb);
    if (status == TC_OK)
        status = check_columns(c, column, n, err);
    for (; status == TC_OK && c->n < n; c->n++) {
        c->column[c->n] = column[c->n];
        c->n_parameters += column[c->n].type != TC_CINEMA_FILE;
        if (!(c->column[c->n].name = strdup(column[c->n].name))) {
            status = tc_cinema_fail(err, TC_E_MEMORY, "memory ran out for the table of %s; free some", cdb);
            break;
        }
    }
    if (status == TC_OK)
        status = look(c, err);
    if (status == TC_OK)
        *out = c;
    else
        tc_cinema_destroy(&c);
    return status;
}

void tc_cinema_destroy(tc_cinema **cinema)
{
    tc_cinema *c = cinema ? *cinema : NULL;
    if (!c)
        return;
    tc_cinema_rows_free(c->own, c->n_own);
    for (size_t i = 0; i < c->n; i++)
        free((char *)c->column[i].name);
    free(c->slot);
    free(c->cdb);
    free(c);
    *cinema = NULL;
}

void tc_cinema_drop_missing(tc_cinema *c, bool on)
{
    c->drop_missing = on;
}

size_t tc_cinema_count(const tc_cinema *c)
{
    return c->n_live + c->n_others;
}
