"""Processes and what they cost."""

import os
import subprocess
import tempfile
import time
from dataclasses import dataclass


@dataclass(frozen=True)
class Run:
    output: str
    wall: float  # from start to end [s]
    cpu: float  # user and system, all threads [s]
    memory: float  # most at one time [MiB]


def run(*command):
    """Runs a command to its end. Raises RuntimeError with what it said if it fails."""
    with tempfile.TemporaryFile("w+") as output, tempfile.NamedTemporaryFile("r") as memory:
        # GNU time is in between because the memory of a direct child would count Python's, which it begins as.
        begin = time.perf_counter()
        process = subprocess.Popen(["/usr/bin/time", "--format=%M", "--output=" + memory.name, *command],
                                   stdout=output, stderr=subprocess.PIPE, text=True)
        errors = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}:\n{errors}")
        output.seek(0)
        return Run(output.read(), wall, usage.ru_utime + usage.ru_stime, int(memory.read()) / 1024)
