"""tetcast and VTK's volume renderers side by side: frame times, ratios and the difference of their pictures.

Every mesh is drawn with one transfer function (shared knots), one unit distance and one camera per azimuth by all renderers
in turn, view by view, so that whatever else the machine does falls on all of them. Frame: the median over --frames frames of
one view after a warm-up; a row's time: the mean over the views. Times of tetcast are `frame` of `render --stats` (first hit,
march, resolve), those of VTK are Render() until the GL is done; reading the picture back is in neither. Meshes that are not
there are left out, and named.
"""

import json
import os
import shutil
import statistics
import subprocess
import sys

import common
import peer_vtk  # VTK itself is loaded by the peer's own process
from common import Absent, Failure, bar, run

FAST = ["bunyk-preintegrated", "bunyk-partial", "projected"]

# The rows with "paper" stand for those of table 2 of Weiler et al. 2003 (title, cells, frames a second on a Radeon 9700 Pro,
# 512 x 512): Blunt Fin is the same mesh, the others have other shapes of the same number of cells. "whole": all views, each
# picture compared with the reference; of the others few views, of which the first is compared.
ROWS = [
    {"name": "bluntfin", "file": "bluntfin_tets.vtu", "field": "Density", "whole": True, "paper": ["Blunt Fin", 190852, 3.37],
     "speed_bar": {"bunyk-preintegrated": [6.2, 7], "bunyk-partial": [12, 14], "projected": [4.4, 5]}, "picture_bar": True},
    {"name": "heatsink", "synth": "heatsink", "cells": 124152, "paper": ["heat sink", 124152, 2.27]},
    {"name": "cylinder", "synth": "cylinder", "cells": 203460, "paper": ["cylinder", 203460, 1.94]},
    {"name": "ball", "synth": "ball", "cells": 148955, "paper": ["sphere", 148955, 5.13]},
    {"name": "disk_out_ref", "file": "vol/disk_out_ref.vtu", "field": "Temp", "split": True, "picture_bar": True},
    {"name": "combustor", "file": "combustor_tets.vtu", "field": "Density"},
    {"name": "fin in channel", "synth": "bluntfin"},
]
PICTURE_BAR = 2 / 255
COMPARED = ["bunyk-preintegrated", "bunyk-partial"]  # projected and zsweep draw other approximations
FEW_VIEWS, FEW_FRAMES = 3, 3

# Ways to run tetcast; the first is what ratios and pictures are taken of. 2003: one cell a pass and a table of 8 bits, as the paper.
VARIANTS = {"tetcast": [], "tetcast table": ["--integrator", "table"],
            "tetcast 2003": ["--integrator", "table", "--table-format", "8", "--steps-per-pass", "1"],
            "tetcast compute": ["--driver", "compute"], "tetcast peel": ["--reentry", "peel"]}
DEFAULT_VARIANTS = ["tetcast", "tetcast table", "tetcast 2003"]


