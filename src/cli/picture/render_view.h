/* render_view.h: the camera of a command line, and why a picture is empty. */
#ifndef TC_CLI_RENDER_VIEW_H
#define TC_CLI_RENDER_VIEW_H

#include "cli/picture/render_options.h"

/* ResetCamera from +z, then what the options say, then azimuth, elevation, roll and zoom.
 * -1 to go on, else the exit code (the eye on the focal point). */
int tc_render_camera(tc_camera *out, const tc_render_command *options, const double bounds[6], tc_talk *talk);

/* The greatest opacity of a pixel; 0: the picture is empty. */
float tc_image_peak(const tc_image *image);

/* Fills why with a sentence that says, as far as it can be told, why nothing is seen. nan_color [4]: of --nan-color,
 * its fourth number the attenuation; NULL: not given. */
void tc_empty_reason(char *why, size_t capacity, const tc_mesh_report *report, const char *field, const tc_transfer *tf,
                     const double *nan_color, const tc_camera *camera, const tc_size *size);

#endif
