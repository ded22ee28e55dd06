#!/bin/sh
# batch: each picture of a scene's steps, fields, functions and views, as render makes it alone; names, choices, shards, scenes.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
for i in 0 1 2 3; do cube run_$i.vtk $i; done
scene() { printf '%s' "$2" >"$1"; } # scene FILE TEXT
of() { "$TC_PIXELS" "$1" tetcast:scene; }
holds() { of "$1" | grep -qF -e "$2" || fail "$1 does not hold $2: $(of "$1")"; }
files() { [ "$(find "$1" -type f | wc -l)" -eq "$2" ] || fail "$1 has $(find "$1" -type f | wc -l) files instead of $2"; }
same() { diff -r "$1" "$2" >why 2>&1 || fail "$1 and $2 differ: $(head -1 why)"; }
out='"output": {"size": [64, 48]}, "method": {"driver": "pingpong"}'

# Each of four steps, two fields, two functions, two views; as render makes it with the same options.
scene s.json '{"data": "run_*.vtk", "field": ["Temp", "Pres"],
"transfer_function": [{"name": "warm", "color_map": "Cool to Warm"}, {"name": "vir", "color_map": "Viridis", "opacity": "0:0,5:0.6"}],
"views": {"orbit": 2, "elevation": 20},
"output": {"size": [64, 48], "cinema": true}, "method": {"driver": "pingpong"}}'
run 0 batch s.json --quiet
stderr_empty
stdout_empty
files s.cdb 33
"$TC_CINEMA" s.cdb --files >why || fail "s.cdb: $(cat why)"
grep -qx '1.0,180.0,20.0,Temp,vir,s_0001_Temp_vir_180_20.png' s.cdb/data.csv || fail "a row is not there"
unit=$(of s.cdb/s_0000_Temp_vir_0_20.png | sed -n 's/.*"unit_distance":\([0-9.e+-]*\).*/\1/p')
alone() { # alone STEP FIELD RANGE NAME ANGLE OPTION…
    picture=s.cdb/s_000$1_$2_$4_$5_20.png
    one=run_$1.vtk
    tail="--field $2 --range $3 --azimuth $5"
    shift 5
    # shellcheck disable=SC2086
    run 0 render $one --quiet --size 64x48 --driver pingpong --elevation 20 --unit-distance "$unit" $tail "$@" -o one.png
    same_pixels one.png "$picture"
    run 0 render "$picture" --quiet -o again.png
    same_pixels again.png "$picture"
}
alone 0 Temp 0,5 warm 0
alone 1 Temp 0,5 vir 180 --color-map Viridis --opacity 0:0,5:0.6
alone 3 Pres 0,1 vir 0 --color-map Viridis --opacity 0:0,5:0.6
alone 2 Pres 0,1 warm 180
other_pixels s.cdb/s_0000_Temp_vir_0_20.png s.cdb/s_0001_Temp_vir_0_20.png
other_pixels s.cdb/s_0000_Temp_vir_0_20.png s.cdb/s_0000_Temp_vir_180_20.png
other_pixels s.cdb/s_0000_Temp_vir_0_20.png s.cdb/s_0000_Temp_warm_0_20.png
other_pixels s.cdb/s_0000_Temp_vir_0_20.png s.cdb/s_0000_Pres_vir_0_20.png

# Shards, side by side, are one run, byte by byte; also where there are more of them than steps, and than frames.
for n in 2 3 9; do
    for i in $(seq $n); do
        "$TETCAST" batch s.json --quiet -o "n$n/s_{step:04d}_{field}_{tf}_{phi}_{theta}.png" --shard "$i/$n" >"out$i" 2>&1 &
        # shellcheck disable=SC2034
        eval "job$i=$!"
    done
    for i in $(seq $n); do
        eval "wait \$job$i" || fail "shard $i/$n: $(cat "out$i")"
    done
    same s.cdb "n$n/s.cdb"
done
run 0 batch s.json --quiet --frames 0 --shard 9/9 -o "none/{field}{tf}{phi}.png"
for wrong in 0/3 4/3 3 1/0 x/2; do
    run 2 batch s.json --shard $wrong
    one_line
