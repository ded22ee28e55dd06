#!/usr/bin/python3
"""tetcast and VTK's volume renderers side by side: frame times, ratios and the difference of their pictures.

Every mesh is drawn with one transfer function (shared knots), one unit distance and one camera per azimuth by all renderers
in turn, view by view, so that whatever else the machine does falls on all of them. Frame: the median over --frames frames of
one view after a warm-up; a row's time: the mean over the views. Times of tetcast are `frame` of `render --stats` (first hit,
march, resolve), those of VTK are Render() until the GL is done; reading the picture back is in neither.

Needs the built program, and for VTK python3-vtk9, python3-numpy, xvfb. Meshes that are not there are left out, and named.
"""

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys

sys.dont_write_bytecode = True
import peer_vtk  # noqa: E402  (VTK itself is loaded by the peer's own process)

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
VTK_PYTHON = "/usr/bin/python3"
FAST = ["bunyk-preintegrated", "bunyk-partial", "projected"]

# The last four stand for rows of table 2 of Weiler et al. 2003, whose meshes are not public.
ROWS = [
    {"name": "bluntfin", "file": "bluntfin_tets.vtu", "field": "Density",
     "speed_bar": {"bunyk-preintegrated": 4.5, "projected": 3.3}, "picture_bar": True},
    {"name": "disk_out_ref", "file": "vol/disk_out_ref.vtu", "field": "Temp", "split": True, "picture_bar": True},
    {"name": "combustor", "file": "combustor_tets.vtu", "field": "Density"},
    {"name": "heatsink", "synth": "heatsink"},
    {"name": "cylinder", "synth": "cylinder"},
    {"name": "ball", "synth": "ball"},
    {"name": "fin in channel", "synth": "bluntfin"},
]
PICTURE_BAR = 2 / 255
COMPARED = ["bunyk-preintegrated", "bunyk-partial"]  # projected and zsweep draw other approximations

# Ways to run tetcast; the first is what ratios and pictures are taken of.
VARIANTS = {"tetcast": [], "tetcast table": ["--integrator", "table"], "tetcast peel": ["--reentry", "peel"]}


class Failure(Exception):
    pass


def run(command, threads=None):
    env = dict(os.environ)
    if threads:
        env["LP_NUM_THREADS"] = str(threads)
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Failure(f"{' '.join(command[:3])} … ended with {done.returncode}: {done.stderr.strip()[-400:]}")
    return done.stdout


