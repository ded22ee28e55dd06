"""Where the time of a cell step goes: cells a pass, integration, exact signs, and the parts of a step one by one."""

import json
import os

import common
import shaders
from common import Failure, bar, by_name, frames, mean_of_views, ratio

SWEEP = [1, 2, 4, 8, 16, 32, 64, 128, 512]
SIGNS_INPUTS = ["synth:bluntfin", "synth:heatsink", "synth:kuhn"]


def mesh_and_size(options):
    """Blunt Fin, or where that is not at hand its synthetic look-alike; small with --quick."""
    side = options.size.split("x")[0]
    path = os.path.join(options.data, "bluntfin_tets.vtu")
    what = ["synth:heatsink:5000"] if options.quick else [path, "--field", "Density"] if os.path.exists(path) else ["synth:bluntfin"]
    return what + ["--size", side]


def name_of(result):
    """What a page calls the mesh."""
    name = os.path.basename(result["input"])
    return "Blunt Fin" if name == "bluntfin_tets.vtu" else name


def views(options, n):
    return ["--azimuths", ",".join(f"{a:g}" for a in options.azimuths[:n])]


def shader_folder(options, name, edits=(), bare=False):
    source = os.path.join(common.ROOT, "gpu", "shaders")
    try:
        return shaders.make(source, os.path.join(options.work, "shaders", name), edits, bare)
    except shaders.Misfit as misfit:
        raise Failure(str(misfit)) from None


def passes(options):
    """Frame time against cells a pass; K = 1 is the paper's loop."""
    variants = {"auto": ""}
    variants.update({f"K={k}": f"steps-per-pass={k}" for k in (SWEEP[::4] if options.quick else SWEEP)})
    if "compute" in common.drivers(options):
        variants["compute"] = "driver=compute"
    result = frames(options, mesh_and_size(options) + views(options, 6) + ["--frames", "3"], variants)
    rows = []
    print(f"\n  {'variant':<12}{'frame ms':>10}{'passes':>8}{'fragments':>12}   mean over the views")
    for name, variant in by_name(result).items():
        if "failed" in variant:
            print(f"  {name:<12} failed: {variant['failed']}")
            continue
        row = {"name": name, "steps_per_pass": variant.get("steps_per_pass")}
        for key in ("frame_ms", "first_hit_ms", "march_ms", "passes", "fragments", "steps", "instructions", "cycles"):
            row[key] = mean_of_views(variant, key)
        rows.append(row)
        print(f"  {name:<12}{row['frame_ms']:>10.2f}{row['passes']:>8.0f}{row['fragments'] or 0:>12.0f}")
    swept = [row for row in rows if row["name"].startswith("K=")]
    best = min(swept, key=lambda row: row["frame_ms"])
    one = swept[0]
    print(f"  best: {best['name']}, {one['frame_ms'] / best['frame_ms']:.2f} times as fast as K=1")
    data = {"rows": rows, "best": best["name"], "input": name_of(result), "mesh": result["mesh"], "size": options.size, "threads": options.threads}
    if one["fragments"] and best["fragments"] and one["fragments"] > best["fragments"]:
        # What a fragment costs besides its steps: state read and written, set-up of the ray.
        data["fragment_ns"] = 1e6 * (one["march_ms"] - best["march_ms"]) / (one["fragments"] - best["fragments"])
        if one["instructions"] and best["instructions"]:
            data["fragment_instructions"] = ((one["instructions"] - best["instructions"]) /
                                             (one["fragments"] - best["fragments"]))
    return data, []


def integration(options):
    """The default integrator against the bare walk, on the same rays: no ray ends before it leaves the mesh."""
    bare = shader_folder(options, "bare", bare=True)
    stop = "opacity-stop=1"
    variants = {"default": stop, "bare walk": f"shaders={bare},{stop}", "table": f"integrator=table,{stop}",
                "exact": f"integrator=exact,{stop}"}
    result = frames(options, mesh_and_size(options) + views(options, 6) + ["--frames", str(options.frames)], variants)
    found = by_name(result)
    walk = mean_of_views(found["bare walk"], "frame_ms")
    rows = []
    for name, variant in found.items():
        if "failed" in variant:
            raise Failure(f"{name}: {variant['failed']}")
        if variant["views"][0].get("steps") != found["bare walk"]["views"][0].get("steps"):
            raise Failure(f"{name} makes other steps than the bare walk: its rays are not the same")
        ms = mean_of_views(variant, "frame_ms")
        rows.append({"name": name, "integrator": variant["integrator"], "frame_ms": ms, "ratio": ratio(ms, walk),
                     "march_ratio": ratio(mean_of_views(variant, "march_ms"), mean_of_views(found["bare walk"], "march_ms"))})
        print(f"  {name:<12}{ms:>10.2f} ms {rows[-1]['ratio']:>6.2f} x the bare walk")
    return ({"rows": rows, "input": name_of(result), "mesh": result["mesh"], "size": options.size},
            [bar("density emitter: default integrator by the bare walk", rows[0]["ratio"], 1.6)])


