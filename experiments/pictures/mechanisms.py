"""mechanisms.py PROGRAM MECHANISM|FILE.toml OUT.svg: draws a mechanism with the names of its lengths.

The links of the nominal design at its initial pose are read from the page that `pkmopt workspace --html` writes. Needs
numpy. For the READMEs in engine/accelerators, and for all files in experiments/mechanisms:
  mechanisms.py build/quickstart/bin/pkmopt 4ppa-2par engine/accelerators/four_ppa_two_par/mechanism.svg
  mechanisms.py build/quickstart/bin/pkmopt experiments/mechanisms
and for one file, such as experiments/mechanisms/frames/h4.toml, into experiments/mechanisms/pictures/h4.svg."""
import base64
import html
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

# Dimensions to draw: (name, end, end), where an end is (link, index among the links of this name, 0 or 1: its first or
# second end). Dimensions are drawn above the line between the ends, or left of a vertical line; a fourth element -1
# puts them on the other side.
LENGTHS = {
    "4ppa-2par": [
        ("a", ("platform", 0, 0), ("platform", 0, 1), -1),
        ("b", ("rail 1", 0, 0), ("rail 2", 0, 0)),
        ("l_u", ("upper bar of slider 1", 0, 0), ("upper bar of slider 1", 0, 1)),
        ("l_d", ("lower bar of limb 1", 0, 0), ("lower bar of limb 1", 0, 1)),
        ("d", ("lower connector of limb 2", 0, 0), ("platform", 0, 1), -1),
        ("L0", ("rail 2", 0, 0), ("rail 2", 0, 1), -1),
    ],
    "3crr-r-cru": [
        *((f"l_{i}", (f"rod {i}", 0, 0), (f"rod {i}", 0, 1)) for i in (11, 12, 21, 22, 31, 32, 41, 42)),
        ("l", ("moving platform", 0, 0), ("moving platform", 0, 1)),
        ("L", ("rail 1", 0, 0), ("rail 1", 0, 1), -1),
    ],
    "quadrupteron": [
        *((f"l_{i}", (f"rod {i}", 0, 0), (f"rod {i}", 0, 1)) for i in (11, 12, 21, 22, 31, 32, 41, 42)),
        ("l", ("platform", 4, 0), ("platform", 4, 1)),
        ("L", ("rail 1", 0, 0), ("rail 1", 0, 1), -1),
    ],
    "2t1r-p-hybrid": [
        ("2 a", ("platform", 0, 0), ("platform", 0, 1), -1),
        ("e", ("platform", 1, 0), ("platform", 1, 1)),
        ("L1", ("link A", 0, 0), ("link A", 0, 1)),
        ("L2", ("link B", 0, 0), ("link B", 0, 1)),
        ("L3", ("link C", 0, 0), ("link C", 0, 1)),
        ("d", ("carriage E", 0, 0), ("carriage E", 0, 1)),
    ],
}
# Direction of the viewer: azimuth and elevation [deg].
ABOVE = (-90, 90)
EYE = {"4ppa-2par": (-62, 16), "2t1r-p-hybrid": (-70, 24), "3-rpr": ABOVE, "3-rrr": ABOVE, "five-bar": ABOVE,
       "rotary-delta": (-40, 24), "linear-delta": (-40, 24), "gough": (-40, 16), "par4": (-70, 24)}  # fmt: skip
COLOURS = {"frame": "#9a9a9a", "platform": "#c44e52"}
OTHERS = ["#4c72b0", "#55a868", "#8172b3", "#ccb974", "#64b5cd", "#937860"]
WIDTH = 900  # of the picture [px]


def unpack(text):
    """An array from the page: a bit field, or values as 16-bit fractions between two bounds."""
    kind, *bounds, data = text.split(":")
    data = base64.b64decode(data)
    if kind == "bits":
        return np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little")
    level = np.frombuffer(data, "<u2").astype(float)
    lower, upper = (float(b) for b in bounds)
    return lower + (upper - lower) * level / 65534


