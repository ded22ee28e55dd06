#!/bin/sh
# broken: what info and render say about cells that do not fit together.
. "$TC_SOURCE/tests/cli/lib.sh"

# One triangle with three cells (two of them on one side of it), a copy of a cell, and a cell that repeats a point.
cat >three.vtk <<'VTK'
# vtk DataFile Version 3.0
three cells on a face
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 double
0 0 0  1 0 0  0 1 0  0.2 0.2 -1  0.1 0.2 1  0.4 0.3 1
CELLS 5 25
4 0 1 2 3
4 0 1 2 4
4 0 1 2 5
4 2 1 0 4
4 0 1 1 2
CELL_TYPES 5
10 10 10 10 10
POINT_DATA 6
SCALARS heat double 1
LOOKUP_TABLE default
0 1 2 3 4 5
VTK
run 0 info three.vtk
prints "1 faces have three cells or more; they are treated as boundaries"
prints "1 tets are there more than once; the copies were dropped"
prints "1 cells repeat a point"
prints "rays cross gaps by peeling"
run 0 info --json three.vtk
cp out three.json
json three.json eq mesh.tets 3 eq mesh.defects.unlinked_faces 1 eq mesh.defects.faces_of_many 1 \
    eq mesh.defects.faces_one_side 0 eq mesh.defects.dropped_duplicate 1 eq mesh.defects.dropped_degenerate 1 \
    eq mesh.reentry peel
run 0 render three.vtk --size 32x32 --verify 1024 -o three.png --stats three_stats.json
there three.png
says "warning: 1 faces have three cells or more"
says "composited in the order of entry"
json three_stats.json eq march.rays_lost 0 le verify.max_abs_error 0.00196

# Two cells on one side of their common face; convexification was asked for, and cannot be.
sed -e 's/^CELLS 5 25/CELLS 2 10/' -e '/^4 0 1 2 3/d' -e '/^4 2 1 0 4/d' -e '/^4 0 1 1 2/d' \
    -e 's/^CELL_TYPES 5/CELL_TYPES 2/' -e 's/^10 10 10 10 10/10 10/' three.vtk >side.vtk
run 0 info side.vtk
prints "1 faces lie between two cells on one side, which overlap"
run 0 render side.vtk --size 32x32 --verify 1024 -o side.png --stats side_stats.json
says "warning: 1 faces lie between two cells on one side"
json side_stats.json eq march.rays_lost 0 le verify.max_abs_error 0.00196
run 1 render side.vtk --size 8x8 --reentry convexify -o no.png
says "peel"
absent no.png
run 0 render side.vtk --size 8x8 --quiet -o quiet.png
stderr_empty
finish
