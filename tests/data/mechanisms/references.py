"""Makes the reference values of this folder, independently of the program.

    python3 references.py            # writes *.json beside this file, in a minute or two

Joints, verdicts and cells come from mechanism_file.py, areas and volumes from elsewhere: arcs of circles by Green's
theorem, sections of shells, closed forms.
"""

import itertools
import json
import math
import pathlib
import re

import numpy as np

from mechanism_file import Mechanism

HERE = pathlib.Path(__file__).resolve().parent


def arcs_area(annuli):
    """Area common to annuli (cx, cy, inner, outer), by Green's theorem over their arcs."""
    inside = lambda x, y, skip: all(i == skip or r0 - 1e-12 <= math.hypot(x - cx, y - cy) <= r1 + 1e-12
                                    for i, (cx, cy, r0, r1) in enumerate(annuli))
    circles = [(i, r, s) for i, (_, _, r0, r1) in enumerate(annuli) for r, s in ((r1, 1), (r0, -1)) if r > 0]
    area = 0.0
    for i, r, side in circles:
        cx, cy = annuli[i][:2]
        cuts = {0.0, 2 * math.pi}
        for j, other, _ in circles:
            dx, dy = annuli[j][0] - cx, annuli[j][1] - cy
            d = math.hypot(dx, dy)
            if i != j and d > 0 and abs(c := (d * d + r * r - other * other) / (2 * d * r)) < 1:
                cuts |= {(math.atan2(dy, dx) + t * math.acos(c)) % (2 * math.pi) for t in (1, -1)}
        for a, b in itertools.pairwise(sorted(cuts)):
            m = (a + b) / 2
            if inside(cx + r * math.cos(m), cy + r * math.sin(m), i):
                along_x, along_y = math.sin(b) - math.sin(a), math.cos(a) - math.cos(b)
                area += side * r / 2 * (r * (b - a) + cx * along_x + cy * along_y)
    return area


def integral(f, breaks, tolerance=1e-13):
    """Of f from the first to the last break: 16 Gauss nodes, halved until both halves agree with the whole."""
    x, w = np.polynomial.legendre.leggauss(16)

    def rule(a, b):
        return (b - a) / 2 * sum(weight * f((a + b) / 2 + (b - a) / 2 * t) for t, weight in zip(x, w))

    def part(a, b, whole, depth):
        m = (a + b) / 2
        left, right = rule(a, m), rule(m, b)
        if abs(left + right - whole) <= tolerance * (b - a) or depth == 0:
            return left + right
        return part(a, m, left, depth - 1) + part(m, b, right, depth - 1)

    edges = [a + (b - a) * k / 16 for a, b in itertools.pairwise(breaks) for k in range(16)] + [breaks[-1]]
    return sum(part(a, b, rule(a, b), 30) for a, b in itertools.pairwise(edges))


def poses(name, values, box, count, rng):
    """Poses, random in a box, in every working mode; joints that do not exist are null."""
    m, found = Mechanism(name, values), []
    for _ in range(count):
        pose = {n: round(float(rng.uniform(*box[n])), 4) for n in m.coordinates}
        for mode in m.modes():
            joints, _, exists, _ = m.evaluate(pose, mode)
            found.append({"parameters": values, "pose": pose, "mode": ",".join(mode.values()),
                          "joints": {n: float(q) if np.isfinite(q) else None for n, q in joints.items()},
                          "assembles": bool(exists), "feasible": bool(m.feasible(pose, mode))})
    return found


def voxels(name, values, cells, held=None, limits=None):
    m = Mechanism(name, values, limits)
    held = m.default_held(cells) | (held or {})
    feasible, box, tight = m.voxels(cells, held)
    return {"parameters": values, "limits": limits or {}, "held": held, "box": box, "cells": cells,
            "feasible": feasible, "least_margin": tight}


def exact(values, held, value, digits, how, limits=None, ranges=None):
    return {"parameters": values, "limits": limits or {}, "held": held, "box": ranges or {}, "value": value,
            "digits": digits, "how": how}


def rpr_area(m, phi):
    p, c, s = m.p, math.cos(phi), math.sin(phi)
    legs = [[p[f"{point}{i}{axis}"] for point in "AB" for axis in "xy"] for i in "123"]
    return arcs_area([(ax - c * bx + s * by, ay - s * bx - c * by, p["rmin"], p["rmax"]) for ax, ay, bx, by in legs])


