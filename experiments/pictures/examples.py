#!/usr/bin/env python3
"""Draws the pictures of docs/how-to, docs/concepts and docs/gallery.md: examples.py PROGRAM [NAME ...]

Each picture is drawn from the output of pkmopt, into examples/NAME.svg beside this script. Without NAME all are drawn,
which takes a minute."""
import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402, after the selection of the backend

HERE = Path(__file__).resolve().parent
MECHANISMS = "experiments/mechanisms"
COLOURS = ["#00447c", "#c8501e", "#4c8c2b", "#7a5195"]

# Pictures that pkmopt draws: name -> arguments of `pkmopt workspace`; FIELD stands for the map of that field.
DRAWN = {
    "largest-workspace": "--from rails.h5 --cut theta=0",
    "slice": "4ppa-2par --cut theta=20deg",
    "map": "4ppa-2par --cut theta=20deg --field conditioning --cells x=24,z=24,theta=2",
    "own-quantity": f"{MECHANISMS}/quantities/orthoglide.toml --cut z=0 --field pressure_angle --cells x=30,y=30,z=2",
    "transmission": f"{MECHANISMS}/rotary-delta.toml --cut y=0 --field lti --cells x=30,y=2,z=30",
    "connect": f"{MECHANISMS}/connectivity/3-rpr.toml --cut phi=60deg",
    "home-pose": f"{MECHANISMS}/connectivity/five-bar.toml",
    "stiffness": f"{MECHANISMS}/quantities/elastic-delta.toml --cut y=0 --field stiffness --cells x=30,y=2,z=30",
    "natural-frequencies": f"{MECHANISMS}/quantities/elastic-delta.toml --cut y=0 --field natural_frequency "
                           "--cells x=30,y=2,z=30",
    "acceleration": f"{MECHANISMS}/quantities/elastic-delta.toml --cut y=0 --field effective_mass --cells x=30,y=2,z=30",
    "cable-robot": f"{MECHANISMS}/cables/cogiro.toml --set m_payload=50kg --cut z=1 --field tension_reserve "
                   "--cells x=28,y=20,z=2",
    "tool-error": f"{MECHANISMS}/five-bar.toml --joint-error 0.01deg --field accuracy --cells x=30,y=30",
    "obstacles": "cell.toml --cut y=0.1 --cells x=80,y=2,z=80",
    "gough": f"{MECHANISMS}/gough.toml --cut z=1.2",
    "orthoglide": f"{MECHANISMS}/orthoglide.toml --cut z=0",
    "linear-delta": f"{MECHANISMS}/linear-delta.toml --cut y=0 --field conditioning --cells x=30,y=2,z=30",
    "par4": f"{MECHANISMS}/par4.toml --cut y=0",
    "3-rrr": f"{MECHANISMS}/3-rrr.toml",
    "2t1r-p-hybrid": "2t1r-p-hybrid --cut beta=0",
    "quadrupteron": "quadrupteron --cut z=0.21",
}


class Program:
    """Runs pkmopt in a temporary folder with a link to the experiments."""

    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)
        (self.folder / "experiments").symlink_to(HERE.parent)
        self.done = set()
        self.page_block("obstacles", "cell.toml")
        self.page_block("certified-cycle", "high.toml")
        self.page_block("buckling", "cycle.toml")

    def page_block(self, page, name):
        """Write the block with the caption `name` of a page in docs/how-to to a file."""
        text = (HERE.parents[1] / "docs" / "how-to" / f"{page}.md").read_text()
        (self.folder / name).write_text(text.split(f":caption: {name}\n")[1].split("```")[0])

    def __call__(self, arguments):
        done = subprocess.run([self.program, *arguments.split()], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                              check=True)
        return done.stdout

    def study(self, file, name):
        """Run a study once; return the open study file."""
        if name not in self.done:
            self(f"run {file} -o {name} --quiet")
            self.done.add(name)
        return h5py.File(self.folder / name)

    def table(self, arguments):
        """Columns of the CSV file that a command writes."""
        self(f"{arguments} --csv table.csv --force")
        with open(self.folder / "table.csv") as file:
            rows = list(csv.DictReader(file))
        return {key: [row[key] for row in rows] for key in rows[0]}


def numbers(column):
    return np.array([float(value or "nan") for value in column])


def axes(width=5.2, height=3.0):
    figure, plot = plt.subplots(figsize=(width, height), layout="constrained")
    plot.spines[["top", "right"]].set_visible(False)
    plot.grid(alpha=0.25, linewidth=0.6)
    return plot


def bars(labels, values, xlabel, signs=False):
    plot = axes(5.2, 0.5 + 0.3 * len(labels))
    colours = [COLOURS[value < 0] for value in values] if signs else COLOURS[0]
    plot.barh(labels, values, color=colours, height=0.6)
    plot.invert_yaxis()
    plot.set_xlabel(xlabel)
    plot.axvline(0, color="black", linewidth=0.8)


