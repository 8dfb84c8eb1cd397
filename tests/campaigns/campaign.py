"""What the campaigns have in common: small studies, what they end with, the program as a child."""

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

# Differ from run to run: clocks, the machine, the study's text where the interval of checkpoints is part of it.
UNREPEATED = {"seconds", "toml", "toml_file", "text_digest", "created", "updated", "machine", "program_version",
              "program_revision", "notes", "reproducible"}


def digest(path):
    """Of the bits of all that has to repeat in a study file."""
    lines = []

    def add(name, item):
        for key, value in sorted(item.attrs.items()):
            if key not in UNREPEATED:
                lines.append((name + "@" + key, repr(value)))
        if isinstance(item, h5py.Dataset) and name.split("/")[-1] not in UNREPEATED:
            lines.append((name, hashlib.sha256(repr(item.shape).encode() + item[()].tobytes()).hexdigest()))

    with h5py.File(path, "r") as file:
        add("/", file)
        file.visititems(add)
    return hashlib.sha256(repr(sorted(lines)).encode()).hexdigest()


def state(path):
    with h5py.File(path, "r") as file:
        return file.attrs["state"]


class Folder:
    """A folder for files, and the program run in it."""

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
        """Exit code and all that was printed."""
        child = self.start(arguments, variables)
        try:
            output = child.communicate(timeout=timeout)[0]
        except subprocess.TimeoutExpired:
            child.kill()
            child.communicate()
            return None, "no end within %g s" % timeout
        return child.returncode, output


def disk(library, folder, **settings):
    """Variables for a child whose disk tests/campaigns/unreliable_disk.c stands for."""
    return {"LD_PRELOAD": os.path.abspath(library), "DISK_FOLDER": folder,
            **{"DISK_" + name.upper(): str(value) for name, value in settings.items()}}
