#!/bin/sh
# synth: the list, the files, and that a file and synth: are the same mesh.
. "$TC_SOURCE/tests/cli/lib.sh"
run 0 synth --list
stderr_empty
for name in kuhn ball heatsink cylinder bluntfin sliver-1e5 seam; do
    prints "$name "
done
[ "$(wc -l <out)" -ge 100 ] || fail "fewer than seventy datasets"
sed 's/ .*//' out >names
sed -n 's/ *broken: .*//p' out >broken
[ "$(head -1 names)" = kuhn ] || fail "the list does not begin with kuhn"
run 0 synth --list --json
cp out list.json
json list.json size . "$(wc -l <names)" has 0.name has 0.what has 0.field

# What is broken comes out of the file as it does without one; the rest has no defects.
while read -r name; do
    case $name in
    bad-index)
        run 1 synth "$name" -o "$name.vtu"
        says "names vertex"
        [ ! -e "$name.vtu" ] || fail "a mesh that cannot be was written"
        continue
        ;;
    esac
    run 0 synth "$name" --cells 600 --seed 7 -o "$name.vtu"
    there "$name.vtu"
    stdout_empty
    if [ "$name" = no-cells ]; then
        run 1 info --json "$name.vtu"
        says "no cells"
        continue
    fi
    run 0 info --json "$name.vtu"
    cp out file.json
    run 0 info --json "synth:$name:600" --seed 7
    cp out direct.json
    tets=$(sed -n 's/.*"tets": \([0-9]*\).*/\1/p' direct.json | head -1)
    json file.json eq mesh.tets "$tets"
    grep -qx "$name" broken || json file.json eq mesh.defects.dropped_degenerate 0 eq mesh.defects.unlinked_faces 0
done <names

# The same seed gives the same bytes, another one other bytes.
run 0 synth kuhn --cells 600 --seed 7 -o again.vtu
cmp -s kuhn.vtu again.vtu || fail "the same seed gave another file"
run 0 synth kuhn --cells 600 --seed 8 -o other.vtu
! cmp -s kuhn.vtu other.vtu || fail "another seed gave the same file"
finish
