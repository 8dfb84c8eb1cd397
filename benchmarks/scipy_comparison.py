#!/usr/bin/env python3
"""Compares pkmopt's optimisers with those of scipy: scipy_comparison.py [--seeds N] [--generations N]

All of them evaluate the same three problems by the same engine, through the package pkmopt for Python. The global
optimisers, pkmopt's `ga` and scipy's differential_evolution with its default settings but without polishing, have the
same population and number of generations; the table has medians over the seeds. The local optimisers, both of them
SLSQP, start from the same design and use the same exact derivatives. "to 1e-4" is the number of evaluations after
which the best feasible design is within 1e-4 of the best value of all optimisers; "-": half of the seeds did not reach
it. All times include the evaluations; those of pkmopt also include checkpoints, the study file, and for `slsqp` the
final table of sensitivities.

Fails if an optimiser reports a value that the evaluation of its design does not give.
"""

import argparse
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np
import scipy.optimize

import pkmopt

EXPERIMENTS = Path(__file__).resolve().parents[1] / "experiments"
POPULATION = 60  # scipy's default for four variables
VIOLATION = 1e-9  # of a constraint that is accepted: solvers end at a constraint with rounding errors on either side


def problems():
    """(title, tables of the study) of each problem."""
    lengths = {"a": (0.15, 0.95), "b": (0.35, 1.55), "l_u": (0.25, 1.5), "l_d": (0.25, 1.5)}
    angles = {"beta_max": "75 deg", "cos_theta_min": 0.1}
    yield "4PPa-2PaR, volume", {
        "mechanism": "4ppa-2par",
        "variables": lengths,
        "objectives": "workspace-volume",
        "baseline": {"a": 0.2, "b": 0.8, "l_u": 0.6, "l_d": 0.55},
        "workspace": {"method": "columns", "limits": angles},
    }
    yield "rotary Delta, ratio", {
        "mechanism": pkmopt.Mechanism.from_file(EXPERIMENTS / "mechanisms" / "rotary-delta.toml"),
        "variables": {"R": (0.1, 0.4), "l_a": (0.1, 0.4), "l_b": (0.4, 0.9)},
        "objectives": "workspace-ratio",
        "baseline": {"R": 0.2, "l_a": 0.2, "l_b": 0.5},
        "workspace": {"method": "columns", "tolerance": 1e-6},
    }
    yield "4PPa-2PaR, ratio with constraints", {
        "mechanism": "4ppa-2par",
        "variables": lengths,
        "objectives": "workspace-ratio",
        "constraints": ["workspace-shape", "rail-length",
                        {"type": "linear", "coefficients": {"a": 1, "b": -1}, "bound": 0}],
        "baseline": {"a": 0.2, "b": 0.8, "l_u": 0.6, "l_d": 0.55},
        "parameters": {"d": 0.15, "L0": 2.5},
        "workspace": {"method": "columns", "limits": angles},
    }


class RecordedProblem(pkmopt.Problem):
    """Records the designs that are evaluated, and their values to minimise: infinite if a constraint is violated. The
    values and the derivatives of a design, which SLSQP requests one after the other, count as one evaluation."""

    def __init__(self, **tables):
        super().__init__(**tables)
        self.designs, self.values = [], []

    def evaluate(self, designs, **options):
        return self._record(designs, super().evaluate(designs, **options))

    def differentiate(self, designs, **options):
        found = super().differentiate(designs, **options)
        self._record(designs, found.evaluation)
        return found

    def _record(self, designs, found):
        values = to_minimise(self, np.atleast_2d(found.objectives)[:, 0], np.atleast_2d(found.constraints))
        for design, value in zip(np.atleast_2d(designs).copy(), values):
            if not self.designs or not np.array_equal(design, self.designs[-1]):
                self.designs.append(design)
                self.values.append(value)
        return found


def to_minimise(problem, objectives, margins):
    """Values to minimise; infinite if a constraint is violated by more than VIOLATION or a value is undefined."""
    sign = -1 if problem.info["objectives"][0]["maximise"] else 1
    is_feasible = np.isfinite(objectives) & np.all(margins >= -VIOLATION, axis=1)
    return np.where(is_feasible, sign * objectives, np.inf)


