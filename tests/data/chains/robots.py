"""Makes robots.json, reference values for the Exechon, the Isoglide4-T3R1 and the Hexaglide of
experiments/mechanisms/chains, independently of the program.

    python3 robots.py

The geometry is written down here; the mechanism files are not read. The parasitic motion of the Exechon is solved by
Newton's method from the conditions of its hinges. Differences, inertia and forces are those of ../frames/references.py.
"""

import itertools
import json
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "frames"))
sys.dont_write_bytecode = True

import references  # noqa: E402
from references import REAL, Bodies, case, rotation, solve, vector  # noqa: E402

references.STEP = STEP = REAL(1) / 8192  # the rods of the Hexaglide have large derivatives of high order

PI = np.arccos(REAL(-1))
DEGREE = PI / 180


def length(v):
    return np.sqrt(v @ v)


class Exechon:
    """2-UPR and 1-SPR; coordinates z, alpha, beta."""

    base = [vector("0.35", 0, 0), vector("-0.35", 0, 0), vector(0, "-0.45", 0)]
    hinges = [vector("0.15", 0, 0), vector("-0.15", 0, 0), vector(0, "-0.2", 0)]
    axes = [vector(0, 1, 0), vector(0, 1, 0), vector(1, 0, 0)]
    strokes = REAL("0.6"), REAL("1.1")
    known = None  # the last pose with its parasitic motion

    def platform(self, pose, others):
        x, y, gamma = others
        return vector(x, y, pose[0]), rotation(0, pose[1]) @ rotation(1, pose[2]) @ rotation(2, gamma)

    def parasitic(self, pose):
        """x, y and gamma for which every leg is normal to the axis of its hinge."""

        def offsets(others):
            p, R = self.platform(pose, others)
            return vector(*((R @ n) @ (p - A) for A, n in zip(self.base, self.axes)))

        if self.known and np.array_equal(self.known[0], pose):
            return self.known[1]
        others = vector(0, 0, 0)
        while max(abs(offsets(others))) > 1e-18:
            slopes = np.stack([(offsets(others + STEP * e) - offsets(others - STEP * e)) / (2 * STEP)
                               for e in np.eye(3, dtype=REAL)], 1)
            others = others - solve(slopes, offsets(others))
        self.known = pose, others
        return others

    def dependent(self, pose):
        return self.parasitic(pose)[:2]

    def legs(self, pose):
        p, R = self.platform(pose, self.parasitic(pose))
        return [(A, p + R @ b) for A, b in zip(self.base, self.hinges)]

    def joints(self, pose):
        return vector(*(length(B - A) for A, B in self.legs(pose)))

    def bodies(self, pose):
        all = Bodies()
        p, R = self.platform(pose, self.parasitic(pose))
        all.point(REAL(15), p)
        all.solid(vector("0.12", "0.15", "0.2"), R)
        for A, B in self.legs(pose):
            u = (B - A) / length(B - A)
            for mass, inertia, at in (("12", "0.4", A + REAL("0.15") * u), ("8", "0.3", B - REAL("0.3") * u)):
                all.point(REAL(mass), at)
                all.lines.append((REAL(inertia), u))
        return all

    def margins(self, pose):
        low, high = self.strokes
        return [m for q in self.joints(pose) for m in (q - low, high - q)]


class Isoglide:
    """Isoglide4-T3R1; coordinates x, y, z and phi about y."""

    d, l, r, s, tilt = REAL("0.5"), REAL("0.45"), REAL("0.15"), REAL("0.6"), 60 * DEGREE
    axes = [0, 1, 2, 2]  # of the legs: x, y or z

    def legs(self, pose):
        """Axis, slide and end of each leg."""
        tip = vector(np.cos(pose[3]), 0, -np.sin(pose[3])) * self.r
        legs = []
        for k, axis in enumerate(self.axes):
            B = pose[:3] + (tip if k == 3 else 0)
            S = vector(*[-self.d / 2] * 3)
            if k == 3:
                S[0] += self.r
            S[axis] = B[axis]
            legs.append((np.eye(3, dtype=REAL)[axis], S, B))
        return legs

    def joints(self, pose):
        return vector(*(S @ axis for axis, S, _ in self.legs(pose)))

    def bodies(self, pose):
        all = Bodies()
        R = rotation(1, pose[3])
        all.point(REAL(2), pose[:3] + R @ vector(self.r / 2, 0, 0))
        inertia = 2 * self.r**2 / 12
        all.solid(vector(0, inertia, inertia), R)
        mass = REAL("1.2") * self.l
        for axis, S, B in self.legs(pose):
            v = B - S
            height = np.sqrt(self.l**2 - v @ v / 4) / length(v)  # of the isosceles triangle of the two links
            elbow = S + v / 2 - height * np.cross(axis, v)  # the second link turns left, about the axis
            all.point(REAL(1), S)
            for start, end in ((S, elbow), (elbow, B)):
                all.rod(mass, mass * self.l**2 / 12, start, end)
        return all

    def margins(self, pose):
        found = [self.tilt - abs(pose[3])]
        for axis, S, B in self.legs(pose):
            found += [2 * self.l - length(B - S), S @ axis, self.s - S @ axis]
        return found


