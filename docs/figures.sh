#!/bin/sh
# Makes the figures in docs/images again.   docs/figures.sh TETCAST
set -eu
tetcast=$1
cd "$(dirname "$0")/.."
images=docs/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$images"

"$tetcast" render synth:heatsink --size 1024x768 --azimuth 30 --elevation 28 --color-map Turbo --opacity 12:0.5,75:8 \
    --background 1,1,1 -o "$images/heatsink.png"

fin=../shared/data/bluntfin_tets.vtu # NASA's Blunt Fin, where it is at hand
if [ -f "$fin" ]; then
    "$tetcast" render "$fin" --field Density --size 1024x640 --azimuth 25 --elevation 35 --zoom 1.5 --color-map Inferno \
        --opacity 0.19:0,0.9:0.02,1.1:0.12,2:0.5,5:3 --background 1,1,1 -o "$images/bluntfin.png"
fi

# Flat cells, by exact signs and by the paper's own arithmetic, which loses rays and says so.
for stepper in signs planes; do
    "$tetcast" render synth:cap-1e8 --stepper $stepper --size 480x400 --azimuth 30 --elevation 20 --background 1,1,1 \
        --quiet -o "$images/cap-$stepper.png" || [ $stepper = planes ]
done

# Weiler et al. 2003, figure 8: fragments in each pass of the heat sink, one cell a pass.
curve() { # FILE OPTIONS…: one number a line
    file=$1
    shift
    "$tetcast" render synth:heatsink --size 512x512 --azimuth 30 --elevation 28 --color-map Turbo --opacity 12:0.5,75:8 \
        --steps-per-pass 1 --count --quiet --stats "$work/stats.json" -o "$work/picture.exr" "$@"
    tr -d ' \n' <"$work/stats.json" | sed 's/.*"fragments_per_pass":\[\([^]]*\)\].*/\1/' | tr , '\n' >"$work/$file"
}
curve all --z-update-every never --opacity-stop 1
curve locked --opacity-stop 1
curve stopped
gnuplot <<GNUPLOT
set terminal pngcairo size 900,540 font "sans,11"
set output "$images/fig8.png"
set title "Heat sink, 512x512, one cell a pass (after Weiler et al. 2003, figure 8)"
set xlabel "pass"
set ylabel "fragments"
set yrange [0:*]
set key center right
plot "$work/all" with lines lw 2 lc rgb "#c0392b" title "without early z", \\
     "$work/locked" with lines lw 2 lc rgb "#27ae60" title "early z", \\
     "$work/stopped" with lines lw 2 lc rgb "#2980b9" title "early z and early ray termination"
GNUPLOT
for file in all locked stopped; do
    awk -v name="$file" '{ n += $1 } END { printf "%-8s %d fragments in %d passes\n", name, n, NR }' "$work/$file"
done
