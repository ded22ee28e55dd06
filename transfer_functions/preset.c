/* preset.c: the life of a preset. */
#include "transfer_functions/preset.h"

#include <stdlib.h>

void tc_preset_destroy(tc_preset **preset)
{
    if (!preset || !*preset)
        return;
    free((*preset)->name);
    free((*preset)->color);
    free((*preset)->opacity);
    free(*preset);
    *preset = NULL;
}
