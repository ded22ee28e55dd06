#!/bin/sh
# info: as a table and as JSON, with the defects in words.
. "$TC_SOURCE/tests/cli/lib.sh"
data=$TC_SOURCE/../shared/data

run 0 synth heatsink --cells 4000 -o sink.vtu --quiet
run 0 info sink.vtu
stderr_empty
for word in format tetra arrays bounds convex GPU defects; do
    prints "$word"
done
prints "none found"
run 0 info --json sink.vtu
cp out sink.json
json sink.json has tetcast eq source.cell_types.0.dimension 3 ge source.cell_types.0.count 1000 has source.arrays.0.name \
    size source.arrays.0.range 2 size mesh.bounds 6 eq mesh.convex false ge mesh.imaginary_tets 1 ge mesh.gpu_bytes 1 \
    ge mesh.boundary_faces 100 eq mesh.parts 1 ge mesh.unit_distance 0.01 has time_ms.read
tets=$(sed -n 's/.*"tets": \([0-9]*\).*/\1/p' sink.json | head -1)
json sink.json ge mesh.gpu_bytes $((16 * tets))
run 0 info --json sink.vtu --reentry peel
cp out peel.json
json peel.json eq mesh.reentry peel eq mesh.imaginary_tets 0
run 1 info missing.vtu
stdout_empty
says "missing.vtu"
echo "no mesh" >text.vtk
run 1 info text.vtk
stdout_empty
says "text.vtk"

# Two tets of the cell sizes 3, 4 and 12: the diagonal is 13, the unit distance 13 / cbrt(2).
cat >two.vtk <<'VTK'
# vtk DataFile Version 3.0
two tets
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
0 0 0  3 0 0  0 4 0  0 0 12  3 4 12
CELLS 2 10
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 2
10 10
VTK
run 0 info --json two.vtk
cp out two.json
json two.json ge mesh.unit_distance 10.31810 le mesh.unit_distance 10.31811

# A file with oddities: a triangle, an inverted tet, a point of no cell.
cat >odd.vtk <<'VTK'
# vtk DataFile Version 3.0
oddities
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 double
0 0 0  1 0 0  0 1 0  0 0 1  1 1 1  9 9 9
CELLS 3 14
4 0 1 2 3
4 1 3 2 4
3 0 1 2
CELL_TYPES 3
10 10 5
POINT_DATA 6
SCALARS heat double 1
LOOKUP_TABLE default
0 1 2 3 4 5
VTK
run 0 info odd.vtk
prints "triangle (left out"
prints "1 cells were inverted"
prints "1 points belong to no cell"
run 0 render odd.vtk --size 8x8 -o odd.png --stats odd_stats.json
json odd_stats.json eq mesh.dropped_cells 1
run 0 info --json odd.vtk
cp out odd.json
json odd.json eq mesh.tets 2 eq source.dropped_cells 1 eq mesh.points 5 eq mesh.range.0 0 eq mesh.range.1 4 \
    eq mesh.defects.reoriented 1 eq mesh.defects.unused_vertices 1 eq mesh.defects.dropped_degenerate 0 \
    eq source.field heat ge mesh.volume 0.49 le mesh.volume 0.51

if [ -d "$data" ]; then
    run 0 info --json "$data/vol/QuadraticTetra.vtu"
    cp out quadratic.json
    json quadratic.json eq source.linearised true
    run 0 info "$data/vol/QuadraticTetra.vtu"
    prints "quadratic cells became linear"
fi
finish
