#!/usr/bin/env python3
"""Makes docs/accuracy.md and its plots from `tetcast study`.

    docs/accuracy.py TETCAST WORK [--quick]

TETCAST is the program, WORK a folder for the results of the studies; the same command goes on where it stopped. The data
are looked for in $TETCAST_DATA, or ../shared/data beside the repository; where they are not, the page is left as it is.
--quick: few and small pictures, to try this script; results, page and plots then go to WORK-quick.
"""
import csv
import hashlib
import json
import os
import shutil
import statistics
import subprocess
import sys

FUNCTIONS = ["smooth", "knots12", "spike", "steps"]
# name of the scene in results, title, input below the data's folder (None: synthetic), options, all knobs or tables alone
SCENES = [
    ("bluntfin_tets", "Blunt Fin", "bluntfin_tets.vtu", ["--field", "Density"], True),
    ("combustor_tets", "combustor", "combustor_tets.vtu", ["--field", "Density"], False),
    ("disk_out_ref", "disk_out_ref", "vol/disk_out_ref.ex2", ["--field", "Temp"], False),
    ("can", "can", "vol/can.vtu", ["--field", "DISPL:magnitude"], False),
    ("heatsink", "heat sink", None, [], True),
]
HALF_STEP, AIM = 1 / 510, 1 / 2000
# every view of every scene
MAIN = "exact,table8"
# Pairs that no setting was chosen on: title, input, options.
UNSEEN = [
    ("fire_ug, Viridis, opacity up and down", "vol/fire_ug.vtu",
     "--color-map Viridis --opacity 298:0,400:0.4,500:0.05,692:3 --azimuth 35 --elevation 20"),
    ("can, Turbo, two peaks", "vol/can.vtu",
     "--color-map Turbo --opacity 2.4:0,8:0.2,10:4,12:0.3,18.6:1.5 --azimuth 110 --elevation 30"),
    ("notch stress, Plasma, dense at the end", "vol/notch_stress_fixed.vtk",
     "--color-map Plasma --opacity=-145362:0.05,2e6:0.6,4e6:0,8.1e6:5 --azimuth 20 --elevation -40"),
    ("heat sink, spike of 1/500", None,
     "synth:heatsink --opacity 0:0.02,0.4:0.02,0.401:15,0.402:0.02,1:0.3 --azimuth -40 --elevation 25"),
    ("torus knot, steps up to 20", None,
     "synth:torusknot --opacity=-1.567:0,-0.5:0,-0.5:2,0:2,0:0.1,0.7:0.1,0.7:20,1.567:20 --parallel --elevation 60"),
]


class Sums:
    """The rows of a study's summary.csv."""

    def __init__(self, folder):
        with open(os.path.join(folder, "summary.csv"), newline="") as f:
            self.rows = list(csv.DictReader(f))

    def get(self, function, setting):
        for r in self.rows:
            if r["function"] == function and r["setting"] == setting:
                return r
        return None


def number(row, key):
    """None where it was not measured."""
    return float(row[key]) if row and row.get(key) else None


def error_text(value):
    if value is None:
        return "–"
    if value >= 0.01:
        return f"{value:.2g}"
    mantissa, exponent = f"{value:.1e}".split("e")
    superscript = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{mantissa}·10{superscript}"


def ms_text(value):
    return "–" if value is None else f"{value:.0f}" if value >= 20 else f"{value:.1f}"


def ratio_text(value):
    return "–" if value is None else f"{value:.2f}"


def table(head, rows):
    out = ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    out += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(out) + "\n"


def study(tetcast, folder, what, options):
    command = [tetcast, "study", what, "--out", folder] + options
    print("accuracy:", " ".join(command[1:]), flush=True)
    if subprocess.run(command).returncode != 0:
        sys.exit("accuracy: the study failed; the page was left as it is")
    return Sums(folder)


def ratio(a, b):
    return a / b if a is not None and b is not None and b > 0 else None


