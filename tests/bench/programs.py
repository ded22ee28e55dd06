"""What other programs and scripts measure: bytes a tet, cold start, new values, new functions, counts, tables."""

import json
import os
import shutil

import common
from common import Absent, Failure, bar, program, run, script
from steps import mesh_and_size


def bytes_per_tet(options):
    """Memory of Blunt Fin on the GPU, from --stats: of all cells, imaginary ones, too."""
    mesh = common.real_mesh(options, "bluntfin_tets.vtu")
    stats = os.path.join(options.work, "bytes.json")
    run([program(options, "tetcast"), "render", mesh, "--field", "Density", "--size", "512x512", "--quiet", "--stats", stats, "-o",
         os.path.join(options.work, "bytes.exr")])
    found = common.read_json(stats)["mesh"]
    cells = found["tets"] + found["imaginary_tets"]
    data = {"cells": cells, "imaginary": found["imaginary_tets"], "points": found["points"],
            "mesh": found["gpu_bytes"] / cells, "other": found["gpu_bytes_other"] / cells,
            "table_bytes": found["gpu_bytes_table"], "state_bytes": found["gpu_bytes_state"]}
    print(f"  {data['mesh']:.2f} bytes a tet in cells and vertices, {data['other']:.2f} in all else but tables and state; tables "
          f"{data['table_bytes'] / 2**20:.2f} MiB, state {data['state_bytes'] / 2**20:.2f} MiB")
    return data, [bar("bytes a tet: cells and vertices", data["mesh"], 23.6),
                  bar("bytes a tet: all but tables and state", data["mesh"] + data["other"], 24.5)]


def cold_start(options):
    """From the start of the process to the written PNG, against the shortest VTK script."""
    mesh, out = common.real_mesh(options, "bluntfin_tets.vtu"), os.path.join(options.work, "cold_start.json")
    command = [common.VTK_PYTHON, script("cold_start.py"), mesh, "--tetcast", program(options, "tetcast"), "--json", out]
    if not (os.environ.get("DISPLAY") or shutil.which("xvfb-run")):
        command.append("--no-vtk")
        print("  VTK is left out: it needs an X display; install xvfb")
    for line in run(command + ["--rounds", "1" if options.quick else "7"], limit=300).splitlines():
        print("  " + line)
    found = common.read_json(out)
    return found, [bar(f"{what}: faster than the shortest VTK script", found["rows"][name]["vtk over it"], least, least=True)
                   for what, name, least in (("cold start", "tetcast", 2.5), ("cold start with a cache file", "tetcast, cache", 4))
                   if "vtk over it" in found["rows"][name]]


def values(options):
    """New values on the same mesh, against a full set-up."""
    found = json.loads(run([program(options, "bench_values"), "--json", *(["20000", "2"] if options.quick else ["1000000", "5"])],
                           options.threads, 300))
    print(f"  {found['tets']} tets: set-up {found['ms_set_up']:.1f} ms, new values of points {found['ms_point_values']:.2f} ms, of cells "
          f"{found['ms_cell_values']:.2f} ms")
    return found, [bar(f"new values of {what} on 10^6 tets, share of a full set-up", found[f"ratio_{key}_values"], 0.05)
                   for what, key in (("points", "point"), ("cells", "cell"))]


def transfer(options):
    """A new transfer function to the next frame, against a frame alone."""
    what = mesh_and_size(options)
    field = what[what.index("--field") + 1] if "--field" in what else ""
    found = json.loads(run([program(options, "bench_transfer"), what[0], field, what[-1], "5" if options.quick else "31"],
                           options.threads, 300))
    for name in ("default", "table"):
        f = found[name]
        print(f"  {name:<8} ({f['integrator']}): frame {f['frame_ms']:.2f} ms, change {f.get('change_ms', 0):.2f} ms, "
              f"{f['ratio']:.3f} x a frame")
    return found, [bar("a new transfer function to the next frame, by a frame", found["default"]["ratio"], 1.5)]


def counts(options):
    """Instructions under callgrind: the same in every run."""
    if not shutil.which("valgrind"):
        raise Absent("valgrind is not installed")
    text = run(["sh", script("counts.sh"), program(options, "bench_setup")] + (["kuhn", "5000"] if options.quick else []), limit=600)
    groups = []
    for line in text.splitlines():
        print("  " + line)
        words = line.rsplit(None, 1)
        if line.endswith(("a tet", "an entry")):
            groups.append({"title": line, "rows": []})
        elif len(words) == 2 and groups:
            groups[-1]["rows"].append({"what": words[0].strip(), "count": float(words[1])})
    if not groups:
        raise Failure("counts.sh printed no figures")
    return {"groups": groups}, []


def tables(options):
    """The pre-integration table, incremental against entry by entry."""
    text = run([program(options, "bench_table")] + (["32", "32", "32"] if options.quick else []), limit=300)
    print(text)
    rows = []
    for line in text.splitlines()[2:]:
        words = line.rsplit(None, 5)
        if len(words) == 6:
            rows.append(dict(zip(("function", "bits", "one_thread_ms", "two_threads_ms", "entry_by_entry_ms", "ratio"),
                                 [words[0].strip()] + [float(w) for w in words[1:]])))
    if not rows:
        raise Failure("bench_table printed no rows")
    return {"rows": rows, "size": text.splitlines()[0].split(",")[0]}, []
