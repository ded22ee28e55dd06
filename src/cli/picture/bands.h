/* bands.h: pictures that are too large to be made at once are rendered in bands, whose rows go to the file as they
 * come. */
#ifndef TC_CLI_BANDS_H
#define TC_CLI_BANDS_H

#include "cli/picture/render_picture.h"

/* tc_render_picture in bands. run->image stays NULL. Memory: whatever the picture's size that of one
 * of 2 million pixels made at once: some 370 MiB in software with a mesh of 195 112 cells in it (3000x2000, 16384x4096; of
 * which 300 MiB for the band), on a GPU less of the program's own. Where rays are counted (--count, --audit, --stats) some
 * 700 MiB: the state that counts is a second one. Time: that of the picture, and for each band a look at each face of the
 * boundary. On an error nothing of the file stays. */
int tc_bands_picture(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv);

#endif
