"""What the benchmarks share: running programs, bars, the file of results."""

import json
import math
import os
import statistics
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
VTK_PYTHON = "/usr/bin/python3"


class Failure(Exception):
    """Something could not be measured; the text says why."""


class Absent(Failure):
    """What a measurement needs is not there: it is left out, and that is no error."""


def run(command, threads=None, limit=None):
    """Standard output of a command; llvmpipe gets `threads`. Failure where it fails or takes longer than limit seconds."""
    env = dict(os.environ)
    if threads:
        env["LP_NUM_THREADS"] = str(threads)
    try:
        done = subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=limit)
    except subprocess.TimeoutExpired:
        raise Failure(f"{' '.join(command[:3])} … took longer than {limit:.0f} s") from None
    if done.returncode:
        raise Failure(f"{' '.join(command[:3])} … ended with {done.returncode}: {done.stderr.strip()[-400:]}")
    return done.stdout


def program(options, name):
    path = os.path.join(options.build, name)
    if not os.access(path, os.X_OK):
        raise Absent(f"{name} is not built (cmake --build BUILD --target bench_programs)")
    return path


def script(name):
    path = os.path.join(HERE, name)
    if not os.path.exists(path):
        raise Absent(f"tests/bench/{name} is not there")
    return path


def real_mesh(options, file):
    path = os.path.join(options.data, file)
    if not os.path.exists(path):
        raise Absent(f"{file} is not in the folder of real meshes (--data)")
    return path


def drivers(options):
    """Names of the drivers that work here."""
    listing = json.loads(run([program(options, "tetcast"), "backends", "--json"]))
    return [entry["name"] for entry in listing if entry["kind"] == "driver" and entry["works"]]


def frames(options, what, variants, limit=None):
    """bench_frames: what: INPUT and options; variants: {name: "KEY=VALUE,…"}."""
    listing = [name + ("," + keys if keys else "") for name, keys in variants.items()]
    out = run([program(options, "bench_frames"), *what, "--threads", str(options.threads), *listing], options.threads, limit)
    return json.loads(out)


def bar(what, value, limit, least=False):
    """A figure to reach: value <= limit, or >= with least."""
    met = value is not None and math.isfinite(value) and (value >= limit if least else value <= limit)
    return {"what": what, "value": value, "limit": limit, "least": least, "met": met}


def bar_text(b):
    value = "not measured" if b["value"] is None else f"{b['value']:.3g}"
    return f"{b['what']}: {value} (bar {'>=' if b['least'] else '<='} {b['limit']:g}): {'met' if b['met'] else 'NOT MET'}"


def mean_of_views(variant, key):
    """Mean over a bench_frames variant's views; None where one lacks it."""
    values = [view.get(key) for view in variant["views"]]
    return statistics.mean(values) if values and None not in values else None


def by_name(result):
    return {variant["name"]: variant for variant in result["variants"]}


def ratio(a, b):
    return a / b if a is not None and b else None


def power_fit(points):
    """Exponent of y = c x^e by least squares in the logarithms; None with fewer than two points."""
    if len(points) < 2:
        return None
    x, y = [math.log(p[0]) for p in points], [math.log(p[1]) for p in points]
    mx, my = statistics.mean(x), statistics.mean(y)
    spread = sum((a - mx) ** 2 for a in x)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / spread if spread else None


def available_bytes():
    with open("/proc/meminfo", encoding="ascii") as file:
        for line in file:
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    return 0


def write_json(path, value):
    with open(path + ".part", "w", encoding="utf-8") as file:
        json.dump(value, file, indent=1)
    os.replace(path + ".part", path)


def read_json(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None
