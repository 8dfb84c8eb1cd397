#!/usr/bin/python3
"""A study with its mechanism from a file, beside the built-in one.

same_front.py PROGRAM [--seeds S] [--population P] [--generations G]

experiments/3crr-r-cru/volume-coupling-force.toml as it stands, and with experiments/mechanisms/3crr-r-cru.toml, whose
masses are made to follow the lengths as `masses = "geometry"` has them and whose margins are written in metres, as
those of the built-in mechanism are. Coupling on columns of a file has no derivatives, so the gradient stage is the
built-in one's alone. The mean hypervolumes of the genetic algorithm over the seeds have to agree to 0.5 %; the refined
designs of the one and the trade-offs of the other have to be worth the same to both, to 1e-8. Exit code 1 if not.
"""

import argparse
import json
import os
import re
import statistics
import sys
import tempfile
import time

import h5py

import campaign

EXPERIMENTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../experiments")

# name, unit, default of `masses = "geometry"`
MASSES = (("lambda", "kg/m", 0.956353), ("m_0", "kg", -0.0268514), ("kappa", "1", 0.796114),
          ("density_1", "kg/m^2", 21.0881), ("kappa_1", "1", 0.0736616), ("density", "kg/m^2", 18.0441),
          ("kappa_D", "1", 0.121307), ("share", "1", 0.5))


def read(name):
    with open(os.path.join(EXPERIMENTS, name), encoding="utf-8") as file:
        return file.read()


def changed(text, pattern, by):
    """Every place of a pattern, of which there has to be one."""
    text, count = re.subn(pattern, by, text, flags=re.MULTILINE)
    if count == 0:
        sys.exit("nothing in the mechanism's file is like " + pattern)
    return text


def described():
    """The mechanism's file with other masses and margins."""
    text = read("mechanisms/3crr-r-cru.toml")
    text = changed(text, r"^(m_\d\d|I_\w+|m|m_1|c) +=.*\n", "")
    text = changed(text, r"^\[platform\]", "".join(
        '%s = { default = %r, unit = "%s", min = -1e3, max = 1e6 }\n' % (name, value, unit)
        for name, unit, value in MASSES) + "\n[platform]")
    text = changed(text, r'^mass    = "m"', 'mass    = "density*l^2"')
    text = changed(text, r'"x \+ c\*cos\(phi\)", "y \+ c\*sin\(phi\)"',
                   '"x + share*l*cos(phi)", "y + share*l*sin(phi)"')
    text = changed(text, r'\["I_xx", "I_yy", "I_zz"\]', str(["kappa_D*density*l^4"] * 3).replace("'", '"'))
    text = changed(text, r'"m_1"', '"density_1*pi*r^2"')
    text = changed(text, r'\["I_1xx", "I_1yy", "I_1zz"\]', str(["kappa_1*density_1*pi*r^4"] * 3).replace("'", '"'))
    text = changed(text, r'_mass( +)= "m_(\d\d)"', r'_mass\1= "lambda*l_\2 + m_0"')
    text = changed(text, r'_inertia( *)= "I_(\d\d)"', r'_inertia\1= "kappa*(lambda*l_\2 + m_0)*l_\2^2/12"')
    text = changed(text, r'"cos\(phi\) - c_min"\nunit    = "1"', '"l*(cos(phi) - c_min)"\nunit = "m"')
    text = changed(text, r'^\[\[margin\]\]\nname +=.*\nformula = "sqrt\(1 - s_min\^2\) - abs\(k_\d\)"\nunit +=.*\n', "")
    text = changed(text, r"^k_(\d) = .*\n", "")
    # that a root exists is a margin, too: a millionth of it is far from being the least
    aside = ("(y_1 - L)^2 + z_n^2", "x_2^2 + (z_n - L)^2", "x_3^2 + y_3^2", "(x_4 - L)^2 + (z - L)^2")
    margins = ""
    for i, square in enumerate(aside, 1):
        distance = "sqrt(1e6*(%s))/1e3" % square
        reach = "sqrt(1e6*(l_{0}1^2 + l_{0}2^2 {1} 2*l_{0}1*l_{0}2*sqrt(1 - s_min^2)))/1e3"
        for name, formula in (("in", distance + " - " + reach.format(i, "-")),
                              ("out", reach.format(i, "+") + " - " + distance)):
            margins += '[[margin]]\nname = "%s %d"\nformula = "%s"\nunit = "m"\n\n' % (name, i, formula)
    return changed(text, r"\A((?:.|\n)*?)(?=^\[\[margin\]\])", lambda found: found.group(1) + margins)


