"""check_models.py PROGRAM MECHANISM POSE LOOPS OTHERS: checks the models for simulation that `pkmopt pose` writes. The
joints of the URDF file form a tree with one root, LOOPS loops are closed by <constraint> and in the YAML file, SDF and
MJCF files have the same bodies, masses and drives, and shapes coincide with the lines of the DXF file, but for OTHERS
lines, of pairs of rods and of legs. With OTHERS = "fixed", the URDF file is that of a mechanism without such a model:
its joints are fixed, and comments list LOOPS cut loops. If Debian's check_urdf is installed, it must accept the file as
well."""

import math
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy
import yaml


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


def links_of(robot):
    """Links by name, and the joint of each with its parent; asserts that they form a tree with one root."""
    links = {link.get("name"): link for link in robot.iter("link")}
    assert len(links) == len(list(robot.iter("link"))), "two links with the same name"
    joints = {joint.find("child").get("link"): joint for joint in robot.iter("joint")}
    assert len({joint.get("name") for joint in joints.values()}) == len(list(robot.iter("joint"))) == len(links) - 1
    (root,) = set(links) - set(joints)
    return links, joints, root


def positions_of(links, joints, root):
    """Origins of the frames of links, which have the axes of the root's."""

    def position_of(name):
        position, steps = numpy.zeros(3), 0
        while name != root:
            origin = joints[name].find("origin")
            assert name == "platform_frame" or not numbers(origin, "rpy").any()
            position, name = position + numbers(origin, "xyz"), joints[name].find("parent").get("link")
            steps += 1
            assert steps < len(links), "a loop"
        return position

    return {name: position_of(name) for name in links}


def shapes_of(links, positions):
    """The endpoints of the axis of each cylinder and sphere, in the root frame."""
    found = []
    for name, link in links.items():
        for visual in link.iter("visual"):
            origin, shape = visual.find("origin"), visual.find("geometry")[0]
            half = float(shape.get("length", 0)) / 2 * rotation_matrix(numbers(origin, "rpy"))[:, 2]
            centre = positions[name] + numbers(origin, "xyz")
            found.append(numpy.array([centre - half, centre + half]))
            assert float(shape.get("radius")) >= 0
    return found


def check_physical(mass, moments):
    """Simulation programs require positive masses and moments of inertia that a body can have."""
    inertia = numpy.array([[moments["ixx"], moments["ixy"], moments["ixz"]],
                           [moments["ixy"], moments["iyy"], moments["iyz"]],
                           [moments["ixz"], moments["iyz"], moments["izz"]]])
    smallest, middle, largest = numpy.linalg.eigvalsh(inertia)
    assert mass > 0 and smallest > 0 and largest <= (smallest + middle) * (1 + 1e-9), (mass, inertia)


def check_urdf(robot):
    """The masses and drives of the URDF file; its joints move, and all but the drives are without limits."""
    links, joints, root = links_of(robot)
    assert root == "base" and "platform_frame" in links
    masses = {}
    for name in set(links) - {"base", "platform_frame"}:
        inertial = links[name].find("inertial")
        masses[name] = float(inertial.find("mass").get("value"))
        check_physical(masses[name], {key: float(value) for key, value in inertial.find("inertia").attrib.items()})
    drives = {}
    for joint in joints.values():
        assert joint.get("type") in ("fixed", "continuous", "revolute", "prismatic")
        if joint.get("type") != "fixed":
            assert abs(numpy.linalg.norm(numbers(joint.find("axis"), "xyz")) - 1) < 1e-12
        limit = joint.find("limit")
        assert (limit is not None) or joint.get("type") in ("fixed", "continuous")
        if limit is None:
            continue
        drives[joint.get("name")] = joint
        assert float(limit.get("effort")) > 0 and float(limit.get("velocity")) > 0
        if "lower" in limit.attrib:
            assert float(limit.get("lower")) <= 0 <= float(limit.get("upper"))
    return masses, drives


def check_closures(robot, positions, closures):
    """The two ends of each <constraint> coincide, and the YAML file says the same."""
    constraints = list(robot.iter("constraint"))
    assert [constraint.get("name") for constraint in constraints] == [closure["name"] for closure in closures]
    for constraint, closure in zip(constraints, closures):
        assert constraint.get("type") == closure["type"]
        ends = []
        for side in ("parent", "child"):
            link, point = constraint.find(side).get("link"), numbers(constraint.find(side + "_origin"), "xyz")
            assert link == closure[side] and (point == closure[side + "_point"]).all()
            ends.append(positions[link] + point)
            axis = constraint.find(side + "_axis")
            assert (axis is None) == (closure["type"] == "spherical")
            assert axis is None or (numbers(axis, "xyz") == closure[side + "_axis"]).all()
        assert abs(ends[0] - ends[1]).max() < 1e-12
    return len(constraints)