class Vtk:
    """peer_vtk.py --serve in a virtual X server of its own. VTK 9.1 can crash: its partial pre-integration does on
    disk_out_ref seen along its axes. Such a view is left out of that renderer's row, which says so."""

    def __init__(self, mesh, options, arguments):
        command = [VTK_PYTHON, os.path.join(HERE, "peer_vtk.py"), mesh, "--serve", "--size", options.size, "--threads",
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
        self.work = os.path.join(options.build, "bench")
        os.makedirs(self.work, exist_ok=True)

    def mesh_of(self, row):
        """Path of the row's mesh; None where its file is absent."""
        if "file" in row:
            path = os.path.join(self.options.data, row["file"])
            return path if os.path.exists(path) else None
        path = os.path.join(self.work, row["synth"] + ".vtu")
        run([self.tetcast, "synth", row["synth"], "-o", path])
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

    def run_tetcast(self, row, mesh, about, camera, extra, picture):
        stats = os.path.join(self.work, "stats.json")
        run([self.tetcast, "render", mesh, "-o", picture, "--field", about["field"], "--" + about["association"] + "-data",
             "--size", self.options.size, "--background", "transparent", "--camera-position", numbers(camera["position"]),
             "--focal-point", numbers(camera["focal_point"]), "--view-up", numbers(camera["view_up"]), "--view-angle",
             repr(camera["view_angle"]), *self.transfer_options(row, about), "--repeat", str(self.options.frames),
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
        camera = peer_vtk.camera_reset(about["bounds"], azimuth)
        stem = os.path.join(self.work, f"{row['name'].replace(' ', '_')}_{azimuth:g}")
        for name in self.options.variants:
            picture = f"{stem}_{name.replace(' ', '_')}.exr"
            stats = self.run_tetcast(row, mesh, about, camera, VARIANTS[name], picture)
            result["runs"].append({"renderer": name, "azimuth": azimuth, "frame_ms": stats["time_ms"]["frame"],
                                   "picture": picture, "stats": stats})
        ours = f"{stem}_{self.options.variants[0].replace(' ', '_')}.exr"
        truth = f"{stem}_reference.exr"
        self.run_tetcast(row, mesh, about, camera, ["--driver", "reference", "--repeat", "1"], truth)
        for entry in result["runs"][-len(self.options.variants):]:
            entry["error"] = self.compare(entry["picture"], truth)
        for name in self.options.mappers:
            try:
                answer = vtk.ask(mapper=name, camera=camera, frames=self.options.frames, picture=f"{stem}_{name}")
            except Failure as failure:
                result["runs"].append({"renderer": name, "azimuth": azimuth, "failed": str(failure)})
                continue
            answer.update(renderer=name, azimuth=azimuth, picture=f"{stem}_{name}.tif",
                          difference=self.compare(ours, f"{stem}_{name}.tif"),
                          error=self.compare(f"{stem}_{name}.tif", truth))
            result["runs"].append(answer)

    def row(self, row):
        mesh = self.mesh_of(row)
        if not mesh:
            print(f"\n{row['name']}: left out, {os.path.join(self.options.data, row['file'])} is not there")
            return None
        arguments = ["--field", row["field"]] if "field" in row else []
        if row.get("split"):  # both draw the tets of VTK's splitting
            split = os.path.join(self.work, row["name"] + "_tets.vtu")
            arguments += ["--write-tets", split]
        vtk = Vtk(mesh, self.options, arguments)
        try:
            about = vtk.ask()
            result = {"name": row["name"], "mesh": split if row.get("split") else mesh, "runs": []}
            for azimuth in self.options.azimuths:
                self.view(row, result["mesh"], about, vtk, azimuth, result)
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
            line["error_mean"] = statistics.mean(r["error"]["mean_abs"] for r in runs)
            line["error_worst_view"] = max(r["error"]["mean_abs"] for r in runs)
            line["error_max"] = max(r["error"]["max_abs"] for r in runs)
            if name in row.get("speed_bar", {}):
                line["bars"].append({"what": f"ratio >= {row['speed_bar'][name]}",
                                     "met": line["ratio"] >= row["speed_bar"][name]})
            if row.get("picture_bar") and name in COMPARED:
                line["bars"].append({"what": "mean difference <= 2/255 in every view",
                                     "met": line["mean_abs_worst_view"] <= PICTURE_BAR})

    def report(self, result):
        data, stats = result["data"], result["runs"][0]["stats"]
        mesh, march = stats.get("mesh", {}), stats.get("march", {})
        lost = sum(r["stats"].get("march", {}).get("rays_lost", 0) for r in result["runs"] if "stats" in r)
        print(f"\n{result['name']}: {data['tets']} tets, {mesh.get('imaginary_tets', 'no')} imaginary, field {data['field']}, "
              f"{self.options.size}, {len(self.options.azimuths)} views, {march.get('steps_per_ray', 0):.1f} steps a ray in the "
              f"first, {lost} rays lost")
        print(f"  {'renderer':<22}{'threads':>8}{'frame ms':>10}{'least':>9}{'most':>9}{'ratio':>8}"
              f"{'error':>9}{'worst view':>11}{'largest':>9}{'mean diff':>11}   in 1/255: mean error over the views against the "
              f"reference, the worst view's, the largest; mean difference from ours")
        for line in result["summary"]:
            if not line["views"]:
                print(f"  {line['renderer']:<22}crashed in every view")
                continue
            text = (f"  {line['renderer']:<22}{line['threads']:>8}{line['frame_ms']:>10.2f}{line['frame_least_ms']:>9.2f}"
                    f"{line['frame_most_ms']:>9.2f}{line['ratio']:>8.2f}")
            text += f"{255 * line['error_mean']:>9.4f}{255 * line['error_worst_view']:>11.4f}{255 * line['error_max']:>9.2f}"
            if "mean_abs" in line:
                text += f"{255 * line['mean_abs']:>11.3f}"
            if line["views_failed"]:
                text += f"   crashed in {line['views_failed']} views, left out"
            for bar in line["bars"]:
                text += f"   {bar['what']}: {'met' if bar['met'] else 'NOT MET'}"
            print(text)
        sys.stdout.flush()


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build"), help="folder of the built program")
    parser.add_argument("--data", default=os.path.join(os.path.dirname(ROOT), "shared", "data"), help="folder of real meshes")
    parser.add_argument("--rows", help="by commas: " + ", ".join(row["name"] for row in ROWS))
    parser.add_argument("--mappers", default=",".join(FAST), help="by commas: " + ", ".join(peer_vtk.MAPPERS))
    parser.add_argument("--variants", default="tetcast,tetcast table", help="by commas: " + ", ".join(VARIANTS))
    parser.add_argument("--azimuths", default="0,60,120,180,240,300")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--out", help="JSON of everything measured; default BUILD/bench.json")
    parser.add_argument("--check", action="store_true", help="exit code 3 when a bar is not met")
    options = parser.parse_args()
    options.mappers = [name for name in options.mappers.split(",") if name]
    options.variants = options.variants.split(",")
    options.azimuths = [float(a) for a in options.azimuths.split(",")]
    options.out = options.out or os.path.join(options.build, "bench.json")
    width, height = options.size.split("x")
    if width != height:
        parser.error("--size must be square: ResetCamera's view depends on the shape of the window")
    for name, known in [(n, peer_vtk.MAPPERS) for n in options.mappers] + [(n, VARIANTS) for n in options.variants]:
        if name not in known:
            parser.error(f"no '{name}'; there are {', '.join(known)}")
    names = [row["name"] for row in ROWS]
    chosen = options.rows.split(",") if options.rows else names
    for name in chosen:
        if name not in names:
            parser.error(f"no row '{name}'; there are {', '.join(names)}")
    options.rows = [row for row in ROWS if row["name"] in chosen]
    return options


def main():
    options = parse()
    bench = Bench(options)
    if not os.access(bench.tetcast, os.X_OK):
        sys.exit(f"{bench.tetcast} is not there; build it first (make)")
    if options.mappers and not (os.environ.get("DISPLAY") or shutil.which("xvfb-run")):
        sys.exit("VTK needs an X display: install xvfb, python3-vtk9 and python3-numpy")
    load = os.getloadavg()[0]
    print(f"{os.cpu_count()} cores, load {load:.2f} at the start"
          + ("; other work runs beside this: times will be off" if load > 0.5 else ""))
    results, failed = [], False
    for row in options.rows:
        try:
            result = bench.row(row)
            if result:
                results.append(result)
        except Failure as failure:
            print(f"\n{row['name']}: failed: {failure}")
            failed = True
    with open(options.out + ".part", "w", encoding="utf-8") as file:
        json.dump({"cores": os.cpu_count(), "load_at_start": load, "size": options.size, "frames": options.frames,
                   "threads": options.threads, "rows": results}, file, indent=1)
    os.replace(options.out + ".part", options.out)
    print(f"\neverything measured: {options.out}")
    met = all(bar["met"] for result in results for line in result["summary"] for bar in line["bars"])
    sys.exit(1 if failed else 3 if options.check and not met else 0)


if __name__ == "__main__":
    main()