REFERENCE = 'reference = { workspace-volume = 0, dci = 1, peak-force = "30 N" }'  # of the hypervolume


def studies(population, generations):
    """As it stands, and with the mechanism from a file, which has no gradient stage."""
    own = read("3crr-r-cru/volume-coupling-force.toml")
    own = changed(own, r"^population = \d+", "population = %d\n%s" % (population, REFERENCE))
    own = changed(own, r"^generations = \d+", "generations = %d" % generations)
    file = own[:own.index('[[stage]]\noptimiser = "nlopt"')]
    file = changed(file, r'^type = "3crr-r-cru"\nmasses = .*', 'file = "mechanism.toml"')
    return own, changed(file, r'^margin = "5 mm"', "margin = 0.005")  # margins of files are of different units


def fronts(path):
    """By stage: hypervolumes by generation, names of variables and objectives, designs and what they are worth."""
    with h5py.File(path, "r") as file:
        names = [[name.decode() for name in file["problem"][of]["name"][()]] for of in ("variables", "objectives")]
        stages = [file["stages"][str(k + 1)]["front"] for k in range(int(file["stages"].attrs["count"]))]
        return [(front["hypervolume"][()], *names, front["design"][()], front["objective"][()]) for front in stages]


def difference(folder, study, variables, objectives, designs, values):
    """The largest relative one of `values` and of what a study makes of the designs."""
    largest = 0
    for design, value in zip(designs, values):
        given = ",".join("%s=%r" % pair for pair in zip(variables, map(float, design)))
        code, output = folder.run(["evaluate", study, "--set", given, "--threads", "1", "--json"])
        if code != 0:
            sys.exit("exit code %s: %s" % (code, output))
        found = json.loads(output)["objectives"]
        largest = max([largest] + [abs(found[name] / x - 1) for name, x in zip(objectives, value)])
    return largest


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--population", type=int, default=120)
    parser.add_argument("--generations", type=int, default=60)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as path:
        folder = campaign.Folder(path, options.program)
        folder.write("mechanism.toml", described())
        for name, text in zip(("own", "file"), studies(options.population, options.generations)):
            folder.write(name + ".toml", text)
            begin = time.monotonic()
            code, output = folder.run(["run", name + ".toml", "--seeds", str(options.seeds), "--quiet"], timeout=36000)
            print("%-4s  %.0f s" % (name, time.monotonic() - begin), flush=True)
            if code != 0:
                sys.exit("exit code %s: %s" % (code, output[-2000:]))
        volumes, worst = {"own": [], "file": []}, 0
        print("seed  hypervolume, own  file           refined designs  largest difference")
        for seed in range(1, options.seeds + 1):
            own, file = [fronts(folder.file("%s-seed-%d.h5" % (name, seed))) for name in ("own", "file")]
            volumes["own"].append(own[0][0][-1])
            volumes["file"].append(file[0][0][-1])
            refined = own[-1]
            found = max(difference(folder, "file.toml", *refined[1:]), difference(folder, "own.toml", *file[0][1:]))
            worst = max(worst, found)
            print("%4d  %-16.10g  %-13.10g  %-15d  %.1e"
                  % (seed, volumes["own"][-1], volumes["file"][-1], len(refined[3]), found), flush=True)
    off = statistics.mean(volumes["file"]) / statistics.mean(volumes["own"]) - 1
    print("mean hypervolumes differ by %.2e, designs by %.1e" % (off, worst))
    return 1 if abs(off) > 5e-3 or worst > 1e-8 else 0


if __name__ == "__main__":
    sys.exit(main())
