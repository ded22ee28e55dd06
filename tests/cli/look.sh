#!/bin/sh
# Options of a look: each changes the picture as it says, and what cannot be is refused with one sentence.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
cube two.vtk
echo "{}" >two.json
size="--size 24x18 --driver reference --quiet"

picture() { # picture NAME OPTION…
    name=$1
    shift
    # shellcheck disable=SC2086
    run 0 render two.vtk $size -o "$name.png" "$@"
}
picture plain
for look in "--model emission" "--model absorption" "--model mip" "--model minip" "--model average" "--model xray" \
    "--model isosurface --iso 0.5" "--iso 0.5,1.5" "--shade cell" "--shade vertex --ambient 0.1 --light 1,0,1" "--clip 0.5,0,0,1,0,0" \
    "--clip-box 0,1,0,1,0,0.5" "--select Material:2" "--select Temp:0,1" "--blocks 20" "--surface 0.5" \
    "--color-field Pres" "--categories 0:1,0,0;2:0,0,1" "--field Material --categories 1:1,0,0;2:0,1,0"; do
    # shellcheck disable=SC2086
    picture a $look
    other_pixels plain.png a.png
done

size="--size 240x180 --driver reference --quiet" # figures need room
picture large
for figure in "--title T" "--color-bar" "--color-bar --color-bar-place left" "--color-bar --color-bar-opacity" "--axes" "--triad" \
    "--title T --text-size 14"; do
    # shellcheck disable=SC2086
    picture a $figure
    other_pixels large.png a.png
    [ ! -f last.png ] || other_pixels last.png a.png
    mv a.png last.png
done
picture a --field Material --color-bar --categories "1:1,0,0;2:0,1,0"
picture b --field Material --color-bar --categories "1:1,0,0:copper;2:0,1,0:iron"
other_pixels a.png b.png

# A bar stands where a colour is the function's, and nowhere else.
bar() { # bar same|other OPTION…: beside the picture without one
    which=$1
    shift
    picture b "$@"
    run 0 render two.vtk --size 240x180 --driver reference -o a.png "$@" --color-bar --zoom 1
    if [ "$which" = same ]; then
        same_pixels a.png b.png
        says "--color-bar is left out"
    else
        other_pixels a.png b.png
        says_not "--color-bar is left out"
    fi
}
bar same --model xray
bar same --model absorption --background 1,1,1
bar same --model isosurface --iso 0.5,1.5 --iso-color 1,0,0
bar other --model isosurface --iso 0.5,1.5
bar other --iso 0.5 --iso-color 1,0,0
bar other --model mip
run 0 render two.vtk --size 240x180 --driver reference -o a.png --model xray --color-bar --quiet
picture b --model xray # in the same view
same_pixels a.png b.png

# What stands around the mesh is not over it: pixels of the figure and of the volume are others, and all there are.
differing() { # differing A B: pixels
    "$TETCAST" compare "$1" "$2" --json | sed -n 's/.*"differing": \([0-9]*\).*/\1/p'
}
apart() { # apart OPTION…: prints 1 where they are apart, else 0
    run 0 render two.vtk --size 160x120 --driver reference --quiet -o both.png "$@"
    run 0 render both.png --quiet -o volume.png --color-bar=off --axes=off --title " "
    run 0 render both.png --quiet -o figure.png --opacity 0:0,2:0
    [ "$(differing volume.png figure.png)" -eq "$(($(differing both.png volume.png) + $(differing both.png figure.png)))" ]
}
apart --color-bar --color-bar-place left --title Two || fail "the figure is over the mesh"
run 0 render both.png --quiet -o again.png
same_pixels both.png again.png
apart --color-bar --zoom 1 && fail "a view that was asked for is another"
picture a --color-bar --zoom 1
picture b --color-bar --focal-point 1,0.5,0.5
same_pixels a.png b.png
picture b --color-bar
other_pixels a.png b.png
picture a --triad
picture b --triad --zoom 1
same_pixels a.png b.png
size="--size 24x18 --driver reference --quiet"
picture a --color-bar --axes
same_pixels plain.png a.png # there is no room

# What says the same is the same picture.
picture a --select Material:2
picture b --blocks 20
same_pixels a.png b.png
picture b --select Temp:1,2
same_pixels a.png b.png
picture b --select Material:1 --select Material:2
same_pixels plain.png b.png
picture b --select Material:1,2 --blocks 10,20
same_pixels plain.png b.png
picture b --clip "0,0,0,1,0,0;2,1,1,-1,0,0" --clip 0,0,0,0,0,1
same_pixels plain.png b.png
picture a --color-field Temp --color-map Viridis
picture b --color-map Viridis
same_pixels a.png b.png
picture a --iso 0.5,1.5 --iso-color 1,0,0 --iso-opacity 0.5
picture b --iso 0.5,1.5 --iso-color "1,0,0;1,0,0" --iso-opacity 0.5,0.5
same_pixels a.png b.png
picture a --model emission
picture b --model emission --background 0,0,0
same_pixels a.png b.png
printf '1: 1,0,0 # copper\n2: 0,1,0\n' >materials.txt
printf '[{"IndexedColors": [1, 0, 0, 0, 1, 0], "Annotations": ["1", "copper", "2", "iron"]}]' >materials.json
picture a --field Material --categories "1:1,0,0;2:0,1,0"
for file in materials.txt materials.json; do
    picture b --field Material --categories $file
    same_pixels a.png b.png
