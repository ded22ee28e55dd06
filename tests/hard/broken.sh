#!/bin/sh
# broken.sh HARD SHADERS [VARIANT...] [-- OPTIONS]: the catalogue against shaders broken on purpose (variant.sh):
# each must fail. One row a variant: how many cases failed; of these, in how many the renderer reported lost rays, or
# cells of which other than two faces hold the ray; a ray did not visit the cells of brute force; a ray's length in the
# mesh was wrong; a pixel was wrong (by the reference, an analytic chord, its own range, or beside another picture of the
# same thing). A case counts in each column that it belongs to. Last, some of the meshes.
# OPTIONS go to hard (--filter TEXT, --size N, …). Exit 0: every variant was caught, by one of these at least; 1: one was
# not, or its shaders do not compile; 77: the context is missing.
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
    # A shader that does not compile fails every case, and shows nothing.
    if grep -Eq 'shader [a-z_]+[.][a-z]+:|linking [a-z_]+[.]vert and ' "$work/said"; then
        missed=1
        echo "broken.sh: $variant does not compile" >&2
        grep -Em 1 'shader |linking ' "$work/said" >&2
        continue
    fi
    awk -v variant="$variant" '
        /^FAILED [^0-9]/ {
            failed++
            lost += /rays were lost/
            held += /other than two faces held/
            cells += /do not visit the cells of brute force|visit other cells than/
            lengths += /a ray.s length in real cells is|a ray.s length is wrong/
            pictures += /pixel [0-9]+, [0-9]+ is|alpha is|pixels differ|colour exceeds/
            sub(/^FAILED /, "")
            split($0, part, ";")
            if (!(part[1] in seen) && n++ < 6)
                names = names (names == "" ? "" : ", ") part[1]
            seen[part[1]] = 1
        }
        END {
            printf "| %s | %d | %d | %d | %d | %d | %d | %s%s |\n", variant, failed, lost, held, cells, lengths, pictures,
                names, (n > 6 ? " and " (n - 6) " more" : "")
            exit !(lost + held + cells + lengths + pictures)
        }' "$work/said" || {
        missed=1
        echo "broken.sh: $variant is not caught: no case failed for one of these reasons" >&2
    }
done
exit $missed
