#!/bin/sh
# window.sh BUILD OUT.png: a picture of the window, for the README: the Blunt Fin over a logarithmic opacity axis, one ray probed.
# Needs xvfb, xdotool, ImageMagick. Runs itself again under Xvfb.
set -eu
build=$1 out=$2
if [ "${3:-}" != inside ]; then
    exec xvfb-run -a -s "-screen 0 1280x820x24 -noreset" sh "$0" "$build" "$out" inside
fi
state=$(mktemp -d)
trap 'kill "$pid" 2>/dev/null || true; rm -rf "$state"' EXIT
XDG_STATE_HOME=$state "$build/tetcast" edit --trace "$state/trace.json" synth:bluntfin --color-map Viridis --azimuth 25 --elevation 20 \
    --opacity 0.65:0,1.2:0.0005,2.2:0.02,3:0.4,4.3:0.9 2>/dev/null &
pid=$!
n=0
until xdotool search --onlyvisible --name bluntfin >/dev/null 2>&1 || [ $((n += 1)) -gt 150 ]; do sleep 0.1; done
sleep 4
point() {
    xdotool mousemove "$1" "$2"
    sleep 0.5
}
point 858 101
xdotool click 1 # logarithmic axis
point 350 420
xdotool click 1
sleep 0.5
xdotool key p
point 352 422
sleep 3
import -window root "$out"
kill "$pid"
