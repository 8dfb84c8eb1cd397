"""A Python peer: peer.py TOOL EVALUATOR PROBLEM.json ACTION, where TOOL is deap_ga or scipy_de, EVALUATOR voxels_numpy
or voxels_numba. Prints JSON.

counts DESIGNS.json      numbers of feasible cells of designs
generations N SEED       N generations of 20: the candidates tried and the seconds they took
search SEEDS LIMIT       per seed from 1: whether LIMIT candidates reach the target, which ends the search; the number
                         of candidates tried, the best feasible ratio, CPU seconds from the start of the process
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
            search(trials, seed, POPULATION, trials.limit)  # more generations than candidates are allowed
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
    count(problem.lower)  # numba compiles, or loads what it has compiled
    if action == "counts":
        return counts(count, *arguments)
    search = importlib.import_module(tool).search
    run = {"generations": generations, "search": searches}[action]
    return run(search, problem, count, *arguments)


if __name__ == "__main__":
    print(json.dumps(main(*sys.argv[1:])))
