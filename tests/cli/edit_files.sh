#!/bin/sh
# What the window has saved is opened by it again, unchanged: a scene, a picture that carries its scene, a preset that is
# chosen by its path; and the preset is as ParaView wants it.
. "$TC_SOURCE/tests/cli/edit_lib.sh"
mkdir first scene picture preset
display_open

# A map in Lab over a range of its own, a curve with a step, a midpoint and a sharpness, and a part of the picture's size.
cat >map.json <<'MAP'
[{"Name": "map", "ColorSpace": "Lab", "NanColor": [0.1, 0.2, 0.3],
  "RGBPoints": [2, 0.1, 0.2, 0.9, 3, 0.9, 0.8, 0.1, 6, 0.5, 0, 0.1],
  "Points": [2, 0, 0.5, 0, 3, 0.1, 0.25, 0.5, 4, 0.6, 0.5, 0, 4, 0.2, 0.5, 0, 6, 0.9, 0.5, 0]}]
MAP
window_open synth:ball --color-map map.json --size 160x120 --camera-position 1,2,5 --model emission
save_preset first/map.json
save_scene scene.json
save_picture picture.png
window_close
json first/map.json size . 1 eq 0.Name map eq 0.ColorSpace Lab size 0.RGBPoints 12 size 0.Points 20 \
    eq 0.Points.6 0.25 eq 0.Points.7 0.5 eq 0.NanColor.2 0.3
json scene.json eq data synth:ball
is_for_paraview first/map.json

window_open scene.json
save_preset scene/map.json
save_picture scene/picture.png
window_close
cmp -s first/map.json scene/map.json || fail "the preset of an opened scene is another"
same_within scene/picture.png picture.png

# A picture that is opened in a window that shows something else; then a preset.
window_open synth:kuhn --size 64x48
open_file picture.png
wait_for window_named 'ball'
save_preset picture/map.json
cmp -s first/map.json picture/map.json || fail "the preset of an opened picture is another"
open_file first/map.json
save_preset preset/map.json
cmp -s first/map.json preset/map.json || fail "a preset that is opened and saved is another"
window_close

run 0 render scene.json -o rendered.png --quiet
same_within rendered.png picture.png
run 0 render picture.png -o again.png --quiet
same_within again.png picture.png
finish
