#!/bin/sh
# breach.sh: check.sh must see a breach of each rule in a small made-up tree, and must pass that tree without it.
set -eu
check=$(dirname "$0")/check.sh
check=$(cd "$(dirname "$check")" && pwd)/check.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/src/core" "$tree/src/mesh" "$tree/src/cli" "$tree/src/edit" "$tree/src/window" "$tree/readers" "$tree/gpu" "$tree/transfer_functions" \
    "$tree/datasets_synthetic" "$tree/tests" "$tree/cmake"

plain() {
    echo '#include "tetcast.h"' >"$tree/src/core/status.h"
    echo '#include "core/status.h"' >"$tree/src/mesh/mesh.c"
    echo '#include "mesh/mesh.h"' >"$tree/gpu/pack.c"
    echo '#include "cli/options.h"' >"$tree/src/cli/main.c"
    echo '#include "edit/document.h"' >"$tree/src/edit/document.c"
    printf '#include <gtk/gtk.h>\n#include "cli/options.h"\n#include "edit/document.h"\n' >"$tree/src/window/main.c"
}
pass() {
    sh "$check" "$1" "$tree" || { echo "FAIL: '$1' refuses a tree without a breach"; exit 1; }
}
refuse() {
    if sh "$check" "$1" "$tree" >/dev/null; then
        echo "FAIL: '$1' does not see: $2"
        exit 1
    fi
    plain
}

plain
for rule in includes length apart; do pass $rule; done
echo '#include "mesh/mesh.h"' >"$tree/src/core/status.h"
refuse includes "core includes mesh"
echo '#include "reference/reference.h"' >"$tree/gpu/pack.c"
refuse includes "gpu includes the reference, which is of its own rank"
echo '#include "core/status.h"' >"$tree/src/cli/main.c"
refuse includes "the program includes the inside of the library"
echo '#include "cli/options.h"' >"$tree/src/edit/document.c"
refuse includes "the model of the window includes the program"
echo '#include "transfer_functions/preset.h"' >"$tree/src/edit/document.c"
refuse includes "the model of the window includes the inside of the library"
echo '#include "core/status.h"' >"$tree/src/window/main.c"
refuse includes "the window includes the inside of the library"
echo '#include "window/session.h"' >"$tree/src/cli/main.c"
refuse includes "the program includes the window"
echo '#include <gtk/gtk.h>' >"$tree/src/edit/document.c"
refuse apart "the model of the window includes GTK"
echo '#include <vtkCell.h>' >"$tree/src/mesh/mesh.c"
refuse apart "the mesh includes VTK"
awk 'BEGIN { for (i = 0; i < 801; i++) print "" }' >"$tree/gpu/pack.c"
refuse length "a file of 801 lines"
echo "all breaches were seen"
