"""Formats the measurements as a Markdown table."""

import math
from dataclasses import dataclass
from statistics import median


@dataclass(frozen=True)
class Row:
    """An optimiser with an evaluator: its searches, one per seed, and runs of 100 generations with their process costs.

    Medians are over the seeds; a search that did not reach the target counts as infinitely long.
    """

    name: str
    evaluator: str
    searches: list
    generations: list
    costs: list
    optimum: float

    def rate(self):
        return median(each["candidates"] / each["seconds"] for each in self.generations)

    def found(self):
        return sum(each["reached"] for each in self.searches)

    def evaluations(self):
        return self._until_reached("tried")

    def cpu(self):
        return self._until_reached("cpu")

    def missing(self):
        """Median gap of the best ratio to the optimum [%]; infinite (not shown) if most searches reached the target."""
        gap = median(1 - each["best"] / self.optimum for each in self.searches)
        return math.inf if math.isfinite(self.evaluations()) else 100 * gap

    def wall(self):
        return median(each.wall for each in self.costs)

    def tried(self):
        """Candidates of 100 generations; fewer than 2020 if an optimiser stops earlier or creates duplicates."""
        return median(each["candidates"] for each in self.generations)

    def memory(self):
        return max(each.memory for each in self.costs)

    def _until_reached(self, what):
        return median(each[what] if each["reached"] else math.inf for each in self.searches)


# Heading, value, function that selects the best value (printed in bold), and format.
COLUMNS = (
    ("candidates/s", Row.rate, max, "{:.0f}"),
    ("found", Row.found, max, "{}"),
    ("evaluations", Row.evaluations, min, "{:.0f}"),
    ("CPU, s", Row.cpu, min, "{:.3f}"),
    ("missing, %", Row.missing, None, "{:.2g}"),
    ("100 generations, s", Row.wall, None, "{:.2f}"),
    ("their candidates", Row.tried, None, "{:.0f}"),
    ("memory, MiB", Row.memory, min, "{:.0f}"),
)


def print_table(title, groups):
    """Prints the rows of all groups; the best values of each group are in bold."""
    print(f"\n{title}\n")
    lines = [["", "evaluator", *(heading for heading, *_ in COLUMNS)]]
    lines.append(["-"] * len(lines[0]))
    for rows in groups:
        values = [_column(rows, *column[1:]) for column in COLUMNS]
        lines += [[row.name, row.evaluator, *cells] for row, *cells in zip(rows, *values)]
    for line in lines:
        print("| " + " | ".join(line) + " |")


def _column(rows, value, best, form):
    values = [value(row) for row in rows]
    texts = [form.format(each) if math.isfinite(each) else "-" for each in values]
    winner = form.format(best(values)) if best else None
    return [f"**{text}**" if text == winner else text for text in texts]
