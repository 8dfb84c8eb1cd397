"""Shared by the campaigns: small studies, a digest of study files, and running the program as a child process."""

import hashlib
import os
import subprocess

import h5py

PROBLEM = """[study]
name = "campaign"
seed = 7
[mechanism]
type = "4ppa-2par"
[variables]
a   = { min = 0.15, max = 0.95 }
b   = { min = 0.35, max = 1.55 }
l_u = { min = 0.25, max = 1.5 }
l_d = { min = 0.25, max = 1.5 }
[workspace]
method = "columns"
tolerance = 1e-8
limits = { alpha_min = 0.1, h_min = 0.06, beta_min = 0.1, beta_max = 1.3, sin_par_min = 0.1, cos_theta_min = 0.1 }
[[objective]]
type = "workspace-ratio"
[[constraint]]
type = "workspace-shape"
[[constraint]]
type = "linear"
coefficients = { a = 1, b = -1 }
"""
CONDITIONING = '[[objective]]\ntype = "conditioning"\n'

FILE = """[study]
name = "campaign"
seed = 7
[mechanism]
file = "%s"
[variables]
R = { min = 0.2, max = 0.4 }
r = { min = 0.03, max = 0.1 }
l = { min = 0.4, max = 0.8 }
[workspace]
method = "voxels"
cells = { x = 16, y = 16, z = 16 }
[[objective]]
type = "workspace-ratio"
[[stage]]
optimiser = "ga"
population = 20
generations = 60
""" % os.path.abspath(os.path.join(os.path.dirname(__file__), "../../experiments/mechanisms/linear-delta.toml"))

STUDIES = {
    "ga": PROBLEM + '[[stage]]\noptimiser = "ga"\npopulation = 20\ngenerations = 60\n',
    "nsga2": PROBLEM + CONDITIONING + '[[stage]]\noptimiser = "nsga2"\npopulation = 24\ngenerations = 20\n',
    "nlopt": PROBLEM + '[[stage]]\noptimiser = "nlopt"\nstart = "none"\nmultistart = 3\n',
    "ipopt": PROBLEM + '[[stage]]\noptimiser = "ipopt"\nstart = "none"\nmultistart = 3\n',
    "sweep": PROBLEM + '[[stage]]\noptimiser = "sweep"\ndesign = "full-factorial"\npoints = 6\n',
    "file": FILE,
}

# Attributes and datasets that differ between runs: clocks, machine, and the study's text, which contains the checkpoint
# interval.
NOT_REPRODUCIBLE = {"seconds", "toml", "toml_file", "text_digest", "created", "updated", "machine", "program_version",
              "program_revision", "notes", "reproducible"}


def digest(path):
    """Hash of all reproducible attributes and datasets of a study file."""
    lines = []

    def add(name, item):
        for key, value in sorted(item.attrs.items()):
            if key not in NOT_REPRODUCIBLE:
                lines.append((name + "@" + key, repr(value)))
        if isinstance(item, h5py.Dataset) and name.split("/")[-1] not in NOT_REPRODUCIBLE:
            lines.append((name, hashlib.sha256(repr(item.shape).encode() + item[()].tobytes()).hexdigest()))

    with h5py.File(path, "r") as file:
        add("/", file)
        file.visititems(add)
    return hashlib.sha256(repr(sorted(lines)).encode()).hexdigest()


def state(path):
    with h5py.File(path, "r") as file:
        return file.attrs["state"]


class Folder:
    """A working folder and the program that is run in it."""

    def __init__(self, path, program):
        self.path, self.program = path, os.path.abspath(program)

    def file(self, name):
        return os.path.join(self.path, name)

    def write(self, name, text):
        with open(self.file(name), "w", encoding="utf-8") as file:
            file.write(text)

    def start(self, arguments, variables=None):
        return subprocess.Popen([self.program, *arguments], cwd=self.path, env={**os.environ, **(variables or {})},
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                errors="replace")

    def run(self, arguments, variables=None, timeout=600):
        """Runs the program. Returns its exit code (None after a timeout) and its output, including stderr."""
        child = self.start(arguments, variables)
        try:
            output = child.communicate(timeout=timeout)[0]
        except subprocess.TimeoutExpired:
            child.kill()
            child.communicate()
            return None, "still running after %g s" % timeout
        return child.returncode, output


def disk(library, folder, **settings):
    """Environment variables for a child process whose file access is simulated by unreliable_disk.c."""
    return {"LD_PRELOAD": os.path.abspath(library), "DISK_FOLDER": folder,
            **{"DISK_" + name.upper(): str(value) for name, value in settings.items()}}
