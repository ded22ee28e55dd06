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
finish