def signs(options):
    """What exact signs cost: frame times against plain float signs, which lose rays."""
    folder = shader_folder(options, "float-signs", ["float-signs"])
    inputs = [mesh_and_size(options)]
    inputs += [[name + (":3000" if options.quick else "")] + inputs[0][-2:] for name in SIGNS_INPUTS]
    rows = []
    for what in inputs:
        result = frames(options, what + views(options, 2) + ["--frames", str(options.frames)],
                        {"exact": "", "float": f"shaders={folder}"})
        found = by_name(result)
        for exact, plain in zip(found["exact"]["views"], found["float"]["views"]):
            rows.append({"input": os.path.basename(what[0]), "azimuth": exact["azimuth"], "exact_ms": exact["frame_ms"],
                         "float_ms": plain["frame_ms"], "float_lost": plain["rays_lost"],
                         # passes go on for a ray that is lost
                         "ratio": exact["frame_ms"] / plain["frame_ms"] if plain["rays_lost"] == 0 else None})
            row = rows[-1]
            print(f"  {row['input']:<22} at {row['azimuth']:<5g}{row['exact_ms']:>9.2f} ms exact {row['float_ms']:>9.2f} ms "
                  f"float {row['ratio'] or float('nan'):>7.3f}, {row['float_lost']:.0f} rays lost by floats")
    return {"rows": rows}, []


# Rows of `parts`: name, the variant, the one it is compared with, what the difference is.
PARTS = [
    ("integration", "default", "walk", "the default integrator against none"),
    ("interpolation", "walk", "walk no-interpolation", "depth and scalar at the exit face, left out with what carries those of vertices"),
    ("fetch of a vertex", "walk vertex-twice", "walk", "16 bytes, once more"),
    ("fetch of a cell's record", "walk record-twice", "walk", "16 bytes, once more"),
    ("projection", "walk projection-twice", "walk", "of one vertex, once more"),
    ("signs", "walk signs-twice", "walk", "of three crosses, once more"),
    ("fetch of the integrals' node", "nodes-twice", "default", "32 bytes, once more"),
]


def parts(options):
    """A step's parts by leaving them out or doing them twice, beside the least that bytes and instructions allow."""
    stop = "opacity-stop=1"
    wanted = {"default": ([], False), "walk": ([], True), "nodes-twice": (["nodes-twice"], False)}
    wanted.update({"walk " + name: ([name], True) for name in shaders.ON_BARE})
    variants, misfits = {}, []
    for name, (edits, bare) in wanted.items():
        try:
            folder = shader_folder(options, "parts-" + name.replace(" ", "-"), edits, bare)
        except Failure as failure:
            misfits.append(str(failure))
            print(f"  {name}: left out: {failure}")
            continue
        variants[name] = f"shaders={folder},{stop}" if edits or bare else stop
    result = frames(options, mesh_and_size(options) + views(options, 2) + ["--frames", str(2 * options.frames), "--lanes"], variants)
    found = {}
    for name, variant in by_name(result).items():
        if "failed" in variant:
            raise Failure(f"{name}: {variant['failed']}")
        found[name] = {key: mean_of_views(variant, key) for key in
                       ("frame_ms", "first_hit_ms", "march_ms", "instructions", "cycles", "steps", "rays")}
        if found[name]["steps"] != found["default"]["steps"]:
            raise Failure(f"{name} makes other steps than the default: its rays are not the same")
    steps = found["default"]["steps"]
    rows = []

    def row(name, what, value, less=None):
        entry = {"name": name, "what": what}
        for key, scale in (("march_ms", 1e6), ("instructions", 1), ("cycles", 1)):
            if value[key] is not None and (not less or less[key] is not None):
                entry[{"march_ms": "ns"}.get(key, key)] = scale * (value[key] - (less[key] if less else 0)) / steps
        rows.append(entry)
        print(f"  {name:<34}" + "".join(f"{entry[k]:>9.2f} {k}" if k in entry else "" for k in ("ns", "instructions", "cycles")))

    print("  per cell step:")
    row("a step of the default", "all of the march", found["default"])
    row("a step of the bare walk", "all of it", found["walk"])
    for name, variant, other, what in PARTS:
        if variant in found and other in found:
            row(name, what, found[variant], found[other])
    least = sum(n for _, n, _ in shaders.LEAST) / 8
    data = {"rows": rows, "input": name_of(result), "misfits": misfits, "steps": steps, "rays": found["default"]["rays"], "mesh": result["mesh"],
            "variants": found, "counters": result["counters"], "least_instructions": least,
            "least": [{"part": p, "instructions": n / 8, "what": w} for p, n, w in shaders.LEAST],
            "lanes": mean_of_views(by_name(result)["default"], "lanes"), "bytes_walk": 32, "bytes_default": 64, "threads": options.threads}
    try:
        data["memory"] = json.loads(common.run([common.program(options, "bench_read"), str(options.threads),
                                                "64" if options.quick else "512"]))
    except Failure as failure:
        print(f"  memory: left out: {failure}")
    print(f"  the least a step of the bare walk can be: {least:.1f} instructions, 32 bytes (64 with integration)")
    return data, []
