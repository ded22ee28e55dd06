#!/bin/sh
# build.sh FOLDER: builds the fuzz targets with clang into FOLDER; without clang it says so and leaves them out.
set -eu
build=$1
source=$(cd "$(dirname "$0")/../.." && pwd)

for version in '' -19 -18 -17 -16 -15 -14; do
    c=$(command -v "clang$version" || true)
    cxx=$(command -v "clang++$version" || true)
    [ -z "$c" ] || [ -z "$cxx" ] || break
done
if [ -z "$c" ] || [ -z "$cxx" ]; then
    echo "no clang is there, so the fuzz targets are not built (Debian: clang-14 libclang-rt-14-dev)"
    exit 0
fi
trap 'rm -f "$build/probe" "$build/probe.c"' EXIT
mkdir -p "$build"
echo 'int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n) { return d && n ? 0 : 0; }' >"$build/probe.c"
if ! "$c" -fsanitize=fuzzer,address,undefined -o "$build/probe" "$build/probe.c" >/dev/null 2>&1; then
    echo "$c has no libFuzzer, so the fuzz targets are not built (Debian: libclang-rt-14-dev)"
    exit 0
fi
# Configured again when WERROR is another than the last time.
if [ ! -f "$build/build.ninja" ] || ! grep -q "^TC_WERROR:[A-Z]*=${WERROR:-OFF}\$" "$build/CMakeCache.txt"; then
    cmake -S "$source" -B "$build" -G Ninja -DTC_FUZZ=ON -DTC_WERROR="${WERROR:-OFF}" -DCMAKE_BUILD_TYPE=None \
        -DCMAKE_C_COMPILER="$c" -DCMAKE_CXX_COMPILER="$cxx" >"$build/configure.log" 2>&1 || {
        cat "$build/configure.log"
        exit 1
    }
fi
cmake --build "$build" -- --quiet
