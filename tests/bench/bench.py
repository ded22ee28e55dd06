#!/usr/bin/python3
"""Measures tetcast: beside VTK's volume renderers, and by itself. Results: BUILD/bench/results.json, of which docs/performance.py
makes docs/performance.md.

Sections (--only A,B,… takes some; the results of the others stay):

  peers        frame times and pictures of tetcast and VTK's renderers, same mesh, function and cores, view by view in one run;
               the 2003 paper's table 2
  passes       frame time against cells a pass; K = 1 is the paper's
  integration  the default integrator against a walk that integrates nothing, on the same rays
  parts        where a step's time goes: parts left out or done twice, and the least that bytes and instructions allow
  signs        exact signs against plain float signs
  bytes        memory a tet
  transfer     a new transfer function to the next frame
  values       new values on the same mesh
  batch        frames a minute of a batch, against the same loop in VTK's Python and tetcast once a frame
  edit         the window: from a move of the pointer to its picture, and how long it lets events wait
  cold         process start to written PNG, against a VTK script
  growth       set-up and frame time against the number of cells, up to 5e7
  tables       the pre-integration table, incremental against entry by entry
  counts       instructions under callgrind

Needs the built program and `bench_programs`; for VTK python3-vtk9, python3-numpy, xvfb. What is not there is left out, and named.
Exit code 1: something failed; with --check 3: a bar is not met, or was not measured, since a section that has bars, or a part
of it, was left out.
"""

import argparse
import os
import sys
import time

sys.dont_write_bytecode = True
import batch  # noqa: E402
import common  # noqa: E402
import edit  # noqa: E402
import growth  # noqa: E402
import peer_vtk  # noqa: E402
import peers  # noqa: E402
import programs  # noqa: E402
import steps  # noqa: E402

SECTIONS = {"peers": peers.measure, "passes": steps.passes, "integration": steps.integration, "parts": steps.parts,
            "signs": steps.signs, "bytes": programs.bytes_per_tet, "transfer": programs.transfer, "values": programs.values,
            "batch": batch.measure, "edit": edit.measure,
            "cold": programs.cold_start, "growth": growth.measure, "tables": programs.tables, "counts": programs.counts}
HAVE_BARS = {"peers", "integration", "bytes", "transfer", "values", "batch", "edit", "cold", "growth"}


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(common.ROOT, "build"), help="folder of the built program")
    parser.add_argument("--data", default=os.environ.get("TETCAST_DATA", os.path.join(os.path.dirname(common.ROOT), "shared", "data")),
                        help="folder of real meshes")
    parser.add_argument("--only", help="sections, by commas: " + ", ".join(SECTIONS))
    parser.add_argument("--skip", default="", help="sections, by commas")
    parser.add_argument("--quick", action="store_true", help="small and few, to try it; results go to BUILD/bench-quick")
    parser.add_argument("--rows", help="of peers, by commas: " + ", ".join(row["name"] for row in peers.ROWS))
    parser.add_argument("--mappers", default=",".join(peers.FAST), help="of peers, by commas: " + ", ".join(peer_vtk.MAPPERS))
    parser.add_argument("--variants", help="of peers, by commas: " + ", ".join(peers.VARIANTS))
    parser.add_argument("--azimuths", default="0,60,120,180,240,300")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2, help="of every renderer")
    parser.add_argument("--most-cells", type=int, default=50_000_000, help="of growth")
    parser.add_argument("--check", action="store_true", help="exit code 3 when a bar is not met or was left out")
    options = parser.parse_args()
    width, height = options.size.split("x")
    if width != height:
        parser.error("--size must be square: ResetCamera's view depends on the shape of the window")
    if options.quick:
        options.size, options.frames, options.azimuths = "96x96", 1, "0,60"
    options.build = os.path.abspath(options.build)
    options.work = os.path.join(options.build, "bench-quick" if options.quick else "bench")
    options.mappers = [name for name in options.mappers.split(",") if name]
    options.variants = options.variants.split(",") if options.variants else []
    options.azimuths = [float(a) for a in options.azimuths.split(",")]
    names = [row["name"] for row in peers.ROWS]
    chosen = options.rows.split(",") if options.rows else names if not options.quick else ["bluntfin", "heatsink", "ball"]
    only = options.only.split(",") if options.only else list(SECTIONS)
    skip = [name for name in options.skip.split(",") if name]
    for name, known in ([(n, peer_vtk.MAPPERS) for n in options.mappers] + [(n, peers.VARIANTS) for n in options.variants] +
                        [(n, names) for n in chosen] + [(n, SECTIONS) for n in only + skip]):
        if name not in known:
            parser.error(f"no '{name}'; there are {', '.join(known)}")
    options.rows = [row for row in peers.ROWS if row["name"] in chosen]
    options.sections = [name for name in SECTIONS if name in only and name not in skip]
    return options


