#!/usr/bin/python3
"""Reference values of cable robots, computed by numpy and scipy alone, independently of pkmopt.

    tests/data/cables/references.py > tests/data/cables/references.json

CoGiRo: dimensions of Gagliardini, Caro, Gouttefarde et al. and Lamaury, Gouttefarde (T-RO 31(2), 2015, 501-510).
IPAnema 1: Pott et al. 2013. Straight massless cables: W t + w = 0, where the columns of W are (u; R b x u). The reserve
of a pose is the largest s with W t + w = 0 and t_min + s <= t <= t_max - s, a linear program (scipy.optimize.linprog,
HiGHS). Cables over pulleys: Pott, "Cable-Driven Parallel Robots", Springer, 2018. The poses are the additive recurrence
frac(1/2 + k g^-i), i = 1 to 6, g^7 = g + 1, k = 1, 2, .., in a box.
"""
import itertools
import json

import numpy as np
from scipy.optimize import brentq, linprog, minimize

GRAVITY = 9.81
ROBOTS = {
    "cogiro": {
        "anchors": [[-7.1775, -5.4361, 5.3911], [-7.4594, -5.1504, 5.3999], [-7.3911, 5.1940, 5.3976],
                    [-7.1026, 5.4753, 5.4094], [7.2398, 5.3759, 5.4093], [7.5208, 5.0851, 5.4200],
                    [7.4461, -5.2539, 5.3874], [7.1608, -5.5342, 5.3973]],
        "platform": [[.5032, -.4928, 0], [-.5097, .3508, .9976], [-.5032, -.2700, 0], [.4960, .3561, .9996],
                     [-.5032, .4928, 0], [.4998, -.3404, .9991], [.5021, .2750, -.0007], [-.5045, -.3463, .9976]],
        "mass": 91.058, "centre": [-.034, -.013, .264], "tension": [100, 5000]},
    "ipanema": {
        "anchors": [[x, y, z] for z in (2, 0) for x, y in ((-2, 1.5), (2, 1.5), (2, -1.5), (-2, -1.5))],
        "platform": [[x, y, 0] for _ in (2, 0) for x, y in ((-.06, .06), (.06, .06), (.06, -.06), (-.06, -.06))],
        "mass": 25, "centre": [0, 0, 0], "tension": [0, 720]},
}


def rotation(alpha, beta, gamma):
    ca, sa, cb, sb, cc, sc = np.cos(alpha), np.sin(alpha), np.cos(beta), np.sin(beta), np.cos(gamma), np.sin(gamma)
    about_x = np.array([[1, 0, 0], [0, ca, -sa], [0, sa, ca]])
    about_y = np.array([[cb, 0, sb], [0, 1, 0], [-sb, 0, cb]])
    about_z = np.array([[cc, -sc, 0], [sc, cc, 0], [0, 0, 1]])
    return about_x @ about_y @ about_z


def structure(robot, pose):
    """Lengths of the cables, structure matrix W about the platform's origin, and the weight w of the platform."""
    R, p = rotation(*pose[3:]), np.array(pose[:3])
    b = np.array(robot["platform"]) @ R.T
    cables = np.array(robot["anchors"]) - p - b
    lengths = np.linalg.norm(cables, axis=1)
    u = cables / lengths[:, None]
    weight = np.array([0, 0, -robot["mass"] * GRAVITY])
    return lengths, np.vstack([u.T, np.cross(b, u).T]), np.concatenate([weight, np.cross(R @ robot["centre"], weight)])


def over_pulley(anchor, axis, radius, B):
    """Length of a cable from its anchor over a pulley to B, and the unit vector of its free part towards the pulley:
    the root of the condition that the free part is tangential to the pulley, found numerically."""
    e, v = np.array(axis, float), np.array(B) - anchor
    across = v - e * (e @ v)
    across /= np.linalg.norm(across)
    centre = anchor + radius * across
    radial = lambda wrap: -np.cos(wrap) * across + np.sin(wrap) * e
    tangent = lambda wrap: np.sin(wrap) * across + np.cos(wrap) * e
    gap = lambda wrap: (B - centre) @ radial(wrap) - radius
    grid = np.linspace(0, 2 * np.pi, 400)
    for a, b in itertools.pairwise(grid):
        if gap(a) * gap(b) > 0:
            continue
        wrap = brentq(gap, a, b, xtol=1e-15, rtol=1e-15)
        free = (B - centre) @ tangent(wrap)
        if free > 0:
            return radius * wrap + free, free, -tangent(wrap)


def pulleys(robot):
    """IPAnema 1 with pulleys at all anchors, to which the cables come from below at the top, from above at the bottom."""
    out = {"radius": .05, "poses": [[.5, .3, 1.2, .05, -.1, .02], [-1.2, -.9, .4, -.1, .05, .3], [0, 0, 1, 0, 0, 0]],
           "lengths": [], "free": [], "jacobian": [], "reserve": []}
    for pose in out["poses"]:
        R, p = rotation(*pose[3:]), np.array(pose[:3])
        b = np.array(robot["platform"]) @ R.T
        found = [over_pulley(np.array(A, float), [0, 0, 1 if A[2] > 0 else -1], out["radius"], p + each)
                 for A, each in zip(robot["anchors"], b)]
        u = np.array([each for *_, each in found])
        W = np.vstack([u.T, np.cross(b, u).T])
        weight = np.array([0, 0, -robot["mass"] * GRAVITY])
        out["lengths"].append([length for length, *_ in found])
        out["free"].append([free for _, free, _ in found])
        # the platform's twist for unit rates of the coordinates
        twists = np.eye(6)
        twists[3:, 3:] = np.array([[1, 0, 0], rotation(pose[3], 0, 0)[:, 1], R[:, 2]]).T
        out["jacobian"].append((-W.T @ twists).tolist())
        out["reserve"].append(reserve(W, np.concatenate([weight, np.cross(R @ robot["centre"], weight)]),
                                      robot["tension"]))
    return out


