"""What the Python peers evaluate: designs of one problem, counted until one is as good as asked for."""

import json
import math
from types import SimpleNamespace

import numpy as np


class Reached(Exception):
    """A feasible design within the target is known: the search is over."""


class Exhausted(Exception):
    """As many candidates as allowed have been tried."""


class Trials:
    """Candidates of one search. An optimiser asks for the margins of each candidate once, then for its ratio."""

    def __init__(self, problem, count, limit=math.inf, target=math.inf):
        self.problem, self.limit, self.target = problem, limit, target
        self._count, self._cells = count, math.prod(problem.cells)
        self.made, self.best = 0, 0.0

    def margins(self, design):
        """Counts a candidate. Its constraints, which hold when >= 0 (eq 21, eq 18, a <= b) [m]."""
        if self.made == self.limit:
            raise Exhausted
        self.made += 1
        return margins(self.problem, design)

    def ratio(self, design):
        """V / V_mech of a feasible candidate: the voxels' box is as large as V_mech = pi b (l_u + l_d)."""
        ratio = self._count(design) / self._cells
        self.best = max(self.best, ratio)
        if ratio >= self.target:
            raise Reached
        return ratio


def margins(problem, design):
    """The three constraints of the wide-bounds problem, none without constraints."""
    if not problem.constrained:
        return np.empty(0)
    a, b, l_u, l_d = design
    shape = l_d - math.sqrt(l_u**2 + (b - a * problem.cos_theta_min) ** 2) / 2
    return np.array([shape, problem.L0 - 2 * l_u * math.cos(problem.alpha_min), b - a])


def violation(values):
    """Sum of what margins are below 0."""
    return float(-np.minimum(values, 0).sum())


def load(path):
    with open(path) as file:
        return SimpleNamespace(**json.load(file))
