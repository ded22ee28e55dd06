#!/bin/sh
# check.sh includes|length|apart [ROOT]: the rules of docs/architecture.md that can be checked by reading the sources.
#   includes  rooms include only rooms below them; programs include tetcast.h and nothing else of the library
#   length    no source file has more than 800 lines
#   apart     VTK, TetGen and OpenImageIO appear in the helper programs only, GTK in the window only
# Prints every breach as FILE: SENTENCE. Exit 0: none; 1: some; 2: nothing was checked.
set -eu
root=${2:-$(dirname "$0")/../..}
cd "$root"

sources() {
    find src readers gpu transfer_functions datasets_synthetic -type f \( -name '*.c' -o -name '*.h' -o -name '*.cpp' \)
}

includes() {
    sources | sort | xargs awk '
    # A room may include rooms of a lower rank, and itself.
    BEGIN {
        rank["core"] = 0; rank["mesh"] = 1
        rank["cache"] = rank["scene"] = rank["shell"] = rank["image"] = 2
        rank["transfer_functions"] = rank["datasets_synthetic"] = rank["readers"] = 2
        rank["gpu"] = rank["reference"] = rank["figure"] = rank["probe"] = 3
        rank["api"] = 4; rank["study"] = 5
        rank["cli"] = rank["edit"] = 6; rank["window"] = 7 # clients: of the library they see tetcast.h
    }
    FNR == 1 {
        n = split(FILENAME, part, "/")
        room = part[1] == "src" ? (n > 2 ? part[2] : "") : part[1]
        files++
    }
    /^[ \t]*#[ \t]*include[ \t]*"/ {
        split($0, quoted, "\"")
        name = quoted[2]
        depth = split(name, step, "/")
        seen++
        if (name ~ /^tetcast(_[a-z]+)?\.h$/ || depth == 1) # a public header, or a neighbour in the same folder
            next
        target = step[1]
        if (!(target in rank))
            print FILENAME ": includes " name ", which is in no room"
        else if (!(room in rank))
            print FILENAME ": is in no room, but includes " name
        else if (target != room && (rank[target] >= rank[room] || (rank[room] > 5 && rank[target] < 6)))
            print FILENAME ": room " room " may not include " name
    }
    END { if (seen < 1) print "no include was found: nothing was checked" }'
}

# Shaders: a name in quotes is another shader. Presets and other data are no sources.
length_check() {
    find src readers gpu transfer_functions datasets_synthetic tests cmake -type f \
        \( -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.glsl' -o -name '*.py' -o -name '*.sh' -o \
        -name '*.cmake' -o -name CMakeLists.txt \) | sort | xargs awk '
    { lines[FILENAME]++ }
    END { for (f in lines) if (lines[f] > 800) print f ": " lines[f] " lines; 800 is the most" }'
}

apart() {
    sources | grep -v -e '^src/.*/helper/' -e '^readers/.*\.cpp$' -e '^readers/.*\.h$' | sort | xargs awk '
    /^[ \t]*#[ \t]*include[ \t]*[<"](vtk|tetgen|OpenImageIO)/ {
        print FILENAME ": includes a library that belongs into a helper program: " $0
    }
    /^[ \t]*#[ \t]*include[ \t]*[<"](gtk|gdk|glib|gio)/ && FILENAME !~ /^src\/window\// {
        print FILENAME ": includes a library that belongs into the window: " $0
    }'
}

case ${1:-} in
includes) found=$(includes) ;;
length) found=$(length_check) ;;
apart) found=$(apart) ;;
*)
    echo "usage: check.sh includes|length|apart [ROOT]" >&2
    exit 2
    ;;
esac
[ -z "$found" ] && exit 0
printf '%s\n' "$found"
exit 1