done

# Which steps: both ends, strides, from the end, lists; each once.
scene p.json '{"data": "run_%d.vtk"}'
frames() { # frames TEXT STEP…
    text=$1
    shift
    run 0 batch p.json --size 8x8 --frames="$text" --dry-run -o "f/{step}.png"
    stems=$(cut -f2 out | sed 's|f/||; s|.png||' | tr '\n' ' ')
    [ "$stems" = "$* " ] || fail "--frames $text gives $stems instead of $*"
    absent f
}
frames : 0 1 2 3
frames 2 2
frames -1 3
frames 1:2 1 2
frames 0::2 0 2
frames -2: 2 3
frames 0:400:3 0 3
frames 3,1,1:2 1 2 3
frames :-2:2 0 2
for wrong in "x 2" "0:1:0 2" "9 1" "2:1 1" " 2" "1,, 2" "0:1:-1 2" "99999999999999999999 2"; do
    run "${wrong##* }" batch p.json --frames="${wrong% *}" -o "f/{step}.png"
    one_line
done
run 0 batch p.json --quiet --size 8x8 --step 1:2 -o "f/{step}.png"
files f 2
run 2 batch p.json --frames 1 --step 2
one_line
run 2 batch p.json --frames 1 --time 2
one_line

# Names: ParaView's count the pictures of the series, {step} its steps; what meets or cannot be is refused before anything is made.
run 0 batch p.json --quiet --size 8x8 --frames 1::2 -o "pv/a.%04d.png"
there pv/a.0000.png
there pv/a.0001.png
files pv 2
run 0 batch p.json --quiet --size 8x8 --frames 1::2 -o "pw/{frame}_{step:03d}_{time:.2f}_{{%%.png"
there "pw/1_003_3.00_{%.png"
for wrong in "a.png" "{step:q}.png" "{stp}.png" "{step}.gif" "{step}" "{phi}_{step}.exe" "{time:.0e}{.png" "{eye}{step}.png"; do
    run 2 batch p.json --size 8x8 -o "$wrong"
    one_line
    rm -rf none
done
run 2 batch s.json -o "{step}_{field}_{tf}.png"
says "put {view} into it"
run 2 batch s.json -o "{step}_{tf}_{phi}.png"
says "put {field} into it"
run 2 batch s.json -o "{step}_{field}_{phi}.png"
says "put {tf} into it"
scene t.json '{"data": "run_%d.vtk", "transfer_function": [{"name": "a b"}, {"name": "a/b"}]}'
run 2 batch t.json --size 8x8 -o "{step}{tf}.png"
says "two pictures would be written to"
cp run_0.vtk 0.png
scene t.json '{"data": ["run_0.vtk", "run_1.vtk"], "output": {"file": "run_{step}.png"}}'
run 0 batch t.json --quiet --size 8x8
there run_1.png
rm -f run_?.png
run 2 batch p.json -o -
one_line
run 2 batch p.json --size 8x8 --bits 16 -o "bits/{step}.jpg"
says "bits/{step}.jpg: --bits 16: png has 8 or 16 bits a channel"
one_line
absent bits
run 2 batch p.json --stats a.json
one_line
run 0 batch p.json --size 8x8 --cache --dry-run
says "warning: a batch reads and writes no cache"

# One database holds all pictures: it begins where names begin to differ, or where the name says.
cinema() { # cinema OUTPUT CDB FILE
    rm -rf db
    run 0 batch s.json --quiet --frames 1 -o "$1"
    "$TC_CINEMA" "$2" --files >why || fail "$1: $(cat why)"
    grep -q ",$3\$" "$2/data.csv" || fail "$1: $3 is not in data.csv: $(sed -n 2p "$2/data.csv")"
}
cinema "db/{tf}/{field}/{step}_{phi}.png" db/s.cdb warm/Temp/1_180.png
cinema "db/all.cdb/{tf}/{field}{step}{phi}.png" db/all.cdb vir/Pres10.png
cinema "db/a{{b.cdb/x_{tf}{field}{step}{phi}.png" "db/a{b.cdb" x_virPres10.png
cinema "db/x/%02d{tf}{field}{phi}.png" db/x/s.cdb 00virTemp0.png
run 2 batch s.json -o "db/{tf}.cdb/{field}{step}{phi}.png"
says "all pictures are of one database"
one_line
run 0 batch s.json --quiet --frames 1 --stereo pair -o "db/{eye}/{tf}{field}{phi}.png"
"$TC_CINEMA" db/s.cdb --files >why || fail "of two eyes: $(cat why)"

