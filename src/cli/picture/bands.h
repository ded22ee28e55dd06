/* bands.h: pictures that are too large to be made at once are rendered in bands, whose rows go to the file as they
 * come. */
#ifndef TC_CLI_BANDS_H
#define TC_CLI_BANDS_H

#include "cli/picture/render_picture.h"

/* tc_render_picture in bands. run->image stays NULL. Memory: some 340 MiB beside the mesh, whatever the picture's size;
 * time: that of the picture, and for each band of some 2 million pixels a look at each face of the boundary. On an
 * error nothing of the file stays. */
int tc_bands_picture(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv);

#endif
