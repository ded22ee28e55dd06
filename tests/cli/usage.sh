#!/bin/sh
# Wrong command lines: exit code 2, one sentence on stderr that names the remedy, nothing on stdout.
. "$TC_SOURCE/tests/cli/lib.sh"

wrong() { # wrong TEXT ARGUMENT…
    text=$1
    shift
    run 2 "$@"
    says "$text"
    stdout_empty
}

wrong "Usage: tetcast COMMAND"
for case in \
    "the nearest is 'render'|rendr" \
    "the nearest is 'compare'|comprae" \
    "the nearest is 'backends'|backend" \
    "no option '--bogus' before the command|--bogus render" \
    "render needs INPUT|render" \
    "so 'b' is one too many|render a b" \
    "the nearest is '--field'|render a --feild x" \
    "the nearest is '--opacity-stop'|render a --opacity-stpo 1" \
    "no option '-z'|render a -z" \
    "the nearest is '--json'|info a --jsno" \
    "--field needs a value|render a --field" \
    "--field needs a value|render a --field --size 3x3" \
    "--cell-data takes no value|render a --cell-data=1" \
    "--size takes WxH, not '3'|render a --size 3" \
    "--size takes WxH, not '3x'|render a --size 3x" \
    "--size takes WxH, not '-3x4'|render a --size=-3x4" \
    "from 1 to 32768|render a --size 0x4" \
    "from 1 to 32768|render a --size 32769x4" \
    "each from 0 to 1|render a --background 255,255,255" \
    "--background takes|render a --background 1,1" \
    "--camera-position takes X,Y,Z, not '1,2'|render a --camera-position 1,2" \
    "--camera-position takes X,Y,Z, not '1,2,nan'|render a --camera-position 1,2,nan" \
    "above 0|render a --view-angle 0" \
    "above 0|render a --zoom 0" \
    "above 0|render a --unit-distance -1" \
    "LO below HI|render a --range 2,1" \
    "LO below HI|render a --range 1,1" \
    "not 0,0,0|render a --view-up 0,0,0" \
    "no direction to look|render a --camera-position 1,2,3 --focal-point 1,2,3" \
    "exclude each other|render a --time 1 --step 2" \
    "exclude each other|render a --cell-data --point-data" \
    "the nearest is 'table'|render a --integrator tabel" \
    "the nearest is 'osmesa'|render a --gl mesa" \
    "the nearest is 'planes'|render a --stepper plane" \
    "--driver reference does not|render a --stepper planes --driver reference" \
    "--stepper planes does not|render a --stepper planes --audit" \
    "--driver reference does not do|render a --audit --driver reference" \
    "one ray a pixel|render a --audit --samples 4" \
    "--samples takes 1|render a --samples 2" \
    "--state-format takes auto|render a --state-format 8" \
    "the nearest is 'convexify'|render a --reentry convex" \
    "each from 2 to 1024|render a --table-size 1,128,256" \
    "--table-size takes|render a --table-size 128,128" \
    "from 2 to 1024|render a --table-size 2048,2,2" \
    "--verify needs the picture at once|render a --size 32768x32768 --verify 10" \
    "each from 1 to 32768|render a --size 40000x2" \
    "--stereo makes two|render a --stereo anaglyph --verify 10" \
    "40000x10 pixels|render a --stereo side-by-side --size 20000x10" \
    "are one file|render a -o a.png --stats a.png" \
    "would be written over|render a --stats a" \
    "at most 1|render a --opacity-stop 1.5" \
    "--steps-per-pass takes K|render a --steps-per-pass 0" \
    "--repeat takes N|render a --repeat 0" \
    "--verify takes N|render a --verify -5" \
    "--threads takes N|render a --threads 0" \
    "--step takes N|render a --step 1.5" \
    "give the file with --color-map|render a --preset x" \
    "the extension tells the format|render a -o a.bmp" \
    "the extension tells the format|render a -o png" \
    "both want stdout|render a -o - --stats -" \
    "--output - and --error-image - both want stdout|render a -o - --error-image -" \
    "--error-image - and --stats - both want stdout|render a --error-image - --stats -" \
    "--output and --error-image are one file, a.png|render a -o a.png --error-image a.png" \
    "--error-image and --stats are one file, e.png|render a --error-image e.png --stats e.png" \
    "a is the input and would be written over: give --error-image another name|render a --error-image a" \
    "e.bmp: the extension tells the format|render a --error-image e.bmp" \
    "--shell is not in this version|render a --shell x" \
    "the nearest is 'heatsink'|render synth:heatsnk" \
    "the number of cells|render synth:ball:many" \
    "the number of cells|render synth:ball:0" \
    "compare needs A B|compare a" \
    "must not be above|compare a b --warn 1 --fail 0.5" \
    "needs the name of a dataset|synth" \
    "the nearest is 'ball'|synth bal -o a.vtu" \
    "-o ball.vtu|synth ball" \
    "must end in .vtu|synth ball -o ball.vtk" \
    "--cells takes N|synth ball -o ball.vtu --cells 0" \
    "takes no arguments|backends now"; do
    # shellcheck disable=SC2086 # the words of the case are the arguments
    wrong "${case%%|*}" ${case##*|}
    one_line
done
[ -z "$(ls -A | grep -v -x -e out -e err)" ] || fail "a wrong command line left files behind: $(ls -A)"
finish
