/* categories.h: --categories: a colour for each value, as of material numbers. */
#ifndef TC_CLI_CATEGORIES_H
#define TC_CLI_CATEGORIES_H

#include "cli/talk.h"

/* The values, ascending, with their names; tc_category_list_finish ends it. */
typedef struct tc_category_list {
    size_t n;
    double *value;     /* [n] */
    const char **name; /* [n], owned; NULL: has none */
} tc_category_list;
void tc_category_list_finish(tc_category_list *list);

/* The function that has each value's colour and attenuation up to half-way to the next one, and what its values are
 * called. text   "V:R,G,B[,A][:NAME];…" with colours from 0 to 1 and attenuation per unit distance (1), or a file: such
 * lines, # begins a comment; or a ParaView preset, the first with IndexedColors, whose Annotations give the values and
 * names, else they are whole numbers from the first of range on range  [2] of the field -1, or the exit code of an
 * error that was printed. */
int tc_categories_make(tc_transfer **out, tc_category_list *list, const char *text, const double range[2],
                       tc_talk *talk);

#endif
