/* upload.h: packed arrays and transfer functions → textures. */
#ifndef TC_GPU_UPLOAD_H
#define TC_GPU_UPLOAD_H

#include "gpu/gl.h"
#include "gpu/pack_planes.h"
#include "transfer_functions/means.h"
#include "transfer_functions/pieces.h"
#include "transfer_functions/running.h"
#include "transfer_functions/table.h"

/* One array in a texture buffer. */
typedef struct tc_texture_buffer {
    GLuint buffer, texture;
    size_t bytes;
} tc_texture_buffer;

/* data: n_texel texels of texel_bytes, borrowed, or NULL: room alone; what: "uploading the gradients", for errors.
 * Errors: TC_E_MEMORY (with the figure needed), TC_E_GL. */
tc_status tc_texture_buffer_upload(tc_texture_buffer *out, const tc_gl *gl, const void *data, size_t n_texel,
                                   size_t texel_bytes, GLenum format, const char *what, tc_error *err);
void tc_texture_buffer_finish(tc_texture_buffer *buffer, const tc_gl *gl);

typedef struct tc_gpu_mesh {
    tc_texture_buffer cells, vertices, faces, cell_scalar;
    tc_texture_buffer planes_vertices, planes_normals, planes_neighbours, planes_scalars; /* tc_pack_planes */
    size_t n_cell, n_real, n_vertex, n_face;
    double ms;
} tc_gpu_mesh;

/* planes: NULL, or what the stepper of the paper's arithmetic reads; it stands in for the cells' records, which stay
 * away then. Errors: TC_E_MEMORY (with the figure needed), TC_E_GL. */
tc_status tc_gpu_mesh_upload(tc_gpu_mesh *out, const tc_gl *gl, const tc_pack *pack, const tc_pack_planes *planes,
                             tc_error *err);
/* Other values onto a mesh that was uploaded without planes: pack is tc_pack_scalars', of the same mesh. Sent are the values
 * alone: of points with the vertices that hold them, of cells in an array of their own, which comes and goes with them; the
 * vertices then only when it comes. *bytes gets how many. Errors: as tc_gpu_mesh_upload; the mesh is then to be uploaded
 * anew. */
tc_status tc_gpu_mesh_values(tc_gpu_mesh *mesh, size_t *bytes, const tc_gl *gl, const tc_pack *pack, tc_error *err);
size_t tc_gpu_mesh_bytes(const tc_gpu_mesh *mesh);
void tc_gpu_mesh_finish(tc_gpu_mesh *mesh, const tc_gl *gl);

/* A transfer function's textures: `table` (3-D), `nodes` (running integrals: two texels a node, point and cumulative;
 * means: three an interval),
 * `pieces` (three texels an end, transfer_functions/pieces.h). */
typedef struct tc_gpu_transfer {
    GLuint table;
    tc_texture_buffer nodes, pieces;
    GLuint piece_floats; /* the same as pieces, a float a texel: one of them is read for less */
    size_t bytes;
} tc_gpu_transfer;

tc_status tc_gpu_table_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_table *table, tc_error *err);
/* Beside what is there. */
tc_status tc_gpu_pieces_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_pieces *pieces, tc_error *err);
/* Into `nodes`, beside what is there. */
tc_status tc_gpu_means_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_means *means, tc_error *err);
tc_status tc_gpu_running_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_running *running, tc_error *err);
void tc_gpu_transfer_finish(tc_gpu_transfer *transfer, const tc_gl *gl);

#endif
