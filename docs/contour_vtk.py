#!/usr/bin/python3
"""VTK's contours of a mesh, as lit surfaces: what tetcast's isosurfaces are set beside in docs/gallery.md.

    xvfb-run -a /usr/bin/python3 docs/contour_vtk.py MESH.vtu OUT.png FIELD VALUES COLORS OPACITIES SIZE AZIMUTH ELEVATION cells|tets

VALUES a,b; COLORS r,g,b;r,g,b; OPACITIES a,b; SIZE WxH. The camera is ResetCamera's over the mesh, then Azimuth and Elevation; one head
light; ambient 0.2, diffuse 0.8, specular 0.2, power 20, two-sided; normals interpolated (Phong); translucent surfaces by depth
peeling; 8 x multisampling is left out, as a ray goes through the middle of each pixel. Needs python3-vtk9 and an X display.
"""
import sys

import vtk


def main():
    mesh, out, field, values, colors, opacities, size, azimuth, elevation, tets = sys.argv[1:]
    width, height = (int(v) for v in size.split("x"))
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(mesh)
    reader.Update()
    grid = reader.GetOutput()
    if tets == "tets":  # hexahedra split into tets, as tetcast has them, though not by the same diagonals
        grid.Squeeze()
        split = vtk.vtkDataSetTriangleFilter()
        split.SetInputData(grid)
        split.TetrahedraOnlyOn()
        split.Update()
        grid = split.GetOutput()
    grid.GetPointData().SetActiveScalars(field)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetUseDepthPeeling(1)
    renderer.SetMaximumNumberOfPeels(32)
    renderer.SetOcclusionRatio(0)
    for value, color, opacity in zip(values.split(","), colors.split(";"), opacities.split(",")):
        contour = vtk.vtkContourFilter()
        contour.SetInputData(grid)
        contour.SetValue(0, float(value))
        contour.ComputeNormalsOff()
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputConnection(contour.GetOutputPort())
        normals.SplittingOff()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(normals.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        shown = actor.GetProperty()
        shown.SetColor(*(float(c) for c in color.split(",")))
        shown.SetOpacity(float(opacity))
        shown.SetAmbient(0.2)
        shown.SetDiffuse(0.8)
        shown.SetSpecular(0.2)
        shown.SetSpecularPower(20)
        shown.SetSpecularColor(1, 1, 1)
        shown.SetInterpolationToPhong()
        renderer.AddActor(actor)
    window = vtk.vtkRenderWindow()
    window.SetMultiSamples(0)
    window.SetAlphaBitPlanes(1)
    window.SetSize(width, height)
    window.SetOffScreenRendering(1)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    renderer.ResetCamera(grid.GetBounds())
    camera.Azimuth(float(azimuth))
    camera.Elevation(float(elevation))
    renderer.ResetCameraClippingRange()
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(out)
    writer.SetInputConnection(shot.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
