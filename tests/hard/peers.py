#!/usr/bin/python3
"""The hard cases through VTK's own volume renderers: how many pixels each gets wrong, beside tetcast.

  build/hard --context osmesa --export DIR
  xvfb-run -a /usr/bin/python3 tests/hard/peers.py DIR [--table FILE.md] [--json FILE] [--timeout 60]

Each case and mapper runs in a process of its own (tests/bench/peer_vtk.py), so that one that crashes or hangs is a row of
the table and no more. Colour and opacity share one list of knots. A pixel is wrong where a channel differs by more than
8/255 from the double-precision reference. Needs python3-vtk9, python3-numpy and an X display.
"""

import argparse
import glob
import json
import os
import signal
import subprocess
import sys
import tempfile

import numpy

sys.dont_write_bytecode = True

BENCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "bench", "peer_vtk.py")
# Of the Bunyk mapper's ray integrators the partial pre-integration errs least where colour and opacity share knots.
MAPPERS = {"bunyk-partial": "Bunyk", "projected": "projected tetrahedra"}
WRONG = 8 / 255


def read(path, case):
    width, height = case["size"]
    return numpy.fromfile(path, "<f4").reshape(height, width, 4)


def wrong_pixels(picture, truth):
    """How many pixels are wrong, and the largest error; what is not finite is wrong."""
    error = numpy.abs(picture.astype("f8") - truth).max(axis=2)
    error = numpy.where(numpy.isfinite(error), error, numpy.inf)
    return int((error > WRONG).sum()), float(error.max())


def ending(code):
    return f"ended by {signal.Signals(-code).name}" if code < 0 else f"ended with {code}"


def ask_peer(stem, case, mapper, timeout):
    """The mapper's picture, or in words why there is none."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("knots", "camera"):
            with open(f"{folder}/{name}.json", "w", encoding="utf-8") as file:
                json.dump(case[name], file)
        width, height = case["size"]
        command = [sys.executable, BENCH, stem + ".vtu", "--mapper", mapper, "--size", f"{width}x{height}", "--transfer",
                   f"{folder}/knots.json", "--camera", f"{folder}/camera.json", "--unit-distance",
                   repr(case["unit_distance"]), "--frames", "1", "--threads", "1", "--picture", f"{folder}/picture"]
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=timeout, check=False)
        except subprocess.TimeoutExpired:
            return None, f"not done in {timeout:g} s"
        found = glob.glob(f"{folder}/picture_*.rgba")
        if done.returncode != 0 or not found:
            return None, ending(done.returncode)
        return read(found[0], case), ""


def judge(stem, timeout):
    with open(stem + ".json", encoding="utf-8") as file:
        case = json.load(file)
    truth = read(stem + ".reference.rgba", case)
    row = {"case": case["name"], "eye_inside": case["eye_inside"], "ill_posed": case["ill_posed"], "pixels": int(truth.shape[0] * truth.shape[1]), "seen": int((truth[..., 3] > 0).sum())}
    row["tetcast"] = dict(zip(("wrong", "worst"), wrong_pixels(read(stem + ".tetcast.rgba", case), truth)))
    for mapper in MAPPERS:
        picture, why = ask_peer(stem, case, mapper, timeout)
        row[mapper] = {"none": why} if picture is None else dict(zip(("wrong", "worst"), wrong_pixels(picture, truth)))
    return row


def cell(result):
    return result.get("none") or f"{result['wrong']}"


def total(rows, what):
    names = ["tetcast", *MAPPERS]
    wrong = [sum(row[name].get("wrong", 0) for row in rows) for name in names]
    none = [sum("none" in row[name] for row in rows) for name in names]
    return f"| **{what}: {len(rows)}** | {sum(row['seen'] for row in rows)} | " + " | ".join(
        f"{count}" + (f", and {missing} without a picture" if missing else "") for count, missing in zip(wrong, none)) + " |"


def table(rows):
    names = ["tetcast", *MAPPERS]
    lines = ["| case | pixels that see the mesh | wrong by tetcast | " +
             " | ".join(f"by VTK's {name}" for name in MAPPERS.values()) + " |", "|---|--:|--:|--:|--:|"]
    for row in rows:
        lines.append(f"| {row['case']} | {row['seen']} | " + " | ".join(cell(row[name]) for name in names) + " |")
    lines.append(total([row for row in rows if not row["eye_inside"]], "eye outside"))
    lines.append(total([row for row in rows if row["eye_inside"]], "eye inside"))
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="what `hard --export` wrote")
    parser.add_argument("--table", help="writes the table as markdown")
    parser.add_argument("--json", help="writes the rows as JSON")
    parser.add_argument("--timeout", type=float, default=60, help="seconds for each case and mapper")
    options = parser.parse_args()
    if not os.environ.get("DISPLAY"):
        sys.exit("no X display: run under xvfb-run -a")
    stems = sorted(path[:-len(".vtu")] for path in glob.glob(os.path.join(options.folder, "*.vtu")))
    if not stems:
        sys.exit(f"{options.folder}: no cases; make them with hard --export")
    rows = []
    for stem in stems:
        rows.append(judge(stem, options.timeout))
        print(json.dumps(rows[-1]), flush=True)
    text = table(rows)
    for path, what in ((options.table, text), (options.json, json.dumps(rows, indent=1) + "\n")):
        if path:
            with open(path, "w", encoding="utf-8") as file:
                file.write(what)
    print(text)
    if any(row["tetcast"]["wrong"] > row["ill_posed"] for row in rows):
        sys.exit("tetcast has wrong pixels")


if __name__ == "__main__":
    main()
