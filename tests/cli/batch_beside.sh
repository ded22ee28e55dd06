#!/bin/sh
# batch: a picture is the same, byte by byte, whatever others are asked for beside it, and --resume knows it again; what changes
# it makes another.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
for i in 0 1 2; do cube run_$i.vtk $i; done
front='{"name": "front", "direction": [0, -1, 0]}'
top='{"name": "top", "direction": [0, 0, 1], "view_up": [0, 1, 0]}'
side='{"name": "side", "direction": [1, 0, 0]}'
scene() { # scene VIEWS [TITLE]
    printf '{"data": "run_*.vtk", "views": %s, "transfer_function": {"range": [0, 5]}, "method": {"driver": "pingpong"},
"effects": {"title": "%s", "color_bar": true}, "output": {"size": [96, 64]}}' "$1" "${2-cube}" >s.json
}
# made FOLDER NAME COUNT OPTION…: goes on, makes so many; then all is as of one run
made() {
    folder=$1
    name=$2
    count=$3
    shift 3
    run 0 batch s.json --resume --json -o "$folder/$name" "$@"
    tail -1 out >line.json
    json line.json eq done "$count" eq failed 0
    rm -rf one
    run 0 batch s.json --quiet -o "one/$name" "$@"
    diff -r one "$folder" >why 2>&1 || fail "$folder is not that of one run: $(head -1 why)"
}
# Views before and between those that are there, and in another order.
name='{step}_{view}.png'
scene "[$front, $top]"
made list "$name" 6
scene "[$side, $top, $front]"
made list "$name" 3
scene "[$top, $front, $side]"
made list "$name" 0
scene '{"phi": [0, 120], "theta": [10]}'
name='{step}_{phi}_{theta}.png'
made grid "$name" 6
scene '{"phi": [0, 60, 120], "theta": [-10, 10]}'
made grid "$name" 12
# Fewer and more steps.
scene "[$top]"
name='{step}_{view}.png'
made steps "$name" 1 --frames 1
made steps "$name" 2
# A view of the same name that looks from elsewhere, or leaves no room for the bar; each step its own box.
for over in first step; do
    scene "[$front]"
    made "other_$over" "$name" 3 --camera-over $over
    scene '[{"name": "front", "direction": [0, -1, 0.5]}]'
    made "other_$over" "$name" 3 --camera-over $over
    scene '[{"name": "front", "direction": [0, -1, 0.5], "zoom": 1}]'
    made "other_$over" "$name" 3 --camera-over $over
    made "other_$over" "$name" 0 --camera-over $over
done
# What a title tells is seen: of the frame's number in the batch it is another when others come before it.
scene "[$front]" 'picture {frame}'
made title "$name" 2 --frames 1:2
made title "$name" 3
# Depth and value are files beside, and leave the picture as it is.
scene "[$front]"
made plain "$name" 3
cp plain/1_front.png before.png
run 0 batch s.json --resume --quiet --depth --value -o "plain/$name"
cmp -s plain/1_front.png before.png || fail "--depth changes the picture"

# What the command line says is not blamed on the scene; what the scene says is.
run 2 batch s.json --repeat 3
one_line
says "error: --repeat: frames are repeated"
run 2 batch s.json --stats a.json
says "error: --stats: statistics are"
run 2 batch s.json -o -
says "error: a batch makes files"
printf '{"data": "run_*.vtk",\n"output": {"repeat": 3}}' >w.json
run 1 batch w.json
one_line
says "error: w.json:2: output.repeat: --repeat: frames are repeated"
run 2 batch s.json --model minip --depth
says "with --model mip, minip and average nothing is opaque"
finish
