#!/bin/sh
# batch --memory: what cannot be done within it is refused in a sentence that says what it takes; with as much as that the run
# stays below, and its pictures are the same.
. "$TC_SOURCE/tests/cli/lib.sh"
[ "$TC_SANITIZE" = ON ] && finish # a sanitizer's own memory would be counted
printf '{"data": "synth:ball:3000", "views": {"orbit": 5}, "output": {"size": [1600, 1200]}}' >s.json
stays() { # stays EXTENSION
    run 1 batch s.json --quiet --memory 50M -o "no/{phi}.$1"
    one_line
    says "--memory is 50 MiB: allow more"
    [ -z "$(find no -type f 2>/dev/null)" ] || fail "pictures are made beyond --memory"
    most=$(grep -o 'take [0-9]* MiB' err | grep -o '[0-9]*')
    run 0 batch s.json --json --memory "${most}M" -o "bound/{phi}.$1"
    tail -1 out >line.json
    json line.json eq done 5 eq failed 0
    peak=$(($(grep -oE '"(helper_)?peak_bytes":[0-9]*' line.json | cut -d: -f2 | paste -sd+)))
    [ "$peak" -le $((most * 1048576)) ] || fail "$((peak >> 20)) MiB are taken, of $most MiB"
}
stays png
run 0 batch s.json --quiet -o "free/{phi}.png"
diff -r bound free >why || fail "with --memory pictures are others: $(head -1 why)"
stays tif # which a helper program writes
finish
