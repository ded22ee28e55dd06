#!/bin/sh
# counts.sh BENCH_SETUP [NAME [CELLS]]: instructions a tet of each part of setting up a mesh, and an entry of the
# pre-integration tables, counted by valgrind on one thread: the same on a busy machine, and on another of its kind.
set -eu
bench=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
valgrind --tool=callgrind --callgrind-out-file="$folder/out" "$bench" "$@" >"$folder/sizes" 2>"$folder/log" || {
    cat "$folder/log" >&2
    exit 1
}
callgrind_annotate --inclusive=yes --threshold=100 "$folder/out" >"$folder/counts"
awk '
FILENAME ~ /sizes$/ { size[$1] = $2; next }
{
    # 1,234 (5.6%) file:function [object]
    if (!match($0, /:tc_[a-z0-9_]+( |$)/))
        next
    name = substr($0, RSTART + 1)
    sub(/ .*/, "", name)
    sub(/\(.*/, "")
    gsub(/[ ,]/, "")
    if ($0 + 0 > count[name])
        count[name] = $0 + 0
}
function line(what, name, per) {
    if (!(name in count)) {
        print "counts.sh: " name " was not called" >"/dev/stderr"
        failed = 1
        exit 1
    }
    printf "%-34s %9.1f\n", what, count[name] / size[per]
}
END {
    if (failed)
        exit 1
    print size["tets"] " tets, instructions a tet"
    line("check: repair", "tc_mesh_repair", "tets")
    line("check: parts", "tc_adjacency_components", "tets")
    line("check: the boundary", "tc_boundary_build", "tets")
    line("check: is it convex", "tc_boundary_is_convex", "tets")
    line("order", "tc_mesh_order", "tets")
    line("adjacency", "tc_adjacency_build", "tets")
    line("pack", "tc_pack_build", "tets")
    line("all of tc_mesh_prepare", "tc_mesh_prepare", "tets")
    print size["entries"] " entries of a table, instructions an entry"
    line("8 bits, as the paper has it", "tc_table_build", "entries")
    line("16 bits, the drift of colour", "tc_drift_build", "entries")
}' "$folder/sizes" "$folder/counts"
