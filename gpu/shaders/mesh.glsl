// mesh.glsl: the packed mesh (design: "Record"; layout written by gpu/pack.c).

#include "fetch.glsl"

// A cell is named by where its record starts. 5 ints a record: XOR of the vertex ids, then the neighbours (their records'
// starts, -1 outside) in the order of the sorted vertex ids.
#if defined CELL_INTS && CELL_INTS == 4
FETCH_INTS(0, rgba32i) mesh_cells;
#elif defined CELL_INTS
FETCH_INTS(0, rg32i) mesh_cells;
#else
FETCH_IBUFFER(0) mesh_cells;
#endif
FETCH_BUFFER(1) mesh_vertices; // x, y, z, scalar
#ifdef HAS_IMAGINARY
uniform int mesh_real; // records below are real cells, the others imaginary ones
int mesh_real_kept = 0;
#endif
#ifdef CELL_DATA
uniform samplerBuffer mesh_cell_scalar;
#endif

const int MESH_RECORD = 5;

// Before a walk.
void mesh_begin()
{
#ifdef HAS_IMAGINARY
    mesh_real_kept = keep(mesh_real);
#endif
}

// Int i of all records. A buffer texture has so many texels: where records are more, 2 or 4 ints (CELL_INTS) share a texel.
int mesh_int(int i)
{
#ifndef CELL_INTS
    return fetch(mesh_cells, i).x;
#elif CELL_INTS == 2
    ivec2 texel = fetch(mesh_cells, i >> 1).xy;
    return (i & 1) == 0 ? texel.x : texel.y;
#else
    ivec4 texel = fetch(mesh_cells, i >> 2);
    ivec2 half_texel = (i & 2) == 0 ? texel.xy : texel.zw;
    return (i & 1) == 0 ? half_texel.x : half_texel.y;
#endif
}

int mesh_fourth_vertex(int cell, ivec3 face)
{
    return mesh_int(cell) ^ face.x ^ face.y ^ face.z;
}

// The cell behind the face opposite vertex `dropped`; `face` are the cell's three other vertices.
int mesh_neighbour(int cell, int dropped, ivec3 face)
{
    int rank = int(dropped > face.x) + int(dropped > face.y) + int(dropped > face.z);
    return mesh_int(cell + 1 + rank);
}

bool mesh_is_real(int cell)
{
#ifdef HAS_IMAGINARY
    return cell < mesh_real_kept;
#else
    return true;
#endif
}

#ifdef CELL_DATA
// Scalar of a real cell.
float mesh_cell_value(int cell)
{
    return texelFetch(mesh_cell_scalar, cell / MESH_RECORD).x;
}
#endif
