#!/bin/sh
# Scene files, and pictures that carry theirs: what they say is rendered, and what is wrong is told by line and key.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
small="--size 24x18 --quiet"
mkdir data
cube data/disk.vtu

# The first example of docs/formats.md, word by word; its paths lead from its folder.
sed -n '/^```json$/,/^```$/{p;/^```$/q}' "$TC_SOURCE/docs/formats.md" | grep -v '^```' >data/disk.json
[ "$(wc -l <data/disk.json)" -gt 10 ] || fail "docs/formats.md has no example"
run 0 render data/disk.json --driver reference
there data/disk.png
run 0 render data/disk.vtu --driver reference --field Temp --camera-position 4,3,8 --focal-point 1,0.5,0.5 --view-up 0,1,0 \
    --view-angle 25 --azimuth 10 --color-map Viridis --range 0,2 --opacity 0:0,0.5:0.1,2:3 --iso 0.5,1.5 \
    --iso-color "1,0.5,0;0.2,0.4,1" --iso-opacity 1,0.4 --shade vertex --light "head;1,1,0" --ambient 0.3 \
    --color-field Pres --clip 0.2,0,0,1,0,0 --select "Material:1;Material:2" --surface 0.1 --title Disk --color-bar \
    --samples 4 --size 320x240 --background 1,1,1 -o line.png
same_pixels data/disk.png line.png

# Without a name for the picture the scene's; with one of the command line that.
printf '{"data": "data/disk.vtu", "output": {"size": [8, 8]}, "method": {"driver": "reference"}}' >short.json
run 0 render short.json
there short.png
run 0 render short.json -o else.png --size 9x7
"$TETCAST" render else.png --quiet --size 5x5 -o less.png || fail "else.png is not made again"
says "wrote else.png"
other_pixels short.png else.png

# A picture is made again bit by bit, and carries the same scene then.
scene_of() { "$TC_PIXELS" "$1" tetcast:scene; }
again() { # again OPTION…
    # shellcheck disable=SC2086
    run 0 render $input $small -o first.png "$@"
    run 0 render first.png --quiet -o second.png
    same_pixels first.png second.png
    [ -n "$(scene_of first.png)" ] || fail "$input $* carries no scene"
    [ "$(scene_of first.png)" = "$(scene_of second.png)" ] || fail "$input $* carries another scene when it is made again"
}
input=synth:ball:500
again --azimuth 30 --elevation 20 --zoom 1.3 --background 0.1,0.2,0.3,0.7
again --parallel --roll 10 --samples adaptive --clipping-range 1,9 --unit-distance 0.1 --steps-per-pass 3
again --opacity "0:0,0.5:0.3,1:7" --integrator table --table-size 32,32,64 --table-format 8 --seed 7
again --error 0.01 --no-cache --size 12x9
again --driver reference --verify 20 --reentry peel --nan-color 1,0,1
input=data/disk.vtu
again --driver reference --field Pres --log --range 0.1,1
again --driver reference --cell-data --field Material --categories "1:1,0,0;2:0,1,0,3"
again --driver reference --color-field Pres --color-map Plasma --select Material:1 --select "Temp:0,1;Pres:0,1" --surface
again --driver reference --model mip --clip 0.5,0,0,1,0,0 --clip-box 0,2,0,0.8,0,1 --triad --title "Schön 'n' \"gut\""
again --driver reference --iso 0.5,1.2 --iso-color "1,0,0;0,1,0" --shade vertex --light "head;1,0,0" --color-bar --axes
for extension in exr tif; do
    run 0 render $input $small -o first.$extension --azimuth 33
    run 0 render first.$extension --quiet -o second.$extension
    run 0 compare first.$extension second.$extension --json
    grep -q '"max_abs": 0.0' out || fail "first.$extension made again is another picture"
done
cp data/disk.vtu 0.vtk
cube 1.vtk 1
printf '{"file-series-version": "1.0", "files": [{"name": "0.vtk", "time": 0}, {"name": "1.vtk", "time": 1}]}' >run.vtk.series
run 0 render run.vtk.series $small --step : -o "s_{step}.png" --azimuth 20
for step in 0 1; do
    run 0 render s_$step.png --quiet -o again.png
    same_pixels s_$step.png again.png
done
run 0 render s_0.png --quiet --step 1 -o again.png # over the range that all steps share
same_pixels s_1.png again.png
run 0 render s_0.png --quiet --time 1 -o again.png
same_pixels s_1.png again.png

# From another folder, since files are in it by their whole path; named after its data.
run 0 render $input $small -o first.png
(cd data && "$TETCAST" render ../first.png --quiet --size 5x5) || fail "a picture is not made from another folder"
there data/disk.png
run 2 render data/disk.png -o data/disk.png
says "data/disk.png is the input and would be written over"
run 1 render nothing.png -o a.png
says "nothing.png"
run 0 render short.json --quiet -o plain.png
printf 'tetcast:scane' | dd of=plain.png bs=1 seek="$(LC_ALL=C grep -a -b -o 'tetcast:scene' plain.png | head -1 | cut -d: -f1)" conv=notrunc 2>dd.err
run 1 render plain.png -o a.png
says "plain.png carries no scene"

