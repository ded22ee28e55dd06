#!/bin/sh
# The program and the library are linked to none of the libraries that belong into helper programs.
. "$TC_SOURCE/tests/cli/lib.sh"
for file in "$TETCAST" "$TC_BUILD/libtetcast.so"; do
    ldd "$file" >libraries || fail "ldd $file"
    ! grep -iE 'libvtk|libtet\.|libtet1|OpenImageIO|libGL|libOSMesa|libEGL' libraries || fail "$file links them"
    [ "$(wc -l <libraries)" -le 16 ] || fail "$file needs $(wc -l <libraries) libraries: starting gets slow"
done
for helper in tetcast-read tetcast-convexify tetcast-image; do
    [ -x "$TC_BUILD/$helper" ] || fail "$helper was not built"
done

# Formats that need many libraries are read by a module, which is loaded when one is called for.
ldd "$TC_BUILD/tetcast-read" >libraries || fail "ldd tetcast-read"
! grep -iE 'hdf5|netcdf|libmpi|libcurl|libssl' libraries || fail "tetcast-read links them"
mkdir alone
cp "$TC_BUILD/tetcast-read" alone
printf 'FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\n' >a.case
TETCAST_HELPERS=$work/alone
export TETCAST_HELPERS
run 0 synth ball --cells 300 -o a.vtu
run 0 info a.vtu
run 1 info a.case
says "a.case"
says "alone/tetcast-read-more.so"
one_line
finish
