/* locate.c: where helper programs are: in $TETCAST_HELPERS, beside the library or the executable, or as installed. */
#define _GNU_SOURCE
#include "core/locate.h"
#include "core/memory.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct search {
    const char *name;
    char *found;
    char places[700]; /* folders, for the error sentence */
    bool out_of_memory;
} search;

/* Looks for name in folder + below; true when the search is over. */
static bool look(search *s, const char *folder, size_t length, const char *below)
{
    char *path = NULL;
    struct stat info;
    if (length == 0)
        return false;
    if (asprintf(&path, "%.*s%s/%s", (int)length, folder, below, s->name) < 0) {
        s->out_of_memory = true;
        return true;
    }
    if (stat(path, &info) == 0 && S_ISREG(info.st_mode) && access(path, X_OK) == 0) {
        s->found = realpath(path, NULL);
        s->out_of_memory = !s->found;
    }
    free(path);
    if (s->found || s->out_of_memory)
        return true;
    size_t n = strlen(s->places);
    snprintf(s->places + n, sizeof s->places - n, "%s%.*s%s", n ? ", " : "", (int)length, folder, below);
    return false;
}

/* Looks in the folders that belong to the file `beside`. */
static bool look_around(search *s, const char *beside)
{
    static const char *const below[] = {
        "/../libexec/tetcast", "/../../libexec/tetcast", "/../lib/tetcast", "/tetcast", "", "/.."};
    char *path = realpath(beside, NULL);
    char *slash = path ? strrchr(path, '/') : NULL;
    bool over = false;
    for (size_t i = 0; slash && !over && i < sizeof below / sizeof *below; i++)
        over = slash == path ? look(s, "/.", 2, below[i]) : look(s, path, (size_t)(slash - path), below[i]);
    free(path);
    return over;
}

tc_status tc_locate_helper(char **path, const char *name, tc_error *err)
{
    static const char here; /* an address inside the library */
    search s = {.name = name};
    bool over = false;
    *path = NULL;
    for (const char *folder = secure_getenv("TETCAST_HELPERS"); folder && !over;) {
        size_t n = strcspn(folder, ":");
        over = look(&s, folder, n, "");
        folder = folder[n] ? folder + n + 1 : NULL;
    }
    Dl_info library;
    if (!over && dladdr(&here, &library) != 0 && library.dli_fname)
        over = look_around(&s, library.dli_fname);
    if (!over)
        over = look_around(&s, "/proc/self/exe");
    if (s.out_of_memory)
        return tc_fail_memory(err, "the path of a helper program", 1, 4096);
    if (!s.found)
        return tc_fail(err, TC_E_WORKER,
                       "the helper program %s was not found (searched %s); set TETCAST_HELPERS to its folder", name,
                       s.places);
    *path = s.found;
    return TC_OK;
}
