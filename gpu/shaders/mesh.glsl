// mesh.glsl: the packed mesh (design: "Record"; layout written by gpu/pack.c).

#include "fetch.glsl"

// A cell's record: the XOR of its four vertex ids; and of its neighbours n0 ... n3 (-1 outside) in the order of the sorted
// ids of the vertices opposite them, n0 ^ n3, n1 ^ n3, n2 ^ n3. A ray comes from one of them, and so knows them all.
FETCH_INTS(0, rgba32i) mesh_cells;
FETCH_BUFFER(1) mesh_vertices; // x, y, z, scalar
#ifdef HAS_IMAGINARY
uniform int mesh_real; // cells below are real, the others imaginary
int mesh_real_kept = 0;
#endif
#ifdef CELL_DATA
uniform samplerBuffer mesh_cell_scalar;
#endif

// Before a walk.
void mesh_begin()
{
#ifdef HAS_IMAGINARY
    mesh_real_kept = keep(mesh_real);
#endif
}

ivec4 mesh_record(int cell)
{
    return fetch(mesh_cells, cell);
}

// A cell's neighbour opposite vertex v, XOR its n3; `face` are its three other vertices, `record` is its record.
int mesh_other(ivec4 record, int v, ivec3 face)
{
    bool x = v > face.x, y = v > face.y, z = v > face.z; // how many of them hold says its place in the order
    bool one = x || y || z, two = x && y || z && (x || y), all = x && y && z;
    return all ? 0 : two ? record.w : one ? record.z : record.y;
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
    return texelFetch(mesh_cell_scalar, cell).x;
}
#endif