def rrr_area(m, phi):
    p, angles = m.p, [2 * math.pi * k / 3 for k in range(3)]
    at = lambda f, t: p["R"] * f(t) - p["r"] * f(t + phi)
    reach = abs(p["l_a"] - p["l_b"]), p["l_a"] + p["l_b"]
    return arcs_area([(at(math.cos, t), at(math.sin, t), *reach) for t in angles])


def gough_volume(m, tilt, yaw):
    """Sections z = const of six shells; R = Rx(tilt) Rz(yaw)."""
    p, legs = m.p, []
    for k, side in itertools.product(range(3), (-1, 1)):
        base, joint = 2 * math.pi * k / 3 + side * p["a_b"], 2 * math.pi * k / 3 + side * p["a_p"] + yaw
        u, v = p["r"] * math.cos(joint), p["r"] * math.sin(joint)
        legs.append((p["R"] * math.cos(base) - u, p["R"] * math.sin(base) - math.cos(tilt) * v, math.sin(tilt) * v))
    rim = lambda l, h: math.sqrt(max(0.0, l * l - h * h))
    area = lambda z: arcs_area([(x, y, rim(p["l_min"], z + h), rim(p["l_max"], z + h)) for x, y, h in legs])
    tops = {l - h for _, _, h in legs for l in (p["l_min"], p["l_max"])}
    ends = [0.0, *sorted(z for z in tops if 0 < z < p["l_max"]), p["l_max"]]
    return integral(area, ends)


def linear_delta_volume(m):
    """Six times the sector where slide 1 is lowest and slide 2 highest, in polar coordinates."""
    p = m.p
    d, l, travel = p["R"] - p["r"], p["l"], p["q_max"] - p["q_min"]
    height = lambda r, t: math.sqrt(max(0.0, l * l - r * r - d * d + 2 * r * d * math.cos(t)))

    def ray(t):
        end = d * math.cos(t) + math.sqrt(l * l - (d * math.sin(t)) ** 2)

        def inner(s):                          # r = end - s^2: slide 1's height ends like a root
            r = end - s * s
            return 2 * s * r * (travel - height(r, t - 2 * math.pi / 3) + height(r, t))

        return integral(inner, [0.0, math.sqrt(end)])

    return 6 * integral(ray, [2 * math.pi / 3, math.pi])


