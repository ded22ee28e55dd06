/* scene_lines.c: in which line of a JSON text a key stands. The text is known to be valid: nothing is checked again. */
#include "cli/scene/scene_lines.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct tc_place {
    const char *at;
    int line;
} tc_place;

static void tc_step(tc_place *p)
{
    p->line += *p->at == '\n';
    p->at++;
}

static void tc_space(tc_place *p)
{
    while (*p->at && strchr(" \t\r\n", *p->at))
        tc_step(p);
}

/* Behind the string that begins here; its length without quotes. */
static size_t tc_string(tc_place *p)
{
    const char *from = ++p->at;
    while (*p->at && *p->at != '"')
        p->at += *p->at == '\\' && p->at[1] ? 2 : 1;
    size_t length = (size_t)(p->at - from);
    p->at += *p->at == '"';
    return length;
}

/* Behind the value that begins here. */
static void tc_value(tc_place *p)
{
    int depth = 0;
    do {
        if (*p->at == '"') {
            tc_string(p);
            continue;
        }
        depth += (*p->at == '{' || *p->at == '[') - (*p->at == '}' || *p->at == ']');
        if (depth < 0)
            return; /* of what holds the value */
        tc_step(p);
    } while (*p->at && (depth > 0 || !strchr(",}] \t\r\n", *p->at)));
}

/* Moves from an object's beginning to the value of a key in it; *line gets the key's. */
static bool tc_find(tc_place *p, int *line, const char *key)
{
    tc_space(p);
    if (*p->at != '{')
        return false;
    tc_step(p);
    for (;;) {
        tc_space(p);
        if (*p->at != '"')
            return false;
        const char *name = p->at + 1;
        int here = p->line;
        size_t length = tc_string(p);
        tc_space(p);
        p->at += *p->at == ':';
        tc_space(p);
        if (length == strlen(key) && !memcmp(name, key, length)) {
            *line = here;
            return true;
        }
        tc_value(p);
        tc_space(p);
        if (*p->at != ',')
            return false;
        tc_step(p);
    }
}

/* Moves from an array's beginning to its element number i. */
static bool tc_find_element(tc_place *p, int *line, int i)
{
    tc_space(p);
    if (*p->at != '[')
        return false;
    for (tc_step(p); i >= 0; i--) {
        tc_space(p);
        if (i == 0)
            break;
        tc_value(p);
        tc_space(p);
        if (*p->at != ',')
            return false;
        tc_step(p);
    }
    *line = p->line;
    return true;
}

int tc_json_line(const char *text, const char *section, const char *key)
{
    tc_place p = {text, 1};
    int line = 1, element = -1;
    char name[64];
    const char *bracket = strchr(section, '[');
    if (!strncmp(text, "\xef\xbb\xbf", 3))
        p.at += 3;
    snprintf(name, sizeof name, "%.*s", bracket ? (int)(bracket - section) : (int)strlen(section), section);
    if (bracket)
        element = atoi(bracket + 1);
    if (*section && !tc_find(&p, &line, name))
        return line;
    if (element >= 0 && !tc_find_element(&p, &line, element))
        return line;
    tc_find(&p, &line, key);
    return line;
}