def front(study, xlabel, ylabel):
    stage = study["stages/1"]
    values = stage["front/objective"][:]
    plot = axes()
    plot.plot(*values[np.argsort(values[:, 0])].T, "o-", color=COLOURS[0], markersize=3, linewidth=0.8)
    plot.set_xlabel(xlabel)
    plot.set_ylabel(ylabel)


def sensitivity(run):
    run.study("experiments/4ppa-2par/rails.toml", "rails.h5")
    text = re.split(r"others fixed +reoptimised\n", run("show rails.h5"))[1].split("\n\n")[0]
    rows = [line.split() for line in text.splitlines()]  # name, varies or fixed, mm, derivative
    bars([row[0] for row in rows], [float(row[3]) for row in rows], "change of the workspace [m$^2$ rad per mm]",
         signs=True)


def footprint(run):
    front(run.study("experiments/4ppa-2par/floor.toml", "floor.h5"), "workspace [m$^2$ rad]", "floor area [m$^2$]")


def shorter_cycle(run):
    front(run.study(f"{MECHANISMS}/motors/time-against-energy.toml", "time.h5"), "duration of the cycle [s]",
          "energy per cycle [J]")


def motor(run):
    rows = run.table(f"trajectory {MECHANISMS}/motors/rotary-delta.toml --motion cycle")
    plot = axes()
    for i in (1, 2, 3):
        plot.plot(numbers(rows["time"]), numbers(rows[f"arm{i}_motor_torque"]), color=COLOURS[i - 1], label=f"arm{i}",
                  linestyle="--" if i == 3 else "-")
    plot.set_xlabel("time [s]")
    plot.set_ylabel("torque of the motor [N m]")
    plot.legend(frameon=False)


def fastest_cycle(run):
    plot = axes()
    for law, label, colour in (("", "time-optimal", 0), (" --law own", "polynomial of degree 5, scaled", 1)):
        rows = run.table(f"trajectory {MECHANISMS}/motors/fastest-delta.toml --motion cycle --fastest{law}")
        plot.plot(numbers(rows["time"]), numbers(rows["arm1_speed"]), color=COLOURS[colour], label=label)
    plot.set_xlabel("time [s]")
    plot.set_ylabel("speed of arm1 [rad/s]")
    plot.legend(frameon=False)


def certified_cycle(run):
    rows = run.table(f"trajectory {MECHANISMS}/motors/rotary-delta.toml --motion high.toml --allow-infeasible")
    plot = axes()
    for i in (1, 2, 3):
        plot.plot(numbers(rows["time"]), np.degrees(numbers(rows[f"arm{i}"])), color=COLOURS[i - 1], label=f"arm{i}",
                  linestyle="--" if i == 3 else "-")
    plot.axhline(-40, color="black", linewidth=0.8)
    plot.annotate("minimum -40 deg", (0, -40), xytext=(0, 3), textcoords="offset points")
    plot.set_xlabel("time [s]")
    plot.set_ylabel("crank angle [deg]")
    plot.legend(frameon=False)


def joint_forces(run):
    joints = ("arm1.A", "arm1.C 1", "arm1.B 1")
    run('trajectory %s/motors/rotary-delta.toml --motion cycle --reactions --csv joints.csv --force' % MECHANISMS)
    with open(run.folder / "joints.csv") as file:
        rows = list(csv.DictReader(file))
    plot = axes()
    for joint, colour in zip(joints, COLOURS):
        force = np.linalg.norm([[float(row[f"{joint}_F{axis}"]) for row in rows] for axis in "xyz"], axis=0)
        plot.plot([float(row["time"]) for row in rows], force, color=colour, label=joint)
    plot.set_xlabel("time [s]")
    plot.set_ylabel("force in the joint [N]")
    plot.legend(frameon=False)


def start_from(run):
    run.study("experiments/4ppa-2par/floor.toml", "floor.h5")
    run.page_block("start-from", "ratio.toml")
    run("run ratio.toml --start-from floor.h5 --quiet --force")
    with h5py.File(run.folder / "ratio.h5") as study:
        values = study["stages/1/evaluations/objective"][:, 0]
    plot = axes()
    plot.plot(range(1, len(values) + 1), values, "o-", color=COLOURS[0], markersize=3, linewidth=0.8)
    plot.set_xlabel("evaluation")
    plot.set_ylabel("workspace ratio [rad]")


