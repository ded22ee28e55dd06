#!/bin/sh
# ParaView states and cameras: what they say of a volume view is rendered, what is left out is told, and the picture needs
# the state no more. Colour maps as text.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
cp "$TC_SOURCE"/tests/cli/paraview/* .
cube disk.vtu
small="--size 24x18 --quiet --driver reference"
map='{"Name":"Temp","ColorSpace":"Diverging","NanColor":[1,1,0],"RGBPoints":[0,0.231373,0.298039,0.752941,1,0.865003,0.865003,0.865003,2,0.705882,0.0156863,0.14902]}'

# A state is the options that it stands for.
run 0 render volume.pvsm --driver reference
there volume.png
says_not "warning"
run 0 render disk.vtu --driver reference -o line.png --field Temp --point-data --camera-position 4,3,8 \
    --focal-point 1,0.5,0.5 --view-up 0,1,0 --view-angle 25 --color-map "$map" --range 0,2 --opacity 0:0,0.5:0.1,2:1 \
    --unit-distance 0.25 --size 160x120 --background 0.32,0.34,0.43
same_pixels volume.png line.png
run 0 render disk.vtu --paraview volume.pvsm --driver reference -o given.png
same_pixels volume.png given.png
run 0 explain volume.pvsm
prints "density-emitter"

# The picture carries all of it, and is made again without the state.
mkdir away
mv volume.pvsm away
run 0 render volume.png --quiet -o again.png
same_pixels volume.png again.png
grep -q pvsm volume.png || fail "the command line is not in the picture"
"$TC_PIXELS" volume.png tetcast:scene >scene
! grep -q pvsm scene || fail "the picture's scene needs the state"
mv away/volume.pvsm .

# Paths: beside the state where they are not there; else a sentence with the remedy.
mkdir -p far/from
mv disk.vtu far
sed 's|value="disk.vtu"|value="/nowhere/disk.vtu"|' volume.pvsm >far/state.pvsm
run 0 render far/state.pvsm $small -o far.png
"$TETCAST" render far/state.pvsm --size 24x18 --driver reference -o far.png 2>err
says "far/state.pvsm: its data /nowhere/disk.vtu are not there: far/disk.vtu is taken"
mv far/disk.vtu .
run 1 render far/state.pvsm $small
one_line
says "far/state.pvsm shows /nowhere/disk.vtu, which is not there: give the data, tetcast render INPUT --paraview far/state.pvsm"
run 0 render disk.vtu --paraview far/state.pvsm $small -o far2.png
same_pixels far.png far2.png

# The state lies under a scene, and both under the command line.
printf '{"paraview": "volume.pvsm", "camera": {"view_angle": 40}, "output": {"size": [24, 18]}}' >under.json
run 0 render under.json --driver reference
run 0 render volume.pvsm --driver reference --view-angle 40 --size 24x18 -o line.png
same_pixels under.png line.png
run 0 render under.json --driver reference --view-angle 25 -o over.png
run 0 render volume.pvsm $small -o line.png
same_pixels over.png line.png
printf '{"paraview": "volume.pvsm", "field": "Pres", "output": {"size": [24, 18]}}' >field.json
run 0 render field.json --driver reference
run 0 render volume.pvsm $small --field Pres -o line.png
same_pixels field.png line.png
"$TC_PIXELS" field.png tetcast:scene | grep -q '"range":\[0,1\]' || fail "another field is shown over the state's range"

# Cameras.
run 0 render disk.vtu --paraview camera.pvcc $small -o camera.png
run 0 render disk.vtu $small --camera-position 0,0,9 --focal-point 1,0.5,0.5 --view-up 0.1,1,0 --parallel-scale 2 -o line.png
same_pixels camera.png line.png
run 0 render volume.pvsm --paraview camera.pvcc $small -o both.png
run 0 render volume.pvsm $small --camera-position 0,0,9 --focal-point 1,0.5,0.5 --view-up 0.1,1,0 --parallel-scale 2 -o line.png
same_pixels both.png line.png
run 0 render disk.vtu --paraview viewpoints.pvcvbc --size 24x18 --driver reference -o camera2.png
same_pixels camera.png camera2.png
says "viewpoints.pvcvbc: of its 2 cameras the first is taken"
run 1 render camera.pvcc
one_line
says "camera.pvcc holds a camera and no data"

# What is left out is told, a line each; what was understood is rendered.
mkdir data
for name in a b c; do cube data/$name.vtu; done
run 1 render left_out.pvsm --driver reference
says 'has no cell array "Pres:1"'
run 0 render left_out.pvsm --field Temp --point-data --range 0.1,10 --driver reference -o left_out.png
for what in \
    "of its 2 render views RenderView2 is taken" \
    "the background is a gradient there and its first colour here" \
    "its lights are left out" \
    "the axes in the corner are left out" \
    "run, shown as Outline, is left out" \
    "the colour bar is left out" \
    "the representation is Surface, not Volume" \
    "the colours are 8 bands there and continuous here" \
    "the colours below and above the range are left out" \
    "shading (--shade vertex) is left out" \
    "the representation's Position (0, 0, 1) is left out" \
    "the filter Clip1 (Clip) is left out, what goes into it is shown (--clip, --clip-box)" \
    "the filter Threshold1 (Threshold) is left out, what goes into it is shown (--select)" \
    "of the series of 3 files the one at time 1.5 is taken: data/b.vtu" \
    "the animation of Value of Threshold1 is left out" \
    "the camera's path is left out"; do
    says "left_out.pvsm: $what"
done
[ "$(wc -l <err)" -eq 17 ] || fail "there are $(wc -l <err) lines instead of 16 notes and the last one"
run 0 render left_out.pvsm --field Temp --point-data --range 0.1,10 --driver reference -o left_out.png --quiet
stderr_empty

# A batch of the state: all files of its series, along the camera's path.
mkdir many
run 0 batch left_out.pvsm --field Temp --point-data --range 0.1,10 --driver reference -o "many/{step}_{view}.png" --quiet
[ "$(ls many)" = "$(printf '0_0001.png\n1_0002.png\n2_0003.png')" ] || fail "the batch made $(ls many)"
"$TC_PIXELS" many/0_0001.png tetcast:scene | grep -q '"position":\[4,3,8\]' || fail "the path does not begin at its first key"
"$TC_PIXELS" many/2_0003.png tetcast:scene | grep -q '"position":\[8,3,4\]' || fail "the path does not end at its last key"
"$TC_PIXELS" many/2_0003.png tetcast:scene | grep -q 'data/c.vtu' || fail "the last step is not of the last file"
mv data/c.vtu c_away
mkdir fewer
run 1 batch left_out.pvsm --field Temp --point-data --range 0.1,10 --driver reference -o "fewer/{step}_{view}.png"
mv c_away data/c.vtu
[ "$(ls fewer)" = "$(printf '0_0001.png\n1_0002.png')" ] || fail "without the last file the batch made $(ls fewer)"
says "step 2: data/c.vtu cannot be opened"
says_not "the camera's path is left out"
run 0 batch disk.vtu --paraview volume.pvsm --driver reference -o many/one.png --quiet
same_pixels volume.png many/one.png

# Files that are none: a sentence with the line.
refused() { # refused NAME SENTENCE
    run 1 render "$1" $small
    one_line
    says "$2"
}
head -c 3000 volume.pvsm >cut.pvsm
refused cut.pvsm "cut.pvsm:"
printf '<VTKFile type="UnstructuredGrid"/>' >else.pvsm
refused else.pvsm "else.pvsm is neither a ParaView state"
printf '<!DOCTYPE a [<!ENTITY b "cc"><!ENTITY d "&b;&b;">]><ParaView><ServerManagerState version="&d;"/></ParaView>' >bomb.pvsm
refused bomb.pvsm "bomb.pvsm:1: this is no ParaView state or camera file: it has a document type"
{
    i=0
    while [ $i -lt 70 ]; do
        printf '<ParaView>'
        i=$((i + 1))
    done
} >deep.pvsm
refused deep.pvsm "more than 64 deep"
printf '<ParaView><ServerManagerState version="5.9"/></ParaView>' >empty.pvsm
refused empty.pvsm "empty.pvsm has no render view"
: >nothing.pvsm
refused nothing.pvsm "nothing.pvsm:1: this is no ParaView state or camera file: no element found"
refused missing.pvsm "missing.pvsm cannot be read"
mkdir folder.pvsm
refused folder.pvsm "folder.pvsm cannot be read"
run 1 render disk.vtu --paraview cut.pvsm $small
one_line
sed 's|value="25"|value="250"|' volume.pvsm >wide.pvsm
refused wide.pvsm "wide.pvsm: camera.view_angle"
run 2 render volume.pvsm --paraview
# A name that would be written over.
run 2 render disk.vtu --paraview camera.pvcc --stats camera.pvcc $small
says "camera.pvcc is the file of --paraview and would be written over"
cmp -s camera.pvcc "$TC_SOURCE/tests/cli/paraview/camera.pvcc" || fail "camera.pvcc was written over"

# A colour map as text: on the command line, in a scene as a text and as an object, and in the picture.
run 0 render disk.vtu $small --color-map "$map" -o text.png
echo "$map" >map.json
run 0 render disk.vtu $small --color-map map.json -o file.png
same_pixels text.png file.png
printf '{"data": "disk.vtu", "transfer_function": {"color_map": %s}}' "$map" >object.json
run 0 render object.json $small
same_pixels text.png object.png
printf '{"data": "disk.vtu", "transfer_function": {"color_map": [%s], "preset": "Temp"}}' "$map" >list.json
run 0 render list.json $small
same_pixels text.png list.png
printf '{"data": "disk.vtu", "transfer_function": {"color_map": "%s"}}' "$(echo "$map" | sed 's/"/\\"/g')" >string.json
run 0 render string.json $small
same_pixels text.png string.png
run 0 render text.png $small -o made_again.png
same_pixels text.png made_again.png
run 0 render disk.vtu $small --color-map Viridis -o other.png
other_pixels text.png other.png
run 2 render disk.vtu $small --color-map '{"Name": "a"}'
says 'the colour map'"'"'s text: the colour map "a" cannot be used: it has neither RGBPoints nor IndexedColors'
run 2 render disk.vtu $small --color-map '{"Name": '
says "the colour map's text is no ParaView preset: line 1"
printf '{"data": "disk.vtu", "transfer_function": {"color_map": 3}}' >wrong.json
run 1 render wrong.json $small
says "wrong.json:1: transfer_function.color_map takes a text or a preset"
finish
