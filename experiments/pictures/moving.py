"""moving.py PROGRAM OUT.svg: animation of the rotary Delta in a slice of its workspace, coloured by conditioning.

All data come from the program: the slice is a table of `pkmopt workspace`, the surface behind it the STL file, and the
joint values are the table of `pkmopt trajectory`. The links are computed from the joint values; the script asserts that
their lengths stay constant. Needs numpy.
  moving.py build/quickstart/bin/pkmopt experiments/pictures/moving.svg
"""
import csv
import itertools
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

FILE = Path(__file__).resolve().parents[1] / "mechanisms" / "rotary-delta.toml"
R, r, L_A, L_B = 0.2, 0.05, 0.2, 0.5  # its nominal lengths [m]
PAIR = 0.045  # distance between the rods of a pair, for drawing only [m]
MOTION = """type = "formulas"
duration = 5
x = "0.24*sin(2*pi*t/5)"
y = 0
z = "-0.45 + 0.085*cos(4*pi*t/5) - 0.02*sin(2*pi*t/5)"
"""
SECONDS, SAMPLES = 5, 91
LEVELS = np.arange(0.15, 0.7, 0.05)  # contour levels of the conditioning
COLOURS = np.array([[68, 50, 126], [33, 145, 140], [253, 216, 84]])  # of the lowest, the middle and the highest level
SHADES = 14  # number of grey levels of the surface behind the slice
TURN, UP = np.radians([-66, 17])  # direction of the viewer: azimuth and elevation
WIDTH = 860  # [px]


def table(program, folder, *arguments):
    """{column: values} of the CSV table that a command writes."""
    file = Path(folder, "table.csv")
    subprocess.run([program, *arguments, "--csv", file, "--force"], check=True, stdout=subprocess.DEVNULL)
    with open(file) as text:
        rows = list(csv.DictReader(text))
    return {name.split(" ")[0]: np.array([float(row[name] or "nan") for row in rows])
            for name in rows[0] if name != "reason"}  # fmt: skip


def field(cells, name, first, second):
    """The values of a field on the grid of two coordinates; NaN where there is no cell."""
    u, v = np.unique(cells[first]), np.unique(cells[second])
    grid = np.full((len(u), len(v)), np.nan)
    grid[np.searchsorted(u, cells[first]), np.searchsorted(v, cells[second])] = cells[name]
    return u, v, grid


def extrapolated(grid):
    """Replaces NaN by means of neighbours, so that contour lines extend beyond the boundary of the workspace."""
    grid = grid.copy()
    while np.isnan(grid).any():
        padded = np.pad(grid, 1, constant_values=np.nan)
        neighbours = np.stack([padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]])
        known = ~np.isnan(neighbours)
        mean = np.where(known, neighbours, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
        grid = np.where(np.isnan(grid) & known.any(axis=0), mean, grid)
    return grid


def outlines(u, v, grid, level=0.0):
    """Closed contour lines around the region above the level (marching squares), smoothed by a mean of three points."""
    step = np.array([u[1] - u[0], v[1] - v[0]])
    above = np.pad(np.clip(grid - level, -0.01, 0.01), 1, constant_values=-1e-9)  # margins may jump
    crossings, follows = {}, {}
    for i in range(above.shape[0] - 1):
        for j in range(above.shape[1] - 1):
            nodes = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            inside = [above[c] > 0 for c in nodes]
            entries, exits = [], []
            for k in range(4):
                a, b = nodes[k], nodes[(k + 1) % 4]
                if inside[k] == inside[(k + 1) % 4]:
                    continue
                edge = (min(a, b), max(a, b))
                share = above[edge[0]] / (above[edge[0]] - above[edge[1]])
                crossings[edge] = np.array(edge[0]) + share * (np.array(edge[1]) - edge[0])
                (exits if inside[k] else entries).append(edge)
            follows.update(zip(exits, entries[::-1] if len(exits) > 1 else entries))
    while follows:
        edge, line = next(iter(follows)), []
        while edge in follows:
            line.append(crossings[edge])
            edge = follows.pop(edge)
        line = (np.roll(line, 1, axis=0) + line + np.roll(line, -1, axis=0)) / 3
        yield (line - 1) * step + [u[0], v[0]]


def links(joints, at):
    """{name: polylines, one per sample} of cranks with the pins of their rods, of rods, platform and base."""
    found = {}
    for limb in range(3):
        turn = 2 * np.pi * limb / 3
        out, across, down = (np.array(axis) for axis in (
            [np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, -1]))  # fmt: skip
        angle = joints[limb][:, None]
        elbow = R * out + L_A * (np.cos(angle) * out + np.sin(angle) * down)
        wrist = at + r * out
        assert abs(np.linalg.norm(wrist - elbow, axis=1) - L_B).max() < 1e-9, "the length of the rods must be constant"
        half = PAIR / 2 * across
        found[f"arm {limb}"] = np.stack([0 * elbow + R * out, elbow, elbow - half, elbow + half], axis=1)
        for side, shift in enumerate((-half, half)):
            found[f"rod {limb} {side}"] = np.stack([elbow, wrist], axis=1) + shift
            found.setdefault("platform", []).append(wrist + shift)
            found.setdefault("base", []).append(R * out + 2 * shift)
    found["platform"] = np.stack(found["platform"], axis=1)
    found["base"] = np.array(found["base"])
    return found


def surface_behind(program, folder):
    """[(shade, triangle)] of the workspace surface behind the slice that face the viewer, sorted from back to front."""
    subprocess.run([program, "workspace", FILE, "--box", "x=-0.45:0.45,y=0:0.45,z=-0.72:-0.2", "--cells",
                    "x=36,y=18,z=26", "--stl", folder], check=True, stdout=subprocess.DEVNULL)  # fmt: skip
    data = next(Path(folder).glob("*.stl")).read_bytes()[84:]
    facets = np.frombuffer(data, np.dtype([("normal", "<f4", 3), ("at", "<f4", (3, 3)), ("more", "<u2")]))["at"]
    facets = facets[(facets[:, :, 1] > 1e-6).any(axis=1)]
    normals = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])
    length = np.linalg.norm(normals, axis=1)
    facing = (normals @ TO_EYE > 0) & (length > 0)
    facets, normals = facets[facing], normals[facing] / length[facing, None]
    order = np.argsort(facets.mean(axis=1) @ TO_EYE)
    light = np.array([-0.5, -0.3, 0.81])
    shade = np.round((0.5 + 0.5 * normals @ light) * SHADES).astype(int)
    return [(shade[k], facets[k]) for k in order]