def yields(run):
    run.study(f"{MECHANISMS}/tolerances/delta-nominal.toml", "nominal.h5")
    run.study(f"{MECHANISMS}/tolerances/delta-robust.toml", "robust.h5")
    shares = []
    for name in ("nominal.h5", "robust.h5"):
        shares.append(100 * json.loads(run(f"evaluate --from {name} --samples 100000 --json"))["yield"]["share"])
    bars(["nominal optimum", "robust design"], shares, "machines that do the task [%]")


def tolerances(run):
    task = f"tolerances {MECHANISMS}/par4.toml --box x=-100mm:100mm,y=-100mm:100mm,z=-550mm:-450mm"
    plot = axes()
    for i, (option, label) in enumerate((("", "equal tolerances"), (" --free", "proportions of minimum cost"))):
        rows = run.table(task + option)
        names = rows[list(rows)[0]]
        column = next(key for key in rows if key.startswith("certified") or key.startswith("tolerance"))
        plot.bar(np.arange(len(names)) + 0.4 * i - 0.2, 1e3 * numbers(rows[column]), 0.38, color=COLOURS[i],
                 label=label)
    plot.set_xticks(range(len(names)), names)
    plot.set_ylabel("certified tolerance [mm]")
    plot.legend(frameon=False, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1))


def motor_and_gear(run):
    run.study(f"{MECHANISMS}/motors/chosen-drive.toml", "drive.h5")
    run("export drive.h5 --csv drive --force")
    with open(run.folder / "drive" / "evaluations.csv") as file:
        rows = list(csv.DictReader(file))
    time = next(key for key in rows[0] if key.startswith("objective cycle-time"))
    motors, gears = (list(dict.fromkeys(sorted((r[key] for r in rows), key=lambda t: float(t.split()[0].split(":")[0]))))
                     for key in (next(k for k in rows[0] if k.startswith(name)) for name in ("motor", "gear")))
    best = np.full((len(motors), len(gears)), np.nan)
    for row in rows:
        if row["status"] == "feasible" and row[time]:
            i, j = motors.index(row["motor"]), gears.index(row["gear"])
            best[i, j] = np.nanmin([best[i, j], float(row[time])])
    figure, plot = plt.subplots(figsize=(5.2, 2.6), layout="constrained")
    picture = plot.imshow(best, cmap="cividis_r", aspect="auto", vmax=1)
    plot.set_xticks(range(len(gears)), gears)
    plot.set_yticks(range(len(motors)), motors)
    for (i, j), value in np.ndenumerate(best):
        if np.isfinite(value):
            plot.text(j, i, f"{value:.3g}", ha="center", va="center", fontsize=7,
                      color="white" if value > 0.6 else "black")
    figure.colorbar(picture, label="shortest cycle found [s]")


def solid(run, slice_of, field, threshold, box, labels):
    """A map of a field with the outline of a solid."""
    rows = run.table(slice_of)
    keys = list(rows)
    x, z = numbers(rows[keys[0]]), numbers(rows[keys[1]])  # of the slice; the third column is the fixed coordinate
    grid = [np.unique(x), np.unique(z)]
    values = np.full((len(grid[1]), len(grid[0])), np.nan)
    column = next(key for key in keys if key.split()[0] == field)
    inside = np.array([value not in ("0", "no") for value in rows["feasible"]])
    shown = np.where(inside, numbers(rows[column]), np.nan)
    values[np.searchsorted(grid[1], z), np.searchsorted(grid[0], x)] = shown
    plot = axes(4.6, 3.6)
    levels = plot.contourf(grid[0] * 1e3, grid[1] * 1e3, values, levels=9, cmap="cividis")
    plot.figure.colorbar(levels, label=field)
    plot.contour(grid[0] * 1e3, grid[1] * 1e3, values, levels=[threshold], colors="white", linewidths=1)
    reached = np.isfinite(values)
    plot.set_xlim(*(1e3 * grid[0][reached.any(axis=0)][[0, -1]]))
    plot.set_ylim(*(1e3 * grid[1][reached.any(axis=1)][[0, -1]]))
    (left, right), (low, high) = box
    plot.plot([left, right, right, left, left], [low, low, high, high, low], color="#c8501e", linewidth=2)
    plot.set_aspect("equal")
    plot.set_xlabel(labels[0])
    plot.set_ylabel(labels[1])


def largest_box(run):
    run("new mechanism my-robot -o robot.toml --force")
    solid(run, "workspace robot.toml --cut y=0 --cells x=60,y=2,z=60", "conditioning", 0.3, ((-126.8, 116.8), (-594.1, -350.6)),
          ("x [mm]", "z [mm]"))


def smallest_robot(run):
    run.study(f"{MECHANISMS}/quantities/rotary-delta-cylinder.toml", "cylinder.h5")
    solid(run, "workspace --from cylinder.h5 --cut y=0 --cells x=60,y=2,z=60", "lti", 0.5, ((-300, 300), (-424, -224)),
          ("x [mm]", "z [mm]"))


