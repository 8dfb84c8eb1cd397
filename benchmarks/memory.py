#!/usr/bin/env python3
"""Prints the peak memory of `pkmopt run` for studies of increasing size: memory.py path/to/pkmopt"""
import os
import resource
import subprocess
import sys
import tempfile

EXPERIMENT = os.path.join(os.path.dirname(__file__), "..", "experiments", "4ppa-2par", "wide-bounds.toml")


def run(program, folder, population, generations):
    """Returns memory and study file size of one run [MiB]. A separate process measures the memory, because the system
    records the maximum over all children."""
    with open(EXPERIMENT) as file:
        head, _, stage = file.read().partition("[[stage]]")
    if not stage:
        sys.exit(f"{EXPERIMENT}: no [[stage]] found")
    study = os.path.join(folder, f"{population}-{generations}.toml")
    with open(study, "w") as file:
        file.write(f'{head}[[stage]]\noptimiser = "ga"\npopulation = {population}\ngenerations = {generations}\n')
    measure = (
        "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True);"
        "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
    )
    command = [program, "run", study, "--output", study + ".h5", "--quiet"]
    kilobytes = subprocess.run([sys.executable, "-c", measure, *command], check=True, stdout=subprocess.PIPE).stdout
    return int(kilobytes) / 1024, os.path.getsize(study + ".h5") / 2**20


with tempfile.TemporaryDirectory() as folder:
    print("evaluations  memory, MiB  study file, MiB")
    for population, generations in (20, 100), (200, 100), (200, 1000), (1000, 1000):
        memory, size = run(sys.argv[1], folder, population, generations)
        print(f"{population * (generations + 1):11}  {memory:11.0f}  {size:15.1f}")
