"""Frames a minute of a batch: against the same loop in VTK's Python, and against tetcast started once a frame."""

import json
import os
import shutil
import statistics
import subprocess
import time

from common import Absent, Failure, VTK_PYTHON, bar, program, script

EARTH = {"Name": "Earth", "ColorSpace": "RGB",
         "RGBPoints": [0, 0.1, 0.2, 0.5, 0.3, 0.2, 0.6, 0.6, 0.6, 0.9, 0.85, 0.5, 1, 0.5, 0.2, 0.1]}
ROWS = {  # dataset, field, range
    "mug.e, 21 steps": ("vol/mug.e", "convected", (0, 1)),
    "can_series, 3 steps that move": (["vol/can_series/can_0.hdf", "vol/can_series/can_1.hdf", "vol/can_series/can_2.hdf"],
                                      "VEL", (0, 5700)),
}


def scene_of(options, row):
    data, field, (lo, hi) = ROWS[row]
    files = [os.path.join(options.data, f) for f in (data if isinstance(data, list) else [data])]
    for f in files:
        if not os.path.exists(f):
            raise Absent(f"{f} is not there")
    mid = (lo + hi) / 2
    return {"data": files if isinstance(data, list) else files[0], "field": field,
            "views": {"phi": 4, "theta": [20]},
            "transfer_function": [
                {"name": "warm", "color_map": "Cool to Warm", "opacity": f"{lo}:0,{hi}:0.3", "range": [lo, hi]},
                {"name": "earth", "color_map": EARTH, "opacity": f"{lo}:0,{mid}:0.1,{hi}:0.9", "range": [lo, hi]}],
            "output": {"file": "{step:03d}_{phi}_{theta}_{tf}.png", "size": options.size, "background": [1, 1, 1]}}


def timed(command, folder, limit=600):
    start = time.monotonic()
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=limit, check=False)
    except subprocess.TimeoutExpired:
        raise Failure(f"{command[0]} took more than {limit} s") from None
    if done.returncode:
        raise Failure(f"{' '.join(command)}: {done.stderr.strip().splitlines()[-1] if done.stderr.strip() else done.returncode}")
    return time.monotonic() - start, done.stdout


def fresh(path):
    shutil.rmtree(path, ignore_errors=True)
    os.makedirs(path)
    return path