# The scene may be a dataset; of files that belong together, of a pattern, of a list.
{
    echo '<VTKFile type="Collection"><Collection>'
    for i in 0 1 2 3; do echo "<DataSet timestep=\"$i.5\" file=\"u$i.vtu\"/>"; done
    echo '</Collection></VTKFile>'
} >run.pvd
vtu() { # vtu FILE SHIFT A B: two tets; the last point is moved by SHIFT, values from A to B
    cat >"$1" <<VTU
<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2">
<PointData><DataArray type="Float64" Name="T" format="ascii">$3 $4 $3 $4 $4</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1 $2 $2 $2</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 1 2 3 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>
VTU
}
vtu u0.vtu 1 0 1
vtu u1.vtu 1 2 5
vtu u2.vtu 1 -1 0
vtu u3.vtu 4 1 2
run 0 batch run.pvd --quiet --size 64x48 -o "pvd/{step}_{time}.png"
files pvd 4
there pvd/3_3.5.png
run 0 batch run.pvd --quiet --size 8x8
for i in 0 1 2 3; do there "run_000$i.png"; done
rm -f run_000?.png
run 0 batch u0.vtu --quiet --size 8x8
there u0.png
scene l.json '{"data": ["u0.vtu", "u[1-3].vtu"], "times": [0.5, 1.5, 2.5, 3.5], "output": {"size": [64, 48]}}'
run 0 batch l.json --quiet -o "list/{step}_{time}.png"
for i in 0 1 2 3; do same_pixels "pvd/${i}_$i.5.png" "list/${i}_$i.5.png"; done
scene x.json '{"data": ["u0.vtu", "u1.vtu"], "times": [1, 0]}'
run 1 batch x.json
one_line
scene x.json '{"data": "v*.vtu"}'
run 1 batch x.json
one_line
says 'v*.vtu'

