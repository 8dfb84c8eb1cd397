"""speed.py OUT.svg: a bar chart of the designs evaluated per second by pkmopt and by other optimisation tools.

The rates are read from benchmarks/README.md, where benchmarks/peers/run.sh writes them; that of the paper's own program
is 2020 designs in 112.67 s. There is one bar per tool and evaluator, for the fastest of the tool's optimisers.
  speed.py experiments/pictures/speed.svg
"""
import html
import re
import sys
from pathlib import Path

FIGURES = Path(__file__).resolve().parents[2] / "benchmarks" / "README.md"
PAPER = ("the paper's own program", 2020 / 112.67)
EVALUATORS = {"C++ loop": "a loop in C++", "columns": "exact columns", "voxels": "the grid's voxels"}
WIDTH, ROW, NAMES = 860, 30, 330  # of the picture, of a row, and of the column of names [px]


def rates():
    """{label: designs per second} from the table of the paper's problem; exact columns are listed for pkmopt only."""
    table = FIGURES.read_text().split("The paper's problem\n")[1].split("The wide-bounds problem\n")[0]
    found = {}
    for tool, evaluator, rate in re.findall(r"^\| ([^|]+) \| ([^|]+) \| \*{0,2}(\d+)\*{0,2} \|", table, re.M):
        tool = tool.split()[0] if tool != "GNU Octave ga" else "GNU Octave"
        if evaluator != "columns" or tool == "pkmopt":
            evaluator = "" if evaluator == "Octave" else ", " + EVALUATORS.get(evaluator, evaluator)
            found[tool + evaluator] = max(float(rate), found.get(tool + evaluator, 0))
    return dict(sorted([*found.items(), PAPER], key=lambda pair: -pair[1]))


def picture():
    bars = rates()
    fastest, height = max(bars.values()), ROW * len(bars) + 62
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" role="img">',
           "<title>Designs evaluated per second on the paper's problem</title>",
           "<style>svg { --paper: #fff; --ink: #24292f; --other: #8c959f; --ours: #2f8f5b }\n"
           "@media (prefers-color-scheme: dark) { svg { --paper: #161b22; --ink: #e6edf3; --ours: #6fcf97 } }\n"
           "text { font: 16px sans-serif; fill: var(--ink) } .ours { fill: var(--ours) } .other { fill: var(--other) }"
           "</style>", '<rect width="100%" height="100%" rx="10" fill="var(--paper)"/>',
           '<text x="24" y="32" font-weight="bold">Designs evaluated per second: workspaces of 4PPa-2PaR on 32 x 34 x '
           "60 voxels, or exact</text>"]  # fmt: skip
    for row, (name, rate) in enumerate(bars.items()):
        y, length = 50 + ROW * row, max((WIDTH - NAMES - 100) * rate / fastest, 1.5)
        out.append(f'<text x="{NAMES - 10}" y="{y + 17}" text-anchor="end">{html.escape(name)}</text>'
                   f'<rect class="{"ours" if name.startswith("pkmopt") else "other"}" x="{NAMES}" y="{y}" '
                   f'width="{length:.1f}" height="{ROW - 8}"/>'
                   f'<text x="{NAMES + length + 8:.1f}" y="{y + 17}">{rate:,.0f}</text>')  # fmt: skip
    return "\n".join(out) + "\n</svg>\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(picture())
