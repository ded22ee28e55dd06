#!/bin/sh
# render: what goes where, and what is said.
. "$TC_SOURCE/tests/cli/lib.sh"
ball="synth:ball:3000 --size 32x24"

# Without -o the picture is INPUT's name + .png in the current folder; stdout stays empty.
run 0 render $ball
stdout_empty
says "wrote ball.png"
there ball.png
[ "$(head -c 4 ball.png | tail -c 3)" = PNG ] || fail "ball.png is no PNG"

# The picture says how to make it again.
for key in command camera transfer_function version; do
    grep -a -q "tetcast:$key" ball.png || fail "ball.png carries no tetcast:$key"
done
grep -a -q "tetcast render synth:ball:3000 --size 32x24" ball.png || fail "ball.png does not carry its command line"

# -o - is a PNG on stdout and nothing else.
run 0 render $ball -o -
[ "$(head -c 4 out | tail -c 3)" = PNG ] || fail "stdout is no PNG"
cp out stdout.png
run 0 compare ball.png stdout.png
prints "same"

# --quiet says nothing, --verbose more than the default.
run 0 render $ball -o a.png --quiet
stderr_empty
run 0 render $ball -o a.png
quiet_lines=$(wc -l <err)
run 0 --verbose render $ball -o a.png
[ "$(wc -l <err)" -gt "$quiet_lines" ] || fail "--verbose says no more than the default"

# Both drivers, both integrators, the steps of a pass: one picture.
run 0 render $ball -o reference.exr --driver reference
for options in "--integrator integral" "--integrator table" "--steps-per-pass 1" "--steps-per-pass 64 --z-update-every never" \
    "--reentry peel" "--table-format 16f --integrator table" "--threads 1" "--stepper planes"; do
    run 0 render $ball -o b.exr $options
    run 0 compare reference.exr b.exr --warn 0.004
done

# The camera's options act.
for options in "--azimuth 40" "--elevation 30" "--roll 20" "--zoom 1.5" "--view-angle 50 --camera-position 0,0,4" \
    "--parallel-scale 3" "--focal-point 0.3,0,0" "--color-map Viridis" "--opacity 0:0,1:2" "--range 0,0.5" \
    "--unit-distance 0.01" "--background 0.5,0.5,0.5"; do
    run 0 render $ball -o c.exr $options
    run 2 compare reference.exr c.exr
done
run 0 render $ball -o d.exr --azimuth 360 --zoom 1 --background transparent --view-up 0,1,0
run 0 compare reference.exr d.exr

# A clipping range that holds all changes nothing; one that does not, does; one beside the mesh is said.
run 0 render $ball -o e.exr --clipping-range 0.1,100
run 0 compare reference.exr e.exr
for options in "--clipping-range 0,7" "--clipping-range 6,100" "--parallel --camera-position 0,0,0.2"; do
    run 0 render $ball -o c.exr $options --verify 1000
    run 2 compare reference.exr c.exr
done
grep -a -q clipping_range e.exr || fail "e.exr does not carry its clipping range"
run 0 render $ball -o f.png --clipping-range 20,30
says "outside the clipping range 20 to 30"
run 0 render $ball -o f.png --parallel --camera-position 0,0,-2 --focal-point 0,0,-3
says "lies behind the camera"
for wrong in 5,5 7,2 -1,4 3 1,2,3 0,inf; do
    run 2 render $ball -o no.png --clipping-range "$wrong"
    says "--clipping-range takes NEAR,FAR"
    absent no.png
done

# A file as input, by the reader.
run 0 synth ball --cells 3000 -o ball.vtu
there ball.vtu
run 0 render ball.vtu --size 32x24 -o e.exr
run 0 compare reference.exr e.exr

# An empty picture is never silent, not even with --quiet, and says why.
run 0 render $ball -o f.png --opacity 0:0,1:0 --quiet
says "the opacity is 0 for every value"
run 0 render $ball -o f.png --camera-position 0,0,5 --focal-point 0,0,9 --quiet
says "behind the camera"
run 0 render $ball -o f.png --focal-point 100,0,0 --quiet
says "outside the view"
run 0 render $ball -o f.png --quiet --zoom 0.0001
says "the picture is empty"
run 0 render $ball -o f.png --quiet --unit-distance 1e9
says "all but empty"
one_line
run 0 render $ball -o f.png
says_not "empty"

# A time outside the steps, and a list that names a file that is not there.
run 0 synth ball --cells 300 -o step.vtu --quiet
for name in step gone; do
    cat >$name.pvd <<PVD
<VTKFile type="Collection"><Collection>
<DataSet timestep="1" file="$name.vtu"/><DataSet timestep="2" file="$name.vtu"/>
</Collection></VTKFile>
PVD
done
run 0 render step.pvd --size 8x8 -o t.png --time 5
says "time 5 lies after the last step; the step at 2 was read"
run 0 render step.pvd --size 8x8 -o t.png --time 0
says "time 0 lies before the first step; the step at 1 was read"
run 0 render step.pvd --size 8x8 -o t.png --time 1.5
says_not "lies"
run 1 render gone.pvd --size 8x8 -o gone.png
says "gone.pvd lists"
says "gone.vtu cannot be opened"
one_line
absent gone.png
run 1 render step.pvd --size 8x8 -o gone.png --step 2
says "no step 2"

# A mesh whose gaps cannot be filled is peeled, and that is said: three tets on one face.
cat >fan.vtk <<'VTK'
# vtk DataFile Version 3.0
three cells on one face
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 double
0 0 0  1 0 0  0 1 0  0.2 0.2 1  0.2 0.2 -1  0.9 0.9 1
CELLS 3 15
4 0 1 2 3
4 0 1 2 4
4 0 1 2 5
CELL_TYPES 3
10 10 10
POINT_DATA 6
SCALARS heat double 1
LOOKUP_TABLE default
0 1 2 3 4 5
VTK
run 0 render fan.vtk --size 16x16 -o fan.png
says "by peeling"
there fan.png

# Gaps are peeled for a single frame where that is sooner, filled for more; it is the same picture.
fin="synth:bluntfin:40000 --size 64x64"
run 0 render $fin -o once.exr
says "by peeling: a single picture"
run 0 render $fin -o more.exr --repeat 1
says_not "by peeling"
run 0 compare once.exr more.exr --warn 0.0001
for options in "--reentry convexify" "--stats fin.json" "--samples 4"; do
    run 0 render $fin -o more.exr $options
    says_not "by peeling"
done

# Inputs that fail say so, name the file and write nothing.
run 1 render no-such-file.vtu
says "no-such-file.vtu"
stdout_empty
absent no-such-file.png
echo "this is no mesh" >text.vtu
run 1 render text.vtu
says "text.vtu"
absent text.png
run 1 render ball.vtu --field Nonsense -o g.png
says "Nonsense"
absent g.png
run 2 render $ball -o g.png --color-map "Col to Warm"
says "Cool to Warm"
absent g.png
run 1 render $ball -o g.png --opacity no-such-file.json
absent g.png
run 2 render $ball -o g.png --camera-position 0,0,0 --focal-point 0,0,0
finish
