/* options.c: parsing a command line against a table, and printing the table as help. */
#include "cli/options.h"
#include "cli/nearest.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TC_HELP_COLUMN 34
#define TC_HELP_WIDTH 100

/* Options of every command. values of flags go to this struct. */
typedef struct tc_common {
    bool quiet, verbose, help, version;
} tc_common;

static const tc_option tc_common_option[] = {
    {.help = "Everywhere"},
    {"--quiet", 'q', NULL, "only errors", TC_OPTION_FLAG, .at = offsetof(tc_common, quiet)},
    {"--verbose", 'v', NULL, "say what is done and why", TC_OPTION_FLAG, .at = offsetof(tc_common, verbose)},
    {"--help", 'h', NULL, "this text", TC_OPTION_FLAG, .at = offsetof(tc_common, help)},
    {"--version", 0, NULL, "the version", TC_OPTION_FLAG, .at = offsetof(tc_common, version)},
};
#define TC_N_COMMON (sizeof tc_common_option / sizeof *tc_common_option)

bool tc_parse_real(double *out, const char *text)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !isfinite(value))
        return false;
    *out = value;
    return true;
}

bool tc_parse_reals(double *out, int *count, int capacity, const char *text)
{
    int n = 0;
    for (const char *at = text;; n++) {
        char *end;
        double value = strtod(at, &end);
        if (n == capacity || end == at || !isfinite(value) || (*end && *end != ','))
            return false;
        out[n] = value;
        if (!*end)
            break;
        at = end + 1;
    }
    *count = n + 1;
    return true;
}

bool tc_parse_int(int *out, const char *text)
{
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (end == text || *end || errno || value < INT_MIN || value > INT_MAX)
        return false;
    *out = (int)value;
    return true;
}

static bool tc_parse_u64(uint64_t *out, const char *text)
{
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    if (end == text || *end || errno || strchr(text, '-'))
        return false;
    *out = value;
    return true;
}

/* ---------------------------------------------------------------------------------------------------- one value */

static bool tc_in_bounds(const tc_option *option, double value)
{
    if (option->low == option->high)
        return true;
    return value <= option->high && (option->open ? value > option->low : value >= option->low);
}

/* 1 found, 0 not one of the words, -1 a word of a later version */
static int tc_choice_find(int *out, const tc_choice *choice, const char *text)
{
    for (; choice && choice->name; choice++)
        if (!strcmp(choice->name, text)) {
            *out = choice->value;
            return choice->later ? -1 : 1;
        }
    return 0;
}

static int tc_refuse_value(tc_talk *talk, const tc_option *option, const char *text, const char *why)
{
    char bounds[96] = "";
    if (option->low != option->high && !*why) {
        if (option->high < 1e18)
            snprintf(bounds, sizeof bounds, ", %s %.10g and at most %.10g", option->open ? "above" : "at least",
                     option->low, option->high);
        else
            snprintf(bounds, sizeof bounds, ", %s %g", option->open ? "above" : "at least", option->low);
    }
    tc_talk_error(talk, "%s takes %s%s%s%s, not '%s'", option->name, option->value, bounds, *why ? ": " : "", why,
                  text);
    return TC_EXIT_USAGE;
}

static int tc_refuse_choice(tc_talk *talk, const tc_option *option, const char *text)
{
    tc_nearest search = {.name = text};
    for (const tc_choice *choice = option->choice; choice->name; choice++)
        if (!choice->later)
            tc_nearest_offer(&search, choice->name);
    tc_talk_error(talk, "%s takes %s, not '%s'; the nearest is '%s'", option->name, option->value, text, search.best);
    return TC_EXIT_USAGE;
}

