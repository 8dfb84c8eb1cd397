"""The two problems, each as a study on voxels and on exact columns, and what the peers are told of them."""

import json
import math
import subprocess
from dataclasses import dataclass

WITHIN = 1e-4  # relative: as near to the optimum a design counts as found
CELLS = 32 * 34 * 60


@dataclass(frozen=True)
class Problem:
    name: str
    title: str
    voxels: str  # studies of experiments/4ppa-2par
    columns: str
    best_on_voxels: float  # greatest ratio known
    best_on_columns: float


PROBLEMS = (
    # The plateau of the paper's grid near l_d = 0.6998; the corner of the bounds (4PPa-2PaR document).
    Problem("corner", "The paper's problem", "paper-problem.toml", "paper-problem-columns.toml",
            12576 / CELLS, 0.1935533684),
    # What 20 of 20 seeds find with a population of 100 and 200 generations; what SLSQP and Ipopt reach from all starts.
    Problem("wide-bounds", "The wide-bounds problem", "wide-bounds-voxels.toml", "wide-bounds.toml",
            20484 / CELLS, 0.311626100727),
)

# Limits where a study leaves them out.
INACTIVE = {"alpha_min": 0, "beta_min": 0, "beta_max": math.pi / 2, "h_min": 0, "sin_par_min": 0, "cos_theta_min": 0}


def flat(pkmopt, study, target):
    """The study on voxels as numbers by name, from `pkmopt check`: JSON that every peer reads with its own means."""
    found = json.loads(subprocess.run([pkmopt, "check", study, "--json"], check=True, capture_output=True).stdout)
    variables, workspace, constraints = found["variables"], found["workspace"], found["constraints"]
    cells = [workspace["cells"][axis] for axis in ("x", "z", "theta")]
    limits = {name: workspace["limits"][name] for name in INACTIVE}
    # What the peers take for granted.
    assert [variable["name"] for variable in variables] == ["a", "b", "l_u", "l_d"]
    assert [each["name"] for each in constraints] in ([], ["workspace-shape", "rail-length", "linear"])
    assert math.prod(cells) == CELLS and workspace["box"] is None and workspace["y"] == "middle"
    return {
        "lower": [variable["min"] for variable in variables],
        "upper": [variable["max"] for variable in variables],
        "cells": cells,
        "d": found["parameters"]["d"],
        "L0": found["parameters"]["L0"],
        **{name: INACTIVE[name] if limit is None else limit for name, limit in limits.items()},
        "constrained": bool(constraints),
        "target": target,
    }
