"""check_vtp.py PROGRAM STUDY POSE: uses VTK to read the file that `pkmopt pose -o F.vtp` writes for a study with
obstacles. Checks that each body has its name and its part and is a closed surface, and that boxes and spheres have the
correct volumes. Exit code 77 if VTK is missing."""

import subprocess
import sys
import tempfile
import tomllib
from math import pi, prod
from pathlib import Path

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    sys.exit(77)
import numpy


def texts(data, name):
    """The strings of an array of field data."""
    array = data.GetFieldData().GetAbstractArray(name)
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def number(text):
    """Converts "20 mm", "1 m" or a plain number to m."""
    value, unit = (text.split() if isinstance(text, str) else (text, "m"))
    return float(value) * {"mm": 1e-3, "m": 1}[unit]


def volume(corners):
    """Volume enclosed by oriented triangles (divergence theorem); corners: triangles x 3 x 3."""
    return numpy.einsum("ij,ij->", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])) / 6


def main():
    program, study, pose = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.vtp"
        subprocess.run([program, "pose", study, "--at", pose, "-o", file], check=True, stdout=subprocess.DEVNULL)
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(file))
        reader.Update()
    data = reader.GetOutput()
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    triangles = vtk_to_numpy(data.GetPolys().GetData()).reshape(-1, 4)
    assert (triangles[:, 0] == 3).all()
    corners = points[triangles[:, 1:]]
    body, part = (vtk_to_numpy(data.GetCellData().GetArray(name)) for name in ("body", "part"))
    bodies, parts = texts(data, "bodies"), texts(data, "parts")
    assert set(body) == set(range(len(bodies))) and set(part) == set(range(len(parts)))
    assert {"crank of arm1", "rod of arm3"} < set(bodies), bodies
    assert {"arm1", "platform", "obstacle"} < set(parts), parts
    assert texts(data, "title")[0].startswith("links of rotary-delta"), texts(data, "title")

    for k in range(len(bodies)):  # closed: every edge occurs once in each direction
        ends = numpy.roll(corners[body == k], -1, axis=1)
        edges = {(tuple(a), tuple(b)) for a, b in zip(corners[body == k].reshape(-1, 3), ends.reshape(-1, 3))}
        assert edges == {(b, a) for a, b in edges}, bodies[k]

    obstacles = tomllib.loads(Path(study).read_text())["obstacle"]
    assert [bodies[k] for k in sorted(set(body[part == parts.index("obstacle")]))] == [o["name"] for o in obstacles]
    for obstacle in obstacles:
        if obstacle["shape"] == "box":
            expected, tolerance = prod(map(number, obstacle["size"])), 1e-6
        else:
            expected, tolerance = 4 / 3 * pi * number(obstacle["radius"]) ** 3, 0.05  # inscribed polyhedron
        found = volume(corners[body == bodies.index(obstacle["name"])])
        assert abs(found - expected) < tolerance * expected, (obstacle["name"], found, expected)
    print(len(bodies), "bodies of", len(triangles), "triangles")


main()