def reserve(W, w, tension):
    n, m = W.shape
    t_min, t_max = tension
    A = np.block([[-np.eye(m), np.ones((m, 1))], [np.eye(m), np.ones((m, 1))]])
    b = np.concatenate([np.full(m, -t_min), np.full(m, t_max)])
    found = linprog(np.append(np.zeros(m), -1), A, b, np.hstack([W, np.zeros((n, 1))]), -w, bounds=[(None, None)] * (m + 1))
    return found.x[-1] if found.status == 0 else -np.inf


def tensions(W, w, tension):
    """Tensions of least norm, with the least maximum, and the analytic centre; within the limits."""
    m = W.shape[1]
    t_min, t_max = tension
    particular = -np.linalg.pinv(W) @ w
    basis = np.linalg.svd(W)[2][6:].T
    largest = linprog(np.append(np.zeros(m), 1), np.hstack([np.eye(m), -np.ones((m, 1))]), np.zeros(m),
                      np.hstack([W, np.zeros((6, 1))]), -w, bounds=[(t_min, t_max)] * m + [(0, None)]).x[-1]

    def least_norm(upper):
        limits = [{"type": "ineq", "fun": lambda x: (particular + basis @ x - t_min) / 100},
                  {"type": "ineq", "fun": lambda x: (upper - particular - basis @ x) / 100}]
        start = centre()
        x = minimize(lambda x: x @ x / 1e4, basis.T @ (start - particular), jac=lambda x: x / 5e3, constraints=limits,
                     method="SLSQP", options={"ftol": 1e-16, "maxiter": 500}).x
        return particular + basis @ x

    def centre():
        A = np.block([[-np.eye(m), np.ones((m, 1))], [np.eye(m), np.ones((m, 1))]])
        b = np.concatenate([np.full(m, -t_min), np.full(m, t_max)])
        t = linprog(np.append(np.zeros(m), -1), A, b, np.hstack([W, np.zeros((6, 1))]), -w,
                    bounds=[(None, None)] * (m + 1)).x[:m]
        for _ in range(200):
            gradient = basis.T @ (1 / (t - t_min) - 1 / (t_max - t))
            hessian = basis.T @ np.diag((t - t_min) ** -2.0 + (t_max - t) ** -2.0) @ basis
            step = np.linalg.solve(hessian, gradient)
            t = t + basis @ step / (1 + np.sqrt(max(0, gradient @ step)))
        return t

    return {"least-norm": least_norm(np.full(m, t_max)).tolist(), "largest": largest, "centre": centre().tolist()}


def poses(count, ranges):
    g = 1.1
    for _ in range(100):
        g = (1 + g) ** (1 / 7)
    for k in range(1, count + 1):
        yield [lo + (hi - lo) * ((0.5 + k * g ** -(i + 1)) % 1) for i, (lo, hi) in enumerate(ranges)]


def main():
    cogiro, ipanema = ROBOTS["cogiro"], ROBOTS["ipanema"]
    out = {"cogiro": {}, "ipanema": {}}
    lengths, W, w = structure(cogiro, [0, 0, 2, 0, 0, 0])
    out["cogiro"]["central"] = {"lengths": lengths.tolist(), "least_norm": (-np.linalg.pinv(W) @ w).tolist(),
                                "reserve": reserve(W, w, cogiro["tension"]), "tensions": tensions(W, w, cogiro["tension"])}
    ranges = [(-7, 7), (-5, 5), (0, 4), (-.3, .3), (-.3, .3), (-.5, .5)]
    values = [reserve(*structure(cogiro, pose)[1:], cogiro["tension"]) for pose in poses(10000, ranges)]
    out["cogiro"]["ranges"] = ranges
    out["cogiro"]["feasible"] = "".join("1" if s >= 0 else "0" for s in values)
    out["cogiro"]["nearest_to_0"] = min(map(abs, values))
    out["cogiro"]["reserves"] = [float(f"{s:.10g}") for s in values[::20]]
    # 0 to 300 kg at the origin, 50 N along x and y, 100 N along z and 20 N m about z in both directions
    box = []
    for pose in itertools.islice(poses(300, ranges), 300):
        _, W, w = structure(cogiro, pose)
        arm = rotation(*pose[3:]) @ cogiro["centre"]
        least = np.inf
        for mass, x, y, z, m in itertools.product((0, 300), (-50, 50), (-50, 50), (-100, 100), (-20, 20)):
            force = np.array([x, y, z])
            load = w + np.concatenate([force, np.cross(arm, force) + [0, 0, m]])
            load[2] -= mass * GRAVITY
            least = min(least, reserve(W, load, cogiro["tension"]))
        box.append(float(f"{least:.10g}"))
    out["cogiro"]["box_reserves"] = box

    lengths, W, w = structure(ipanema, [0, 0, 1, 0, 0, 0])
    out["ipanema"]["central"] = {"lengths": lengths.tolist(), "least_norm_without_limits": (-np.linalg.pinv(W) @ w).tolist(),
                                 "reserve": reserve(W, w, ipanema["tension"])}
    _, W, w = structure(ipanema, [.5, .3, 1.2, .05, -.1, .02])
    out["ipanema"]["tensions"] = tensions(W, w, ipanema["tension"])
    out["ipanema"]["reserve"] = reserve(W, w, ipanema["tension"])
    out["pulleys"] = pulleys(ipanema)
    print(json.dumps(out))


main()
