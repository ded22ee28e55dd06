#!/bin/sh
# Files that are read are not written over, whatever option names them.
. "$TC_SOURCE/tests/cli/lib.sh"
. "$TC_SOURCE/tests/cli/cube.sh"
cube two.vtk
small="--size 24x18 --driver reference --quiet"

kept() { # kept FILE READ WRITE OPTION…: OPTION of WRITE names FILE, which READ reads
    file=$1 reads=$2 writes=$3
    shift 3
    cp "$file" before
    # shellcheck disable=SC2086
    run 2 render two.vtk $small "$@"
    says "is the file of $reads and would be written over: give $writes another name"
    one_line
    cmp -s "$file" before || fail "$file was written over"
}
printf '[{"Name": "m", "RGBPoints": [0, 1, 0, 0, 1, 0, 0, 1]}]' >map
printf '1: 1,0,0\n2: 0,1,0\n' >cats.tif
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >g.obj
printf '0 0\n2 1\n' >opacity.txt
kept map --color-map --stats --color-map map --stats map -o a.png
kept cats.tif --categories --stats --field Material --categories cats.tif --stats ./cats.tif -o a.png
kept cats.tif --categories --output --field Material --categories cats.tif -o cats.tif
kept cats.tif --categories --error-image --field Material --categories cats.tif --error-image cats.tif -o a.png
kept opacity.txt --opacity --stats --opacity opacity.txt --stats opacity.txt -o a.png
ln -s g.obj link.obj
kept g.obj --geometry --stats --geometry two.stl,0.5 --geometry link.obj,0.5 --stats g.obj -o a.png
printf '{"data": "two.vtk", "transfer_function": {"color_map": "map"}}' >scene.json
run 2 render scene.json --stats map
says "map is the file of --color-map"
absent a.png
# A name is no file.
# shellcheck disable=SC2086
run 0 render two.vtk $small --color-map Viridis --opacity linear --stats linear -o a.png
there linear
finish
