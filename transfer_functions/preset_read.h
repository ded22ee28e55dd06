/* preset_read.h: what the readers of presets share. */
#ifndef TC_TRANSFER_FUNCTIONS_PRESET_READ_H
#define TC_TRANSFER_FUNCTIONS_PRESET_READ_H

#include "transfer_functions/preset.h"

/* Appends; takes the preset over, also on failure. Errors: TC_E_MEMORY. */
tc_status tc_preset_list_add(tc_preset_list *list, tc_preset *preset, tc_error *err);
/* Notes the first problem. */
void tc_preset_set_problem(tc_preset *preset, const char *format, ...) TC_PRINTF(2, 3);
/* Sets space (and hsv_wrap for "Wrapped"); notes a problem when the name is unknown. */
void tc_preset_set_space(tc_preset *preset, const char *space);
/* Checks and orders the points; notes problems. */
void tc_preset_complete(tc_preset *preset);

tc_status tc_preset_parse_json(tc_preset_list *out, const char *text, size_t length, const char *path, tc_error *err);
tc_status tc_preset_parse_xml(tc_preset_list *out, const char *text, size_t length, const char *path, tc_error *err);

#endif
