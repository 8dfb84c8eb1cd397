#!/usr/bin/python3
"""Measures the time of a generation without its evaluations: overhead.py PROGRAM [PROGRAM ..] [--rounds N]

Runs studies whose evaluations take some microseconds, alternately with each program, on one and on two threads. Prints
for each population the median time of a generation, less the time of its evaluations divided by the number of threads:
survivor selection, recording and reproduction. Checkpoints are excluded.
"""

import argparse
import os
import statistics
import subprocess
import tempfile

import h5py

STUDY = """
study = { name = "serial part", seed = 7 }
mechanism = { type = "4ppa-2par" }
workspace = { method = "columns", tolerance = 1e-2 }
checkpoint = { every = 3600 }
stage = [{ optimiser = "%s", population = %d, generations = %d }]
objective = [%s]
[variables]
a   = { min = 0.15, max = 0.95 }
b   = { min = 0.35, max = 1.55 }
l_u = { min = 0.25, max = 1.5 }
l_d = { min = 0.25, max = 1.5 }
"""
OBJECTIVES = {"ga": '{ type = "workspace-ratio" }',
              "nsga2": '{ type = "workspace-ratio" }, { type = "workspace-volume" }'}


def generations(program, folder, optimiser, population, threads):
    """Returns the seconds of each generation except the first."""
    study, output = os.path.join(folder, "study.toml"), os.path.join(folder, "study.h5")
    with open(study, "w", encoding="utf-8") as file:
        file.write(STUDY % (optimiser, population, max(5, min(100, 400000 // population)), OBJECTIVES[optimiser]))
    subprocess.run([program, "run", study, "--output", output, "--force", "--quiet", "--threads", str(threads)],
                   check=True)
    with h5py.File(output) as file:
        found = {}
        file.visititems(lambda name, item: found.update({name.split("/", 2)[-1]: item}))
        ends, first = found["generations/seconds"][()], found["generations/first_row"][()]
        rows = found["evaluations/seconds"][()].astype(float)
    bounds = [*first, len(rows)]
    return [ends[g] - ends[g - 1] - rows[bounds[g]:bounds[g + 1]].sum() / threads for g in range(1, len(ends))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", nargs="+", type=os.path.abspath)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for optimiser in OBJECTIVES:
            for population in (1000, 10000, 100000):
                times = {(program, threads): [] for threads in (1, 2) for program in arguments.programs}
                for _ in range(arguments.rounds):
                    for (program, threads), values in times.items():
                        values.extend(generations(program, folder, optimiser, population, threads))
                medians = [1e3 * statistics.median(values) for values in times.values()]
                print(f"{optimiser:6}{population:8}" + "".join(f"{m:10.3f} ms" for m in medians), flush=True)


if __name__ == "__main__":
    main()
