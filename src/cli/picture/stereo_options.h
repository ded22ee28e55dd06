/* stereo_options.h: pictures for two eyes: what is asked for, what it cannot go with, and names. */
#ifndef TC_CLI_STEREO_OPTIONS_H
#define TC_CLI_STEREO_OPTIONS_H

#include "cli/picture/render_options.h"

/* In the order of tc_stereo_choice. */
typedef enum tc_stereo {
    TC_STEREO_NONE = 0,
    TC_STEREO_PAIR = 1,         /* two pictures */
    TC_STEREO_SIDE_BY_SIDE = 2, /* one of twice the width, the left eye's at the left */
    TC_STEREO_TOP_BOTTOM = 3,   /* one of twice the height, the left eye's on top */
    TC_STEREO_ANAGLYPH = 4      /* one: red is the left eye's, green and blue the right one's */
} tc_stereo;

/* -1, or the exit code of an error that was printed. */
int tc_stereo_check(const tc_render_command *options, tc_talk *talk);
/* The name of an eye's picture (0 left, 1 right): {eye} in the pattern becomes left or right, else _left or _right
 * stands before the extension. False: it has no room in out [capacity]. */
bool tc_stereo_name(char *out, size_t capacity, const char *pattern, int eye);
/* tc_output_check of options->output, or of the two names that it stands for. */
int tc_stereo_output_check(const tc_render_command *options, tc_talk *talk);

#endif
