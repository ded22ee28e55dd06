#!/bin/sh
# sanitize.sh BUILD JOBS: all tests of a build with sanitizers (TC_SANITIZE). Fails when a test fails, or when any program,
# a helper program too, was reported by a sanitizer.
set -eu
build=$1
jobs=$2
rm -rf "$build/reports"
mkdir -p "$build/reports"
status=0
(cd "$build" && ctest --output-on-failure -j "$jobs") || status=$?
for report in "$build"/reports/*; do
    [ -e "$report" ] || continue
    # Code of TetGen's own, which may crash on a boundary (its process ends, and rays re-enter by peeling), is not ours.
    if grep -q 'libtet[-0-9.]*so' "$report"; then
        echo "left out, TetGen's: $report"
        continue
    fi
    echo "== $report"
    cat "$report"
    status=1
done
exit $status