# What is wrong is told by file, line and key; nothing is written.
wrong() { # wrong TEXT SCENE
    printf '%s' "$2" >wrong.json
    run 1 render wrong.json -o no.png
    says "$1"
    one_line
    absent no.png
}
wrong "wrong.json:3: camera has no key 'positon'; the nearest is 'position'" '{"data": "synth:ball",
"camera": {
"positon": [1, 2, 3]}}'
wrong "wrong.json:2: the scene has no key 'effect'; the nearest is 'effects'" '{"data": "synth:ball",
"effect": {}}'
wrong "wrong.json:2: the scene has no key 'azimuth': it belongs into camera" '{"data": "synth:ball",
"azimuth": 3}'
wrong "wrong.json:2: camera.azimuth takes a number, not a text" '{"data": "synth:ball", "camera": {"roll": 1,
"azimuth": "3"}}'
wrong "wrong.json:2: camera.position takes X,Y,Z, not '1,2'" '{"data": "synth:ball", "camera":
{"position": [1, 2]}}'
wrong "wrong.json:1: camera.view_angle takes DEG, above 0" '{"data": "synth:ball", "camera": {"view_angle": 0}}'
wrong "wrong.json:1: effects.shade takes off|cell|vertex, not 'cel'; the nearest is 'cell'" '{"data": "synth:ball", "effects": {"shade": "cel"}}'
wrong "wrong.json:1: effects takes an object" '{"data": "synth:ball", "effects": ["mip"]}'
wrong "wrong.json:2: views stands for several pictures, which tetcast batch makes" '{"data": "synth:ball",
"views": 7}'
wrong "wrong.json:1: transfer_function stands for several pictures" '{"data": "synth:ball", "transfer_function": [{}]}'
wrong "wrong.json:1: data stands for several pictures" '{"data": ["a.vtu", "b.vtu"]}'
wrong "wrong.json:1: field stands for several pictures" '{"data": "synth:ball", "field": ["a", "b"]}'
wrong "wrong.json:1: shell is not in this version" '{"data": "synth:ball", "shell": {}}'
wrong "wrong.json:1: output.size takes WxH: each from 1 to 32768" '{"data": "synth:ball", "output": {"size": [0, 4]}}'
wrong "wrong.json names no data: add \"data\": \"FILE\"" '{"field": "x"}'
wrong "wrong.json:3: this is no JSON" '{"data": "synth:ball",

}'
wrong "wrong.json:1: a scene is an object" '[1]'
wrong "nowhere.vtu cannot be read" '{"data": "nowhere.vtu"}'
wrong "wrong.json:2: this is no JSON: duplicate object key" '{"data": "synth:ball",
"data": "synth:ball"}'
wrong "wrong.json:1: effects.iso takes a text, a number or a list of them, not an empty list" '{"data": "synth:ball", "effects": {"iso": []}}'
run 1 render gone.json
says "gone.json cannot be read"

# What is found wrong only later is told by its place, too, where the command line does not have its part in it.
wrong "wrong.json:2: transfer_function.range: --range takes LO,HI with LO below HI, not 2,1" '{"data": "synth:ball", "transfer_function": {
"range": [2, 1]}}'
wrong "wrong.json:2: effects.iso_color: --iso-color is of --iso" '{"data": "synth:ball", "effects": {
"iso_color": [1, 0, 0]}}'
wrong "wrong.json:1: effects.iso_color: --iso-color has 3, but there are 2 of --iso" \
    '{"data": "synth:ball", "effects": {"iso": [0, 1], "iso_color": [[1, 0, 0], [0, 0, 0], [1, 1, 1]]}}'
wrong "wrong.json:1: effects.color_bar_place: --color-bar-place is of --color-bar" '{"data": "synth:ball", "effects": {"color_bar_place": "left"}}'
wrong "wrong.json: --cell-data" '{"data": "data/disk.vtu", "cell_data": true, "point_data": true}'
wrong 'wrong.json: there is no colour map "Virdis"' '{"data": "synth:ball", "transfer_function": {"color_map": "Virdis"}}'
wrong "wrong.json: --categories" '{"data": "data/disk.vtu", "effects": {"categories": "none.txt"}}'
wrong "wrong.json: data/disk.vtu: 'Material' is cell data" '{"data": "data/disk.vtu", "field": "Material", "effects": {"iso": 1}}'
wrong "at most 64 of them" "{\"data\": \"synth:ball\", \"effects\": {\"iso\": [0$(printf ',%s' $(seq 64))]}}"
run 2 render wrong.json --iso "0$(printf ',%s' $(seq 64))"
says "at most 64 of them"
printf '{"data": "data/disk.vtu", "output": {"file": "x.gif"}}' >wrong.json
run 1 render wrong.json
says "wrong.json:1: output.file: x.gif: the extension tells the format"
run 2 render wrong.json -o y.gif
says "error: y.gif: the extension"
run 2 render wrong.json -o no.png --color-map Virdis
says 'error: there is no colour map "Virdis"'
run 2 render wrong.json -o no.png --iso-color 1,0,0
says "error: --iso-color is of --iso"
run 0 render wrong.json $small --driver reference -o good.png

