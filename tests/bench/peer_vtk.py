#!/usr/bin/python3
"""VTK's own volume renderers of unstructured grids, timed, with their pictures: the peers that tetcast is measured against.

  xvfb-run -a /usr/bin/python3 peer_vtk.py MESH.vtu --field Density --mapper bunyk-preintegrated --azimuth 0,60 --frames 5

Mappers: bunyk-preintegrated, bunyk-partial, bunyk-linear (vtkUnstructuredGridVolumeRayCastMapper, after Bunyk et al. 1997,
with the three ray integrators), projected (vtkProjectedTetrahedraMapper), zsweep (vtkUnstructuredGridVolumeZSweepMapper).
Needs python3-vtk9, python3-numpy and an X display (Debian's VTK has no other kind of window).

Colour and opacity share one list of knots: vtkUnstructuredGridPartialPreIntegration and the linear integrator drop opacity
knots that the colour function does not have. Pictures are what the mapper gave, 8 bits a channel, premultiplied.
With --serve it answers one JSON request a line (keys: mapper, camera, frames, warm, picture) with one JSON line each.
"""

import argparse
import json
import math
import os
import statistics
import sys
import time

sys.dont_write_bytecode = True

MAPPERS = ["bunyk-preintegrated", "bunyk-partial", "bunyk-linear", "projected", "zsweep"]


def camera_reset(bounds, azimuth=0.0, view_angle=30.0):
    """vtkRenderer::ResetCamera from +z for a square picture, then vtkCamera::Azimuth."""
    centre = [(bounds[2 * a] + bounds[2 * a + 1]) / 2 for a in range(3)]
    radius = math.dist(bounds[0::2], bounds[1::2]) / 2
    distance = radius / math.sin(math.radians(view_angle) / 2)
    turn = math.radians(azimuth)
    eye = [centre[0] + distance * math.sin(turn), centre[1], centre[2] + distance * math.cos(turn)]
    return {"position": eye, "focal_point": centre, "view_up": [0, 1, 0], "view_angle": view_angle}


def cool_to_warm(lo, hi, opacity=0.3, n=33):
    """The benchmark transfer function: n knots of the diverging map, opacity linear from 0."""
    import vtk
    color = vtk.vtkColorTransferFunction()
    color.SetColorSpaceToDiverging()
    color.AddRGBPoint(0, 0.231373, 0.298039, 0.752941)
    color.AddRGBPoint(0.5, 0.865003, 0.865003, 0.865003)
    color.AddRGBPoint(1, 0.705882, 0.0156863, 0.14902)
    knots = []
    for i in range(n):
        t = i / (n - 1)
        knots.append([lo + (hi - lo) * t, *color.GetColor(t), opacity * t])
    return knots


