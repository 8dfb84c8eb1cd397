#!/usr/bin/python3
"""Checks the computational complexity of commands in the size of their input file.

check_costs.py PROGRAM CHECKER

Each command runs on files with n and with 4 n entries. The ratio of the CPU times, which hardly depends on the
machine, shows the order of growth: 4 is linear, 16 quadratic, 64 cubic. The limits lie between two orders, so that
caches and other work on the machine do not decide. For links the limit allows quadratic growth, because the number
of pairs of links is quadratic. Exit code 1 if a ratio exceeds its limit.
"""

import os
import resource
import subprocess
import sys
import tempfile

HEAD = """[mechanism]
name = "many"
[parameters]
w = { default = 0.5, min = 0.1, max = 3, unit = "m" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
sweep = ["x", "y"]
box = { x = [0, 1], y = [0, 1] }
"""
LIMB = """[[limb]]
name = "a"
drive = "formula"
joints = { p = "x", q = "y" }
unit = "m"
"""
LINK = '[[link]]\nname = "l%d"\nfrom = ["x", %d, 0]\nto = ["x + 1", %d, 0]\nradius = 0.1\ngroup = "g%d"\nmass = 1\n'
MARGIN = '[[margin]]\nname = "m"\nformula = "%s"\nunit = "1"\n'


def links(n):
    return HEAD + LIMB + MARGIN % "x" + "".join(LINK % (i, i, i, i // 2) for i in range(n))


def lets(n):
    """A chain of definitions, each used twice, so that proofs contain all of them as named subexpressions."""
    chain = "".join('a%d = "a%d + %d*y*a%d"\n' % (i, i - 1, i, max(i - 2, 0)) for i in range(1, n))
    return HEAD + '[let]\na0 = "x"\n' + chain + LIMB + MARGIN % ("min(a%d, x - 0.5)" % (n - 1))


def proof(n):
    chain = "".join("let n%d = (n%d + (x * n%d))\n" % (i, i - 1, max(i - 2, 0)) for i in range(1, n))
    head = "pkmopt proof 1\nvolume 0 2\naxis x 0 1\nlet n0 = x\n"
    return head + chain + "condition n%d\nboxes\nn.\nend\n" % (n - 1)


def cpu_seconds(command, folder):
    shortest = None
    for _ in range(2):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            sys.exit("%s: exit code %d: %s" % (" ".join(command), done.returncode, done.stdout[-2000:]))
        spent = after.ru_utime - before.ru_utime
        shortest = spent if shortest is None else min(shortest, spent)
    return shortest


def main():
    program, checker = (os.path.abspath(path) for path in sys.argv[1:3])
    cases = [
        ("check, links", links, 150, 32, [program, "check"]),
        ("check, [let]", lets, 20000, 12, [program, "check"]),
        ("certify --proof, [let]", lets, 5000, 12,
         [program, "certify", "--boxes", "1", "--gap", "1.99", "--proof", "a.proof", "--force", "--threads", "1"]),
        ("check of a proof", proof, 10000, 12, [checker]),
    ]
    failed = False
    print("%-24s %8s  CPU seconds     for four times as many  ratio  limit" % ("command", "entries"))
    with tempfile.TemporaryDirectory() as folder:
        for name, make, n, limit, command in cases:
            paths = []
            for count in (n, 4 * n):
                paths.append(os.path.join(folder, "%d.%s" % (count, "toml" if command[0] == program else "proof")))
                with open(paths[-1], "w", encoding="utf-8") as file:
                    file.write(make(count))
            seconds = [float("inf")] * 2
            for _ in range(3):  # other work on the machine may disturb a measurement
                seconds = [min(old, cpu_seconds([*command, path], folder)) for old, path in zip(seconds, paths)]
                ratio = seconds[1] / max(seconds[0], 1e-3)
                if ratio <= limit:
                    break
            failed = failed or ratio > limit
            print("%-24s %8d  %11.3f  %25.3f  %5.1f  %5.1f" % (name, n, *seconds, ratio, limit), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
