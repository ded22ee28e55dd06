#!/bin/sh
# `tetcast study`: a small one gives tables, JSON and plots; it goes on where it stopped; other requests are refused.
. "$TC_SOURCE/tests/cli/lib.sh"
small="synth:kuhn:300 --size 32x32 --views 2 --frames 2 --functions smooth,steps"

columns() { awk -F, 'NR == 1 { n = NF } NF != n { exit 1 } END { exit !(NR > 1) }' "$1" || fail "$1 is no table"; }

run 0 study $small --knobs integrator,table8-32x32,table8-64x64,samples,reentry,figure -o s
stdout_empty
for file in results.csv summary.csv rotation.csv study.json study.key; do there s/$file; done
columns s/results.csv
columns s/summary.csv
# 2 functions x 2 views x (default, 6 integrators, 2 tables, 4 samples, 2 re-entries)
[ "$(wc -l <s/results.csv)" -eq 61 ] || fail "results.csv has $(wc -l <s/results.csv) lines"
[ "$(wc -l <s/summary.csv)" -eq 31 ] || fail "summary.csv has $(wc -l <s/summary.csv) lines"
[ "$(wc -l <s/rotation.csv)" -eq 73 ] || fail "rotation.csv has $(wc -l <s/rotation.csv) lines"
[ "$(wc -l <s/fragments.csv)" -eq 7 ] || fail "fragments.csv has $(wc -l <s/fragments.csv) lines"
json s/study.json has tetcast eq views 2 size rows 60 size summary 30 size rotation 72 size fragments 6 \
    eq rows.0.setting default eq rows.0.pixels 1024 has rows.0.ms_median has rows.0.max_error has rows.0.p9999_error \
    has rows.0.steps_per_ray has rows.0.bytes_state le rows.0.max_error 0.002 eq summary.0.views 2 \
    eq summary.0.time_ratio 1 type summary.0.front boolean
# A value of every measured row; what cannot be measured says why.
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
    NR > 1 && $at["knob"] == "reentry" && $at["note"] == "" { print "no note: " $0; bad = 1 }
    NR > 1 && $at["knob"] != "reentry" && ($at["ms_median"] <= 0 || $at["max_error"] == "") { print "empty: " $0; bad = 1 }
    END { exit bad }' s/results.csv >why || fail "$(head -2 why)"
plots="error-time table-size samples rotation fragments"
for plot in $plots; do there s/$plot-kuhn.gp; done
if command -v gnuplot >/dev/null; then
    for plot in $plots; do
        there s/$plot-kuhn.svg
        there s/$plot-kuhn.png
    done
fi

# Again: nothing is measured anew. A torn last line is measured again, and nothing else.
cp s/results.csv before.csv
run 0 study $small --knobs integrator,table8-32x32,table8-64x64,samples,reentry,figure -o s --no-plots
cmp -s before.csv s/results.csv || fail "results.csv changed"
head -c -9 before.csv >s/results.csv
run 0 study $small --knobs integrator,table8-32x32,table8-64x64,samples,reentry,figure -o s --no-plots
cut -d, -f1-7,12-19 before.csv | sort >a
cut -d, -f1-7,12-19 s/results.csv | sort >b
cmp -s a b || fail "the row that was torn is another one: $(diff a b | head -2)"
# More knobs go into the same folder; another size does not.
run 0 study $small --knobs stop-0.99 -o s --no-plots
[ "$(wc -l <s/results.csv)" -eq 65 ] || fail "results.csv has $(wc -l <s/results.csv) lines"
run 2 study synth:kuhn:300 --size 33x32 --views 2 --frames 2 -o s
says "s holds a study that was asked for otherwise"
says "--restart"
one_line
run 0 study synth:kuhn:300 --size 8x8 --views 1 --frames 1 --functions smooth --knobs exact -o s --restart --no-plots
[ "$(wc -l <s/results.csv)" -eq 3 ] || fail "results.csv has $(wc -l <s/results.csv) lines"

# Without gnuplot the scripts are there, and one sentence says so.
mkdir bin
PATH=$work/bin run 0 study synth:kuhn:300 --size 8x8 --views 1 --frames 1 --functions smooth --knobs exact -o s
says "install gnuplot"
[ "$(grep -c gnuplot err)" -eq 1 ] || fail "more than one sentence about gnuplot"

# A function by options is "given"; the folder is named after the input.
run 0 study synth:kuhn:300 --size 8x8 --views 1 --frames 1 --knobs exact --opacity linear --no-plots
there kuhn-study/results.csv
grep -q '^kuhn,given,' kuhn-study/results.csv || fail "no function 'given'"

run 0 study --list
prints "table8-128x256"
prints "spike"
run 0 study --list --json
cp out list.json
json list.json has settings.5.name size functions 4 eq settings.0.name default
run 2 study synth:kuhn --knobs nonsense -o n
says "'nonsense'"
says "integrator"
absent n/results.csv
run 2 study synth:kuhn --functions smooth,wavy -o n
says "not 'wavy'"
run 1 study nosuch.vtu -o n
says "nosuch.vtu cannot be read"
: >file
run 1 study synth:kuhn:300 -o file/x
says "file/x"
finish
