# lib.sh: what the tests of the program share. From ctest: TETCAST (program), TC_SOURCE, TC_BUILD, TC_JSON (json_check),
# TC_PIXELS (png_pixels), TC_CINEMA (cinema_check).
set -u
here=$TC_SOURCE/tests/cli
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
cd "$work" || exit 1
failures=0
last=

fail() {
    failures=$((failures + 1))
    echo "FAIL: $* (after: tetcast $last)"
    [ -f err ] && sed 's/^/    stderr: /' err | head -5
}

# run CODE ARGUMENT…: runs the program, its output in files out and err; the exit code must be CODE.
run() {
    want=$1
    shift
    last=$*
    "$TETCAST" "$@" >out 2>err </dev/null
    got=$?
    [ $got -eq "$want" ] || fail "exit code $got instead of $want"
}

says() { grep -qF -e "$1" err || fail "stderr does not say '$1'"; }
says_not() { ! grep -qF -e "$1" err || fail "stderr says '$1'"; }
prints() { grep -qF -e "$1" out || fail "stdout does not contain '$1'"; }
stdout_empty() { [ ! -s out ] || fail "stdout is not empty"; }
stderr_empty() { [ ! -s err ] || fail "stderr is not empty"; }
one_line() { [ "$(wc -l <err)" -eq 1 ] || fail "stderr has $(wc -l <err) lines instead of one sentence"; }
there() { [ -s "$1" ] || fail "$1 was not written"; }
absent() { [ ! -e "$1" ] || fail "$1 is there"; }
# json FILE CHECK…: see json_check.c
json() { "$TC_JSON" "$@" >why || { fail "$*: $(cat why)"; }; }
# Do two PNG files have the same pixels, to the last bit?
same_pixels() { [ "$("$TC_PIXELS" "$1")" = "$("$TC_PIXELS" "$2")" ] || fail "$1 and $2 differ"; }
other_pixels() { [ "$("$TC_PIXELS" "$1")" != "$("$TC_PIXELS" "$2")" ] || fail "$1 and $2 are one picture"; }

finish() {
    [ $failures -eq 0 ] || { echo "$failures checks failed"; exit 1; }
    echo "all checks passed"
    exit 0
}
