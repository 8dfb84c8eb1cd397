"""Makes solved.toml and solved.json: limbs as chains without a closed form, and reference values of their joints.

    python3 solved.py

The joints are computed independently of the program: every chain is a product of matrix exponentials of its twists, with
three revolute joints in place of a spherical one, and all six equations are solved along a path from the reference
configuration to the pose.
"""

import json
import pathlib

import numpy as np
from scipy.linalg import expm

HERE = pathlib.Path(__file__).resolve().parent
REFERENCE = np.array([0, 0, 0.6])  # origin of the platform in the reference configuration
CHAINS = ["RRRRRR", "PRUC", "UPCR", "RRRS", "UPS", "SRU", "RSU", "CSP"]
AXES = {"R": 1, "P": 1, "C": 1, "U": 2, "S": 0}


def unit(v):
    return v / np.linalg.norm(v)


def hat(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def twist(kind, axis, point):
    xi = np.zeros((4, 4))
    if kind == "P":
        xi[:3, 3] = axis
    else:
        xi[:3, :3] = hat(axis)
        xi[:3, 3] = -np.cross(axis, point)
    return xi


def pose_matrix(pose):
    T = np.eye(4)
    for axis, angle in zip(np.eye(3), pose[3:]):
        T[:3, :3] = T[:3, :3] @ expm(hat(axis) * angle)
    T[:3, 3] = pose[:3]
    return T


class Limb:
    def __init__(self, name, chain, random):
        self.name, self.chain = name, chain
        self.base = np.round(random.uniform(-0.3, 0.3, 3) * [1, 1, 0.1], 3)
        self.platform = np.round(random.uniform(-0.15, 0.15, 3) * [1, 1, 0.2], 3)
        end = REFERENCE + self.platform
        inner = [self.base + (end - self.base) * k / (len(chain) - 1) + random.uniform(-0.2, 0.2, 3)
                 for k in range(1, len(chain) - 1)]
        points = [self.base, *(np.round(p, 3) for p in inner), end]
        self.links = [np.round(b - a, 3) for a, b in zip(points, points[1:])]
        self.axes = [np.round(random.uniform(-1, 1, 3), 2) for joint in chain for _ in range(AXES[joint])]
        self.driven = next(k for wanted in "PR" for k, joint in enumerate(chain) if joint == wanted)
        self.twists, self.names = [], []
        axes = iter(unit(a) for a in self.axes)
        for k, (joint, point) in enumerate(zip(chain, points)):
            name = f"q{k + 1}"
            if joint == "S":
                parts = [("R", e, None) for e in np.eye(3)]
            elif joint == "U":
                parts = [("R", next(axes), name + "_1"), ("R", next(axes), name + "_2")]
            elif joint == "C":
                axis = next(axes)
                parts = [("P", axis, name + "_1"), ("R", axis, name + "_2")]
            else:
                parts = [(joint, next(axes), name)]
            for kind, axis, of in parts:
                self.twists.append(twist(kind, axis, point))
                self.names.append(of)
        assert len(self.twists) == 6

    def is_regular(self):
        motions = [np.r_[xi[:3, 3] + xi[:3, :3] @ REFERENCE, 0.3 * xi[2, 1], 0.3 * xi[0, 2], 0.3 * xi[1, 0]]
                   for xi in self.twists]
        return np.linalg.svd(motions)[1][-1] > 0.05

    def error(self, q, wanted):
        T = np.eye(4)
        for xi, angle in zip(self.twists, q):
            T = T @ expm(xi * angle)
        M = np.eye(4)
        M[:3, 3] = REFERENCE
        E = wanted @ np.linalg.inv(T @ M)
        return np.array([*E[:3, 3], E[2, 1] - E[1, 2], E[0, 2] - E[2, 0], E[1, 0] - E[0, 1]])

    def solved(self, q, wanted):
        for _ in range(8):
            e, step = self.error(q, wanted), 1e-7
            J = np.array([(self.error(q + step * unit, wanted) - e) / step for unit in np.eye(6)]).T
            q = q - np.linalg.solve(J, e)
        return q

    def joints(self, pose):
        q, start = np.zeros(6), np.array([*REFERENCE, 0, 0, 0])
        for part in (0.5, 1):
            q = self.solved(q, pose_matrix(start + part * (pose - start)))
        assert np.abs(self.error(q, pose_matrix(pose))).max() < 3e-15, self.name
        return {name: float(x) for name, x in zip(self.names, q) if name}

    def toml(self):
        def text(v):
            return "[" + ", ".join(f"{x:g}" for x in v) + "]"

        joints = ", ".join(f'"{joint}"' for joint in self.chain)
        return (f'\n[[limb]]\nname     = "{self.name}"\ndrive    = "chain"\nchain    = [{joints}]\n'
                f"driven   = {self.driven + 1}\n"
                f"axes     = [{', '.join(text(a) for a in self.axes)}]\n"
                f"links    = [{', '.join(text(v) for v in self.links)}]\n"
                f"base     = {text(self.base)}\nplatform = {text(self.platform)}\n")


def main():
    random = np.random.default_rng(7)
    limbs = []
    for chain in CHAINS:
        limbs.append(Limb(chain.lower(), chain, random))
        while not limbs[-1].is_regular():
            limbs[-1] = Limb(chain.lower(), chain, random)
    text = ('# Made by solved.py\n[mechanism]\nname = "solved-chains"\n\n[parameters]\n'
            'unused = { default = 0, min = -1, max = 1, meaning = "of no effect" }\n\n[platform]\n'
            'coordinates = { x = "along x", y = "along y", z = "along z", alpha = "about x", beta = "about y", '
            'gamma = "about z" }\ncharacteristic_length = "100 mm"\n\n[survey]\n'
            "box = { x = [-0.1, 0.1], y = [-0.1, 0.1], z = [0.5, 0.7], alpha = [-0.2, 0.2], beta = [-0.2, 0.2], "
            "gamma = [-0.2, 0.2] }\n")
    (HERE / "solved.toml").write_text(text + "".join(limb.toml() for limb in limbs))
    cases = []
    for _ in range(8):
        pose = np.round([*REFERENCE, 0, 0, 0] + random.uniform(-1, 1, 6) * ([0.02] * 3 + [0.06] * 3), 4)
        cases.append({"pose": list(pose), "joints": {limb.name: limb.joints(pose) for limb in limbs}})
    (HERE / "solved.json").write_text(json.dumps(cases, indent=1) + "\n")


if __name__ == "__main__":
    main()
