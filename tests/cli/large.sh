#!/bin/sh
# Pictures that are made in bands are those that are made at once, whatever is drawn around them; what cannot be made in bands
# is refused.
. "$TC_SOURCE/tests/cli/lib.sh"
ball=synth:ball:3000

# --repeat asks for the picture at once. Two bands, with letters and lines across where they meet.
set -- $ball --size 1500x1500 --azimuth 30 --elevation 20 --outline --axes --triad --color-bar --title Bands
run 0 render "$@" -o bands.png --background 0.1,0.1,0.2 --stats bands.json
run 0 render "$@" -o whole.png --background 0.1,0.1,0.2 --stats whole.json --repeat 1
same_pixels bands.png whole.png
for key in rays rays_lost steps steps_max; do
    a=$(grep -o "\"$key\": [0-9]*" bands.json) b=$(grep -o "\"$key\": [0-9]*" whole.json)
    [ -n "$a" ] && [ "$a" = "$b" ] || fail "$key of bands is $a, of the whole $b"
done
json bands.json eq image.width 1500 eq image.height 1500
run 0 render "$@" -o bands.exr --quiet
run 0 render "$@" -o whole.exr --repeat 1 --quiet
run 0 compare bands.exr whole.exr --quiet
run 0 render bands.png -o again.png --quiet
same_pixels bands.png again.png
# Rows and columns that bands and tiles do not divide: no row is there twice, none is left out.
run 0 render $ball --size 1501x2803 --axes --quiet -o odd.png
run 0 render $ball --size 1501x2803 --axes --quiet -o odd_whole.png --repeat 1
same_pixels odd.png odd_whole.png
run 0 render $ball --size 16411x131 --quiet -o odd.png
run 0 render $ball --size 16411x131 --quiet -o odd_counted.png --stats odd.json
same_pixels odd.png odd_counted.png
# The rays' state is there once, also where the last band is smaller (twice it takes 500 MB).
run 0 batch $ball --size 4100x4102 --json -o "{frame}.png"
tail -1 out >line.json
[ "$TC_SANITIZE" = ON ] || json line.json le peak_bytes 430e6
# To stdout, transparent; as said by the words of a picture that is made at once.
run 0 render $ball --size 1500x1500 -o - --quiet
mv out stdout.png
run 0 render $ball --size 1500x1500 -o at_once.png --repeat 1 --quiet
same_pixels stdout.png at_once.png

# Wider than a texture: tiles beside each other. The mirrored view is the mirrored picture, if no tile is out of place.
run 0 render synth:kuhn --size 20000x4 --parallel-scale 0.0002 -o wide.png --stats wide.json
json wide.json eq image.width 20000 eq image.height 4
run 0 render synth:kuhn --size 20000x4 --parallel-scale 0.0002 -o reference.png --driver reference --quiet
run 0 compare wide.png reference.png --quiet
run 0 render synth:kuhn --size 4x20000 --view-angle 170 -o high.jpg --quiet
there high.jpg

run 0 render $ball --size 1500x1500 --opacity 0:0,1:0 -o empty.png
says "the picture is empty"
[ "$(grep -c "is empty" err)" -eq 1 ] || fail "it is said more than once"
# Rays that the paper's arithmetic loses are counted over all bands, and the picture is there all the same.
run 1 render synth:cap-1e8 --size 1500x1500 --stepper planes -o planes.png --stats planes.json
lost=$(grep -o '"rays_lost": [0-9]*' planes.json | grep -o '[0-9]*')
says "$lost of "
there planes.png
finish
