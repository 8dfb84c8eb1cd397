#!/usr/bin/python3
"""Refutation test of `pkmopt tolerances`.

tolerances.py PROGRAM [--robots N] [--poses N] [--seed S]

For a five-bar and a rotary Delta, with common parameters and with parameters of each limb, `pkmopt tolerances`
certifies the tolerances of a box of poses. Random robots within the tolerances, half of them at vertices, are evaluated
at random poses and at the vertices of the box, by formulas in this file that share no code with pkmopt. The campaign
fails if a robot violates a constraint or if a determinant of its Jacobians does not have the sign that it has for the
design. It also fails if the robot that pkmopt prints as a violation does none according to these formulas, or if the
certified tolerances are more than 40 % smaller than those of this robot.
"""

import argparse
import json
import os
import subprocess
import sys
import time

import numpy as np

MECHANISMS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "experiments", "mechanisms")


def crank_and_rod(u, w, square, crank, rod, branch):
    """Angle of a crank and cosine of the angle from the direction (u, w) of the rod's end; NaN: not assembled."""
    cosine = (square + crank**2 - rod**2) / (2 * crank * np.hypot(u, w))
    with np.errstate(invalid="ignore"):
        return np.arctan2(w, u) + branch * np.arccos(cosine), cosine


def five_bar(value, x, y):
    """Reserves, each > 0 if its constraint is satisfied, and det G."""
    reserves, rods = [y], []
    for limb, side, branch in (("left", -1, 1), ("right", 1, -1)):
        u, crank = x - side * value(limb, "d"), value(limb, "l_a")
        q, cosine = crank_and_rod(u, y, u**2 + y**2, crank, value(limb, "l_b"), branch)
        reserves.append(1 - np.abs(cosine))
        rods.append((u - crank * np.cos(q), y - crank * np.sin(q)))
    return reserves, rods[0][0] * rods[1][1] - rods[0][1] * rods[1][0]


def rotary_delta(value, x, y, z):
    reserves, rods = [-z], []
    for i in range(3):
        limb, angle = f"arm{i + 1}", 2 * np.pi / 3 * i
        c, s = np.cos(angle), np.sin(angle)
        u, v, w = c * x + s * y + value(limb, "r") - value(limb, "R"), c * y - s * x, -z
        crank = value(limb, "l_a")
        q, cosine = crank_and_rod(u, w, u**2 + v**2 + z**2, crank, value(limb, "l_b"), -1)
        q = (q + np.pi) % (2 * np.pi) - np.pi
        reserves += [1 - np.abs(cosine), q - value(limb, "q_min"), value(limb, "q_max") - q]
        along, down = u - crank * np.cos(q), z + crank * np.sin(q)
        rods.append((c * along - s * v, s * along + c * v, down))
    (a, b, d), (e, f, g), (h, i, j) = rods
    return reserves, a * (f * j - g * i) - b * (e * j - g * h) + d * (e * i - f * h)


ROBOTS = {
    "five-bar": (five_bar, {"x": (-0.05, 0.05), "y": (0.3, 0.4)}),
    "rotary-delta": (rotary_delta, {"x": (-0.1, 0.1), "y": (-0.1, 0.1), "z": (-0.55, -0.4)}),
}


def lookup(parameters):
    """value(limb, name): the parameter of the limb, otherwise the common one."""
    return lambda limb, name: parameters.get(f"{limb}.{name}", parameters.get(name))


def certified(program, name, box, arguments):
    ranges = ",".join(f"{axis}={low}:{high}" for axis, (low, high) in box.items())
    command = [program, "tolerances", os.path.join(MECHANISMS, name + ".toml"), "--box=" + ranges, "--json", *arguments]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def count_failures(formulas, box, found, sign, robots, poses, random):
    """Number of pairs of a robot and a pose at which a constraint or a determinant's sign is violated."""
    failures = 0
    vertices = np.array(np.meshgrid(*box.values())).reshape(len(box), -1).T
    low, high = np.array(list(box.values())).T
    for first in range(0, robots, 1000):
        count = min(1000, robots - first)
        parameters = dict(found["parameters"])
        at_vertex = random.random((count, 1)) < 0.5
        for name, tolerance in found["certified"].items():
            inside = random.uniform(-1, 1, (count, 1))
            parameters[name] = parameters[name] + tolerance * np.where(at_vertex, np.sign(inside), inside)
        points = np.vstack([vertices, random.uniform(low, high, (poses - len(vertices), len(box)))])
        reserves, det = formulas(lookup(parameters), *(points[:, i] for i in range(len(box))))
        good = det * sign > 0
        for reserve in reserves:
            good = good & (reserve > 0)
        failures += good.size - np.count_nonzero(good)
    return failures


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("program")
    options.add_argument("--robots", type=int, default=1000)
    options.add_argument("--poses", type=int, default=100)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    random = np.random.default_rng(given.seed)
    wrong = 0
    for name, (formulas, box) in ROBOTS.items():
        for arguments in ([], ["--copies"], ["--free"]):
            start = time.monotonic()
            found = certified(given.program, name, box, arguments)
            seconds = time.monotonic() - start
            middle = [sum(ends) / 2 for ends in box.values()]
            sign = np.sign(formulas(lookup(found["parameters"]), *middle)[1])
            failures = count_failures(formulas, box, found, sign, given.robots, given.poses, random)
            violation = found["violation"]
            reserves, det = formulas(lookup(violation["parameters"]), *violation["pose"].values())
            reserve = np.nanmin([*reserves, det * sign]) if not np.isnan([*reserves, det]).any() else -np.inf
            share = min(found["certified"][p] / t for p, t in violation["tolerance"].items())
            print(f"{name} {' '.join(arguments)}: certified / violation {share:.4f}, {found['boxes']} boxes, "
                  f"{seconds:.1f} s, {given.robots} robots x {given.poses} poses: {failures} refuted; "
                  f"robot of the violation: {reserve:.2g}")
            wrong += failures > 0 or share < 0.6 or reserve > 1e-6
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
