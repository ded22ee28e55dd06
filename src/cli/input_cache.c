/* input_cache.c: --cache and --cache-file: a prepared mesh is kept in a file and found again. */
#define _GNU_SOURCE
#include "cli/input_cache.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* INPUT without slashes at its end; "." and the like by the folder's own name. The caller frees it. */
static char *tc_input_plain(const char *input)
{
    const char *slash = strrchr(input, '/'), *name = slash ? slash + 1 : input;
    if (!*name || !strcmp(name, ".") || !strcmp(name, ".."))
        return realpath(input, NULL);
    return strdup(input);
}

/* The file in seen->cache; "" where it has no name that fits. */
static void tc_cache_name(tc_input_seen *seen, const tc_cache_key *key, const tc_input_options *options,
                          const char *input)
{
    struct stat info;
    char *plain = tc_input_plain(input);
    const char *file = options->cache_file, *slash = plain ? strrchr(plain, '/') : NULL;
    int length = -1;
    if (file && (stat(file, &info) != 0 || !S_ISDIR(info.st_mode)))
        length = snprintf(seen->cache, sizeof seen->cache, "%s", file);
    else if (file && plain)
        length = snprintf(seen->cache, sizeof seen->cache, "%s/%.200s-%016llx.tccache", file, slash ? slash + 1 : plain,
                          (unsigned long long)key->word[0]);
    else if (plain)
        length = snprintf(seen->cache, sizeof seen->cache, "%s.tccache", plain);
    if (length < 0 || (size_t)length >= sizeof seen->cache)
        seen->cache[0] = 0;
    free(plain);
}

/* Tries the cache: *out gets the mesh, or stays NULL. False: there is nothing to keep the mesh by. */
static bool tc_cache_try(tc_mesh **out, tc_cache_key *key, tc_input_seen *seen, const tc_input_options *options,
                         const tc_read_options *read, const tc_prepare_options *prepare, const char *input,
                         tc_talk *talk)
{
    tc_error err = {0};
    double start = tc_talk_clock_s();
    if (tc_input_is_synthetic(input)) {
        tc_talk_warning(talk, "a synthetic dataset has no file to keep a cache for: --cache is without effect");
        return false;
    }
    if (access(input, R_OK) != 0) /* reading it will say so */
        return false;
    if (tc_cache_key_make(key, input, read, prepare, &err) != TC_OK) {
        tc_talk_warning(talk, "no cache is used: %s", err.text);
        return false;
    }
    tc_cache_name(seen, key, options, input);
    if (!seen->cache[0])
        return false;
    seen->hit =
        tc_mesh_load(out, seen->cache, key, input, options->threads, &talk->log, &err) == TC_OK;
    if (seen->hit) {
        seen->ms_cache_load = 1e3 * (tc_talk_clock_s() - start);
        tc_talk_detail(talk, "the prepared mesh came from %s", seen->cache);
    } else if (access(seen->cache, F_OK) == 0) {
        snprintf(seen->why, sizeof seen->why, "%s", err.text);
        tc_talk_detail(talk, "the cache is not used: %s", err.text);
    }
    return true;
}

/* Keeps a mesh that was read under this key. */
static void tc_cache_keep(tc_input_seen *seen, const tc_cache_key *key, const tc_mesh *mesh,
                          const tc_input_options *options, const tc_read_options *read,
                          const tc_prepare_options *prepare, const char *input, tc_talk *talk)
{
    tc_error err = {0};
    tc_cache_key now;
    double start = tc_talk_clock_s();
    if (tc_cache_key_make(&now, input, read, prepare, &err) != TC_OK || memcmp(&now, key, sizeof now) != 0) {
        tc_talk_warning(talk, "%s changed while it was read: no cache is written", input);
    } else if (tc_mesh_save(mesh, seen->cache, key, options->threads, &err) != TC_OK) {
        tc_talk_warning(talk, "no cache is written: %s", err.text);
    } else {
        seen->ms_cache_save = 1e3 * (tc_talk_clock_s() - start);
        tc_talk_detail(talk, "the prepared mesh is kept in %s", seen->cache);
    }
}

int tc_input_open(tc_mesh **out, tc_input_seen *seen, const tc_input_options *options, const char *input, tc_talk *talk)
{
    const tc_read_options read = tc_input_read_options(options);
    const tc_prepare_options prepare = tc_input_prepare_options(options);
    tc_cache_key key;
    *out = NULL;
    *seen = (tc_input_seen){.ms_read = NAN, .ms_cache_load = NAN, .ms_cache_save = NAN};
    bool cache = (options->cache || options->cache_file) &&
                 tc_cache_try(out, &key, seen, options, &read, &prepare, input, talk);
    int code = *out ? -1 : tc_input_load(out, &seen->ms_read, options, input, talk);
    if (code < 0)
        code = tc_input_prepare(*out, options, talk);
    if (code < 0 && cache && seen->cache[0] && !seen->hit)
        tc_cache_keep(seen, &key, *out, options, &read, &prepare, input, talk);
    return code;
}

json_t *tc_input_cache_json(const tc_input_seen *seen)
{
    if (!seen->cache[0])
        return NULL;
    json_t *out = json_object();
    tc_json_text(out, "file", seen->cache);
    json_object_set_new(out, "hit", json_boolean(seen->hit));
    tc_json_text(out, "why", seen->why);
    tc_json_measured(out, "load_ms", seen->ms_cache_load);
    tc_json_measured(out, "save_ms", seen->ms_cache_save);
    return out;
}
