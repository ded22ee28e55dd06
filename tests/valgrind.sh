#!/bin/sh
# valgrind.sh BUILD [NAME…]: memcheck (errors and leaks) of the unit tests and commands that use no GL; all, or only
# those named. Helper programs run as they are: they are mostly other people's libraries.
set -u
build=$(cd "$1" && pwd) || exit 1
shift
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
cd "$work" || exit 1
export TETCAST_HELPERS="$build" TC_VALGRIND=1
tetcast=$build/tetcast
failures=0
count=0
only=" $* "

# check NAME COMMAND…: the command must end with 0, and memcheck must find nothing.
check() {
    name=$1
    shift
    case $only in
    "  " | *" $name "*) ;;
    *) return ;;
    esac
    count=$((count + 1))
    start=$(date +%s)
    result=ok
    timeout 600 valgrind -q --error-exitcode=98 --leak-check=full --errors-for-leak-kinds=definite,indirect,possible \
        --num-callers=30 --child-silent-after-fork=yes --suppressions="$here/valgrind.supp" "$@" >out 2>&1 || {
        result=FAILED
        failures=$((failures + 1))
    }
    echo "$name: $result, $(($(date +%s) - start)) s"
    [ $result = ok ] || grep -v '^--[0-9]*--' out | tail -n 80 # without its talk of system calls that it does not know
}

for test in "$build"/tests/test_*; do
    name=$(basename "$test")
    case $name in
    # GL: Mesa makes code as it runs
    test_gpu_context | test_gpu_exact | test_gpu_program | test_gpu_signs | test_gpu_watch | test_study_run) ;;
    test_gpu_propose | test_synth_shapes | test_synth_defects) ;; # minutes here; make sanitize has them
    *) check "$name" "$test" ;;
    esac
done
check cli_parts "$build/tests/cli/test_cli_parts"
check synth "$tetcast" synth heatsink --cells 2000 -o sink.vtu
check info "$tetcast" info sink.vtu
check info_json "$tetcast" info --json sink.vtu --reentry peel
check render "$tetcast" render sink.vtu --driver reference --size 32x32 -o a.png --stats a.json --verify 64
check render_again "$tetcast" render synth:heatsink --driver reference --size 32x32 --color-map Turbo \
    --opacity 12:0.5,75:8 --azimuth 30 --background 1,1,1 -o b.png
check compare "$tetcast" compare a.png a.png
echo "$count programs, $failures failed"
[ $failures -eq 0 ]
