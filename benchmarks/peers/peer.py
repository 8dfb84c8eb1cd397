"""Runs a Python optimiser: peer.py TOOL EVALUATOR PROBLEM.json ACTION, where TOOL is deap_ga or scipy_de, and EVALUATOR
is voxels_numpy or voxels_numba. Prints JSON.

counts DESIGNS.json      numbers of feasible voxels of designs
generations N SEED       N generations of 20: number of candidates and seconds
search SEEDS LIMIT       for seeds 1 to SEEDS, a search that ends at the target or after LIMIT candidates: whether the
                         target was reached, number of candidates, best feasible ratio, CPU seconds since the start of
                         the process
"""

import importlib
import json
import sys
import time

from trials import Exhausted, Reached, Trials, load

POPULATION = 20


def counts(count, file):
    with open(file) as designs:
        return [int(count(design)) for design in json.load(designs)]


def generations(search, problem, count, number, seed):
    trials = Trials(problem, count)
    begin = time.perf_counter()
    search(trials, int(seed), POPULATION, int(number))
    return {"candidates": trials.made, "seconds": time.perf_counter() - begin}


def searches(search, problem, count, seeds, limit):
    start, found = time.process_time(), []
    for seed in range(1, int(seeds) + 1):
        trials = Trials(problem, count, int(limit), problem.target)
        begin, reached = time.process_time(), False
        try:
            search(trials, seed, POPULATION, trials.limit)  # the candidates end the search, not the generations
        except Reached:
            reached = True
        except Exhausted:
            pass
        found.append({"reached": reached, "tried": trials.made, "best": trials.best,
                      "cpu": start + time.process_time() - begin})
    return found


def main(tool, evaluator, problem_file, action, *arguments):
    problem = load(problem_file)
    count = importlib.import_module(evaluator).counter(problem)
    count(problem.lower)  # triggers the compilation by numba, or loads the cached result
    if action == "counts":
        return counts(count, *arguments)
    search = importlib.import_module(tool).search
    run = {"generations": generations, "search": searches}[action]
    return run(search, problem, count, *arguments)


if __name__ == "__main__":
    print(json.dumps(main(*sys.argv[1:])))
