#!/bin/sh
# batch --resume: what is finished and valid is kept, all else is made anew; the end is that of one run, byte by byte.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
for i in 0 1 2 3; do cube run_$i.vtk $i; done
preset() { # preset OPACITY: a colour map file with an opacity that grows to this
    printf '[{"Name": "x", "RGBPoints": [0, 0, 0, 1, 5, 1, 0, 0], "Points": [0, 0, 0.5, 0, 5, %s, 0.5, 0]}]' "$1" >opacity.json
}
preset 0.4
scene() { # scene OPACITY: of the second function
    cat >s.json <<JSON
{"data": "run_*.vtk", "views": {"orbit": 3}, "method": {"driver": "pingpong"},
"transfer_function": [{"range": [0, 5]}, {"name": "two", "range": [0, 5], "opacity": "$1"}],
"output": {"size": [64, 48], "cinema": true, "depth": true, "value": true}}
JSON
}
name='{step}_{tf}_{phi}.png'
# The same files with the same bytes, but for the date that EXR files carry.
same() {
    for side in "$1" "$2"; do
        rm -rf "dateless/$side"
        mkdir -p "dateless/$side"
        (cd "$side" && find . -type f) | while read -r file; do
            mkdir -p "dateless/$side/${file%/*}"
            LC_ALL=C sed 's/20[0-9][0-9]:[01][0-9]:[0-3][0-9] [0-2][0-9]:[0-5][0-9]:[0-6][0-9]/DATE/' "$side/$file" >"dateless/$side/$file"
        done
    done
    diff -r "dateless/$1" "dateless/$2" >why 2>&1 || fail "$1 and $2 differ: $(head -1 why)"
}
# left FOLDER COUNT: so many are to do
left() {
    run 0 batch s.json --resume --dry-run -o "$1/$name"
    [ "$(grep -c 'to do$' out)" -eq "$2" ] || fail "$(grep -c 'to do$' out) frames are to do instead of $2"
}
# again FOLDER COUNT [DONE]: goes on, makes so many, keeps the others; then nothing is left, and all is as of one run
again() {
    run 0 batch s.json --resume --json -o "$1/$name"
    tail -1 out >line.json
    json line.json eq event end eq done "$2" eq kept $((24 - $2)) eq failed 0 eq frames 24
    [ "$(grep -c '"status":"done"' out)" -eq "$2" ] || fail "the events tell of $(grep -c '"status":"done"' out) pictures, not $2"
    "$TC_CINEMA" "$1/s.cdb" --files >why || fail "$1: $(cat why)"
    rm -rf one
    run 0 batch s.json --quiet -o "one/$name"
    same one "$1"
}
scene linear
run 0 batch s.json --quiet -o "a/$name"
[ "$(find a -type f | wc -l)" -eq 73 ] || fail "$(find a -type f | wc -l) files instead of 73"
again a 0
# Nothing to do: no picture is touched, and no context is made.
find a -name '*.exr' -o -name '*.png' | xargs ls -l --time-style=full-iso >before
run 0 batch s.json --resume -o "a/$name"
says "all 24 frames are there"
run 0 batch s.json --resume --json -o "a/$name"
tail -1 out >line.json
[ "$TC_SANITIZE" = ON ] || json line.json eq kept 24 le peak_bytes 40e6 # a context alone takes more
find a -name '*.exr' -o -name '*.png' | xargs ls -l --time-style=full-iso >after
cmp -s before after || fail "pictures that are there are written again"

# Another function, another data file, a file that a function names.
scene 0:0,5:0.5
left a 12
again a 12
sleep 0.02
touch run_1.vtk
left a 6
again a 6
scene opacity.json
again a 12
sleep 0.02
preset 0.9
again a 12
run 0 batch s.json --resume --dry-run -o "a/$name" --color-map Viridis
[ "$(grep -c 'to do$' out)" -eq 24 ] || fail "another colour map of the command line is not seen"
run 0 batch s.json --resume --dry-run -o "a/$name" --threads 1 --quiet
[ "$(grep -c 'to do$' out)" -eq 0 ] || fail "how fast it goes is taken for what is seen"

