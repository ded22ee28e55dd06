/* render_verify.h: --verify and --error-image: how wrong the picture is, in words and as an image. */
#ifndef TC_CLI_RENDER_VERIFY_H
#define TC_CLI_RENDER_VERIFY_H

#include "cli/picture/render_report.h"

/* Verifies run->image and says what came out; fills run->verify and, with --error-image, run->errors. -1 to go on, else
 * an exit code. */
int tc_verify_run(tc_render_run *run, tc_talk *talk);
/* Writes run->errors, which is painted where the format holds no floats. -1 to go on, else an exit code. */
int tc_error_image_write(tc_render_run *run, tc_talk *talk, int argc, char **argv);

/* "with 95 % confidence at most 0.073 % of the other pixels err by more than 5.9e-05"; both numbers are rounded up.
 * Empty when all pixels were looked at, or when they were not drawn at random. */
void tc_confidence_text(char *out, size_t capacity, const tc_verify_result *verify);
/* Up to two digits, so that a bound stays one; what is not positive and finite stays as it is. */
double tc_round_up(double value);

/* Colour of an error on the logarithmic ramp from 1e-7 to 1e-1; rgb [3]. Lighter is worse. */
void tc_error_color(float *rgb, double error);
/* An image of tc_verify_image into one to look at: the ramp, ill-posed pixels turquoise, those not looked at grey. */
void tc_error_paint(tc_image *errors);
/* Has the format of this file, or PNG for "-", no room for floats? */
bool tc_error_is_painted(const char *path);
/* What an error image shows, in one sentence. */
void tc_error_legend(char *out, size_t capacity, bool painted);

#endif
