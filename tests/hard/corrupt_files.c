/* corrupt_files.c: the real files to damage, and a folder with one of them damaged. */
#define _GNU_SOURCE
#include "corrupt_files.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool join(char out[TC_PATH], const char *folder, const char *name)
{
    int n = snprintf(out, TC_PATH, "%s%s%s", folder, *folder && *name ? "/" : "", name);
    return n > 0 && n < TC_PATH;
}

static bool ends(const char *text, const char *with)
{
    size_t n = strlen(text), m = strlen(with);
    return n >= m && strcmp(text + n - m, with) == 0;
}

static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Appends the files below folder/below to list, named below folder. */
static void collect(char ***list, size_t *n, const char *folder, const char *below)
{
    char path[TC_PATH], name[TC_PATH];
    struct dirent *entry;
    struct stat st;
    if (!join(path, folder, below))
        return;
    DIR *dir = opendir(path);
    while (dir && (entry = readdir(dir))) {
        if (entry->d_name[0] == '.' || !join(name, below, entry->d_name) || !join(path, folder, name) ||
            stat(path, &st) != 0)
            continue;
        if (S_ISDIR(st.st_mode)) {
            collect(list, n, folder, name);
        } else if (S_ISREG(st.st_mode) && !strstr(name, "README") && !strstr(name, "MANIFEST")) {
            *list = realloc(*list, (*n + 1) * sizeof **list);
            (*list)[(*n)++] = strdup(name);
        }
    }
    if (dir)
        closedir(dir);
}

static tc_dataset *add(tc_datasets *out, const char *folder, const char *input)
{
    out->set = realloc(out->set, (out->n + 1) * sizeof *out->set);
    tc_dataset *set = &out->set[out->n++];
    *set = (tc_dataset){0};
    snprintf(set->folder, sizeof set->folder, "%s", folder);
    snprintf(set->input, sizeof set->input, "%s", input);
    return set;
}

static void add_file(tc_dataset *set, const char *name)
{
    set->file = realloc(set->file, (set->n_file + 1) * sizeof *set->file);
    set->file[set->n_file++] = strdup(name);
}

/* A folder whose files belong together: one data set if a file of it leads, else one for each file. */
static void add_folder(tc_datasets *out, const char *folder)
{
    char **name = NULL;
    size_t n = 0;
    const char *leader = NULL;
    collect(&name, &n, folder, "");
    qsort(name, n, sizeof *name, by_text);
    for (size_t i = 0; i < n && !leader; i++)
        if (ends(name[i], ".foam") || ends(name[i], ".case"))
            leader = name[i];
    tc_dataset *set = leader ? add(out, folder, leader) : NULL;
    for (size_t i = 0; i < n; i++) {
        if (!leader)
            set = add(out, folder, "");
        /* The reader does not look into these; what leads is empty for OpenFOAM. */
        if (!strstr(name[i], "transportProperties") && !strstr(name[i], "blockMeshDict") && !ends(name[i], ".foam") &&
            !ends(name[i], ".sos") && !strstr(name[i], "fvS") && !strstr(name[i], "phi"))
            add_file(set, name[i]);
    }
    for (size_t i = 0; i < n; i++)
        free(name[i]);
    free(name);
}

bool tc_datasets_find(tc_datasets *out, const char *data)
{
    static const char *const part[] = {"", "vol", "surf", "tf"};
    *out = (tc_datasets){0};
    for (size_t p = 0; p < sizeof part / sizeof *part; p++) {
        char folder[TC_PATH], path[TC_PATH];
        struct dirent **entry;
        int n = join(folder, data, part[p]) ? scandir(folder, &entry, NULL, alphasort) : -1;
        for (int i = 0; i < n; i++) {
            struct stat st;
            const char *name = entry[i]->d_name;
            if (name[0] != '.' && !strstr(name, "README") && !strstr(name, "MANIFEST") && join(path, folder, name) &&
                stat(path, &st) == 0) {
                if (S_ISREG(st.st_mode)) {
                    tc_dataset *set = add(out, folder, "");
                    add_file(set, name);
                    set->map = strcmp(part[p], "tf") == 0;
                } else if (S_ISDIR(st.st_mode) && strcmp(part[p], "vol") == 0) {
                    add_folder(out, path);
                }
            }
            free(entry[i]);
        }
        if (n >= 0)
            free(entry);
    }
    return out->n > 0;
}

bool tc_datasets_untouched(const tc_datasets *sets, int64_t since_s)
{
    bool good = true;
    for (size_t s = 0; s < sets->n; s++)
        for (size_t f = 0; f < sets->set[s].n_file; f++) {
            char path[TC_PATH];
            struct stat st;
            if (!join(path, sets->set[s].folder, sets->set[s].file[f]) || stat(path, &st) != 0 ||
                (int64_t)st.st_ctime >= since_s) {
                printf("%s was changed meanwhile\n", path);
                good = false;
            }
        }
    return good;
}

void tc_datasets_finish(tc_datasets *sets)
{
    for (size_t s = 0; s < sets->n; s++) {
        for (size_t f = 0; f < sets->set[s].n_file; f++)
            free(sets->set[s].file[f]);
        free(sets->set[s].file);
    }
    free(sets->set);
    *sets = (tc_datasets){0};
}

