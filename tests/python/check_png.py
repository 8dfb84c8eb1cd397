"""check_png.py PROGRAM: checks that the PNG and SVG images of `pkmopt workspace` show equal areas, and that the PNG
image has a frame and text labels."""

import re
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

import numpy


def pixels_of(png):
    """Pixels as an array height x width x 3; asserts that the checksum of every chunk is correct."""
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
    """Area of the slice in SVG pixels, from its boundary loops (shoelace formula); holes are subtracted."""
    path = re.search(r'class="outline".* d="([^"]*)"', svg)[1]
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
        pixels, text = pixels_of(png), svg.read_text()
        width, height = (float(re.search(name + r'="([\d.]+)"', text)[1]) for name in ("width", "height"))
        assert abs(pixels.shape[1] - 2 * width) <= 1 and abs(pixels.shape[0] - 2 * height) <= 1
        filled = (pixels[:, :, 2] - pixels[:, :, 0] > 30).sum() / 4  # 2 x 2 PNG pixels per SVG pixel; blue area
        assert abs(filled - area_of(text)) < 0.02 * area_of(text), (filled, area_of(text))
        left, top, frame_width, frame_height = (2 * float(number) for number in re.findall(
            r'<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"', text)[0])
        dark = pixels.max(axis=2) < 100
        frame = dark[round(top), round(left):round(left + frame_width)]
        assert frame.mean() > 0.9
        for name, region in {"title": dark[:round(top) - 4], "ticks": dark[round(top + frame_height) + 6:],
                             "axis labels": dark[:, :round(left) - 4]}.items():
            assert 100 < region.sum() < 0.1 * region.size, name


main(*sys.argv[1:])
