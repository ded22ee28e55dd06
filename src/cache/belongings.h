/* belongings.h: what a dataset consists of besides the file that is named. */
#ifndef TC_CACHE_BELONGINGS_H
#define TC_CACHE_BELONGINGS_H

#include "core/hash.h"

/* Does all that path holds lie in this one file, by what its first bytes say? True of VTK's XML files without pieces
 * and of legacy VTK; false of all else, a folder too. */
bool tc_cache_alone(const char *path);

/* Does the file begin as a cache file does? */
bool tc_cache_begins(const char *path);

/* A hash of the names, sizes and times of all files in and below a folder, in any order: whatever a dataset of several
 * files holds, if it lies there. Left out are cache files, whatever their names, temporary files of this library and
 * pictures (.png, .exr, .tif, .jpg), .csv and .json, which programs that look at a dataset put beside it.
 *   main: the file that is named, NULL for none; it and all that lists files by its name (.pvd, .vtm, .pvtu, .case, …)
 *         must name files within the folder
 * Errors: TC_E_FILE: a file was changed less than 50 ms ago, so that its time does not tell the next change; a list
 * names files elsewhere; there are more than 20 000 files; a folder cannot be read. TC_E_MEMORY. Cost: for each file a
 * stat and a look at its first bytes. */
tc_status tc_cache_folder(tc_hash *out, const char *folder, const char *main, tc_error *err);

#endif
