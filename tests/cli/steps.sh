#!/bin/sh
# render --step FROM:TO: one picture of each step, as the step alone gives it; what is set up again, and what is refused.
. "$TC_SOURCE/tests/cli/lib.sh"
small="--size 24x24 --quiet"

# Three steps of one mesh whose ranges differ, and a fourth whose mesh has moved.
mesh() { # mesh FILE SHIFT A B: two tets; the last point is moved by SHIFT, values from A to B
    cat >"$1" <<VTU
<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2">
<PointData><DataArray type="Float64" Name="T" format="ascii">$3 $4 $3 $4 $4</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1$2</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 1 2 3 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>
VTU
}
mesh 0.vtu "" 0 1
mesh 1.vtu "" 2 5
mesh 2.vtu "" -1 0
mesh 3.vtu ".5" 1 2
{
    echo '<VTKFile type="Collection"><Collection>'
    for i in 0 1 2 3; do echo "<DataSet timestep=\"$i.25e-1\" file=\"$i.vtu\"/>"; done
    echo '</Collection></VTKFile>'
} >run.pvd

# Each picture is that of its step alone with the range of all steps; values are put onto the mesh, a moved one is set up.
run 0 render run.pvd $small --step : -o "{step:02d}_{time:.1f}.exr" --stats s.json
json s.json size steps 4 eq transfer_range.0 -1 eq transfer_range.1 5 lacks march lacks time_ms.read has time_ms.ranges \
    has time_ms.total eq steps.0.set_up mesh eq steps.1.set_up values eq steps.2.set_up values eq steps.3.set_up mesh \
    eq steps.1.step 1 eq steps.1.time 0.125 eq steps.1.output 01_0.1.exr eq steps.1.gpu_bytes_sent 80 \
    has steps.1.time_ms.pack lacks steps.1.time_ms.check lacks steps.1.time_ms.order has steps.3.time_ms.check \
    has steps.3.mesh eq steps.3.march.rays_lost 0 has memory.peak_bytes
unit=$(sed -n 's/.*"unit_distance": \([0-9.e+-]*\).*/\1/p' s.json)
for step in 0 1 2; do
    run 0 render run.pvd $small --step $step -o one.exr --range=-1,5
    run 0 compare one.exr "0${step}_0.$step.exr" --warn 0
    prints "max 0 at"
done
run 0 render run.pvd $small --step 3 -o one.exr --range=-1,5 --unit-distance "$unit" --camera-position 0.5,0.5,4 \
    --focal-point 0.5,0.5,0.5
run 0 render run.pvd $small --step 2:3 -o seen.exr --range=-1,5 --unit-distance "$unit" --camera-position 0.5,0.5,4 \
    --focal-point 0.5,0.5,0.5 --stats t.json
run 0 compare one.exr seen_0003.exr --warn 0
prints "max 0 at"
grep -a -q tetcast:step seen_0003.exr || fail "seen_0003.exr carries no step"
json t.json lacks time_ms.ranges eq transfer_range.1 5

# Names, and steps from the end; a step says its name.
run 0 render run.pvd --size 8x8 --step -3::2
there run_0001.png
there run_0003.png
absent run_0002.png
says "step 1: 2 tets"
says "step 3: 2 tets"

# One step fills its names, too; without placeholders they stay as they are.
for given in "--step 2" "--step -2" "--time 0.23"; do
    # shellcheck disable=SC2086
    run 0 render run.pvd $small $given -o "one_{step:02d}_{time}.png" --error-image "e{step}.png"
    there one_02_0.225.png
    there e2.png
    rm -f one_02_0.225.png e2.png
done
run 0 render run.pvd $small --step 2 -o "{{step}}.png"
there "{{step}}.png"
run 0 render run.pvd $small -o "{step}.png" # no step was asked for
there "{step}.png"
for name in "x{step:q}.png 2" "nowhere{step}/{step}.png 1" "{step}.vtu 2"; do
    run "${name##* }" render run.pvd $small --step 1 -o "${name% *}"
    one_line
done
run 0 render run.pvd $small --step 1 -o 1.png
"$TETCAST" render 1.png --quiet -o "{step}.png" >out 2>err && fail "a picture is written over the one it is made from"
says "1.png is the input"
run 2 render run.pvd $small --step 1 -o "a{step}.png" --error-image "a{step:d}.png"
says "a1.png is the name of two files"
run 2 render run.pvd $small --step 1 -o "a{step}.png" --stats a1.png
says "a1.png is the name of two files"

# What cannot be: a step that is not there, names that meet, the input, one stdout.
wrong() { # wrong CODE TEXT ARGUMENT…
    want_code=$1
    text=$2
    shift 2
    rm -f ./*.png
    run "$want_code" render run.pvd --size 8x8 "$@"
    says "$text"
    one_line
    for f in ./*.png; do [ ! -e "$f" ] || fail "$f was written"; done
}
wrong 1 "has 4 time steps (0 to 3), so there is no step 4" --step 0:4
wrong 1 "no steps from 3 to 1" --step -1:1
wrong 2 "put {step} into the name" --step : -o "{time:d}.png"
wrong 2 "--output - takes one picture" --step : -o -
wrong 2 "{frame} is no part of a name" --step : -o "{frame}.png"
wrong 2 "--step takes N|FROM:TO" --step 1:x
wrong 2 "a stride of 1 or more" --step 0:3:0
wrong 2 "the extension tells the format" --step : -o "{step}"
wrong 1 "nowhere" --step : -o "nowhere/{step}.png"
wrong 2 "exclude each other" --step : --time 1
wrong 2 "--stats and a picture are one file" --step : -o "a{step}.png" --stats a2.png
run 2 render synth:ball:300 --step : -o b.png
says "has no time steps"

# The first step's mesh comes from a cache file, of any name and where the dataset is; the values of the others are put onto it.
mkdir set
cp 0.vtu 1.vtu 2.vtu 3.vtu run.pvd set
sleep 0.1 # younger files are not believed
run 0 render set/run.pvd $small --step 0:2 -o "n{step}.exr"
for name in miss hit; do
    run 0 render set/run.pvd $small --step 0:2 -o "$name{step}.exr" --cache-file set/kept --stats $name.json
    stderr_empty
    for step in 0 1 2; do
        run 0 compare "n$step.exr" "$name$step.exr" --warn 0
    done
done
json miss.json eq steps.0.cache.hit false has steps.0.cache.save_ms eq steps.0.cache.file set/kept lacks steps.1.cache
json hit.json eq steps.0.cache.hit true has steps.0.cache.load_ms lacks steps.0.time_ms.read lacks steps.0.time_ms.check \
    has steps.1.time_ms.read eq steps.1.set_up values lacks steps.1.cache

# A step that fails names itself, and leaves the pictures before it.
echo '<VTKFile type="Collection"><Collection><DataSet timestep="0" file="0.vtu"/><DataSet timestep="1" file="gone.vtu"/>
</Collection></VTKFile>' >gone.pvd
run 1 render gone.pvd $small --step : -o g.png
says "step 1: "
says "gone.vtu"
absent g_0000.png
run 1 render gone.pvd $small --step : -o g.png --range 0,1
says "step 1: "
there g_0000.png
absent g_0001.png

finish
