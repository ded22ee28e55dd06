/* series.h: a scene's "data" as files over time.
 *
 *   "run.e"                 one file, whose steps are its own; also synth:NAME
 *   "run_%04d.vtu"          a file a step, by their numbers; %d, %04d, %.4d, once, in folders' names, too; %% is a per
 * cent "run_*.vtu"             a file a step; * ? [a-z] as in a shell, in natural order: run_2 before run_10
 *   ["a.vtu", "b_*.vtu"]    a file a step, in the list's order; elements may be patterns. A plain name need not be
 * there: its step is for the reader to refuse. One of them must be.
 *
 * A name that is that of a file means this file, whatever is in it. Names that are not absolute lead from the folder.
 * The times of a file series are what is given, else 0, 1, 2 …: the place in the series, not the number in the name. */
#ifndef TC_CLI_BATCH_SERIES_H
#define TC_CLI_BATCH_SERIES_H

#include "cli/talk.h"

#include <jansson.h>

typedef struct tc_series {
    size_t n;      /* files, at least 1 */
    char **path;   /* [n], from the folder */
    double *time;  /* [n] ascending; NULL where of_files is false */
    bool of_files; /* false: path[0] is the one file, its steps are its own */
} tc_series;

/* The files of data, a text or a list of texts. times: a list of as many ascending numbers, or NULL. folder: NULL or
 * "": the current one. A gap in the numbers of a %d pattern is a warning. -1, or the exit code of an error that was
 * printed: nothing matches (with the folder and its nearest file), a pattern is wrong, times do not fit. Whatever it
 * is, tc_series_finish frees what is in *out. Cost: reads the folders of patterns, O(n log n). */
int tc_series_make(tc_series *out, const json_t *data, const json_t *times, const char *folder, tc_talk *talk);
void tc_series_finish(tc_series *series);

/* <0, 0, >0: a before, like, after b in natural order: runs of digits by their value, else by bytes. */
int tc_natural_compare(const char *a, const char *b);

#endif