def machine(tetcast):
    """The renderer that --gl auto takes, without paths or names of hosts."""
    out = subprocess.run([tetcast, "backends"], capture_output=True, text=True).stdout
    words = [line.split(None, 2) for line in out.splitlines()]
    software = [w for w in words if len(w) == 3 and "llvmpipe" in w[2]]
    cores = len(os.sched_getaffinity(0))
    return f"{cores} CPU cores" + (", no GPU (llvmpipe)" if software else "")


def defaults_part(main):
    rows, errors, ratios, ill, pixels = [], [], [], 0, 0
    for name, title, *_ in SCENES:
        for function in FUNCTIONS:
            d, t = main[name].get(function, "default"), main[name].get(function, "table8")
            error, times = number(d, "max_error"), ratio(number(d, "ms_median"), number(t, "ms_median"))
            errors.append((error, title, function))
            ratios.append((times, title, function))
            ill += int(number(d, "ill_posed"))
            pixels += int(number(d, "pixels"))
            rows.append([title, function, error_text(error), error_text(number(d, "p9999_error")),
                         error_text(number(d, "mean_error")), d["ill_posed"], d["integrator"], ms_text(number(d, "ms_median")),
                         ms_text(number(t, "ms_median")), ratio_text(times)])
    worst = max(errors)
    slow = max(r for r in ratios if r[0] is not None)
    middle = statistics.median(r[0] for r in ratios if r[0] is not None)
    text = (f"Over these {len(rows)} pairs of scene and function the largest error of any channel of any pixel is "
            f"{error_text(worst[0])} ({worst[1]}, {worst[2]}); {sum(e[0] <= HALF_STEP for e in errors)} pairs stay below half "
            f"an 8-bit step, 1/510 = {error_text(HALF_STEP)}, and {sum(e[0] <= AIM for e in errors)} below 1/2000 = "
            f"{error_text(AIM)}. {ill} of {pixels} rays ({100 * ill / pixels:.4f} %) are ill-posed and counted apart. A frame "
            f"takes {ratio_text(middle)} times as long as with the paper's table in the middle, {ratio_text(slow[0])} times at "
            f"the most ({slow[1]}, {slow[2]}).\n\n")
    return text + table(["scene", "function", "max error", "99.99 %", "mean", "ill-posed", "integrator", "ms a frame",
                         "ms, 8-bit table", "ratio"], rows)


def exact_part(main):
    rows, worst, worst_most, slow = [], 0, 0, 0
    for name, title, *_ in SCENES:
        for function in FUNCTIONS:
            d, e = main[name].get(function, "default"), main[name].get(function, "exact")
            times = ratio(number(e, "ms_median"), number(d, "ms_median"))
            worst = max(worst, number(e, "max_error") or 0)
            worst_most = max(worst_most, number(e, "p9999_error") or 0)
            slow = max(slow, times or 0)
            rows.append([title, function, error_text(number(e, "max_error")), error_text(number(e, "p9999_error")),
                         error_text(number(e, "mean_error")), e["ill_posed"], ms_text(number(e, "ms_median")),
                         ratio_text(times)])
    text = (f"`--integrator exact` errs by {error_text(worst)} at the most, and by at most {error_text(worst_most)} in 99.99 % of "
            f"the channels of each pair, in up to {ratio_text(slow)} times the default's frame time.\n\n")
    return text + table(["scene", "function", "max error", "99.99 %", "mean", "ill-posed", "ms a frame", "× default"], rows)


