#!/bin/sh
# run.sh BUILD: the hard cases at length (make hard). Tables and figures of each step come to BUILD/hard-cases.
# Every step runs whatever the ones before said. Exit 0: all kept their bounds; 1: one did not.
set -u
build=$1
here=$(dirname "$0")
out=$build/hard-cases
status=0
mkdir -p "$out/export"

say() {
    echo "hard: $*" >&2
}

for context in osmesa egl osmesa-compute; do
    size=192
    [ $context = osmesa ] || size=96 # the same walks again: a quarter of the rays
    say "$context, at length"
    "$build/hard" --context $context --long --size $size --table "$out/$context.md" --json "$out/$context.json"
    case $? in
    0) ;;
    77) say "$context is missing here" ;;
    *) status=1 ;;
    esac
done
say "reference"
"$build/hard" --context reference --size 128 --verified 1024 --table "$out/reference.md" --json "$out/reference.json" ||
    status=1

say "shaders broken on purpose"
sh "$here/broken.sh" "$build/hard" "$here/../../gpu/shaders" >"$out/broken.md" || [ $? -eq 77 ] || status=1
cat "$out/broken.md"

say "damaged files"
"$build/corrupt" "$build/tetcast" "$here/../../../shared/data" || [ $? -eq 77 ] || status=1

say "the window under random pointer and keys"
if cmake --build "$build" --target edit_random >/dev/null 2>&1; then
    whole=$(cd "$build" && pwd)
    TETCAST=$whole/tetcast TETCAST_HELPERS=$whole TC_BUILD=$whole TC_SOURCE=$(cd "$here/../.." && pwd) \
        TC_EDIT_EVENTS=20000 sh "$here/../cli/edit_random.sh" >"$out/window.txt" || [ $? -eq 77 ] || status=1
    cat "$out/window.txt"
else
    say "the window is not built here"
fi

say "beside VTK's renderers"
if "$build/hard" --context osmesa --export "$out/export"; then
    xvfb-run -a /usr/bin/python3 "$here/peers.py" "$out/export" --table "$out/peers.md" --json "$out/peers.json" ||
        status=1
else
    [ $? -eq 77 ] || status=1
fi
say "what exact signs cost"
sh "$here/cost.sh" "$build/tetcast" "$here/../../gpu/shaders" >"$out/cost.txt" || status=1
cat "$out/cost.txt"
say "tables are in $out"
exit $status
