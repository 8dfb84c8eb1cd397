#!/usr/bin/env python3
"""Measures the speedup by a second rank and a second thread: speedup.py PROGRAM [STUDY.toml ..] [--rounds N]

Runs each study alternately on one thread, as two concurrent processes (each runs the whole study, which shows what the
two cores can do at most), on two ranks, and on two threads. Alternating runs are affected alike by changes of the
machine's speed. Prints the median times recorded in the study files, the speedup over one thread, and the efficiency:
the time of the two concurrent processes divided by twice the time of the two ranks or threads. Ratios are medians over
the rounds.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
EXPERIMENTS = os.path.join(HERE, "..", "..", "experiments", "3crr-r-cru")
STUDIES = [os.path.join(HERE, "survey.toml"), os.path.join(EXPERIMENTS, "coupling.toml"),
           os.path.join(EXPERIMENTS, "volume-coupling-force.toml")]
RANKS = ["mpirun", "--allow-run-as-root", "--bind-to", "none", "-n", "2"]


class Runner:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def start(self, study, name, launcher=(), threads="1"):
        return subprocess.Popen([*launcher, self.program, "run", study, "--output", os.path.join(self.folder, name),
                                 "--force", "--quiet", "--threads", threads])

    def seconds(self, name):
        shown = subprocess.run([self.program, "show", os.path.join(self.folder, name), "--json"], check=True,
                              stdout=subprocess.PIPE).stdout
        return json.loads(shown)["seconds"]

    def round(self, study):
        """Returns the seconds on one thread, of two concurrent processes, on two ranks, and on two threads."""
        times = []
        for runs in [[{}], [{}, {}], [{"launcher": RANKS}], [{"threads": "2"}]]:
            children = [self.start(study, f"{i}.h5", **run) for i, run in enumerate(runs)]
            if any([child.wait() for child in children]):
                sys.exit(f"{study}: a run failed")
            times.append(statistics.mean(self.seconds(f"{i}.h5") for i in range(len(runs))))
        return times


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("studies", nargs="*", default=STUDIES)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    print(f"{'':28}{'one':>9}{'two procs':>13}{'two ranks':>11}{'two threads':>13}"
          f"{'ranks/one':>13}{'efficiency':>12}{'threads/one':>15}{'efficiency':>12}")
    with tempfile.TemporaryDirectory() as folder:
        runner = Runner(arguments.program, folder)
        for study in arguments.studies:
            rounds = [runner.round(study) for _ in range(arguments.rounds)]
            median = [statistics.median(times) for times in zip(*rounds)]
            ratio = [statistics.median(r[above] / r[below] / share for r in rounds)
                     for above, below, share in ((0, 2, 1), (1, 2, 2), (0, 3, 1), (1, 3, 2))]
            print(f"{os.path.basename(study):28}{median[0]:8.2f}s{median[1]:12.2f}s{median[2]:10.2f}s{median[3]:12.2f}s"
                  f"{ratio[0]:13.2f}{ratio[1]:11.1%} {ratio[2]:15.2f}{ratio[3]:11.1%}", flush=True)


if __name__ == "__main__":
    main()
