#!/bin/sh
# The window under pointer and keys that mean nothing, 300 events; TC_EDIT_EVENTS=20000 (make hard) for many, TC_EDIT_SEED
# for others. All is undone then, memory is looked at, nothing is complained of (tests/window/edit_random.c). And a
# window that is ended from outside says nothing.
. "$TC_SOURCE/tests/cli/edit_lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
random=$TC_BUILD/tests/window/edit_random
[ -x "$random" ] || skip "edit_random is not built"
cube two.vtk
display_open

# More than once: a window that ends while its picture is made ends as well.
for wait in 0 0.1 0.5; do
    window_open two.vtk --trace trace.json
    sleep $wait
    kill -TERM "$editor"
    wait "$editor"
    code=$?
    editor=
    [ $code -eq 0 ] || fail "exit code $code of a window that was ended"
    stderr_empty
    stdout_empty
    there trace.json
    rm -f trace.json
done

last="(edit_random)"
if [ "${TC_SANITIZE:-OFF}" = ON ]; then
    export LSAN_OPTIONS="$leaks" ASAN_OPTIONS="${ASAN_OPTIONS:-}:exitcode=99:log_path=$work/report"
fi
GSK_RENDERER=cairo "$random" two.vtk "${TC_EDIT_EVENTS:-300}" "${TC_EDIT_SEED:-1}" >out 2>err
code=$?
[ $code -eq 77 ] && skip "$(cat err)"
# The driver's 128 bytes, once, come from where no frame can be told, so that they cannot be suppressed.
if [ $code -eq 99 ] && [ "$(cat report* | grep -c 'ERROR:\|runtime error')" -eq 1 ] &&
    grep -q 'SUMMARY: AddressSanitizer: 128 byte(s) leaked in 1 allocation(s)' report*; then
    code=0
fi
[ -z "$(ls report* 2>/dev/null)" ] || [ $code -eq 0 ] || cat report*
[ $code -eq 0 ] || fail "exit code $code of edit_random: $(head -20 err)"
cat out
finish
