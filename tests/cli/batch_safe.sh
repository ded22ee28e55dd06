#!/bin/sh
# batch where something goes wrong: a sentence for each thing, the others are finished, what failed is listed, exit code 1.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
for i in 0 1 2 3 4 5; do cube run_$i.vtk $i; done
cat >s.json <<'JSON'
{"data": "run_*.vtk", "views": {"orbit": 4}, "method": {"driver": "pingpong"},
"transfer_function": {"range": [0, 7], "unit_distance": 1}, "output": {"size": [64, 48], "cinema": true}}
JSON
name='{step}_{phi}.png'
run 0 batch s.json --quiet -o "one/$name"
same() { diff -r "$1" "$2" >why 2>&1 || fail "$1 and $2 differ: $(head -1 why)"; }
# whole FOLDER: each file in it is one of the whole run's, and the catalogue names what is there
whole() {
    for file in "$1"/s.cdb/.[!.]* "$1"/s.cdb/*; do
        [ -e "$file" ] || continue
        case $file in
        */data.csv) continue ;;
        esac
        cmp -s "$file" "one/s.cdb/${file##*/}" || fail "$file is not a whole picture"
    done
    [ ! -e "$1/s.cdb/data.csv" ] || "$TC_CINEMA" "$1/s.cdb" --files >why || fail "$1: $(cat why)"
}
goes_on() { # goes_on FOLDER OPTION…: then all is as of one run
    folder=$1
    shift
    run 0 batch s.json --resume --quiet -o "$folder/$name" "$@"
    same one "$folder"
}
sentences() { [ "$(grep -c '^tetcast: error: ' err)" -eq "$1" ] || fail "$(grep -c '^tetcast: error: ' err) errors instead of $1"; }

# SIGINT and SIGTERM: the file at hand is finished; the program's whole group gets them, helpers live on.
env --default-signal=INT true 2>/dev/null && fresh="env --default-signal=INT,TERM" || fresh=
for signal in INT TERM; do
    [ -n "$fresh" ] || [ $signal = TERM ] || continue # a job of a script ignores SIGINT
    for pause in 0.12 0.2 0.3; do
        for group in "" -; do
            rm -rf stopped
            $fresh setsid "$TETCAST" batch s.json --quiet --size 300x200 -o "stopped/$name" >out 2>err &
            job=$!
            sleep $pause
            kill -$signal -- "$group$job" 2>/dev/null
            wait $job
            got=$?
            last="batch, $signal to $group$job after $pause s"
            if [ $got -eq 1 ]; then
                one_line
                says "stopped by SIG$signal after"
                says "--resume goes on"
            elif [ $got -gt 128 ]; then # before the first picture was begun
                absent stopped/s.cdb/data.csv
            elif [ $got -ne 0 ]; then # or it was done before
                fail "exit code $got"
            fi
            [ ! -d stopped/s.cdb ] || "$TC_CINEMA" stopped/s.cdb --files >why || [ ! -e stopped/s.cdb/data.csv ] || fail "$(cat why)"
            [ "$(find stopped -type f 2>/dev/null | grep -vc '\.png$')" -le 1 ] || fail "$(find stopped -type f | grep -v '\.png$')"
        done
    done
    run 0 batch s.json --resume --quiet --size 300x200 -o "stopped/$name"
    run 0 batch s.json --quiet --size 300x200 -o "never/$name"
    same stopped never
done

# Signals that the run ignores, as under nohup, do not reach its helpers.
rm -rf stopped
(
    trap '' INT HUP TERM
    exec setsid "$TETCAST" batch s.json --quiet --size 300x200 -o "stopped/$name"
) >out 2>err &
job=$!
for pause in 0.05 0.05 0.05 0.05 0.05; do
    sleep $pause
    for signal in INT HUP TERM; do kill -$signal -- -$job 2>/dev/null; done
done
last="batch, whose group gets signals that it ignores"
wait $job || fail "exit code $?"
stderr_empty
run 0 batch s.json --quiet --size 300x200 -o "never/$name"
same stopped never

# A step that cannot be read: damaged, not there, of another kind, without the field; also the first one.
cp -p run_1.vtk kept_1.vtk
head -c 300 kept_1.vtk >run_1.vtk
run 1 batch s.json -o "d/$name"
says "step 1: run_1.vtk"
says "4 of 24 frames are missing:"
says "  step 1 (4 pictures): run_1.vtk"
sentences 2
whole d
[ "$(find d -name '*.png' | wc -l)" -eq 20 ] || fail "the other steps are not finished"
cp -p kept_1.vtk run_1.vtk
goes_on d
cat >list.json <<'JSON'
{"data": ["gone.vtk", "run_1.vtk", "none.vtk", "empty.vtk", "run_4.vtk", "less.vtk"], "views": {"orbit": 4}, "method": {"driver": "pingpong"},
"field": "Pres", "output": {"size": [64, 48]}}
JSON
: >empty.vtk
sed '/SCALARS Pres/,/^0 0/d' run_5.vtk >less.vtk
run 1 batch list.json --quiet -o "e/$name"
for step in 0 2 3 5; do says "  step $step (4 pictures): "; done
says "16 of 24 frames are missing:"
sentences 5
[ "$(find e -name '*.png' | wc -l)" -eq 8 ] || fail "the other steps are not finished"
run 1 batch list.json --json -o "e/$name" --resume
[ "$(grep -c '"event":"failed"' out)" -eq 4 ] || fail "the events tell of $(grep -c '"event":"failed"' out) steps, not 4"
tail -1 out >line.json
json line.json eq event end eq done 0 eq kept 8 eq failed 16 eq frames 24
run 1 batch list.json --frames 2:3 --quiet -o "f/$name"
absent f
{
    echo '<VTKFile type="Collection"><Collection>'
    for i in 9 1 2; do echo "<DataSet timestep=\"$i\" file=\"v$i.vtu\"/>"; done | sed 's/timestep="9"/timestep="0"/'
    echo '</Collection></VTKFile>'
} >run.pvd
for i in 1 2; do "$TETCAST" synth kuhn --cells 48 -o v$i.vtu --quiet >out 2>&1 || fail "no dataset: $(cat out)"; done
run 1 batch run.pvd --quiet --size 64x48 -o "p/{step}.png"
says "v9.vtu"
sentences 2
there p/1.png
there p/2.png
absent p/0.png