TO_EYE = np.array([np.cos(TURN) * np.cos(UP), np.sin(TURN) * np.cos(UP), np.sin(UP)])
RIGHT = np.array([-np.sin(TURN), np.cos(TURN), 0])
ABOVE = np.cross(TO_EYE, RIGHT)


class Sheet:
    """Orthographic projection of points in space onto the picture, and SVG paths through them."""

    margin, footer = 34, 40  # [px]

    def __init__(self, points):
        flat = self.flat(points)
        self.low = flat.min(axis=0)
        self.scale = (WIDTH - 2 * self.margin) / np.ptp(flat[:, 0])
        self.height = round(np.ptp(flat[:, 1]) * self.scale + 2 * self.margin + self.footer)

    @staticmethod
    def flat(points):
        return np.stack([points @ RIGHT, -(points @ ABOVE)], axis=-1)

    def at(self, points):
        return (self.flat(np.asarray(points, float)) - self.low) * self.scale + self.margin

    def path(self, points, end="", min_distance=0.0):
        """Attribute `d` of a polyline; skips points closer to their predecessor than `min_distance` [px]."""
        kept = []
        for point in self.at(points):
            if not kept or np.hypot(*(point - kept[-1])) >= min_distance:
                kept.append(point)
        return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in kept) + end

    def link(self, name, points):
        if name.startswith("arm"):  # the crank, and the pin that connects its rods
            return self.path(points[:2]) + self.path(points[2:])
        return self.path(points, "Z" if name == "platform" else "")


def colour(level):
    position = (level - LEVELS[0]) / (LEVELS[-1] - LEVELS[0]) * (len(COLOURS) - 1)
    return "#" + "".join(f"{round(np.interp(position, range(len(COLOURS)), channel)):02x}" for channel in COLOURS.T)


