/* digest.c: what a frame's pixels depend on, as a short text. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/digest.h"
#include "cli/json_out.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* Is the file only the list of the others, or one of several? */
static bool tc_is_of_many(const char *path)
{
    static const char *const known[] = {".case", ".foam",   ".pvd", ".series", ".pvtu", ".encas", ".sos",
                                        ".k",    ".d3plot", ".vtm", ".cas",    ".pvtk", ".pvtp"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof known / sizeof *known; i++)
        if (!strcasecmp(dot, known[i]))
            return true;
    return false;
}

void tc_identity_make(char *out, size_t capacity, const char *path)
{
    struct stat info;
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    *out = 0;
    if (tc_input_is_synthetic(path)) {
        snprintf(out, capacity, "%s", path);
        return;
    }
    if (stat(path, &info) != 0)
        return;
    int used = snprintf(out, capacity, "%s %lld %lld.%09ld", name, (long long)info.st_size,
                        (long long)info.st_mtim.tv_sec, (long)info.st_mtim.tv_nsec);
    tc_cache_key key;
    if (used <= 0 || (size_t)used >= capacity || (!S_ISDIR(info.st_mode) && !tc_is_of_many(path)))
        return;
    if (tc_cache_key_make(&key, path, NULL, NULL, NULL) == TC_OK)
        snprintf(out + used, capacity - (size_t)used, " %016" PRIx64 "%016" PRIx64, key.word[0], key.word[1]);
    else
        *out = 0; /* files that it names may change unseen */
}

/* Says where, when or how fast, not what is seen. */
static bool tc_is_apart(const char *option)
{
    static const char *const apart[] = {"--step", "--time", "--size"};
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++)
        if (!strcmp(option, apart[i]))
            return true;
    return false;
}

json_t *tc_digest_options(const tc_render_command *options)
{
    size_t n_key;
    const tc_scene_key *key = tc_scene_keys(&n_key);
    json_t *list = json_array();
    for (size_t k = 0; k < n_key; k++) {
        if (key[k].role != TC_KEY_PICTURE || !key[k].option || tc_is_apart(key[k].option))
            continue;
        for (size_t i = 0; i < options->given.n; i++) {
            const tc_given *given = &options->given.item[i];
            char identity[512] = "";
            if (strcmp(given->option->name, key[k].option) != 0)
                continue;
            json_t *one = json_array();
            json_array_append_new(one, json_string(key[k].option));
            const bool file = given->text && ((key[k].path == TC_PATH_MAYBE && tc_names_file(given->text)) ||
                                              key[k].path == TC_PATH_OPACITY);
            if (file) { /* its folder may have moved */
                char *path = strdup(given->text), *comma = path ? strrchr(path, ',') : NULL;
                if (path)
                    tc_identity_make(identity, sizeof identity, path);
                if (comma && !*identity) {
                    *comma = 0;
                    tc_identity_make(identity, sizeof identity, path);
                    json_array_append_new(one, json_string(comma + 1));
                }
                free(path);
            }
            json_array_append_new(one, json_string(*identity ? identity : given->text ? given->text : ""));
            json_array_append_new(list, one);
        }
    }
    const double size[2] = {options->size.width, options->size.height};
    json_t *json = json_object();
    json_object_set_new(json, "options", list);
    json_object_set_new(json, "size", tc_json_reals(size, 2));
    return json;
}

void tc_digest_make(char out[17], json_t *json)
{
    char *text = json_dumps(json, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    uint64_t hash = 0xcbf29ce484222325u;
    json_decref(json);
    *out = 0;
    if (!text)
        return;
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        hash = (hash ^ *c) * 0x100000001b3u;
    snprintf(out, 17, "%016" PRIx64, hash);
    free(text);
}
