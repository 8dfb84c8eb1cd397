"""Measures pkmopt: its genetic algorithm with default options, from the start of the process to the study file."""

import json

import h5py
import numpy as np

from measure import run


class Program:
    """Runs a study with `pkmopt run`, its stages replaced by one `ga` stage with default options."""

    def __init__(self, pkmopt, study, folder):
        self._pkmopt, self._folder = pkmopt, folder
        with open(study) as text:
            self._problem = text.read().partition("[[stage]]")[0]

    def generations(self, seed):
        """Runs 100 generations of 20 (default). Returns candidates and seconds of the search, and the process cost."""
        cost, study_file = self._run(seed, "")
        shown = json.loads(run(self._pkmopt, "show", study_file, "--json").output)
        return {"candidates": shown["evaluations"], "seconds": shown["seconds"]}, cost

    def search(self, seed, target):
        """Runs until the generation in which the target is reached. Returns the same data as the peers' `search`."""
        cost, study_file = self._run(seed, f"target = {target!r}\n")
        with h5py.File(study_file) as file:
            evaluations = file["stages/1/evaluations"]
            ratio, status = evaluations["objective"][:, 0], evaluations["status"][:]
        ratio = np.where(status == 0, ratio, 0.0)  # 0: feasible
        reached = ratio >= target
        return {"reached": bool(reached.any()), "tried": int(reached.argmax()) + 1 if reached.any() else len(ratio),
                "best": float(ratio.max()), "cpu": cost.cpu}

    def _run(self, seed, option):
        study, study_file = self._folder / "study.toml", self._folder / "study.h5"
        study.write_text(f'{self._problem}[[stage]]\noptimiser = "ga"\n{option}')
        return run(self._pkmopt, "run", str(study), "--seed", str(seed), "--force", "--quiet", "--output",
                   str(study_file)), str(study_file)
