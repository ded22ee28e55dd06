#!/bin/sh
# cost.sh TETCAST SHADERS [RUNS]: what exact signs cost: frame times with them against plain float signs (variant.sh,
# float-signs), alternating, medians of RUNS (9) runs of 15 frames each. Real data where it is at hand, else synthetic. GL is
# whatever `tetcast render` finds in the environment: the figures are of that device.
set -eu
tetcast=$1 shaders=$2 runs=${3:-9}
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sh "$here/variant.sh" float-signs "$shaders" "$work/float"
mkdir "$work/exact"
real=$here/../../../shared/data/bluntfin_tets.vtu

# frame FOLDER OPTIONS...: median frame time in ms
frame() {
    TETCAST_SHADERS="$work/$1" "$tetcast" render "$2" --azimuth "$3" --repeat 15 --quiet --stats "$work/s.json" \
        -o "$work/x.png" 2>"$work/said" || return 0 # plain floats may lose rays
    sed -n 's/.*"frame": \([0-9.]*\).*/\1/p' "$work/s.json"
}

printf '%-28s %10s %10s %8s\n' "exact against float signs" "exact ms" "float ms" ratio
for input in "$real" synth:bluntfin synth:heatsink synth:kuhn; do
    case $input in synth:*) ;; *) [ -f "$input" ] || continue ;; esac
    for azimuth in 0 60; do
        : >"$work/exact.txt"
        : >"$work/float.txt"
        i=0
        while [ $i -lt "$runs" ]; do
            frame exact "$input" $azimuth >>"$work/exact.txt"
            frame float "$input" $azimuth >>"$work/float.txt"
            i=$((i + 1))
        done
        if [ ! -s "$work/exact.txt" ] || grep -q 'error: shader ' "$work/said"; then
            cat "$work/said" >&2
            exit 1
        fi
        if [ ! -s "$work/float.txt" ]; then
            printf '%-28s %s\n' "$(basename "$input") at $azimuth" "float: $(sed 's/.*error: //; s/;.*//' "$work/said")"
            continue
        fi
        paste "$work/exact.txt" "$work/float.txt" | awk -v name="$(basename "$input") at $azimuth" '
            { a[NR] = $1; b[NR] = $2; r[NR] = $1 / $2 }
            function median(x, n,   i, j, t) {
                for (i = 2; i <= n; i++) for (j = i; j > 1 && x[j] < x[j - 1]; j--) { t = x[j]; x[j] = x[j - 1]; x[j - 1] = t }
                return n % 2 ? x[(n + 1) / 2] : (x[n / 2] + x[n / 2 + 1]) / 2
            }
            END { printf "%-28s %10.2f %10.2f %8.3f\n", name, median(a, NR), median(b, NR), median(r, NR) }'
    done
done
