/* info_text.h: what `info` found out, in words and as JSON. */
#ifndef TC_CLI_INFO_TEXT_H
#define TC_CLI_INFO_TEXT_H

#include "cli/input_cache.h"

typedef struct tc_info {
    const char *input;
    const tc_source *source; /* NULL for a synthetic dataset */
    tc_mesh_report report;
    bool prepared;  /* tc_mesh_prepare went well: the report is whole */
    tc_input_seen seen;
    double unit_distance;
} tc_info;

/* Bytes of cells and vertices on the GPU: 16 a tet, imaginary ones too, 16 a vertex. */
double tc_info_gpu_bytes(const tc_mesh_report *report);

void tc_info_print(const tc_info *info); /* to stdout */
json_t *tc_info_json(const tc_info *info);

#endif
