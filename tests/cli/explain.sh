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

# The page has the command's own options, and leaves the others to render's.
page=$TC_SOURCE/docs/man/tetcast-explain.1
run 0 explain --help
for option in --measure --json; do
    prints "  $option "
    sed 's/\\-/-/g' "$page" | grep -qE -e "^\.(B|BR|BI).*$option" || fail "$option has no paragraph in $page"
done
finish
