#!/bin/sh
# broken.sh HARD SHADERS [VARIANT...] [-- OPTIONS]: the catalogue against shaders that are broken on purpose (variant.sh):
# each must fail. One row a variant: cases that failed, by what was noticed first in each, and some of their meshes.
# OPTIONS go to hard (--filter TEXT, --size N, …). Exit 0: every variant was caught; 1: one was not.
set -eu
hard=$1 shaders=$2
shift 2
here=$(dirname "$0")
variants=
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    variants="$variants $1"
    shift
done
[ $# -gt 0 ] && shift
: "${variants:=float-signs no-ties ids-only float-weights eye-origin peel-exit}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

missed=0
printf '| variant | cases failed | rays lost | faces that hold | other cells | lengths | pictures | meshes |\n'
printf '|---|--:|--:|--:|--:|--:|--:|---|\n'
for variant in $variants; do
    sh "$here/variant.sh" "$variant" "$shaders" "$work/$variant"
    code=0
    # Weights matter where faces are passed nearly in their plane, which the short run has too few of.
    if [ $# -eq 0 ] && [ "$variant" = float-weights ]; then
        TETCAST_SHADERS=$work/$variant "$hard" --context osmesa --long --size 96 --filter "grazing planes" \
            >"$work/said" 2>&1 || code=$?
    else
        TETCAST_SHADERS=$work/$variant "$hard" --context osmesa "$@" >"$work/said" 2>&1 || code=$?
    fi
    case $code in
    1) ;;
    77) exit 77 ;;
    *)
        missed=1
        echo "broken.sh: $variant is not caught (hard ended with $code)" >&2
        tail -n 3 "$work/said" >&2
        ;;
    esac
    awk -v variant="$variant" '
        /^FAILED [^0-9]/ {
            failed++
            lost += /rays were lost/
            held += /other than two faces/
            cells += /other cells|brute force/
            lengths += /length/
            pictures += /pixel|alpha/
            sub(/^FAILED /, "")
            split($0, part, ";")
            if (!(part[1] in seen) && n++ < 6)
                names = names (names == "" ? "" : ", ") part[1]
            seen[part[1]] = 1
        }
        END {
            printf "| %s | %d | %d | %d | %d | %d | %d | %s%s |\n", variant, failed, lost, held, cells, lengths, pictures,
                names, (n > 6 ? " and " (n - 6) " more" : "")
        }' "$work/said"
done
exit $missed
