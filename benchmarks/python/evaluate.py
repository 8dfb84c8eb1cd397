#!/usr/bin/env python3
"""Measures what a call from Python adds to the time of evaluations: evaluate.py LIBRARY [--designs N] [--rounds N]

LIBRARY is build/release/benchmarks/libpkm_evaluate.so. Problem.evaluate and the C++ evaluator (ParallelEvaluator)
evaluate the same designs in turns, in this process and on the same threads. For several designs the ratio of the total
times is printed, for a single design the time that Python adds, as medians. Fails if the values differ in a bit."""

import argparse
import ctypes
import statistics
import time

import numpy as np

import pkmopt

VARIABLES = {"a": (0.15, 0.95), "b": (0.35, 1.55), "l_u": (0.25, 1.5), "l_d": (0.25, 1.5)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("library")
    parser.add_argument("--designs", type=int, default=10000)
    parser.add_argument("--rounds", type=int, default=200)
    arguments = parser.parse_args()

    problem = pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume", workspace={"method": "columns"})
    toml = problem.to_toml().encode()
    seconds_in_cpp = ctypes.CDLL(arguments.library).pkm_evaluation_seconds
    seconds_in_cpp.restype = ctypes.c_double
    lower, upper = np.array(list(VARIABLES.values())).T
    designs = np.random.default_rng(1).uniform(lower, upper, (arguments.designs, len(lower)))

    def by_cpp(x):
        values = np.empty(len(x))
        addresses = [ctypes.c_void_p(array.ctypes.data) for array in (x, values)]
        return seconds_in_cpp(toml, ctypes.c_size_t(len(x)), *addresses), values

    def by_python(x):
        start = time.perf_counter()
        found = problem.evaluate(x)
        return time.perf_counter() - start, np.atleast_2d(found.objectives)[:, 0]

    def compare(x, of_python):
        cpp, python = [], []
        for _ in range(arguments.rounds):
            for times, (seconds, values) in ((cpp, by_cpp(x)), (python, by_python(of_python))):
                times.append(seconds)
                if len(times) == 1:
                    expected = values if times is cpp else expected
                    if not np.array_equal(values, expected):
                        raise SystemExit("the values of C++ and Python differ")
        return cpp, python

    compare(designs[:100], designs[:100])  # prepares both
    cpp, python = compare(designs, designs)
    each = 1e6 / len(designs)
    print("%d designs: C++ %.3f us, Python %.3f us per design, ratio of medians %.4f, of totals %.4f"
          % (len(designs), each * statistics.median(cpp), each * statistics.median(python),
             statistics.median(python) / statistics.median(cpp), sum(python) / sum(cpp)))
    cpp, python = compare(designs[:1], designs[0])
    print("1 design: C++ %.3f us, Python %.3f us" % (1e6 * statistics.median(cpp), 1e6 * statistics.median(python)))


if __name__ == "__main__":
    main()
