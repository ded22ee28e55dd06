#!/usr/bin/env python3
"""Makes docs/gallery.md and its pictures: one for each effect, from the command that stands below it.

    docs/gallery.py TETCAST [OUT]

OUT (default docs/) gets gallery.md and images/gallery-*.png. With --sides FOLDER each picture is made from another side too, into that
folder, to be looked at. Pictures of datasets that are not at hand are left as they are.
"""
import os
import shlex
import subprocess
import sys

SIZE = "480x400"
HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "..", "..", "shared", "data")
FIN, DISK, CAN = "bluntfin_tets.vtu", "vol/disk_out_ref.vtu", "vol/can.vtu"
COMBUSTOR, PLATE = "combustor_tets.vtu", "vol/multi_material_cylinder_plate.vtk"

# name, title, what it shows, input, options
SHOWN = [
    ("Optical models", [
        ("density-emitter", "Density emitter", "Light emitted in proportion to attenuation, and absorbed (Williams and Max 1992). The default.",
         COMBUSTOR, "--field Density --opacity 0.2:0.2,0.4:0.3,0.71:4 --azimuth 35 --elevation 25 --zoom 1.2 --background 1,1,1"),
        ("emission", "Emission", "Light alone: nothing hides anything.",
         COMBUSTOR, "--field Density --model emission --opacity 0.2:0,0.4:0.02,0.71:0.5 --azimuth 35 --elevation 25 --zoom 1.2"),
        ("absorption", "Absorption", "Black matter before what lies behind it.",
         COMBUSTOR, "--field Density --model absorption --azimuth 35 --elevation 25 --zoom 1.2 --background 1,1,1"),
        ("xray", "X-ray", "White matter: how much a ray meets.",
         CAN, "--field DISPL --model xray --opacity 2:2,19:2 --azimuth 60 --elevation 20 --zoom 1.3 --background 0,0,0"),
        ("maximum", "Largest scalar", "The largest scalar of each ray, exact to the last bit of a float.",
         COMBUSTOR, "--field Density --model mip --color-map Inferno --azimuth 35 --elevation 25 --zoom 1.2 --background 1,1,1"),
        ("minimum", "Least scalar", "The least scalar of each ray.",
         COMBUSTOR, "--field Density --model minip --color-map Inferno --azimuth 35 --elevation 25 --zoom 1.2 --background 1,1,1"),
        ("average", "Mean scalar", "The mean of the scalar over the ray's length in the mesh.",
         COMBUSTOR, "--field Density --model average --color-map Inferno --azimuth 35 --elevation 25 --zoom 1.2 --background 1,1,1"),
    ]),
    ("Isosurfaces and light", [
        ("isosurfaces", "Isosurfaces", "Flat colours, each with an opacity of its own, at the exact crossing within the cell.",
         DISK, "--field Temp --model isosurface --samples 16 --iso 400,600,800 --iso-color '0.2,0.4,1;0.9,0.9,0.3;1,0.2,0.1' --iso-opacity 0.3,0.5,1 "
               "--azimuth 30 --elevation 35 --zoom 1.3 --background 1,1,1"),
        ("iso-shaded", "Lit isosurfaces", "Normals that vary smoothly, from a gradient at each vertex.",
         DISK, "--field Temp --model isosurface --samples 16 --iso 400,600,800 --iso-color '0.2,0.4,1;0.9,0.9,0.3;1,0.2,0.1' --iso-opacity 0.4,0.6,1 "
               "--shade vertex --azimuth 30 --elevation 35 --zoom 1.3 --background 1,1,1"),
        ("iso-volume", "Isosurfaces in a volume", "Mixed in the order of the ray.",
         DISK, "--field Temp --samples 16 --iso 700 --iso-color 1,0.6,0.2 --shade vertex --opacity 293:0,350:0.05,600:0.25 --azimuth 30 --elevation 35 "
               "--background 1,1,1"),
        ("shade-cell", "Light, a gradient a cell", "Flat, as the paper's: the cells show.",
         FIN, "--field Density --shade cell --opacity 0.19:0,1:0.1,2:0.6,5:3 --azimuth 25 --elevation 35 --zoom 1.15 --background 1,1,1"),
        ("shade-vertex", "Light, a gradient a vertex", "The same, smooth across cells.",
         FIN, "--field Density --shade vertex --opacity 0.19:0,1:0.1,2:0.6,5:3 --azimuth 25 --elevation 35 --zoom 1.15 --background 1,1,1"),
    ]),
    ("Fields and cells", [
        ("color-field", "Two fields", "Colour by one field, opacity by another.",
         DISK, "--field Temp --color-field Pres --color-map Viridis --opacity 293:0,400:0.3,900:2 --azimuth 30 --elevation 35 --zoom 1.3 --background 1,1,1"),
        ("cell-data", "Cell data", "Constant in each cell, with crisp boundaries.",
         CAN, "--field EQPS --cell-data --opacity 0:0.5,2.9:6 --azimuth 60 --elevation 20 --zoom 1.3 --background 1,1,1"),
        ("categories", "Materials", "A colour for each material number, and an opacity.",
         PLATE, "--field mat_id --categories '1:1,0.3,0.2,0.3;2:0.2,0.7,0.2,2;3:0.2,0.3,1,0.5;4:1,0.8,0,6' --azimuth 20 --elevation -50 "
                "--color-bar --background 1,1,1"),
        ("select", "Selection", "Whole cells within a range; the others are stepped through.",
         FIN, "--field Density --select Density:1.2,5 --opacity 0.19:0.4,5:1.5 --azimuth 25 --elevation 35 --zoom 1.15 --background 1,1,1"),
    ]),
    ("Cuts", [
        ("clip", "Clipping planes", "Cells are cut where the planes lie.",
         COMBUSTOR, "--field Density --clip 0,0,29,0,0,-1 --opacity 0.2:0.3,0.7:1.2 --azimuth 35 --elevation 25 --zoom 1.2 --background 1,1,1"),
        ("clip-box", "A box", "What lies inside it.",
         "synth:ball", "--clip-box -0.6,0.6,-1,1,-0.3,1 --opacity linear --azimuth 35 --elevation 25 --background 1,1,1"),
    ]),
    ("Geometry", [
        ("outline", "Outline", "The box around the mesh, in depth order with the volume.",
         DISK, "--field Temp --samples 16 --outline --opacity 293:0,400:0.2,900:1 --azimuth 30 --elevation 35 --background 1,1,1"),
        ("wireframe", "Wireframe", "The edges of the boundary.",
         CAN, "--field DISPL --samples 16 --wireframe --opacity 2:0.5,19:3 --azimuth 60 --elevation 20 --zoom 1.3 --background 1,1,1"),
        ("surface", "Surface", "The boundary, translucent, around the volume.",
         FIN, "--field Density --surface 0.25 --opacity 0.19:0,1:0.1,2:0.6,5:3 --azimuth 25 --elevation 35 --zoom 1.15 --background 1,1,1"),
        ("figure", "Colour bar, axes, title", "For papers; off by default.",
         DISK, "--field Temp --samples 16 --iso 700 --shade vertex --color-bar --axes --title 'Temperature' --azimuth 30 --elevation 35 --background 1,1,1"),
    ]),
    ("Figures of the 2003 paper", [
        ("weiler-1a", "Figure 1, left", "Lit isosurfaces of a sphere of tetrahedra.",
         "synth:ball", "--model isosurface --samples 16 --iso 0.2,0.45,0.7 --iso-opacity 1,0.5,0.3 --shade cell --azimuth 30 --elevation 25 --background 1,1,1"),
        ("weiler-1b", "Figure 1, middle; figure 5", "The heat sink, not convex, as a density emitter.",
         "synth:heatsink", "--color-map Turbo --opacity 12:0.5,75:8 --azimuth 30 --elevation 28 --background 1,1,1"),
        ("weiler-1c", "Figure 1, right", "Blunt Fin as a density emitter.",
         FIN, "--field Density --color-map Inferno --opacity 0.19:0,0.9:0.02,1.1:0.12,2:0.5,5:3 --azimuth 25 --elevation 35 --zoom 1.15 "
              "--background 1,1,1"),
        ("weiler-9a", "Figure 9, left", "Isosurfaces of the heat sink.",
         "synth:heatsink", "--model isosurface --samples 16 --iso 25,40,60 --iso-opacity 1,1,1 --shade cell --surface 0.15 --azimuth 30 --elevation 28 --background 1,1,1"),
        ("weiler-9b", "Figure 9, right", "A cylinder; the hole in its middle is filled with imaginary cells.",
         "synth:cylinder", "--color-map Turbo --opacity linear --azimuth 30 --elevation 40 --background 1,1,1"),
    ]),
]


