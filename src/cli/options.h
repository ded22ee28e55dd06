/* options.h: a command and its options as a constant table; parsing and --help are made from it.
 *
 * Every command also knows --quiet, --verbose, --help and --version. `--name VALUE`, `--name=VALUE`, `-o VALUE` and
 * `-oVALUE` are the same; `--` ends the options. The last of two equal options holds, but for those that add up. */
#ifndef TC_CLI_OPTIONS_H
#define TC_CLI_OPTIONS_H

#include "cli/talk.h"

/* What an option's value becomes, and the type it is written to. */
typedef enum tc_option_kind {
    TC_OPTION_HEADING = 0, /* no option: a title in --help; its text is help */
    TC_OPTION_FLAG,        /* bool, no value */
    TC_OPTION_TEXT,        /* const char *, pointing into argv */
    TC_OPTION_INT,         /* int, low..high; or one of choice's words */
    TC_OPTION_U64,         /* uint64_t, low..high */
    TC_OPTION_REAL,        /* double, low..high (exclusive where open is set) */
    TC_OPTION_REALS,       /* double[n], comma separated, low..high */
    TC_OPTION_CHOICE,      /* int: the value of one of choice */
    TC_OPTION_CUSTOM,      /* parse() writes it */
    TC_OPTION_ALSO,        /* no option: --help prints the command's other table here */
    TC_OPTION_LATER        /* known, but not in this version: refused with a sentence; not in --help */
} tc_option_kind;

typedef struct tc_choice {
    const char *name; /* NULL ends the list */
    int value;
    bool later; /* known, but not in this version */
} tc_choice;

typedef struct tc_option {
    const char *name;  /* "--field" */
    char letter;       /* 'o' for -o; 0: none */
    const char *value; /* how --help names the value; NULL for flags */
    const char *help;
    tc_option_kind kind;
    size_t at;        /* offset in the command's struct */
    size_t has;       /* offset of a bool there, plus 1, that is set; 0: none */
    double low, high; /* bounds; low == high: none */
    bool open;        /* low itself is not allowed */
    bool optional;    /* of TC_OPTION_REAL: the value may be left out, and is `high` then */
    bool repeat;      /* of TC_OPTION_CUSTOM: may be given again, and adds up */
    int n;            /* of TC_OPTION_REALS */
    const tc_choice *choice;
    /* Writes to field; false when text is wrong, and *why (64 bytes) may say more. */
    bool (*parse)(void *field, const char *text, char *why);
} tc_option;

/* An option as it was given. */
typedef struct tc_given {
    const tc_option *option;
    const char *text; /* borrowed; "on" or "off" of a flag; NULL: an optional value was left out */
    const char *called; /* borrowed; where: the option's name, or the place in a scene */
} tc_given;

/* What was given, in order; of an option that does not repeat the last. tc_given_finish ends it. */
typedef struct tc_given_list {
    size_t n;
    tc_given *item;
} tc_given_list;

struct tc_command;
typedef int tc_command_run(tc_talk *talk, const struct tc_command *command, int argc, char **argv);

typedef struct tc_command {
    const char *name, *arguments, *what; /* "render", "INPUT", one line */
    const char *about;                   /* more, before the options; may be NULL */
    const tc_option *option;
    size_t n_option;
    const tc_option *own; /* a table before option, of the same struct: what this command has beside another one's options */
    size_t n_own;
    const tc_option *also; /* a further table, of the struct that lies at also_at in the command's; NULL: none */
    size_t n_also, also_at;
    size_t given;        /* offset of a tc_given_list in the command's struct, plus 1, that is filled; 0: none */
    int least, most;     /* number of arguments that are no options */
    tc_command_run *run; /* argv[0] is the command's name; gives the exit code */
} tc_command;

/* Parses argv[1..argc) into values, over what is in it. A flag may be written --flag=off. argument [command->most] gets
 * the others, *n_argument their count. Gives -1 to go on, else the exit code to end with (--help, --version, or an
 * error that was printed). */
int tc_options_parse(void *values, const char **argument, int *n_argument, tc_talk *talk, const tc_command *command,
                     int argc, char **argv);

/* One option by its whole name, of the command's own tables; NULL: there is none. */
const tc_option *tc_command_option(const tc_command *command, const char *name);
/* Sets an option of the command's own tables as if it had been given with that text; called says how errors name it.
 * text NULL: an optional value is left out; "on" and "off" set a flag, "off" takes an optional value away. The same
 * codes. */
int tc_option_set(void *values, tc_talk *talk, const tc_command *command, const tc_option *option, const char *called,
                  const char *text);
/* Was it given, and not off? */
bool tc_is_given(const tc_given_list *list, const char *name);
/* Was it put off: a flag, a choice or an optional value? */
bool tc_is_put_off(const tc_given_list *list, const char *name);
/* Was it given on the command line, whatever its value? */
bool tc_is_of_line(const tc_given_list *list, const char *name);
/* Its place in a scene; NULL: it is not from there. */
const char *tc_scene_place(const tc_given_list *list, const char *name);
/* Prints why an option cannot be, behind its place where a scene has it. `with`: another that it does not go with, or
 * NULL. The exit code: a wrong command line, unless the scene alone is at fault. */
int tc_given_refuse(const tc_given_list *list, tc_talk *talk, const char *option, const char *with, const char *format,
                    ...) TC_CLI_PRINTF(5, 6);
void tc_given_finish(tc_given_list *list);

void tc_command_help(const tc_command *command);
void tc_version_print(void);

/* Whole text as a finite number or list of numbers between low and high (low == high: any). */
bool tc_parse_real(double *out, const char *text);
bool tc_parse_reals(double *out, int *count, int capacity, const char *text);
bool tc_parse_int(int *out, const char *text);

#endif
