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
    # A warning that an allocation of a damaged file's size failed, as it is to, and no more.
    if ! grep -qvE 'WARNING: AddressSanitizer failed to allocate|^$' "$report"; then
        echo "left out: $(basename "$report"): $(cat "$report")"
        continue
    fi
    # Faults within TetGen and VTK are not ours: their process ends, which is told, or rays re-enter by peeling. Whose it is
    # says the first frame that is not the sanitizers' or the standard libraries' own.
    whose=$(grep -m 1 '^ *#[0-9]' <<END
$(grep -vE 'libsanitizer|libasan|libubsan|libstdc\+\+|libc\.so|sysdeps|/c\+\+/' "$report")
END
    ) || whose=
    case $whose in
    */libtet.* | */libtet-* | */libvtk*)
        echo "left out: $(basename "$report"): $whose"
        continue
        ;;
    esac
    echo "== $report"
    cat "$report"
    status=1
done
exit $status
