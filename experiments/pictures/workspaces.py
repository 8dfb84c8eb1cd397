"""workspaces.py OUT.png TITLE:SUBTITLE:FIELD:FILE.vtkhdf ...: workspace surfaces side by side, coloured by a field."""
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkFiltersSources import vtkOutlineSource
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextActor,
    vtkTextProperty,
    vtkWindowToImageFilter,
)
import vtkmodules.vtkRenderingFreeType  # noqa: F401, registers text rendering
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, registers OpenGL rendering

import h5py

# The colour map cividis, perceptually uniform and suited to colour-blind readers, at ten equidistant values.
CIVIDIS = np.array(
    [[0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120], [165, 156, 116],
     [195, 179, 105], [225, 204, 85], [254, 232, 56]]) / 255  # fmt: skip


def colours():
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for i in range(256):
        at = i / 255 * (len(CIVIDIS) - 1)
        table.SetTableValue(i, *(np.interp(at, range(len(CIVIDIS)), CIVIDIS[:, k]) for k in range(3)))
    table.Build()
    return table


def extrapolated(values):
    """Replaces NaN near known values by means of neighbours: the surface lies beyond the last feasible cells."""
    values = values.copy()
    for _ in range(3):
        padded = np.pad(values, 1, constant_values=np.nan)
        shifts = [np.roll(padded, step, axis)[1:-1, 1:-1, 1:-1] for axis in range(3) for step in (-1, 1)]
        count = sum(np.isfinite(s) for s in shifts)
        mean = sum(np.nan_to_num(s) for s in shifts) / np.maximum(count, 1)
        values = np.where(np.isnan(values) & (count > 0), mean, values)
    return np.nan_to_num(values)


def scene(title, subtitle, field, path, viewport):
    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput().GetPointData()
    cells = reader.GetOutput().GetDimensions()
    arrays = {name: vtk_to_numpy(data.GetArray(name)).reshape(cells[::-1]) for name in ("margin", "feasible", field)}
    inside = arrays[field][arrays["feasible"] > 0]

    # All axes have length 1, because lengths and a rotation cannot share a scale; a layer of infeasible cells around
    # the box closes the surface there.
    image = vtkImageData()
    image.SetDimensions(*(n + 2 for n in cells))
    image.SetSpacing(*(1 / n for n in cells))
    outside = -1e-6 * np.abs(arrays["margin"]).max()
    for name, values in (("margin", np.pad(arrays["margin"], 1, constant_values=outside)),
                         ("shown", extrapolated(np.pad(arrays[field], 1, constant_values=np.nan)))):  # fmt: skip
        array = numpy_to_vtk(values.ravel(), deep=True)
        array.SetName(name)
        image.GetPointData().AddArray(array)
    image.GetPointData().SetActiveScalars("margin")

    surface = vtkFlyingEdges3D()
    surface.SetInputData(image)
    surface.SetValue(0, 0.0)
    surface.InterpolateAttributesOn()
    surface.Update()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("shown")
    mapper.SetLookupTable(colours())
    mapper.SetScalarRange(*(float(v) for v in np.nanpercentile(inside, (1, 99))))
    actor = vtkActor()
    actor.SetMapper(mapper)

    box = vtkOutlineSource()
    box.SetBounds(surface.GetOutput().GetBounds())
    edges = vtkPolyDataMapper()
    edges.SetInputConnection(box.GetOutputPort())
    frame = vtkActor()
    frame.SetMapper(edges)
    frame.GetProperty().SetColor(0.6, 0.6, 0.6)

    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(*viewport)
    renderer.AddActor(actor)
    renderer.AddActor(frame)
    with h5py.File(path) as file:
        axes = [name.decode() if isinstance(name, bytes) else name for name in file["pkmopt/axes"][:]]
    text(renderer, title, 22, (0.5, 0.945), bold=True)
    text(renderer, "axes " + ", ".join(axes) + "; " + subtitle, 17, (0.5, 0.89))
    renderer.AddActor2D(bar(mapper))
    camera = renderer.GetActiveCamera()
    camera.SetPosition(2.2, -2.6, 1.7)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(0.82)
    camera.SetWindowCenter(0, 0.02)
    return renderer


def text(renderer, words, size, at, bold=False):
    actor = vtkTextActor()
    actor.SetInput(words)
    style(actor.GetTextProperty(), size, bold)
    actor.GetTextProperty().SetJustificationToCentered()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(*at)
    renderer.AddActor2D(actor)


def style(properties: vtkTextProperty, size, bold=False):
    properties.SetFontFamilyToArial()
    properties.SetFontSize(size)
    properties.SetColor(0.15, 0.15, 0.15)
    properties.SetBold(bold)
    properties.SetItalic(False)
    properties.SetShadow(False)


def bar(mapper):
    actor = vtkScalarBarActor()
    actor.SetLookupTable(mapper.GetLookupTable())
    actor.SetOrientationToHorizontal()
    actor.SetNumberOfLabels(3)
    actor.SetLabelFormat("%.2f")
    actor.UnconstrainedFontSizeOn()
    style(actor.GetLabelTextProperty(), 17)
    actor.SetPosition(0.2, 0.02)
    actor.SetWidth(0.6)
    actor.SetHeight(0.09)
    return actor


def main(out, pictures):
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(400 * len(pictures), 480)
    window.SetMultiSamples(8)
    for i, words in enumerate(pictures):
        viewport = (i / len(pictures), 0, (i + 1) / len(pictures), 1)
        window.AddRenderer(scene(*words.split(":", 3), viewport))
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetFileName(out)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


main(sys.argv[1], sys.argv[2:])
