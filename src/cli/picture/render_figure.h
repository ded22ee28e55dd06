/* render_figure.h: what a run asks for around its picture, and the room that the picture leaves for it. */
#ifndef TC_CLI_RENDER_FIGURE_H
#define TC_CLI_RENDER_FIGURE_H

#include "cli/picture/render_report.h"

/* Title, colour bar, axes and triad, those that are asked for, for a run whose mesh, function, look and camera are there; no
 * bar where no colour of the picture is the function's.
 * out borrows from run. False: none. */
bool tc_render_figure(tc_figure *out, const tc_render_run *run);

/* Moves the camera so that title, colour bar and axes' labels stand beside the mesh, where they are asked for and no
 * option says where the eye is or how large the picture. Warns where a bar that was asked for is left out. -1 to go on, else the exit code of an error that was printed. */
int tc_render_figure_fit(tc_render_run *run, tc_talk *talk);

#endif