def check_sdf(sdf, masses, positions, drives, loops):
    """The bodies of the SDF file are those of the URDF file without the bodies between revolute joints."""
    model = sdf.find("model")
    bodies = {link.get("name"): link for link in model.findall("link")}
    assert set(bodies) == {name for name in masses if not name.startswith("between_")} | {"base"}
    for name in set(bodies) - {"base"}:
        inertial = bodies[name].find("inertial")
        assert float(inertial.find("mass").text) == masses[name]
        check_physical(masses[name], {element.tag: float(element.text) for element in inertial.find("inertia")})
        assert abs(numpy.array(bodies[name].find("pose").text.split()[:3], float) - positions[name]).max() < 1e-12
    joints = {joint.get("name"): joint for joint in model.findall("joint")}
    assert len(joints) == len(bodies) + loops and set(drives) <= set(joints)
    for joint in joints.values():
        assert joint.find("parent").text in set(bodies) | {"world"} and joint.find("child").text in bodies
    for name, drive in drives.items():
        limit = drive.find("limit")
        if "lower" in limit.attrib:
            for end in ("lower", "upper"):
                assert limit.get(end) == joints[name].find(f"axis/limit/{end}").text


def check_mjcf(mujoco, masses, drives, position_at_zero, loops):
    """The bodies of the MJCF file are those of the SDF file, perhaps with some in universal joints that close loops."""
    bodies = {body.get("name"): body for body in mujoco.find("worldbody").iter("body")}
    assert {name for name in masses if not name.startswith("between_")} == \
        {name for name in bodies if not name.startswith("between_")}
    for name in bodies:
        assert name.startswith("between_") or float(bodies[name].find("inertial").get("mass")) == masses[name]
    joints = {joint.get("name"): joint for joint in mujoco.find("worldbody").iter("joint")}
    for name, drive in drives.items():
        assert float(joints[name].get("ref")) == position_at_zero[name]
        limit = drive.find("limit")
        if "lower" in limit.attrib:
            lower, upper = numbers(joints[name], "range")
            ends = position_at_zero[name] + numpy.array([float(limit.get("lower")), float(limit.get("upper"))])
            assert abs(ends - [lower, upper]).max() < 1e-12
    assert [motor.get("joint") for motor in mujoco.find("actuator")] == list(drives)
    assert len(mujoco.find("equality")) >= loops
    assert mujoco.find("default/equality").get("solimp") is not None


def main(program, mechanism, at, loops, others):
    with tempfile.TemporaryDirectory() as folder:
        path = {kind: Path(folder, "model." + kind) for kind in ("urdf", "sdf", "xml", "yaml", "dxf")}
        kinds = ("urdf", "dxf") if others == "fixed" else ("urdf", "sdf", "xml", "dxf")
        command = [program, "pose", mechanism, "--at", at]
        for kind in kinds:
            command += ["-o", path[kind]]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        if shutil.which("check_urdf"):
            subprocess.run(["check_urdf", path["urdf"]], check=True, stdout=subprocess.DEVNULL)
        robot = ElementTree.parse(path["urdf"]).getroot()
        links, joints, root = links_of(robot)
        positions = positions_of(links, joints, root)
        shapes, lines = shapes_of(links, positions), lines_of(path["dxf"])
        # the shapes have another order than the lines
        missing = sum(min(abs(shape - line).max() for shape in shapes) > 1e-9 and
                      min(abs(shape[::-1] - line).max() for shape in shapes) > 1e-9 for line in lines)
        if others == "fixed":
            assert root == "frame" and {joint.get("type") for joint in joints.values()} == {"fixed"}
            assert missing == 0 and len(shapes) == len(lines) > 0
            assert path["urdf"].read_text().count("<!-- cut loop: ") == int(loops)
            return
        assert missing == int(others), f"{missing} lines are not drawn"
        masses, drives = check_urdf(robot)
        beside = yaml.safe_load(path["yaml"].read_text())
        assert check_closures(robot, positions, beside["loop_closures"]) == int(loops)
        position_at_zero = {drive["joint"]: drive["position_at_zero"] for drive in beside["drives"]}
        assert list(position_at_zero) == list(drives)
        check_sdf(ElementTree.parse(path["sdf"]).getroot(), masses, positions, drives, int(loops))
        check_mjcf(ElementTree.parse(path["xml"]).getroot(), masses, drives, position_at_zero, int(loops))


main(*sys.argv[1:])