static int tc_value_set(char *values, tc_talk *talk, const tc_option *option, const char *text)
{
    void *field = values + option->at;
    char why[64] = "";
    bool good = false;
    int number = 0, found = text ? tc_choice_find(&number, option->choice, text) : 0;
    double real;
    uint64_t big;

    if (found < 0 || option->kind == TC_OPTION_LATER) {
        tc_talk_error(talk, "%s%s%s is not in this version (%s)", option->name, found < 0 ? " " : "",
                      found < 0 ? text : "", tc_version());
        return TC_EXIT_USAGE;
    }
    switch (option->kind) {
    case TC_OPTION_TEXT:
        good = *text != 0;
        *(const char **)field = text;
        break;
    case TC_OPTION_INT:
        good = found || (tc_parse_int(&number, text) && tc_in_bounds(option, number));
        *(int *)field = number;
        break;
    case TC_OPTION_CHOICE:
        if (!found)
            return tc_refuse_choice(talk, option, text);
        good = true;
        *(int *)field = number;
        break;
    case TC_OPTION_U64:
        good = tc_parse_u64(&big, text) && tc_in_bounds(option, (double)big);
        if (good)
            *(uint64_t *)field = big;
        break;
    case TC_OPTION_REAL:
        if (option->optional && !text) {
            *(double *)field = option->high;
            good = true;
            break;
        }
        good = found || (tc_parse_real(&real, text) && tc_in_bounds(option, real));
        if (good)
            *(double *)field = found ? (double)number : real;
        break;
    case TC_OPTION_REALS:
        good = tc_parse_reals(field, &number, option->n, text) && number == option->n;
        for (int i = 0; good && i < number; i++)
            good = tc_in_bounds(option, ((double *)field)[i]);
        break;
    case TC_OPTION_CUSTOM:
        good = option->parse(field, text, why);
        break;
    default:
        break;
    }
    if (!good)
        return tc_refuse_value(talk, option, text, why);
    if (option->has)
        *(bool *)(values + option->has - 1) = true;
    return -1;
}

/* ------------------------------------------------------------------------------------------------- what was given */

/* Notes an option that was set. */
static int tc_given_add(tc_given_list *list, tc_talk *talk, const tc_option *option, const char *called,
                        const char *text)
{
    size_t at = list->n;
    for (size_t i = 0; i < list->n && !option->repeat; i++)
        if (list->item[i].option == option)
            at = i;
    if (at == list->n) {
        tc_given *more = realloc(list->item, (list->n + 1) * sizeof *more);
        if (!more) {
            tc_talk_error(talk, "memory ran out");
            return TC_EXIT_FAILED;
        }
        list->item = more;
        list->n++;
    }
    list->item[at] = (tc_given){option, text, called};
    return -1;
}

static const tc_given *tc_given_find(const tc_given_list *list, const char *name)
{
    for (size_t i = list->n; i-- > 0;)
        if (!strcmp(list->item[i].option->name, name))
            return &list->item[i];
    return NULL;
}

bool tc_is_put_off(const tc_given_list *list, const char *name)
{
    const tc_given *one = tc_given_find(list, name);
    return one && one->text && !strcmp(one->text, "off") &&
           (one->option->kind == TC_OPTION_FLAG || one->option->kind == TC_OPTION_CHOICE || one->option->optional);
}

bool tc_is_given(const tc_given_list *list, const char *name)
{
    return tc_given_find(list, name) && !tc_is_put_off(list, name);
}

bool tc_is_of_line(const tc_given_list *list, const char *name)
{
    const tc_given *one = tc_given_find(list, name);
    return one && one->called == one->option->name;
}

const char *tc_scene_place(const tc_given_list *list, const char *name)
{
    const tc_given *one = tc_given_find(list, name);
    return one && one->called != one->option->name ? one->called : NULL;
}

int tc_given_refuse(const tc_given_list *list, tc_talk *talk, const char *option, const char *with, const char *format,
                    ...)
{
    char text[8192];
    const char *place = tc_scene_place(list, option);
    va_list more;
    va_start(more, format);
    vsnprintf(text, sizeof text, format, more);
    va_end(more);
    tc_talk_error(talk, "%s%s%s", place ? place : "", place ? ": " : "", text);
    return !place || (with && tc_is_of_line(list, with)) ? TC_EXIT_USAGE : TC_EXIT_FAILED;
}

void tc_given_finish(tc_given_list *list)
{
    free(list->item);
    *list = (tc_given_list){0};
}

/* ------------------------------------------------------------------------------------------------- whole command */

/* A table of options and where the struct of its values lies in the command's. */
typedef struct tc_table_of {
    const tc_option *option;
    size_t n, at;
} tc_table_of;
enum { TC_TABLES = 4 }; /* the last: options of every command */

static tc_table_of tc_option_table(const tc_command *command, int i)
{
    switch (i) {
    case 0:
        return (tc_table_of){command->option, command->n_option, 0};
    case 1:
        return (tc_table_of){command->also, command->n_also, command->also_at};
    case 2:
        return (tc_table_of){command->own, command->n_own, 0};
    default:
        return (tc_table_of){tc_common_option, TC_N_COMMON, 0};
    }
}