def run_pkmopt(tables, seed, stage):
    """Returns the designs in the order of evaluation, their values to minimise, and the time of the run [s]."""
    study = pkmopt.Study(**tables, stages=stage)
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        results = study.run(Path(folder) / "study.h5", seed=seed)
        seconds = time.perf_counter() - start
        table = results.evaluations()
        results.close()
    designs = np.stack([table[v.name] for v in study.variables], axis=1)
    margins = np.zeros((len(table), len(study.constraints)))
    for column, name in enumerate(study.constraints):
        margins[:, column] = table[name]
    return designs, to_minimise(study, table[study.objectives[0]], margins), seconds


def run_ga(tables, seed, generations):
    return run_pkmopt(tables, seed, {"optimiser": "ga", "population": POPULATION, "generations": generations})


def run_pkmopt_slsqp(tables, _seed, _generations):
    return run_pkmopt(tables, 1, {"optimiser": "nlopt", "algorithm": "slsqp"})


def run_scipy(tables, minimise):
    problem = RecordedProblem(**tables)
    start = time.perf_counter()
    minimise(problem.as_scipy())
    seconds = time.perf_counter() - start
    return np.array(problem.designs), np.array(problem.values), seconds


def run_differential_evolution(tables, seed, generations):
    return run_scipy(tables, lambda p: scipy.optimize.differential_evolution(
        p.penalised, p.bounds, popsize=POPULATION // len(p.bounds), maxiter=generations, tol=0, seed=seed, polish=False,
        updating="deferred", vectorized=True))


def run_scipy_slsqp(tables, _seed, _generations):
    return run_scipy(tables, lambda p: scipy.optimize.minimize(
        p.fun, p.x0, jac=p.jac, bounds=p.bounds, constraints=p.constraints, method="SLSQP",
        options={"ftol": 1e-12, "maxiter": 1000}))


# Name, function, and whether the result depends on the seed.
OPTIMISERS = [
    ("pkmopt `ga`", run_ga, True),
    ("scipy `differential_evolution`", run_differential_evolution, True),
    ("pkmopt `slsqp`", run_pkmopt_slsqp, False),
    ("scipy `SLSQP`", run_scipy_slsqp, False),
]


def check(tables, designs, values):
    """Raises ValueError unless the best design, evaluated again, has its value."""
    best = int(np.argmin(values))
    problem = pkmopt.Problem(**tables)
    found = problem.evaluate(designs[best])
    again = float(to_minimise(problem, found.objectives, found.constraints[np.newaxis])[0])
    if again != values[best]:
        raise ValueError("the design %s has the value %r; expected %r" % (designs[best], again, values[best]))


def evaluations_until(values, target):
    """Number of evaluations until a value <= target; infinite if there is none."""
    reached = np.flatnonzero(values <= target)
    return float(reached[0] + 1) if len(reached) else np.inf


def table_of(tables, seeds, generations):
    """Rows of a problem: optimiser, best value, evaluations until it is nearly reached, all evaluations, time."""
    runs = {name: [run(tables, seed, generations) for seed in range(1, seeds + 1 if is_random else 2)]
            for name, run, is_random in OPTIMISERS}
    for each in runs.values():
        for designs, values, _ in each:
            check(tables, designs, values)
    best = min(values.min() for each in runs.values() for _, values, _ in each)
    for name, each in runs.items():
        until = statistics.median_high(evaluations_until(values, best + 1e-4 * abs(best)) for _, values, _ in each)
        yield [name, "%.8g" % abs(statistics.median(values.min() for _, values, _ in each)),
               "%.0f" % until if np.isfinite(until) else "-",
               "%.0f" % statistics.median(len(values) for _, values, _ in each),
               "%.0f ms" % (1e3 * statistics.median(seconds for _, _, seconds in each))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=5, help="number of seeds of the global optimisers")
    parser.add_argument("--generations", type=int, default=100)
    arguments = parser.parse_args()
    print("| problem | optimiser | best value | to 1e-4 | evaluations | time |")
    print("|---|---|---|---|---|---|")
    for title, tables in problems():
        for row in table_of(tables, arguments.seeds, arguments.generations):
            print("| " + " | ".join([title, *row]) + " |", flush=True)


if __name__ == "__main__":
    main()
