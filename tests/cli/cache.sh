#!/bin/sh
# --cache: the same picture from the cache file as without, and never from one that does not fit.
. "$TC_SOURCE/tests/cli/lib.sh"

# draw NAME OPTION…: renders sink.vtu to NAME.exr and NAME.json.
draw() {
    name=$1
    shift
    run 0 render sink.vtu --size 48x48 --stats "$name.json" -o "$name.exr" "$@"
}
# same A B: the pictures are equal to the bit.
same() {
    run 0 compare "$1.exr" "$2.exr" --json
    json out eq max_abs 0
}
hit() { json "$1.json" eq cache.hit true ge cache.load_ms 0 lacks cache.save_ms lacks cache.why lacks time_ms.read \
    lacks time_ms.check lacks time_ms.order lacks time_ms.adjacency lacks time_ms.convexify has time_ms.frame; }
missed() { json "$1.json" eq cache.hit false lacks cache.load_ms has cache.save_ms has time_ms.read has time_ms.check; }

run 0 synth heatsink --cells 4000 -o sink.vtu
draw plain
json plain.json lacks cache
absent sink.vtu.tccache
draw first --cache
missed first
json first.json eq cache.file sink.vtu.tccache lacks cache.why
there sink.vtu.tccache
draw second --cache --verbose
says "came from sink.vtu.tccache"
hit second
same plain first
same plain second
for key in mesh.tets mesh.imaginary_tets march.steps march.rays; do
    last=${key#*.}
    [ "$(grep "\"$last\":" plain.json)" = "$(grep "\"$last\":" second.json)" ] || fail "$key differs"
done

# Another setting, another content, damage: read anew, and kept for the next time.
look() {
    name=$1
    shift
    run 0 info --json sink.vtu "$@"
    cp out "$name.json"
}
found() { json "$1.json" eq cache.hit true ge cache.load_ms 0 lacks cache.save_ms lacks time_ms.read lacks time_ms.check; }
read_anew() { json "$1.json" eq cache.hit false has cache.save_ms has cache.why has time_ms.read has time_ms.check; }
look heat --cache --field field
read_anew heat
look heat --cache --field field
found heat
json heat.json eq source.field field ge mesh.tets 1000 lacks source.helper_peak_bytes
run 0 info sink.vtu --cache --field field
cp out cached.txt
run 0 info sink.vtu --field field
diff out cached.txt >difference || fail "info differs with the cache: $(cat difference)"
look peel --cache --reentry peel
read_anew peel
json peel.json eq mesh.reentry peel
look again --cache
read_anew again
printf 'x' | dd of=sink.vtu.tccache bs=1 seek=5000 conv=notrunc 2>/dev/null
draw damaged --cache
json damaged.json eq cache.hit false has cache.why has time_ms.read
grep -q 'is damaged' damaged.json || fail "the reason is not said"
same plain damaged
dd if=sink.vtu.tccache of=short bs=1000 count=20 2>/dev/null
mv short sink.vtu.tccache
look short --cache
read_anew short
run 0 synth heatsink --cells 3000 -o sink.vtu
look other --cache
read_anew other
look kept --cache
found kept
[ "$(ls -A | grep -c '^\.tetcast-')" -eq 0 ] || fail "temporary files are left"

# Elsewhere: a file, or a folder with one for each setting.
rm sink.vtu.tccache
mkdir kept
look a --cache-file kept
look b --cache-file kept --reentry peel
look c --cache-file kept
found c
[ "$(ls kept | wc -l)" -eq 2 ] || fail "the folder holds $(ls kept)"
look d --cache-file one
look d --cache-file one
found d
absent sink.vtu.tccache

# Where it cannot be written the work is done, with one warning; no other file is written over.
look e --cache-file missing/one
one=$(grep -c 'no cache is written' err)
[ "$one" -eq 1 ] || fail "$one warnings"
json e.json lacks cache.save_ms
cp sink.vtu before.vtu
look f --cache-file sink.vtu
says "is no cache file"
cmp -s sink.vtu before.vtu || fail "the input was written over"
run 0 info synth:ball:500 --cache
says "synthetic"
absent synth:ball:500.tccache
run 1 info missing.vtu --cache
one_line

# Two at once.
"$TETCAST" info sink.vtu --cache --json >p.json &
"$TETCAST" info sink.vtu --cache --json >q.json
wait $! || fail "two at once: the other failed"
look last --cache
found last
finish