/* Finds an option by its long name of that length, or by its letter. *table tells in which table it is. */
static const tc_option *tc_option_find(int *table, const tc_command *command, const char *name, size_t length,
                                       char letter)
{
    for (int k = 0; k < TC_TABLES; k++) {
        const tc_table_of t = tc_option_table(command, k);
        for (size_t i = 0; i < t.n; i++) {
            const tc_option *option = &t.option[i];
            bool by_name =
                name && option->name && strlen(option->name) == length && !memcmp(option->name, name, length);
            if (by_name || (letter && option->letter == letter)) {
                *table = k;
                return option;
            }
        }
    }
    return NULL;
}

const tc_option *tc_command_option(const tc_command *command, const char *name)
{
    int table;
    const tc_option *option = tc_option_find(&table, command, name, strlen(name), 0);
    return option && table < TC_TABLES - 1 ? option : NULL;
}

int tc_option_set(void *values, tc_talk *talk, const tc_command *command, const tc_option *option, const char *called,
                  const char *text)
{
    int code = -1, table = 0;
    tc_option named = *option;
    tc_option_find(&table, command, option->name, strlen(option->name), 0);
    char *base = (char *)values + tc_option_table(command, table).at;
    named.name = called;
    if (option->optional && text && !strcmp(text, "off"))
        *(bool *)(base + option->has - 1) = false;
    else if (option->kind == TC_OPTION_FLAG)
        *(bool *)(base + option->at) = strcmp(text, "off") != 0;
    else
        code = tc_value_set(base, talk, &named, text);
    if (code < 0 && command->given)
        code = tc_given_add((tc_given_list *)((char *)values + command->given - 1), talk, option, called, text);
    return code;
}

static int tc_refuse_option(tc_talk *talk, const tc_command *command, const char *text, size_t length)
{
    char name[64];
    tc_nearest search = {.name = name};
    snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), text);
    for (int k = 0; k < TC_TABLES; k++) {
        const tc_table_of t = tc_option_table(command, k);
        for (size_t i = 0; i < t.n; i++)
            if (t.option[i].name && t.option[i].kind != TC_OPTION_LATER)
                tc_nearest_offer(&search, t.option[i].name);
    }
    tc_talk_error(talk, "%s has no option '%s'; the nearest is '%s' (tetcast %s --help lists them)", command->name,
                  name, search.best, command->name);
    return TC_EXIT_USAGE;
}

/* Is the word one of the command's long options? */
static bool tc_is_option(const tc_command *command, const char *word)
{
    int table;
    return !strncmp(word, "--", 2) && tc_option_find(&table, command, word, strcspn(word, "="), 0);
}

/* Reads the option at argv[*i], and its value; moves *i onto the last word used. */
static int tc_option_read(void *values, tc_common *common, tc_talk *talk, const tc_command *command, int *i, int argc,
                          char **argv)
{
    const char *text = argv[*i], *value = NULL, *next = *i + 1 < argc ? argv[*i + 1] : NULL;
    double number;
    int table = 0;
    bool is_long = text[1] == '-';
    size_t length = is_long ? strcspn(text, "=") : 2;
    const tc_option *option = tc_option_find(&table, command, is_long ? text : NULL, length, is_long ? 0 : text[1]);
    if (!option)
        return tc_refuse_option(talk, command, text, length);
    if (text[length])
        value = text + length + (is_long ? 1 : 0);
    if (option->kind == TC_OPTION_FLAG && value && (table == TC_TABLES - 1 || strcmp(value, "off") != 0)) {
        tc_talk_error(talk, "%s takes no value, but '%s' was given", option->name, text);
        return TC_EXIT_USAGE;
    }
    if (table == TC_TABLES - 1) {
        *(bool *)((char *)common + option->at) = true;
        return -1;
    }
    if (option->kind == TC_OPTION_FLAG) {
        value = value ? value : "on";
    } else if (option->kind == TC_OPTION_LATER) {
        value = "";
    } else if (option->optional && !value) {
        if (next && tc_parse_real(&number, next)) {
            value = next;
            ++*i;
        }
    } else if (!value) {
        if (!next || tc_is_option(command, next)) {
            tc_talk_error(talk, "%s needs a value: %s", option->name, option->value);
            return TC_EXIT_USAGE;
        }
        value = next;
        ++*i;
    }
    return tc_option_set(values, talk, command, option, option->name, value);
}

