// mesh.glsl: the packed mesh (design: "Record"; layout written by gpu/pack.c).

#include "fetch.glsl"

// A cell is named by where its record starts. 5 ints a record: XOR of the vertex ids, then the neighbours (their records'
// starts, -1 outside) in the order of the sorted vertex ids.
FETCH_IBUFFER(0) mesh_cells;
FETCH_BUFFER(1) mesh_vertices; // x, y, z, scalar
#ifdef HAS_IMAGINARY
uniform int mesh_real; // records below are real cells, the others imaginary ones
#endif
#ifdef CELL_DATA
uniform samplerBuffer mesh_cell_scalar;
#endif

const int MESH_RECORD = 5;

int mesh_fourth_vertex(int cell, ivec3 face)
{
    return fetch(mesh_cells, cell).x ^ face.x ^ face.y ^ face.z;
}

// The cell behind the face opposite vertex `dropped`; `face` are the cell's three other vertices.
int mesh_neighbour(int cell, int dropped, ivec3 face)
{
    int rank = int(dropped > face.x) + int(dropped > face.y) + int(dropped > face.z);
    return fetch(mesh_cells, cell + 1 + rank).x;
}

bool mesh_is_real(int cell)
{
#ifdef HAS_IMAGINARY
    return cell < mesh_real;
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
