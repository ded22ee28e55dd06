# cube.sh: two hexahedra beside each other with fields of points and cells, for the tests of looks and scenes.
# cube FILE [SHIFT]: values of Temp grow by SHIFT.
cube() {
    cat >"$1" <<VTK
# vtk DataFile Version 3.0
two hexahedra
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 12 double
0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1  2 0 0  2 1 0  2 0 1  2 1 1
CELLS 2 18
8 0 1 2 3 4 5 6 7
8 1 8 9 2 5 10 11 6
CELL_TYPES 2
12
12
POINT_DATA 12
SCALARS Temp double 1
LOOKUP_TABLE default
$(for v in 0 1 1 0 0 1 1 0 2 2 2 2; do printf '%s ' "$((v + ${2:-0}))"; done)
SCALARS Pres double 1
LOOKUP_TABLE default
0 0 0 0 1 1 1 1 0 0 1 1
CELL_DATA 2
SCALARS Material int 1
LOOKUP_TABLE default
1 2
SCALARS ObjectId int 1
LOOKUP_TABLE default
10 20
VTK
}