# One range of all steps, of the first, of each; the same for unit and camera. A picture tells what was in force.
over() { # over FOLDER OPTION…
    folder=$1
    shift
    run 0 batch run.pvd --quiet --size 64x48 --driver pingpong -o "$folder/{step}.png" "$@"
    for i in 0 1 2 3; do
        run 0 render "$folder/$i.png" --quiet -o again.png
        same_pixels "$folder/$i.png" again.png
    done
}
over all
for i in 0 1 2 3; do holds all/$i.png '"range":[-1,5]'; done
same_camera() { [ "$(of "$1" | sed 's/.*"position":\([^]]*\).*/\1/')" = "$(of "$2" | sed 's/.*"position":\([^]]*\).*/\1/')" ]; }
unit_of() { of "$1" | sed 's/.*"unit_distance":\([0-9.e+-]*\).*/\1/'; }
same_camera all/0.png all/3.png || fail "the camera moves"
[ "$(unit_of all/0.png)" = "$(unit_of all/3.png)" ] || fail "the unit distance changes"
over first --range-over first
for i in 0 1 2 3; do holds first/$i.png '"range":[0,1]'; done
over step --range-over step --unit-over step --camera-over step
holds step/0.png '"range":[0,1]'
holds step/1.png '"range":[2,5]'
holds step/2.png '"range":[-1,0]'
holds step/3.png '"range":[1,2]'
same_camera step/0.png step/3.png && fail "the camera does not follow the box"
[ "$(unit_of step/0.png)" != "$(unit_of step/3.png)" ] || fail "the unit distance does not follow the box"
run 0 render run.pvd --step 3 --quiet --size 64x48 --driver pingpong -o one.png
same_pixels one.png step/3.png
over most --unit-over all --camera-over all
[ "$(unit_of most/0.png)" = "$(unit_of step/3.png)" ] || fail "the unit distance is not the largest"
same_camera most/0.png step/3.png || fail "the camera does not see the box around all steps"
over seen --camera-over all # and no more than that
same_camera seen/0.png step/3.png || fail "the camera does not see the box around all steps"
[ "$(unit_of seen/0.png)" = "$(unit_of step/0.png)" ] || fail "the unit distance changes with --camera-over"
over thick --unit-over all
same_camera thick/0.png step/0.png || fail "the camera changes with --unit-over"
scene o.json '{"data": "run.pvd", "frames": "1:2", "transfer_function": [{"range_over": "first", "unit_over": "all"}, {"range_over": "all"}, {"range_over": "step"}], '"$out"'}'
run 0 batch o.json --quiet -o "o/{step}{tf}.png" # each function by its own rule
holds o/1tf1.png '"range":[0,1]'
holds o/1tf2.png '"range":[-1,5]'
holds o/1tf3.png '"range":[2,5]'
[ "$(unit_of o/1tf1.png)" = "$(unit_of step/1.png)" ] || fail "the unit distance is of a step that is not shown"
scene o.json '{"data": "run.pvd", "transfer_function": [{}, {"unit_over": "all"}], '"$out"'}'
run 0 batch o.json --quiet --frames 2: -o "o/{step}{tf}.png"
[ "$(unit_of o/2tf1.png)" = "$(unit_of step/0.png)" ] || fail "the second function's unit distance is the first's"
[ "$(unit_of o/2tf2.png)" = "$(unit_of step/3.png)" ] || fail "a function of the list has not its own unit distance"
over fixed --range 0,7 --unit-distance 0.25
for i in 0 3; do
    holds fixed/$i.png '"range":[0,7]'
    holds fixed/$i.png '"unit_distance":0.25'
done
run 0 batch run.pvd --quiet --size 64x48 --driver pingpong --frames 1,3 -o "some/{step}.png"
holds some/1.png '"range":[1,5]' # of the steps that are shown
scene o.json '{"data": "run.pvd", "transfer_function": {"range_over": "first", "unit_over": "step"}, "camera": {"over": "step"}, '"$out"'}'
run 0 batch o.json --quiet -o "o/{step}.png"
holds o/1.png '"range":[0,1]'
same_pixels o/0.png step/0.png
run 0 batch o.json --quiet --range-over step --frames 1 -o "o/{step}.png"
same_pixels o/1.png step/1.png

# The title has the step's time, and keeps it when the picture is made again.
scene i.json '{"data": "run.pvd", "effects": {"title": "t = {time:.2f} of {step}"}, "output": {"size": [320, 240]}, "method": {"driver": "pingpong"}}'
run 0 batch i.json --quiet --frames 1:2 -o "i/{step}.png"
holds i/2.png '"title":"t = 2.50 of 2"'
run 0 render i/2.png --quiet -o again.png
same_pixels i/2.png again.png
run 0 render i/2.png --quiet --title "t = 1.50 of 1" -o again.png
other_pixels i/2.png again.png

# Views: a list with names, a grid, a path, one for each step; each is made again from its own picture.
views() { # views VIEWS FILE…
    scene v.json '{"data": "run.pvd", "frames": "0:1", "transfer_function": {"range": [0, 5]}, "views": '"$1"', '"$out"'}'
    shift
    rm -rf v
    run 0 batch v.json --quiet -o "v/{step}_{view}.png"
    files v $#
    for file in "$@"; do
        there "v/$file.png"
        run 0 render "v/$file.png" --quiet -o again.png
        same_pixels "v/$file.png" again.png
    done
}
views '[{"name": "front", "direction": [0, -1, 0]}, {"name": "top", "direction": [0, 0, 1], "view_up": [0, 1, 0], "zoom": 1.2}]' \
    0_front 0_top 1_front 1_top