class Peer:
    """One mesh with one transfer function; mappers are made when first asked for and kept."""

    def __init__(self, options):
        import vtk
        self.vtk = vtk
        self.size = options.size
        self.threads = options.threads
        self.mappers = {}
        self.grid = self.read(options.mesh)
        self.use_field(options.field)
        self.tets = self.grid.GetNumberOfCells()
        self.bounds = list(self.grid.GetBounds())
        if options.write_tets:
            self.write(options.write_tets)
        lo, hi = self.range
        self.knots = cool_to_warm(lo, hi)
        if options.transfer:
            with open(options.transfer, encoding="utf-8") as file:
                self.knots = json.load(file)
        diagonal = math.dist(self.bounds[0::2], self.bounds[1::2])
        self.unit = options.unit_distance or diagonal / self.tets ** (1 / 3)
        self.window = None

    def read(self, path):
        vtk = self.vtk
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(path)
        if not os.path.exists(path) or not reader.CanReadFile(path):
            sys.exit(f"{path}: not a VTK XML unstructured grid")
        reader.Update()
        grid = reader.GetOutput()
        types = vtk.vtkCellTypes()
        grid.GetCellTypes(types)
        if [types.GetCellType(i) for i in range(types.GetNumberOfTypes())] != [vtk.VTK_TETRA]:
            grid.Squeeze()  # vtkDataSetTriangleFilter reads past the types of a grid with spare room
            split = vtk.vtkDataSetTriangleFilter()
            split.SetInputData(grid)
            split.TetrahedraOnlyOn()
            split.Update()
            grid = split.GetOutput()
        return grid

    def use_field(self, name):
        points, cells = self.grid.GetPointData(), self.grid.GetCellData()
        names = [d.GetArrayName(i) for d in (points, cells) for i in range(d.GetNumberOfArrays())]
        if name is None and names:
            name = names[0]
        data = points if points.HasArray(name or "") else cells
        if not name or not data.HasArray(name):
            sys.exit(f"no array '{name}'; there are {', '.join(names)}")
        self.of_points = data is points
        self.field = name
        data.SetActiveScalars(name)
        self.range = list(data.GetArray(name).GetRange())

    def write(self, path):
        """The tets and the field in use, for tetcast to read."""
        out = self.vtk.vtkUnstructuredGrid()
        out.SetPoints(self.grid.GetPoints())
        out.SetCells(self.vtk.VTK_TETRA, self.grid.GetCells())
        source, target = ((self.grid.GetPointData(), out.GetPointData()) if self.of_points else
                          (self.grid.GetCellData(), out.GetCellData()))
        target.SetScalars(source.GetArray(self.field))
        writer = self.vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(path)
        writer.SetInputData(out)
        writer.Write()

    def open_window(self):
        vtk = self.vtk
        if not os.environ.get("DISPLAY"):
            sys.exit("no X display: run under xvfb-run -a")
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetAlphaBitPlanes(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*self.size)
        self.renderer = vtk.vtkRenderer()
        self.renderer.SetBackground(0, 0, 0)
        self.renderer.SetBackgroundAlpha(0)
        self.window.AddRenderer(self.renderer)
        color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
        color.SetColorSpaceToRGB()
        for s, r, g, b, a in self.knots:
            color.AddRGBPoint(s, r, g, b)
            opacity.AddPoint(s, a)
        self.volume = vtk.vtkVolume()
        prop = self.volume.GetProperty()
        prop.SetColor(color)
        prop.SetScalarOpacity(opacity)
        prop.SetScalarOpacityUnitDistance(self.unit)
        prop.SetInterpolationTypeToLinear()
        prop.ShadeOff()
        self.renderer.AddVolume(self.volume)

    def mapper(self, name):
        vtk = self.vtk
        if name in self.mappers:
            return self.mappers[name]
        if name == "projected":
            mapper = vtk.vtkProjectedTetrahedraMapper()
        elif name == "zsweep":
            mapper = vtk.vtkUnstructuredGridVolumeZSweepMapper()
            mapper.SetRayIntegrator(vtk.vtkUnstructuredGridPreIntegration())
        else:
            integrator = {"bunyk-preintegrated": vtk.vtkUnstructuredGridPreIntegration,
                          "bunyk-partial": vtk.vtkUnstructuredGridPartialPreIntegration,
                          "bunyk-linear": vtk.vtkUnstructuredGridLinearRayIntegrator}[name]
            mapper = vtk.vtkUnstructuredGridVolumeRayCastMapper()
            mapper.SetRayIntegrator(integrator())
            mapper.SetNumberOfThreads(self.threads)
        if name != "projected":
            mapper.AutoAdjustSampleDistancesOff()
            mapper.SetImageSampleDistance(1)
            mapper.IntermixIntersectingGeometryOff()
        mapper.SetInputData(self.grid)
        if self.of_points:
            mapper.SetScalarModeToUsePointData()
        else:
            mapper.SetScalarModeToUseCellData()
        self.mappers[name] = mapper
        return mapper

    def set_camera(self, c):
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(c["position"])
        camera.SetFocalPoint(c["focal_point"])
        camera.SetViewUp(c["view_up"])
        camera.SetViewAngle(c.get("view_angle", 30))
        camera.SetParallelProjection("parallel_scale" in c)
        if "parallel_scale" in c:
            camera.SetParallelScale(c["parallel_scale"])
        self.renderer.ResetCameraClippingRange()

    def frame_ms(self):
        self.renderer.GetActiveCamera().Modified()
        start = time.perf_counter()
        self.window.Render()
        self.window.WaitForCompletion()
        return 1e3 * (time.perf_counter() - start)

    def render(self, name, camera, frames, warm=1):
        """Times of `frames` frames after `warm` others; set-up is in the first frame a mapper ever makes."""
        if not self.window:
            self.open_window()
        first = name not in self.mappers
        self.volume.SetMapper(self.mapper(name))
        self.set_camera(camera)
        result = {"mapper": name, "threads": self.threads, "camera": camera}
        if first:
            result["first_frame_ms"] = self.frame_ms()
        for _ in range(warm):
            self.frame_ms()
        times = [self.frame_ms() for _ in range(frames)]
        if times:
            result.update(frame_ms=statistics.median(times), frame_min_ms=min(times), frame_max_ms=max(times),
                          frames=frames)
        return result

    def picture(self):
        """What the window holds: float32 [height][width][4], premultiplied, row 0 at the top."""
        import numpy
        from vtk.util.numpy_support import vtk_to_numpy
        width, height = self.size
        pixels = self.vtk.vtkUnsignedCharArray()
        self.window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, pixels)
        rgba = vtk_to_numpy(pixels).reshape(height, width, 4)[::-1]
        return numpy.ascontiguousarray(rgba, dtype="f4") / 255

    def save(self, path):
        import picture
        picture.write_raw(path + ".rgba", self.picture())
        picture.write_tiff(path + ".tif", self.picture())

    def about(self):
        result = {"vtk": self.vtk.vtkVersion.GetVTKVersion(), "tets": self.tets, "field": self.field,
                  "association": "point" if self.of_points else "cell", "range": self.range, "bounds": self.bounds,
                  "unit_distance": self.unit, "knots": self.knots, "size": self.size, "threads": self.threads}
        if self.window:
            report = self.window.ReportCapabilities()
            for line in report.splitlines():
                if line.startswith("OpenGL renderer string:"):
                    result["gl_renderer"] = line.split(":", 1)[1].strip()
        return result


