"""Loads libpkmopt.so and converts its errors, texts and arrays (ctypes and numpy)."""

from __future__ import annotations

import ctypes
import difflib
import json
import os
import signal
import threading
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

_SONAME = "libpkmopt.so.0"


class Error(Exception):
    """An error of pkmopt; its text is one sentence."""


class InputError(Error, ValueError):
    """A name, a value or a text is invalid, or the mechanism does not support the request."""


class FileError(Error, OSError):
    """A study file cannot be read or written."""


class DesignError(Error, ValueError):
    """The parameters do not describe a mechanism."""


class Stopped(Error):
    """A computation was stopped by the caller."""


class InternalError(Error, RuntimeError):
    """A bug of pkmopt."""


_OK, _NO_MEMORY = 0, 5
_ERRORS = {1: InputError, 2: FileError, 3: DesignError, 4: Stopped, 6: InternalError}


def _candidates() -> List[str]:
    """Where the library may be: named by the environment, beside the package, in an archive or a source tree, installed."""
    named = os.environ.get("PKMOPT_LIBRARY")
    if named:
        return [named]
    here = Path(__file__).resolve().parent
    found = list(here.glob("lib/" + _SONAME))
    for root in list(here.parents)[1:4]:
        for place in ("lib", "lib/*-linux-gnu", *["build/%s/lib" % b for b in ("quickstart", "release", "ci")]):
            found += root.glob("%s/%s" % (place, _SONAME))
    return [str(path) for path in found] + [_SONAME]


def _load() -> ctypes.CDLL:
    reasons = []
    for name in _candidates():
        try:
            return ctypes.CDLL(name)
        except OSError as error:
            reasons.append(str(error))
    raise ImportError(
        "the library %s was not found: build pkmopt with experiments/quickstart.sh, install its package, or set "
        "PKMOPT_LIBRARY to the library's path (%s)" % (_SONAME, "; ".join(reasons))
    )


class Options(ctypes.Structure):
    """The struct pkmopt_options of the C interface."""


INTERRUPT = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
Options._fields_ = [("threads", ctypes.c_int), ("interrupt", INTERRUPT), ("user", ctypes.c_void_p)]


class Progress(ctypes.Structure):
    """State of a run after a generation."""

    stage: int
    stages: int
    generation: int
    evaluations: int
    evaluation_limit: int
    seconds: float
    best: float
    violation: float
    front: int
    hypervolume: float
    feasible_share: float

    _fields_ = [
        ("stage", ctypes.c_int),
        ("stages", ctypes.c_int),
        ("generation", ctypes.c_int64),
        ("evaluations", ctypes.c_int64),
        ("evaluation_limit", ctypes.c_int64),
        ("seconds", ctypes.c_double),
        ("best", ctypes.c_double),
        ("violation", ctypes.c_double),
        ("front", ctypes.c_size_t),
        ("hypervolume", ctypes.c_double),
        ("feasible_share", ctypes.c_double),
    ]

    def __repr__(self) -> str:
        values = ", ".join("%s=%r" % (name, getattr(self, name)) for name, _ in self._fields_)
        return "Progress(%s)" % values


PROGRESS = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(Progress), ctypes.c_void_p)


class RunOptions(ctypes.Structure):
    """The struct pkmopt_run_options of the C interface."""

    _fields_ = [
        ("common", Options),
        ("time_limit", ctypes.c_double),
        ("overwrite", ctypes.c_int),
        ("progress", PROGRESS),
        ("user", ctypes.c_void_p),
        ("functions", ctypes.c_void_p),
        ("python", ctypes.c_void_p),
    ]


library = _load()
library.pkmopt_version.restype = ctypes.c_char_p
library.pkmopt_error.restype = ctypes.c_char_p
library.pkmopt_free.argtypes = [ctypes.c_void_p]
library.pkmopt_free.restype = None

_evaluate = library.pkmopt_study_evaluate
_evaluate.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_int, *5 * [ctypes.c_void_p]]

version: str = library.pkmopt_version().decode()

