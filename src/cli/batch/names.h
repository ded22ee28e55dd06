/* names.h: the name of a picture from a template with placeholders.
 *
 *   {time} {phi} {theta}           numbers: the step's time; degrees. As short as reads back the same; {time:.3f},
 * {time:e}, {time:.4g}; {time:06d} rounds {step} {frame}                 whole numbers: the step in the dataset, the
 * frame in the plan; {step:06d} %d %04d %.4d                   the frame's number within its series: 0, 1, 2 … over the
 * steps that were chosen, as ParaView counts {view} {tf} {field} {eye} {kind}  texts, made safe (tc_name_safe)
 *   {{ }} %%                       a brace, a per cent
 *
 * The extension is part of the template and not looked at. */
#ifndef TC_CLI_BATCH_NAMES_H
#define TC_CLI_BATCH_NAMES_H

#include <stdbool.h>
#include <stddef.h>

/* What stands in a name. Texts are borrowed; a number that is not finite, a text that is NULL: there is none. */
typedef struct tc_name_values {
    double time;
    int step;
    long long frame;
    long long number;
    double phi, theta;
    const char *view, *tf, *field, *eye, *kind;
} tc_name_values;

/* Which placeholders a template has. */
enum {
    TC_NAME_TIME = 1 << 0,
    TC_NAME_STEP = 1 << 1,
    TC_NAME_FRAME = 1 << 2,
    TC_NAME_NUMBER = 1 << 3, /* printf's */
    TC_NAME_PHI = 1 << 4,
    TC_NAME_THETA = 1 << 5,
    TC_NAME_VIEW = 1 << 6,
    TC_NAME_TF = 1 << 7,
    TC_NAME_FIELD = 1 << 8,
    TC_NAME_EYE = 1 << 9,
    TC_NAME_KIND = 1 << 10
};

/* Writes the name to out [capacity]. False: the template is wrong, asks for what there is none of, or the name does not
 * fit; why [capacity_why] says which. */
bool tc_name_make(char *out, size_t capacity, const char *pattern, const tc_name_values *values, char *why,
                  size_t capacity_why);

/* The template's placeholders as bits. 0 with why "": it has none; 0 with a sentence in why [capacity_why]: it is
 * wrong. */
unsigned tc_name_uses(const char *pattern, char *why, size_t capacity_why);

/* A text as part of a file's name: ASCII letters, digits, '.', '_' and '-' stay, every other character, of several
 * bytes too, becomes one '_'. "" becomes "_", "." and ".." become "_" and "__". Cut to capacity. Different texts may
 * become the same. */
void tc_name_safe(char *out, size_t capacity, const char *text);

/* The shortest decimal text that strtod reads back as value; with an exponent from 1e16 up and below 1e-4, as Python's
 * repr; no trailing ".0"; -0 is "0". out [capacity]: 32 is enough. */
void tc_name_number(char *out, size_t capacity, double value);

#endif
