#!/usr/bin/python3
"""Failures of the n-th disk operation, for every n.

disk.py PROGRAM UNRELIABLE_DISK [--every K]

The operations are opening for writing, write, fsync and rename. One operation fails once, or it and all later ones fail
(a full disk), or a write writes only its first half. In each case an existing file is afterwards either unchanged or
complete, never anything else; no other files remain; and a failure is reported by a message and exit code 1. Prints a
table.
"""

import argparse
import errno
import os
import shutil
import sys
import tempfile

import campaign

STUDY = campaign.PROBLEM + """[[stage]]
optimiser = "ga"
population = 8
generations = 4
[checkpoint]
every = 0
"""
FAILURES = {
    "once": {"error": errno.EIO},
    "from then on": {"fails_for": 0, "error": errno.ENOSPC},
    "half written": {"short": 1, "error": errno.ENOSPC},
}


class Scenario:
    """A command, its output file, and the files that exist before it."""

    def __init__(self, arguments, output, before):
        self.arguments, self.output, self.before = arguments, output, before


def files_below(path):
    found = {}
    for folder, _, names in os.walk(path):
        for name in names:
            full = os.path.join(folder, name)
            with open(full, "rb") as file:
                found[os.path.relpath(full, path)] = file.read()
    return found


class Campaign:
    def __init__(self, root, program, library, every):
        self.root, self.program, self.library, self.every = root, program, library, every
        self.faults = []
        self.ready = campaign.Folder(os.path.join(root, "ready"), program)
        os.mkdir(self.ready.path)
        self.ready.write("study.toml", STUDY)
        self.ready.write("other.toml", STUDY.replace("seed = 7", "seed = 8"))
        for study, file in (("study", "after"), ("other", "before")):
            self.expect_run(self.ready, ["run", study + ".toml", "--output", file + ".h5", "--threads", "1"])
            self.expect_run(self.ready, ["export", file + ".h5", "--csv", file, "--vtk", file + ".vtkhdf"])
        self.after = campaign.digest(self.ready.file("after.h5"))

    @staticmethod
    def expect_run(folder, arguments, variables=None):
        code, output = folder.run(arguments, variables)
        if code != 0:
            sys.exit("%s: exit code %s: %s" % (" ".join(arguments), code, output))

    def fresh(self, scenario):
        path = os.path.join(self.root, "at")
        shutil.rmtree(path, ignore_errors=True)
        os.mkdir(path)
        for name, source in scenario.before.items():
            source, target = self.ready.file(source), os.path.join(path, name)
            (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)
        return campaign.Folder(path, self.program)

    def count(self, scenario):
        """Number of disk operations of a run, and the files after it."""
        folder = self.fresh(scenario)
        number = os.path.join(self.root, "number")
        self.expect_run(folder, scenario.arguments, campaign.disk(self.library, folder.path, count=number))
        with open(number, encoding="ascii") as file:
            return int(file.read()), files_below(folder.path)

    def fault(self, name, how, number, what):
        self.faults.append(what)
        print("%s, failure %d %s: %s" % (name, number, how, what), flush=True)

    def is_study(self, folder, name, finished):
        """Whether a file is the complete study or, unless it must be `finished`, a checkpoint that resumes to it."""
        if not finished and folder.run(["resume", name, "--threads", "1"])[0] != 0:
            return False
        try:
            return campaign.digest(folder.file(name)) == self.after
        except OSError:
            return False

    def check(self, name, scenario, how, number, after):
        folder = self.fresh(scenario)
        before = files_below(folder.path)
        code, output = folder.run(scenario.arguments,
                                  campaign.disk(self.library, folder.path, fails_at=number, **FAILURES[how]), 120)
        remaining = files_below(folder.path)
        fault = lambda what: self.fault(name, how, number, what)
        if code not in (0, 1):
            fault("exit code %s: %s" % (code, output[-300:]))
        error = os.strerror(FAILURES[how]["error"])
        if code == 1 and error not in output:
            fault("the message does not contain '%s': %s" % (error, output[-300:]))
        for file in sorted(set(remaining) - set(before) - set(after)):
            fault("%s remains" % file)
        for file in sorted(set(before) - set(remaining)):
            fault("%s was deleted" % file)
        for file in sorted(remaining):
            if remaining[file] == after.get(file) or (code != 0 and remaining[file] == before.get(file)):
                continue
            if file == scenario.output and file.endswith(".h5"):
                if self.is_study(folder, file, finished=code == 0):
                    continue
            fault("%s is neither the old nor the new file, %d bytes" % (file, len(remaining[file])))
        if code == 0 and not set(after) <= set(remaining):
            fault("exit code 0 without %s" % ", ".join(sorted(set(after) - set(remaining))))
        return code

    def run(self, name, scenario):
        numbers, after = self.count(scenario)
        for how in FAILURES:
            ended = {0: 0, 1: 0}
            faults = len(self.faults)
            tested = range(1, numbers + 1, self.every)
            for number in tested:
                code = self.check(name, scenario, how, number, after)
                ended[code] = ended.get(code, 0) + 1
            print("%-22s%-14s%8d%8d%10d%14d%8d" % (name, how, numbers, len(tested), ended[1], ended[0],
                                                   len(self.faults) - faults), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("unreliable_disk")
    parser.add_argument("--every", type=int, default=1, help="test only every K-th operation")
    arguments = parser.parse_args()
    run = ["run", "study.toml", "--output", "s.h5", "--threads", "1"]
    tables = ["export", "s.h5", "--csv", "tables", "--force"]
    texts = {"study.toml": "study.toml"}
    scenarios = {
        "a new study": Scenario(run, "s.h5", texts),
        "over another study": Scenario(run + ["--force"], "s.h5", {**texts, "s.h5": "before.h5"}),
        "tables": Scenario(tables, "tables", {"s.h5": "after.h5"}),
        "over other tables": Scenario(tables, "tables", {"s.h5": "after.h5", "tables": "before"}),
        "over a picture": Scenario(["export", "s.h5", "--vtk", "s.vtkhdf", "--force"], "s.vtkhdf",
                                   {"s.h5": "after.h5", "s.vtkhdf": "before.vtkhdf"}),
    }
    with tempfile.TemporaryDirectory(prefix="pkmopt-disk-") as path:
        campaign_ = Campaign(path, arguments.program, arguments.unreliable_disk, arguments.every)
        print("%-22s%-14s%8s%8s%10s%14s%8s" % ("", "failure", "ops", "tested", "exit 1", "exit 0", "faults"))
        for name, scenario in scenarios.items():
            campaign_.run(name, scenario)
    print("%d faults" % len(campaign_.faults))
    return 1 if campaign_.faults else 0


if __name__ == "__main__":
    sys.exit(main())
