"""check_urdf.py PROGRAM MECHANISM POSE [LOOPS]: checks the URDF file written by `pkmopt pose`: its links form a tree
with the root "frame", its shapes coincide with the lines of the DXF file, and it lists LOOPS cut kinematic loops. If
Debian's check_urdf is installed, it must accept the file as well."""

import math
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy


def lines_of(dxf):
    """The endpoints of each LINE and POINT, as arrays 2 x 3."""
    rows = dxf.read_text().splitlines()
    pairs = list(zip(map(int, rows[::2]), rows[1::2]))
    starts = [k for k, pair in enumerate(pairs) if pair in ((0, "LINE"), (0, "POINT"))]
    found = []
    for start in starts:
        numbers, at = {}, start + 1
        while pairs[at][0] != 0:
            code, value = pairs[at]
            if code >= 10:
                numbers[code] = float(value)
            at += 1
        ends = [[numbers.get(10 * axis + end, numbers[10 * axis]) for axis in (1, 2, 3)] for end in (0, 1)]
        found.append(numpy.array(ends))
    return found


def numbers(element, name):
    return numpy.array([float(word) for word in element.get(name).split()])


def rotation_matrix(rpy):
    """Roll, pitch, yaw: rotations about the fixed axes x, y and z of the parent, in this order."""
    (r, p, y), c, s = rpy, math.cos, math.sin
    about_x = numpy.array([[1, 0, 0], [0, c(r), -s(r)], [0, s(r), c(r)]])
    about_y = numpy.array([[c(p), 0, s(p)], [0, 1, 0], [-s(p), 0, c(p)]])
    about_z = numpy.array([[c(y), -s(y), 0], [s(y), c(y), 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def shapes_of(robot):
    """The endpoints of the axis of each cylinder and sphere in the root frame; asserts that the links form a tree."""
    links = {link.get("name"): link for link in robot.iter("link")}
    assert len(links) == len(list(robot.iter("link"))), "two links with the same name"
    joints = {joint.find("child").get("link"): joint for joint in robot.iter("joint")}
    assert len({joint.get("name") for joint in joints.values()}) == len(list(robot.iter("joint"))) == len(links) - 1
    assert set(joints) == set(links) - {"frame"}

    def position_of(name):
        position, steps = numpy.zeros(3), 0
        while name != "frame":
            origin = joints[name].find("origin")
            assert not numbers(origin, "rpy").any() and joints[name].get("type") == "fixed"
            position, name = position + numbers(origin, "xyz"), joints[name].find("parent").get("link")
            steps += 1
            assert steps < len(links), "a loop"
        return position

    found = []
    for name, link in links.items():
        for visual in link.iter("visual"):
            origin, shape = visual.find("origin"), visual.find("geometry")[0]
            half = float(shape.get("length", 0)) / 2 * rotation_matrix(numbers(origin, "rpy"))[:, 2]
            centre = position_of(name) + numbers(origin, "xyz")
            found.append(numpy.array([centre - half, centre + half]))
            assert float(shape.get("radius")) >= 0
    return found


def main(program, mechanism, at, loops=None):
    with tempfile.TemporaryDirectory() as folder:
        urdf, dxf = Path(folder, "links.urdf"), Path(folder, "links.dxf")
        subprocess.run([program, "pose", mechanism, "--at", at, "-o", urdf, "-o", dxf], check=True,
                       stdout=subprocess.DEVNULL)
        if shutil.which("check_urdf"):
            subprocess.run(["check_urdf", urdf], check=True, stdout=subprocess.DEVNULL)
        shapes, lines = shapes_of(ElementTree.parse(urdf).getroot()), lines_of(dxf)
        assert len(shapes) == len(lines) > 0
        for line in lines:  # the shapes have another order than the lines
            assert min(abs(shape - line).max() for shape in shapes) < 1e-9, line
        cuts = urdf.read_text().count("<!-- cut loop: ")
        assert loops is None or cuts == int(loops), f"{cuts} cut loops"
        print(f"{len(lines)} shapes, {cuts} cut loops")


main(*sys.argv[1:])
