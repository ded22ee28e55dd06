#!/bin/sh
# --error and --frame-time: what is promised holds in all pixels, is measured once, and is said.
. "$TC_SOURCE/tests/cli/lib.sh"
TETCAST_CACHE=$work/cache
export TETCAST_CACHE
heat="synth:heatsink:4000 --size 96x64"
steps="--opacity 0:0,0.4:0,0.4:6,0.6:6,0.6:0.2,1:0.2 --range 0,1"

# The error of the picture that was written, over all of its pixels, is below the one that was asked for.
for error in 0.01 0.002 0.0005; do
    run 0 render $heat -o a.exr --error $error --stats s.json
    stdout_empty
    says "error $error: "
    says "ms a frame"
    json s.json eq choice.asked_error $error has choice.setting has choice.why le choice.error $error \
        ge choice.tried 1 has choice.frame_ms ge choice.calibration_rays 10000 ge choice.candidates 40 \
        eq verify.pixels 4096 le verify.max_abs_error $error
    run 0 render $heat -o b.exr --error $error --stats all.json --verify 6144
    json all.json eq verify.pixels 6144 le verify.max_abs_error $error eq choice.cached true
    run 0 render synth:ball:3000 --size 64x64 $steps --azimuth 20 -o c.exr --error $error --stats ball.json --verify 4096
    json ball.json eq verify.pixels 4096 le verify.max_abs_error $error
done

# The first run measured, all others knew.
rm -r cache
run 0 render $heat -o a.exr --error 0.01 --stats s.json --verbose
says "calibration kept in $work/cache/"
json s.json eq choice.cached false
run 0 render $heat -o a.exr --error 0.01 --stats s.json --verbose
says "calibration taken from $work/cache/"
json s.json eq choice.cached true
run 0 render $heat -o a.exr --error 0.01 --stats s.json --azimuth 50 # another view of the same
json s.json eq choice.cached true
run 0 render $heat -o a.exr --error 0.01 --stats s.json --color-map Viridis # another function
json s.json eq choice.cached false
for cached in false true; do # another driver, with times of its own
    run 0 render $heat -o a.exr --error 0.01 --stats s.json --driver compute
    json s.json eq choice.cached $cached eq march.driver compute
done
run 0 render $heat -o a.exr --error 0.01 --stats s.json --no-cache
json s.json eq choice.cached false

# A damaged file is ignored, and mended.
for file in cache/*.json; do
    echo '{"key": "' >"$file"
done
run 0 render $heat -o a.exr --error 0.01 --stats s.json --verbose
says "is ignored"
json s.json eq choice.cached false
run 0 render $heat -o a.exr --error 0.01 --stats s.json
json s.json eq choice.cached true

# Nowhere to keep it is no error.
TETCAST_CACHE=/dev/null/cache
run 0 render $heat -o a.exr --error 0.01 --stats s.json
says_not warning
json s.json eq choice.cached false
unset TETCAST_CACHE
home=${HOME:-/}
unset HOME XDG_CACHE_HOME
run 0 render $heat -o a.exr --error 0.01 --stats s.json
says_not warning
HOME=$home
TETCAST_CACHE=$work/cache
export HOME TETCAST_CACHE

# What cannot be reached is said in one sentence with what can; nothing is written.
rm -f a.exr s.json
run 1 render $heat -o a.exr --error 1e-9 --stats s.json --quiet
one_line
says "no setting reaches an error of 1e-09 here: the least is "
says "ms a frame"
absent a.exr
absent s.json
run 1 render $heat -o a.exr --error 1e-4 --integrator table --table-format 8 --quiet
one_line
says "that keeps what was given"
says "bits a channel"
absent a.exr

# What is given stays.
run 0 render $heat -o a.exr --error 0.2 --integrator table --table-size 64,64,64 --opacity-stop 0.97 --stats s.json
says "table of 64x64x64"
says "opacity stop 0.97"
json s.json eq march.integrator table le verify.max_abs_error 0.2

# Time: the most accurate that fits, here all do; the fastest with a warning where none does.
run 0 render $heat -o a.exr --frame-time 1e6 --stats s.json
json s.json eq choice.in_time true le choice.error 0.0001
run 0 render $heat -o a.exr --time 1000000ms --stats t.json
json t.json eq choice.asked_frame_ms 1000000 eq choice.cached true
run 0 render $heat -o a.exr --frame-time 0.0001 --stats s.json
says "warning: no setting makes a frame within 0.0001 ms: the fastest takes "
says "a smaller picture"
json s.json eq choice.in_time false
there a.exr

# Both: the error is kept.
run 0 render $heat -o a.exr --error 0.002 --frame-time 1e6 --stats s.json
says_not warning
json s.json eq choice.in_time true le choice.error 0.002
run 0 render $heat -o a.exr --error 0.002 --frame-time 0.0001 --stats s.json
says "warning: an error of 0.002 takes "
json s.json eq choice.in_time false le choice.error 0.002

# The reference has nothing to choose, and is checked.
run 0 render $heat -o a.exr --error 0.001 --driver reference --stats s.json
json s.json le choice.error 1e-6 lacks choice.cached
run 1 render $heat -o a.exr --error 1e-12 --driver reference

# Wrong words.
run 2 render $heat --error 0
run 2 render $heat --error 2
run 2 render $heat --frame-time -3
run 2 render $heat --time 0ms
run 2 render $heat --time ms
run 2 render $heat --error 0.1 --stepper planes
run 0 render $heat --time 3 -o a.exr # the time of the data, as before
finish