# What is off is as if it were not there, in a scene and on the command line; with it goes what belongs to it.
off() { # off SCENE LESS OPTION…: the scene with the options is the picture of LESS
    printf '{"data": "data/disk.vtu", "field": "Temp", "output": {"size": [80, 60]}, "method": {"driver": "pingpong"}, "effects": {%s}}' "$1" >more.json
    printf '{"data": "data/disk.vtu", "field": "Temp", "output": {"size": [80, 60]}, "method": {"driver": "pingpong"}, "effects": {%s}}' "$2" >less.json
    shift 2
    run 0 render less.json --quiet -o less.png
    run 0 render more.json --quiet "$@" -o off.png
    same_pixels less.png off.png
    run 0 render off.png --quiet -o again.png
    same_pixels off.png again.png
}
off '"one_sided": false, "color_bar_opacity": false, "axes": false, "surface": false, "surface_color": [1, 0, 0]' ''
off '"color_bar": false, "color_bar_place": "left", "outline": false, "line_color": [1, 0, 0], "shade": "off", "ambient": 0.5' ''
run 0 render more.json --quiet --color-bar --outline --shade cell --size 320x240 --zoom 1 -o more.png
run 0 render more.png --quiet --color-bar=off --outline=off --shade off --size 80x60 -o less.png
same_pixels off.png less.png
off '"surface": 0.5, "surface_color": [1, 0, 0], "specular": 0.9' '' --surface=off
run 0 render data/disk.vtu --field Temp --size 80x60 --driver pingpong --quiet --one-sided=off --log=off -o off.png
same_pixels off.png less.png
run 2 render more.json --color-bar=off --color-bar-place left
says "error: --color-bar-place is of --color-bar"
run 2 render data/disk.vtu --surface=off --surface-color 1,0,0
says "--surface-color is of --surface"

# The view of the command line, whatever projection the picture has.
view="--size 40x30 --driver reference --quiet"
run 0 render data/disk.vtu $view --camera-position 4,3,8 --focal-point 1,0.5,0.5 --parallel-scale 1 -o first.png
run 0 render data/disk.vtu $view --camera-position 4,3,8 --focal-point 1,0.5,0.5 --view-angle 20 -o angle.png
run 0 render data/disk.vtu $view --camera-position 4,3,8 --focal-point 1,0.5,0.5 -o wide.png
run 0 render first.png --quiet --parallel=off --view-angle 20 -o a.png
same_pixels angle.png a.png
run 0 render first.png --quiet --view-angle 20 -o a.png
same_pixels angle.png a.png
run 0 render first.png --quiet --parallel=off -o a.png
same_pixels wide.png a.png
other_pixels first.png a.png
run 0 render first.png --quiet --parallel-scale 2 --view-angle 20 -o a.png
run 0 render a.png --quiet --parallel-scale 1 -o a.png.png
same_pixels first.png a.png.png

# A measurement is no part of a picture.
run 0 render data/disk.vtu $small --verify 5 -o first.png
scene_of first.png | grep -q verify && fail "--verify is in the scene of its picture"
run 0 render first.png --quiet --outline -o a.png

# A file needs no dot in its name; a built-in map stands before it.
printf '0:1,0,0\n1:0,0,1\n' >data/cats
cp data/cats data/viridis
printf '{"data": "disk.vtu", "field": "Temp", "effects": {"categories": "cats"}}' >data/named.json
run 0 render data/named.json $small -o first.png
mkdir elsewhere
(cd elsewhere && "$TETCAST" render ../first.png --quiet -o again.png) || fail "a picture loses a file without a dot"
same_pixels first.png elsewhere/again.png
printf '{"data": "disk.vtu", "transfer_function": {"color_map": "viridis"}}' >data/named.json
run 0 render data/named.json $small -o first.png

# Geometry with an opacity, as lists.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >data/x.obj
printf 'v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n' >data/y.obj
for geometry in '[["x.obj", 0.5], ["y.obj", 0.3]]' '["x.obj,0.5", ["y.obj", 0.3]]' '["x.obj,0.5", "y.obj,0.3"]'; do
    printf '{"data": "disk.vtu", "effects": {"geometry": %s}}' "$geometry" >data/named.json
    run 0 render data/named.json --size 80x60 --driver reference --quiet -o a.png
    [ ! -f geometry.png ] || same_pixels geometry.png a.png
    mv a.png geometry.png
done
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\n' >lines.obj
run 2 render data/disk.vtu --size 8x8 --geometry lines.obj --verify 5 -o no.png
says "lines.obj has 2 lines, and the reference that --verify compares with draws none: leave out --verify"
absent no.png
finish
