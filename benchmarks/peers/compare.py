"""Compares pkmopt with other optimisers (the peers) on the paper's problem and the wide-bounds problem.

compare.py PKMOPT PAGMO PAGMO_COLUMNS FOLDER: three programs, and a folder for output files. Prints a table per problem.
Fails if an evaluator counts different voxels than pkmopt.
"""

import json
import random
import sys
from dataclasses import dataclass
from pathlib import Path

from measure import run
from problems import PROBLEMS, WITHIN, flat
from program import Program
from table import Row, print_table

HERE = Path(__file__).parent
STUDIES = HERE.parent.parent / "experiments" / "4ppa-2par"
SEEDS = 20
LIMIT = 2020  # maximum candidates of a search: the paper's 100 generations of 20, and the initial population
LIMIT_ON_COLUMNS = 20000
RUNS = 3  # runs of 100 generations
DESIGNS = 20  # random designs per problem for which all evaluators must count the same voxels


@dataclass(frozen=True)
class Peer:
    name: str
    evaluator: str
    command: tuple  # without the problem and the action


def pagmo(program, evaluator, problem):
    tools = ["sga", "sade", "cmaes", "cmaes-8", "nsga2"]
    if problem.name == "wide-bounds":
        tools += ["sga-self-adaptive", "sade-self-adaptive"]
    return [Peer("pagmo " + tool, evaluator, (program, tool)) for tool in tools]


def slower_peers():
    for tool, name in (("deap_ga", "DEAP eaSimple"), ("scipy_de", "scipy differential_evolution")):
        for evaluator in ("numba", "numpy"):
            yield Peer(name, evaluator, (sys.executable, str(HERE / "peer.py"), tool, "voxels_" + evaluator))
    yield Peer("GNU Octave ga", "Octave", ("octave-cli", "--quiet", "--no-init-file", str(HERE / "octave_ga.m")))


def check_counts(pkmopt, study, problem_file, peers):
    """Raises RuntimeError unless every peer counts the same voxels as `pkmopt evaluate`, for random designs and for the
    lower and upper bounds."""
    problem = json.loads(problem_file.read_text())
    stream = random.Random(1)
    designs = [[stream.uniform(*bounds) for bounds in zip(problem["lower"], problem["upper"])] for _ in range(DESIGNS)]
    designs += [problem["lower"], problem["upper"]]
    designs_file = problem_file.with_suffix(".designs.json")
    designs_file.write_text(json.dumps(designs))
    expected = []
    for design in designs:
        values = ",".join(f"{name}={value!r}" for name, value in zip(("a", "b", "l_u", "l_d"), design))
        found = json.loads(run(pkmopt, "evaluate", study, "--set", values, "--json").output)
        expected.append(found["workspace"]["feasible_cells"])
    for peer in peers:
        counts = json.loads(run(*peer.command, str(problem_file), "counts", str(designs_file)).output)
        if counts != expected:
            raise RuntimeError(f"{peer.name}, {peer.evaluator}: counts {counts}; expected {expected} from pkmopt")


def peer_row(peer, problem, limit, optimum):
    """Measures a peer; `problem` holds the arguments of its command that define the problem."""
    command = (*peer.command, *problem)
    searches = json.loads(run(*command, "search", str(SEEDS), str(limit)).output)
    costs = [run(*command, "generations", "100", str(seed)) for seed in range(1, RUNS + 1)]
    return Row(peer.name, peer.evaluator, searches, [json.loads(cost.output) for cost in costs], costs, optimum)


def program_row(program, evaluator, target, optimum):
    searches = [program.search(seed, target) for seed in range(1, SEEDS + 1)]
    generations, costs = zip(*(program.generations(seed) for seed in range(1, RUNS + 1)))
    return Row("pkmopt ga", evaluator, searches, generations, costs, optimum)


def on_voxels(problem, pkmopt, pagmo_on_loop, folder):
    study, optimum = str(STUDIES / problem.voxels), problem.best_on_voxels
    target = (1 - WITHIN) * optimum
    problem_file = folder / (problem.name + ".json")
    problem_file.write_text(json.dumps(flat(pkmopt, study, target)))
    peers = [*pagmo(pagmo_on_loop, "C++ loop", problem), *slower_peers()]
    check_counts(pkmopt, study, problem_file, peers)
    yield program_row(Program(pkmopt, study, folder), "voxels", target, optimum)
    for peer in peers:
        yield peer_row(peer, [str(problem_file)], LIMIT, optimum)


def on_columns(problem, pkmopt, pagmo_on_columns, folder):
    study, optimum = str(STUDIES / problem.columns), problem.best_on_columns
    target = (1 - WITHIN) * optimum
    yield program_row(Program(pkmopt, study, folder), "columns", target, optimum)
    for peer in pagmo(pagmo_on_columns, "columns", problem):
        yield peer_row(peer, [study, repr(target)], LIMIT_ON_COLUMNS, optimum)


def main(pkmopt, pagmo_on_loop, pagmo_on_columns, folder):
    for problem in PROBLEMS:
        print_table(problem.title, [list(on_voxels(problem, pkmopt, pagmo_on_loop, Path(folder))),
                                    list(on_columns(problem, pkmopt, pagmo_on_columns, Path(folder)))])


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except RuntimeError as error:
        sys.exit(str(error))
