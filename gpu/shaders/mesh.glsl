// mesh.glsl: the packed mesh (design: "Record"; layout written by gpu/pack.c).

uniform isamplerBuffer mesh_cells;   // 5 ints a cell: XOR of the vertex ids, then the neighbours in the order of the sorted ids
uniform samplerBuffer mesh_vertices; // x, y, z, scalar
#ifdef HAS_IMAGINARY
uniform int mesh_real; // cells below are real, the others imaginary
#endif
#ifdef CELL_DATA
uniform samplerBuffer mesh_cell_scalar;
#endif

int mesh_fourth_vertex(int cell, ivec3 face)
{
    return texelFetch(mesh_cells, cell * 5).x ^ face.x ^ face.y ^ face.z;
}

// The cell behind the face opposite vertex `dropped`; `others` are the cell's three other vertices.
int mesh_neighbour(int cell, int dropped, ivec3 others)
{
    int rank = int(dropped > others.x) + int(dropped > others.y) + int(dropped > others.z);
    return texelFetch(mesh_cells, cell * 5 + 1 + rank).x;
}

bool mesh_is_real(int cell)
{
#ifdef HAS_IMAGINARY
    return cell < mesh_real;
#else
    return true;
#endif
}