def table_part(main, knobs):
    sizes = [(32, 32), (64, 64), (128, 64), (128, 128), (128, 256), (256, 128), (512, 128)]

    def reached(sums, function, form):
        for s, length in sizes:
            row = sums.get(function, f"table{form}-{s}x{length}")
            error = number(row, "max_error")
            if error is not None and error <= HALF_STEP:
                return (f"{s}²×{length}: {ms_text(number(row, 'ms_median'))} ms "
                        f"({ratio_text(number(row, 'time_ratio'))} × default), "
                        f"{(number(row, 'bytes_table') or 0) / 2**20:.1f} MiB")
        return None

    rows, reach8, reach16 = [], 0, 0
    for name, title, *_ in SCENES:
        for function in FUNCTIONS:
            t = main[name].get(function, "table8")
            eight, half = reached(knobs[name], function, "8"), reached(knobs[name], function, "16f")
            reach8 += eight is not None
            reach16 += half is not None
            rows.append([title, function, error_text(number(t, "max_error")), error_text(number(t, "mean_error")),
                         ms_text(number(t, "ms_median")), eight or "none", half or "none"])
    text = (f"The paper's table, 8 bits and 128×128×256, in all views; then the smallest of the tables from 32²×32 to 512²×128 "
            f"that stays below 1/510 in the views of the knobs. One of 8 bits does in {reach8} of {len(rows)} pairs, one of half "
            f"floats in {reach16}.\n\n")
    return text + table(["scene", "function", "max error", "mean", "ms a frame", "8 bits reach 1/510 at", "half floats at"], rows)


def knob_part(knobs, listing):
    """Every setting beside the default: median and extremes over pairs of scene and function."""
    rows = []
    measured = [(knobs[s[0]], f) for s in SCENES for f in FUNCTIONS]
    for knob, setting, what in listing:
        if knob in ("figure", "default"):
            continue
        times, errors, lost, rays = [], [], 0, 0
        for sums, function in measured:
            base = sums.get(function, "samples-1" if knob == "samples" else "default")
            row = sums.get(function, setting)
            key = "mean_error" if knob == "samples" else "max_error"
            r = ratio(number(row, "ms_median"), number(base, "ms_median"))
            e = ratio(number(row, key), number(base, key))
            lost += int(number(row, "rays_lost") or 0)
            rays += int(number(row, "rays") or 0)
            if r is not None:
                times.append(r)
            if e is not None:
                errors.append(e)
        if not times:
            continue
        share = f"; lost {lost} of {rays} rays" if lost else ""
        rows.append([knob, f"`{setting}`", what.split(": the 2003")[0] + share, f"{statistics.median(times):.2f}",
                     f"{min(times):.2f} … {max(times):.2f}",
                     f"{statistics.median(errors):.2g}" if errors else "–", f"{max(errors):.2g}" if errors else "–",
                     len(times)])
    return table(["knob", "setting", "what", "time", "least … most", "error, median", "error, most", "pairs"], rows)


def choice(tetcast, data, work, size, pair, wish):
    """The stats of one picture whose setting --error or --frame-time chose; every pixel is compared."""
    title, file, options = pair
    stats = os.path.join(work, "choice.json")
    command = [tetcast, "render"] + ([os.path.join(data, file)] if file else []) + options.split()
    command += wish + ["--size", f"{size}x{size}", "--verify", str(size * size), "--stats", stats, "--quiet", "-o",
                       os.path.join(work, "choice.exr")]
    print("accuracy:", title, *wish, flush=True)
    if subprocess.run(command, env=dict(os.environ, TETCAST_CACHE=os.path.join(work, "cache"))).returncode != 0:
        sys.exit("accuracy: no setting was chosen; the page was left as it is")
    with open(stats) as f:
        return json.load(f)


def choice_part(tetcast, data, work, size):
    errors, times, held = [], [], 0
    for pair in UNSEEN:
        for asked in (0.01, 0.002, 0.0005):
            s = choice(tetcast, data, work, size, pair, ["--error", str(asked)])
            held += s["verify"]["max_abs_error"] <= asked
            errors.append([pair[0], asked, error_text(s["verify"]["max_abs_error"]), s["choice"]["setting"],
                           ms_text(s["choice"]["frame_ms"]), s["choice"]["tried"], s["verify"]["ill_posed"]])
        middle = s["choice"]["frame_ms"]
        for share in (0.8, 1.5):
            budget = max(1, round(share * middle))
            s = choice(tetcast, data, work, size, pair, ["--frame-time", str(budget)])
            times.append([pair[0], budget, ms_text(s["choice"]["frame_ms"]), "yes" if s["choice"]["in_time"] else "no",
                          error_text(s["verify"]["max_abs_error"]), s["choice"]["setting"]])
    return (f"Five pairs that nothing was tuned on, {size}×{size}, every pixel compared: in {held} of {len(errors)} cases the "
            "largest error is below the one asked for. The first picture of a pair calibrates (seconds), and what it finds is kept.\n\n"
            + table(["scene and function", "`--error`", "max error", "setting", "ms a frame", "tried", "ill-posed"], errors)
            + "\nThe same with a frame time, 0.8 and 1.5 times that of the last setting:\n\n"
            + table(["scene and function", "`--frame-time`", "ms a frame", "in time", "max error", "setting"], times))


