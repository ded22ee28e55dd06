/* key.c: what a prepared mesh depends on, as one hash: the bytes of its file, of a dataset of several files also names,
 * sizes and times of all that lie with it, the settings that change the result, and the programs that made it. */
#define _GNU_SOURCE
#include "cache/belongings.h"
#include "cache/format.h"
#include "core/locate.h"
#include "core/memory.h"
#include "mesh/mesh.h"

#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Size and time of a program: another build may make another mesh. Nothing where it is not there. */
static void put_program(FILE *stream, const char *path)
{
    struct stat file;
    if (path && stat(path, &file) == 0)
        fprintf(stream, "program %lld %lld.%09ld\n", (long long)file.st_size, (long long)file.st_mtim.tv_sec,
                file.st_mtim.tv_nsec);
    else
        fprintf(stream, "no program\n");
}

/* The same of a module that lies beside a program. */
static void put_module(FILE *stream, const char *program, const char *name)
{
    const char *slash = program ? strrchr(program, '/') : NULL;
    char *path = NULL;
    if (slash && asprintf(&path, "%.*s/%s", (int)(slash - program), program, name) < 0)
        path = NULL;
    put_program(stream, path);
    free(path);
}

static void put_programs(FILE *stream)
{
    static const char here; /* an address inside the library */
    static const struct {
        const char *name, *module;
    } helpers[] = {{"tetcast-read", "tetcast-read-more.so"}, {"tetcast-convexify", NULL}};
    Dl_info library;
    put_program(stream, dladdr(&here, &library) != 0 ? library.dli_fname : NULL);
    for (size_t i = 0; i < sizeof helpers / sizeof *helpers; i++) {
        char *path;
        if (tc_locate_helper(&path, helpers[i].name, NULL) != TC_OK)
            path = NULL;
        put_program(stream, path);
        if (helpers[i].module)
            put_module(stream, path, helpers[i].module);
        free(path);
    }
}

static void put_settings(FILE *stream, const tc_read_options *read, const tc_prepare_options *prepare)
{
    fprintf(stream, "format %d, %s, %zu %zu bytes\n", TC_CACHE_FORMAT, tc_version(), sizeof(tc_mesh_report),
            sizeof(tc_file_repairs));
    if (read->field)
        fprintf(stream, "field %zu %s\n", strlen(read->field), read->field);
    fprintf(stream, "association %d, refine %d, ranges %d\n", (int)read->association, read->refine,
            read->all_ranges || !read->field);
    if (read->has_time)
        fprintf(stream, "time %a\n", read->time);
    if (read->has_step)
        fprintf(stream, "step %d\n", read->step);
    fprintf(stream, "reentry %d, limit %a, once %zu\n", (int)prepare->reentry, prepare->convexify_limit_s,
            prepare->once_pixels);
}

/* What lies with a file: in the folder of its name, and, where that is a link, in that of the file itself. */
static tc_status put_folders(FILE *stream, const char *path, const char *real, tc_error *err)
{
    const char *const names[] = {path, real};
    tc_status status = TC_OK;
    char *first = NULL;
    for (int i = 0; i < 2 && status == TC_OK; i++) {
        const char *slash = strrchr(names[i], '/');
        char *folder = slash ? strndup(names[i], slash == names[i] ? 1 : (size_t)(slash - names[i])) : strdup(".");
        char *whole = folder ? realpath(folder, NULL) : NULL;
        tc_hash hash;
        if (!whole)
            status = tc_fail(err, TC_E_FILE, "the folder of %s cannot be read: %s", names[i], strerror(errno));
        else if (!first || strcmp(first, whole) != 0)
            status = tc_cache_folder(&hash, whole, real, err);
        if (status == TC_OK && (!first || strcmp(first, whole) != 0))
            fprintf(stream, "folder %016llx%016llx, file %s\n", (unsigned long long)hash.word[0],
                    (unsigned long long)hash.word[1], slash ? slash + 1 : names[i]);
        free(folder);
        free(first);
        first = whole;
    }
    free(first);
    return status;
}

/* The content of path, and of what lies with it. */
static tc_status put_content(FILE *stream, const char *path, int threads, tc_error *err)
{
    char *real = realpath(path, NULL);
    struct stat info;
    tc_hash hash = {{0, 0}};
    uint64_t bytes = 0;
    tc_status status = TC_OK;
    if (!real || stat(real, &info) != 0)
        status = tc_fail(err, TC_E_FILE, "%s cannot be read: %s", path, strerror(errno));
    else if (S_ISDIR(info.st_mode))
        status = tc_cache_folder(&hash, real, NULL, err);
    else
        status = tc_hash_file(&hash, &bytes, real, threads, err);
    if (status == TC_OK)
        fprintf(stream, "content %llu %016llx%016llx\n", (unsigned long long)bytes, (unsigned long long)hash.word[0],
                (unsigned long long)hash.word[1]);
    if (status == TC_OK && !S_ISDIR(info.st_mode) && !tc_cache_alone(real))
        status = put_folders(stream, path, real, err);
    free(real);
    return status;
}

tc_status tc_cache_key_make(tc_cache_key *out, const char *path, const tc_read_options *read,
                            const tc_prepare_options *prepare, tc_error *err)
{
    static const tc_read_options no_read = {0};
    static const tc_prepare_options no_prepare = {0};
    char *text = NULL;
    size_t n = 0;
    if (!out || !path)
        return tc_fail(err, TC_E_ARG, "tc_cache_key_make: out or path is NULL");
    *out = (tc_cache_key){{0, 0}};
    prepare = prepare ? prepare : &no_prepare;
    FILE *stream = open_memstream(&text, &n);
    if (!stream)
        return tc_fail_memory(err, "a cache's key", 1, 4096);
    put_settings(stream, read ? read : &no_read, prepare);
    put_programs(stream);
    tc_status status = put_content(stream, path, prepare->threads, err);
    if (fclose(stream) != 0 && status == TC_OK)
        status = tc_fail_memory(err, "a cache's key", 1, 4096);
    if (status == TC_OK) {
        tc_hash hash = tc_hash_bytes(text, n, TC_CACHE_FORMAT);
        out->word[0] = hash.word[0];
        out->word[1] = hash.word[1];
    }
    free(text);
    return status;
}
