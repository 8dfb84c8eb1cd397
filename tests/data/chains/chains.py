"""Makes chains.json, reference values for experiments/mechanisms/chains/agile-eye.toml, independently of the program.

    python3 chains.py

The geometry is written down here; the mechanism file is not read. The axis w of the joint in the middle of a limb is
found by intersecting the two circles of the sphere around u and v, and the links are sums of point masses (Gauss
quadrature along the arcs). Differences, inertia and forces are those of ../frames/references.py.
"""

import json
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "frames"))
sys.dont_write_bytecode = True

from references import REAL, Bodies, case, rotation, vector  # noqa: E402

DEGREE = np.arccos(REAL(-1)) / 180


class AgileEye:
    """Spherical 3-RRR; coordinates alpha, beta, gamma."""

    rho, alpha = REAL("0.1"), (90 * DEGREE, 90 * DEGREE)
    gamma = [REAL("54.735610317245345") * DEGREE] * 2
    per_length = REAL("0.8"), REAL("0.6")

    def axes(self, k):
        turn = rotation(2, 120 * k * DEGREE)
        g_1, g_2 = self.gamma
        u = vector(np.sin(g_1), 0, np.cos(g_1))
        v = vector(np.sin(g_2) / 2, -np.sin(g_2) * np.sqrt(REAL(3)) / 2, -np.cos(g_2))
        zero = np.cross(u, v)
        return turn @ u, turn @ v, turn @ zero / np.sqrt(zero @ zero)

    def limb(self, x, k):
        """The axes u, w, v and the direction of the first link at 0."""
        u, v, zero = self.axes(k)
        v = rotation(0, x[0]) @ rotation(1, x[1]) @ rotation(2, x[2]) @ v
        n, c = np.cross(u, v), u @ v
        c_1, c_2 = np.cos(self.alpha[0]), np.cos(self.alpha[1])
        in_plane = ((c_1 - c * c_2) * u + (c_2 - c * c_1) * v) / (1 - c * c)
        height = np.sqrt((1 - in_plane @ in_plane) / (n @ n))
        return u, in_plane + height * n, v, zero

    def angles(self, x, k):
        """The angles of the first two joints."""
        u, w, v, zero = self.limb(x, k)
        q = np.arctan2(w @ np.cross(u, zero), w @ zero)
        before, after = np.cross(w, np.cross(w, u)), -np.cross(w, np.cross(w, v))  # directions of both links at w
        return q, np.arctan2(w @ np.cross(before, after), before @ after)

    def joints(self, x):
        return vector(*(self.angles(x, k)[0] for k in range(3)))

    def bodies(self, x):
        bodies = Bodies()
        nodes, weights = np.polynomial.legendre.leggauss(16)
        for k in range(3):
            u, w, v, _ = self.limb(x, k)
            for a, b, alpha, density in ((u, w, self.alpha[0], self.per_length[0]),
                                         (w, v, self.alpha[1], self.per_length[1])):
                for s, weight in zip((nodes + 1) / 2, weights / 2):
                    at = (np.sin((1 - s) * alpha) * a + np.sin(s * alpha) * b) / np.sin(alpha)
                    bodies.point(density * self.rho * alpha * weight, self.rho * at)
        bodies.point(REAL("0.5"), vector(0, 0, 0))
        R = rotation(0, x[0]) @ rotation(1, x[1]) @ rotation(2, x[2])
        bodies.solid(vector("2e-4", "2e-4", "3e-4"), R)
        return bodies


def voxels(robot, cells, largest):
    """Number of cells of the box +-60 deg with all q1 in +-60 deg and all q2 in +-`largest`, and the least margin."""
    bound, count, margins = 60 * DEGREE, 0, []
    centres = [-bound + (2 * i + 1) * bound / cells for i in range(cells)]
    for a in centres:
        for b in centres:
            for c in centres:
                angles = [robot.angles((a, b, c), k) for k in range(3)]
                all_margins = [m for q_1, q_2 in angles for m in (bound - abs(q_1), largest - abs(q_2))]
                margins.append(min(abs(m) for m in all_margins))
                count += min(all_margins) >= 0
    return {"cells": cells, "feasible": int(count), "least_margin": float(min(margins))}


def main():
    robot, random = AgileEye(), np.random.default_rng(1)
    cases = []
    for _ in range(8):
        x, v, a = (np.round(random.uniform(-s, s, 3), 4) for s in (0.6, 2, 10))
        found = case(robot, x, v, a)
        found["passive"] = [float(robot.angles(vector(*x), k)[1]) for k in range(3)]
        cases.append(found)
    data = {"agile-eye": cases, "voxels": voxels(robot, 10, 150 * DEGREE)}
    (HERE / "chains.json").write_text(json.dumps(data, indent=1) + "\n")


if __name__ == "__main__":
    main()
