#!/bin/sh
# edit: what `tetcast edit` says where no window can be: command line, no program, no display, no OpenGL 4.3, no data. One
# sentence each. (The window itself: edit_*.sh.)
. "$TC_SOURCE/tests/cli/lib.sh"
unset DISPLAY WAYLAND_DISPLAY
export NO_COLOR=1 XDG_STATE_HOME="$work/state"

run 0 edit --help
prints "Usage: tetcast edit INPUT"
prints "--trace FILE"
prints "--color-map NAME|FILE"
stderr_empty
run 2 edit
one_line
says "edit needs INPUT"
run 2 edit synth:kuhn --colour-map Viridis
one_line
says "the nearest is '--color-map'"

# A copy of the program without the window's beside it, as a build without GTK leaves it.
mkdir bin
cp "$TETCAST" bin/tetcast || exit 1
window=$TC_BUILD/tetcast-edit
full=$TETCAST
TETCAST=$work/bin/tetcast
TETCAST_HELPERS=$work/none run 1 edit synth:kuhn
one_line
says "tetcast-edit of the window was not found"
says "$work/none"
says "$work/bin"
says "libgtk-4-dev"
TETCAST=$full

if [ ! -x "$window" ]; then
    echo "skipped: tetcast-edit is not built"
    finish
fi
run 1 edit synth:kuhn
one_line
says "there is no display"
says "neither DISPLAY nor WAYLAND_DISPLAY is set"
DISPLAY= WAYLAND_DISPLAY= run 1 edit synth:kuhn
one_line
says "there is no display"

# It is found in $TETCAST_HELPERS, too, and gets the whole line.
mkdir helpers
printf '#!/bin/sh\nfor word in "$0" "$@"; do echo "<$word>"; done\nexit 7\n' >helpers/tetcast-edit
chmod +x helpers/tetcast-edit
TETCAST=$work/bin/tetcast
export DISPLAY=:none
TETCAST_HELPERS=$work/none:$work/helpers run 7 --quiet edit synth:kuhn --iso '0.2,0.4' --title 'a b'
printf '<%s>\n' "$work/helpers/tetcast-edit" --quiet synth:kuhn --iso 0.2,0.4 --title 'a b' >want
cmp -s out want || fail "tetcast-edit did not get the whole command line: $(cat out)"
TETCAST=$full

# A display that cannot be opened; one without OpenGL; data that cannot be read.
DISPLAY=:none run 1 edit synth:kuhn
says "the display could not be opened"
command -v Xvfb >/dev/null || { echo "skipped: Xvfb is not installed"; finish; }
Xvfb -displayfd 1 -screen 0 800x600x24 -nolisten tcp -noreset >display 2>server.log &
server=$!
trap 'kill $server; wait; rm -rf "$work"' EXIT
tries=400
until [ -s display ] || [ $tries -eq 0 ]; do tries=$((tries - 1)); sleep 0.05; done
DISPLAY=:$(cat display)
export DISPLAY GDK_BACKEND=x11 GTK_A11Y=none GSETTINGS_BACKEND=memory
ours() { grep '^tetcast: ' err >sentence; mv sentence err; } # GTK may warn of what a bare server lacks
MESA_GL_VERSION_OVERRIDE=3.3 run 1 edit synth:kuhn
ours
one_line
says "a window needs OpenGL 4.3"
says "tetcast render makes pictures"
GDK_DEBUG=gl-disable run 1 edit synth:kuhn
ours
one_line
says "a window needs OpenGL 4.3"
run 1 edit absent.vtu
ours
one_line
says "absent.vtu"
run 2 edit synth:nothing
ours
one_line
says "there is no synthetic dataset 'nothing'"
run 1 edit synth:kuhn --trace absent/trace.json
ours
one_line
says "absent/trace.json"
finish
