#!/usr/bin/python3
"""The loop that a batch replaces, in VTK's Python: every step of a dataset, from some views, with some functions, as PNG files.

  xvfb-run -a /usr/bin/python3 batch_vtk.py SCENE.json FOLDER [--mapper default|preintegrated|projected]

SCENE.json is a scene of tetcast batch: data (a file, or a list of files), field, views {"phi": N, "theta": [..]}, a list of
transfer functions {"color_map": "Cool to Warm" or a preset of ColorSpace RGB from 0 to 1, "opacity": "S:A,S:A"}, output {"size": "WxH"}; ranges are fixed in it.
default: vtkUnstructuredGridVolumeRayCastMapper as it is; preintegrated: with the quicker of its integrators; projected:
vtkProjectedTetrahedraMapper, which is approximate. The mesh is split into tetrahedra once while it stays the same; mapper, window and functions are kept. Prints one JSON line:
{"frames": N, "seconds": S, "first": seconds to the first picture}. Needs python3-vtk9 and an X display.
"""

import argparse
import json
import math
import os
import sys
import time

sys.dont_write_bytecode = True

COOL_TO_WARM = [0, 0.231373, 0.298039, 0.752941, 0.5, 0.865003, 0.865003, 0.865003, 1, 0.705882, 0.0156863, 0.14902]


def reader_of(vtk, path):
    if path.endswith((".e", ".ex2")):
        reader = vtk.vtkExodusIIReader()
        reader.SetFileName(path)
        reader.UpdateInformation()
        for i in range(reader.GetNumberOfPointResultArrays()):
            reader.SetPointResultArrayStatus(reader.GetPointResultArrayName(i), 1)
        return reader
    reader = vtk.vtkHDFReader() if path.endswith(".hdf") else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    return reader


def steps(vtk, data):
    """Gives a grid for each step; of a file of several steps the reader is kept."""
    for path in data if isinstance(data, list) else [data]:
        reader = reader_of(vtk, path)
        information = reader.GetOutputInformation(0)
        times = information.Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or [None]
        for t in times:
            if t is not None:
                reader.UpdateTimeStep(t)
            else:
                reader.Update()
            output = reader.GetOutputDataObject(0)
            if output.IsA("vtkMultiBlockDataSet"):
                append = vtk.vtkAppendFilter()
                append.MergePointsOn()
                leaves = output.NewIterator()
                leaves.InitTraversal()
                while not leaves.IsDoneWithTraversal():
                    if leaves.GetCurrentDataObject().GetNumberOfCells():
                        append.AddInputData(leaves.GetCurrentDataObject())
                    leaves.GoToNextItem()
                append.Update()
                output = append.GetOutput()
            yield output


def functions(vtk, scene):
    made = []
    for f in scene["transfer_function"]:
        lo, hi = f["range"]
        color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
        points = COOL_TO_WARM
        if f["color_map"] == "Cool to Warm":
            color.SetColorSpaceToDiverging()
        else:
            points = f["color_map"]["RGBPoints"]
        for i in range(0, len(points), 4):
            color.AddRGBPoint(lo + (hi - lo) * points[i], *points[i + 1:i + 4])
        for knot in f["opacity"].split(","):
            s, a = knot.split(":")
            opacity.AddPoint(float(s), float(a))
        made.append((f["name"], color, opacity))
    return made


def finish(done, start, first):
    print(json.dumps({"frames": done, "seconds": time.monotonic() - start, "first": first or math.nan}))
    sys.stdout.flush()
    os._exit(0)  # VTK's window needs long to go


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("folder")
    parser.add_argument("--mapper", choices=["default", "preintegrated", "projected"], default="default")
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    start = time.monotonic()
    import vtk
    with open(options.scene, encoding="utf-8") as file:
        scene = json.load(file)
    width, height = (int(n) for n in scene["output"]["size"].split("x"))
    renderer, window, volume = vtk.vtkRenderer(), vtk.vtkRenderWindow(), vtk.vtkVolume()
    if options.mapper != "projected":
        mapper = vtk.vtkUnstructuredGridVolumeRayCastMapper()
        mapper.SetNumberOfThreads(options.threads)
        if options.mapper == "preintegrated":
            mapper.SetRayIntegrator(vtk.vtkUnstructuredGridPreIntegration())
    else:
        mapper = vtk.vtkProjectedTetrahedraMapper()
    volume.SetMapper(mapper)
    volume.GetProperty().SetInterpolationTypeToLinear()
    renderer.AddVolume(volume)
    renderer.SetBackground(*scene["output"].get("background", [0, 0, 0])[:3])
    window.AddRenderer(renderer)
    window.SetSize(width, height)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    looks = functions(vtk, scene)
    shot, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    shot.ShouldRerenderOff()
    writer.SetInputConnection(shot.GetOutputPort())
    split, done, first, home = vtk.vtkDataSetTriangleFilter(), 0, None, None
    for number, grid in enumerate(steps(vtk, scene["data"])):
        grid.GetPointData().SetActiveScalars(scene["field"])
        split.SetInputData(grid)
        split.TetrahedraOnlyOn()
        split.Update()
        kept = split.GetOutput()
        kept.GetPointData().SetActiveScalars(scene["field"])
        mapper.SetInputData(kept)
        if home is None:
            volume.GetProperty().SetScalarOpacityUnitDistance(grid.GetLength() / grid.GetNumberOfCells() ** (1 / 3))
            renderer.ResetCamera()
            home = vtk.vtkCamera()
            home.DeepCopy(renderer.GetActiveCamera())
        for name, color, opacity in looks:
            volume.GetProperty().SetColor(color)
            volume.GetProperty().SetScalarOpacity(opacity)
            for view in range(scene["views"]["phi"]):
                for theta in scene["views"]["theta"]:
                    phi = 360 * view / scene["views"]["phi"]
                    camera = renderer.GetActiveCamera()
                    camera.DeepCopy(home)
                    camera.Azimuth(phi)
                    camera.Elevation(theta)
                    renderer.ResetCameraClippingRange()
                    window.Render()
                    shot.Modified()
                    writer.SetFileName(os.path.join(options.folder, f"{number:03d}_{phi:g}_{theta:g}_{name}.png"))
                    writer.Write()
                    done += 1
                    first = first or time.monotonic() - start
    finish(done, start, first)


if __name__ == "__main__":
    main()
