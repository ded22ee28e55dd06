/* bands_size.h: which pictures are made at once, and which in bands. */
#ifndef TC_CLI_BANDS_SIZE_H
#define TC_CLI_BANDS_SIZE_H

#include "cli/picture/render_options.h"

enum {
    TC_ONCE_PIXELS = 1 << 21,  /* made at once: 32 MiB as floats, some 290 MiB with the rays' state */
    TC_WHOLE_PIXELS = 1 << 26, /* made at once where something needs the picture whole */
    TC_ONCE_SIDE = 16384       /* of a texture: what OpenGL 4.3 promises */
};

/* Is the picture made in bands: is it larger than what is made at once, and nothing is asked for that needs it whole, or
 * can it not be made at once at all? */
bool tc_bands_asked(const tc_render_command *options);
/* Refuses what a picture that can only be made in bands cannot have. -1, or the exit code of an error that was printed. */
int tc_bands_check(const tc_render_command *options, tc_talk *talk);

#endif
