/* edit_command.h: the command line of `edit`, which `tetcast` reads to hand it on and the window reads to do it. */
#ifndef TC_CLI_EDIT_COMMAND_H
#define TC_CLI_EDIT_COMMAND_H

#include "cli/commands.h"
#include "cli/picture/render_options.h"

typedef struct tc_edit_command {
    tc_render_command render; /* first: the options of render are at their places in it */
    const char *trace;        /* file to write what happened when; NULL: none */
} tc_edit_command;

#endif
