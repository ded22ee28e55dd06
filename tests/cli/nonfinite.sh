#!/bin/sh
# Values and coordinates that are not finite: counted, said, shown when asked for.
. "$TC_SOURCE/tests/cli/lib.sh"

one='\077\200\000\000' zero='\000\000\000\000' nan='\177\300\000\000' inf='\177\200\000\000' two='\100\000\000\000'
# Two voxels, 3 x 2 x 2 points; one value is NaN, one infinite, both in the second voxel alone.
{
    printf '# vtk DataFile Version 3.0\nvalues\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nORIGIN 0 0 0\n'
    printf 'SPACING 1 1 1\nPOINT_DATA 12\nSCALARS v float 1\nLOOKUP_TABLE default\n'
    printf "$one$two$nan$zero$two$two$one$zero$one$two$one$inf\n"
} >values.vtk
# Three tets in a fan about an edge; the last point is nowhere, and takes the two tets around it along.
{
    printf '# vtk DataFile Version 3.0\npoints\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n'
    printf "$zero$zero$zero$one$zero$zero$zero$one$zero$zero$zero$one$one$one$one$nan$one$zero\n"
    printf 'CELLS 3 15\n'
    printf '\0\0\0\004\0\0\0\0\0\0\0\001\0\0\0\002\0\0\0\003'
    printf '\0\0\0\004\0\0\0\001\0\0\0\002\0\0\0\003\0\0\0\005'
    printf '\0\0\0\004\0\0\0\002\0\0\0\003\0\0\0\004\0\0\0\005'
    printf '\nCELL_TYPES 3\n\0\0\0\012\0\0\0\012\0\0\0\012\n'
    printf "POINT_DATA 6\nSCALARS v float 1\nLOOKUP_TABLE default\n$one$two$one$one$two$one\n"
} >points.vtk

# info counts both.
run 0 info values.vtk
prints "2 values of the field are NaN or infinite"
prints "tets have such a value and are transparent; render --nan-color shows them"
run 0 info values.vtk --json
cp out values.json
json values.json eq mesh.defects.nonfinite_scalars 2 ge mesh.defects.nonfinite_cells 2 le mesh.defects.nonfinite_cells 6 \
    eq mesh.defects.dropped_nonfinite 0
run 0 info points.vtk --json
cp out points.json
json points.json eq mesh.defects.nonfinite_cells 0 eq mesh.defects.dropped_nonfinite 2 eq mesh.tets 1

# render says it, and the statistics hold it.
look="--size 32x32 --azimuth 20 --elevation 30 --unit-distance 0.3"
run 0 render values.vtk $look -o clear.exr --stats s.json --verify 2000
says "cells have a value that is not finite and are transparent; --nan-color shows them"
json s.json ge mesh.nonfinite_cells 2 eq mesh.dropped_nonfinite 0 le verify.max_abs_error 0.00196
run 0 render points.vtk $look -o left.exr --stats s.json --verify 2000
says "2 cells have a point that is not finite and were dropped"
json s.json eq mesh.nonfinite_cells 0 eq mesh.dropped_nonfinite 2 eq mesh.dropped_cells 2 le verify.max_abs_error 0.00196

# With a colour they are there, on either driver; without attenuation they are not.
run 0 render values.vtk $look -o violet.exr --nan-color 0.6,0,1,2 --verify 2000 --stats s.json
says "shown with --nan-color"
json s.json le verify.max_abs_error 0.00196
run 2 compare clear.exr violet.exr
run 0 render values.vtk $look -o reference.exr --nan-color 0.6,0,1,2 --driver reference
run 0 compare violet.exr reference.exr --warn 0.002
run 0 render values.vtk $look -o none.exr --nan-color 0.6,0,1,0
run 0 compare clear.exr none.exr
run 0 render values.vtk $look -o a.exr --nan-color 0.6,0,1
run 0 render values.vtk $look -o b.exr --nan-color 0.6,0,1,1
run 0 compare a.exr b.exr
for wrong in 1,2 1,0,2 0,0,0,-1 0,0,x 0,0,0,1,1; do
    run 2 render values.vtk -o no.png --nan-color "$wrong"
    says "--nan-color takes R,G,B[,A]"
    absent no.png
done
finish
