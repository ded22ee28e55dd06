/* corrupt_files.h: the real files to damage, and a folder with one of them damaged. */
#ifndef TC_TESTS_CORRUPT_FILES_H
#define TC_TESTS_CORRUPT_FILES_H

#include "corrupt_kinds.h"

#include <stdbool.h>

enum { TC_PATH = 1024 };

/* What is given to the program at once: a file, or several that belong together. */
typedef struct tc_dataset {
    char folder[TC_PATH]; /* that holds all of it, without a slash at its end */
    char input[TC_PATH];  /* what the program is given, below folder; "": the file that is damaged */
    char **file;          /* [n_file] below folder: what may be damaged, sorted; owned */
    size_t n_file;
    bool map; /* a colour map: goes to render --color-map */
} tc_dataset;

typedef struct tc_datasets {
    tc_dataset *set; /* [n] owned */
    size_t n;
} tc_datasets;

/* All below a folder of data with vol/, surf/ and tf/; README and MANIFEST are left out. False: there are none. */
bool tc_datasets_find(tc_datasets *out, const char *data);
/* Are the real files still as they were at that time (seconds since 1970)? Prints those that are not. */
bool tc_datasets_untouched(const tc_datasets *sets, int64_t since_s);
void tc_datasets_finish(tc_datasets *sets);

/* Makes folder `to` hold the data set with file `f` damaged; the other files are copies.
 * input gets the path to give to the program, damaged that of the damaged file. False and a message on trouble. */
bool tc_damage_make(char input[TC_PATH], char damaged[TC_PATH], const char *to, const tc_dataset *set, size_t f,
                    const tc_damage *damage, uint64_t seed, const char *other);

/* Removes a folder and all in it. */
void tc_folder_remove(const char *path);

#endif