def within(points, line):
    """Whether points of the picture lie inside a closed polyline (even-odd rule with a ray to the right)."""
    (x, y), inside = points.T, np.zeros(len(points), bool)
    for a, b in zip(line, np.roll(line, -1, axis=0)):
        if a[1] != b[1]:
            inside ^= ((a[1] > y) != (b[1] > y)) & (x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
    return inside


def animated(values, tag="animate", more='attributeName="d"'):
    return f'<{tag} {more} dur="{SECONDS}s" repeatCount="indefinite" values="{";".join(values)}"/>'


STYLE = """svg { --paper: #fff; --ink: #24292f; --frame: #8c959f; --arm: #3b6ea8; --rod: #2f8f5b; --platform: #c44e52 }
@media (prefers-color-scheme: dark) {
  svg { --paper: #161b22; --ink: #e6edf3; --frame: #8b949e; --arm: #79b0ee; --rod: #6fcf97; --platform: #f08a8d }
}
text { font: italic 30px sans-serif; fill: var(--ink); text-anchor: middle }
text { paint-order: stroke; stroke: var(--paper); stroke-width: 5; stroke-linejoin: round }
.legend { font: 25px sans-serif; text-anchor: start }
.behind { stroke-width: 0.8; stroke-linejoin: round }
.edge { fill: none; stroke: var(--ink); stroke-opacity: 0.6; stroke-width: 1.5 }
.way { fill: none; stroke: var(--paper); stroke-width: 2; stroke-dasharray: 5 5 }
.base { fill: var(--frame); fill-opacity: 0.25; stroke: var(--frame); stroke-width: 4 }
.halo, .arm, .rod { fill: none }
.halo { stroke: var(--paper); stroke-opacity: 0.75; stroke-width: 9 }
.arm { stroke: var(--arm); stroke-width: 8 } .rod { stroke: var(--rod); stroke-width: 4 }
.platform { fill: var(--platform); fill-opacity: 0.85; stroke: var(--platform); stroke-width: 4 }"""


def picture(program):
    with tempfile.TemporaryDirectory() as folder:
        motion = Path(folder, "motion.toml")
        motion.write_text(MOTION)
        trajectory = table(program, folder, "trajectory", FILE, "--motion", motion, "--samples", str(SAMPLES))
        cells = table(program, folder, "workspace", FILE, "--fixed", "y=0", "--box", "x=-0.45:0.45,z=-0.72:-0.2",
                        "--cells", "x=360,z=208")  # fmt: skip
        surface = surface_behind(program, folder)
    tool_path = np.stack([trajectory["x"], trajectory["y"], trajectory["z"]], axis=1)
    drawn = links([trajectory[f"arm{i}"] for i in (1, 2, 3)], tool_path)
    base = drawn.pop("base")

    def contours(name, levels):
        x, z, grid = field(cells, name, "x", "z")
        grid = extrapolated(grid)
        return [list(in_slice(outlines(x, z, grid, level))) for level in levels]

    def in_slice(found):
        for line in found:
            if len(line) > 20:  # omit tiny contours, which are artefacts of the grid
                yield np.stack([line[:, 0], 0 * line[:, 0], line[:, 1]], axis=1)

    edges = contours("margin", [0])[0]
    sheet = Sheet(np.concatenate([*edges, base, *(at for _, at in surface),
                                  *(line.reshape(-1, 3) for line in drawn.values())]))  # fmt: skip
    hidden = within(sheet.at([at for _, at in surface]).reshape(-1, 2), sheet.at(edges[0])).reshape(-1, 3).all(axis=1)
    surface = [facet for facet, gone in zip(surface, hidden) if not gone]
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {sheet.height}" width="{WIDTH}" role="img">',
           "<title>A rotary Delta moves in a slice of its workspace</title>", f"<style>{STYLE}</style>",
           '<rect width="100%" height="100%" rx="10" fill="var(--paper)"/>', '<g class="behind">']  # fmt: skip
    for shade, run in itertools.groupby(surface, lambda facet: facet[0]):
        grey = f"hsl(205 22% {38 + 45 * shade / SHADES:.0f}%)"
        out.append(f'<path fill="{grey}" stroke="{grey}" d="{"".join(sheet.path(at, "Z") for _, at in run)}"/>')
    out.append("</g>")

    out.append(f'<clipPath id="slice"><path d="{"".join(sheet.path(edge, "Z", 0.7) for edge in edges)}"/></clipPath>')
    out.append('<g clip-path="url(#slice)">')
    for level, found in zip(LEVELS, contours("conditioning", LEVELS)):
        d = "".join(sheet.path(line, "Z", 0.7) for line in found)
        out.append(f'<path fill="{colour(level)}" d="{d}"/>')
    out.append("</g>")
    out += [f'<path class="edge" d="{sheet.path(edge, "Z", 0.7)}"/>' for edge in edges]
    out.append(f'<path class="way" d="{sheet.path(tool_path)}"/><path class="base" d="{sheet.path(base, "Z")}"/>')

    out.append('<g stroke-linecap="round" stroke-linejoin="round">')
    for name in sorted(drawn, key=lambda name: float(drawn[name].mean(axis=(0, 1)) @ TO_EYE)):
        shapes = [sheet.link(name, points) for points in drawn[name]]
        for kind in (["halo"] if name != "platform" else []) + name.split()[:1]:
            out.append(f'<path class="{kind}" d="{shapes[0]}">{animated(shapes)}</path>')
    out.append("</g>")

    for index, line, shift in (("a", drawn["arm 0"][:, :2], (0, -20)), ("b", drawn["rod 0 1"], (32, 0))):
        positions = [f"{x:.1f} {y:.1f}" for x, y in sheet.at(line.mean(axis=1)) + shift]
        follow = animated(positions, "animateTransform", 'attributeName="transform" type="translate"')
        out.append(f'<text transform="translate({positions[0]})">l<tspan font-size="70%" dy="4">{index}</tspan>'
                   f"{follow}</text>")  # fmt: skip
    for k, level in enumerate(LEVELS):
        out.append(f'<rect x="{sheet.margin + 24 * k}" y="{sheet.height - 44}" width="24" height="20" '
                   f'fill="{colour(level)}"/>')  # fmt: skip
    out.append(f'<text class="legend" x="{sheet.margin + 24 * len(LEVELS) + 12}" y="{sheet.height - 25}">conditioning '
               f"{LEVELS[0]:.2f} .. {LEVELS[-1] + 0.05:.2f}</text>")  # fmt: skip
    return "\n".join(out) + "\n</svg>\n"


if __name__ == "__main__":
    program, out = sys.argv[1:]
    Path(out).write_text(picture(program))
