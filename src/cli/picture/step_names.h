/* step_names.h: --step FROM:TO[:STRIDE], and the name of each step's picture. */
#ifndef TC_CLI_STEP_NAMES_H
#define TC_CLI_STEP_NAMES_H

#include <stdbool.h>
#include <stddef.h>

/* Several steps, as --step gives them: both ends are rendered. */
typedef struct tc_step_range {
    bool there; /* false: one step, or none was asked for */
    bool has_from, has_to;
    int from, to; /* negative: from the end */
    int stride;   /* 1 and more */
} tc_step_range;

/* "FROM:TO", "FROM:", ":TO", ":" with ":STRIDE" behind. False when text is none of them; why [64] may say more. */
bool tc_step_range_parse(tc_step_range *out, const char *text, char *why);

/* The steps of a file with n_time of them (0: one, number 0), ascending. step [capacity] gets as many as fit; the count
 * is given back, 0 when there is none; why [capacity_why] says so then. */
size_t tc_step_range_list(int *step, size_t capacity, const tc_step_range *range, size_t n_time, char *why,
                          size_t capacity_why);

/* Writes the name of a step's file, from a pattern with {step}, {step:04d}, {time}, {time:06d}, {time:.3f} (d rounds;
 * also e, g, width, 0) and {{, }} for braces; a pattern without step and time gets _0012 before its extension.
 *   why [capacity_why]  what is wrong with the pattern, when false is given: also when the name does not fit */
bool tc_step_name(char *out, size_t capacity, const char *pattern, int step, double time, char *why,
                  size_t capacity_why);

/* How a number stands in a name. */
typedef struct tc_number_format {
    bool zero; /* pad with zeros */
    int width, precision;
    char kind; /* d (rounds), e, f or g */
} tc_number_format;

/* ":04d}" or "}" behind a placeholder's name; whole: for a whole number, which d alone writes. *end comes behind the
 * brace. False where it is neither. */
bool tc_number_format_parse(tc_number_format *out, const char **end, const char *text, bool whole);
/* As snprintf: the characters that it takes. */
int tc_number_format_write(char *out, size_t capacity, const tc_number_format *format, double value);

/* Has the pattern a {step} or a {time}? Braces in pairs are none. */
bool tc_step_is_in_name(const char *pattern);

#endif
