/* geometry.h: the triangles and lines of a look as buffers for the GPU. */
#ifndef TC_GPU_GEOMETRY_H
#define TC_GPU_GEOMETRY_H

#include "core/hash.h"
#include "gpu/upload.h"

/* One geometry's part of the buffers. */
typedef struct tc_gpu_geometry_part {
    GLint first_triangle, n_triangle, first_line, n_line;
} tc_gpu_geometry_part;

/* All geometries of a look, one behind another. Positions as in pack.h: recentred and scaled in double, then rounded to
 * float. vertices  RGBA32F  x, y, z, 0 triangles RGBA32I  three vertices, 0 planes    RGBA32F  of each triangle: unit
 * normal n (0: none), and n . x of its points, both from doubles lines     RGBA32I  two vertices, 0, 0 */
typedef struct tc_gpu_geometry {
    tc_texture_buffer vertices, triangles, planes, lines;
    tc_gpu_geometry_part *part; /* [n_part] */
    int n_part;
    tc_hash hash; /* of the arrays that were uploaded, */
    bool there;   /* … if any were */
} tc_gpu_geometry;

/* Uploads what is not there yet: arrays are told apart by a hash. Colours, opacities and widths are no part of it.
 * Errors: TC_E_MEMORY, TC_E_GL. Cost: reads the arrays once for the hash; O(vertices + triangles + lines) if they
 * changed. */
tc_status tc_gpu_geometry_update(tc_gpu_geometry *g, const tc_gl *gl, const tc_geometry *geometry, int n,
                                 const double center[3], double scale, tc_error *err);
size_t tc_gpu_geometry_bytes(const tc_gpu_geometry *g);
void tc_gpu_geometry_finish(tc_gpu_geometry *g, const tc_gl *gl);

#endif
