"""Runs processes and measures their time and memory."""

import os
import subprocess
import tempfile
import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Run:
    output: str
    wall: float  # wall time [s]
    cpu: float  # user and system time of all threads [s]
    memory: float  # maximum resident set size [MiB]


def run(*command):
    """Runs a command to its end. Raises RuntimeError with its error output if it fails."""
    with tempfile.TemporaryFile("w+") as output, tempfile.NamedTemporaryFile("r") as memory:
        # GNU time measures the memory: that of a direct child would include Python's, from which it is forked.
        begin = time.perf_counter()
        process = subprocess.Popen(["/usr/bin/time", "--format=%M", "--output=" + memory.name, *command],
                                   stdout=output, stderr=subprocess.PIPE, text=True)
        errors = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} failed with exit code {process.returncode}:\n{errors}")
        output.seek(0)
        return Run(output.read(), wall, usage.ru_utime + usage.ru_stime, int(memory.read()) / 1024)
