"""A small evaluator of mechanism files (joints, margins, voxels), independent of the program.

It knows what the files of experiments/mechanisms use, without links and masses. Needs Python 3.11 and numpy.
"""

import itertools
import math
import pathlib
import re
import tomllib

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
FILES = HERE.parents[2] / "experiments" / "mechanisms"
UNITS = {"m": 1, "mm": 1e-3, "rad": 1, "deg": math.pi / 180}
NAMES = {n: getattr(np, n) for n in "sin cos tan sinh cosh tanh exp log log10 sqrt abs sign pi".split()}
NAMES |= {"asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2, "where": np.where,
          "min": lambda *a: np.minimum.reduce(np.broadcast_arrays(*a)),
          "max": lambda *a: np.maximum.reduce(np.broadcast_arrays(*a))}
AXES = {"x": 0, "y": 1, "z": 2}


def quantity(value):
    if not isinstance(value, str):
        return float(value)
    number, _, unit = value.partition(" ")
    return float(number) * UNITS.get(unit, 1)


def formula(text, names):
    """Value of a formula, or of a number."""
    if not isinstance(text, str):
        return float(text)
    code = re.sub(r"\(([^()?]*)\?([^:]*):([^()]*)\)", r"where(\1,\2,\3)", text)
    return eval(code.replace("^", "**"), {"__builtins__": {}}, NAMES | names)


def turn(axis, angle):
    """Columns of the rotation about x, y or z."""
    c, s, i = np.cos(angle), np.sin(angle), AXES[axis]
    R = [[1.0 if a == b else 0.0 for b in range(3)] for a in range(3)]
    j, k = (i + 1) % 3, (i + 2) % 3
    R[j][j], R[j][k], R[k][j], R[k][k] = c, -s, s, c
    return R


