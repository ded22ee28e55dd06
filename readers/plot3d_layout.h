/* plot3d_layout.h: how a PLOT3D file is laid out, found by arithmetic on its size. */
#ifndef TC_READERS_PLOT3D_LAYOUT_H
#define TC_READERS_PLOT3D_LAYOUT_H

#include "core/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum tc_plot3d_kind { TC_PLOT3D_NONE = 0, TC_PLOT3D_XYZ, TC_PLOT3D_Q } tc_plot3d_kind;

typedef struct tc_plot3d_layout {
    tc_plot3d_kind kind;
    bool big_endian, byte_counts, multi_grid, iblank, double_precision;
    size_t n_grid;
    int64_t n_point; /* over all grids */
} tc_plot3d_layout;

/* Tries every binary 3-D layout; kind is NONE when the file's size fits none. Fails only when it cannot be opened. */
tc_status tc_plot3d_layout_of(tc_plot3d_layout *out, const char *path, tc_error *err);

/* The other file of a pair: of "…xyz.bin" "…q.bin", of "a.xyz", "a.x", "a.g" "a.q", and back. out [capacity].
 * Gives false when there is none (or it is no PLOT3D file of the same grid). */
bool tc_plot3d_partner(char *out, size_t capacity, const char *path, const tc_plot3d_layout *layout);

#ifdef __cplusplus
}
#endif
#endif
