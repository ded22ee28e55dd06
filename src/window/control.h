/* control.h: how an option is shown and set in the window: by which kind of control, over which values, and what it
 * needs. Made from the option's row in the tables of `render`. No GTK here. */
#ifndef TC_WINDOW_CONTROL_H
#define TC_WINDOW_CONTROL_H

#include "cli/picture/render_options.h"

typedef enum tc_control_kind {
    TC_CONTROL_NONE = 0, /* not in the panel: the document has it, or it is no option */
    TC_CONTROL_CHOICE,   /* one of option->choice, the first of which is the default */
    TC_CONTROL_FLAG,
    TC_CONTROL_SLIDER,   /* a number from low to high */
    TC_CONTROL_SWITCHED, /* likewise, or off */
    TC_CONTROL_TEXT,
    TC_CONTROL_COLOR,    /* R,G,B, or not given */
    TC_CONTROL_ARRAY,    /* the name of an array, or none */
    TC_CONTROL_FILES,    /* several files */
    TC_CONTROL_SURFACES, /* isosurfaces: --iso with --iso-color and --iso-opacity */
    TC_CONTROL_BOX       /* six numbers within the bounds of the data */
} tc_control_kind;

typedef struct tc_control {
    const tc_option *option;
    tc_control_kind kind;
    double low, high, value; /* of sliders: ends, and the default */
    bool log;                /* the slider's way is logarithmic */
    char title[48];          /* "Specular power" */
} tc_control;

/* Of a row of tc_look_option or tc_render_option. */
void tc_control_make(tc_control *out, const tc_option *option);

/* Does the option act only where another one is given, of those at `need` [*n]? Static memory. */
const char *const *tc_control_needs(size_t *n, const char *option);
/* The i-th of the options that need others; NULL: behind the last. */
const char *tc_control_dependent(size_t i);

#endif