# Damage: a byte that flipped, a cut, an empty file, a file that is gone or another frame's; of pictures and of those beside.
flip() { printf '\252' | dd of="$1" bs=1 seek="$2" conv=notrunc 2>/dev/null; }
flip a/s.cdb/0_tf1_0.png 3000
truncate -s -10 a/s.cdb/1_tf1_0.png
: >a/s.cdb/1_tf1_120.png
rm a/s.cdb/2_two_120_depth.exr
truncate -s 300 a/s.cdb/3_two_0_value.exr
cp a/s.cdb/3_tf1_0.png a/s.cdb/3_tf1_120.png
cp a/s.cdb/0_two_0_depth.exr a/s.cdb/0_two_120_depth.exr
rm a/s.cdb/0_two_240.png
echo no picture >a/s.cdb/1_two_0.png
left a 9
run 0 batch s.json --resume --quiet --shard 1/2 -o "a/$name"
run 0 batch s.json --resume --quiet --shard 2/2 -o "a/$name"
left a 0
again a 0
rm a/s.cdb/data.csv # its rows are those of what is there
again a 0
mkdir a/s.cdb/x.png
rm a/s.cdb/0_two_240.png
mkdir a/s.cdb/0_two_240.png
run 1 batch s.json --resume --quiet -o "a/$name"
says "1 of 24 frames are missing"
rmdir a/s.cdb/0_two_240.png a/s.cdb/x.png
again a 1

# First some steps, then all, into the same database.
run 0 batch s.json --quiet --frames 1::2 -o "b/$name"
left b 12
again b 12

# Two eyes: a frame is finished when both are.
run 0 batch s.json --quiet --frames 1 -o "e/$name" --stereo pair --depth=off --value=off
truncate -s -5 e/s.cdb/1_two_120_right.png
rm e/s.cdb/1_two_240_left.png
run 0 batch s.json --resume --json --frames 1 -o "e/$name" --stereo pair --depth=off --value=off
tail -1 out >line.json
json line.json eq done 2 eq kept 4
run 0 batch s.json --resume --json --frames 1 -o "e/$name" --stereo pair --eye-angle 3 --depth=off --value=off
tail -1 out >line.json
json line.json eq done 6

# A database names both.
"$TC_CINEMA" e/s.cdb --files >why || fail "e: $(cat why)"
[ "$(head -1 e/s.cdb/data.csv)" = time,phi,theta,field,tf,FILE,FILE_right ] || fail "the columns are $(head -1 e/s.cdb/data.csv)"
grep -q ',1_two_120_left.png,1_two_120_right.png$' e/s.cdb/data.csv || fail "a row is not there: $(tail -1 e/s.cdb/data.csv)"

# Moved to another place with its data.
mkdir there
mv s.json run_?.vtk opacity.json a there
cd there || exit 1
left a 0
cd "$work" || exit 1
mv there/s.json there/run_?.vtk there/opacity.json there/a .

# Killed at any moment: nothing damaged is left, and the run goes on.
cube run_4.vtk 4
cube run_5.vtk 5
scene linear
sed -i 's/"orbit": 3/"orbit": 12/' s.json
run 0 batch s.json --quiet -o "one/$name"
rm -rf one
run 0 batch s.json --quiet -o "one/$name"
files=$(find one -type f | wc -l)
for pause in 0.05 0.21 0.12 0.3 0.17 0.08 0.25 0.15 0.1 0.19 0.7; do
    "$TETCAST" batch s.json --resume --quiet -o "k/$name" >out 2>err &
    job=$!
    sleep $pause
    kill -9 $job 2>/dev/null
    wait $job 2>/dev/null
    for file in k/s.cdb/*.png; do
        [ ! -e "$file" ] || cmp -s "$file" "one/${file#k/}" || fail "$file is not whole after kill -9"
    done
done
run 0 batch s.json --resume --json -o "k/$name"
tail -1 out >line.json
json line.json eq failed 0
[ "$TC_SANITIZE" = ON ] || json line.json ge kept 1 # some were made before they were killed
[ "$(find k -type f | wc -l)" -eq "$files" ] || fail "something stays in the folder: $(find k -type f -newer s.json | grep -v '[gv]$' | head -3)"
same one k

finish
