/* json_check.c: a JSON file against conditions, for the shell tests.
 *   json_check FILE has KEY | lacks KEY | eq KEY VALUE | le KEY NUMBER | ge KEY NUMBER | type KEY NAME | size KEY N …
 * KEY is a path such as march.fragments_per_pass.0 ("." is the whole); VALUE is a number, true, false or a text.
 * Exit 0 when every condition holds; else 1, and the first that does not is printed. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const json_t *tc_find(const json_t *json, const char *key)
{
    char name[128];
    while (json && *key && strcmp(key, ".") != 0) {
        size_t length = strcspn(key, ".");
        snprintf(name, sizeof name, "%.*s", (int)length, key);
        json = json_is_array(json) ? json_array_get(json, (size_t)atol(name)) : json_object_get(json, name);
        key += length + (key[length] == '.');
    }
    return json;
}

static const char *tc_type_name(const json_t *json)
{
    switch (json_typeof(json)) {
    case JSON_OBJECT:
        return "object";
    case JSON_ARRAY:
        return "array";
    case JSON_STRING:
        return "string";
    case JSON_INTEGER:
        return "integer";
    case JSON_REAL:
        return "real";
    case JSON_NULL:
        return "null";
    default:
        return "boolean";
    }
}

static int tc_equal(const json_t *json, const char *value)
{
    if (json_is_string(json))
        return !strcmp(json_string_value(json), value);
    if (json_is_boolean(json))
        return !strcmp(value, json_is_true(json) ? "true" : "false");
    return json_is_number(json) && json_number_value(json) == atof(value);
}

/* How many words the condition takes besides its name, and whether it holds. 0: unknown condition. */
static int tc_check(int *holds, const json_t *json, const char *what, const char *value)
{
    *holds = 0;
    if (!strcmp(what, "has")) {
        *holds = json != NULL;
        return 1;
    }
    if (!strcmp(what, "lacks")) {
        *holds = json == NULL;
        return 1;
    }
    if (!value)
        return 0;
    if (!strcmp(what, "eq"))
        *holds = json && tc_equal(json, value);
    else if (!strcmp(what, "le"))
        *holds = json_is_number(json) && json_number_value(json) <= atof(value);
    else if (!strcmp(what, "ge"))
        *holds = json_is_number(json) && json_number_value(json) >= atof(value);
    else if (!strcmp(what, "type"))
        *holds = json && !strcmp(tc_type_name(json), value);
    else if (!strcmp(what, "size"))
        *holds =
            json && (json_is_array(json) ? json_array_size(json) : json_object_size(json)) == strtoul(value, 0, 10);
    else
        return 0;
    return 2;
}

int main(int argc, char **argv)
{
    json_error_t error;
    json_t *root = argc > 1 ? json_load_file(argv[1], JSON_DECODE_ANY, &error) : NULL;
    if (!root) {
        printf("%s is not JSON: %s\n", argc > 1 ? argv[1] : "no file", argc > 1 ? error.text : "");
        return 1;
    }
    int code = argc > 2 ? 0 : 1, i = 2;
    while (i + 1 < argc && !code) {
        int holds, words = tc_check(&holds, tc_find(root, argv[i + 1]), argv[i], i + 2 < argc ? argv[i + 2] : NULL);
        if (!words || !holds) {
            char *text = json_dumps(tc_find(root, argv[i + 1]), JSON_ENCODE_ANY | JSON_COMPACT);
            printf("%s %s %s%s; it is %.200s\n", argv[i], argv[i + 1], words == 2 ? argv[i + 2] : "",
                   words ? " does not hold" : " is no condition", text ? text : "absent");
            free(text);
            code = 1;
        }
        i += 1 + words;
    }
    if (!code && i != argc) {
        printf("'%s' is left over\n", argv[i]);
        code = 1;
    }
    json_decref(root);
    return code;
}
