"""Evaluates and counts the candidates of the Python peers, until one reaches the target."""

import json
import math
from types import SimpleNamespace

import numpy as np


class Reached(Exception):
    """A feasible design has reached the target: the search ends."""


class Exhausted(Exception):
    """The maximum number of candidates has been evaluated: the search ends."""


class Trials:
    """Candidates of one search. An optimiser calls margins() once per candidate, then ratio()."""

    def __init__(self, problem, count, limit=math.inf, target=math.inf):
        self.problem, self.limit, self.target = problem, limit, target
        self._count, self._cells = count, math.prod(problem.cells)
        self.made, self.best = 0, 0.0

    def margins(self, design):
        """Counts a candidate and returns its constraint values, satisfied if >= 0 (eq 21, eq 18, a <= b) [m]."""
        if self.made == self.limit:
            raise Exhausted
        self.made += 1
        return margins(self.problem, design)

    def ratio(self, design):
        """Returns V / V_mech of a feasible candidate: the volume of the box equals V_mech = pi b (l_u + l_d)."""
        ratio = self._count(design) / self._cells
        self.best = max(self.best, ratio)
        if ratio >= self.target:
            raise Reached
        return ratio


def margins(problem, design):
    """Values of the three constraints of the wide-bounds problem; empty for a problem without constraints."""
    if not problem.constrained:
        return np.empty(0)
    a, b, l_u, l_d = design
    shape = l_d - math.sqrt(l_u**2 + (b - a * problem.cos_theta_min) ** 2) / 2
    return np.array([shape, problem.L0 - 2 * l_u * math.cos(problem.alpha_min), b - a])


def violation(values):
    """Total constraint violation."""
    return float(-np.minimum(values, 0).sum())


def load(path):
    with open(path) as file:
        return SimpleNamespace(**json.load(file))
