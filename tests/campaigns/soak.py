#!/usr/bin/python3
"""Memory use of long runs.

soak.py PROGRAM [--evaluations N] [--runs R]

One run of N evaluations: evaluations are kept in memory, so memory may grow only by the size of their records. R
successive runs in one process (--seeds): memory must not grow. Memory is read from /proc while the program runs. Exit
code 1 if memory grows more.
"""

import argparse
import os
import sys
import tempfile
import time

import campaign

# A row has 4 variables, an objective, margins, status and times: about 100 bytes. Several copies exist while a vector
# is reallocated and while a checkpoint is written and read back.
MAX_BYTES_PER_EVALUATION = 600
MAX_GROWTH_OF_RUNS = 4 << 20  # [bytes] between the first tenth of the runs and the last


def resident(pid):
    """Resident memory of a process [bytes]; None after it has ended."""
    try:
        with open("/proc/%d/statm" % pid, encoding="ascii") as file:
            pages = int(file.read().split()[1])
    except (OSError, IndexError):
        return None
    return pages * os.sysconf("SC_PAGE_SIZE") if pages else None


def watch(folder, arguments, progress):
    """Runs the program. Returns its time in seconds and samples (progress(), resident bytes)."""
    begin, pairs = time.monotonic(), []
    log = folder.file("output.txt")
    with open(log, "w", encoding="utf-8") as out:
        child = folder.start(arguments)
        while child.poll() is None:
            bytes_ = resident(child.pid)
            if bytes_:
                pairs.append((progress(), bytes_))
            time.sleep(0.005)
        out.write(child.communicate()[0])
    if child.returncode != 0:
        with open(log, encoding="utf-8") as text:
            sys.exit("exit code %d: %s" % (child.returncode, text.read()[-1000:]))
    return time.monotonic() - begin, pairs


def mib(bytes_):
    return "%.1f MiB" % (bytes_ / 2**20)


def one_run(folder, evaluations):
    population = 1000
    folder.write("long.toml", campaign.PROBLEM + '[[stage]]\noptimiser = "ga"\npopulation = %d\ngenerations = %d\n'
                 % (population, evaluations // population))
    seconds, pairs = watch(folder, ["run", "long.toml", "--output", "long.h5", "--quiet"], lambda: 0)
    start, peak = pairs[0][1], max(bytes_ for _, bytes_ in pairs)
    each = (peak - start) / evaluations
    print("one run: %d evaluations in %.0f s, %s at the start, maximum %s: %.0f bytes per evaluation"
          % (evaluations, seconds, mib(start), mib(peak), each))
    return each <= MAX_BYTES_PER_EVALUATION


def many_runs(folder, runs):
    folder.write("turn.toml", campaign.STUDIES["ga"])
    done = lambda: sum(name.endswith(".h5") for name in os.listdir(folder.path))
    before = done()
    seconds, pairs = watch(folder, ["run", "turn.toml", "--output", "turn.h5", "--seeds", str(runs), "--quiet"], done)
    pairs = [(number - before, bytes_) for number, bytes_ in pairs]
    tenth = max(runs // 10, 1)
    first = max((bytes_ for number, bytes_ in pairs if number <= tenth), default=0)
    last = max((bytes_ for number, bytes_ in pairs if number > runs - tenth), default=0)
    print("successive runs: %d in %.0f s, maximum %s in the first tenth of them, %s in the last tenth"
          % (runs, seconds, mib(first), mib(last)))
    return first > 0 and last - first <= MAX_GROWTH_OF_RUNS


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--evaluations", type=int, default=300_000)
    parser.add_argument("--runs", type=int, default=60)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pkmopt-soak-") as path:
        folder = campaign.Folder(path, arguments.program)
        passed = [one_run(folder, arguments.evaluations), many_runs(folder, arguments.runs)]
    print("memory does not grow" if all(passed) else "memory grows")
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
