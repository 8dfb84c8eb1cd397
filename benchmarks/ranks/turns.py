#!/usr/bin/env python3
"""What a second rank and a second thread bring: turns.py PROGRAM [STUDY.toml ..] [--rounds N]

Runs studies in turns by one thread, by two such processes at once (each the whole study: what two cores can do at
all), by two ranks, and by two threads, so that a machine that changes its speed changes it for all. Prints the median
times of the runs as their study files tell them, how many times as fast two are as one, and the efficiency: the
study twice by two processes at once over twice the time of two that share it. Medians of the rounds' ratios.
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


class Turns:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def start(self, study, name, launcher=(), threads="1"):
        return subprocess.Popen([*launcher, self.program, "run", study, "--output", os.path.join(self.folder, name),
                                 "--force", "--quiet", "--threads", threads])

    def seconds(self, name):
        told = subprocess.run([self.program, "show", os.path.join(self.folder, name), "--json"], check=True,
                              stdout=subprocess.PIPE).stdout
        return json.loads(told)["seconds"]

    def round(self, study):
        """Seconds alone, of two at once, by two ranks, by two threads."""
        times = []
        for runs in [[{}], [{}, {}], [{"launcher": RANKS}], [{"threads": "2"}]]:
            children = [self.start(study, f"{i}.h5", **run) for i, run in enumerate(runs)]
            if any([child.wait() for child in children]):
                sys.exit("a run failed")
            times.append(statistics.mean(self.seconds(f"{i}.h5") for i in range(len(runs))))
        return times


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("studies", nargs="*", default=STUDIES)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    print(f"{'':28}{'alone':>9}{'two at once':>13}{'two ranks':>11}{'two threads':>13}"
          f"{'ranks/alone':>13}{'efficiency':>12}{'threads/alone':>15}{'efficiency':>12}")
    with tempfile.TemporaryDirectory() as folder:
        turns = Turns(arguments.program, folder)
        for study in arguments.studies:
            rounds = [turns.round(study) for _ in range(arguments.rounds)]
            median = [statistics.median(times) for times in zip(*rounds)]
            ratio = [statistics.median(r[above] / r[below] / share for r in rounds)
                     for above, below, share in ((0, 2, 1), (1, 2, 2), (0, 3, 1), (1, 3, 2))]
            print(f"{os.path.basename(study):28}{median[0]:8.2f}s{median[1]:12.2f}s{median[2]:10.2f}s{median[3]:12.2f}s"
                  f"{ratio[0]:13.2f}{ratio[1]:11.1%} {ratio[2]:15.2f}{ratio[3]:11.1%}", flush=True)


if __name__ == "__main__":
    main()