def settings(tetcast):
    lines = subprocess.run([tetcast, "study", "--list"], capture_output=True, text=True, check=True).stdout.splitlines()
    rows = []
    for line in lines[1:]:
        if not line:
            break
        rows.append(line.split(None, 2))
    return rows


def page(tetcast, size, views, knob_views, frames, main, knobs, choices):
    titles = {s[0]: s[1] for s in SCENES}
    everything = [s[0] for s in SCENES if s[4]]
    names = " and ".join(titles[s] for s in everything)
    out = f"""# What accuracy costs in time

This page is made by `make docs` (`docs/accuracy.py`, which runs `tetcast study`); its figures are of one run on
{machine(tetcast)}. `tetcast study INPUT` makes the same tables and plots of your own data.

## How to read it

An *error* is the largest difference between a channel (premultiplied red, green, blue, or opacity, 0 to 1) of the picture,
as floats, and the double-precision reference caster, which shares no code with the GPU and integrates exactly between the
function's knots. *All* pixels of all views are compared, nothing is left out but ill-posed rays: those whose true colour
moves by more than 1/1020 when mesh or data are shifted by 2⁻²² of diagonal or range. (Of a picture that errs by more than that in more
than 1 % of its pixels, only the worst 1 % are asked whether they are ill-posed.) 99.99 % is the error that all but one channel in
10 000 stay below, of the worst view; the mean is over all channels of all pixels.

*Times* are medians of {frames[0]} frames ({frames[1]} for the knobs) of each view, and of these over the views: first hit, march and resolve, without reading back; frames of one view are interleaved over
the settings, each after a frame to warm up. Pictures have {size[0]}×{size[0]} pixels, and there are {views} views of each scene, oblique and
next to an axis, for the tables of defaults, `exact` and the paper's table; for all other knobs {size[1]}×{size[1]} and {knob_views} views.

The functions are laid over the field's range: *smooth*, Cool to Warm with opacity rising linearly to 0.3; *knots12*, 12 knots
of changing colour and opacity; *spike*, opacity 30 within 1/500 of the range; *steps*, steps between next to nothing and
opacity 20 (κU = 20: the attenuation over one unit distance).

## Defaults

{defaults_part(main)}
## `exact`

{exact_part(main)}
## An error or a frame time instead of knobs

{choices}
## The 2003 paper's table

{table_part(main, knobs)}
"""
    for s in SCENES:
        out += f"\n![{s[1]}: error and time against table size](images/accuracy-table-size-{s[0]}.svg)\n"
    out += f"""
## Error against time

Each point is a setting: the median frame time and the largest error over the views. Nothing lies below and to the left of the grey
line, the front. What lies far from it costs time and buys nothing.
"""
    for s in everything:
        out += f"\n![{titles[s]}: error against time](images/accuracy-error-time-{s}.svg)\n"
    out += f"""
## Which knob buys what

Time and error by those of the default (1: the same; of `samples`: by those of one ray a pixel, mean error against the mean of 8×8
rays over the pixel), over pairs of scene and function: all knobs on {names}, tables on all scenes.

{knob_part(knobs, settings(tetcast))}
## Rays a pixel
"""
    for s in everything:
        out += f"\n![{titles[s]}: rays a pixel](images/accuracy-samples-{s}.svg)\n"
    out += """
## A full turn, and fragments in each pass

After the 2003 paper's figures 7 and 8: frame time follows the number of cell steps, and the depth test takes finished rays out of
the passes.
"""
    for s in everything:
        out += f"\n![{titles[s]}: a full turn](images/accuracy-rotation-{s}.svg)\n"
        out += f"\n![{titles[s]}: fragments in each pass](images/accuracy-fragments-{s}.svg)\n"
    return out


