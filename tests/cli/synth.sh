#!/bin/sh
# synth: the list, the files, and that a file and synth: are the same mesh.
. "$TC_SOURCE/tests/cli/lib.sh"
run 0 synth --list
stderr_empty
for name in kuhn ball heatsink cylinder bluntfin; do
    prints "$name "
done
[ "$(wc -l <out)" -ge 5 ] || fail "fewer than five datasets"
sed 's/ .*//' out >names
run 0 synth --list --json
cp out list.json
json list.json size . "$(wc -l <names)" has 0.name has 0.what has 0.field

while read -r name; do
    run 0 synth "$name" --cells 600 --seed 7 -o "$name.vtu"
    there "$name.vtu"
    stdout_empty
    run 0 info --json "$name.vtu"
    cp out file.json
    run 0 info --json "synth:$name:600" --seed 7
    cp out direct.json
    tets=$(sed -n 's/.*"tets": \([0-9]*\).*/\1/p' direct.json | head -1)
    json file.json eq mesh.tets "$tets" eq mesh.defects.dropped_degenerate 0 eq mesh.defects.unlinked_faces 0
done <names

# The same seed gives the same bytes, another one other bytes.
run 0 synth kuhn --cells 600 --seed 7 -o again.vtu
cmp -s kuhn.vtu again.vtu || fail "the same seed gave another file"
run 0 synth kuhn --cells 600 --seed 8 -o other.vtu
! cmp -s kuhn.vtu other.vtu || fail "another seed gave the same file"
finish
