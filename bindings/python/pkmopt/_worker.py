"""Calls the Python functions of a study. The package uses this module, and pkmopt runs its text as the program of worker
processes. A worker's connection to pkmopt is file descriptor 3.

Every message begins with its length: 8 bytes, native byte order.
  1. pkmopt sends a JSON object: "functions": [[file, function], ..], "parameters": [name, ..], "path": [folder, ..].
     The answer is empty, or says why a function cannot be loaded.
  2. pkmopt sends the number of a function and the parameters of designs, all as float64. The answer has the value and
     the time of each design as float64, then a JSON object with the reasons of failures by number of the design.
"""

from __future__ import annotations

import array
import difflib
import importlib.util
import json
import math
import os
import struct
import sys
import threading
import time
import traceback
from typing import Any, Callable, Dict, Tuple

Function = Callable[[Dict[str, float]], Any]

WORKER = "PKMOPT_WORKER"  # environment variable of the processes that call functions
CONNECTION = 3
FRAMES = 8  # of a traceback in one line


class NoFunction(Exception):
    """A file does not have the function of the given name."""


def describe(error: BaseException) -> str:
    """The error and its traceback in one line."""
    text = "".join(traceback.format_exception_only(type(error), error)).strip().replace("\n", "; ")
    own = globals().get("__file__")  # None in a worker, where this file is "<string>"
    frames = [f for f in traceback.extract_tb(error.__traceback__) if f.filename[:1] != "<" and f.filename != own]
    places = ["%s:%s in %s" % (os.path.basename(f.filename), f.lineno, f.name) for f in reversed(frames)]
    if len(places) > FRAMES:
        places[FRAMES:] = ["%d more" % (len(places) - FRAMES)]
    return text + (" (%s)" % ", called from ".join(places) if places else "")


def load(file: str, function: str) -> Function:
    """The function of a Python file, which is imported once. Its folder comes first in sys.path, as for a program."""
    for module in list(sys.modules.values()):
        if getattr(module, "__file__", None) == file:
            break
    else:
        folder, stem = os.path.dirname(file), os.path.splitext(os.path.basename(file))[0]
        name = stem if stem not in sys.modules else "%s in %s" % (stem, folder)
        spec = importlib.util.spec_from_file_location(name, file)
        assert spec is not None and spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        if folder not in sys.path:
            sys.path.insert(0, folder)
        sys.modules[name] = module
        try:
            spec.loader.exec_module(module)
        except BaseException:
            del sys.modules[name]
            raise
    found: Any = module
    for part in function.split("."):
        if not hasattr(found, part):
            near = difflib.get_close_matches(part, dir(found), 1)
            suggestion = "; did you mean %s?" % near[0] if near else ""
            raise NoFunction("%s: it has no function %s%s" % (file, function, suggestion))
        found = getattr(found, part)
    if not callable(found):
        raise NoFunction("%s: %s is not a function" % (file, function))
    return found  # type: ignore[no-any-return]


def call(function: Function, design: Dict[str, float]) -> Tuple[float, str]:
    """The value of a function, and the reason of a failure, or ""."""
    try:
        result = function(design)
        if result is None:
            return math.nan, "the function returned None; expected a number"
        value = float(result)
    except (Exception, SystemExit) as error:
        return math.nan, describe(error)
    return value, "" if math.isfinite(value) else "the function returned %r; expected a finite number" % value


def receive_bytes(size: int) -> bytes:
    data = bytearray()
    while len(data) < size:
        try:
            part = os.read(CONNECTION, size - len(data))
        except ConnectionError:
            part = b""
        if not part:
            os._exit(0)  # pkmopt has ended
        data += part
    return bytes(data)


def receive() -> bytes:
    return receive_bytes(struct.unpack("=Q", receive_bytes(8))[0])


def send(data: bytes) -> None:
    left = memoryview(struct.pack("=Q", len(data)) + data)
    try:
        while left:
            left = left[os.write(CONNECTION, left) :]
    except ConnectionError:
        os._exit(0)


def end_with(parent: int) -> None:
    """Ends this process after pkmopt, even during a call."""
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(0)


def main() -> None:
    # Libraries with threads of their own would compete with each other, and add numbers in another order.
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    os.environ[WORKER] = "1"  # a study that is started here is a mistake
    threading.Thread(target=end_with, args=(os.getppid(),), daemon=True).start()
    os.dup2(2, 1)  # what functions print does not mix with the output of pkmopt
    setup = json.loads(receive())
    sys.path.extend(setup["path"])
    functions, names = [], setup["parameters"]
    for file, function in setup["functions"]:
        try:
            functions.append(load(file, function))
        except NoFunction as error:
            return send(str(error).encode())
        except (Exception, SystemExit) as error:
            return send(("%s: %s" % (file, describe(error))).encode())
    send(b"")
    while True:
        numbers = array.array("d", receive())
        width, results, failures = len(names), array.array("d"), {}
        for row, first in enumerate(range(1, len(numbers), width)):
            begin = time.perf_counter()
            value, failure = call(functions[int(numbers[0])], dict(zip(names, numbers[first : first + width])))
            results.extend((value, time.perf_counter() - begin))
            if failure:
                failures[row] = failure
        send(results.tobytes() + json.dumps(failures).encode())


if __name__ == "__main__":
    main()