def unmeasured(name, entry, quick):
    """Was a section that has bars, or a part of it, left out? A quick run has fewer bars."""
    if name not in HAVE_BARS:
        return False
    return "left_out" in entry or bool(entry.get("data", {}).get("left_out")) or not (entry.get("bars") or quick)


def exit_code(options, sections):
    """Of the entries of the sections that were run."""
    ran = {name: sections[name] for name in options.sections}
    if any("failed" in entry for entry in ran.values()):
        return 1
    if options.check and any(unmeasured(name, entry, options.quick) or not all(b["met"] for b in entry.get("bars", []))
                             for name, entry in ran.items()):
        return 3
    return 0


def main():
    options = parse()
    if not os.access(os.path.join(options.build, "tetcast"), os.X_OK):
        sys.exit(f"{os.path.join(options.build, 'tetcast')} is not there; build it first (make)")
    os.makedirs(options.work, exist_ok=True)
    path = os.path.join(options.work, "results.json")
    results = common.read_json(path) or {"sections": {}}
    results.update(cores=len(os.sched_getaffinity(0)), quick=options.quick,
                   version=common.run([os.path.join(options.build, "tetcast"), "--version"]).strip())
    for name in options.sections:
        load = os.getloadavg()[0]
        print(f"\n== {name}: {SECTIONS[name].__doc__.strip().splitlines()[0]}" +
              (f"\n   load {load:.1f} at its start: other work beside this makes times wrong" if load > len(os.sched_getaffinity(0)) + 0.5
               else ""), flush=True)
        start = time.monotonic()
        entry = {"load": load}
        try:
            entry["data"], entry["bars"] = SECTIONS[name](options)
            for b in entry["bars"]:
                print("  " + common.bar_text(b))
        except common.Absent as absent:
            entry["left_out"] = str(absent)
            print(f"  left out: {absent}")
        except common.Failure as failure:
            entry["failed"] = str(failure)
            print(f"  failed: {failure}")
        entry["seconds"] = time.monotonic() - start
        print(f"  ({entry['seconds']:.0f} s)", flush=True)
        results["sections"][name] = entry
        common.write_json(path, results)
    bars = [b for name in options.sections for b in results["sections"][name].get("bars", [])]
    print(f"\nBars: {sum(b['met'] for b in bars)} of {len(bars)} met" + (", which means nothing with --quick" if options.quick else ""))
    for b in bars:
        print("  " + common.bar_text(b))
    for name in options.sections:
        for key in ("left_out", "failed"):
            if key in results["sections"][name]:
                print(f"  {name}: {key.replace('_', ' ')}: {results['sections'][name][key]}")
        if unmeasured(name, results["sections"][name], options.quick):
            print(f"  {name}: not all of its bars were measured")
    print(f"\neverything measured: {path}; docs/performance.md is made of it by `make docs` or docs/performance.py")
    sys.exit(exit_code(options, results["sections"]))


if __name__ == "__main__":
    main()
