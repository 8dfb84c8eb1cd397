"""Reads an image in VTKHDF format with VTK's own reader, for tests of engine/export/vtk_image.hpp.

read_vtk.py FILE            prints dimensions, spacing, origin, and the bits of each array, x varying fastest
read_vtk.py FILE TABLE.csv  compares every array with the column of the same name in a table of pkmopt workspace --csv
"""

import csv
import math
import sys

import vtkmodules.vtkIOHDF
from vtkmodules.util.numpy_support import vtk_to_numpy


def read(path):
    reader = vtkmodules.vtkIOHDF.vtkHDFReader()
    assert reader.CanReadFile(path), path
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    data = image.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    return image, arrays


def show(path):
    image, arrays = read(path)
    print("dimensions", *image.GetDimensions())
    print("spacing", *image.GetSpacing())
    print("origin", *image.GetOrigin())
    for name in sorted(arrays):
        print(name, " ".join("%016x" % x for x in arrays[name].astype("<f8").view("<u8")))


def compare(path, table):
    image, arrays = read(path)
    with open(table, newline="") as file:
        rows = list(csv.reader(file))
    names = [header.split(" [")[0] for header in rows[0]]
    n = image.GetDimensions()
    assert len(rows) - 1 == n[0] * n[1] * n[2], (len(rows), n)
    assert set(arrays) == set(names[4:]), (sorted(arrays), names)
    for cell, row in enumerate(rows[1:]):
        k, j, i = cell % n[2], cell // n[2] % n[1], cell // n[2] // n[1]
        point = image.GetPoint((k * n[1] + j) * n[0] + i)
        for axis in range(3):
            assert math.isclose(point[axis], float(row[axis]), rel_tol=1e-12, abs_tol=1e-12), (cell, point, row)
        for name, text in list(zip(names, row))[4:]:
            value = arrays[name][(k * n[1] + j) * n[0] + i]
            assert math.isnan(value) if text == "" else value == float(text), (cell, name, value, text)
    print("equal", len(rows) - 1, "cells of", len(arrays), "arrays")


if len(sys.argv) == 2:
    show(sys.argv[1])
else:
    compare(*sys.argv[1:])
