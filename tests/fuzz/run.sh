#!/bin/sh
# run.sh FOLDER TARGET short|SECONDS: runs fuzz_TARGET of FOLDER on the corpus beside this script: `short` the corpus and a
# fixed number of inputs made from it with a fixed seed; SECONDS as long, on what earlier long runs have found, too.
# A crash leaves its input in FOLDER/crashes; when it is mended, the input goes into the corpus.
set -eu
build=$1 target=$2 length=$3
here=$(cd "$(dirname "$0")" && pwd)
program=$build/fuzz_$target

if [ ! -x "$program" ]; then
    echo "$program is not there: clang or its libFuzzer is missing; skipped (Debian: clang-14 libclang-rt-14-dev)"
    exit 77
fi
mkdir -p "$build/crashes" "$build/found/$target"
# Leaks are looked for at the end of a run; an input may take 10 s at most, and 2 GiB.
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=allocator_may_return_null=1
set -- -max_len=4096 -timeout=10 -rss_limit_mb=2048 -artifact_prefix="$build/crashes/$target-" -print_final_stats=1
[ ! -f "$here/$target.dict" ] || set -- "$@" -dict="$here/$target.dict"
if [ "$length" = short ]; then
    case $target in
    preset) runs=6000 ;;
    options) runs=8000 ;;
    mesh) runs=6000 ;;
    sniff) runs=6000 ;;
    split) runs=700 ;; # polyhedra take their time
    *) runs=6000 ;;
    esac
    new=$(mktemp -d)
    trap 'rm -rf "$new"' EXIT
    "$program" "$@" -seed=1 -runs=$runs "$new" "$here/corpus/$target" 2>"$new.log" || {
        cat "$new.log"
        rm -f "$new.log"
        exit 1
    }
else
    new=$build/found/$target
    "$program" "$@" -max_total_time="$length" -use_value_profile=1 "$new" "$here/corpus/$target" 2>"$build/$target.log" || {
        tail -60 "$build/$target.log"
        exit 1
    }
    cp "$build/$target.log" "$new.log"
fi
awk -v target="$target" '
    / cov: / { for (i = 1; i < NF; i++) { if ($i == "cov:") cov = $(i + 1); if ($i == "ft:") ft = $(i + 1) } }
    /number_of_executed_units/ { runs = $2 }
    /average_exec_per_sec/ { speed = $2 }
    END { printf "%-8s %9d inputs, %6d a second, %5d edges, %6d features\n", target, runs, speed, cov, ft }' "$new.log"
rm -f "$new.log"
