/* builtin.h: the built-in colour maps. */
#ifndef TC_TRANSFER_FUNCTIONS_BUILTIN_H
#define TC_TRANSFER_FUNCTIONS_BUILTIN_H

#include "transfer_functions/preset.h"

/* A new preset (tc_preset_destroy) of the map that tc_transfer_builtin lists at `index`; NULL: no such one, or no
 * memory. */
tc_preset *tc_builtin_preset(size_t index);

#endif