def fresh(work, tetcast):
    """Results of another build are dropped: a study goes on with those of its version."""
    sum_ = hashlib.sha256()
    for path in (tetcast, os.path.join(os.path.dirname(tetcast), "libtetcast.so")):
        if os.path.exists(path):
            with open(path, "rb") as f:
                sum_.update(f.read())
    stamp = os.path.join(work, "build")
    if os.path.exists(stamp):
        with open(stamp) as f:
            if f.read() == sum_.hexdigest():
                return
        shutil.rmtree(work)
    os.makedirs(work, exist_ok=True)
    with open(stamp, "w") as f:
        f.write(sum_.hexdigest())


def main():
    quick = "--quick" in sys.argv
    arguments = [a for a in sys.argv[1:] if a != "--quick"]
    if len(arguments) != 2:
        sys.exit(__doc__)
    tetcast, work = os.path.abspath(arguments[0]), os.path.abspath(arguments[1])
    docs = os.path.dirname(os.path.abspath(__file__))
    data = os.environ.get("TETCAST_DATA", os.path.join(docs, "..", "..", "shared", "data"))
    missing = [s[2] for s in SCENES if s[2] and not os.path.exists(os.path.join(data, s[2]))]
    missing += [u[1] for u in UNSEEN if u[1] and not os.path.exists(os.path.join(data, u[1]))]
    if missing:
        print(f"accuracy: {', '.join(missing)} not found in {data}; docs/accuracy.md is left as it is (TETCAST_DATA names the "
              "folder)")
        return
    work += "-quick" if quick else ""
    size, knob_size, views, knob_views, frames, knob_frames = (64, 48, 2, 1, 1, 1) if quick else (512, 256, 8, 2, 3, 2)
    out = work if quick else docs
    fresh(work, tetcast)
    os.makedirs(os.path.join(out, "images"), exist_ok=True)
    main_sums, knob_sums, plots = {}, {}, []
    for name, _, file, options, everything in SCENES:
        what = os.path.join(data, file) if file else f"synth:{name}" + (":5000" if quick else "")
        main_sums[name] = study(tetcast, os.path.join(work, name), what,
                                options + ["--size", f"{size}x{size}", "--views", str(views), "--frames", str(frames), "--knobs", MAIN, "--no-plots"])
        folder = os.path.join(work, name + "-knobs")
        knob_sums[name] = study(tetcast, folder, what, options + ["--size", f"{knob_size}x{knob_size}", "--views", str(knob_views), "--frames",
                                                                  str(knob_frames)] +
                                ([] if everything else ["--knobs", "table"]))
        for kind in ["table-size"] + (["error-time", "samples", "rotation", "fragments"] if everything else []):
            plots.append((os.path.join(folder, f"{kind}-{name}.svg"), f"accuracy-{kind}-{name}.svg"))
    choices = choice_part(tetcast, data, work, size)
    text = page(tetcast, (size, knob_size), views, knob_views, (frames, knob_frames), main_sums, knob_sums, choices)
    absent = [p[0] for p in plots if not os.path.exists(p[0])]
    if absent:
        sys.exit(f"accuracy: {absent[0]} was not drawn, so the page is left as it is; install gnuplot")
    for source, target in plots:
        shutil.copyfile(source, os.path.join(out, "images", target))
    path = os.path.join(out, "accuracy.md")
    with open(path + ".part", "w") as f:
        f.write(text)
    os.replace(path + ".part", path)
    print(f"accuracy: wrote {os.path.relpath(path)} and {len(plots)} plots")


main()
