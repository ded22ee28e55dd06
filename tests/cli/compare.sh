#!/bin/sh
# compare: its exit codes, its figures, its thresholds.
. "$TC_SOURCE/tests/cli/lib.sh"
ball="synth:ball:500 --size 16x16 --driver reference --quiet"
run 0 render $ball -o a.exr
run 0 render $ball -o b.exr --unit-distance 0.01
run 0 render synth:ball:500 --size 16x8 --driver reference -o small.exr

run 0 compare a.exr a.exr
prints "same: max 0 "
stderr_empty
run 2 compare a.exr b.exr
prints "differ"
run 0 compare a.exr b.exr --warn 1 --fail 1
run 1 compare a.exr b.exr --warn 0 --fail 1
prints "warn"
run 3 compare a.exr small.exr
says "16x16"
says "16x8"
stdout_empty
run 4 compare a.exr missing.exr
says "missing.exr"
echo "no image" >text.png
run 4 compare a.exr text.png
says "text.png"
stdout_empty

run 2 compare a.exr b.exr --json
cp out d.json
json d.json eq verdict differ ge max_abs 0.01 ge mean_abs 0.0001 ge differing 1 eq pixels 256 ge covered 1 le covered 256 \
    has p999_abs has rms size worst 2 eq nonfinite 0
run 0 compare a.exr a.exr --json
cp out d.json
json d.json eq verdict same eq max_abs 0 eq mean_abs 0 eq differing 0

# What was written comes back, to the steps of the format.
for extension in png tif exr; do
    run 0 render $ball -o c.$extension
    run 0 compare a.exr c.$extension
done
finish
