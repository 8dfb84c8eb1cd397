"""Functions in Python that a study calls: objectives, constraints and outputs of type "python"."""

from __future__ import annotations

import ctypes
import inspect
import os
import sys
from pathlib import Path
from typing import Any, Dict, Iterable, List, Mapping, Sequence, Union

from . import _library as lib
from . import _worker
from ._worker import Function


def name_of(function: Function) -> str:
    """The name of a function in a study: "FILE.py:NAME" if a process can import it, otherwise its own name."""
    name = getattr(function, "__qualname__", type(function).__name__)
    file = _file_of(function)
    if file is None or "<" in name:
        return name.split(".")[-1].strip("<>")
    relative = os.path.relpath(file)
    return "%s:%s" % (file if relative.startswith("..") else relative, name)


def _file_of(function: Any) -> Any:
    try:
        file = inspect.getsourcefile(function)
    except TypeError:
        return None
    return file if file and file.endswith(".py") and os.path.isfile(file) else None


def _hash_of(call: str, function: Function) -> str:
    """Hash of the source text that defines the function; "" if the source is unknown."""
    file = _file_of(function)
    if ":" in call and file:
        source = Path(file).read_bytes()
    else:
        try:
            source = inspect.getsource(function).encode("utf-8")
        except (OSError, TypeError):
            return ""
    return lib.text("pkmopt_hash", ctypes.c_char_p(source), lib.size(len(source)))


def load(call: str, folder: str) -> Function:
    """The function "FILE.py:NAME" of a file in a folder."""
    path, colon, name = call.rpartition(":")
    if not colon:
        raise lib.InputError("the study calls %s, which is in no file; pass functions={%r: ..}" % (call, call))
    file = Path(folder, path).resolve()
    if not file.is_file():
        raise lib.InputError('call = "%s": there is no file %s' % (call, file))
    try:
        return _worker.load(str(file), name)
    except _worker.NoFunction as error:
        raise lib.InputError(str(error)) from None


_FUNCTION = ctypes.CFUNCTYPE(
    ctypes.c_int,
    ctypes.c_char_p,
    ctypes.POINTER(ctypes.c_double),
    ctypes.POINTER(ctypes.c_double),
    ctypes.c_void_p,
    ctypes.c_size_t,
    ctypes.c_void_p,
)


class _Struct(ctypes.Structure):
    """The struct pkmopt_functions of the C interface."""

    _fields_ = [
        ("function", _FUNCTION),
        ("user", ctypes.c_void_p),
        ("count", ctypes.c_size_t),
        ("calls", ctypes.POINTER(ctypes.c_char_p)),
        ("hashes", ctypes.POINTER(ctypes.c_char_p)),
    ]


class Connected:
    """Functions that the library calls. The object must be kept as long as the library may call them."""

    def __init__(self, functions: Mapping[str, Function], parameters: Sequence[str]) -> None:
        self._functions = dict(functions)
        self._parameters = list(parameters)
        calls = [call.encode("utf-8") for call in self._functions]
        hashes = [_hash_of(call, function).encode("utf-8") for call, function in self._functions.items()]
        texts = ctypes.c_char_p * max(1, len(calls))
        self._texts = texts(*calls), texts(*hashes)
        self.struct = _Struct(_FUNCTION(self._call), None, len(calls), *self._texts)

    def _call(self, call: bytes, parameters: Any, value: Any, reason: int, capacity: int, _user: Any) -> int:
        design = dict(zip(self._parameters, parameters[: len(self._parameters)]))
        try:
            value[0], failure = _worker.call(self._functions[call.decode("utf-8")], design)
        except BaseException as error:
            lib.set_exception(error)
            failure = _worker.describe(error)
        if not failure:
            return 0
        text = failure.encode("utf-8", "replace")[: capacity - 1] + b"\0"
        ctypes.memmove(reason, text, len(text))
        return 1


class PythonOptions(ctypes.Structure):
    """The struct pkmopt_python of the C interface."""

    _fields_ = [("workers", ctypes.c_int), ("program", ctypes.c_char_p), ("path", ctypes.c_char_p)]


def python_options(workers: int) -> PythonOptions:
    """Options for worker processes that use this interpreter and the folders of modules of this process."""
    path = ":".join(os.path.abspath(folder) for folder in sys.path if ":" not in folder)
    return PythonOptions(lib.count(workers, "workers", "0 for one per core"), os.fsencode(sys.executable), os.fsencode(path))


def by_name(functions: Union[Mapping[str, Function], Iterable[Function]]) -> Dict[str, Function]:
    if isinstance(functions, Mapping):
        return dict(functions)
    return {name_of(function): function for function in functions}


def take_functions(entries: List[Dict[str, Any]], into: Dict[str, Function]) -> List[Dict[str, Any]]:
    """Replaces functions in the entries of a study by their names, and adds the functions to `into`."""
    for entry in entries:
        function = entry.get("call")
        if callable(function):
            name, number = name_of(function), 1
            while into.setdefault(name, function) is not function:  # two lambdas, for example
                number += 1
                name = "%s_%d" % (name_of(function), number)
            entry["call"] = name
    return entries


def refuse_in_worker() -> None:
    if os.environ.get(_worker.WORKER):
        raise RuntimeError(
            "a file whose functions a study calls runs a study when it is imported; put that part below "
            'if __name__ == "__main__":'
        )
