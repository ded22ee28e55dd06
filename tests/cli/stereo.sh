#!/bin/sh
# Pictures for two eyes: names, sizes, which eye is where, metadata that make them again.
. "$TC_SOURCE/tests/cli/lib.sh"
sink="synth:heatsink:3000 --size 80x60 --azimuth 30 --elevation 20 --quiet"

# shellcheck disable=SC2086
{
run 0 render $sink --stereo pair --eye-angle 6 -o pair.png
absent pair.png
there pair_left.png
there pair_right.png
other_pixels pair_left.png pair_right.png
mkdir left right
run 0 render $sink --stereo pair --eye-angle 6 -o "{eye}/of.png"
same_pixels left/of.png pair_left.png
same_pixels right/of.png pair_right.png
for kind in side-by-side top-bottom anaglyph; do
    run 0 render $sink --stereo $kind --eye-angle 6 -o $kind.png --stats $kind.json
    run 0 render $kind.png -o again.png --quiet
    same_pixels $kind.png again.png
done
json side-by-side.json eq image.width 160 eq image.height 60
json top-bottom.json eq image.width 80 eq image.height 120
json anaglyph.json eq image.width 80 eq image.height 60
run 0 render pair_left.png -o again.png --quiet
same_pixels pair_left.png again.png
# Eyes at one place see what one camera sees.
run 0 render $sink -o mono.png
run 0 render $sink --stereo anaglyph --eye-angle 1e-9 -o none.png
run 0 compare mono.png none.png --quiet
run 0 render $sink --stereo none -o none.png
same_pixels mono.png none.png
}
# A picture of a pair is its camera's, whose window centre can be given.
grep -a -q '"window_center":\[0\.' pair_left.png || fail "the left picture does not say its window centre"
grep -a -q '"window_center":\[-0\.' pair_right.png || fail "the right picture does not say its window centre"
# shellcheck disable=SC2086
run 0 render $sink --window-center 0.3,-0.2 -o moved.png
other_pixels moved.png mono.png
run 0 render moved.png --window-center 0,0 -o back.png --quiet
same_pixels back.png mono.png
# shellcheck disable=SC2086
run 0 render $sink --window-center 3,0 -o aside.png
says "lies outside the view"

run 2 render synth:kuhn --stereo pair -o -
says "--stereo pair makes two"
run 2 render synth:kuhn --stereo pair --verify 10 -o a.png
says "leave one of them out"
run 2 render synth:kuhn --stereo pair -o a.png --stats a_left.png
says "a_left.png is the file of --stats"
run 2 render synth:kuhn --stereo red -o a.png
finish