_process = os.getpid()
_thread = threading.local()
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)


class _PendingSignals:
    """While a call of the library runs on the main thread: keeps signals instead of calling their Python handlers, which
    would raise within a callback of the library, where the exception is lost. They are called after the library has
    returned. Callbacks may call the library again."""

    def __enter__(self) -> None:
        self.received: List[Tuple[int, Any]] = []
        self._handlers: Dict[int, Any] = {}
        if threading.current_thread() is threading.main_thread():
            for number in _SIGNALS:
                handler = signal.getsignal(number)
                if callable(handler):
                    self._handlers[number] = handler
                    signal.signal(number, self._receive)
        self._outer = getattr(_thread, "pending", None)
        _thread.pending = self

    def _receive(self, number: int, frame: Any) -> None:
        self.received.append((number, frame))

    def __exit__(self, *_exception: Any) -> None:
        _thread.pending = self._outer
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        for number, frame in self.received:
            self._handlers[number](number, frame)  # raises KeyboardInterrupt by default


def is_stop_requested() -> bool:
    """Whether a signal or a failed callback stops the call of the library on this thread."""
    pending = getattr(_thread, "pending", None)
    return bool(pending and pending.received) or getattr(_thread, "exception", None) is not None


def _poll(_user: Any) -> int:
    """Called by the library on the calling thread about every 50 ms. Entering Python lets it receive signals."""
    return 1 if is_stop_requested() else 0


_interrupt = INTERRUPT(_poll)


def set_exception(error: BaseException) -> None:
    """Keeps an exception of a callback until the library has returned."""
    if getattr(_thread, "exception", None) is None:
        _thread.exception = error


def options(threads: int = 0) -> Options:
    return Options(count(threads, "threads", "0 for all cores"), _interrupt, None)


def count(value: Any, what: str, zero: str) -> int:
    """Checks a number that must be >= 1, or 0, which has the given meaning."""
    if not isinstance(value, (int, np.integer)) or value < 0:
        raise ValueError("%s is %r; expected a number >= 1, or %s" % (what, value, zero))
    return int(value)


def call(name: str, *arguments: Any) -> None:
    """Calls a function that returns a status. Raises what a callback or a signal handler raises, or the error of the
    library."""
    if os.getpid() != _process:
        raise RuntimeError(
            "this process was forked from one that uses pkmopt, whose threads it does not have; start processes by "
            'multiprocessing.get_context("spawn")'
        )
    with _PendingSignals():
        status = getattr(library, name)(*arguments)
    exception: Optional[BaseException] = getattr(_thread, "exception", None)
    if exception is not None:
        _thread.exception = None
        raise exception
    if status == _OK:
        return
    if status == _NO_MEMORY:
        raise MemoryError("pkmopt: out of memory")
    raise _ERRORS.get(status, InternalError)(library.pkmopt_error().decode("utf-8", "replace"))


def quick_call(function: Any, *arguments: Any) -> None:
    """As call(), for functions that take microseconds and need not react to signals before they end."""
    if os.getpid() != _process or function(*arguments) != _OK:
        call(function.__name__, *arguments)


def address(array: npt.NDArray[Any]) -> int:
    """Address of the elements of an array. Faster than array.ctypes.data if the array is writable and not empty."""
    try:
        return ctypes.addressof(ctypes.c_char.from_buffer(array))  # type: ignore[arg-type]
    except (TypeError, ValueError):
        data: int = array.ctypes.data
        return data


def handle(create: str, free: str, *arguments: Any) -> "Handle":
    pointer = ctypes.c_void_p()
    call(create, *arguments, ctypes.byref(pointer))
    return Handle(pointer, free)