views '{"phi": [0, 90], "theta": {"from": -90, "to": 90, "count": 3}}' \
    0_0001 0_0002 0_0003 0_0004 0_0005 0_0006 1_0001 1_0002 1_0003 1_0004 1_0005 1_0006
views '{"path": [{"position": [5, 0, 0]}, {"position": [0, 5, 1], "view_angle": 40}], "count": 3}' \
    0_0001 0_0002 0_0003 1_0001 1_0002 1_0003
views '{"orbit": true, "along": "time"}' 0_0001 1_0002
run 0 batch v.json --quiet --frames 0:2 -o "v/{step}_{view}.exr"
there v/2_0003.exr

# What is wrong in a scene is told by file, line and key; nothing is made.
wrong() { # wrong TEXT SCENE
    scene wrong.json "$2"
    run 1 batch wrong.json -o "no/{step}{view}{tf}{field}.png"
    says "$1"
    one_line
    absent no
}
wrong "wrong.json:2: the scene has no key 'view'; the nearest is 'views'" '{"data": "run.pvd",
"view": []}'
wrong "wrong.json:3: camera has no key 'ovr'; the nearest is 'over'" '{"data": "run.pvd",
"camera": {
"ovr": "all"}}'
wrong "'range_ovr'; the nearest is 'range_over'" '{"data": "run.pvd", "transfer_function": [{}, {"range_ovr": "all"}]}'
wrong "wrong.json:2: camera.over takes" '{"data": "run.pvd", "camera": {
"over": "al"}}'
wrong "wrong.json:2: views" '{"data": "run.pvd",
"views": {"orbits": 3}}'
wrong "wrong.json:2: views[1]" '{"data": "run.pvd",
"views": [{}, {"positon": [1, 2, 3]}]}'
wrong "wrong.json:2: views" '{"data": "run.pvd",
"views": 7}'
wrong "wrong.json:2: field is an empty list" '{"data": "run.pvd",
"field": []}'
wrong "wrong.json:1: field takes a text" '{"data": "run.pvd", "field": ["T", 3]}'
wrong "wrong.json:1: transfer_function is an empty list" '{"data": "run.pvd", "transfer_function": []}'
wrong "wrong.json:1: transfer_function takes an object" '{"data": "run.pvd", "transfer_function": [3]}'
wrong "wrong.json:1: data" '{"data": 3}'
wrong "wrong.json:1: data" '{"frames": "0"}'
wrong "wrong.json: data takes the name of a file, a pattern" '{"data": []}'
wrong "wrong.json: times takes a list of as many numbers as there are files: 1, not 2" '{"data": ["run_1.vtk"], "times": [1, 2]}'
wrong "wrong.json:1: frames takes" '{"data": "run.pvd", "frames": "x"}'
wrong "wrong.json:1: shell is not in this version" '{"data": "run.pvd", "shell": {}}'
wrong "wrong.json:1: a scene is an object" '[]'
wrong "Nothing" '{"data": "run.pvd", "field": ["T", "Nothing"]}'
run 1 batch gone.json
says "gone.json cannot be read"
one_line
run 2 batch
run 2 batch run.pvd u0.vtu
run 2 batch run.pvd --frobnicate

# The command line stands before the scene; a scene that render takes is a batch of one.
scene c.json '{"data": "run.pvd", "field": "T", "frames": "1", "transfer_function": [{"color_map": "Viridis"}, {"color_map": "Plasma"}], '"$out"'}'
run 0 batch c.json --quiet --frames 2 --size 8x6 --color-map Inferno --range 0,1 --unit-distance 1 -o "c/{step}{tf}.png"
files c 2
same_pixels c/2tf1.png c/2tf2.png # one colour map for all
holds c/2tf2.png '"size":[8,6]'
scene r.json '{"data": "run.pvd", "step": 1, "camera": {"azimuth": 30}, "output": {"file": "r.png", "size": [64, 48]}, "method": {"driver": "pingpong"}}'
run 0 batch r.json --quiet
run 0 render r.json --quiet -o one.png
same_pixels r.png one.png
mkdir -p deep/er
scene deep/s.json '{"data": "../run_%d.vtk", "output": {"file": "er/{step}.png", "size": [8, 8]}}'
run 0 batch deep/s.json --quiet
files deep/er 4

