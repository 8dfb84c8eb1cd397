#!/usr/bin/env python3
"""Compares two results of pkm_benchmarks, benchmark by benchmark.

    pkm_benchmarks --benchmark_repetitions=9 --benchmark_out=before.json
    pkm_benchmarks --benchmark_repetitions=9 --benchmark_out=after.json
    benchmarks/compare.py before.json after.json [--limit PERCENT]

Prints the median CPU times, their ratio, and the spread of the repetitions; a change within the spread is noise. With
--limit the exit code is 1 if a benchmark got slower by more than that many per cent and by more than its spread.
"""

import argparse
import json
import statistics
import sys

NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}


def read(path):
    """Benchmark's name -> CPU times of its repetitions [ns], and the machine's name."""
    try:
        with open(path, encoding="utf-8") as file:
            result = json.load(file)
        times = {}
        for run in result["benchmarks"]:
            if run.get("run_type", "iteration") == "iteration" and not run.get("error_occurred"):
                times.setdefault(run["run_name"], []).append(run["cpu_time"] * NANOSECONDS[run["time_unit"]])
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"{path} is no result of Google Benchmark (--benchmark_out): {error!r}")
    if not times:
        sys.exit(f"{path} holds no repetition of any benchmark; write it without --benchmark_report_aggregates_only")
    return times, result.get("context", {}).get("host_name", "?")


def spread(times):
    """Half of the range that the middle half of the repetitions spans, over their median."""
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
    parser.add_argument("--limit", type=float, help="per cent that a benchmark may get slower")
    arguments = parser.parse_args()
    (before, host_before), (after, host_after) = read(arguments.before), read(arguments.after)
    if host_before != host_after:
        print(f"two machines: {host_before} and {host_after}")
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
