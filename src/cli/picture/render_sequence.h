/* render_sequence.h: `render --step FROM:TO`: one picture of each step. */
#ifndef TC_CLI_RENDER_SEQUENCE_H
#define TC_CLI_RENDER_SEQUENCE_H

#include "cli/picture/render_options.h"

/* All steps of options->steps, with one transfer function, camera and unit distance: the function over the range that the
 * scalars have in all of them (unless --range says it), which takes a first pass over the values; the others by the first
 * step. A step whose points and cells are those of the step before costs its values alone. -1, or an exit code. */
int tc_render_sequence(const tc_render_command *options, tc_talk *talk, int argc, char **argv);

#endif