class Handle:
    """Owns an object of the library."""

    def __init__(self, pointer: ctypes.c_void_p, free: str) -> None:
        self._as_parameter_ = pointer
        self._free: Callable[..., Any] = getattr(library, free)

    # The default arguments keep these functions alive: when the interpreter ends, the names of the module may be
    # deleted before its last objects.
    def __del__(self, getpid: Callable[[], int] = os.getpid, process: int = _process) -> None:
        if self._as_parameter_ and getpid() == process:
            self._free(self._as_parameter_)

    def __reduce__(self) -> Any:
        raise TypeError("objects of pkmopt cannot be pickled; pass the TOML text or the file name instead")


def text(name: str, *arguments: Any) -> str:
    """The text that a function allocates as its last argument."""
    pointer = ctypes.c_void_p()
    call(name, *arguments, ctypes.byref(pointer))
    return _taken(pointer)


def _taken(pointer: ctypes.c_void_p) -> str:
    try:
        return ctypes.string_at(pointer).decode("utf-8")
    finally:
        library.pkmopt_free(pointer)


def parsed(name: str, *arguments: Any) -> Any:
    """The JSON that a function allocates as its last argument."""
    return json.loads(text(name, *arguments))


def taken_json(pointer: ctypes.c_void_p) -> Any:
    return json.loads(_taken(pointer))


def taken_array(pointer: ctypes.c_void_p, shape: Tuple[int, ...], dtype: Any) -> Any:
    """A copy of an array that the library has allocated; the original array is freed."""
    try:
        count = int(np.prod(shape))
        bytes_ = ctypes.string_at(pointer, count * np.dtype(dtype).itemsize)
        return np.frombuffer(bytes_, dtype=dtype).reshape(shape).copy()
    finally:
        library.pkmopt_free(pointer)


def pointer(array: Optional[npt.NDArray[Any]]) -> Optional[ctypes.c_void_p]:
    return None if array is None else ctypes.c_void_p(address(array))


def encoded(value: Optional[str]) -> Optional[bytes]:
    if value is not None and not isinstance(value, str):
        raise TypeError("%r is of type %s; expected a text" % (value, type(value).__name__))
    return None if value is None else value.encode("utf-8")


def suggestion(name: Any, names: Sequence[str]) -> str:
    """Text that suggests the closest known name, for the end of a message."""
    near = difflib.get_close_matches(str(name), names, 1)
    return "; did you mean %r?" % near[0] if near else ""


def size(value: int) -> ctypes.c_size_t:
    return ctypes.c_size_t(value)


def rows(values: Any, what: str, names: Sequence[str], units: Sequence[str]) -> Tuple[Array, bool]:
    """Values as an array [count, names], and whether they were a single row. A dict has arrays, numbers or texts with a
    unit by name."""
    if isinstance(values, dict):
        unknown = [name for name in values if name not in names]
        missing = [name for name in names if name not in values]
        if unknown or missing:
            raise ValueError("%s has %s; expected %s" % (what, ", ".join(map(str, values)), ", ".join(names)))
        columns: List[Any] = [
            number(values[name], unit, name) if isinstance(values[name], str) else np.asarray(values[name], dtype=float)
            for name, unit in zip(names, units)
        ]
        values = np.stack(np.broadcast_arrays(*columns), axis=-1)
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise TypeError("%s has complex numbers; expected real ones" % what)
    array = np.ascontiguousarray(array, dtype=np.float64)
    width = len(names)
    single = array.ndim == 1 and array.size > 0
    if array.ndim == 1:
        array = array.reshape(1, -1) if single else array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(
            "%s has shape %s; expected (%d,) or (count, %d): %s"
            % (what, np.shape(values), width, width, ", ".join(names))
        )
    return array, single


def number(value: Any, unit: str, name: str) -> float:
    """A number, or a text such as "200 mm" in the given SI unit; ``name`` is that of the value, for messages."""
    if isinstance(value, str):
        found = ctypes.c_double()
        if library.pkmopt_number(encoded(value), encoded(unit), ctypes.byref(found)) != _OK:
            raise InputError("%s: found %r; expected a number, alone or with a unit like %s" % (name, value, unit))
        return found.value
    try:
        return float(value)
    except TypeError:
        raise TypeError("%s: found %r; expected a number or a text" % (name, value)) from None
