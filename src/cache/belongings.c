/* belongings.c: what a dataset consists of besides the file that is named. Which files those are only their readers know,
 * so that all of their folder are taken for it. */
#define _GNU_SOURCE
#include "cache/belongings.h"
#include "cache/format.h"
#include "core/file.h"
#include "core/memory.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { HEAD = 1024, MOST_FILES = 20000, DEEPEST = 12, LIST_BYTES = 16 << 20 };
static const double FRESH_S = 0.05;

bool tc_cache_alone(const char *path)
{
    static const char *const kinds[] = {"UnstructuredGrid", "StructuredGrid", "RectilinearGrid", "ImageData"};
    char head[HEAD + 1];
    FILE *file = fopen(path, "re");
    size_t n = file ? fread(head, 1, HEAD, file) : 0;
    if (file)
        fclose(file);
    head[n] = 0;
    if (strncmp(head, "# vtk DataFile", 14) == 0)
        return true;
    const char *tag = strstr(head, "<VTKFile"), *type = tag ? strstr(tag, "type=") : NULL;
    if (!type || (type[5] != '"' && type[5] != '\''))
        return false;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        size_t length = strlen(kinds[i]);
        if (strncmp(type + 6, kinds[i], length) == 0 && type[6 + length] == type[5])
            return true;
    }
    return false;
}

bool tc_cache_begins(const char *path)
{
    char magic[sizeof(TC_CACHE_MAGIC) - 1];
    FILE *file = fopen(path, "re");
    bool same = file && fread(magic, sizeof magic, 1, file) == 1 && memcmp(magic, TC_CACHE_MAGIC, sizeof magic) == 0;
    if (file)
        fclose(file);
    return same;
}

typedef struct walk {
    tc_hash sum;
    size_t n;
    struct timespec now;
    tc_error *err;
} walk;

static bool ends(const char *name, const char *const *endings)
{
    size_t n = strlen(name);
    for (; *endings; endings++) {
        size_t m = strlen(*endings);
        if (n >= m && strcasecmp(name + n - m, *endings) == 0)
            return true;
    }
    return false;
}

static bool left_out(const char *name)
{
    static const char *const endings[] = {".tccache", ".png", ".exr", ".tif", ".tiff", ".jpg",
                                          ".jpeg",    ".csv", ".json", NULL};
    static const char *const temporary[] = {".tmp", NULL};
    return ends(name, endings) || (strncmp(name, ".tetcast-", 9) == 0 && ends(name, temporary));
}

/* Does the text name a file by an absolute path, or above its folder? Rather too often yes than too seldom. */
static bool points_elsewhere(const char *text, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (text[i] == '.' && i + 2 < n && text[i + 1] == '.' && text[i + 2] == '/')
            return true;
        if (text[i] != '/' || i + 1 == n || !(isalnum((unsigned char)text[i + 1]) || strchr("._~-", text[i + 1])))
            continue;
        if (i == 0 || isspace((unsigned char)text[i - 1]) || strchr("\"'=>", text[i - 1]))
            return true;
    }
    return false;
}

/* Does the name tell a file that lists others? */
static bool lists_files(const char *path)
{
    static const char *const lists[] = {".pvd",  ".series", ".case",  ".encas", ".sos",  ".vtm",  ".vtmb", ".pvtu",
                                        ".pvts", ".pvtr",   ".pvti",  ".vtpd",  ".vtpc", ".p3d",  NULL};
    return ends(path, lists);
}

/* A text must name files of the folder only. */
static tc_status check_list(const char *path, tc_error *err)
{
    struct stat info;
    if (stat(path, &info) != 0 || info.st_size > LIST_BYTES) /* longer ones are data */
        return TC_OK;
    void *data;
    size_t n;
    tc_status status = tc_file_read(&data, &n, path, err);
    if (status != TC_OK)
        return status;
    if (!memchr(data, 0, n < HEAD ? n : HEAD) && points_elsewhere(data, n))
        status = tc_fail(err, TC_E_FILE, "%s names files outside of its folder, so whether they changed cannot be told",
                         path);
    free(data);
    return status;
}

/* Is a time so near to now that another change might get the same? */
static bool fresh(const struct timespec *time, const struct timespec *now)
{
    double age = (double)(now->tv_sec - time->tv_sec) + 1e-9 * (double)(now->tv_nsec - time->tv_nsec);
    return age < FRESH_S && age > -FRESH_S;
}

/* below: the path from the folder that was asked for */
static tc_status add_file(walk *w, const char *path, const char *below, const struct stat *info)
{
    if (tc_cache_begins(path))
        return TC_OK;
    if (++w->n > MOST_FILES)
        return tc_fail(w->err, TC_E_FILE,
                       "the dataset's folder holds more than %d files, so what belongs to it cannot be told; give it a "
                       "folder of its own",
                       MOST_FILES);
    if (fresh(&info->st_mtim, &w->now) || fresh(&info->st_ctim, &w->now))
        return tc_fail(w->err, TC_E_FILE, "%s was changed just now", path);
    int64_t facts[5] = {info->st_size, info->st_mtim.tv_sec, info->st_mtim.tv_nsec, info->st_ctim.tv_sec,
                        info->st_ctim.tv_nsec};
    tc_hash name = tc_hash_bytes(below, strlen(below), 1), one = tc_hash_bytes(facts, sizeof facts, name.word[0]);
    w->sum.word[0] += one.word[0]; /* in whatever order a folder lists its files */
    w->sum.word[1] += one.word[1] ^ name.word[1];
    return lists_files(path) ? check_list(path, w->err) : TC_OK;
}

static tc_status walk_folder(walk *w, const char *folder, size_t root, int depth)
{
    DIR *handle = opendir(folder);
    if (!handle)
        return tc_fail(w->err, TC_E_FILE, "the folder %s cannot be read: %s", folder, strerror(errno));
    tc_status status = TC_OK;
    const struct dirent *entry;
    while (status == TC_OK && (entry = readdir(handle))) {
        char *path = NULL;
        struct stat info;
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0 || left_out(entry->d_name))
            continue;
        if (asprintf(&path, "%s/%s", folder, entry->d_name) < 0) {
            status = tc_fail_memory(w->err, "a path", 1, 4096);
            break;
        }
        if (stat(path, &info) != 0) /* a link that leads nowhere is a file that is not there */
            ;
        else if (S_ISREG(info.st_mode))
            status = add_file(w, path, path + root, &info);
        else if (S_ISDIR(info.st_mode) && depth == DEEPEST)
            status = tc_fail(w->err, TC_E_FILE, "the folders below %s are too many", folder);
        else if (S_ISDIR(info.st_mode))
            status = walk_folder(w, path, root, depth + 1);
        free(path);
    }
    closedir(handle);
    return status;
}

tc_status tc_cache_folder(tc_hash *out, const char *folder, const char *main, tc_error *err)
{
    walk w = {.err = err};
    clock_gettime(CLOCK_REALTIME, &w.now);
    tc_status status = main ? check_list(main, err) : TC_OK;
    if (status == TC_OK)
        status = walk_folder(&w, folder, strlen(folder) + 1, 0);
    *out = w.sum;
    return status;
}
