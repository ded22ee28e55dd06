#!/bin/sh
# --help and --version: on stdout, exit code 0, for every command, whatever else is on the line; NO_COLOR and pipes.
. "$TC_SOURCE/tests/cli/lib.sh"

run 0 --help
prints "Usage: tetcast COMMAND"
stderr_empty
for command in render edit explain study info compare synth backends; do
    run 0 --help
    prints "  $command "
    run 0 $command --help
    prints "Usage: tetcast $command"
    prints "--verbose"
    stderr_empty
    run 0 $command -h --no-such-option
    run 0 help $command
    prints "Usage: tetcast $command"
    run 0 $command --version
    prints "tetcast "
    awk 'length($0) > 140 { exit 1 }' out || fail "a line of the help is too long"
done
for later in texture; do
    run 0 --help
    ! grep -q "^  $later " out || fail "$later is listed, but is not there"
    run 2 $later
done
run 0 --version
version=$(sed -n 's/^#define TC_VERSION_STRING "\(.*\)"/\1/p' "$TC_SOURCE/src/tetcast.h")
[ "$(cat out)" = "tetcast $version" ] || fail "the version is not that of tetcast.h"
run 2 help nonsense

# No escape codes where stderr is no terminal.
run 1 render no-such-file.vtu
! grep -q "$(printf '\033')" err || fail "escape codes in a pipe"

# A full device is an error, not silence.
if [ -w /dev/full ]; then
    "$TETCAST" --help >/dev/full 2>err
    [ $? -eq 1 ] || fail "a full stdout goes unnoticed"
    says "stdout could not be written"
fi
finish
