#!/usr/bin/python3
"""The hand at the window of `tetcast edit`: opens it on a display of its own without a screen (Xvfb), drags as a
person does, ends it.

  edit_hand.py TETCAST INPUT TRACE drag SECONDS   a point of the opacity curve for some seconds, rest, the view likewise, rest
  edit_hand.py TETCAST INPUT TRACE load SECONDS   moves over the window from the beginning on, then drags the view, rests, drags, …

The window makes the trace; its places are those of the layout with the theme and font of a bare Debian 12.
"""

import contextlib
import math
import os
import signal
import subprocess
import sys
import tempfile
import time

WIDTH, HEIGHT = 1261, 678  # of the window: a picture 800 wide, and 600 high or, where the panel beside it needs more, higher
POINT = (1237, 242)  # the curve's last point
MIDDLE = (400, 350)  # of the picture
PERIOD = 1 / 60
OWN = 0.0012  # what a move takes beside its sleep


@contextlib.contextmanager
def display():
    """A display that takes the first number that is free; xvfb-run would race others for one."""
    command = ["Xvfb", "-displayfd", "1", "-screen", "0", "1500x1000x24", "-nolisten", "tcp", "-noreset"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        try:
            number = server.stdout.readline().strip()
            if not number:
                sys.exit("Xvfb did not start")
            os.environ["DISPLAY"] = ":" + number
            os.environ.pop("WAYLAND_DISPLAY", None)
            yield
        finally:
            server.terminate()


def xdotool(*words):
    done = subprocess.run(["xdotool", *map(str, words)], capture_output=True, text=True, check=False)
    return done.stdout.split()


def open_window(tetcast, name, trace, state):
    env = dict(os.environ, XDG_STATE_HOME=state, XDG_CACHE_HOME=state, GSETTINGS_BACKEND="memory", GTK_A11Y="none", LC_ALL="C.UTF-8")
    window = subprocess.Popen([tetcast, "edit", name, "--trace", trace], env=env)
    start = time.monotonic()
    while time.monotonic() - start < 30 and window.poll() is None:
        found = xdotool("search", "--onlyvisible", "--name", name)
        if found:
            xdotool("windowsize", found[-1], WIDTH, HEIGHT)
            return window
        time.sleep(0.05)
    window.kill()
    sys.exit("the window did not open")


def path(seconds, place):
    """Words of xdotool for moves at 60 Hz; place: of the move's number."""
    words = []
    for i in range(int(seconds / PERIOD)):
        words += ["mousemove", *map(round, place(i)), "sleep", f"{PERIOD - OWN:.4f}"]
    return words


def drag(start, seconds, place):
    xdotool("mousemove", *start, "sleep", 0.1, "mousedown", 1, *path(seconds, place), "mouseup", 1)


def around(i):
    return MIDDLE[0] + 150 * math.sin(i * 0.03), MIDDLE[1] + 60 * math.sin(i * 0.05)


def main():
    tetcast, name, trace, what, seconds = *sys.argv[1:5], float(sys.argv[5])
    with tempfile.TemporaryDirectory() as state, display():
        xdotool("mousemove", *MIDDLE)
        window = open_window(tetcast, name, trace, state)
        if what == "drag":
            time.sleep(4)
            drag(POINT, seconds, lambda i: (POINT[0], POINT[1] - 30 * math.sin(i * 0.05)))
            time.sleep(3)
            drag(MIDDLE, seconds, around)
            time.sleep(3)
        else:
            xdotool(*path(seconds, around))
            for _ in range(3):
                drag(MIDDLE, seconds / 4, around)
                xdotool(*path(seconds / 4, around))
        window.send_signal(signal.SIGTERM)
        code = window.wait(60)
    sys.exit(code)


if __name__ == "__main__":
    main()
