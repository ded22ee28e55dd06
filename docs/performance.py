#!/usr/bin/env python3
"""Makes docs/performance.md and its plots from what `make bench` measured.

    docs/performance.py RESULTS [OUT]

RESULTS is BUILD/bench/results.json; where it is not there the page is left as it is. The page of a --quick run goes beside its
results and never into docs; OUT names another folder.
"""
import json
import os
import statistics
import subprocess
import sys

PLOT = """set terminal svg size 760,460 font "sans,12" background "white"
set output "{out}"
set title "{title}"
set xlabel "{x}"
set ylabel "{y}"
set logscale xy
set grid lc rgb "#dddddd"
set key {key}
{more}
plot {curves}
"""
COLORS = ["#2980b9", "#27ae60", "#c0392b", "#8e44ad", "#d35400", "#16a085"]


def table(head, rows):
    out = ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    out += ["| " + " | ".join("–" if cell is None else str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(out) + "\n"


def num(value, digits=3):
    """Rounded to significant digits, without exponent; None where it was not measured."""
    if value is None:
        return None
    if value == 0:
        return "0"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e" in text else text


def count(value):
    return None if value is None else f"{value:,.0f}".replace(",", " ")


class Page:
    def __init__(self, results, out):
        self.results, self.out = results, out
        self.images = os.path.join(out, "images")
        self.parts, self.plots = [], 0

    def section(self, name):
        """Data of a section; None where there are none."""
        return self.results["sections"].get(name, {}).get("data")

    def add(self, text):
        self.parts.append(text.rstrip() + "\n")

    def absent(self, title, name):
        entry = self.results["sections"].get(name, {})
        why = entry.get("left_out") or entry.get("failed") or "it was not asked for"
        self.add(f"## {title}\n\nNot measured in this run: {why}.")

    def plot(self, name, alt, title, x, y, curves, key="top left", more=""):
        """curves: (title, style, points)."""
        os.makedirs(self.images, exist_ok=True)
        path = os.path.join(self.images, name)
        blocks, texts = "", []
        for i, (label, style, points) in enumerate(curves):
            blocks += f"$data{i} << EOD\n" + "\n".join(f"{a} {b}" for a, b in points) + "\nEOD\n"
            texts.append(f'$data{i} with {style} title "{label}"')
        text = PLOT.format(out=path + ".part", title=title, x=x, y=y, key=key, more=more, curves=", \\\n     ".join(texts))
        try:
            subprocess.run(["gnuplot"], input=blocks + text, text=True, check=True)
        except (OSError, subprocess.CalledProcessError):
            sys.exit(f"performance: {name} was not drawn, so the page is left as it is; install gnuplot")
        os.replace(path + ".part", path)
        self.plots += 1
        self.add(f"![{alt}](images/{name})")


def style(i, dashes=1, points=7):
    return f'linespoints lw 2 dt {dashes} pt {points} ps 0.6 lc rgb "{COLORS[i % len(COLORS)]}"'


def bars(page):
    rows = []
    for name, entry in page.results["sections"].items():
        for b in entry.get("bars", []):
            limit = ("at least " if b["least"] else "at most ") + num(b["limit"])
            if "aim" in b:
                limit += f" (aim {num(b['aim'])})"
            rows.append([b["what"], limit, num(b["value"]), "met" if b["met"] else "**not met**"])
    met = sum(row[3] == "met" for row in rows)
    page.add(f"## Bars\n\n{met} of {len(rows)} are met.\n\n" + table(["figure", "bar", "measured", ""], rows))


def peers(page):
    data = page.section("peers")
    if not data:
        return page.absent("Beside VTK", "peers")
    text = (f"## Beside VTK\n\nThe same mesh, function, unit distance, camera and {data['threads']} threads for all, {data['size']}, "
            "one after the other view by view in one run; means over the views. Errors in 1/255: mean over the covered pixels, and the "
            "largest of any channel, against the double-precision reference (of the meshes but Blunt Fin in the first view). "
            "*tetcast 2003* is the paper's way: a table of 8 bits, one cell a pass; its signs are exact all the same.\n")
    for row in data["rows"]:
        found = row["data"]
        stats = next((r["stats"] for r in row["runs"] if "stats" in r), {})
        steps = stats.get("march", {}).get("steps_per_ray")
        text += (f"\n**{row['name']}**, {count(found['tets'])} tets" +
                 (f", {num(steps)} cell steps a ray in the first view" if steps else "") + f", VTK {found['vtk']}\n\n")
        rows = []
        for line in row["summary"]:
            if not line["views"]:
                rows.append([line["renderer"], 0, "crashed in every view"] + [None] * 5)
                continue
            views = f"{line['views']}" + (f" ({line['views_failed']} crashed)" if line["views_failed"] else "")
            error = {key: num(255 * line[key], 2) if key in line else None for key in ("error_mean", "error_max")}
            rows.append([line["renderer"], views, num(line["frame_ms"]),
                         f"{num(line['frame_least_ms'])} … {num(line['frame_most_ms'])}", num(line["ratio"]),
                         error["error_mean"], error["error_max"]])
        text += table(["renderer", "views", "ms a frame", "views' least … most", "tetcast is faster by", "mean error",
                       "largest"], rows)
    for left in data["left_out"]:
        text += f"\nLeft out: {left}.\n"
    page.add(text)
    rows = []
    for row in data["rows"]:
        if not row.get("paper"):
            continue
        title, cells, fps = row["paper"]
        by_name = {line["renderer"]: line for line in row["summary"] if line["views"]}
        imaginary = next((r["stats"]["mesh"].get("imaginary_tets", 0) for r in row["runs"] if "stats" in r), 0)
        ours = [num(1e3 / by_name[n]["frame_ms"]) if n in by_name else None for n in ("tetcast", "tetcast 2003")]
        rows.append([title, count(cells), count(row["data"]["tets"] + imaginary), num(fps), ours[1], ours[0]])
    if rows:
        page.add(f"## The 2003 paper's table 2\n\nFrames a second. The paper's are of a Radeon 9700 Pro at 512×512 (Weiler et al. 2003, "
                 f"section 6), ours at {data['size']} of the machine above; Blunt Fin is the same mesh, filled to its hull, the others have other shapes of the "
                 "same number of cells (`tetcast synth`), before their gaps are filled.\n\n" +
                 table(["mesh", "cells, paper", "cells, ours, with imaginary ones", "paper", "tetcast, the paper's way", "tetcast"], rows))


def passes(page):
    data = page.section("passes")
    if not data:
        return page.absent("Cells a pass", "passes")
    rows, base = [], next((r["frame_ms"] for r in data["rows"] if r["name"] == "K=1"), None)
    for r in data["rows"]:
        rows.append([r["name"] if r["name"] != "auto" else f"auto ({num(r['steps_per_pass'])})", num(r["frame_ms"]),
                     num(base / r["frame_ms"]) if base else None, num(r["passes"]), count(r["fragments"])])
    text = (f"## Cells a pass\n\n{data['input']}, {data['size']}, mean over the views. K = 1 is the paper's loop; the best is "
            f"{data['best']}.\n\n" +
            table(["cell steps a pass", "ms a frame", "faster than K = 1 by", "passes", "fragments"], rows))
    if "fragment_ns" in data:
        text += (f"\nBetween K = 1 and {data['best']}, each fragment that is spared saves {num(data['fragment_ns'])} ns" +
                 (f" and {num(data['fragment_instructions'])} instructions" if "fragment_instructions" in data else "") +
                 ": reading and writing a ray's state, and setting the ray up again.\n")
    page.add(text)
    swept = [(r["steps_per_pass"], r["frame_ms"]) for r in data["rows"] if r["name"].startswith("K=")]
    page.plot("performance-passes.svg", "frame time against cells a pass", f"{data['input']}, {data['size']}", "cell steps a pass",
              "ms a frame", [("pingpong", style(0), swept)], "top right")


def integration(page):
    data = page.section("integration")
    if not data:
        return page.absent("What integration costs", "integration")
    rows = [[r["name"], r["integrator"] if r["name"] != "bare walk" else None, num(r["frame_ms"]), num(r["ratio"]),
             num(r["march_ratio"])] for r in data["rows"]]
    page.add(f"## What integration costs\n\n{data['input']}, {data['size']}, mean over the views; no ray ends before it leaves the mesh, so "
             "that all make the same steps. The bare walk steps through the cells, and finds depth and scalar at every face, but adds "
             "nothing up.\n\n" + table(["what", "integrator", "ms a frame", "× bare walk", "its march alone"], rows))


def parts(page):
    data = page.section("parts")
    if not data:
        return page.absent("Where a step's time goes", "parts")
    head = ["part", "how it is measured", "ns", "instructions", "cycles"]
    rows = [[r["name"], r["what"], num(r.get("ns")), num(r.get("instructions")), num(r.get("cycles"))] for r in data["rows"]]
    text = (f"## Where a step's time goes\n\n{data['input']}, a cell step of one ray, of all {data['threads']} threads together: march time "
            "over cell steps; instructions and cycles in user space, those of first hits and reading back among them. A part is the "
            "difference of two programs on the same rays, one of which leaves it out or does it once more with other numbers; what is "
            "done once more finds its data in the cache, and part of it hides behind what waits for memory, so that parts do not add up to the whole.\n\n" + table(head, rows))
    for misfit in data["misfits"]:
        text += f"\nLeft out: {misfit}.\n"
    passes_data = page.section("passes")
    if passes_data and "fragment_ns" in passes_data:
        text += f"\nState between passes: {num(passes_data['fragment_ns'])} ns a fragment, by \"Cells a pass\".\n"
    default, walk = data["rows"][0], data["rows"][1]
    text += ("\n### The least a step can be\n\nInstructions for one ray where a register holds eight floats or four doubles, counted from "
             "the sources of the bare walk:\n\n" +
             table(["part", "instructions", "which"], [[p["part"], num(p["instructions"]), p["what"]] for p in data["least"]] +
                   [["all", num(data["least_instructions"]), ""]]))
    if "instructions" in walk:
        text += (f"\nThe bare walk takes {num(walk['instructions'])} instructions a step, {num(walk['instructions'] / data['least_instructions'])} "
                 "times as many. In the gap are " +
                 (f"rays that have ended while others of their group go on ({num(100 * (1 - data['lanes']))} % of the lanes of 4×2 pixels), "
                  if data.get("lanes") else "rays that have ended while others of their group go on, ") +
                 "first hits and reading back, bounds of the fetches, which llvmpipe checks lane by lane, and registers that are put "
                 "aside.\n")
    memory = data.get("memory")
    if memory and "ns" in default:
        rate = {"bare walk": (data["bytes_walk"], walk["ns"]), "default": (data["bytes_default"], default["ns"])}
        rows = [[name, b, num(ns), num(b / ns), num(100 * b / ns * 1e9 / memory["bytes_per_second"]),
                 num(1e9 * b / memory["bytes_per_second"])] for name, (b, ns) in rate.items()]
        text += (f"\nBytes: a step reads a cell's record and a vertex (16 bytes each), the default besides 32 of the "
                 f"function's integrals, which stay in the nearest cache. {memory['threads']} threads read {num(memory['bytes_per_second'] / 1e9)} "
                 f"GB/s of memory in order, and {num(memory['records_per_second'] / 1e6)} million records of 16 bytes a second at random "
                 "places.\n\n" +
                 table(["", "bytes a step", "ns a step", "GB/s", "% of what memory gives", "least ns by bytes"], rows))
    page.add(text)


def signs(page):
    data = page.section("signs")
    if not data:
        return page.absent("What exact signs cost", "signs")
    rows = [[r["input"], num(r["azimuth"]), num(r["exact_ms"]), num(r["float_ms"]), num(r["ratio"]),
             count(r["float_lost"])] for r in data["rows"]]
    ratios = [r["ratio"] for r in data["rows"] if r["ratio"]]
    middle = f"{num(statistics.median(ratios))} times as long in the middle" if ratios else "no ratio, since they lose rays in all rows"
    page.add(f"## What exact signs cost\n\nFrames in turn with exact signs and with plain float ones: {middle}. Where floats lose rays "
             "passes go on for these, and there is no ratio.\n\n" +
             table(["mesh", "azimuth", "exact, ms", "float, ms", "ratio", "rays lost by floats"], rows))


def memory(page):
    data = page.section("bytes")
    if not data:
        return page.absent("Memory", "bytes")
    page.add(f"## Memory\n\nBlunt Fin on the GPU, {count(data['cells'])} cells ({count(data['imaginary'])} imaginary): "
             f"{num(data['mesh'], 4)} bytes a cell in cells and vertices, {num(data['other'])} in all else but tables and state (boundary faces). "
             f"Tables of the transfer function: {num(data['table_bytes'] / 2**20)} MiB; state of 512×512 rays: "
             f"{num(data['state_bytes'] / 2**20)} MiB. The paper's layout has 160 bytes a tet.")


def growth(page):
    data = page.section("growth")
    if not data:
        return page.absent("Size", "growth")
    rows, curves = [], []
    for r in data["rows"]:
        t = r["time_ms"]
        rows.append([r["generator"], count(r["cells"]), count(r["imaginary"]), num(r["setup_ms"] / 1e3), num(r["setup_us_per_tet"]),
                     num(1e3 * t["convexify"] / r["cells"]) if t.get("convexify") else None,
                     num(r["default"]["frame_ms"]), num(r["no stop"]["frame_ms"]), num(r["bare walk"]["frame_ms"]),
                     num(r["no stop"]["steps"] / r["no stop"]["rays"]),
                     num(1e-3 * r["no stop"]["steps"] / r["no stop"]["march_ms"]), num(r["peak_bytes"] / 2**30),
                     num(r["helper_peak_bytes"] / 2**30) if r["helper_peak_bytes"] else None])
    text = (f"## Size\n\nSynthetic meshes, {data['size']}, one oblique view, {data['threads']} threads: a convex one (*kuhn*) and one that is not "
            "(*heatsink*). Set-up is all between reading and the first frame: check, order, neighbours, gaps (TetGen, a process apart), "
            "pack, upload. *no stop*: no ray ends before it leaves the mesh.\n\n" +
            table(["mesh", "tets", "imaginary", "set-up, s", "µs a tet", "gaps, µs a tet", "frame, ms", "no stop, ms", "bare walk, ms",
                   "steps a ray", "10⁶ steps/s", "peak GiB", "TetGen's"], rows))
    for left in data["left_out"]:
        text += f"\nLeft out: {left}.\n"
    fits = [[name, num(value)] for name, value in data["fits"].items() if value is not None]
    text += "\nFrame time grows as the number of cells to the power of (least squares in the logarithms):\n\n" + table(["", "exponent"], fits)
    page.add(text)
    for i, name in enumerate(("default", "no stop", "bare walk")):
        for generator, dashes, point in (("kuhn", 1, 7), ("heatsink", 2, 5)):
            points = [(r["cells"], r[name]["frame_ms"]) for r in data["rows"] if r["generator"] == generator]
            if points:
                curves.append((f"{generator}, {name}", style(i, dashes, point), points))
    first = data["rows"][0]
    last = max(r["cells"] for r in data["rows"])
    guide = [(n, first["bare walk"]["frame_ms"] * (n / first["cells"]) ** 0.45) for n in (first["cells"], last)]
    curves.append(("N^{0.45}", 'lines lw 1 dt 3 lc rgb "#888888"', guide))
    page.plot("performance-growth.svg", "frame time against the number of cells", f"Frame time against size, {data['size']}", "tets",
              "ms a frame", curves)
    setup = [(g, [(r["cells"], r["setup_us_per_tet"]) for r in data["rows"] if r["generator"] == g]) for g in ("kuhn", "heatsink")]
    page.plot("performance-setup.svg", "set-up against the number of cells", "Set-up, reading excluded", "tets", "microseconds a tet",
              [(g, style(i), points) for i, (g, points) in enumerate(setup) if points], "top right")


def small(page):
    data = page.section("transfer")
    if data:
        rows = [[name, data[k]["integrator"], num(data[k]["frame_ms"]), num(data[k].get("change_ms")), num(data[k]["ratio"])]
                for k, name in (("default", "default"), ("table", "the paper's table, as half floats or as asked for"))]
        rows[1][0] = "table"
        page.add("## A new transfer function\n\nFrom a new function to the next frame, Blunt Fin: what it takes longer than a frame with the "
                 "same function (tables, upload), median over "
                 f"{data['pairs']} pairs.\n\n" + table(["", "integrator", "frame, ms", "change, ms", "(frame + change) / frame"], rows))
    else:
        page.absent("A new transfer function", "transfer")
    data = page.section("values")
    if data:
        rows = [["full set-up", num(data["ms_set_up"]), None]]
        rows += [[f"new values of {k}s", num(data[f"ms_{k}_values"]), num(100 * data[f"ratio_{k}_values"])] for k in ("point", "cell")]
        page.add(f"## New values on the same mesh\n\n{count(data['tets'])} tets; packing and upload are in all of them, reading in none.\n\n" +
                 table(["", "ms", "% of a set-up"], rows))
    else:
        page.absent("New values on the same mesh", "values")
    data = page.section("cold")
    if data:
        rows = [[name, num(r["median_ms"]), f"{num(r['min_ms'])} … {num(r['max_ms'])}", num(r["cpu_ms"]),
                 *[num(r.get(peer + " over it")) if name.startswith("tetcast") else None for peer in ("vtk", "vtk, modules")]] for name, r in data["rows"].items()]
        page.add(f"## Cold start\n\nFrom the start of the process to the written PNG, Blunt Fin at {data['size']}, {data['rounds']} rounds in turn: "
                 "tetcast, the same with its cache file, the shortest VTK script that makes such a picture, and one that loads the modules "
                 "that it uses alone. Files are in memory; VTK's X server runs before.\n\n" +
                 table(["", "ms", "least … most", "CPU, ms", "the VTK script takes, ×", "with modules, ×"], rows))
    else:
        page.absent("Cold start", "cold")
    data = page.section("tables")
    if data:
        rows = [[r["function"], num(r["bits"]), num(r["one_thread_ms"]), num(r["two_threads_ms"]), count(r["entry_by_entry_ms"]),
                 count(r["ratio"])] for r in data["rows"]]
        page.add(f"## The pre-integration table\n\nMilliseconds, {data['size']}; 8 bits: the paper's, 16 and 32: the drift of the colour. Entry by "
                 "entry is the direct way with as many samples; the paper gives 128 s against 1.5 s.\n\n" +
                 table(["function", "bits", "1 thread", "2 threads", "entry by entry", "ratio"], rows))
    else:
        page.absent("The pre-integration table", "tables")
    data = page.section("counts")
    if data:
        text = "## Instructions, counted\n\nBy callgrind, one thread: the same in every run, and on a busy machine.\n"
        for group in data["groups"]:
            text += f"\n{group['title'][0].upper() + group['title'][1:]}:\n\n"
            text += table(["part", "instructions"], [[r["what"], num(r["count"], 4)] for r in group["rows"]])
        page.add(text)
    else:
        page.absent("Instructions, counted", "counts")


def batch(page):
    data = page.section("batch")
    if not data:
        return page.absent("Batches", "batch")
    names = [("default", "VTK's ray caster"), ("preintegrated", "pre-integrated"), ("projected", "projected tetrahedra, approximate"),
             ("once", "tetcast once a frame")]
    rows = []
    for name, r in data["rows"].items():
        rate = r["frames_per_minute"]
        rows.append([name, r["frames"], num(rate["batch"])] +
                    [f"{num(rate[k])} ({num(r['over'][k])} ×)" if k in rate else None for k, _ in names])
    page.add(f"## Batches\n\nPictures of {data['size']} a minute, PNG files included: all steps, 4 views, 2 functions, by `tetcast batch`, and by the "
             "same loop in VTK's Python under Xvfb (tests/bench/batch_vtk.py), in turn in one run; in brackets how many times as many the batch "
             "makes. What the steps take to read and set up is in all of them.\n\n" +
             table(["", "frames", "batch"] + [title for _, title in names], rows))
    over = data["memory"]
    page.plot("performance-batch.svg", "memory over a batch", f"Resident memory of a batch, helpers included: {over['steps']} steps, each with a new mesh",
              "frame", "MiB", [("", style(0), over["points"])], "off", "unset logscale\nset yrange [0:*]")


def edit(page):
    data = page.section("edit")
    if not data:
        return page.absent("The window", "edit")
    whole, large = data["whole"], data["large"][0]
    titles = [("curve_wait_ms", "curve: pointer to picture, ms"), ("curve_wait_most_of_ten_ms", "… of nine moves in ten, at most"),
              ("curve_pictures_per_second", "… pictures a second"), ("curve_divide", "… each side divided by"),
              ("curve_rest_ms", "… last move to full accuracy, ms"), ("function_ms", "… function, table and upload, ms"),
              ("orbit_wait_ms", "view: pointer to picture, ms"), ("orbit_wait_most_of_ten_ms", "… of nine moves in ten, at most"),
              ("orbit_pictures_per_second", "… pictures a second"), ("orbit_divide", "… each side divided by"),
              ("orbit_rest_ms", "… last move to full accuracy, ms"),
              ("event_ms", f"{count(large['cells'])} cells: longest wait of an event, ms")]
    rows = [[title, num(whole[key]["median"]), num(whole[key]["least"])] if whole[key] else [title, None, None] for key, title in titles]
    page.add(f"## The window\n\n`tetcast edit`, Blunt Fin, a picture of {data['size'][0]}×{data['size'][1]}, under Xvfb with a pointer that moves 60 "
             "times a second: it drags a point of the opacity curve, rests, turns the view, rests. By the window's own trace; a move waits from when "
             "the display took it until the picture of it, or of a later one, was painted. The last line is of another mesh, from when its window "
             "opened: read, drawn, turned and refined.\n\n" + table(["", f"median of {len(data['runs'])} runs", "least"], rows))


def make(results, out):
    page = Page(results, out)
    renderers = {r["stats"]["gl"]["renderer"] for row in (page.section("peers") or {"rows": []})["rows"] for r in row["runs"]
                 if "gl" in r.get("stats", {})}
    on = f"{results['cores']} CPU cores" + (f", OpenGL by {', '.join(sorted(renderers))}" if renderers else "")
    page.add(f"# Speed, memory, size\n\nThis page is made by `make bench` and `make docs` (`docs/performance.py`); its figures are of one run of "
             f"{results['version']} on {on}. A frame is what a moved camera costs: first hits, march, resolve, without reading back; medians "
             "over frames of a view, means over views. Where nothing else is said the function is the benchmark function: Cool to Warm over the "
             "field's range, opacity linear from 0 to 0.3, and all settings are the defaults. [accuracy.md](accuracy.md) says how exact these "
             "pictures are.")
    loads = [name for name, entry in results["sections"].items() if entry["load"] > results["cores"] + 0.5]
    if loads:
        page.add(f"Other work ran beside these sections, whose times are therefore too long: {', '.join(loads)}.")
    for part in (bars, peers, passes, integration, parts, signs, memory, growth, batch, edit, small):
        part(page)
    path = os.path.join(out, "performance.md")
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write("\n".join(page.parts))
    os.replace(path + ".part", path)
    print(f"performance: wrote {os.path.relpath(path)} and {page.plots} plots")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    try:
        with open(sys.argv[1], encoding="utf-8") as file:
            results = json.load(file)
    except OSError:
        print(f"performance: {sys.argv[1]} is not there; docs/performance.md is left as it is (make bench measures)")
        return
    docs = os.path.dirname(os.path.abspath(__file__))
    out = sys.argv[2] if len(sys.argv) > 2 else os.path.dirname(os.path.abspath(sys.argv[1])) if results["quick"] else docs
    make(results, out)


main()