int tc_options_parse(void *values, const char **argument, int *n_argument, tc_talk *talk, const tc_command *command,
                     int argc, char **argv)
{
    tc_common common = {.quiet = talk->quiet, .verbose = talk->verbose};
    bool options = true;
    int count = 0;

    for (int i = 1; i < argc; i++) /* asked for help, a wrong line gets it too */
        if (!strcmp(argv[i], "--"))
            break;
        else if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
            tc_command_help(command);
            return TC_EXIT_DONE;
        }
    for (int i = 1; i < argc; i++) {
        if (options && !strcmp(argv[i], "--")) {
            options = false;
        } else if (options && argv[i][0] == '-' && argv[i][1]) {
            int code = tc_option_read(values, &common, talk, command, &i, argc, argv);
            if (code >= 0)
                return code;
        } else if (!*argv[i]) {
            tc_talk_error(talk, "%s takes %s, not an empty word", command->name,
                          command->most ? command->arguments : "no arguments");
            return TC_EXIT_USAGE;
        } else if (count == command->most) {
            tc_talk_error(talk, "%s takes %s%s, so '%s' is one too many", command->name,
                          command->most ? "only " : "no arguments", command->most ? command->arguments : "", argv[i]);
            return TC_EXIT_USAGE;
        } else {
            argument[count++] = argv[i];
        }
        if (common.version) {
            tc_version_print();
            return TC_EXIT_DONE;
        }
    }
    talk->quiet = common.quiet && !common.verbose;
    talk->verbose = common.verbose;
    if (count < command->least) {
        tc_talk_error(talk, "%s needs %s (tetcast %s --help tells more)", command->name, command->arguments,
                      command->name);
        return TC_EXIT_USAGE;
    }
    *n_argument = count;
    return -1;
}

/* ---------------------------------------------------------------------------------------------------------- help */

/* Characters on the screen, not bytes. */
static int tc_columns(const char *text)
{
    int n = 0;
    for (; *text; text++)
        n += ((unsigned char)*text & 0xC0) != 0x80;
    return n;
}

/* Prints text in words from column `from` on. */
static void tc_help_wrap(const char *text, int from)
{
    int column = from;
    while (*text) {
        char word[128];
        size_t length = strcspn(text, " ");
        snprintf(word, sizeof word, "%.*s", (int)length, text);
        int width = tc_columns(word);
        if (column > from && column + 1 + width > TC_HELP_WIDTH) {
            printf("\n%*s", from, "");
            column = from;
        }
        column += printf("%s%s", column > from ? " " : "", word) - (int)strlen(word) + width;
        text += length + (text[length] == ' ');
    }
    putchar('\n');
}

static void tc_help_option(const tc_option *option)
{
    char left[160];
    if (option->kind == TC_OPTION_LATER || option->kind == TC_OPTION_ALSO)
        return;
    if (option->kind == TC_OPTION_HEADING) {
        printf("\n%s:\n", option->help);
        return;
    }
    if (option->letter)
        snprintf(left, sizeof left, "  -%c, %s%s%s", option->letter, option->name, option->value ? " " : "",
                 option->value ? option->value : "");
    else
        snprintf(left, sizeof left, "  %s%s%s", option->name, option->value ? " " : "",
                 option->value ? option->value : "");
    int width = tc_columns(left);
    if (width + 2 > TC_HELP_COLUMN)
        printf("%s\n%*s", left, TC_HELP_COLUMN, "");
    else
        printf("%s%*s", left, TC_HELP_COLUMN - width, "");
    tc_help_wrap(option->help, TC_HELP_COLUMN);
}

void tc_command_help(const tc_command *command)
{
    printf("Usage: tetcast %s%s%s [options]\n\n", command->name, *command->arguments ? " " : "", command->arguments);
    tc_help_wrap(command->what, 0);
    if (command->about) {
        putchar('\n');
        tc_help_wrap(command->about, 0);
    }
    for (size_t i = 0; i < command->n_own; i++)
        tc_help_option(&command->own[i]);
    for (size_t i = 0; i < command->n_option; i++) {
        tc_help_option(&command->option[i]);
        for (size_t k = 0; k < command->n_also && command->option[i].kind == TC_OPTION_ALSO; k++)
            tc_help_option(&command->also[k]);
    }
    for (size_t i = 0; i < TC_N_COMMON; i++)
        tc_help_option(&tc_common_option[i]);
}

void tc_version_print(void)
{
    printf("tetcast %s\n", tc_version());
}