/* ------------------------------------------------------------------------------------------------------- damaging */

static bool load(tc_bytes *out, const char *path)
{
    struct stat st;
    FILE *file = fopen(path, "rb");
    *out = (tc_bytes){0};
    bool good = file && fstat(fileno(file), &st) == 0;
    if (good) {
        out->data = malloc((size_t)st.st_size + 1);
        out->n = out->data ? fread(out->data, 1, (size_t)st.st_size, file) : 0;
        good = out->data && out->n == (size_t)st.st_size;
    }
    if (file)
        fclose(file);
    if (!good)
        fprintf(stderr, "%s cannot be read: %s\n", path, strerror(errno));
    return good;
}

/* A new file, never one that is there already or that a link leads to. */
static bool store(const char *path, const tc_bytes *bytes)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    FILE *file = fd < 0 ? NULL : fdopen(fd, "wb");
    bool good = file && fwrite(bytes->data, 1, bytes->n, file) == bytes->n;
    good = file && fclose(file) == 0 && good;
    if (!good)
        fprintf(stderr, "%s cannot be written: %s\n", path, strerror(errno));
    return good;
}

/* Makes the folders on the way to a file. */
static void make_way(const char *path)
{
    char part[TC_PATH];
    for (size_t i = 1; path[i] && i < sizeof part; i++)
        if (path[i] == '/') {
            snprintf(part, sizeof part, "%.*s", (int)i, path);
            mkdir(part, 0700);
        }
}

/* A copy, never a link: nothing in the scratch folder may lead back to the real files. */
static bool copy_file(const char *from, const char *to)
{
    tc_bytes bytes;
    bool good = load(&bytes, from);
    make_way(to);
    good = good && store(to, &bytes);
    free(bytes.data);
    return good;
}

/* Copies the files of the set's folder but the one that is damaged, and but one whose name the damaged one gets. */
static bool copy_company(const char *to, const tc_dataset *set, const char *but, const char *nor)
{
    char **name = NULL;
    size_t n = 0;
    bool good = true;
    collect(&name, &n, set->folder, "");
    for (size_t i = 0; i < n; i++) {
        char from[TC_PATH], path[TC_PATH];
        if (good && strcmp(name[i], but) != 0 && strcmp(name[i], nor) != 0)
            good = join(from, set->folder, name[i]) && join(path, to, name[i]) && copy_file(from, path);
        free(name[i]);
    }
    free(name);
    return good;
}

bool tc_damage_make(char input[TC_PATH], char damaged[TC_PATH], const char *to, const tc_dataset *set, size_t f,
                    const tc_damage *damage, uint64_t seed, const char *other)
{
    static const char *const extension[] = {".vtu", ".vtk", ".e",   ".cgns", ".case",
                                            ".hdf", ".bin", ".pvd", ".vtm",  ".obj"};
    char path[TC_PATH], name[TC_PATH];
    tc_bytes bytes, more = {0};
    uint64_t random = seed;
    size_t slash = strlen(set->folder);
    while (slash > 0 && set->folder[slash - 1] != '/')
        slash--;
    bool whole_folder = strcmp(set->folder + slash, "vol") != 0 && strcmp(set->folder + slash, "surf") != 0 &&
                        strcmp(set->folder + slash, "tf") != 0 && strcmp(set->folder + slash, "data") != 0;
    snprintf(name, sizeof name, "%s", set->file[f]);
    if (damage->to == TC_DAMAGE_NAME) {
        char *dot = strrchr(name, '.');
        if (dot)
            *dot = 0;
        const char *with = extension[tc_random(&random) % (sizeof extension / sizeof *extension)];
        if (dot && strcmp(set->file[f] + (dot - name), with) == 0)
            with = ".vtp";
        strncat(name, with, sizeof name - strlen(name) - 1);
    }
    if (!join(path, set->folder, set->file[f]) || !join(damaged, to, name) ||
        !join(input, to, *set->input && strcmp(set->input, set->file[f]) != 0 ? set->input : name) ||
        !load(&bytes, path))
        return false;
    bool good = damage->to != TC_DAMAGE_BYTES || load(&more, other);
    if (good && damage->to == TC_DAMAGE_BYTES)
        damage->apply(&bytes, &random, &more);
    if (good && whole_folder && damage->to != TC_DAMAGE_COMPANY)
        good = copy_company(to, set, set->file[f], name);
    if (good) {
        make_way(damaged);
        good = store(damaged, &bytes);
    }
    if (good && *set->input && damage->to == TC_DAMAGE_COMPANY && access(input, F_OK) != 0 &&
        join(path, set->folder, set->input))
        good = copy_file(path, input);
    free(bytes.data);
    free(more.data);
    return good;
}

void tc_folder_remove(const char *path)
{
    struct dirent *entry;
    DIR *dir = opendir(path);
    while (dir && (entry = readdir(dir))) {
        char below[TC_PATH];
        struct stat st;
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, "..") || !join(below, path, entry->d_name))
            continue;
        if (lstat(below, &st) == 0 && S_ISDIR(st.st_mode))
            tc_folder_remove(below);
        else
            unlink(below);
    }
    if (dir)
        closedir(dir);
    rmdir(path);
}
