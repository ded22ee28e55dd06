/* stereo.h: pictures for two eyes.
 *
 * The eyes stand beside each other, left and right of the camera's position, and look in parallel; each picture's
 * window centre is moved so that what lies in the focal plane is at one place in both. With f the distance to the focal
 * point, a the eye angle, v the view angle and w = tan(v/2) aspect half the width at unit distance eyes: position -+ e
 * right, e = f tan(a/2) window centres:  +- e / (f w) = +- tan(a/2) / (tan(v/2) aspect) which is what vtkCamera does
 * with EyeAngle a (vtkPerspectiveTransform::Stereo shears by e / f about the focal plane). In parallel projection,
 * where rays have one direction, the eyes are turned by -+ a/2 about the focal point. */
#ifndef TC_CLI_STEREO_H
#define TC_CLI_STEREO_H

#include "cli/picture/render_picture.h"
#include "cli/picture/stereo_options.h"

/* The cameras of the left and the right eye. eye_angle in degrees; aspect = width / height of one eye's picture. 0; -1:
 * the camera has no direction, out is then the camera twice. */
int tc_stereo_cameras(tc_camera out[2], const tc_camera *camera, double eye_angle, double aspect);
/* One picture of two of one size, made by the call. ANAGLYPH: alpha is the larger one. Errors: TC_E_ARG (sizes differ;
 * a kind that is not one picture), TC_E_MEMORY. */
tc_status tc_stereo_combine(tc_image **out, const tc_image *left, const tc_image *right, tc_stereo kind, tc_error *err);

/* tc_render_picture with options->out.stereo. The run's statistics are those of both eyes together. */
int tc_stereo_picture(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv);

#endif