def parameter_influence(run):
    ranges = {"a": (0.15, 0.95), "b": (0.35, 1.55), "l_u": (0.25, 1.5), "l_d": (0.25, 1.5)}  # table 5 of the paper
    plot = axes()
    for (name, limits), colour in zip(ranges.items(), COLOURS):
        lengths = np.linspace(*limits, 41)
        volumes = [json.loads(run(f"evaluate 4ppa-2par --set {name}={length:.6g} --json"))["workspace"]["volume"]
                   for length in lengths]
        plot.plot(lengths, volumes, color=colour, label=name)
    plot.set_xlabel("length [m]")
    plot.set_ylabel("workspace [m$^2$ rad]")
    plot.legend(frameon=False)


def voxel_noise(run):
    lengths = np.linspace(0.55, 0.56, 81)
    plot = axes()
    for method, label, colour in (("workspace 4ppa-2par --cells x=32,z=34,theta=60", "voxels, 32 x 34 x 60 cells", 1),
                                  ("evaluate 4ppa-2par", "columns", 0)):
        values = []
        for length in lengths:
            answer = json.loads(run(f"{method} --set l_d={length} --json"))
            values.append(answer.get("workspace", answer)["volume"])
        plot.plot(1e3 * lengths, values, color=COLOURS[colour], label=label, drawstyle="steps-mid" if colour else None)
    plot.set_xlabel("length of the lower bars l_d [mm]")
    plot.set_ylabel("workspace [m$^2$ rad]")
    plot.legend(frameon=False)


def slice_areas(run):
    heights = np.linspace(0.95, 1.75, 81)
    study = f"workspace {MECHANISMS}/gough.toml --cells x=200,y=200,z=2 --json --cut z="
    areas = [json.loads(run(f"{study}{height:.6g}"))["volume"] for height in heights]
    plot = axes()
    plot.plot(heights, areas, color=COLOURS[0])
    plot.set_xlabel("height z [m]")
    plot.set_ylabel("area of the slice [m$^2$]")


def certified_bounds(run):
    gaps = (0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
    answers = [json.loads(run(f"certify {MECHANISMS}/orthoglide.toml --gap {gap} --json")) for gap in gaps]
    boxes = [answer["boxes"] for answer in answers]
    plot = axes()
    for bound, colour in (("upper", 1), ("lower", 0)):
        plot.semilogx(boxes, [1e3 * answer["volume"][bound] for answer in answers], "o-", color=COLOURS[colour],
                      markersize=3, label=f"{bound} bound")
    plot.set_xlabel("boxes")
    plot.set_ylabel("volume [dm$^3$]")
    plot.legend(frameon=False)


PLOTTED = {
    "slice-areas": slice_areas,
    "certified-volume": certified_bounds,
    "sensitivity": sensitivity,
    "workspace-against-footprint": footprint,
    "shorter-cycle": shorter_cycle,
    "motor": motor,
    "fastest-cycle": fastest_cycle,
    "certified-cycle": certified_cycle,
    "joint-forces": joint_forces,
    "start-from": start_from,
    "yield": yields,
    "certified-tolerances": tolerances,
    "motor-and-gear": motor_and_gear,
    "largest-box": largest_box,
    "smallest-robot": smallest_robot,
    "parameter-influence": parameter_influence,
    "voxel-noise": voxel_noise,
}


def shorten(path, decimals):
    """Round the coordinates of an SVG file, in pixels."""
    def rounded(data):
        return re.sub(r"-?\d+\.\d+", lambda number: f"{float(number[0]):.{decimals}f}", data[0])

    text = re.sub(r"\bd=\"[^\"]*\"", rounded, path.read_text())
    path.write_text("\n".join(line.rstrip() for line in text.splitlines()) + "\n")


def main():
    program, *names = sys.argv[1:]
    plt.rcParams.update({"svg.hashsalt": "pkmopt", "svg.fonttype": "none", "font.size": 9,
                         "font.family": "sans-serif", "axes.axisbelow": True})
    (HERE / "examples").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        run = Program(Path(program).resolve(), folder)
        for name in names or [*DRAWN, *PLOTTED]:
            target = HERE / "examples" / f"{name}.svg"
            if name in DRAWN:
                if "rails.h5" in DRAWN[name]:
                    run.study("experiments/4ppa-2par/rails.toml", "rails.h5")
                run(f"workspace {DRAWN[name]} -o {target} --force")
            else:
                PLOTTED[name](run)
                plt.savefig(target, metadata={"Date": None})
                plt.close()
            shorten(target, 0 if "--field" in DRAWN.get(name, "") else 1)
            print(target)


if __name__ == "__main__":
    main()
