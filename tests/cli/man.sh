#!/bin/sh
# Every option of --help is in the command's manual page, and the page names no option that is not there.
. "$TC_SOURCE/tests/cli/lib.sh"
man=$TC_SOURCE/docs/man

options() { grep -oE -e '(^|[^-a-z])--[a-z][a-z-]*' | grep -oE -e '--[a-z][a-z-]*' | sort -u; }

for command in render study info compare synth backends; do
    page=$man/tetcast-$command.1
    [ -f "$page" ] || { fail "there is no $page"; continue; }
    run 0 $command --help
    options <out >help
    sed 's/\\-/-/g' "$page" | grep -v '^\.\\"' | options >page
    [ "$(wc -l <help)" -ge 4 ] || fail "--help lists no options"
    diff help page >difference || fail "tetcast-$command.1 and --help differ (< help, > page): $(cat difference)"
    grep -q "tetcast\\\\-$command\|tetcast-$command" "$man/tetcast.1" || fail "tetcast.1 does not name $command"
    # Every command's own options are paragraphs of the page, not only mentioned.
    while read -r option; do
        sed 's/\\-/-/g' "$page" | grep -qE -e "^\.(B|BR|BI|IP|OP).*$option" || fail "$option has no paragraph in $page"
    done <help
done
# Of commands that take the options of render, too, the page has their own.
run 0 render --help
options <out >render
for command in batch explain edit; do
    page=$man/tetcast-$command.1
    [ -f "$page" ] || { fail "there is no $page"; continue; }
    run 0 $command --help
    options <out >help
    comm -13 render help >own
    [ -s own ] || fail "--help of $command lists no options of its own"
    sed 's/\\-/-/g' "$page" | grep -v '^\.\\"' | options | comm -13 help - >unknown
    [ ! -s unknown ] || fail "tetcast-$command.1 names what is no option: $(cat unknown)"
    grep -q "tetcast\\\\-$command" "$man/tetcast.1" || fail "tetcast.1 does not name $command"
    while read -r option; do
        sed 's/\\-/-/g' "$page" | grep -qE -e "^\.(B|BR|BI|IP|OP).*$option" || fail "$option has no paragraph in $page"
    done <own
done
if command -v groff >/dev/null; then
    for page in "$man"/*.1; do
        groff -man -Tascii -ww "$page" >/dev/null 2>warnings
        [ ! -s warnings ] || fail "groff on $page: $(head -3 warnings)"
    done
fi
finish
