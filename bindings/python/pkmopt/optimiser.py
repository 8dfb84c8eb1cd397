"""Optimisers for your own functions: ask() returns designs, tell() passes their values to the optimiser."""

from __future__ import annotations

import ctypes
import json
import zipfile
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _library as lib
from . import _toml
from ._library import Array


class Told(NamedTuple):
    """All evaluations of an optimiser so far."""

    designs: Array
    objectives: Array
    constraints: Array
    status: Any
    best: int  #: row of the best one, as the optimiser ranks them; -1: none yet


class Optimiser:
    """An optimiser with an ask-and-tell interface: you evaluate the designs that it requests.

    ``bounds`` are (min, max) or (min, max, step) by variable, ``maximise`` is a flag, or one by objective, and further
    keywords are the options of the optimiser, see `pkmopt list optimisers`. The same arguments and values give the same
    designs, on every machine.

    >>> optimiser = Optimiser("ga", [(-2, 2), (-2, 2)], generations=30, population=20, seed=1)
    >>> while not optimiser.finished:
    ...     X = optimiser.ask()
    ...     optimiser.tell(X, [(x - 1) ** 2 + (y + 0.5) ** 2 for x, y in X])
    >>> [round(x, 1) for x in optimiser.best]
    [1.0, -0.5]
    """

    def __init__(
        self,
        name: str,
        bounds: Sequence[Any],
        *,
        objectives: int = 1,
        maximise: Union[bool, Sequence[bool]] = False,
        constraints: int = 0,
        seed: int = 1,
        **options: Any,
    ) -> None:
        flags = [bool(maximise)] * objectives if isinstance(maximise, (bool, np.bool_)) else [bool(m) for m in maximise]
        if len(flags) != objectives:
            raise ValueError("maximise has %d flags; the problem has %d objectives" % (len(flags), objectives))
        for what, value, least in (("objectives", objectives, 1), ("constraints", constraints, 0), ("seed", seed, 0)):
            if value < least:
                raise ValueError("%s is %r; expected a number >= %d" % (what, value, least))
        if len(bounds) == 0 or any(np.ndim(each) != 1 or len(each) not in (2, 3) for each in bounds):
            raise ValueError("bounds is %r; expected (min, max) or (min, max, step) for each variable" % (bounds,))
        self._arguments: Dict[str, Any] = {
            "name": name,
            "bounds": [[float(x) for x in each] for each in bounds],
            "objectives": objectives,
            "maximise": flags,
            "constraints": constraints,
            "seed": seed,
            **options,
        }
        lower = np.array([each[0] for each in bounds], dtype=float)
        upper = np.array([each[1] for each in bounds], dtype=float)
        step = np.array([each[2] if len(each) > 2 else 0 for each in bounds], dtype=float)
        self._variables, self._objectives, self._constraints = len(bounds), objectives, constraints
        self._handle = lib.handle(
            "pkmopt_optimiser_create",
            "pkmopt_optimiser_free",
            lib.encoded(_toml.lines({"optimiser": name, **options})),
            lib.size(len(bounds)),
            lib.pointer(lower),
            lib.pointer(upper),
            lib.pointer(step),
            lib.size(objectives),
            (ctypes.c_int * objectives)(*flags),
            lib.size(constraints),
            ctypes.c_uint64(seed),
        )
        self._fetch()

    def _fetch(self) -> None:
        """Takes the next batch of designs from the optimiser."""
        count, designs = ctypes.c_size_t(), ctypes.POINTER(ctypes.c_double)()
        derivatives = ctypes.c_int()
        lib.call(
            "pkmopt_optimiser_ask",
            self._handle,
            ctypes.byref(count),
            ctypes.byref(designs),
            ctypes.byref(derivatives),
        )
        n = count.value
        self._batch = (
            np.ctypeslib.as_array(designs, shape=(n, self._variables)).copy() if n else np.empty((0, self._variables))
        )
        self._asked = self._told = 0
        self._F = np.full((n, self._objectives), np.nan)
        self._G = np.full((n, self._constraints), np.nan)
        functions = self._objectives + self._constraints
        self.needs_derivatives = bool(derivatives.value)  #: whether tell() needs dF, and dG if there are constraints
        self._D = np.full((n, functions, self._variables), np.nan) if self.needs_derivatives else None

    @property
    def finished(self) -> bool:
        """Whether the optimiser has ended, i.e. requests no more designs."""
        return len(self._batch) == 0

    def ask(self, n: Optional[int] = None) -> Array:
        """The next designs to evaluate [count, variables]: all that the optimiser needs at once, such as a generation,
        or at most ``n`` of them. Empty if all requested designs have been returned, or if the optimiser has ended."""
        if n is not None and n < 0:
            raise ValueError("n is %r; expected a number >= 0, or None for all" % n)
        end = len(self._batch) if n is None else min(len(self._batch), self._asked + n)
        designs = self._batch[self._asked : end].copy()
        self._asked = end
        return designs

    def tell(self, X: Any, F: Any, G: Any = None, dF: Any = None, dG: Any = None) -> None:
        """Passes the values of designs to the optimiser, in the order in which ask() returned the designs.

        ``F`` has the objectives [count, objectives] or [count]; NaN: the design failed. ``G`` has the constraints
        [count, constraints], satisfied if >= 0. ``dF`` and ``dG`` are derivatives [count, .., variables], for
        optimisers that need them.
        """
        x = np.atleast_2d(np.asarray(X, dtype=float))
        first, end = self._told, self._told + len(x)
        if end > self._asked or not np.array_equal(x, self._batch[first:end]):
            raise ValueError("these are not the designs of the last ask(), in their order")
        self._F[first:end] = self._shaped(F, (len(x), self._objectives), "F")
        if self._constraints:
            self._G[first:end] = self._shaped(G, (len(x), self._constraints), "G")
        elif G is not None and np.size(G):
            raise ValueError("G has values, but the problem has no constraints")
        if self._D is not None:
            n = self._variables
            self._D[first:end, : self._objectives] = self._shaped(dF, (len(x), self._objectives, n), "dF")
            if self._constraints:
                self._D[first:end, self._objectives :] = self._shaped(dG, (len(x), self._constraints, n), "dG")
        self._told = end
        if end < len(self._batch):
            return
        lib.call(
            "pkmopt_optimiser_tell",
            self._handle,
            lib.pointer(self._F),
            lib.pointer(self._G) if self._constraints else None,
            lib.pointer(self._D),
            None,
        )
        self._fetch()

    def __repr__(self) -> str:
        bounds, name = self._arguments["bounds"], self._arguments["name"]
        return "<Optimiser %s: %d variables, %d evaluations>" % (name, len(bounds), len(self.evaluations.designs))

    @staticmethod
    def _shaped(values: Any, shape: Any, what: str) -> Array:
        if values is None:
            raise ValueError("%s is missing; expected an array of shape %s" % (what, shape))
        array = np.asarray(values, dtype=float)
        if array.size != int(np.prod(shape)):
            raise ValueError("%s has shape %s; expected %s" % (what, array.shape, shape))
        return array.reshape(shape)

    @property
    def evaluations(self) -> Told:
        """All evaluations that the optimiser has been told."""
        rows, best = ctypes.c_size_t(), ctypes.c_int64()
        counted = [None] * 4
        lib.call("pkmopt_optimiser_evaluations", self._handle, ctypes.byref(rows), *counted, ctypes.byref(best))
        n = rows.value
        found: List[Array] = [np.empty((n, w)) for w in (self._variables, self._objectives, self._constraints)]
        status: Any = np.empty(n, dtype=np.uint8)
        lib.call(
            "pkmopt_optimiser_evaluations",
            self._handle,
            ctypes.byref(rows),
            *[lib.pointer(each) for each in (*found, status)],
            ctypes.byref(best),
        )
        return Told(found[0], found[1], found[2], status, best.value)

    @property
    def best(self) -> Optional[Array]:
        """The best design so far; with several objectives a compromise. None if there is none yet."""
        told = self.evaluations
        return None if told.best < 0 else told.designs[told.best]

    def save(self, path: Union[str, Path]) -> None:
        """Saves the optimiser, with what it has been told, as a numpy file (.npz)."""
        told = self._history()
        with open(path, "wb") as file:
            np.savez(file, arguments=np.array(json.dumps(self._arguments)), **told)

    def _history(self) -> Dict[str, Any]:
        told = self.evaluations
        if self.needs_derivatives:
            raise lib.InputError("an optimiser that needs derivatives cannot be saved")
        partial = slice(0, self._told)
        return {
            "designs": np.concatenate([told.designs, self._batch[partial]]),
            "objectives": np.concatenate([told.objectives, self._F[partial]]),
            "constraints": np.concatenate([told.constraints, self._G[partial]]),
        }

    @classmethod
    def load(cls, path: Union[str, Path]) -> "Optimiser":
        """Continues a saved optimiser: it runs again and is told the saved values, which restores its state."""
        try:
            with np.load(path) as saved:
                arguments = json.loads(str(saved["arguments"]))
                designs, F, G = saved["designs"], saved["objectives"], saved["constraints"]
        except (KeyError, ValueError, zipfile.BadZipFile):
            raise lib.FileError("%s: found no saved optimiser; expected a file of Optimiser.save()" % path) from None
        optimiser = cls(arguments.pop("name"), arguments.pop("bounds"), **arguments)
        first = 0
        while first < len(designs):
            X = optimiser.ask(len(designs) - first)
            end = first + len(X)
            if len(X) == 0 or not np.array_equal(X, designs[first:end]):
                raise lib.InputError("%s: the saved designs are not those of this version of pkmopt" % path)
            optimiser.tell(X, F[first:end], G[first:end] if G.shape[1] else None)
            first = end
        return optimiser


def optimiser_names() -> List[str]:
    """Names of the optimisers."""
    names: List[str] = lib.parsed("pkmopt_optimiser_names")
    return names