class Hexaglide:
    """Six slides on rails along x; coordinates x, y, z, alpha, beta, gamma."""

    d, r, L, stroke, cone = REAL("0.2"), REAL("0.15"), REAL("0.9"), REAL(2), 70 * DEGREE
    # rail, angle of the platform's joint [deg], and on which side of it the slide is
    rods = [(2.5, 20, -1), (1.5, -140, -1), (0.5, 100, 1), (-0.5, -100, 1), (-1.5, 140, -1), (-2.5, -20, -1)]

    def legs(self, pose):
        R = rotation(0, pose[3]) @ rotation(1, pose[4]) @ rotation(2, pose[5])
        legs = []
        for rail, angle, side in self.rods:
            B = pose[:3] + R @ vector(self.r * np.cos(angle * DEGREE), self.r * np.sin(angle * DEGREE), 0)
            y = REAL(rail) * self.d
            across = np.hypot(B[1] - y, B[2])
            along = self.L**2 - across**2
            legs.append((along, None if along < 0 else vector(B[0] + side * np.sqrt(along), y, 0), B))
        return R, legs

    def joints(self, pose):
        return vector(*(S[0] for _, S, _ in self.legs(pose)[1]))

    def bodies(self, pose):
        all = Bodies()
        R, legs = self.legs(pose)
        all.point(REAL(12), pose[:3])
        all.solid(12 * self.r**2 * vector("0.25", "0.25", "0.5"), R)
        mass = REAL("1.5") * self.L
        for _, S, B in legs:
            all.point(REAL(4), S)
            all.rod(mass, mass * self.L**2 / 12, S, B)
        return all

    def margins(self, pose):
        R, legs = self.legs(pose)
        found = [along for along, _, _ in legs]
        if min(found) < 0:
            return found
        for _, S, B in legs:
            found += [S[0] + self.stroke / 2, self.stroke / 2 - S[0]]
            found.append(self.cone - np.arccos((S - B) @ R[:, 2] / self.L))
        return found


def coupling_indices(found):
    """1 - exp(-sum of |M_q(i, k)|/M_q(i, i), k != i), with M_q = J^-T M J^-1."""
    J, M = (np.array(found[name], dtype=REAL) for name in ("J", "M"))
    inverse = np.stack([solve(J, e) for e in np.eye(len(J), dtype=REAL)], axis=1)
    M_q = abs(inverse.T @ M @ inverse)
    return [float(1 - np.exp(1 - sum(row) / row[i])) for i, row in enumerate(M_q)]


def voxels(robot, box, cells, fixed):
    """Which cells of a box of the first three coordinates are feasible, and the least margin."""
    centres = [[REAL(a) + (2 * i + 1) * (REAL(b) - REAL(a)) / (2 * cells) for i in range(cells)] for a, b in box]
    feasible, least = "", np.inf
    for pose in itertools.product(*centres):
        margins = robot.margins(vector(*pose, *fixed))
        feasible += "1" if min(margins) >= 0 else "0"
        least = min(least, *(abs(m) for m in margins))
    return {"cells": cells, "fixed": fixed, "feasible": feasible, "least_margin": float(least)}


def main():
    radians = float(60 * DEGREE)
    robots = {
        "exechon": (Exechon(), [(0.65, 0.8), (-0.4, 0.4), (-0.4, 0.4)], [(0, "1.1"), (-radians, radians)] +
                    [(-radians, radians)], []),
        "isoglide4-t3r1": (Isoglide(), [(0.15, 0.35)] * 3 + [(-0.9, 0.9)], [(0, "0.6")] * 3, [0.3]),
        "hexaglide": (Hexaglide(), [(-0.1, 0.1), (-0.1, 0.1), (-0.68, -0.58)] + [(-0.2, 0.2)] * 3,
                      [(-1, 1), ("-0.9", "0.9"), ("-0.9", 0)], [0.1, -0.15, 0.2]),
    }
    text = []
    for name, (robot, poses, box, fixed) in robots.items():
        random = np.random.default_rng(1)
        cases = []
        for _ in range(6):
            x, v, a = (np.round([random.uniform(*side) for side in sides], 4)
                       for sides in (poses, [(-1.5, 1.5)] * len(poses), [(-8, 8)] * len(poses)))
            assert min(robot.margins(vector(*x))) > 0
            found = case(robot, x, v, a)
            cases.append(json.dumps(found | {"dci": coupling_indices(found)}))
        text.append(f' "{name}": {{\n  "cases": [\n   ' + ",\n   ".join(cases) + '],\n  "voxels": ' +
                    json.dumps(voxels(robot, box, 12, fixed)) + "}")
    (HERE / "robots.json").write_text("{\n" + ",\n".join(text) + "\n}\n")


if __name__ == "__main__":
    main()