# Lit isosurfaces beside VTK's contours of the same: values, colours, opacities, view.
CONTOURS = ("400,600,800", "0.2,0.4,1;0.9,0.9,0.3;1,0.2,0.1", "0.3,0.5,1", 160, 35)


def turned(options):
    """The options with the eye on another side."""
    words = shlex.split(options)
    at = words.index("--azimuth") + 1
    words[at] = str(float(words[at]) + 130)
    return words


def render(tetcast, source, words, out, size):
    path = source if source.startswith("synth:") else os.path.join(DATA, source)
    if not source.startswith("synth:") and not os.path.exists(path):
        return False
    subprocess.run([tetcast, "render", path, "--size", size, *words, "-o", out, "--quiet"], check=True)
    return True


def contours(tetcast, images):
    """The page's part that sets lit isosurfaces beside VTK's, with pictures where VTK is at hand."""
    values, colors, opacities, azimuth, elevation = CONTOURS
    options = (f"--field Temp --model isosurface --iso {values} --iso-color '{colors}' --iso-opacity {opacities} --shade vertex "
               f"--azimuth {azimuth} --elevation {elevation} --background 1,1,1")
    ours = os.path.join(images, "gallery-contours-tetcast.png")
    if render(tetcast, DISK, shlex.split(options), ours, SIZE):
        for kind in ("cells", "tets"):
            theirs = os.path.join(images, f"gallery-contours-vtk-{kind}.png")
            command = ["xvfb-run", "-a", "/usr/bin/python3", os.path.join(HERE, "contour_vtk.py"), os.path.join(DATA, DISK), theirs, "Temp",
                       values, colors, opacities, SIZE, str(azimuth), str(elevation), kind]
            try:
                subprocess.run(command, check=True, capture_output=True)
            except (OSError, subprocess.CalledProcessError):
                print("gallery: VTK is not at hand: its contours stay as they are")
    return ["## Beside VTK", "",
            "Isosurfaces of `disk_out_ref`'s temperature: tetcast, rays through the middle of the pixels; VTK's contour filter on the file's "
            "hexahedra, and on tetrahedra, as tetcast has them but cut by other diagonals, with its normals, one head light, Phong's interpolation "
            "and depth peeling (`docs/contour_vtk.py`). Where the surface is ragged the tetrahedra are: a hexahedron's contour is smoother. "
            "tetcast's normals come from the gradient of the field, VTK's from the triangles.", "",
            "| tetcast | VTK, hexahedra | VTK, tetrahedra |", "| --- | --- | --- |",
            "| ![tetcast](images/gallery-contours-tetcast.png) | ![VTK, hexahedra](images/gallery-contours-vtk-cells.png) | "
            "![VTK, tetrahedra](images/gallery-contours-vtk-tets.png) |", "",
            "```sh", f"tetcast render {os.path.basename(DISK)} --size {SIZE} {options}", "```", ""]


