#!/usr/bin/python3
"""From the start of a process to a written PNG: tetcast, with and without its cache file, against the shortest VTK script that
does the same, and against one that loads only the modules it uses. All are run in turn, round by round, so that whatever else
the machine does falls on all of them.

  cold_start.py MESH.vtu [--field NAME] [--rounds N] [--json FILE] [--tetcast PROGRAM]

VTK's script reads, maps the range to Cool to Warm and opacity 0 to 0.3, resets the camera, and writes the window:
vtkUnstructuredGridVolumeRayCastMapper with its defaults, on all cores. Its X server (xvfb-run) runs before and is not timed.
Files are in the page cache, and shaders in Mesa's cache on disk, as after any run: one round before is not counted.
MESA_SHADER_CACHE_DISABLE=1 gives the first run of all, where programs are compiled in both. CPU: of all cores, helpers
included, the X server not. Needs python3-vtk9 and xvfb, or --no-vtk.
"""

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

VTK_PYTHON = "/usr/bin/python3"

# The shortest, and one that loads only what it uses, which starts in less time.
VTK_SHORT = """
import sys
from vtk import *
"""
VTK_MODULES = """
import sys
import vtkmodules.vtkRenderingVolumeOpenGL2
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import (vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume,
                                         vtkWindowToImageFilter)
from vtkmodules.vtkRenderingVolume import vtkUnstructuredGridVolumeRayCastMapper
"""
VTK_REST = """
mesh, field, size, picture = sys.argv[1:]
reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(mesh)
reader.Update()
grid = reader.GetOutput()
data = grid.GetPointData() if grid.GetPointData().HasArray(field) else grid.GetCellData()
data.SetActiveScalars(field)
lo, hi = data.GetArray(field).GetRange()
color, opacity = vtkColorTransferFunction(), vtkPiecewiseFunction()
color.SetColorSpaceToDiverging()
color.AddRGBPoint(lo, 0.231373, 0.298039, 0.752941)
color.AddRGBPoint((lo + hi) / 2, 0.865003, 0.865003, 0.865003)
color.AddRGBPoint(hi, 0.705882, 0.0156863, 0.14902)
opacity.AddPoint(lo, 0)
opacity.AddPoint(hi, 0.3)
mapper = vtkUnstructuredGridVolumeRayCastMapper()
mapper.SetInputData(grid)
volume = vtkVolume()
volume.SetMapper(mapper)
volume.GetProperty().SetColor(color)
volume.GetProperty().SetScalarOpacity(opacity)
volume.GetProperty().SetScalarOpacityUnitDistance(grid.GetLength() / grid.GetNumberOfCells() ** (1 / 3))
volume.GetProperty().SetInterpolationTypeToLinear()
renderer, window = vtkRenderer(), vtkRenderWindow()
renderer.AddVolume(volume)
window.AddRenderer(renderer)
window.SetSize(*[int(n) for n in size.split("x")])
window.SetOffScreenRendering(1)
renderer.ResetCamera()
window.Render()
shot, writer = vtkWindowToImageFilter(), vtkPNGWriter()
shot.SetInput(window)
shot.ReadFrontBufferOff()
shot.ShouldRerenderOff()
writer.SetInputConnection(shot.GetOutputPort())
writer.SetFileName(picture)
writer.Write()
"""


def fail(text):
    sys.exit(f"cold_start.py: {text}")


def timed(command, picture):
    """Seconds of a command that is to write picture anew, and those of all cores, its helpers' too."""
    if os.path.exists(picture):
        os.remove(picture)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    seconds = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode or not os.path.exists(picture):
        fail(f"{' '.join(command[:3])} … ended with {done.returncode}: {done.stderr.strip()[-400:]}")
    return seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(options, folder):
    mesh = os.path.join(folder, os.path.basename(options.mesh))
    shutil.copyfile(options.mesh, mesh)
    picture = os.path.join(folder, "picture.png")
    stats = os.path.join(folder, "stats.json")
    own = [options.tetcast, "render", mesh, "--field", options.field, "--size", options.size, "--quiet", "-o", picture]
    ways = {"tetcast": own, "tetcast, cache": [*own, "--cache"]}
    if not options.no_vtk:
        for name, head in {"vtk": VTK_SHORT, "vtk, modules": VTK_MODULES}.items():
            script = os.path.join(folder, f"peer{len(ways)}.py")
            with open(script, "w", encoding="utf-8") as file:
                file.write(head + VTK_REST)
            ways[name] = [VTK_PYTHON, "-B", script, mesh, options.field, options.size, picture]
    times = {name: [] for name in ways}
    for index in range(options.rounds + 1):
        for name, command in ways.items():
            both = timed(command, picture)
            if index > 0:
                times[name].append(both)
    # what a run with the cache did, so that its time is known to be one of a hit
    timed([*ways["tetcast, cache"], "--stats", stats], picture)
    with open(stats, encoding="utf-8") as file:
        cache = json.load(file).get("cache", {})
    if not cache.get("hit"):
        fail(f"the cache file was not used: {cache}")
    return times


def summary(times):
    rows = {}
    for name, both in times.items():
        seconds, cpu = zip(*both)
        rows[name] = {"median_ms": 1e3 * statistics.median(seconds), "min_ms": 1e3 * min(seconds),
                      "max_ms": 1e3 * max(seconds), "cpu_ms": 1e3 * statistics.median(cpu)}
        for peer in ("vtk", "vtk, modules"):  # of each round, then their median
            if peer in times and peer != name:
                rows[name][f"{peer} over it"] = statistics.median(v[0] / s for v, s in zip(times[peer], seconds))
    return rows


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    built = os.path.join(here, "..", "..", "build", "tetcast")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="a VTU file of tets")
    parser.add_argument("--field", default="Density")
    parser.add_argument("--size", default="512x512", help="WxH")
    parser.add_argument("--rounds", type=int, default=9, help="counted ones; default 9")
    parser.add_argument("--tetcast", default=built, help="the program; default that of build/")
    parser.add_argument("--no-vtk", action="store_true", help="tetcast alone")
    parser.add_argument("--json", help="write the figures there; - for standard output")
    options = parser.parse_args()
    options.tetcast = shutil.which(options.tetcast) or fail(f"{options.tetcast} is no program; build it first")
    if options.rounds < 1:
        fail("--rounds takes 1 or more")
    if not options.no_vtk and not os.environ.get("DISPLAY"):
        if not shutil.which("xvfb-run"):
            fail("no X display and no xvfb-run: VTK has no other kind of window; give --no-vtk")
        os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1024x768x24", sys.executable, *sys.argv])
    with tempfile.TemporaryDirectory() as folder:
        times = measure(options, folder)
    rows = summary(times)
    out = {"mesh": os.path.basename(options.mesh), "field": options.field, "size": options.size, "rounds": options.rounds,
           "cores": len(os.sched_getaffinity(0)), "rows": rows}
    if options.json and options.json != "-":
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(out, file, indent=1)
    if options.json == "-":
        print(json.dumps(out, indent=1))
        return
    print(f"{out['mesh']}, {options.size}, {options.rounds} rounds, {out['cores']} cores: process start to written PNG")
    for name, row in rows.items():
        ratio = "".join(f"   {key[:-8]} takes {row[key]:.2f} x" for key in row if key.endswith(" over it"))
        print(f"  {name:15} {row['median_ms']:6.0f} ms ({row['min_ms']:.0f} … {row['max_ms']:.0f}), CPU {row['cpu_ms']:.0f} ms"
              f"{ratio if name.startswith('tetcast') else ''}")


if __name__ == "__main__":
    main()
