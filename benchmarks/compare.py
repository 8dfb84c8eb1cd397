#!/usr/bin/env python3
"""Compares two builds of pkm_benchmarks, or two results of it, benchmark by benchmark.

    benchmarks/compare.py before/pkm_benchmarks after/pkm_benchmarks [--rounds N] [--filter REGEX] [--limit PERCENT]
    benchmarks/compare.py before.json after.json [--limit PERCENT]     (pkm_benchmarks --benchmark_out=before.json)

Two programs run each benchmark alternately, so that changes of the machine's speed affect both. Prints the median
times, their ratio, and the spread of the repetitions; a change within the spread is noise. Benchmarks that only one of
the programs has are listed. Multithreaded benchmarks (their names end with /real_time) are compared by wall time, the
others by CPU time. With --limit the exit code is 1 if a benchmark is slower by more than that percentage and by more
than its spread.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys

NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}


def repetitions(result):
    """Returns the times of all repetitions [ns] by benchmark name."""
    times = {}
    for run in result["benchmarks"]:
        if run.get("run_type", "iteration") == "iteration" and not run.get("error_occurred"):
            clock = "real_time" if run["run_name"].endswith("/real_time") else "cpu_time"
            times.setdefault(run["run_name"], []).append(run[clock] * NANOSECONDS[run["time_unit"]])
    return times


def read(path):
    """Returns the times in a result file, and the name of the machine."""
    try:
        with open(path, encoding="utf-8") as file:
            result = json.load(file)
        times = repetitions(result)
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"{path}: {type(error).__name__}: {error}; expected two programs, or two results of Google Benchmark "
                 "(--benchmark_out)")
    if not times:
        sys.exit(f"{path}: no repetitions of benchmarks; expected a result without --benchmark_report_aggregates_only")
    return times, result.get("context", {}).get("host_name", "?")


def run_program(program, *options):
    """Returns the output of a benchmark program."""
    try:
        return subprocess.run([program, *options], check=True, stdout=subprocess.PIPE, text=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"{program}: {error}")


def exactly(name):
    """Returns a POSIX regular expression that matches `name` only; POSIX does not allow other escapes than these."""
    return "^" + re.sub(r"([][.*^$+?(){}|\\])", r"\\\1", name) + "$"


def run_alternately(programs, rounds, pattern):
    """Returns the times of each program."""
    lists = [run_program(each, "--benchmark_list_tests", f"--benchmark_filter={pattern}").split() for each in programs]
    times = [{}, {}]
    for name in dict.fromkeys(lists[0] + lists[1]):
        for _ in range(rounds):
            for program, known, mine in zip(programs, lists, times):
                if name in known:
                    result = run_program(program, f"--benchmark_filter={exactly(name)}", "--benchmark_format=json",
                                 "--benchmark_min_time=0.05")
                    for run, values in repetitions(json.loads(result)).items():
                        mine.setdefault(run, []).extend(values)
    return times


def spread(times):
    """Relative spread: half of the interquartile range of the repetitions, divided by their median."""
    if len(times) < 3:
        return 0.0
    lower, median, upper = statistics.quantiles(times, n=4, method="inclusive")
    return (upper - lower) / 2 / median


def short(nanoseconds):
    for unit, size in (("s", 1e9), ("ms", 1e6), ("us", 1e3)):
        if nanoseconds >= size:
            return f"{nanoseconds / size:.3g} {unit}"
    return f"{nanoseconds:.3g} ns"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--limit", type=float, help="maximum slowdown of a benchmark, in per cent")
    parser.add_argument("--rounds", type=int, default=9, help="repetitions of each benchmark, if programs are given")
    parser.add_argument("--filter", default=".", help="benchmarks to run, if programs are given")
    arguments = parser.parse_args()
    programs = [arguments.before, arguments.after]
    if all(os.access(program, os.X_OK) for program in programs):
        before, after = run_alternately(programs, arguments.rounds, arguments.filter)
    else:
        (before, host_before), (after, host_after) = read(arguments.before), read(arguments.after)
        if host_before != host_after:
            print(f"warning: results of two machines, {host_before} and {host_after}")
    slower = []
    width = max(map(len, before | after))
    print(f"{'':{width}}  {'before':>9}  {'after':>9}  after/before  spread")
    for name in before | after:
        if name not in before or name not in after:
            print(f"{name:{width}}  only in {arguments.before if name in before else arguments.after}")
            continue
        old, new = statistics.median(before[name]), statistics.median(after[name])
        noise = max(spread(before[name]), spread(after[name]))
        print(f"{name:{width}}  {short(old):>9}  {short(new):>9}  {new / old:12.3f}  {noise:6.1%}")
        if arguments.limit is not None and new / old - 1 > max(arguments.limit / 100, noise):
            slower.append(name)
    if slower:
        sys.exit(f"slower by more than {arguments.limit:g} %: {', '.join(slower)}")


if __name__ == "__main__":
    main()