def serve(peer):
    """One request a line on stdin, one answer a line on stdout. An empty request asks what is loaded."""
    for line in sys.stdin:
        request = json.loads(line)
        if "mapper" not in request:
            answer = peer.about()
        else:
            answer = peer.render(request["mapper"], request["camera"], request.get("frames", 0), request.get("warm", 1))
            if request.get("picture"):
                peer.save(request["picture"])
        print(json.dumps(answer), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="a VTU file; cells other than tets are split by vtkDataSetTriangleFilter")
    parser.add_argument("--field", help="point or cell array; default the first")
    parser.add_argument("--size", default="512x512", help="WxH")
    parser.add_argument("--transfer", help="JSON file of knots [s, r, g, b, a]; default the benchmark transfer function")
    parser.add_argument("--unit-distance", type=float, help="default bounds diagonal / cbrt(cells)")
    parser.add_argument("--camera", help="JSON file: position, focal_point, view_up, view_angle or parallel_scale")
    parser.add_argument("--mapper", default="bunyk-preintegrated", help=", ".join(MAPPERS) + "; several by commas")
    parser.add_argument("--azimuth", default="0", help="degrees, several by commas, from ResetCamera's view from +z")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2, help="of the ray caster, and of llvmpipe")
    parser.add_argument("--picture", help="writes PREFIX_MAPPER_AZIMUTH.rgba (raw floats, with .json) and .tif")
    parser.add_argument("--write-tets", help="writes the tets and the field as VTU")
    parser.add_argument("--serve", action="store_true", help="answers requests on stdin")
    options = parser.parse_args()
    options.size = [int(n) for n in options.size.split("x")]
    os.environ["LP_NUM_THREADS"] = str(options.threads)  # read when the first context is made

    peer = Peer(options)
    if options.serve:
        serve(peer)
        return
    runs = []
    names = [name for name in options.mapper.split(",") if name]
    for name in names:
        if name not in MAPPERS:
            sys.exit(f"no mapper '{name}'; there are {', '.join(MAPPERS)}")
    for azimuth in [float(a) for a in options.azimuth.split(",")]:
        camera = camera_reset(peer.bounds, azimuth)
        if options.camera:
            with open(options.camera, encoding="utf-8") as file:
                camera = json.load(file)
        for name in names:
            run = peer.render(name, camera, options.frames)
            run["azimuth"] = azimuth
            if options.picture:
                peer.save(f"{options.picture}_{name}_{azimuth:g}")
            runs.append(run)
    print(json.dumps({"data": peer.about(), "runs": runs}, indent=1))


if __name__ == "__main__":
    main()
