# edit_lib.sh: what the tests of the window share: a display without a screen, the window on it, and a hand: keys and a
# pointer that the X server makes. Skips with 77 where one of them is missing.
. "$TC_SOURCE/tests/cli/lib.sh"

skip() { echo "skipped: $*"; exit 77; }
for tool in Xvfb xdotool import convert; do
    command -v $tool >/dev/null || skip "$tool is not installed"
done
[ -x "$TC_BUILD/tetcast-edit" ] || skip "tetcast-edit is not built"

# Nothing of the user's is read or written; nothing reaches for a session bus.
mkdir -p home run state
chmod 700 run
export HOME="$work/home" XDG_RUNTIME_DIR="$work/run" XDG_STATE_HOME="$work/state" XDG_CONFIG_HOME="$work/home" \
    XDG_DATA_HOME="$work/home" XDG_CACHE_HOME="$work/home" GDK_BACKEND=x11 GTK_A11Y=none GSETTINGS_BACKEND=memory \
    NO_COLOR=1 LC_ALL=C.UTF-8
unset WAYLAND_DISPLAY DBUS_SESSION_BUS_ADDRESS GTK_THEME GDK_SCALE

server= editor=
end_all() {
    [ -z "$editor" ] || kill "$editor" 2>/dev/null
    [ -z "$server" ] || kill "$server" 2>/dev/null
    wait
    rm -rf "$work"
}
trap end_all EXIT

# wait_for COMMAND…: until it succeeds; a fault after half a minute.
wait_for() {
    tries=600
    until "$@" >/dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || { fail "waited in vain: $*"; return 1; }
        sleep 0.05
    done
}

# display_open: an X server of the test's own, on a number that it finds.
display_open() {
    Xvfb -displayfd 1 -screen 0 1400x900x24 -nolisten tcp >display 2>server.log &
    server=$!
    wait_for test -s display || { cat server.log; exit 1; }
    DISPLAY=:$(cat display)
    export DISPLAY
}

window_named() { window=$(xdotool search --name "$1" 2>/dev/null | head -1) && [ -n "$window" ]; }

# window_open ARGUMENT…: tetcast edit; returns when its data are there: the title names the field then.
window_open() {
    last="edit $*"
    "$TETCAST" edit "$@" >out 2>err </dev/null &
    editor=$!
    wait_for window_named ' · ' || exit 1
    main=$window
    xdotool windowfocus --sync "$main"
}

# window_close: Ctrl+Q; the program ends well and has said nothing.
window_close() {
    keys ctrl+q
    wait "$editor" || fail "the window ended with $?"
    editor=
    stdout_empty
    stderr_empty
}

# keys NAME…: pressed one after the other.
keys() { xdotool key --delay 10 "$@"; }

# chooser KEY TITLE PATH: the key opens the chooser of that title, into which the path is typed.
chooser() {
    keys "$1"
    wait_for window_named "$2" || return
    xdotool windowfocus --sync "$window" key ctrl+a type --delay 5 "$3"
    keys Return
    wait_for chooser_is_gone "$window"
    xdotool windowfocus --sync "$main"
}
chooser_is_gone() { ! xdotool getwindowname "$1"; }

# What is written appears whole, so that a file that is there is done.
save_preset() { chooser ctrl+s 'Save the function' "$work/$1" && wait_for test -s "$work/$1"; }
save_scene() { chooser ctrl+shift+s 'Save the scene' "$work/$1" && wait_for test -s "$work/$1"; }
save_picture() { chooser ctrl+e 'Save the picture' "$work/$1" && wait_for test -s "$work/$1"; }

# pink.json: a colour map of one colour, which nothing else in the window has.
printf '[{"Name": "Pink", "ColorSpace": "RGB", "RGBPoints": [0, 1, 0, 1, 1, 1, 0, 1]}]' >pink.json

# curve_find: where the fill below the curve is in the window, if the colour map is pink.json and the curve is flat:
# left, right, top and bottom, in pixels. It is the first pink part of the panel at the right; the strip of colours, the
# second, tells left and right to the pixel.
curve_find() {
    import -window "$main" shot.png
    set -- $(convert shot.png -format '%w %h' info:)
    convert shot.png -crop "400x$2+$(($1 - 400))+0" +repage -depth 8 txt:- | awk -F'[(),: ]+' -v shift=$(($1 - 400)) '
        NR == 1 { next }
        { pink = $3 > $4 + 60 && $5 > $4 + 60 }
        pink { n[$2]++; if (!($2 in lo) || $1 < lo[$2]) lo[$2] = $1; if (!($2 in hi) || $1 > hi[$2]) hi[$2] = $1 }
        $2 > last { last = $2 }
        END {
            for (y = 0; y <= last; y++) {
                wide = n[y] > 250
                if (wide && !before) from[++parts] = y
                if (wide) to[parts] = y
                before = wide
            }
            if (parts < 2) exit 1
            y = int((from[2] + to[2]) / 2)
            print lo[y] + shift, hi[y] + 1 + shift, from[1], to[1] + 1
        }' >curve && [ -s curve ] || return 1
    read -r left right top bottom <curve
}

# drag X0 Y0 X1 Y1 STEPS: the left button, from place to place in the window, as fast as a hand would.
drag() {
    xdotool mousemove --window "$main" "$1" "$2" mousedown 1
    i=1
    while [ $i -le "$5" ]; do
        xdotool mousemove --window "$main" $(($1 + ($3 - $1) * i / $5)) $(($2 + ($4 - $2) * i / $5)) sleep 0.05
        i=$((i + 1))
    done
    xdotool mouseup 1
}

# near FILE KEY VALUE TOLERANCE: of a number in a JSON file, as of json_check.
near() {
    json "$1" ge "$2" "$(awk "BEGIN { print $3 - $4 }")" le "$2" "$(awk "BEGIN { print $3 + $4 }")"
}

# same_within A B: two pictures of one size that show something, no channel of which differs by more than 1/255.
same_within() {
    run 0 compare "$1" "$2" --json
    json out eq verdict same le max_abs 0.00393 ge covered 1000
}
