"""Reads and modifies study files with h5py, as an independent implementation, for tests/unit/storage/h5py_test.cpp.

read_study.py values FILE         prints values of the sample study bit by bit, one item per line
read_study.py labels FILE         checks attributes and layout of every dataset
read_study.py snippets FILE PAGE  runs the Python examples of a page on the file
read_study.py contiguous FILE     rewrites one dataset in h5py's default layout, big-endian
read_study.py put FILE PATH INDEX VALUE  changes one value
read_study.py shorten FILE PATH   removes the last row of a dataset
read_study.py remove FILE PATH    removes a dataset
read_study.py wide FILE PATH      prints where the column names of a dataset are stored, their number, first and last
read_study.py forge FILE KIND     makes a change that pkmopt never writes, see forge()
"""

import math
import os
import re
import shutil
import sys
import tempfile

import h5py


def values(path):
    with h5py.File(path, "r") as f:
        for name in ("design", "objective", "margin", "report"):
            data = f["stages/1/evaluations/" + name][:]
            print(name, data.shape, " ".join("%016x" % x for x in data.view("<u8").ravel()))
        print("status", f["stages/1/evaluations/status"][:].tolist())
        print("generation", f["stages/1/evaluations/generation"][:].tolist())
        print("population", f["stages/1/generations/population"][:].tolist())
        print("columns", f["stages/1/evaluations/margin"].attrs["columns"].tolist())
        print("format", f.attrs["format"])
        print("schema", f.attrs["schema"])
        print("seed", f.attrs["seed"])
        print("name", f.attrs["name"])
        print("lower", f["problem/variables/lower"][:].tolist())
        print("best", f["best/design"][:].tolist() == f["stages/1/evaluations/design"][8].tolist())
        print("map", f["final/map/feasible"].shape, f["final/map/axis"].asstr()[:].tolist())
        print("toml", len(f["toml"].asstr()[()]))


def labels(path):
    count = 0

    def names_in(item, name):  # the attribute is a list of names, or the path of a dataset with the list
        label = item.attrs[name]
        return item.file[label].asstr()[:] if isinstance(label, str) and label.startswith("/") else label

    def visit(name, item):
        nonlocal count
        assert item.attrs["description"], name
        if not isinstance(item, h5py.Dataset):
            return
        count += 1
        assert "unit" in item.attrs, name
        if item.shape:
            assert item.chunks and item.maxshape[0] is None, name
            if math.prod(item.chunks) * item.dtype.itemsize >= 1024:
                assert item.compression == "gzip" and item.shuffle, name
        if "columns" in item.attrs:
            names = names_in(item, "columns")
            assert len(names) == len(names_in(item, "unit")) == item.shape[-1], name
            assert len(set(names)) == len(names), name

    with h5py.File(path, "r") as f:
        assert f.userblock_size == 512
        f.visititems(visit)
    print(count, "datasets")


def snippets(path, readme):
    with open(readme, encoding="utf-8") as f:
        blocks = re.findall(r"```python\n(.*?)```", f.read(), re.DOTALL)
    with tempfile.TemporaryDirectory() as folder:
        for name in ("wide.h5", "front.h5"):
            shutil.copy(path, os.path.join(folder, name))
        os.chdir(folder)
        for block in blocks:
            exec(compile(block, readme, "exec"), {})
        os.chdir("/")
    print(len(blocks), "snippets")


def contiguous(path):
    with h5py.File(path, "r+") as f:
        data = f["stages/1/evaluations/objective"][:]
        del f["stages/1/evaluations/objective"]
        f.create_dataset("stages/1/evaluations/objective", data=data.astype(">f8"))


def put(path, name, index, value):
    with h5py.File(path, "r+") as f:
        f[name][int(index)] = float(value)


def shorten(path, name):
    with h5py.File(path, "r+") as f:
        f[name].resize(f[name].shape[0] - 1, axis=0)


def remove(path, name):
    with h5py.File(path, "r+") as f:
        del f[name]


def wide(path, name):
    with h5py.File(path, "r") as f:
        columns = f[name].attrs["columns"]
        names = f[columns].asstr()[:] if isinstance(columns, str) else columns
        print(columns if isinstance(columns, str) else "attribute", len(names), names[0], names[-1])


def forge(path, kind):
    """Replaces the objectives by a link, foreign storage or values of another type, or writes invalid numbers."""
    rows = "stages/1/evaluations/objective"
    with h5py.File(path, "r+") as f:
        shape = f[rows].shape
        if kind == "count":
            f["stages"].attrs["count"] = 2**32
            return
        if kind == "variable":
            f["problem/parameters/variable"][2] = 0
            return
        if kind == "cells":
            f["final/best"].attrs["feasible_cells"] = -1
            return
        if kind == "unread":  # redundant data that pkmopt does not read
            del f["best/design"]
            f["best/design"] = h5py.SoftLink("/stages/1/evaluations/design")
            return
        del f[rows]
        if kind == "soft":
            f[rows] = h5py.SoftLink("/stages/1/evaluations/seconds")
        elif kind == "link":
            f[rows] = h5py.ExternalLink("/etc/passwd", "/x")
        elif kind == "external":
            f.create_dataset(rows, shape, "<f8", external=[("/etc/passwd", 0, h5py.h5f.UNLIMITED)])
        elif kind == "virtual":
            layout = h5py.VirtualLayout(shape, "<f8")
            layout[:] = h5py.VirtualSource("/etc/passwd", "x", shape)
            f.create_virtual_dataset(rows, layout)
        elif kind == "filter":
            f.create_dataset(rows, shape, "<f8", compression="lzf")
        elif kind == "type":
            f.create_dataset(rows, shape, "<i8")
        elif kind == "huge":
            f.create_dataset(rows, shape, "<f8", chunks=shape)  # no chunk is stored


if __name__ == "__main__":
    commands = {c.__name__: c for c in (values, labels, snippets, contiguous, put, shorten, remove, wide, forge)}
    commands[sys.argv[1]](*sys.argv[2:])
