/* render_setup.h: from the command line of `render` to all that a picture is made of. */
#ifndef TC_CLI_RENDER_SETUP_H
#define TC_CLI_RENDER_SETUP_H

#include "cli/picture/look_build.h"
#include "cli/picture/render_report.h"

/* Opens INPUT, says what was wrong with it, and makes the transfer function, the camera, and the options with the look,
 * into a run that is all zeros. -1, or the exit code of an error that was printed; tc_render_close frees what is there
 * of it. */
int tc_render_open(tc_render_run *run, const tc_render_command *options, tc_talk *talk);
/* The same of a mesh that is there, prepared, with its report. range: the scalars of the data that the function is laid
 * over. A function and a camera that the run has already stay; the look is made anew. The same codes. */
int tc_render_setup(tc_render_run *run, const double range[2], tc_talk *talk);
void tc_render_close(tc_render_run *run);
/* Can the options' transfer function be made of any data: are map and opacity known, and their files right? The same codes. */
int tc_render_function_check(const tc_render_command *options, tc_talk *talk);

/* Says what the reader noted. */
void tc_source_notes_say(const tc_mesh *mesh, const char *input, tc_talk *talk);
/* Says how many values and points are not finite. */
void tc_nonfinite_say(const tc_render_run *run, tc_talk *talk);

#endif