def once_a_frame(options, scene, folder, most):
    """tetcast render for each of `most` frames spread over the batch: seconds a frame."""
    plan = [json.loads(line) for line in timed([program(options, "tetcast"), "batch", "scene.json", "--dry-run", "--json", "-q"],
                                               folder)[1].splitlines()]
    plan = [p for p in plan if p["event"] == "plan"]
    chosen = plan[::max(1, len(plan) // most)]
    looks = {f["name"]: f for f in scene["transfer_function"]}
    seconds = 0
    for p in chosen:
        look, data = looks[p["tf"]], scene["data"]
        step = [] if isinstance(data, list) else ["--step", str(p["step"])]
        seconds += timed([program(options, "tetcast"), "render", data[p["step"]] if isinstance(data, list) else data, *step,
                          "--field", scene["field"], "--color-map", look["color_map"] if isinstance(look["color_map"], str) else json.dumps(look["color_map"]), "--opacity", look["opacity"],
                          "--range", ",".join(map(str, look["range"])), "--background", "1,1,1", "--size", options.size,
                          "--azimuth", str(p["phi"]), "--elevation", str(p["theta"]), "-q", "-o", "once.png"], folder)[0]
    return seconds / len(chosen), len(plan)


def row_of(options, row, rounds):
    scene, work = scene_of(options, row), fresh(os.path.join(options.work, "batch"))
    with open(os.path.join(work, "scene.json"), "w", encoding="utf-8") as file:
        json.dump(scene, file)
    for name in ("default", "preintegrated", "projected"):
        os.makedirs(os.path.join(work, name))
    tetcast = program(options, "tetcast")
    has_vtk = os.environ.get("DISPLAY") or shutil.which("xvfb-run")
    server = [] if os.environ.get("DISPLAY") else ["xvfb-run", "-a"]
    found = {"batch": [], "once": [], "default": [], "preintegrated": [], "projected": []}
    timed([tetcast, "batch", "scene.json", "-q"], work)
    frames = 0
    for _ in range(rounds):
        seconds, _ = timed([tetcast, "batch", "scene.json", "-q"], work)
        once, frames = once_a_frame(options, scene, work, 12)
        found["batch"].append(frames / seconds * 60)
        found["once"].append(60 / once)
        for mapper in ("default", "preintegrated", "projected") if has_vtk else ():
            text = timed([*server, VTK_PYTHON, script("batch_vtk.py"), "scene.json", mapper, "--mapper", mapper, "--threads",
                          str(options.threads)], work)[1]
            done = json.loads(text.strip().splitlines()[-1])
            found[mapper].append(done["frames"] / done["seconds"] * 60)
    out = {"frames": frames, "frames_per_minute": {k: statistics.median(v) for k, v in found.items() if v}}
    rate = out["frames_per_minute"]
    out["over"] = {k: statistics.median([b / o for b, o in zip(found["batch"], v)]) for k, v in found.items() if v and k != "batch"}
    print(f"  {row}: {frames} frames, {rate['batch']:.0f} a minute; " +
          ", ".join(f"{k} {rate[k]:.0f} ({out['over'][k]:.2f} x)" for k in out["over"]))
    return out


def resident(pid):
    """Bytes of a process and of its children."""
    total = 0
    for who in [str(pid), *children(pid)]:
        try:
            with open(f"/proc/{who}/statm", encoding="ascii") as file:
                total += int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        except (OSError, IndexError):
            pass
    return total


def children(pid):
    out = []
    for thread in os.listdir(f"/proc/{pid}/task"):
        try:
            with open(f"/proc/{pid}/task/{thread}/children", encoding="ascii") as file:
                out += file.read().split()
        except OSError:
            pass
    return out


def memory(options, steps):
    """Resident memory over a batch of many steps, each with a mesh that has moved: files of can_series in turn."""
    work = fresh(os.path.join(options.work, "batch_memory"))
    files = [os.path.join(options.data, "vol", "can_series", f"can_{i}.hdf") for i in range(3)]
    if not all(os.path.exists(f) for f in files):
        raise Absent("can_series is not in the folder of real meshes (--data)")
    for i in range(steps):
        os.symlink(files[i % 3], os.path.join(work, f"step_{i:03d}.hdf"))
    command = [program(options, "tetcast"), "batch", os.path.join(work, "step_%03d.hdf"), "--field", "VEL", "--range-over", "first",
               "--range", "0,5700", "--size", options.size, "-q", "--json", "-o", os.path.join(work, "{step:03d}.png")]
    points = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run:
        for line in run.stdout:
            event = json.loads(line)
            if event["event"] == "frame":
                points.append((event["finished"], resident(run.pid) / 2**20))
    if run.returncode or len(points) != steps:
        raise Failure(f"a batch of {steps} steps ended with {run.returncode} after {len(points)}")
    shutil.rmtree(work)
    early = statistics.median(m for n, m in points if steps // 10 < n <= steps // 2)
    late = statistics.median(m for n, m in points if n > steps // 2)
    print(f"  {steps} steps that move: {early:.0f} MiB in the first half, {late:.0f} in the second ({late / early:.3f})")
    return {"steps": steps, "points": points, "growth": late / early}


def measure(options):
    """Frames a minute of a batch: against VTK's Python, and against tetcast once a frame; memory over 200 steps."""
    result = {}
    for row in ROWS:
        result[row] = row_of(options, row, 1 if options.quick else 3)
    first = result[next(iter(ROWS))]["over"]
    over = memory(options, 24 if options.quick else 200)
    bars = [bar("frames a minute of a batch, by tetcast once a frame", first["once"], 2, least=True),
            bar("memory of a batch, second half of its steps over the first", over["growth"], 1.05)]
    casters = [first[k] for k in ("default", "preintegrated") if k in first]
    if casters:
        bars.append(bar("frames a minute of a batch, by the same loop in VTK's Python (its quicker ray caster)", min(casters), 6, least=True))
    return {"rows": result, "memory": over, "size": options.size}, bars