def times(R, v):
    return [sum(R[i][k] * v[k] for k in range(3)) for i in range(3)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    return [x / math.sqrt(dot(v, v)) for x in v]


class Mechanism:
    """A file, with parameters and limits set by name."""

    def __init__(self, name, values=None, limits=None):
        self.file = tomllib.loads((FILES / f"{name}.toml").read_text())
        self.p = {n: quantity(s["default"]) for n, s in self.file["parameters"].items()} | (values or {})
        self.p |= {l["name"]: quantity(l["inactive"]) for l in self.file.get("limit", []) if "inactive" in l}
        self.p |= limits or {}
        self.coordinates = self.file["platform"]["coordinates"]

    def modes(self):
        """All combinations of branches and signs, the default one first."""
        signs = [(l["name"] + (str(k) if "copies" in l else ""), l["branch"]) for l in self.file["limb"]
                 if "branch" in l for k in range(1, l.get("copies", {"number": 1})["number"] + 1)]
        choices = [(n, "+-" if b == "+" else "-+") for n, b in signs]
        choices += [(n, "".join(c)) for n, c in self.file.get("modes", {}).items()]
        return [{n: s for (n, _), s in zip(choices, m)} for m in itertools.product(*(c for _, c in choices))]

    def evaluate(self, pose, mode=None):
        """(joints, margins, assembles, names) at a pose of numbers or arrays."""
        mode = mode or self.modes()[0]
        sign = {n: 1.0 if s == "+" else -1.0 for n, s in mode.items()}
        names = self.p | pose | {n: s for n, s in sign.items() if n in self.file.get("modes", {})}
        R = [[1.0 if a == b else 0.0 for b in range(3)] for a in range(3)]
        origin = [0.0, 0.0, 0.0]
        for n, meaning in self.coordinates.items():
            kind, axis = meaning.split()
            if kind == "along":
                origin[AXES[axis]] = pose[n]
            else:
                T = turn(axis, pose[n])
                R = [[sum(R[i][k] * T[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
        with np.errstate(invalid="ignore"):
            values = []
            for n, text in self.file.get("let", {}).items():
                names[n] = formula(text, names)
                values.append(names[n])
            joints, margins = {}, {}
            for limb in self.file["limb"]:
                for k in range(limb.get("copies", {"number": 1})["number"]):
                    self.limb(limb, k, names, sign, R, origin, joints, margins)
            names |= joints
            for m in self.file.get("margin", []):
                margins[m["name"]] = formula(m["formula"], names)
        values += joints.values()
        exists = np.logical_and.reduce(np.broadcast_arrays(*(np.isfinite(v) for v in values)))
        return joints, margins, exists, names

    def limb(self, limb, k, names, sign, R, origin, joints, margins):
        copies = limb.get("copies")
        name = limb["name"] + (str(k + 1) if copies else "")
        about = turn(copies["about"], 2 * math.pi * k / copies["number"]) if copies else turn("x", 0.0)
        ranges = [formula(t, names) for t in limb["range"]] if "range" in limb else None
        if limb["drive"] == "formula":
            found = {n: formula(t, names) for n, t in limb["joints"].items()}
        else:
            vector = lambda key: times(about, [formula(t, names) for t in limb[key]])
            A = vector("base")
            B = ([formula(t, names) for t in limb["end"]] if "end" in limb else
                 [o + x for o, x in zip(origin, times(R, vector("platform")))])
            v = [b - a for a, b in zip(A, B)]
            if "across" in limb:
                n = unit(vector("across"))
                v = [x - dot(v, n) * y for x, y in zip(v, n)]
            s, v2 = sign.get(name), dot(v, v)
            if limb["drive"] == "telescope":
                q = np.sqrt(v2)
            elif "links" in limb:
                e = unit(vector("along"))
                q = dot(v, e)
                l1, l2 = (formula(t, names) for t in limb["links"])
                d = np.sqrt(v2 - q * q)
                margins[name + " reaches"] = np.minimum(l1 + l2 - d, d - abs(l1 - l2))
            elif limb["drive"] == "slider":
                along, rod = dot(v, unit(vector("direction"))), formula(limb["rod"], names)
                margins[name + " reaches"] = rod**2 - (v2 - along**2)
                q = along + s * np.sqrt(margins[name + " reaches"])
            elif limb["drive"] == "crank":
                axis, zero = unit(vector("axis")), unit(vector("zero"))
                a, b = formula(limb["crank"], names), formula(limb["rod"], names)
                u, w = dot(v, zero), dot(v, cross(axis, zero))
                k = (v2 + a * a - b * b) / (2 * a * np.hypot(u, w))
                margins[name + " reaches"] = 1 - np.abs(k)
                q = np.arctan2(w, u) + s * np.arccos(k)
                middle = sum(ranges) / 2 if ranges else 0.0
                q = q - 2 * math.pi * np.round((q - middle) / (2 * math.pi))
            if "joint_base" in limb:
                part = limb["joint_base"]
                lean = np.arccos(dot(v, unit(times(about, part["axis"]))) / np.sqrt(v2))
                margins[name + " joint_base"] = formula(part["max"], names) - lean
            number = str(k + 1) if copies else ""
            found = {limb["joint_name"] + number if "joint_name" in limb else name: q}
        for n, q in found.items():
            joints[n] = q
            if ranges:
                margins[n + " range"] = np.minimum(q - ranges[0], ranges[1] - q)

    def feasible(self, pose, mode=None):
        _, margins, exists, _ = self.evaluate(pose, mode)
        ok = exists
        for m in margins.values():
            with np.errstate(invalid="ignore"):
                ok = ok & (m >= 0)
        return ok

    def voxels(self, cells, held, box=None, mode=None):
        """Number of feasible cells, the box, and the least |margin| of any cell: counts are safe above rounding."""
        spans = {n: [float(formula(t, self.p)) for t in self.file["survey"]["box"][n]] for n in cells} | (box or {})
        at = {n: lo + (hi - lo) * (np.arange(cells[n]) + 0.5) / cells[n] for n, (lo, hi) in spans.items()}
        pose = {n: float(v) for n, v in held.items()} | dict(zip(at, np.meshgrid(*at.values(), indexing="ij")))
        _, margins, exists, _ = self.evaluate(pose, mode)
        tight = min(float(np.nanmin(np.abs(m))) for m in margins.values()) if margins else math.inf
        return int(np.count_nonzero(self.feasible(pose, mode))), spans, tight

    def default_held(self, swept):
        fixed = self.file["survey"].get("fixed", {})
        return {n: float(formula(fixed.get(n, 0), self.p)) for n in self.coordinates if n not in swept}
