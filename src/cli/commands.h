/* commands.h: the commands of the program, one file each. */
#ifndef TC_CLI_COMMANDS_H
#define TC_CLI_COMMANDS_H

#include "cli/options.h"

extern const tc_command tc_command_render;   /* render_options.c, cmd_render.c */
extern const tc_command tc_command_batch;    /* batch/batch_options.c, cmd_batch.c */
extern const tc_command tc_command_edit;     /* cmd_edit.c */
extern const tc_command tc_command_study;    /* cmd_study.c */
extern const tc_command tc_command_explain;  /* cmd_explain.c */
extern const tc_command tc_command_info;     /* cmd_info.c */
extern const tc_command tc_command_compare;  /* cmd_compare.c */
extern const tc_command tc_command_synth;    /* cmd_synth.c */
extern const tc_command tc_command_backends; /* cmd_backends.c */

#endif