def links_of(program, mechanism):
    """[(name, part, radius, ends)] at the initial pose of the nominal design."""
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "page.html")
        command = [program, "workspace", mechanism, "--cells", "8", "--html", str(page)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        text = page.read_text()
    start = text.index('"mechanism":{"mode"') + len('"mechanism":')
    design = json.JSONDecoder().raw_decode(text[start:])[0]["designs"][0]
    index = int(np.sum(unpack(design["assembles"])[: design["initial_pose"]]))
    at = np.stack([unpack(c).reshape(-1, design["end_count"])[index] for c in design["end_positions"]], axis=1)
    return [(k["name"], k["part"], k["radius"], at[[k["from"], k["to"]]]) for k in design["links"]]


def picture(mechanism, links, lengths=()):
    turn, up = np.radians(EYE.get(mechanism, (-60, 20)))
    right = np.array([-np.sin(turn), np.cos(turn), 0])
    away = -np.array([np.cos(turn) * np.cos(up), np.sin(turn) * np.cos(up), np.sin(up)])
    above = np.cross(right, away)
    flat = np.array([np.stack([ends @ right, -(ends @ above)], axis=1) for *_, ends in links])
    margin = 0.06 * np.ptp(flat.reshape(-1, 2), axis=0).max()
    low = flat.reshape(-1, 2).min(axis=0) - margin
    size = flat.reshape(-1, 2).max(axis=0) + margin - low
    scale = WIDTH / size[0]

    def px(point):
        return (np.array([point @ right, -(point @ above)]) - low) * scale

    def line(a, b, colour, width, more=""):
        (x1, y1), (x2, y2) = a, b
        return (f'<path d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" stroke="{colour}" stroke-width="{width:.1f}"{more}/>')

    def text(at, words, anchor="middle", colour="#222"):
        name, _, index = words.partition("_")
        low = f'<tspan font-size="70%" dy="4">{html.escape(index)}</tspan>' if index else ""
        return (f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}" fill="{colour}">'
                f"{html.escape(name)}{low}</text>")  # fmt: skip

    parts = [part for part in dict.fromkeys(part for _, part, *_ in links) if part not in COLOURS]
    colours = COLOURS | {part: OTHERS[i % len(OTHERS)] for i, part in enumerate(parts)}
    drawn = ['<g fill="none" stroke-linecap="round">']
    for _, part, radius, ends in sorted(links, key=lambda k: -float(k[3].mean(axis=0) @ away)):
        a, b = px(ends[0]), px(ends[1])
        width = max(2 * radius * scale, 2)
        drawn.append(line(a, b, "#fff", width + 3, ' stroke-opacity="0.7"'))
        drawn.append(line(a, b, colours[part], width))
    drawn.append("</g>")
    drawn.append('<g font-family="sans-serif" font-size="19" font-style="italic">')
    for name, *ends, side in ((*length, 1) if len(length) == 3 else length for length in lengths):
        found = [([k for k in links if k[0] == link][which], end) for link, which, end in ends]
        a, b = (px(link[3][end]) for link, end in found)
        across = np.array([-(b - a)[1], (b - a)[0]]) / max(np.hypot(*(b - a)), 1e-9)
        if across[1] > 0 or (abs(across[1]) < 0.2 and across[0] > 0):
            across = -across  # to the upper or, if nearly vertical, the left side
        across *= side
        shift = (12 + scale * max(link[2] for link, _ in found)) * across
        drawn.append(line(a + shift, b + shift, "#222", 1, ' marker-start="url(#tip)" marker-end="url(#tip)"'))
        drawn.append(text((a + b) / 2 + shift + 13 * across + [0, 6], name))
    origin, arm = px(np.zeros(3)), 0.14 * size.max()
    for axis, name in zip(np.eye(3), "xyz"):
        tip = px(axis * arm)
        drawn.append(line(origin, tip, "#c0392b", 2, ' marker-end="url(#tip)"'))
        drawn.append(text(tip + 14 * (tip - origin) / max(np.hypot(*(tip - origin)), 1e-9) + [0, 6], name, colour="#c0392b"))
    drawn.append("</g>")
    named = [f'<tspan fill="{colours[part]}">{html.escape(part)}</tspan>' for part in colours]
    drawn.append(f'<text x="{WIDTH / 2}" y="{size[1] * scale + 22:.1f}" text-anchor="middle" '
                 f'font-family="sans-serif" font-size="16" word-spacing="2">{" &#160; ".join(named)}</text>')  # fmt: skip
    height = size[1] * scale + 36
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height:.0f}" width="{WIDTH}">\n'
            '<defs><marker id="tip" viewBox="-10 -4 10 8" markerWidth="9" markerHeight="7" orient="auto-start-reverse">'
            '<path d="M-10-4L0 0L-10 4z" fill="context-stroke"/></marker></defs>\n'
            '<rect width="100%" height="100%" fill="#fff"/>\n' + "\n".join(drawn) + "\n</svg>\n")  # fmt: skip


if __name__ == "__main__":
    program, mechanism, *out = sys.argv[1:]
    if Path(mechanism).is_dir():
        for file in sorted(Path(mechanism).glob("*.toml")):
            Path(mechanism, "pictures", file.stem + ".svg").write_text(picture(file.stem, links_of(program, str(file))))
    else:
        Path(out[0]).write_text(picture(Path(mechanism).stem, links_of(program, mechanism), LENGTHS.get(mechanism, ())))
