#!/bin/sh
# The window as a person uses it: a point of the curve is dragged, undone and done again, a colour map is searched for by
# keys; what is saved then is what render and batch make.
. "$TC_SOURCE/tests/cli/edit_lib.sh"
mkdir moved undone redone taken
display_open
window_open synth:kuhn --color-map pink.json --opacity 0:0.8,0.5:0.8,1:0.79 --integrator table --trace trace.json
wait_for curve_find

# The point in the middle goes to a quarter of the range and an opacity of 0.2.
drag $(((left + right) / 2)) "$top" $((left + (right - left) / 4)) $((bottom - (bottom - top) / 4)) 12
save_preset moved/map.json
json moved/map.json size . 1 eq 0.Name map eq 0.ColorSpace RGB size 0.RGBPoints 8 size 0.Points 12 eq 0.Points.0 0 \
    eq 0.Points.1 0.8 eq 0.Points.8 1 eq 0.Points.9 0.79
near moved/map.json 0.Points.4 0.25 0.01
near moved/map.json 0.Points.5 0.2 0.03

keys ctrl+z
save_preset undone/map.json
json undone/map.json size 0.Points 12 eq 0.Points.4 0.5 eq 0.Points.5 0.8
keys ctrl+shift+z
save_preset redone/map.json
cmp -s moved/map.json redone/map.json || fail "what is done again is not what was undone"

# From the curve to the lower panel, past its two tabs, into the search.
keys F6 Tab Tab
xdotool type --delay 5 inferno
keys Return
save_preset taken/map.json
json taken/map.json eq 0.Name map ge 0.Points.4 0.24 le 0.Points.4 0.26
near taken/map.json 0.RGBPoints.1 0 0.01
near taken/map.json 0.RGBPoints.3 0 0.02
! cmp -s taken/map.json moved/map.json || fail "no colour map was taken"

save_picture picture.png
save_scene scene.json
window_close

# Pictures of the drag: the pointer, then the table and the march, then the picture in the window.
json trace.json type traceEvents array
awk -F'"' '
    { id = $0; ts = $0; sub(/.*"id":/, "", id); id += 0; sub(/.*"ts":/, "", ts); ts += 0 }
    id && !(($4, id) in at) { at[$4, id] = ts; last = id > last ? id : last }
    END {
        for (i = 1; i <= last; i++)
            n += ("pointer", i) in at && ("table", i) in at && ("render", i) in at && ("shown", i) in at &&
                at["pointer", i] < at["table", i] && at["table", i] < at["shown", i] &&
                at["pointer", i] < at["render", i] && at["render", i] < at["shown", i]
        print n + 0
        exit n < 5 # one of the drag, and the start, what was undone, done again and taken
    }' trace.json >chains || fail "the trace has $(cat chains) changes that were shown"

run 0 render scene.json -o rendered.png --quiet
same_within rendered.png picture.png
run 0 batch scene.json -o 'batch_{step:03d}.png' --quiet
same_within batch_000.png picture.png
size=$(convert picture.png -format '%wx%h' info:)
run 0 render synth:kuhn --color-map taken/map.json --integrator table --size "$size" -o preset.png --quiet
same_within preset.png picture.png
run 0 render synth:kuhn --size "$size" -o plain.png --quiet
run 2 compare plain.png picture.png
finish
