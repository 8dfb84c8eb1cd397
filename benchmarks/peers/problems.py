"""The two problems, each as a study with voxels and with exact volumes, and their data for the peers."""

import json
import math
import subprocess
from dataclasses import dataclass

WITHIN = 1e-4  # relative distance from the optimum within which a design counts as found
CELLS = 32 * 34 * 60


@dataclass(frozen=True)
class Problem:
    name: str
    title: str
    voxels: str  # studies of experiments/4ppa-2par
    columns: str
    best_on_voxels: float  # best known ratio
    best_on_columns: float


PROBLEMS = (
    # Voxels: plateau of the paper's grid near l_d = 0.6998. Columns: corner of the bounds (4PPa-2PaR document).
    Problem("corner", "The paper's problem", "paper-problem.toml", "paper-problem-columns.toml",
            12576 / CELLS, 0.1935533684),
    # Voxels: found by 20 of 20 seeds with a population of 100 and 200 generations. Columns: found by SLSQP and Ipopt
    # from all starts.
    Problem("wide-bounds", "The wide-bounds problem", "wide-bounds-voxels.toml", "wide-bounds.toml",
            20484 / CELLS, 0.311626100727),
)

# Inactive values of the limits that a study omits.
INACTIVE = {"alpha_min": 0, "beta_min": 0, "beta_max": math.pi / 2, "h_min": 0, "sin_par_min": 0, "cos_theta_min": 0}


def flat(pkmopt, study, target):
    """Problem data of the voxel study as a flat dictionary, from `pkmopt check --json`, for all peers to read."""
    found = json.loads(subprocess.run([pkmopt, "check", study, "--json"], check=True, capture_output=True).stdout)
    variables, workspace, constraints = found["variables"], found["workspace"], found["constraints"]
    cells = [workspace["cells"][axis] for axis in ("x", "z", "theta")]
    limits = {name: workspace["limits"][name] for name in INACTIVE}
    # Assumptions of the peers.
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