def main():
    arguments = sys.argv[1:]
    sides = None
    if "--sides" in arguments:
        at = arguments.index("--sides")
        sides = arguments[at + 1]
        del arguments[at:at + 2]
        os.makedirs(sides, exist_ok=True)
    tetcast = arguments[0]
    out = arguments[1] if len(arguments) > 1 else HERE
    os.makedirs(os.path.join(out, "images"), exist_ok=True)
    page = ["# Gallery", "",
            "One picture for each effect, made by `make docs` (`docs/gallery.py`) with the command below it. What a scene does not ask for "
            "costs it nothing; `tetcast explain` says what it asked for. The meshes: NASA's Blunt Fin, VTK's combustor, Sandia's "
            "`disk_out_ref` and `can` (as ParaView distributes them), and tetcast's own (`synth:`).", ""]
    missing = 0
    for title, entries in SHOWN:
        page += [f"## {title}", ""]
        for name, heading, what, source, options in entries:
            picture = os.path.join(out, "images", f"gallery-{name}.png")
            if not render(tetcast, source, shlex.split(options), picture, SIZE):
                print(f"gallery: {source} is not at hand: {name} stays as it is")
                missing += 1
            elif sides:
                render(tetcast, source, turned(options), os.path.join(sides, f"{name}-other.png"), SIZE)
            command = f"tetcast render {os.path.basename(source)} --size {SIZE} {options}"
            page += [f"### {heading}", "", what, "", f"![{heading}](images/gallery-{name}.png)", "", "```sh", command, "```", ""]
    page += contours(tetcast, os.path.join(out, "images"))
    with open(os.path.join(out, "gallery.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(page))
    print(f"gallery: {sum(len(e) for _, e in SHOWN) - missing} pictures")


if __name__ == "__main__":
    main()
