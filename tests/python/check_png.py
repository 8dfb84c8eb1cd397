"""check_png.py PROGRAM: the picture that `pkmopt workspace` draws as dots has the area that it draws as SVG, and letters."""

import re
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy


def dots_of(png):
    """Height x width x 3; asserts that every chunk is whole."""
    data = png.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = {}, 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        content = data[at + 8:at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == zlib.crc32(kind + content)
        chunks[kind] = content
        at += 12 + length
    assert list(chunks) == [b"IHDR", b"IDAT", b"IEND"]
    width, height, *form = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    assert form == [8, 2, 0, 0, 0]
    rows = numpy.frombuffer(zlib.decompress(chunks[b"IDAT"]), numpy.uint8).reshape(height, 1 + 3 * width)
    assert not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, 3).astype(int)


def area_of(svg):
    """In pixels, of the section's loops; holes count less."""
    path = re.search(r'class="section".* d="([^"]*)"', svg)[1]
    area = 0
    for loop in filter(None, path.split("Z")):
        x, y = numpy.array([pair.split() for pair in re.split("[ML]", loop)[1:]], float).T
        area += (x @ numpy.roll(y, -1) - y @ numpy.roll(x, -1)) / 2
    return abs(area)


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        svg, png = Path(folder, "cut.svg"), Path(folder, "cut.png")
        subprocess.run([program, "workspace", "4ppa-2par", "--cut", "theta=20deg", "--cells", "12", "-o", svg, "-o", png],
                       check=True, stdout=subprocess.DEVNULL)
        dots, text = dots_of(png), svg.read_text()
        width, height = (float(re.search(name + r'="([\d.]+)"', text)[1]) for name in ("width", "height"))
        assert abs(dots.shape[1] - 2 * width) <= 1 and abs(dots.shape[0] - 2 * height) <= 1
        filled = (dots[:, :, 2] - dots[:, :, 0] > 30).sum() / 4  # four dots a pixel; blue, also over grey lines
        assert abs(filled - area_of(text)) < 0.02 * area_of(text), (filled, area_of(text))
        left, top, across, down = (2 * float(number) for number in re.findall(
            r'<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"', text)[0])
        dark = dots.max(axis=2) < 100
        frame = dark[round(top), round(left):round(left + across)]
        assert frame.mean() > 0.9
        for name, part in {"title": dark[:round(top) - 4], "ticks": dark[round(top + down) + 6:],
                           "names": dark[:, :round(left) - 4]}.items():
            assert 100 < part.sum() < 0.1 * part.size, name


main(*sys.argv[1:])
