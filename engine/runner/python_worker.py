"""Worker process of pkmopt: calls the Python functions of a study. Its connection to pkmopt is file descriptor 3.

Every message begins with its length: 8 bytes, native byte order.
  1. pkmopt sends a JSON object: "functions": [[file, function], ..], "parameters": [name, ..], "path": [folder, ..].
     The answer is empty, or says why a function cannot be loaded.
  2. pkmopt sends the number of a function and the parameters of designs, all as float64. The answer has the value and
     the time of each design as float64, then a JSON object with the reasons of failures by number of the design.
"""

import os

# Threads of numerical libraries would compete with the other workers, and would change the order of summation.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

os.environ["PKMOPT_WORKER"] = "1"  # a study that is started here is a mistake

import array
import difflib
import importlib.util
import json
import math
import struct
import sys
import threading
import time
import traceback

CONNECTION = 3


def receive_bytes(size):
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


def receive():
    return receive_bytes(struct.unpack("=Q", receive_bytes(8))[0])


def send(data):
    data = memoryview(struct.pack("=Q", len(data)) + data)
    try:
        while data:
            data = data[os.write(CONNECTION, data) :]
    except ConnectionError:
        os._exit(0)


def end_with(parent):
    """Ends this process after pkmopt, even during a call."""
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(0)


def describe(error):
    """The error and its traceback in one line."""
    text = "".join(traceback.format_exception_only(type(error), error)).strip().replace("\n", "; ")
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if not frame.filename.startswith("<")]
    places = ["%s:%s in %s" % (os.path.basename(f.filename), f.lineno, f.name) for f in reversed(frames)]
    return text + (" (%s)" % ", called from ".join(places) if places else "")


def load(file, function, modules):
    if file not in modules:
        folder, stem = os.path.dirname(file), os.path.splitext(os.path.basename(file))[0]
        sys.path.insert(0, folder)
        spec = importlib.util.spec_from_file_location(stem, file)
        modules[file] = importlib.util.module_from_spec(spec)
        sys.modules[stem] = modules[file]
        spec.loader.exec_module(modules[file])
    found = modules[file]
    for part in function.split("."):
        if not hasattr(found, part):
            near = difflib.get_close_matches(part, dir(found), 1)
            raise LookupError("it has no function %s%s" % (function, "; did you mean %s?" % near[0] if near else ""))
        found = getattr(found, part)
    if not callable(found):
        raise LookupError("%s is not a function" % function)
    return found


def call(function, parameters):
    """Value of the function, or NaN; reason of the failure, or ""."""
    try:
        result = function(parameters)
        if result is None:
            return math.nan, "the function returned None; expected a number"
        value = float(result)
    except (Exception, SystemExit) as error:
        return math.nan, describe(error)
    return value, "" if math.isfinite(value) else "the function returned %r; expected a finite number" % value


def main():
    threading.Thread(target=end_with, args=(os.getppid(),), daemon=True).start()
    os.dup2(2, 1)  # what functions print does not mix with the output of pkmopt
    setup = json.loads(receive())
    sys.path.extend(setup["path"])
    functions, modules, names = [], {}, setup["parameters"]
    for file, function in setup["functions"]:
        try:
            functions.append(load(file, function, modules))
        except (Exception, SystemExit) as error:
            send(("%s: %s" % (file, describe(error))).encode())
            return
    send(b"")
    while True:
        numbers = array.array("d", receive())
        function, width = functions[int(numbers[0])], len(names)
        results, failures = array.array("d"), {}
        for row, first in enumerate(range(1, len(numbers), width)):
            begin = time.perf_counter()
            value, failure = call(function, dict(zip(names, numbers[first : first + width])))
            results.extend((value, time.perf_counter() - begin))
            if failure:
                failures[row] = failure
        send(results.tobytes() + json.dumps(failures).encode())


main()
