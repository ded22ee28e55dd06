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

# Leaks of the window are judged by edit_random.sh: each window has 128 bytes of Mesa's driver, which cannot be told apart.
leaks=${LSAN_OPTIONS:-}
[ "${TC_SANITIZE:-OFF}" = OFF ] || export LSAN_OPTIONS=detect_leaks=0

server= editor=
end_all() {
    [ -z "$editor" ] || kill "$editor" 2>/dev/null
    [ -z "$server" ] || kill "$server" 2>/dev/null
    wait
    rm -rf "$work"
}
trap end_all EXIT

# wait_for COMMAND…: until it succeeds; after half a minute the test ends.
wait_for() {
    tries=600
    until "$@" >/dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || { fail "waited in vain: $*"; exit 1; }
        sleep 0.05
    done
}

# display_open: an X server of the test's own, on a number that it finds.
# It is not to begin anew when its last client goes, an xdotool before there is a window.
display_open() {
    Xvfb -displayfd 1 -screen 0 1400x900x24 -nolisten tcp -noreset >display 2>server.log &
    server=$!
    wait_for test -s display
    DISPLAY=:$(cat display)
    export DISPLAY
}

window_named() { window=$(xdotool search --name "$1" 2>/dev/null | head -1) && [ -n "$window" ]; }

window_or_end() { window_named ' · ' || ! kill -0 "$editor"; }

# window_open ARGUMENT…: tetcast edit; returns when its data are there: the title names the field then.
window_open() {
    last="edit $*"
    "$TETCAST" edit "$@" >out 2>err </dev/null &
    editor=$!
    wait_for window_or_end
    window_named ' · ' || { fail "there is no window"; exit 1; }
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

# chooser KEY TITLE WAY PATH: the key opens the chooser of that title, into which, after the keys WAY, the path is typed.
chooser() {
    keys "$1"
    wait_for window_named "$2"
    xdotool windowfocus --sync "$window"
    rounds=8
    until chooser_is_gone "$window"; do # while it reads its folder it may lose keys: then again
        [ $rounds -gt 0 ] || { fail "the chooser does not take $4"; exit 1; }
        rounds=$((rounds - 1))
        keys $3
        xdotool type --delay 5 "$4"
        keys Return
        tries=40
        until chooser_is_gone "$window" || [ $tries -eq 0 ]; do
            tries=$((tries - 1))
            sleep 0.05
        done
    done
    xdotool windowfocus --sync "$main"
}
chooser_is_gone() { ! xdotool getwindowname "$1" >/dev/null 2>&1; }

# What is written appears whole, so that a file that is there is done.
save_preset() { chooser ctrl+s 'Save the function' ctrl+a "$work/$1"; wait_for test -s "$work/$1"; }
save_scene() { chooser ctrl+shift+s 'Save the scene' ctrl+a "$work/$1"; wait_for test -s "$work/$1"; }
save_picture() { chooser ctrl+e 'Save the picture' ctrl+a "$work/$1"; wait_for test -s "$work/$1"; }

open_file() { chooser ctrl+o 'Open data' 'ctrl+l ctrl+a' "$work/$1"; }

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

# is_for_paraview FILE: what vtkSMTransferFunctionPresets and vtkSMTransferFunctionProxy ask of a preset: an array of
# objects with a name of their own, a known space, whole rows of colours and of opacities in the order of their scalars,
# all within 0 and 1.
is_for_paraview() {
    command -v python3 >/dev/null || return 0
    python3 - "$1" >why 2>&1 <<'RULES' || fail "$1: $(tail -1 why)"
import json, sys
for preset in json.load(open(sys.argv[1])):
    assert isinstance(preset["Name"], str) and preset["Name"], "no name"
    assert preset["ColorSpace"] in ("RGB", "HSV", "Lab", "CIELAB", "Diverging", "Lab/CIEDE2000", "Step"), "colour space"
    for key in ("RGBPoints", "Points"):
        row = [preset[key][i:i + 4] for i in range(0, len(preset[key]), 4)]
        assert len(row) > 1 and len(row[-1]) == 4, key + " are not whole rows"
        assert all(type(v) in (int, float) for r in row for v in r), key + " are not numbers"
        assert all(a[0] <= b[0] for a, b in zip(row, row[1:])) and row[0][0] < row[-1][0], key + " are out of order"
        assert all(0 <= v <= 1 for r in row for v in r[1:]), key + " are beyond 0 and 1"
    assert preset["RGBPoints"][0] <= preset["Points"][0] and preset["Points"][-4] <= preset["RGBPoints"][-4], \
        "opacities beyond the colours"
    assert len(preset.get("NanColor", [0] * 3)) == 3, "NanColor"
RULES
}
