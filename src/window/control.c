/* control.c: how an option is shown and set in the window. */
#include "window/control.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* Options that are shown otherwise than their kind says, and what sliders reach; the options' own bounds are wider. */
static const struct {
    const char *option;
    tc_control_kind kind;
    double low, high;
    bool log;
} special[] = {
    {"--iso", TC_CONTROL_SURFACES, 0, 0, false},
    {"--iso-color", TC_CONTROL_NONE, 0, 0, false}, /* by that of --iso */
    {"--iso-opacity", TC_CONTROL_NONE, 0, 0, false},
    {"--color-field", TC_CONTROL_ARRAY, 0, 0, false},
    {"--categories", TC_CONTROL_NONE, 0, 0, false}, /* stands in place of the function that is edited */
    {"--ambient", TC_CONTROL_SLIDER, 0, 1, false},
    {"--diffuse", TC_CONTROL_SLIDER, 0, 2, false},
    {"--specular", TC_CONTROL_SLIDER, 0, 2, false},
    {"--specular-power", TC_CONTROL_SLIDER, 1, 200, true},
    {"--shade-magnitude", TC_CONTROL_SLIDER, 0, 10, false},
    {"--clip-box", TC_CONTROL_BOX, 0, 0, false},
    {"--surface", TC_CONTROL_SWITCHED, 0, 1, false},
    {"--geometry", TC_CONTROL_FILES, 0, 0, false},
    {"--line-color", TC_CONTROL_COLOR, 0, 0, false},
    {"--surface-color", TC_CONTROL_COLOR, 0, 0, false},
    {"--background", TC_CONTROL_COLOR, 0, 0, false},
    {"--text-size", TC_CONTROL_SWITCHED, 6, 64, false},
    {"--opacity-stop", TC_CONTROL_SWITCHED, 0.9, 1, false},
};

/* An option that acts on what others bring. */
static const struct {
    const char *option;
    size_t n;
    const char *need[3];
} dependent[] = {
    {"--light", 3, {"--shade", "--surface", "--geometry"}},
    {"--ambient", 3, {"--shade", "--surface", "--geometry"}},
    {"--diffuse", 3, {"--shade", "--surface", "--geometry"}},
    {"--specular", 3, {"--shade", "--surface", "--geometry"}},
    {"--specular-power", 3, {"--shade", "--surface", "--geometry"}},
    {"--one-sided", 3, {"--shade", "--surface", "--geometry"}},
    {"--shade-magnitude", 3, {"--shade", "--surface", "--geometry"}},
    {"--surface-color", 1, {"--surface"}},
    {"--line-color", 2, {"--outline", "--wireframe"}},
    {"--geometry-color", 1, {"--geometry"}},
    {"--color-bar-place", 1, {"--color-bar"}},
    {"--color-bar-opacity", 1, {"--color-bar"}},
    {"--color-range", 1, {"--color-field"}},
};
enum { TC_N_SPECIAL = sizeof special / sizeof *special, TC_N_DEPENDENT = sizeof dependent / sizeof *dependent };

static tc_control_kind kind_of(const tc_option *option)
{
    switch (option->kind) {
    case TC_OPTION_CHOICE:
        return TC_CONTROL_CHOICE;
    case TC_OPTION_FLAG:
        return TC_CONTROL_FLAG;
    case TC_OPTION_TEXT:
    case TC_OPTION_INT:
    case TC_OPTION_U64:
    case TC_OPTION_REAL:
    case TC_OPTION_REALS:
    case TC_OPTION_CUSTOM:
        return TC_CONTROL_TEXT;
    case TC_OPTION_HEADING:
    case TC_OPTION_ALSO:
    case TC_OPTION_LATER:
        break;
    }
    return TC_CONTROL_NONE;
}

/* "--specular-power" as "Specular power", in the spelling of the window's other words. */
static void title_of(char *out, size_t capacity, const char *name)
{
    size_t n = 0;
    for (const char *at = name + strspn(name, "-"); *at && n + 1 < capacity; at++) {
        if (at[0] == 'r' && n > 3 && !memcmp(&out[n - 3], "olo", 3) && n + 2 < capacity)
            out[n++] = 'u';
        out[n++] = (char)(*at == '-' ? ' ' : *at);
    }
    out[n] = 0;
    *out = (char)toupper((unsigned char)*out);
}

/* The number that the option stands at when it is not given; 0 where the table of looks does not say. */
static double default_of(const tc_option *option)
{
    const bool look = option >= tc_look_option && option < tc_look_option + TC_N_LOOK_OPTION;
    tc_look_options none;
    double value;
    if (!look || option->kind != TC_OPTION_REAL || option->at + sizeof value > sizeof none)
        return 0;
    tc_look_options_defaults(&none);
    memcpy(&value, (const char *)&none + option->at, sizeof value);
    return value;
}

void tc_control_make(tc_control *out, const tc_option *option)
{
    *out = (tc_control){.option = option, .kind = kind_of(option)};
    if (!option->name)
        return;
    title_of(out->title, sizeof out->title, option->name);
    for (size_t i = 0; i < TC_N_SPECIAL; i++)
        if (!strcmp(special[i].option, option->name)) {
            out->kind = special[i].kind;
            out->low = special[i].low;
            out->high = special[i].high;
            out->log = special[i].log;
        }
    const double value = default_of(option);
    out->value = value < out->low || value > out->high ? out->high : value;
    if (out->kind == TC_CONTROL_SWITCHED) /* that is where it begins when it is switched on */
        out->value = !strcmp(option->name, "--text-size") ? 14 : out->high;
}

const char *const *tc_control_needs(size_t *n, const char *option)
{
    for (size_t i = 0; i < TC_N_DEPENDENT; i++)
        if (!strcmp(dependent[i].option, option)) {
            *n = dependent[i].n;
            return dependent[i].need;
        }
    *n = 0;
    return NULL;
}

const char *tc_control_dependent(size_t i)
{
    return i < TC_N_DEPENDENT ? dependent[i].option : NULL;
}