# A step of a series of files of another kind is cut short.
data=$TC_SOURCE/../shared/data/vol/can_series
if [ -d "$data" ]; then
    mkdir can
    for i in 0 1 2; do cp "$data/can_$i.hdf" can; done
    truncate -s 20000 can/can_1.hdf
    echo '{"data": "can/can_%d.hdf", "output": {"size": [64, 48]}, "method": {"driver": "pingpong"}}' >can.json
    run 1 batch can.json --quiet -o "can/{step}.png"
    sentences 2
    says "step 1: can/can_1.hdf"
    says "1 of 3 frames are missing:"
    there can/0.png
    there can/2.png
    absent can/1.png
fi

# Its input goes while it runs.
cp s.json t.json
for i in $(seq 10 59); do cp run_3.vtk run_$i.vtk; done
"$TETCAST" batch t.json --quiet -o "g/$name" >out 2>err &
job=$!
n=0
until [ -e g/t.cdb/1_0.png ] || [ $n -gt 300 ]; do
    sleep 0.02
    n=$((n + 1))
done
rm -f run_58.vtk
wait $job && fail "an input that went is no error"
last="batch, from whose input a file is taken"
says "step 54 (4 pictures): run_58.vtk"
sentences 2
"$TC_CINEMA" g/t.cdb --files >why || fail "$(cat why)"
[ "$(find g -name '*.png' | wc -l)" -eq 220 ] || fail "the other steps are not finished: $(find g -name '*.png' | wc -l)"
rm -f run_??.vtk

# A folder that cannot be written, a full disk.
mkdir disk
if mount -t tmpfs -o size=52k none disk 2>/dev/null; then
    trap 'umount "$work/disk"; rm -rf "$work"' EXIT
    run 1 batch s.json --quiet -o "disk/$name"
    says "No space left on device; free some space"
    says "3 pictures in a row could not be written: the batch ends; with --resume it goes on"
    says "frames are missing:"
    says "that were not begun"
    whole disk
    [ "$(find disk -name '*.png' | wc -l)" -ge 2 ] || fail "nothing is written before the disk is full"
    mount -o remount,size=4m disk && goes_on disk
    rm -rf disk/*
    mount -o remount,ro disk
    run 1 batch s.json --quiet -o "disk/$name"
    one_line
    says "Read-only file system"
    run 1 batch run_0.vtk --quiet --size 8x8 -o "disk/a.png"
    says "Read-only file system; choose a folder"
    umount disk
    trap 'rm -rf "$work"' EXIT
else
    echo "no file system can be mounted here: full and read-only ones are not tested"
fi
last="batch, with a limit of files' sizes"
(
    ulimit -f 4 # of 512 bytes: less than a picture
    exec "$TETCAST" batch s.json --quiet -o "limit/$name" 2>&1
) | cat >err
says "File too large; free some space"
says "24 of 24 frames are missing:"
[ "$(find limit -type f 2>/dev/null | wc -l)" -eq 0 ] || fail "$(find limit -type f | head -3) is there"
goes_on limit
mkdir -p blocked
: >blocked/s.cdb
run 1 batch s.json --quiet -o "blocked/$name"
one_line
says "blocked/s.cdb is a file, so it cannot be a folder of pictures"

# A reader of events that goes away does not stop the work.
{ "$TETCAST" batch s.json --json -o "pipe/$name" 2>err; echo $? >code; } | head -1 >out
[ "$(cat code)" -eq 1 ] || fail "events that nobody reads are no error"
same one pipe

# Without ffmpeg pictures are made all the same, and it is told before and at the end.
mkdir empty
last="batch --video without ffmpeg"
PATH=$work/empty "$TETCAST" batch s.json -o "film/$name" --video "film/{phi}.mp4" >out 2>err
[ $? -eq 1 ] || fail "a video that cannot be made is no error"
says "ffmpeg"
same one/s.cdb film/s.cdb
cat >empty/ffmpeg <<'SH'
#!/bin/sh
# takes the pictures, and is a video to the last argument
for out; do :; done
cat >"${out#file:}"
SH
chmod +x empty/ffmpeg
for wrong in "a.mp4" "{step}{phi}.mp4" "{phi}.avi" "{phi}" "{phi}{eye}.mp4"; do
    run 2 batch s.json -o "film/$name" --video "film/$wrong"
    one_line
done
PATH=$work/empty:$PATH run 0 batch s.json --quiet --resume -o "film/$name" --video "film/{phi}.mp4" --fps 5
for phi in 0 90 180 270; do there "film/$phi.mp4"; done
[ "$(find film -maxdepth 1 -type f | wc -l)" -eq 4 ] || fail "beside the videos: $(ls -A film)"

# A function that cannot be made is told once, before the first picture.
run 2 batch 'run_*.vtk' --color-map Viridiss --quiet -o "nomap/{step}.png"
sentences 1
absent nomap

finish
