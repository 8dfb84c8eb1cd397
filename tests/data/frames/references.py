"""Makes frames.json, reference values for experiments/mechanisms/frames, independently of the program.

    python3 references.py

The geometry is written down here for each robot; the mechanism files are not read. The parasitic motion of the 3-PRS is
solved by Newton's method from the condition that every leg stays in its plane. Derivatives are central differences of
order 6 in extended precision, and drive forces follow from Lagrange's equations: d/dt dT/dv - dT/dx + dV/dx = J^T tau.
"""

import json
import pathlib

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
REAL = np.longdouble
GRAVITY = REAL("9.81")
STEP = REAL(1) / 1024


def vector(*elements):
    return np.array(elements, dtype=REAL)


def difference(f):
    """Derivative of f at 0."""
    h = STEP
    return sum(w * (f(k * h) - f(-k * h)) for k, w in ((1, 45), (2, -9), (3, 1))) / (60 * h)


def rotation(axis, angle):
    """Rotation about x, y or z."""
    R, i, j = np.eye(3, dtype=REAL), (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = np.cos(angle)
    R[i, j], R[j, i] = -np.sin(angle), np.sin(angle)
    return R


def solve(A, b):
    """Gauss-Jordan elimination in extended precision, which numpy.linalg does not have."""
    A, b = A.copy(), b.copy()
    for k in range(len(A)):
        p = k + int(np.argmax(abs(A[k:, k])))
        A[[k, p]], b[[k, p]] = A[[p, k]], b[[p, k]]
        b[k], A[k] = b[k] / A[k, k], A[k] / A[k, k]
        for i in range(len(A)):
            if i != k:
                b[i], A[i] = b[i] - A[i, k] * b[k], A[i] - A[i, k] * A[k]
    return b


class Bodies:
    """Positions of the masses at a pose: point masses, rods without spin, and rigid bodies."""

    def __init__(self):
        self.points, self.lines, self.solids = [], [], []

    def point(self, mass, at):
        self.points.append((mass, at))

    def rod(self, mass, inertia, start, end):
        """A thin body; `inertia` about an axis through its centre and normal to it."""
        self.point(mass, (start + end) / 2)
        self.lines.append((inertia, end - start))

    def solid(self, inertia, R):
        self.solids.append((inertia, R))


def positions(bodies):
    parts = [p for _, p in bodies.points] + [d for _, d in bodies.lines] + [R.ravel() for _, R in bodies.solids]
    return np.concatenate(parts)


def inertia_matrix(robot, x):
    n, at = len(x), robot.bodies(x)
    D = np.stack([difference(lambda s: positions(robot.bodies(x + s * e))) for e in np.eye(n, dtype=REAL)])
    M, k = np.zeros((n, n), dtype=REAL), 0
    for mass, _ in at.points:
        M += mass * D[:, k:k + 3] @ D[:, k:k + 3].T
        k += 3
    for inertia, d in at.lines:
        W = np.cross(d, D[:, k:k + 3]) / (d @ d)
        M += inertia * W @ W.T
        k += 3
    for inertia, R in at.solids:
        spin = [D[i, k:k + 9].reshape(3, 3) @ R.T for i in range(n)]
        W = np.stack([R.T @ vector(S[2, 1], S[0, 2], S[1, 0]) for S in spin])  # along the axes of the body
        M += W * inertia @ W.T
        k += 9
    return M


def case(robot, x, v, a):
    x, v, a = (vector(*u) for u in (x, v, a))
    unit = np.eye(len(x), dtype=REAL)
    J = np.stack([difference(lambda s: robot.joints(x + s * e)) for e in unit], axis=1)
    potential = lambda y: GRAVITY * sum(mass * p[2] for mass, p in robot.bodies(y).points)
    momentum = lambda t: inertia_matrix(robot, x + t * v + t * t / 2 * a) @ (v + t * a)
    energy = lambda y: v @ inertia_matrix(robot, y) @ v / 2
    force = difference(momentum) + vector(
        *(difference(lambda s: potential(x + s * e) - energy(x + s * e)) for e in unit))
    number = lambda array: np.asarray(array, dtype=float).tolist()
    found = {"pose": number(x), "velocity": number(v), "acceleration": number(a), "joints": number(robot.joints(x)),
             "J": number(J), "M": number(inertia_matrix(robot, x)), "forces": number(solve(J.T, force))}
    return found | ({"dependent": number(robot.dependent(x))} if hasattr(robot, "dependent") else {})


def crank(A, zero, down, l_a, l_b, B, sign, centre):
    """Angle of a crank at A with a rod to B, and the crank's end. At 0 it points along `zero`, at pi/2 along `down`."""
    v = B - A
    u, w = v @ zero, v @ down
    k = (v @ v + l_a**2 - l_b**2) / (2 * l_a)
    q = np.arctan2(w, u) + sign * np.arccos(k / np.hypot(u, w))
    q -= 2 * np.pi * np.round((q - centre) / (2 * np.pi))
    return q, A + l_a * (np.cos(q) * zero + np.sin(q) * down)


class Prs:
    """3-PRS; coordinates z, alpha, beta."""

    R, r, L = REAL("0.25"), REAL("0.2"), REAL("0.3")
    angles = [2 * k * np.arccos(REAL(-1)) / 3 for k in range(3)]
    known = None  # the last pose with its parasitic motion

    def platform(self, x, dependent):
        x_p, y_p, gamma = dependent
        return vector(x_p, y_p, x[0]), rotation(0, x[1]) @ rotation(1, x[2]) @ rotation(2, gamma)

    def ends(self, x, dependent):
        p, R = self.platform(x, dependent)
        return [p + R @ vector(self.r * np.cos(t), self.r * np.sin(t), 0) for t in self.angles]

    def dependent(self, x):
        def offsets(y):
            return vector(*(B @ vector(-np.sin(t), np.cos(t), 0) for t, B in zip(self.angles, self.ends(x, y))))

        if self.known and np.array_equal(self.known[0], x):
            return self.known[1]
        y, h = vector(0, 0, 0), STEP
        for _ in range(6):
            slopes = np.stack([(offsets(y + h * e) - offsets(y - h * e)) / (2 * h) for e in np.eye(3, dtype=REAL)], 1)
            y = y - solve(slopes, offsets(y))
        assert max(abs(offsets(y))) < 1e-18
        self.known = x, y
        return y

    def slides(self, x):
        found = []
        for t, B in zip(self.angles, self.ends(x, self.dependent(x))):
            gap = self.R - B @ vector(np.cos(t), np.sin(t), 0)
            found.append((vector(self.R * np.cos(t), self.R * np.sin(t), B[2] + np.sqrt(self.L**2 - gap**2)), B))
        return found

    def joints(self, x):
        return vector(*(S[2] for S, _ in self.slides(x)))

    def bodies(self, x):
        all = Bodies()
        p, R = self.platform(x, self.dependent(x))
        all.point(REAL(5), p)
        all.solid(5 * self.r**2 * vector(REAL("0.25"), REAL("0.25"), REAL("0.5")), R)
        mass = 2 * self.L
        for S, B in self.slides(x):
            all.point(REAL(2), S)
            all.rod(mass, mass * self.L**2 / 12, S, B)
        return all


class Cranks:
    """Robots whose platform is carried by cranks with rods; coordinates x, y, z and a rotation about z."""

    def legs(self, x):
        found = []
        for t, B in self.ends(x):
            zero = vector(np.cos(t), np.sin(t), 0)
            q, C = crank(self.R * zero, zero, vector(0, 0, -1), self.l_a, self.l_b, B, -1, self.centre)
            found.append((q, self.R * zero, C, B))
        return found

    def add_legs(self, all, x, mass, inertia, per_length):
        for _, A, C, B in self.legs(x):
            all.rod(mass, inertia, A, C)
            rod = per_length * self.l_b
            all.rod(rod, rod * self.l_b**2 / 12, C, B)


DEGREE = np.arccos(REAL(-1)) / 180


class Delta(Cranks):
    """Delta with a shaft that rotates the tool relative to the carrier."""

    R, r, l_a, l_b = REAL("0.2"), REAL("0.05"), REAL("0.235"), REAL("0.56")
    centre = (-40 + 95) / 2 * DEGREE

    def ends(self, x):
        return [(120 * k * DEGREE, x[:3] + self.r * vector(np.cos(120 * k * DEGREE), np.sin(120 * k * DEGREE), 0))
                for k in range(3)]

    def joints(self, x):
        return vector(*(leg[0] for leg in self.legs(x)), x[3])

    def bodies(self, x):
        all = Bodies()
        all.point(REAL("0.3"), x[:3])
        all.solid(vector(0, 0, REAL("1e-4")), rotation(2, x[3]))
        mass = REAL("0.4")
        self.add_legs(all, x, mass, mass * self.l_a**2 / 12, REAL("0.12"))
        return all


class H4(Cranks):
    """H4: the crossbar of an H rotates, the two other bars do not."""

    R, l_a, l_b, h, w = (REAL(t) for t in ("0.25", "0.3", "0.7", "0.06", "0.06"))
    centre = (-50 + 95) / 2 * DEGREE

    def bars(self, x):
        along = self.h * vector(np.cos(x[3]), np.sin(x[3]), 0)
        return x[:3] + along, x[:3] - along

    def ends(self, x):
        first, second = self.bars(x)
        w = vector(0, self.w, 0)
        return list(zip((t * DEGREE for t in (45, 135, 225, 315)), (first + w, second + w, second - w, first - w)))

    def joints(self, x):
        return vector(*(leg[0] for leg in self.legs(x)))

    def bodies(self, x):
        all = Bodies()
        inertia = REAL("0.4") * (2 * self.h)**2 / 12
        all.point(REAL("0.4"), x[:3])
        all.solid(vector(0, inertia, inertia), rotation(2, x[3]))
        for bar in self.bars(x):
            all.point(REAL("0.15"), bar)
        outer, inner = REAL("0.04"), REAL("0.034")
        mass = 2700 * self.l_a * np.arccos(REAL(-1)) / 4 * (outer**2 - inner**2)
        self.add_legs(all, x, mass, mass * (self.l_a**2 / 12 + (outer**2 + inner**2) / 16), REAL("0.15"))
        return all


def main():
    rng = np.random.default_rng(1)
    robots = {"3-prs": (Prs(), [(-0.25, 0), (-0.6, 0.6), (-0.6, 0.6)]),
              "delta-with-shaft": (Delta(), [(-0.2, 0.2), (-0.2, 0.2), (-0.55, -0.4), (-3, 3)]),
              "h4": (H4(), [(-0.25, 0.25), (-0.25, 0.25), (-0.75, -0.5), (-0.9, 0.9)])}
    made = {}
    for name, (robot, box) in robots.items():
        made[name] = []
        for _ in range(8):
            x, v, a = (np.round([rng.uniform(*side) for side in sides], 4)
                       for sides in (box, [(-1.5, 1.5)] * len(box), [(-8, 8)] * len(box)))
            made[name].append(case(robot, x, v, a))
    text = ",\n".join(f' "{name}": [\n  ' + ",\n  ".join(map(json.dumps, cases)) + "]" for name, cases in made.items())
    (HERE / "frames.json").write_text("{\n" + text + "\n}\n")


if __name__ == "__main__":
    main()