# Files of several kinds whose steps are their own, where they are at hand: a step's picture is render's, and is made again.
data=$TC_SOURCE/../shared/data/vol
for dataset in "$data/mug.e" "$data/can_series/can_%d.hdf"; do
    [ -d "$data" ] || continue
    scene e.json '{"data": "'"$dataset"'", "frames": "0,2", "views": {"phi": [0, 60], "theta": [20]}, '"$out"'}'
    for over in all first step; do
        rm -rf e
        run 0 batch e.json --quiet --range-over $over -o "e/{step}_{phi}_{theta}.png"
        files e 4
        for file in e/0_0_20.png e/2_60_20.png; do
            run 0 render $file --quiet -o again.png
            same_pixels $file again.png
        done
    done
    other_pixels e/2_0_20.png e/2_60_20.png
done

# What a run does, for schedulers: an event a line, whose counts agree.
run 0 batch s.json --json --frames 0:1 -o "j/{step}{field}{tf}{phi}.png"
stderr_is=$(wc -l <err)
[ "$stderr_is" -le 1 ] || fail "stderr has $stderr_is lines beside the events"
n=0
while read -r line; do
    printf '%s\n' "$line" >line.json
    json line.json has event
    n=$((n + 1))
    [ $n -eq 1 ] && json line.json eq event start eq frames 16 eq steps 2 eq views 2 eq functions 2 eq fields 2
    [ $n -gt 1 ] && [ $n -lt 18 ] && json line.json eq event frame eq status done eq finished $((n - 1)) eq frames 16 ge bytes 100 has write_ms
done <out
[ $n -eq 18 ] || fail "$n events instead of 18"
json line.json eq event end eq frames 16 eq done 16 eq kept 0 eq failed 0 ge peak_bytes 1 lacks stopped
run 0 batch s.json --json --dry-run -o "d/{step}{field}{tf}{phi}.png"
[ "$(grep -c '"event":"plan"' out)" -eq 32 ] && [ "$(wc -l <out)" -eq 32 ] || fail "the plan has $(wc -l <out) lines"
absent d
run 0 batch s.json --dry-run -o "d/{step}{field}{tf}{phi}.png"
[ "$(wc -l <out)" -eq 32 ] || fail "the list has $(wc -l <out) lines"
says "32 frames to do, of 32 in all"
absent d
run 0 batch s.json --dry-run --resume
[ "$(grep -c 'kept$' out)" -eq 32 ] || fail "frames that are there are not told"

# What is said of a picture that is written is not said of the step that is at hand meanwhile.
run 0 batch p.json --size 8x8 -o "j/{step}.jpg"
says "warning: j/0.jpg: JPEG has no transparency"
says_not "warning: step"
says_not "e+"

# A time beyond all steps is told.
run 0 batch p.json --size 8x8 --dry-run --time 2.5
says_not "lies"
run 0 batch p.json --size 8x8 --dry-run --time 99
says "time 99 lies after the last step; the step at 3 is shown"
run 0 batch p.json --size 8x8 --dry-run --time -1
says "time -1 lies before the first step; the step at 0 is shown"

# --memory: too little is one sentence, enough is the same pictures.
run 1 batch s.json --quiet --memory 4M -o "m/s_{step:04d}_{field}_{tf}_{phi}_{theta}.png"
one_line
says "--memory"
[ -z "$(find m -name '*.png' 2>/dev/null)" ] || fail "pictures are made beyond --memory"
rm -rf m
run 0 batch s.json --quiet --memory 600M -o "m/s_{step:04d}_{field}_{tf}_{phi}_{theta}.png"
same s.cdb m/s.cdb
for wrong in 0 -1 4X 10 nan 4GG; do
    run 2 batch s.json --memory=$wrong
    one_line
done

finish
