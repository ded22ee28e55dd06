#!/bin/sh
# An installed tree works wherever it is moved: the program finds library and helpers, and a C program builds
# against it with pkg-config and with CMake.
. "$TC_SOURCE/tests/cli/lib.sh"
unset TETCAST_HELPERS
DESTDIR=$work/stage cmake --install "$TC_BUILD" >log 2>&1 || { cat log; fail "cmake --install"; finish; }
installed=$(find stage -name tetcast -path '*/bin/tetcast' | head -1)
[ -n "$installed" ] || { fail "no program was installed"; finish; }
mv "${installed%/bin/tetcast}" moved
TETCAST=$work/moved/bin/tetcast

run 0 --version
run 0 synth heatsink --cells 2000 -o sink.vtu
run 0 render sink.vtu --size 16x16 --reentry convexify -o a.exr # needs all three helpers
there a.exr
printf 'FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\n' >a.case # needs the module beside tetcast-read
run 1 info a.case
says "a.case"
says_not "cannot be loaded"
if [ -x "$TC_BUILD/tetcast-edit" ]; then
    (unset DISPLAY WAYLAND_DISPLAY; "$TETCAST" edit sink.vtu) >out 2>err && fail "a window without a display"
    says "there is no display" # and not: there is no tetcast-edit
    ldd moved/libexec/tetcast/tetcast-edit | grep -q "libtetcast.*=> $work/moved/" || fail "tetcast-edit has another library"
fi

if [ "${TC_SANITIZE:-OFF}" = ON ]; then
    echo "sanitizers: a plain C program cannot load the library first; that part is left out"
    finish
fi
pc=$(find moved -name tetcast.pc | head -1)
[ -n "$pc" ] || { fail "no tetcast.pc was installed"; finish; }
export PKG_CONFIG_PATH="$work/${pc%/tetcast.pc}"
[ "$(pkg-config --modversion tetcast)" = "$("$TETCAST" --version | sed 's/tetcast //')" ] || fail "version of tetcast.pc"
libdir=$(pkg-config --variable=libdir tetcast)
cc -std=c11 -Wall -Wextra -Werror "$here/client.c" -o client $(pkg-config --cflags --libs tetcast) \
    -Wl,-rpath,"$libdir" 2>log || { cat log; fail "the client does not build with pkg-config"; }
./client >log 2>&1 || fail "the client fails: $(cat log)"

mkdir project
cp "$here/client.c" project/
cat >project/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.20)
project(client C)
find_package(tetcast 0.1 REQUIRED)
add_executable(client client.c)
target_link_libraries(client tetcast::tetcast)
END
{ cmake -S project -B project/build -DCMAKE_PREFIX_PATH="$work/moved" && cmake --build project/build; } >log 2>&1 ||
    { tail -5 log; fail "the client does not build with CMake"; }
project/build/client >log 2>&1 || fail "the client built by CMake fails: $(cat log)"
finish
