#!/usr/bin/python3
"""Studies killed by SIGKILL at random times and resumed until they are finished.

kills.py PROGRAM UNRELIABLE_DISK [--kills N] [--seed S]

Covers all optimisers, 1 and 2 threads, checkpoint intervals from each generation to seconds and automatic ones, on a
sound, a slow and a full disk. After each kill the study file is complete or does not exist yet, and the resumed study
ends with the same bits as an uninterrupted run. Prints a table; exit code 1 if a study was lost.
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

EVERY = ["", "0", "0.02", "0.3", "2"]
DISKS = ["sound", "slow", "full"]


class Lost(Exception):
    pass


class Campaign:
    def __init__(self, folder, library, seed):
        self.folder, self.library, self.random = folder, library, random.Random(seed)
        self.uninterrupted = {}
        self.count = {name: dict.fromkeys(("studies", "kills", "before", "full", "lost"), 0)
                      for name in campaign.STUDIES}

    def measure(self):
        for name, text in campaign.STUDIES.items():
            self.folder.write("uninterrupted.toml", text)
            begin = time.monotonic()
            code, output = self.folder.run(["run", "uninterrupted.toml", "--output", name + ".h5", "--threads", "1"])
            if code != 0:
                sys.exit("%s failed: %s" % (name, output))
            self.uninterrupted[name] = (time.monotonic() - begin, campaign.digest(self.folder.file(name + ".h5")))

    def variables(self, kind):
        if kind == "slow":
            return campaign.disk(self.library, self.folder.path, delay_us=self.random.choice([500, 3000, 20000]))
        if kind == "full":
            return campaign.disk(self.library, self.folder.path, fails_at=self.random.randrange(1, 60), fails_for=0)
        return {}

    def one_study(self, name, limit):
        """Kills and resumes one study until it is finished, at most `limit` times. Returns the number of kills."""
        seconds, digest = self.uninterrupted[name]
        count = self.count[name]
        every = self.random.choice(EVERY)
        self.folder.write("study.toml", campaign.STUDIES[name] + ("[checkpoint]\nevery = %s\n" % every if every else ""))
        file = self.folder.file("study.h5")
        for left in os.listdir(self.folder.path):
            if left.startswith(("study.h5", ".pkmopt-")):
                os.remove(self.folder.file(left))
        count["studies"] += 1
        kills, seen = 0, False
        while True:
            kind = self.random.choice(DISKS) if kills < limit else "sound"
            threads = ["--threads", str(self.random.choice([1, 2]))]
            first = ["run", "study.toml", "--output", "study.h5"]
            if seen and not os.path.exists(file):
                raise Lost("the study file was deleted")
            seen = os.path.exists(file)
            child = self.folder.start((["resume", "study.h5"] if seen else first) + threads, self.variables(kind))
            try:
                # Random times: early kills hit the start of a run, late ones its course.
                output = child.communicate(timeout=self.random.uniform(0, 1.2 * seconds) if kills < limit else 600)[0]
            except subprocess.TimeoutExpired:
                child.send_signal(signal.SIGKILL)
                child.communicate()
                kills += 1
                count["before"] += not os.path.exists(file)
                if kills > limit:
                    raise Lost("still running after 600 s") from None
                continue
            if child.returncode == 0:
                break
            if kind != "full" or child.returncode != 1 or "No space left on device" not in output:
                raise Lost("exit code %d on a %s disk: %s" % (child.returncode, kind, output[-500:]))
            count["full"] += 1
        if campaign.state(file) != "finished" or campaign.digest(file) != digest:
            raise Lost("the result differs from the uninterrupted run")
        return kills

    def run(self, kills):
        done, share = 0, -(-kills // len(campaign.STUDIES))
        while done < kills:
            for name in campaign.STUDIES:
                if done >= kills:
                    break
                try:
                    count = self.one_study(name, min(10, share, kills - done))
                except Lost as what:
                    count = 1
                    self.count[name]["lost"] += 1
                    kept = tempfile.mkdtemp(prefix="pkmopt-lost-")
                    shutil.copytree(self.folder.path, kept, dirs_exist_ok=True)
                    print("%s: %s; its files: %s" % (name, what, kept), flush=True)
                done += count
                self.count[name]["kills"] += count


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("unreliable_disk")
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="pkmopt-kills-") as path:
        run = Campaign(campaign.Folder(path, arguments.program), arguments.unreliable_disk, arguments.seed)
        run.measure()
        begin = time.monotonic()
        run.run(arguments.kills)
    print("%-8s%10s%8s%22s%12s%8s" % ("study", "studies", "kills", "before the first file", "disk full", "lost"))
    for name, count in run.count.items():
        print("%-8s%10d%8d%22d%12d%8d" % (name, *(count[c] for c in ("studies", "kills", "before", "full", "lost"))))
    total = {c: sum(count[c] for count in run.count.values()) for c in ("studies", "kills", "lost")}
    print("%(kills)d kills of %(studies)d studies, %(lost)d lost" % total, "in %.0f s" % (time.monotonic() - begin))
    return 1 if total["lost"] else 0


if __name__ == "__main__":
    sys.exit(main())
