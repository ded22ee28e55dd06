/* room.c: whether memory will do, before it is taken. */
#include "core/room.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t UNASKED = (size_t)256 << 20;
static const double GIB = 1073741824.0;

/* A number with K, M, G or T behind it; false where it is none. */
static bool parse_bytes(size_t *out, const char *text)
{
    char *end;
    double n = strtod(text, &end);
    static const char unit[] = "KMGT";
    const char *u = *end ? strchr(unit, toupper((unsigned char)*end)) : NULL;
    if (end == text || !(n >= 0) || (*end && (!u || end[1])))
        return false;
    for (const char *p = unit; u && p <= u; p++)
        n *= 1024;
    *out = n < (double)SIZE_MAX ? (size_t)n : SIZE_MAX;
    return true;
}

/* The number behind the first line that begins with `key` ("": the first line); false where the file or the line is not
 * there or no number follows ("max"). */
static bool read_number(unsigned long long *out, const char *path, const char *key)
{
    char line[256];
    FILE *file = fopen(path, "re");
    bool found = false;
    while (file && !found && fgets(line, sizeof line, file))
        found = strncmp(line, key, strlen(key)) == 0 && sscanf(line + strlen(key), "%llu", out) == 1;
    if (file)
        fclose(file);
    return found;
}

static size_t system_room(void)
{
    unsigned long long kib;
    return read_number(&kib, "/proc/meminfo", "MemAvailable:") && kib < SIZE_MAX / 1024 ? (size_t)kib * 1024 : SIZE_MAX;
}

/* What the names of one version of control groups are. */
typedef struct names {
    const char *root, *limit, *usage, *reclaimable[2];
} names;

static const names version2 = {"/sys/fs/cgroup", "memory.max", "memory.current", {"inactive_file ", "active_file "}};
static const names version1 = {"/sys/fs/cgroup/memory",
                               "memory.limit_in_bytes",
                               "memory.usage_in_bytes",
                               {"total_inactive_file ", "total_active_file "}};

static bool group_number(unsigned long long *out, const names *n, const char *group, const char *file, const char *key)
{
    char path[4600];
    snprintf(path, sizeof path, "%s%s/%s", n->root, group, file);
    return read_number(out, path, key);
}

/* The least that a group and those above it leave. Cuts `group` down. */
static size_t group_room(const names *n, char *group)
{
    size_t room = SIZE_MAX;
    for (;;) {
        unsigned long long limit, usage, file;
        if (group_number(&limit, n, group, n->limit, "") && group_number(&usage, n, group, n->usage, "")) {
            for (int i = 0; i < 2; i++)
                if (group_number(&file, n, group, "memory.stat", n->reclaimable[i]))
                    usage -= file < usage ? file : usage;
            size_t left = limit > usage ? (size_t)(limit - usage) : 0;
            room = left < room ? left : room;
        }
        char *slash = strrchr(group, '/');
        if (!slash)
            return room;
        *slash = 0;
    }
}

static size_t groups_room(void)
{
    size_t room = SIZE_MAX;
    char line[4200];
    FILE *file = fopen("/proc/self/cgroup", "re");
    while (file && fgets(line, sizeof line, file)) { /* number:controllers:/path */
        char *kind = strchr(line, ':'), *group = kind ? strchr(kind + 1, ':') : NULL;
        if (!group)
            continue;
        *group++ = 0;
        group[strcspn(group, "\n")] = 0;
        bool first = strcmp(kind, ":memory") == 0, second = strcmp(kind, ":") == 0;
        size_t left = first ? group_room(&version1, group) : second ? group_room(&version2, group) : SIZE_MAX;
        room = left < room ? left : room;
    }
    if (file)
        fclose(file);
    return room;
}

static bool told(size_t *out)
{
    const char *text = getenv("TETCAST_MEMORY");
    return text && parse_bytes(out, text);
}

size_t tc_room_available(void)
{
    size_t room;
    if (told(&room))
        return room;
    size_t system = system_room(), groups = groups_room();
    return system < groups ? system : groups;
}

tc_status tc_room_check(size_t bytes, tc_error *err, const char *what, ...)
{
    size_t room;
    if (!told(&room) && bytes < UNASKED)
        return TC_OK;
    room = tc_room_available();
    if (bytes <= room)
        return TC_OK;
    char text[256];
    va_list list;
    va_start(list, what);
    vsnprintf(text, sizeof text, what, list);
    va_end(list);
    return tc_fail(err, TC_E_MEMORY,
                   "%s needs about %.2f GiB of memory, and %.2f GiB are free; close other programs, use a smaller mesh, or "
                   "say in TETCAST_MEMORY how much may be taken",
                   text, (double)bytes / GIB, (double)room / GIB);
}