done
# What is in force is called alike by explain, by the renderers with GL and by the reference.
effects() { tr -d '\n ' <"$1" | sed 's/.*"effects":\[\([^]]*\)\].*/\1/'; }
in_force() { tr -d '\n ' <"$1" | grep -o '"name":"[^"]*","what":"[^"]*","in_force":true' | cut -d '"' -f 4 | tr '\n' ' '; }
while read -r look; do
    for driver in pingpong reference; do
        # shellcheck disable=SC2086
        run 0 render two.vtk --size 24x18 --quiet --driver $driver -o a.png --stats $driver.json $look
    done
    [ "$(effects pingpong.json)" = "$(effects reference.json)" ] ||
        fail "$look: effects $(effects pingpong.json), with the reference $(effects reference.json)"
    # shellcheck disable=SC2086
    run 0 explain two.vtk --size 24x18 --quiet --driver pingpong --json $look
    cp out explained.json
    [ "$(effects pingpong.json | tr -d '"' | tr ',' ' ') " = "$(in_force explained.json)" ] ||
        fail "$look: effects $(effects pingpong.json), but explain tells $(in_force explained.json)"
done <<'LOOKS'
--model mip --surface 0.5 --clip-box 0,1,0,1,0,0.5
--shade vertex --select Material:2 --surface 0.5
--iso 1 --shade cell --clip 0,0,0,1,0,0 --color-field Pres
LOOKS
for driver in pingpong reference; do
    json $driver.json size effects 8 eq effects.0 density-emitter eq effects.1 clip eq effects.2 lights \
        eq effects.3 gradients eq effects.4 shade eq effects.5 isosurfaces eq effects.6 color-field \
        eq effects.7 shade-isosurfaces
done
run 0 render two.vtk $size -o a.png --select Material:7
says "the picture is empty: clipping or selection"

# A step's fields are that step's: the same pictures one by one and as a sequence.
cube 0.vtk 0
cube 1.vtk 1
printf '{"file-series-version": "1.0", "files": [{"name": "0.vtk", "time": 0}, {"name": "1.vtk", "time": 1}]}' >run.vtk.series
look="--range 0,3 --field Material --color-field Temp --color-range 0,3 --select Temp:1,9 --surface 0.3"
run 0 render run.vtk.series $size $look --step 0:1 -o "s_{step}.png"
run 0 render run.vtk.series $size $look --step 1 -o one.png
same_pixels s_1.png one.png
other_pixels s_0.png s_1.png
# The colours of the second field stay those of the first step.
run 0 render run.vtk.series $size --field Pres --color-field Temp --blocks 10 --step 0:1 -o "s_{step}.png"
run 0 render run.vtk.series $size --field Pres --color-field Temp --blocks 10 --step 1 --color-range 0,2 -o one.png
same_pixels s_1.png one.png
run 0 render s_1.png --quiet -o one.png
same_pixels s_1.png one.png

# Blocks of a file that has no numbers for them, by number and by name.
box() { # box FILE LEFT MATERIAL
    cat >"$1" <<VTU
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="8" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="T" format="ascii">0 1 1 0 2 1 1 2</DataArray></PointData>
<CellData><DataArray type="Int32" Name="Material" format="ascii">$3</DataArray></CellData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
$2 0 0 $(($2 + 1)) 0 0 $(($2 + 1)) 1 0 $2 1 0 $2 0 1 $(($2 + 1)) 0 1 $(($2 + 1)) 1 1 $2 1 1</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">12</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>
VTU
}
box left.vtu 0 1
box middle.vtu 1 2
box right.vtu 2 3
cat >blocks.vtm <<'VTM'
<VTKFile type="vtkMultiBlockDataSet" version="1.0" byte_order="LittleEndian"><vtkMultiBlockDataSet>
<DataSet index="0" name="port" file="left.vtu"/><DataSet index="1" name="keel: oak" file="middle.vtu"/>
<DataSet index="2" name="star board" file="right.vtu"/></vtkMultiBlockDataSet></VTKFile>
VTM
of_blocks() { # of_blocks NAME OPTION…
    name=$1
    shift
    # shellcheck disable=SC2086
    run 0 render blocks.vtm $size --field T -o "$name.png" "$@"
}
of_blocks all
of_blocks a --select Material:2,3
other_pixels all.png a.png
for blocks in 2:3 3,2 "keel: oak,star board" "3,keel: oak"; do
    of_blocks b --blocks "$blocks"
    same_pixels a.png b.png
done
run 0 render b.png --quiet -o c.png
same_pixels a.png c.png
of_blocks b --blocks port
of_blocks a --select Material:1
same_pixels a.png b.png
printf '{"data": "blocks.vtm", "field": "T", "effects": {"blocks": ["star board", 1]}}' >blocks.json
# shellcheck disable=SC2086
run 0 render blocks.json $size -o b.png
of_blocks a --blocks 1,3
same_pixels a.png b.png
run 0 info blocks.vtm --json
cp out info.json
json info.json size source.blocks 3 eq source.blocks.1.number 2 eq source.blocks.1.name "keel: oak" \
    size source.arrays 3 eq source.arrays.2.name vtkCompositeIndex eq source.field T
run 0 info blocks.vtm
prints "blocks      1 port"

# What cannot be.
wrong() { # wrong CODE TEXT OPTION…
    code=$1 text=$2
    shift 2
    # shellcheck disable=SC2086
    run "$code" render two.vtk $size -o no.png "$@"
    says "$text"
    one_line
    absent no.png
}
wrong 2 "the nearest is 'minip'" --model minipp
wrong 2 "each from 0 to 1" --iso 1 --iso-color 2,0,0
wrong 2 "--iso-color has 3, but there are 2 of --iso" --iso 1,2 --iso-color "1,0,0;0,1,0;0,0,1"
wrong 2 "--iso-opacity is of --iso" --iso-opacity 0.5
wrong 2 "--model isosurface shows surfaces alone: give --iso" --model isosurface
wrong 2 "--ambient acts on what is lit: give --shade" --ambient 0.5
wrong 2 "points nowhere" --shade cell --light 0,0,0
wrong 2 "points nowhere" --clip 1,2,3,0,0,0
wrong 2 "--clip takes X,Y,Z,NX,NY,NZ" --clip 1,2,3
wrong 2 "X0 below X1" --clip-box 1,0,0,1,0,1
wrong 2 "LO not above HI" --select Temp:2,1
wrong 2 "--select takes NAME:LO,HI" --select Temp
wrong 1 "has no array \"Tmp\"" --select Tmp:1
wrong 2 "whole numbers" --blocks 1.5
wrong 2 "--color-range is of --color-field" --color-range 0,1
wrong 2 "LO below HI" --color-field Pres --color-range 1,0
wrong 2 "--color-map and --categories both" --categories "1:1,0,0" --color-map Viridis
wrong 2 "--opacity is of a colour map" --categories "1:1,0,0" --opacity linear
wrong 2 "there is no file none.txt" --categories none.txt
wrong 2 "the colour map \"Viridis\" is a built-in one" --color-map viridis --preset nonsense
wrong 2 "gives the value 1 twice" --categories "1:1,0,0;1:0,0,0"
wrong 1 "no preset with IndexedColors" --categories two.json
printf '# a\n1:1,0,0; 2:0,1,0\n\n3:1,0\n' >bad.txt
wrong 1 "bad.txt:4: '3:1,0' is not V:R,G,B" --categories bad.txt
wrong 2 "--categories: '3:1,0' is not V:R,G,B" --categories "1:1,0,0;3:1,0"
wrong 2 "--color-bar-place is of --color-bar" --color-bar-place left
wrong 2 "--driver reference draws no lines" --wireframe
wrong 2 "--verify, the reference that is compared with, draws no lines" --driver auto --outline --verify 10
wrong 2 "OPACITY from 0 to 1" --geometry a.stl,2
wrong 1 "none.stl" --geometry none.stl
wrong 2 "two.vtk: 'Material' is cell data" --field Material --iso 1
wrong 2 "two.vtk: absorption" --model absorption --shade cell
wrong 2 "two.vtk: isosurfaces belong to matter that absorbs" --model mip --iso 1
wrong 2 "--axes takes no value, but '--axes=on' was given" --axes=on
run 1 render blocks.vtm $size -o no.png --blocks prt
says "blocks.vtm has no block named 'prt'; the nearest is 'port'"
one_line
wrong 1 "has no names of blocks, so none is 'port'" --blocks port
run 2 render synth:ball $size -o no.png --color-field x
says "a synthetic dataset has one field"
cat >plain.vtk <<'VTK'
# vtk DataFile Version 3.0
one tet
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 double
0 0 0  1 0 0  0 1 0  0 0 1
CELLS 1 5
4 0 1 2 3
CELL_TYPES 1
10
POINT_DATA 4
SCALARS T double 1
LOOKUP_TABLE default
0 1 2 3
VTK
run 1 render plain.vtk $size -o no.png --blocks 1
says "plain.vtk is one block"
finish
