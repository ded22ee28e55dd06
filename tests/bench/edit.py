"""The window of `tetcast edit`, under a hand: from a move of the pointer to its picture, by the window's own trace."""

import json
import os
import shutil
import statistics

from common import Absent, Failure, bar, program, run, script

FUNCTION, CAMERA = 1, 4  # bits of what a move changed
PICTURE = 800 * 600


def hand(options, name, what, seconds):
    """The events of the trace, in order, times in milliseconds."""
    for tool in ("Xvfb", "xdotool"):
        if not shutil.which(tool):
            raise Absent(f"{tool} is not there: install xvfb and xdotool")
    program(options, "tetcast-edit")
    trace = os.path.join(options.work, "edit.json")
    run([script("edit_hand.py"), program(options, "tetcast"), name, trace, what, str(seconds)], options.threads, 120 + 10 * seconds)
    with open(trace, encoding="utf-8") as file:
        events = json.load(file)["traceEvents"]
    for e in events:
        e["at"], e["ms"] = e["ts"] / 1e3, e.get("dur", 0) / 1e3
    return sorted(events, key=lambda e: e["at"])


def named(events, name):
    return [e for e in events if e["name"] == name]


def value(event, key):
    return event["args"].get(key)


def median(values):
    return statistics.median(values) if values else None


def size_of(events):
    last = {}
    for e in named(events, "size"):
        last.update({key: value(e, key) for key in ("width", "height") if key in e["args"]})
    return [int(last[key]) for key in ("width", "height")]


def moved(events, bit):
    """The moves of a drag: what changed this bit alone of the picture's, after the window was settled."""
    settled = max(e["at"] for e in named(events, "size"))
    return [e for e in named(events, "pointer") if e["at"] > settled and int(value(e, "changes")) & (FUNCTION | CAMERA | 8 | 16) == bit]


def drag_of(events, bit):
    """Of one drag: how long a move waited for the picture of it or of a later one, from when the display took it; pictures; rest."""
    moves, shown, late = moved(events, bit), named(events, "shown"), named(events, "event")
    if len(moves) < 20:
        raise Failure("the pointer did not reach what it was to drag: see POINT and MIDDLE of edit_hand.py")
    wait, coarse, step = [], [], 0
    for e in moves:
        while step + 1 < len(late) and late[step + 1]["at"] <= e["at"]:
            step += 1
        after = next((s for s in shown if s["args"]["id"] >= e["args"]["id"]), None)
        if after:
            wait.append(after["at"] - e["at"] + (value(late[step], "late_ms") or 0))
            coarse.append(value(after, "divide"))
    own = {e["args"]["id"] for e in moves}
    last = moves[-1]
    rest = next((e["at"] - last["at"] for e in named(events, "rest") if e["args"]["id"] >= last["args"]["id"]), None)
    seconds = (last["at"] - moves[0]["at"]) / 1e3
    return {"moves": len(moves), "seconds": seconds, "wait_ms": median(wait), "wait_most_of_ten_ms": sorted(wait)[int(0.9 * len(wait))],
            "pictures_per_second": sum(s["args"]["id"] in own for s in shown) / seconds, "divide": median(coarse), "rest_ms": rest}


def function_of(events):
    """A change of the function: it is made, its table built and uploaded."""
    own = {e["args"]["id"] for e in moved(events, FUNCTION)}
    made = {e["args"]["id"]: e["ms"] for e in named(events, "function") if e["args"]["id"] in own}
    table = {e["args"]["id"]: e["ms"] for e in named(events, "table") if e["args"]["id"] in own}
    return median([made.get(i, 0) + ms for i, ms in table.items()])


def dragged(options, seconds):
    events = hand(options, "synth:bluntfin", "drag", seconds)
    width, height = size_of(events)
    if width * height < 0.99 * PICTURE:
        raise Failure(f"the picture has {width}x{height} pixels, fewer than 800x600: see WIDTH and HEIGHT of edit_hand.py")
    return {"size": [width, height], "curve": drag_of(events, FUNCTION), "orbit": drag_of(events, CAMERA), "function_ms": function_of(events)}


def loaded(options, cells, seconds):
    """The longest that an event or anything else that was due waited, from when the window was there to the last move."""
    events = hand(options, f"synth:kuhn:{cells}", "load", seconds)
    came, rest, frames = named(events, "event"), named(events, "rest"), named(events, "frame")
    moves = moved(events, CAMERA)
    if not came or not frames or len(moves) < 20:
        raise Failure("the pointer did not reach the window while it loaded")
    begin, end = came[0]["at"], came[-1]["at"]
    there = next((e["at"] for e in named(events, "shown")), None)
    held = [e["ms"] for e in named(events, "held") if begin <= e["at"] <= end]
    late = [value(e, "late_ms") for e in came if value(e, "late_ms") is not None]
    return {"cells": cells, "events": len(came), "loading_ms": there and there - events[0]["at"], "held_most_ms": max(held, default=0),
            "late_most_ms": max(late, default=None), "late_ms": median(late), "orbit": drag_of(events, CAMERA), "rests": len(rest)}


def measure(options):
    """The window: from a move of the pointer to its picture; how long it lets events wait."""
    seconds, rounds = (2, 1) if options.quick else (5, 3)
    runs = [dragged(options, seconds) for _ in range(rounds)]
    large = [loaded(options, 1_000_000 if options.quick else 10_000_000, seconds) for _ in range(rounds)]
    whole = {}
    for what in ("curve", "orbit"):
        for key in ("wait_ms", "wait_most_of_ten_ms", "rest_ms", "pictures_per_second", "divide"):
            values = [r[what][key] for r in runs if r[what][key] is not None]
            whole[f"{what}_{key}"] = {"median": median(values), "least": min(values, default=None)} if len(values) == len(runs) else None
    whole["function_ms"] = {"median": median([r["function_ms"] for r in runs]), "least": min(r["function_ms"] for r in runs)}
    waits = [max(r["held_most_ms"], r["late_most_ms"] or 0) for r in large]
    whole["event_ms"] = {"median": median(waits), "least": min(waits)}
    for key, v in whole.items():
        print(f"  {key}: " + (f"{v['median']:.3g} (least disturbed run {v['least']:.3g})" if v else "not reached"))

    def reached(key):
        return whole[key]["median"] if whole[key] else None
    bars = [bar("pointer to new picture while a curve point is dragged, ms, median", reached("curve_wait_ms"), 100),
            bar("pointer to new picture while the view is turned, ms, median", reached("orbit_wait_ms"), 100),
            bar("last move of a curve point to the picture at full accuracy, ms", reached("curve_rest_ms"), 1000),
            bar("last turn to the picture at full accuracy, ms", reached("orbit_rest_ms"), 1000),
            bar("a function made, its table built and uploaded, ms", reached("function_ms"), 15),
            bar(f"longest wait of an event while {large[0]['cells']:.0e} cells load and refine, ms", reached("event_ms"), 100)]
    return {"runs": runs, "large": large, "whole": whole, "size": runs[0]["size"]}, [] if options.quick else bars
