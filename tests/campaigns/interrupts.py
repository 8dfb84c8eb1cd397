#!/usr/bin/python3
"""Commands interrupted by SIGINT, SIGTERM or their time limit at random times.

interrupts.py PROGRAM [--interrupts N] [--bound SECONDS] [--seed S]

Covers all commands that compute, including studies whose evaluations or final steps do not end. Each command must end
within the bound; `certify --proof` first writes its intermediate result. An output file is either unchanged, complete
or a study that can be resumed, and a resumed study ends with the same bits as an uninterrupted run. Prints a table;
exit code 1 if a command was late or a file was lost.
"""

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import campaign

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
STOPS = os.path.join(ROOT, "tests/data/stops")
MECHANISMS = os.path.join(ROOT, "experiments/mechanisms")
MAX_DELAY = 3  # [s]: later interrupts of an endless command test nothing new
STOPPED = 3  # exit code
GOUGH_LEGS = "left1=1.15,left2=1.38,left3=1.38,right1=1.43,right2=1.57,right3=1.42"  # m


class Failed(Exception):
    pass


class Command:
    def __init__(self, name, arguments, study=None, file=None, endless=False):
        self.name, self.arguments, self.endless = name, arguments, endless
        self.study = study  # the study file that it writes or resumes
        self.file = file  # another file that it writes
        self.count = dict.fromkeys(("interrupts", "ended before", "late", "lost"), 0)
        self.longest = 0.0
        self.seconds = MAX_DELAY


def commands():
    robot = os.path.join(MECHANISMS, "rotary-delta.toml")
    gough, planar = os.path.join(MECHANISMS, "gough.toml"), os.path.join(MECHANISMS, "3-rrr.toml")
    listed = [Command("run " + name, ["run", name + ".toml", "--output", name + ".h5", "--threads", "2"],
                      study=name + ".h5") for name in campaign.STUDIES]
    listed += [Command("resume " + name, ["resume", name + "-begun.h5"], study=name + "-begun.h5")
               for name in ("ga", "nlopt")]
    return listed + [
        Command("run, slow evaluations", ["run", "slow-evaluations.toml"], study="slow-evaluations.h5", endless=True),
        Command("run, slow exact values", ["run", "endless-exact.toml"], study="endless-exact.h5", endless=True),
        Command("run, seeds", ["run", "ga.toml", "--seeds", "20", "--output", "seeds.h5"]),
        Command("check", ["check", "slow-evaluations.toml"], endless=True),
        Command("evaluate", ["evaluate", "comb.toml", "--set", "w=0.01mm"], endless=True),
        Command("evaluate, certified bounds", ["evaluate", robot, "--certified", "1e-3"], endless=True),
        Command("certify", ["certify", robot, "--gap", "1e-4", "--proof", "p.proof", "--force"], file="p.proof",
                endless=True),
        Command("certify, box", ["certify", gough, "--box", "x=-0.2:0.2,y=-0.2:0.2,z=0.8:1.2"], endless=True),
        Command("tolerances", ["tolerances", planar, "--box", "x=-0.01:0.01,y=-0.01:0.01", "--gap", "1e-4"],
                endless=True),
        Command("workspace", ["workspace", gough, "--cells", "x=100,y=100,z=100"], endless=True),
        Command("forward", ["forward", gough, "--joints", GOUGH_LEGS]),
        Command("report", ["report", "file.h5", "--force", "--output", "page.html"], file="page.html"),
        Command("export", ["export", "file.h5", "--csv", "tables", "--force"]),
        Command("show", ["show", "file.h5"]),
    ]