class Vtk:
    """peer_vtk.py --serve in a virtual X server of its own. VTK 9.1 can crash: its partial pre-integration does on
    disk_out_ref seen along its axes. Such a view is left out of that renderer's row, which says so."""

    def __init__(self, mesh, options, arguments):
        command = [common.VTK_PYTHON, os.path.join(common.HERE, "peer_vtk.py"), mesh, "--serve", "--size", options.size, "--threads",
                   str(options.threads), *arguments]
        if not os.environ.get("DISPLAY"):
            command = ["xvfb-run", "-a", *command]
        self.command = command
        self.process = None

    def start(self):
        self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, **request):
        if not self.process:
            self.start()
        try:
            self.process.stdin.write(json.dumps(request) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass
        line = self.process.stdout.readline()
        if not line:
            code = self.process.wait()
            self.process = None
            raise Failure(f"peer_vtk.py ended with {code}")
        return json.loads(line)

    def close(self):
        if self.process:
            self.process.stdin.close()
            self.process.wait()


def numbers(values):
    return ",".join(repr(float(v)) for v in values)


class Bench:
    def __init__(self, options):
        self.options = options
        self.tetcast = os.path.join(options.build, "tetcast")
        self.work = options.work

    def mesh_of(self, row):
        """Path of the row's mesh; None where its file is absent."""
        if "file" in row:
            path = os.path.join(self.options.data, row["file"])
            return path if os.path.exists(path) else None
        path = os.path.join(self.work, row["synth"] + ".vtu")
        cells = 2000 if self.options.quick else row.get("cells")
        run([self.tetcast, "synth", row["synth"], "-o", path, *(["--cells", str(cells)] if cells else [])])
        return path

    def transfer_options(self, row, about):
        """The knots that VTK uses, as a ParaView preset for the colours and as a list for the opacity."""
        path = os.path.join(self.work, row["name"].replace(" ", "_") + "_preset.json")
        points = [value for knot in about["knots"] for value in knot[:4]]
        with open(path, "w", encoding="utf-8") as file:
            json.dump([{"Name": "benchmark", "ColorSpace": "RGB", "RGBPoints": points}], file)
        opacity = ",".join(f"{knot[0]!r}:{knot[4]!r}" for knot in about["knots"])
        return ["--color-map", path, "--range", numbers(about["range"]), "--opacity", opacity, "--unit-distance",
                repr(about["unit_distance"])]

    def run_tetcast(self, row, mesh, about, camera, extra, picture, frames):
        stats = os.path.join(self.work, "stats.json")
        run([self.tetcast, "render", mesh, "-o", picture, "--field", about["field"], "--" + about["association"] + "-data",
             "--size", self.options.size, "--background", "transparent", "--camera-position", numbers(camera["position"]),
             "--focal-point", numbers(camera["focal_point"]), "--view-up", numbers(camera["view_up"]), "--view-angle",
             repr(camera["view_angle"]), *self.transfer_options(row, about), "--repeat", str(frames),
             "--stats", stats, "--quiet", *extra], self.options.threads)
        with open(stats, encoding="utf-8") as file:
            return json.load(file)

    def compare(self, a, b):
        done = subprocess.run([self.tetcast, "compare", a, b, "--json"], capture_output=True, text=True, check=False)
        if done.returncode > 2 or not done.stdout:
            raise Failure(f"tetcast compare {a} {b}: {done.stderr.strip()}")
        return json.loads(done.stdout)

    def view(self, row, mesh, about, vtk, azimuth, result):
        """One view by all renderers in turn."""
        frames = self.options.frames if row.get("whole") else min(self.options.frames, FEW_FRAMES)
        camera = peer_vtk.camera_reset(about["bounds"], azimuth)
        stem = os.path.join(self.work, f"{row['name'].replace(' ', '_')}_{azimuth:g}")
        for name in self.options.variants:
            picture = f"{stem}_{name.replace(' ', '_')}.exr"
            stats = self.run_tetcast(row, mesh, about, camera, VARIANTS[name], picture, frames)
            result["runs"].append({"renderer": name, "azimuth": azimuth, "frame_ms": stats["time_ms"]["frame"],
                                   "picture": picture, "stats": stats})
        ours = f"{stem}_{self.options.variants[0].replace(' ', '_')}.exr"
        truth = f"{stem}_reference.exr"
        judged = row.get("whole") or azimuth == self.options.azimuths[0]
        if judged:
            self.run_tetcast(row, mesh, about, camera, ["--driver", "reference"], truth, 1)
            for entry in result["runs"][-len(self.options.variants):]:
                entry["error"] = self.compare(entry["picture"], truth)
        for name in self.options.mappers:
            try:
                answer = vtk.ask(mapper=name, camera=camera, frames=frames, picture=f"{stem}_{name}")
            except Failure as failure:
                result["runs"].append({"renderer": name, "azimuth": azimuth, "failed": str(failure)})
                continue
            answer.update(renderer=name, azimuth=azimuth, picture=f"{stem}_{name}.tif",
                          difference=self.compare(ours, f"{stem}_{name}.tif"))
            if judged:
                answer["error"] = self.compare(f"{stem}_{name}.tif", truth)
            result["runs"].append(answer)

    def row(self, row):
        mesh = self.mesh_of(row)
        if not mesh:
            raise Absent(f"{row['file']} is not in the folder of real meshes (--data)")
        arguments = ["--field", row["field"]] if "field" in row else []
        if row.get("split"):  # both draw the tets of VTK's splitting
            split = os.path.join(self.work, row["name"] + "_tets.vtu")
            arguments += ["--write-tets", split]
        vtk = Vtk(mesh, self.options, arguments)
        try:
            about = vtk.ask()
            mesh = split if row.get("split") else mesh
            result = {"name": row["name"], "paper": row.get("paper"), "runs": []}
            for azimuth in self.options.azimuths if row.get("whole") else self.options.azimuths[:FEW_VIEWS]:
                self.view(row, mesh, about, vtk, azimuth, result)
            result["data"] = vtk.ask()
        finally:
            vtk.close()
        self.summarise(row, result)
        self.report(result)
        return result

    def summarise(self, row, result):
        """Means over the views; ratios to the first variant over the same views; bars."""
        summary = result["summary"] = []
        first = {r["azimuth"]: r["frame_ms"] for r in result["runs"] if r["renderer"] == self.options.variants[0]}
        for name in self.options.variants + self.options.mappers:
            all_runs = [r for r in result["runs"] if r["renderer"] == name]
            runs = [r for r in all_runs if "failed" not in r]
            line = {"renderer": name, "threads": self.options.threads, "views": len(runs),
                    "views_failed": len(all_runs) - len(runs), "bars": []}
            summary.append(line)
            if not runs:
                continue
            times = [r["frame_ms"] for r in runs]
            line.update(frame_ms=statistics.mean(times), frame_least_ms=min(times), frame_most_ms=max(times),
                        ratio=sum(times) / sum(first[r["azimuth"]] for r in runs))
            differences = [r["difference"] for r in runs if "difference" in r]
            if differences:
                line["mean_abs"] = statistics.mean(d["mean_abs"] for d in differences)
                line["mean_abs_worst_view"] = max(d["mean_abs"] for d in differences)
                line["max_abs"] = max(d["max_abs"] for d in differences)
            errors = [r["error"] for r in runs if "error" in r]
            if errors:
                line["error_mean"] = statistics.mean(e["mean_abs"] for e in errors)
                line["error_worst_view"] = max(e["mean_abs"] for e in errors)
                line["error_max"] = max(e["max_abs"] for e in errors)
            if name in row.get("speed_bar", {}):
                least, aim = row["speed_bar"][name]
                line["bars"].append(dict(bar(f"{row['name']}: faster than {name}", line["ratio"], least, least=True), aim=aim))
            if row.get("picture_bar") and name in COMPARED:
                line["bars"].append(bar(f"{row['name']}: mean difference from {name} in 1/255, worst view",
                                        255 * line["mean_abs_worst_view"], 255 * PICTURE_BAR))

    def report(self, result):
        data, stats = result["data"], result["runs"][0]["stats"]
        mesh, march = stats.get("mesh", {}), stats.get("march", {})
        lost = sum(r["stats"].get("march", {}).get("rays_lost", 0) for r in result["runs"] if "stats" in r)
        print(f"\n{result['name']}: {data['tets']} tets, {mesh.get('imaginary_tets', 'no')} imaginary, field {data['field']}, "
              f"{self.options.size}, {march.get('steps_per_ray', 0):.1f} steps a ray in the first view, {lost} rays lost")
        print(f"  {'renderer':<22}{'threads':>8}{'views':>7}{'frame ms':>10}{'least':>9}{'most':>9}{'ratio':>8}"
              f"{'error':>9}{'worst view':>11}{'largest':>9}{'mean diff':>11}   in 1/255: mean error over the views against the "
              f"reference, the worst view's, the largest; mean difference from ours")
        for line in result["summary"]:
            if not line["views"]:
                print(f"  {line['renderer']:<22}crashed in every view")
                continue
            text = (f"  {line['renderer']:<22}{line['threads']:>8}{line['views']:>7}{line['frame_ms']:>10.2f}"
                    f"{line['frame_least_ms']:>9.2f}{line['frame_most_ms']:>9.2f}{line['ratio']:>8.2f}")
            for key, digits, width in [("error_mean", 4, 9), ("error_worst_view", 4, 11), ("error_max", 2, 9),
                                       ("mean_abs", 3, 11)]:
                text += f"{255 * line[key]:>{width}.{digits}f}" if key in line else " " * width
            if line["views_failed"]:
                text += f"   crashed in {line['views_failed']} views, left out"
            print(text)
        sys.stdout.flush()


def measure(options):
    """tetcast and VTK's renderers, view by view in one run."""
    if options.mappers and not (os.environ.get("DISPLAY") or shutil.which("xvfb-run")):
        raise Absent("VTK needs an X display: install xvfb, python3-vtk9 and python3-numpy")
    common.program(options, "tetcast")
    if not options.variants:
        options.variants = DEFAULT_VARIANTS + (["tetcast compute"] if "compute" in common.drivers(options) else [])
    bench = Bench(options)
    rows, left_out, failed = [], [], []
    for row in options.rows:
        try:
            rows.append(bench.row(row))
        except Absent as absent:
            left_out.append(f"{row['name']}: {absent}")
            print(f"\n{row['name']}: left out: {absent}")
        except Failure as failure:
            failed.append(f"{row['name']}: {failure}")
            print(f"\n{row['name']}: failed: {failure}")
    for row in rows:  # pictures stay in the work folder
        for entry in row["runs"]:
            entry.pop("picture", None)
    if failed:
        raise Failure("; ".join(failed))
    bars = [b for row in rows for line in row["summary"] for b in line["bars"]]
    return {"rows": rows, "left_out": left_out, "size": options.size, "threads": options.threads}, bars
