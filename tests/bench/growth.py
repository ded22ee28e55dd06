"""Set-up and frame time against the number of cells, from ten thousand to fifty million."""

import common
from common import Absent, Failure, bar, by_name, frames, mean_of_views, power_fit
from steps import shader_folder

# generator: cells; the first is convex, the second is not
SIZES = {"kuhn": [10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000, 50_000_000],
         "heatsink": [10_000, 100_000, 1_000_000, 10_000_000]}
QUICK = {"kuhn": [5_000, 20_000], "heatsink": [5_000, 20_000]}
BYTES_PER_TET = 160  # of memory that a run is expected to take at the most
SETUP = ["check", "adjacency", "order", "convexify"]
STEEPEST, SETUP_MOST, SETUP_AT = 0.45, 2.0, 10_000_000


def one(options, generator, cells, variants):
    if cells * BYTES_PER_TET > 0.9 * common.available_bytes():
        raise Absent(f"{cells} tets take about {cells * BYTES_PER_TET / 2**30:.1f} GiB of memory, "
                     f"{common.available_bytes() / 2**30:.1f} are free")
    n = 1 if cells >= 10_000_000 or options.quick else 3
    what = [f"synth:{generator}:{cells}", "--size", options.size.split("x")[0], "--azimuths", "35", "--elevation", "25",
            "--frames", str(n)] + (["--apart"] if cells >= 3_000_000 else [])
    result = frames(options, what, variants, limit=600)
    time, found = result["time_ms"], by_name(result)
    for name, variant in found.items():
        if "failed" in variant:
            raise Failure(f"{cells} tets, {name}: {variant['failed']}")
    default = found["default"]
    tets = result["mesh"]["tets"]
    setup = sum(time.get(key, 0) for key in SETUP) + default.get("pack_ms", 0) + default.get("upload_ms", 0)
    row = {"generator": generator, "cells": tets, "imaginary": result["mesh"]["imaginary_tets"], "setup_ms": setup,
           "setup_us_per_tet": 1e3 * setup / tets, "time_ms": dict(time, pack=default.get("pack_ms"), upload=default.get("upload_ms")),
           "peak_bytes": result["peak_bytes"], "helper_peak_bytes": result["helper_peak_bytes"], "reentry": result["mesh"]["reentry"]}
    for name, variant in found.items():
        row[name] = {key: mean_of_views(variant, key) for key in ("frame_ms", "march_ms", "steps", "rays", "rays_lost")}
    return row


def measure(options):
    """Set-up and frame time against the number of cells."""
    bare = shader_folder(options, "bare", bare=True)
    variants = {"default": "", "no stop": "opacity-stop=1", "bare walk": f"shaders={bare},opacity-stop=1"}
    rows, left_out, failed, bars, fits = [], [], [], [], {}
    print(f"  {'mesh':<10}{'cells':>10}{'set-up us/tet':>15}{'gaps':>8}{'frame ms':>10}{'no stop':>10}{'bare walk':>10}{'steps/ray':>10}"
          f"{'peak GiB':>10}")
    for generator, sizes in (QUICK if options.quick else SIZES).items():
        for cells in sizes:
            if cells > options.most_cells:
                left_out.append(f"{generator} of {cells} tets: --most-cells is {options.most_cells}")
                print(f"  left out: {left_out[-1]}")
                continue
            try:
                row = one(options, generator, cells, variants)
            except Absent as absent:
                left_out.append(f"{generator} of {cells} tets: {absent}")
                print(f"  left out: {left_out[-1]}")
                continue
            except Failure as failure:
                failed.append(f"{generator} of {cells} tets: {failure}")
                print(f"  failed: {failed[-1]}")
                continue
            rows.append(row)
            print(f"  {generator:<10}{row['cells']:>10}{row['setup_us_per_tet']:>15.3f}"
                  f"{1e3 * row['time_ms'].get('convexify', 0) / row['cells']:>8.3f}{row['default']['frame_ms']:>10.1f}"
                  f"{row['no stop']['frame_ms']:>10.1f}{row['bare walk']['frame_ms']:>10.1f}"
                  f"{row['no stop']['steps'] / row['no stop']['rays']:>10.1f}{row['peak_bytes'] / 2**30:>10.2f}", flush=True)
        of = [row for row in rows if row["generator"] == generator]
        for name in variants:
            fits[f"{generator}, {name}"] = power_fit([(row["cells"], row[name]["frame_ms"]) for row in of])
        large = [(row["cells"], row["bare walk"]["frame_ms"]) for row in of if row["cells"] >= 200_000]
        fits[f"{generator}, bare walk, above 2e5 cells"] = power_fit(large)
        for name in variants:
            if not options.quick:
                bars.append(bar(f"{generator}: frame time grows as cells to the power of, {name}", fits[f"{generator}, {name}"],
                                STEEPEST))
        for row in of:
            if row["cells"] >= 0.9 * SETUP_AT:
                bars.append(bar(f"{generator}: set-up of {row['cells']} tets, microseconds a tet", row["setup_us_per_tet"],
                                SETUP_MOST))
    for name, value in fits.items():
        if value is not None:
            print(f"  frame time of {name}: cells^{value:.3f}")
    if failed:
        raise Failure("; ".join(failed))
    if not rows:
        raise Absent("; ".join(left_out))
    return {"rows": rows, "fits": fits, "left_out": left_out, "threads": options.threads, "size": options.size}, bars