class Campaign:
    def __init__(self, folder, bound, seed):
        self.folder, self.bound, self.random = folder, bound, random.Random(seed)
        self.digests = {}

    def prepare(self, listed):
        for name in os.listdir(STOPS):
            shutil.copy(os.path.join(STOPS, name), self.folder.path)
        with open(os.path.join(STOPS, "slow-exact.toml"), encoding="utf-8") as file:
            self.folder.write("endless-exact.toml", file.read().replace("[workspace]", '[workspace]\nexact = "1 h"'))
        for name, text in campaign.STUDIES.items():
            self.folder.write(name + ".toml", text)
            code, output = self.folder.run(["run", name + ".toml", "--output", name + ".h5", "--threads", "1"])
            if code != 0:
                sys.exit("%s failed: %s" % (name, output))
            self.digests[name] = campaign.digest(self.folder.file(name + ".h5"))
            shutil.copy(self.folder.file(name + ".h5"), self.folder.file(name + "-uninterrupted.h5"))
        self.folder.run(["report", "file.h5", "--force", "--output", "page.html"])
        for command in listed:
            if command.endless:
                continue
            self.restore(command)
            begin = time.monotonic()
            code, output = self.folder.run(command.arguments)
            if code not in (0, 1):
                sys.exit("%s failed: exit code %s: %s" % (command.name, code, output))
            command.seconds = min(MAX_DELAY, time.monotonic() - begin)

    def restore(self, command):
        """Prepares the files that the command needs."""
        if command.name.startswith("resume"):
            name = command.name.split()[1]
            self.remove(command.study)
            child = self.folder.start(["run", name + ".toml", "--output", command.study])
            while not os.path.exists(self.folder.file(command.study)) and child.poll() is None:
                time.sleep(0.001)
            child.send_signal(signal.SIGINT)
            child.communicate()
        elif command.study:
            self.remove(command.study)
        for name in os.listdir(self.folder.path):
            if name.startswith("seeds-"):
                self.remove(name)

    def remove(self, name):
        if os.path.exists(self.folder.file(name)):
            os.remove(self.folder.file(name))

    def interrupt(self, command):
        self.restore(command)
        before = self.content(command.file)
        wait = self.random.uniform(0, 1.1 * command.seconds)
        by_time = command.arguments[0] in ("run", "resume") and self.random.random() < 0.25
        number = self.random.choice([signal.SIGINT, signal.SIGTERM])
        more = ["--time", "%g" % max(wait, 0.01)] if by_time else []
        begin = time.monotonic()
        child = self.folder.start(command.arguments + more)
        command.count["interrupts"] += 1
        try:
            # A time limit counts from the start of the run: allow one second more for starting the program.
            output = child.communicate(timeout=wait + (1 if by_time else 0))[0]
            command.count["ended before"] += 0 if by_time else 1
        except subprocess.TimeoutExpired:
            begin = time.monotonic()
            if not by_time:
                child.send_signal(number)
            try:
                output = child.communicate(timeout=60)[0]
            except subprocess.TimeoutExpired:
                child.kill()
                child.communicate()
                command.count["late"] += 1
                raise Failed("still running after 60 s") from None
            late = time.monotonic() - begin
            command.longest = max(command.longest, late)
            if late > self.bound + self.seconds_of_result(command):
                command.count["late"] += 1
                raise Failed("ended after %.2f s" % late) from None
        if child.returncode not in (0, 1, STOPPED, 4, -number):
            raise Failed("exit code %s: %s" % (child.returncode, output[-300:]))
        self.check(command, before, output)

    def seconds_of_result(self, command):
        """Additional time for writing the intermediate proof: tens of megabytes, at 50 MB/s."""
        return 2e-8 * len(self.content(command.file) or b"") if command.name == "certify" else 0

    def content(self, name):
        if not name or not os.path.exists(self.folder.file(name)):
            return None
        with open(self.folder.file(name), "rb") as file:
            return file.read()

    def check(self, command, before, output):
        for name in [n for n in os.listdir(self.folder.path) if n.startswith(".pkmopt-")]:
            self.remove(name)
        if command.file:
            after = self.content(command.file)
            whole = after is not None and len(after) > 0
            if after != before and not whole:
                raise Failed("%s was lost" % command.file)
        if not command.study or not os.path.exists(self.folder.file(command.study)):
            if command.name.startswith("resume"):
                raise Failed("the study file was deleted")
            return
        code, shown = self.folder.run(["show", command.study])
        if code not in (0, 4):
            raise Failed("the study file cannot be read: %s" % shown[-300:])
        if command.endless:
            return
        code, resumed = self.folder.run(["resume", command.study])
        name = command.study.removesuffix(".h5").removesuffix("-begun")
        if code != 0 or campaign.digest(self.folder.file(command.study)) != self.digests[name]:
            raise Failed("resumed with exit code %s to a different result: %s" % (code, resumed[-300:]))

    def run(self, listed, interrupts):
        for i in range(interrupts):
            command = listed[i % len(listed)]
            try:
                self.interrupt(command)
            except Failed as what:
                command.count["lost"] += "late" not in str(what) and not str(what).startswith(("ended after", "still"))
                print("%s: %s" % (command.name, what), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--interrupts", type=int, default=22)
    parser.add_argument("--bound", type=float, default=2.0)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    listed = commands()
    with tempfile.TemporaryDirectory(prefix="pkmopt-interrupts-") as path:
        run = Campaign(campaign.Folder(path, arguments.program), arguments.bound, arguments.seed)
        run.prepare(listed)
        begin = time.monotonic()
        run.run(listed, arguments.interrupts)
    print("%-26s%12s%14s%8s%8s%14s" % ("command", "interrupts", "ended before", "late", "lost", "longest [s]"))
    for c in listed:
        print("%-26s%12d%14d%8d%8d%14.3f" % (c.name, *c.count.values(), c.longest))
    total = {key: sum(c.count[key] for c in listed) for key in ("interrupts", "late", "lost")}
    print("%(interrupts)d interrupts, %(late)d late, %(lost)d lost" % total, "in %.0f s" % (time.monotonic() - begin))
    return 1 if total["late"] or total["lost"] else 0


if __name__ == "__main__":
    sys.exit(main())