def main():
    rng = np.random.default_rng(1)
    second_rpr = {"A2x": 1.1, "rmin": 0.25, "rmax": 0.7}
    second_rrr = {"R": 0.35, "r": 0.1, "l_a": 0.15, "l_b": 0.3}
    second_bar = {"d": 0.2, "l_a": 0.2, "l_b": 0.4}
    deltas = [({"R": 0.15, "r": 0.05, "l_a": 0.2, "l_b": 0.45, "q_min": -0.6, "q_max": 1.2}, 0.0379918536),
              ({"R": 0.13, "r": 0.05, "l_a": 0.25, "l_b": 0.5, "q_min": -0.5, "q_max": 1.0}, 0.0426343559)]
    gough_2 = {"r": 0.5, "l_min": 1.15, "l_max": 1.75}
    wide = {"q_min": -4.0, "q_max": 8.0}
    arcs, M = "arcs of circles by Green's theorem", Mechanism
    box = lambda x, y, **more: {"x": x, "y": y} | more
    L = M("orthoglide").p["L"]
    made = {}
    made["3-rpr"] = {
        "poses": poses("3-rpr", {}, box((0.2, 0.8), (0, 0.6), phi=(-0.6, 0.8)), 8, rng),
        "voxels": [voxels("3-rpr", v, {"x": 40, "y": 36, "phi": 24}) for v in ({}, second_rpr)],
        "exact": [exact(v, {"phi": 0.2}, rpr_area(M("3-rpr", v), 0.2), 14, arcs) for v in ({}, second_rpr)] +
                 [exact(v, {}, integral(lambda t: rpr_area(M("3-rpr", v), t), [-0.5, 0.7]), 12,
                        arcs + ", Gauss over phi") for v in ({}, second_rpr)]}
    made["3-rrr"] = {
        "poses": poses("3-rrr", {}, box((-0.2, 0.2), (-0.2, 0.2), phi=(-1, 1)), 4, rng),
        "voxels": [voxels("3-rrr", v, {"x": 57, "y": 52}, {"phi": t}) for v in ({}, second_rrr) for t in (0, 0.3)],
        "exact": [exact(v, {"phi": t}, rrr_area(M("3-rrr", v), t), 14, arcs)
                  for v in ({}, second_rrr) for t in (0, 0.3)]}
    made["five-bar"] = {
        "poses": poses("five-bar", {}, box((-0.5, 0.5), (0, 0.6)), 6, rng),
        "voxels": [voxels("five-bar", v, {"x": 60, "y": 50}) for v in ({}, second_bar)],
        "exact": [exact(v, {}, arcs_area([(s * p["d"], 0, abs(p["l_a"] - p["l_b"]), p["l_a"] + p["l_b"])
                                          for s in (-1, 1)]) / 2, 14, arcs + ", half of two annuli")
                  for v in ({}, second_bar) for p in (M("five-bar", v).p,)]}
    made["rotary-delta"] = {
        "poses": poses("rotary-delta", {}, box((-0.3, 0.3), (-0.3, 0.3), z=(-0.6, -0.3)), 6, rng),
        "voxels": [voxels("rotary-delta", v, {"x": 40, "y": 40, "z": 40}, None, {"clear_z": 0.02})
                   for v in ({}, deltas[0][0], deltas[1][0])],
        "exact": [exact(v, {}, volume, 7, "columns isolated by intervals, in two orders of the coordinates",
                        {"clear_z": 0.02}) for v, volume in deltas]}
    made["linear-delta"] = {
        "poses": poses("linear-delta", {}, box((-0.3, 0.3), (-0.3, 0.3), z=(-0.5, 0.2)), 5, rng),
        "voxels": [voxels("linear-delta", v, {"x": 40, "y": 40, "z": 40}) for v in ({}, {"R": 0.25, "l": 0.4})],
        "exact": [exact(v, {}, linear_delta_volume(M("linear-delta", v)), 12, "sectors in polar coordinates")
                  for v in ({}, {"R": 0.25, "l": 0.4})]}
    made["orthoglide"] = {
        "poses": poses("orthoglide", {}, box((-0.2, 0.2), (-0.2, 0.2), z=(-0.2, 0.2)), 5, rng),
        "voxels": [voxels("orthoglide", v, {"x": 40, "y": 40, "z": 40}) for v in ({}, wide)],
        "exact": [exact(wide, {}, 8 * (2 - math.sqrt(2)) * L**3, 14, "three cylinders: 8 (2 - sqrt 2) L^3")],
        "conditioning": [{"pose": dict.fromkeys("xyz", at), "value": value, "how": how} for at, value, how in (
            (0.0, 1.0, "isotropic where the rods lie along the axes"),
            (-L / math.sqrt(6), 0.25, "the cube's corner t = 1/2 of J = I + t (ones - I): singular values 2, 1/2, 1/2"),
            (L / math.sqrt(18), 0.4, "the opposite corner, t = -1/4: 1/2, 5/4, 5/4"))],
        "published": {"cube": 0.2, "rod": 0.310, "travel": 0.257,
                      "rod_of_cube": 0.2 / (1 / math.sqrt(6) + 1 / math.sqrt(18)),
                      "travel_over_rod": 1 + 1 / math.sqrt(18) - (math.sqrt(2 / 3) - 1 / math.sqrt(6))}}
    made["gough"] = {
        "poses": poses("gough", {}, box((-0.3, 0.3), (-0.3, 0.3), z=(0.9, 1.5), alpha=(-0.3, 0.3), beta=(-0.3, 0.3),
                                        gamma=(-0.5, 0.5)), 12, rng),
        "voxels": [voxels("gough", v, {"x": 40, "y": 40, "z": 40}, t) for v, t in (
            ({}, {"alpha": 0.15, "gamma": 0.1}), (gough_2, {"alpha": 0.07, "gamma": -0.2}),
            ({}, {"beta": 0.2, "alpha": 0.1}), ({"tilt": 0.6}, {"alpha": 0.15, "gamma": 0.1}))],
        "exact": [exact(v, {"alpha": t, "beta": 0.0, "gamma": y}, gough_volume(M("gough", v), t, y), 12,
                        "sections of six shells, " + arcs) for v, t, y in (({}, 0.15, 0.1), (gough_2, 0.07, -0.2))]}
    made["par4"] = {
        "poses": poses("par4", {}, box((-0.3, 0.3), (-0.3, 0.3), z=(-0.8, -0.5), phi=(-1, 1)), 4, rng),
        "voxels": [voxels("par4", {}, {"x": 40, "y": 40, "z": 40}, {"phi": t}) for t in (0, 0.5)] +
                  [voxels("par4", {}, {"x": 24, "y": 24, "phi": 24}, {"z": -0.7})]}
    for name, content in made.items():
        text = json.dumps({"file": f"{name}.toml"} | content, indent=1)
        text = re.sub(r"\{[^{}]*\}", lambda t: re.sub(r"\s*\n\s*", " ", t[0]), text)
        (HERE / f"{name}.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
