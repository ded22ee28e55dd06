#!/bin/sh
# explain: what a picture calls for, from the options, the scene file or the picture that render takes.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
cube two.vtk
small="--size 24x18 --quiet"

run 0 explain two.vtk $small --json
cp out plain.json
in_force() { tr -d '\n ' <"$1" | grep -q "\"name\":\"$2\",\"what\":\"[^\"]*\",\"in_force\":$3"; }
in_force plain.json density-emitter true || fail "a plain picture is no density emitter"
for effect in isosurfaces shade clip maximum; do
    in_force plain.json $effect false || fail "a plain picture calls for $effect"
done
json plain.json has textures.0.bytes has programs.0.text_bytes has passes.march has integrator lacks frame_ms

# The same picture by options, by a scene file and by the picture itself.
printf '{"data": "two.vtk", "effects": {"iso": 1, "clip": [0.2, 0, 0, 1, 0, 0]}, "output": {"size": [24, 18]}}' >scene.json
run 0 explain two.vtk $small --json --iso 1 --clip 0.2,0,0,1,0,0
cp out options.json
for effect in isosurfaces clip; do
    in_force options.json $effect true || fail "the picture does not call for $effect"
done
run 0 explain scene.json --quiet --json
cmp -s out options.json || fail "a scene file is explained otherwise than its options"
run 0 render scene.json --quiet -o picture.png
run 0 explain picture.png --quiet --json
cmp -s out options.json || fail "a picture is explained otherwise than its options"
absent scene.png

# Nothing is written, so any INPUT and any name of a picture will do.
cp picture.png two.png
run 0 explain two.png --quiet --json
cmp -s out options.json || fail "a picture named after its data is explained otherwise"
cmp -s two.png picture.png || fail "explain wrote over the picture"
run 0 explain scene.json --quiet -o scene.json --stats no.json
absent no.json
run 0 explain scene.json --quiet
prints "in force"
prints "isosurfaces"
run 2 explain two.vtk $small --driver reference
says "explain"
run 2 explain
says "explain needs INPUT"
run 2 explain two.vtk --mesure
says "the nearest is '--measure'"

# What was asked of error and time chooses here as it does for the picture; who asked for an integrator is said.
TETCAST_CACHE=$work/cache # so that both choose by the same measurements
export TETCAST_CACHE
choose="--error 0.02"
# shellcheck disable=SC2086
run 0 explain synth:ball:500 $small $choose --json
json out eq choice.asked_error 0.02 has choice.why has choice.setting has integrator_why
grep -q '"integrator_why": ""' out && fail "there is no reason for the integrator"
setting=$(sed -n 's/.*"setting": "\(.*\)".*/\1/p' out | head -1)
integrator=$(sed -n 's/.*"integrator": "\(.*\)".*/\1/p' out)
# shellcheck disable=SC2086
run 0 render synth:ball:500 $small $choose -o c.png --stats c.json
json c.json eq choice.cached true eq choice.setting "$setting" eq march.integrator "$integrator"
run 0 explain synth:ball:500 --size 24x18 --error 0.02
prints "chosen"
run 0 explain two.vtk $small --json --integrator exact
json out eq integrator exact eq integrator_why "as --integrator asks" lacks choice
run 0 explain two.vtk $small --json --model mip --integrator integral
json out eq integrator exact eq integrator_why "the model takes no other"
for model in mip average emission xray absorption; do
    run 0 explain two.vtk $small --json --model $model
    grep -q '"integrator_why": ""' out && fail "there is no reason for the integrator of $model"
done

# Of several steps the first is explained, which is said; so is what is left out.
mkdir ens
for i in 0 1 2; do cp two.vtk ens/$i.vtk; done
printf '<VTKFile type="Collection"><Collection>' >run.pvd
for i in 0 1 2; do echo "<DataSet timestep=\"$i\" file=\"ens/$i.vtk\"/>"; done >>run.pvd
printf '</Collection></VTKFile>' >>run.pvd
run 0 explain run.pvd --size 24x18 --step 1:2 --json --stats s.json --verify 9 --repeat 2 --error-image e.png
says "step 1 is explained, the first of 2, with the function over its own range"
says "--stats, --verify, --error-image, --repeat is left out"
absent s.json
absent e.png
run 0 explain run.pvd --size 24x18 --step 1:1 --json
says_not "is explained"
says_not "is left out"
run 1 explain run.pvd $small --step 1:3
says "has 3 time steps (0 to 2), so there is no step 3"
one_line

# The page has the command's own options, and leaves the others to render's.
page=$TC_SOURCE/docs/man/tetcast-explain.1
run 0 explain --help
for option in --measure --json; do
    prints "  $option "
    sed 's/\\-/-/g' "$page" | grep -qE -e "^\.(B|BR|BI).*$option" || fail "$option has no paragraph in $page"
done
finish
