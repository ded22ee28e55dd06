/* gnuplot.h: drawing with gnuplot, where there is one. */
#ifndef TC_CLI_GNUPLOT_H
#define TC_CLI_GNUPLOT_H

#include "cli/talk.h"

/* Runs a script that is in folder, with folder as its working directory. False after a warning: gnuplot is not there,
 * or failed. */
bool tc_gnuplot_run(const char *folder, const char *script, tc_talk *talk);

#endif
