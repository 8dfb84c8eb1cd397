"""Design problems, studies and their results."""

from __future__ import annotations

import ctypes
import html
import os
import tempfile
import time
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _functions
from . import _library as lib
from . import _toml
from ._library import Array, Progress
from ._worker import Function
from .mechanism import Mechanism

Path_ = Union[str, Path]
Table = Union[str, Mapping[str, Any]]
Entry = Union[Table, Function]

#: Time of an evaluation [s] below which it need not be interrupted.
_QUICK = 0.01

#: Values of Evaluation.status.
FEASIBLE, INFEASIBLE, REJECTED, FAILED = range(4)


class Evaluation(NamedTuple):
    """Values of evaluated designs; of a single design without the first dimension."""

    objectives: Array  #: [count, objectives]
    constraints: Array  #: margins [count, constraints], satisfied if >= 0
    outputs: Array  #: [count, outputs]
    status: Any  #: [count]: FEASIBLE, INFEASIBLE, REJECTED or FAILED


class Derivatives(NamedTuple):
    """Values and exact derivatives; those of non-smooth values belong to a smooth approximation."""

    evaluation: Evaluation
    objectives: Array  #: [count, objectives, variables]
    constraints: Array  #: [count, constraints, variables]


class Variable(NamedTuple):
    """A design variable."""

    name: str
    unit: str
    min: float
    max: float
    step: float


def _entries(entries: Union[Entry, Sequence[Entry]]) -> List[Dict[str, Any]]:
    """[[objective]]s and the like: names, functions, or dicts with the keys of the table."""
    if isinstance(entries, (str, Mapping)) or callable(entries):
        all_entries: Sequence[Entry] = [entries]
    else:
        all_entries = entries
    tables: List[Dict[str, Any]] = []
    for each in all_entries:
        if isinstance(each, str):
            tables.append({"type": each})
        elif isinstance(each, Mapping):
            tables.append(dict(each))
        else:
            tables.append({"type": "python", "call": each})
    return tables


def _range(name: str, bounds: Any) -> Dict[str, Any]:
    if isinstance(bounds, Mapping):
        return dict(bounds)
    if isinstance(bounds, (tuple, list, np.ndarray)) and len(bounds) in (2, 3):
        return dict(zip(("min", "max", "step"), bounds))
    raise ValueError("variable %s has %r; expected (min, max), (min, max, step) or a dict" % (name, bounds))


class Problem:
    """A design problem: variables, objectives, constraints and outputs of a mechanism.

    ``variables`` maps names to (min, max), (min, max, step) or the keys of the table; objectives, constraints, outputs
    and stages are names or dicts with the keys of their tables. All values may be numbers in SI units or texts with a
    unit. ``parameters={"r": "50 mm"}`` are values of parameters that do not vary. Further keywords are further tables of
    a study, such as ``workspace={"method": "voxels", ..}``.

    A function is an objective, too: it gets a dict of all parameters in SI units and returns a number, which is
    minimised unless ``{"type": "python", "call": function, "direction": "maximise"}`` says otherwise. An error in it
    fails the design; :meth:`why_failed` has the traceback. Functions must depend on their argument only.

    >>> problem = Problem("4ppa-2par", variables={"a": (0.2, 0.5)}, objectives="workspace-volume")
    >>> problem.evaluate([0.3]).objectives.shape
    (1,)
    """

    def __init__(
        self,
        mechanism: Union[Mechanism, str],
        variables: Mapping[str, Any],
        objectives: Union[Entry, Sequence[Entry]],
        constraints: Union[Entry, Sequence[Entry]] = (),
        outputs: Union[Entry, Sequence[Entry]] = (),
        stages: Union[Table, Sequence[Table]] = (),
        *,
        name: str = "study",
        seed: int = 1,
        **tables: Any,
    ) -> None:
        if not isinstance(mechanism, Mechanism):
            mechanism = Mechanism(mechanism)
        if not isinstance(variables, Mapping):
            raise TypeError('variables is %r; expected a dict such as {"a": (0.2, 0.5)}' % (variables,))
        document: Dict[str, Any] = {"study": {"name": name, "seed": seed}}
        document.update(mechanism._study_tables())
        if "parameters" in tables:  # fixed values, which are a key of [mechanism]
            document["mechanism"]["parameters"] = tables.pop("parameters")
        document["variables"] = {key: _range(key, bounds) for key, bounds in variables.items()}
        document.update(tables)
        functions: Dict[str, Function] = {}
        for key, entries in (("objective", objectives), ("constraint", constraints), ("output", outputs)):
            document[key] = _functions.take_functions(_entries(entries), functions)
        document["stage"] = [
            {"optimiser": each} if isinstance(each, str) else dict(each)
            for each in ([stages] if isinstance(stages, (str, Mapping)) else stages)
        ]
        self._read(
            _toml.document({key: table for key, table in document.items() if table != []}),
            name + ".toml",
            mechanism._study_text(),
            mechanism._file_name,
        )
        self.connect(functions)

    @classmethod
    def from_toml(cls, path: Path_, changes: Sequence[str] = ()) -> Any:
        """Reads a study file in TOML, and the Python files of functions that it calls. ``changes`` are "set NAME=VALUE",
        "limit NAME=VALUE" or "cells NAME=NUMBER"."""
        self = cls.__new__(cls)
        self._set(
            lib.handle(
                "pkmopt_study_from_file",
                "pkmopt_study_free",
                lib.encoded(str(path)),
                lib.encoded("\n".join(changes)),
            )
        )
        self._folder = os.path.dirname(str(path))
        self.connect()
        return self

    @classmethod
    def from_text(cls, toml: str, file_name: str = "study.toml", mechanism: Optional[Mechanism] = None) -> Any:
        """Reads the text of a study; ``mechanism`` is the one that its [mechanism] file = ".." names."""
        self = cls.__new__(cls)
        text = mechanism.to_toml() if mechanism else None
        self._read(toml, file_name, text, mechanism._file_name if mechanism else None)
        self.connect()
        return self

    def connect(self, functions: Union[Mapping[str, Function], Sequence[Function]] = ()) -> None:
        """Connects the functions that the study calls: those given, by their names in the study, and others from their
        files. A new problem is connected; the study of a study file is not, because its functions would be run."""
        given = _functions.by_name(functions)
        calls: List[str] = self.info["functions"]
        unknown = [name for name in given if name not in calls]
        if unknown:
            raise ValueError("the study calls %s, not %s" % (", ".join(calls) or "no function", ", ".join(unknown)))
        if calls:
            found = {call: given[call] if call in given else _functions.load(call, self._folder) for call in calls}
            self._connected = _functions.Connected(found, [p["name"] for p in self.info["parameters"]])
            lib.call("pkmopt_study_set_functions", self._handle, ctypes.byref(self._connected.struct))

    def start_workers(self, count: int = 0) -> None:
        """Has the functions that the study calls called by ``count`` processes, by default one per core. The functions
        must be in files that can be imported."""
        _functions.refuse_in_worker()
        python, options = _functions.python_options(count), lib.options()
        lib.call(
            "pkmopt_study_start_workers",
            self._handle,
            lib.encoded(self._folder),
            ctypes.byref(python),
            ctypes.byref(options),
        )

    def _read(self, toml: str, file_name: str, mechanism: Optional[str], mechanism_file: Optional[str]) -> None:
        texts = [lib.encoded(each) for each in (toml, file_name, mechanism, mechanism_file, None)]
        self._set(lib.handle("pkmopt_study_from_text", "pkmopt_study_free", *texts))

    def _set(self, handle: lib.Handle) -> None:
        self._handle = handle
        self.info: Dict[str, Any] = lib.parsed("pkmopt_study_info", handle)
        self._folder = ""  # where files of functions are
        self._is_quick = False  # whether the last evaluation of a single design was
        self._names = [v["name"] for v in self.info["variables"]]
        self._units = [v["unit"] for v in self.info["variables"]]
        self._widths = [len(self.info[key]) for key in ("objectives", "constraints", "outputs")]

    @property
    def name(self) -> str:
        return str(self.info["name"])

    @property
    def variables(self) -> List[Variable]:
        return [Variable(v["name"], v["unit"], v["min"], v["max"], v["step"]) for v in self.info["variables"]]

    @property
    def objectives(self) -> List[str]:
        """Names of the objectives, in their order."""
        return [each["name"] for each in self.info["objectives"]]

    @property
    def constraints(self) -> List[str]:
        """Names of the constraints that have margins, in their order; limits of poses cut the workspace instead."""
        return [each["name"] for each in self.info["constraints"]]

    @property
    def outputs(self) -> List[str]:
        return [each["name"] for each in self.info["outputs"]]

    @property
    def warnings(self) -> List[str]:
        return list(self.info["warnings"])

    @property
    def baseline(self) -> Optional[Array]:
        """The variables of the baseline; None if the study has none."""
        if self.info["baseline"] is None:
            return None
        return np.array([self.info["baseline"][v["parameter"]] for v in self.info["variables"]])

    def to_toml(self) -> str:
        """The text of the study."""
        return str(self.info["text"])

    def evaluate(self, designs: Any, *, complete: bool = True, threads: int = 0) -> Evaluation:
        """Evaluates designs on all threads: an array [count, variables], one design, or a dict of variables. They may be
        outside of the bounds of the variables, but not outside of what the mechanism allows.

        A design that cannot be evaluated has the status FAILED and NaN; :meth:`why_failed` says why. Without
        ``complete``, the evaluation of a design ends at a violated constraint that depends on the design alone, as in
        the optimisers.
        """
        x, single = self._designs(designs)
        if single and self._is_quick:
            return self._evaluate_quickly(x, complete)
        found = self._empty(len(x))
        options = lib.options(threads)
        start = time.perf_counter()
        lib.call(
            "pkmopt_study_evaluate",
            self._handle,
            len(x),
            lib.address(x),
            1 if complete else 0,
            *[lib.address(each) for each in found],
            ctypes.addressof(options),
        )
        if not single:
            return found
        self._is_quick = time.perf_counter() - start < _QUICK and not self.info["functions"]
        return Evaluation(*[each[0] for each in found])

    def _evaluate_quickly(self, x: Array, complete: bool) -> Evaluation:
        """One design whose evaluation takes as long as the call from Python."""
        objectives, constraints, outputs = self._widths
        values = np.empty(objectives + constraints + outputs)
        status = ctypes.c_uint8()
        at = lib.address(values)
        lib.quick_call(
            lib._evaluate,
            self._handle._as_parameter_,
            1,
            lib.address(x),
            1 if complete else 0,
            at,
            at + 8 * objectives,
            at + 8 * (objectives + constraints),
            ctypes.addressof(status),
            None,
        )
        split = objectives + constraints
        return Evaluation(values[:objectives], values[objectives:split], values[split:], status.value)

    def differentiate(self, designs: Any, *, threads: int = 0) -> Derivatives:
        """Evaluates designs with exact derivatives by all variables; needs columns."""
        x, single = self._designs(designs)
        found = self._empty(len(x))
        objectives, constraints, _ = self._widths
        rows = np.empty((len(x), objectives + constraints, 1 + x.shape[1]))
        options = lib.options(threads)
        lib.call(
            "pkmopt_study_differentiate",
            self._handle,
            lib.size(len(x)),
            lib.pointer(x),
            *[lib.pointer(each) for each in (*found, rows)],
            ctypes.byref(options),
        )
        of_objectives, of_constraints = rows[:, :objectives, 1:], rows[:, objectives:, 1:]
        if single:
            return Derivatives(Evaluation(*[each[0] for each in found]), of_objectives[0], of_constraints[0])
        return Derivatives(found, of_objectives, of_constraints)

    def why_failed(self, design: Any) -> str:
        """Why a design failed, one sentence."""
        x, single = self._designs(design)
        if not single and len(x) != 1:
            raise ValueError("design has %d designs; expected one" % len(x))
        sentence = ctypes.c_void_p()
        options = lib.options()
        lib.call(
            "pkmopt_study_why_failed", self._handle, lib.pointer(x), ctypes.byref(sentence), ctypes.byref(options)
        )
        return lib._taken(sentence)

    def as_scipy(self) -> "ScipyProblem":
        """The problem for scipy.optimize, with a single objective."""
        return ScipyProblem(self)

    def _designs(self, designs: Any) -> Any:
        return lib.rows(designs, "designs", self._names, self._units)

    def _empty(self, count: int) -> Evaluation:
        objectives, constraints, outputs = [np.empty((count, width)) for width in self._widths]
        return Evaluation(objectives, constraints, outputs, np.empty(count, dtype=np.uint8))

    def __repr__(self) -> str:
        return "<%s %r: %s; %s>" % (
            type(self).__name__,
            self.name,
            ", ".join(v.name for v in self.variables),
            ", ".join(self.objectives),
        )


class ScipyProblem:
    """Functions for scipy.optimize: minimises, and all constraints are >= 0.

    ::

        p = problem.as_scipy()
        scipy.optimize.minimize(p.fun, p.x0, jac=p.jac, bounds=p.bounds, constraints=p.constraints, method="SLSQP")
        scipy.optimize.differential_evolution(p.penalised, p.bounds, vectorized=True)
    """

    def __init__(self, problem: Problem) -> None:
        if len(problem.objectives) != 1:
            raise lib.InputError("scipy minimises one objective; the problem has %d" % len(problem.objectives))
        self.problem = problem
        self._sign = -1.0 if problem.info["objectives"][0]["maximise"] else 1.0
        self.bounds = [(v.min, v.max) for v in problem.variables]
        self.x0: Array = problem.baseline if problem.baseline is not None else np.mean(self.bounds, axis=1)
        self.constraints: List[Dict[str, Any]] = []
        if problem.constraints:
            self.constraints = [{"type": "ineq", "fun": self.margins, "jac": self.margins_jac}]
        self._last: Dict[str, Any] = {}

    def _evaluated(self, x: Any) -> Evaluation:
        key = np.asarray(x, dtype=float).tobytes()
        if self._last.get("key") != key:
            self._last = {"key": key, "evaluation": self.problem.evaluate(x)}
        found: Evaluation = self._last["evaluation"]
        return found

    def _differentiated(self, x: Any) -> Derivatives:
        key = np.asarray(x, dtype=float).tobytes()
        if self._last.get("key") != key or "derivatives" not in self._last:
            found = self.problem.differentiate(x)
            self._last = {"key": key, "evaluation": found.evaluation, "derivatives": found}
        derivatives: Derivatives = self._last["derivatives"]
        return derivatives

    def fun(self, x: Any) -> float:
        return self._sign * float(self._evaluated(x).objectives[0])

    def jac(self, x: Any) -> Array:
        slopes: Array = self._sign * self._differentiated(x).objectives[0]
        return slopes

    def margins(self, x: Any) -> Array:
        return self._evaluated(x).constraints

    def margins_jac(self, x: Any) -> Array:
        return self._differentiated(x).constraints

    def penalised(self, x: Any) -> Any:
        """The objective for methods without constraints, of one design or of the columns of an array: violated designs
        are worse than all satisfied ones by their violation; failed ones are infinite."""
        x = np.asarray(x, dtype=float)
        found = self.problem.evaluate(x.T if x.ndim == 2 else x)
        values = self._sign * np.atleast_2d(found.objectives)[:, 0]
        violation = np.sum(np.maximum(0, -np.atleast_2d(found.constraints)), axis=1)
        status = np.atleast_1d(found.status)
        values = np.where(violation > 0, 1e6 * (1 + violation), values)
        values = np.where((status == FAILED) | ~np.isfinite(values), np.inf, values)
        return values if x.ndim == 2 else float(values[0])


class Study(Problem):
    """A design problem with a chain of optimisers (``stages``), which runs and writes a study file.

    >>> study = Study("4ppa-2par", {"a": (0.2, 0.5)}, "workspace-volume", stages={"optimiser": "ga", "generations": 20})
    >>> study.run("study.h5").best                                                    # doctest: +SKIP
    """

    def run(
        self,
        path: Optional[Path_] = None,
        *,
        callback: Optional[Callable[[Progress], Any]] = None,
        threads: int = 0,
        time_limit: Optional[float] = None,
        seed: Optional[int] = None,
        overwrite: bool = False,
        workers: int = 0,
    ) -> "Results":
        """Runs the study and writes its file, with the same bits as `pkmopt run`.

        ``callback`` is called after each generation with the :class:`Progress`; if it returns True, the run stops with
        a checkpoint. Ctrl-C stops with a checkpoint, too, and raises KeyboardInterrupt; :func:`resume` continues.
        Without ``path`` the file is the study's output. Functions in Python are called in this process, or by
        ``workers`` processes; the results are the same.
        """
        if seed is not None and not 0 <= seed < 2**63:
            raise ValueError("seed is %r; expected a number >= 0, or None for that of the study" % seed)
        if workers != 0:
            self.start_workers(workers)
        file = str(path if path is not None else self.info["output"])
        outcome = _run(
            "pkmopt_study_run",
            [self._handle, lib.encoded(file), ctypes.c_int64(-1 if seed is None else seed)],
            callback,
            threads,
            time_limit,
            overwrite,
        )
        return Results(file, outcome)


def resume(
    path: Path_,
    *,
    generations: int = 0,
    evaluations: int = 0,
    callback: Optional[Callable[[Progress], Any]] = None,
    threads: int = 0,
    time_limit: Optional[float] = None,
    functions: Union[Mapping[str, Function], Sequence[Function]] = (),
    workers: int = 0,
) -> "Results":
    """Continues a stopped study from its file, or extends the last stage of a finished one to ``generations`` or
    ``evaluations`` in total.

    Functions in Python are those of ``functions``, called in this process, or else called from their files by
    ``workers`` processes. They must be the same as when the study was started.
    """
    given = _functions.by_name(functions)
    connected = None
    if given:
        with Results(path) as results:
            info = results.study.info
        found = {call: given[call] if call in given else _functions.load(call, "") for call in info["functions"]}
        connected = _functions.Connected(found, [p["name"] for p in info["parameters"]])
    given_limits = {"generations": generations, "evaluations": evaluations}
    limits = [ctypes.c_int64(lib.count(n, what, "0 for no extension")) for what, n in given_limits.items()]
    outcome = _run(
        "pkmopt_study_resume",
        [lib.encoded(str(path)), *limits],
        callback,
        threads,
        time_limit,
        overwrite=True,
        connected=connected,
        workers=workers,
    )
    return Results(path, outcome)


def _run(
    function: str,
    arguments: List[Any],
    callback: Optional[Callable[[Progress], Any]],
    threads: int,
    time_limit: Optional[float],
    overwrite: bool,
    connected: Optional[_functions.Connected] = None,
    workers: int = 0,
) -> Dict[str, Any]:
    _functions.refuse_in_worker()

    def report(progress: Any, _user: Any) -> int:
        try:
            copy = Progress.from_buffer_copy(progress.contents)
            if callback is not None and callback(copy):
                return 1
        except BaseException as error:
            lib.set_exception(error)
        return 1 if lib.is_stop_requested() else 0

    if time_limit is not None and not time_limit > 0:
        raise ValueError("time_limit is %r; expected a time in s above 0, or None" % time_limit)
    options = lib.RunOptions()
    options.common = lib.options(threads)
    options.time_limit = time_limit or 0
    options.overwrite = 1 if overwrite else 0
    options.progress = lib.PROGRESS(report)
    python = _functions.python_options(workers)
    options.python = ctypes.addressof(python)
    options.functions = ctypes.addressof(connected.struct) if connected else None
    outcome: Dict[str, Any] = lib.parsed(function, *arguments, ctypes.byref(options))
    return outcome


class Results:
    """The contents of a study file; a context manager. Made by :func:`open_study` or :meth:`Study.run`."""

    def __init__(self, path: Path_, outcome: Optional[Dict[str, Any]] = None) -> None:
        self.path = str(path)
        self.outcome = outcome or {}  #: of the run that has just ended: stopped, seconds, evaluations, ..
        self._handle: Optional[lib.Handle] = lib.handle(
            "pkmopt_results_open", "pkmopt_results_free", lib.encoded(self.path)
        )
        self.info: Dict[str, Any] = lib.parsed("pkmopt_results_info", self._handle)
        self._study: Optional[Study] = None

    def __enter__(self) -> "Results":
        return self

    def __exit__(self, *_exception: Any) -> None:
        self.close()

    def close(self) -> None:
        self._handle = None

    def _open_handle(self) -> lib.Handle:
        if self._handle is None:
            raise ValueError("%s is closed" % self.path)
        return self._handle

    @property
    def study(self) -> Study:
        """The study, to evaluate further designs."""
        if self._study is None:
            study = Study.__new__(Study)
            study._set(lib.handle("pkmopt_results_study", "pkmopt_study_free", self._open_handle()))
            self._study = study
        return self._study

    @property
    def state(self) -> str:
        """ "finished", "interrupted" or "running"."""
        return str(self.info["state"])

    @property
    def best(self) -> Optional[Dict[str, Any]]:
        """The best design: parameters, objectives, constraints, outputs; None if there is none."""
        best: Optional[Dict[str, Any]] = self.info["best"]
        return best

    @property
    def stages(self) -> List[Dict[str, Any]]:
        """Optimiser, rows, generations and best row of each stage."""
        return list(self.info["tables"])

    def evaluations(self, stage: int = -1) -> Any:
        """All evaluations of a stage, a numpy record array: the variables, objectives, constraints and outputs by name,
        ``status``, ``generation`` and ``seconds``."""
        number = self._stage(stage)
        study = self.study
        count = int(self.stages[number]["rows"])
        widths = [len(study.variables), *study._widths]
        blocks: List[Array] = [np.empty((count, width)) for width in widths]
        status: Any = np.empty(count, dtype=np.uint8)
        generation: Any = np.empty(count, dtype=np.int64)
        seconds: Array = np.empty(count)
        lib.call(
            "pkmopt_results_evaluations",
            self._open_handle(),
            lib.size(number),
            *[lib.pointer(each) for each in (*blocks, status, generation, seconds)],
        )
        names = [v.name for v in study.variables] + study.objectives + study.constraints + study.outputs
        columns = [(name, block[:, i]) for name, (block, i) in zip(names, _columns(blocks))]
        columns += [("status", status), ("generation", generation), ("seconds", seconds)]
        seen: Dict[str, int] = {}
        fields = []
        for name, column in columns:  # an objective and an output may have the same name
            seen[name] = seen.get(name, 0) + 1
            fields.append((name if seen[name] == 1 else "%s_%d" % (name, seen[name]), column.dtype))
        records = np.empty(count, dtype=fields)
        for (name, _), (_, column) in zip(fields, columns):
            records[name] = column
        return records.view(np.recarray)

    def population(self, generation: int = -1, stage: int = -1) -> Any:
        """The evaluations of the population of a generation, by default of the last one."""
        number = self._stage(stage)
        generations = int(self.stages[number]["generations"])
        index = generation + generations if generation < 0 else generation
        if not 0 <= index < generations:
            raise IndexError("generation %d; the stage has %d" % (generation, generations))
        return self.evaluations(number)[self._rows(number, index)]

    @property
    def front(self) -> Any:
        """The Pareto front of the last stage that has one: its evaluations, from best to worst in the first objective;
        empty if there is none."""
        for number in reversed(range(len(self.stages))):
            rows = self._rows(number, -1)
            if len(rows) > 0:
                return self.evaluations(number)[rows]
        return self.evaluations()[:0]

    def to_dataframe(self, stage: int = -1) -> Any:
        """The evaluations as a pandas.DataFrame."""
        import pandas  # type: ignore[import]

        return pandas.DataFrame.from_records(self.evaluations(stage))

    def report(self, path: Optional[Path_] = None, overwrite: bool = False) -> str:
        """Writes the report, an HTML page with plots. Returns its path, by default that of the study with .html."""
        output = str(path) if path is not None else str(Path(self.path).with_suffix(".html"))
        paths = (ctypes.c_char_p * 1)(lib.encoded(self.path))
        options = lib.options()
        lib.call(
            "pkmopt_report",
            lib.size(1),
            paths,
            lib.encoded(output),
            ctypes.c_int(1 if overwrite else 0),
            ctypes.byref(options),
        )
        return output

    def plot_convergence(self, axes: Any = None) -> Any:
        """Plots the best feasible value of the first objective against the evaluations (matplotlib)."""
        from . import plots

        return plots.convergence(self, axes)

    def plot_front(self, axes: Any = None) -> Any:
        """Plots the Pareto front of the first two objectives (matplotlib)."""
        from . import plots

        return plots.front(self, axes)

    def _stage(self, stage: int) -> int:
        count = len(self.stages)
        index = stage + count if stage < 0 else stage
        if not 0 <= index < count:
            raise IndexError("stage %d; the study has %d" % (stage, count))
        return index

    def _rows(self, stage: int, generation: int) -> npt.NDArray[np.int64]:
        count, rows = ctypes.c_size_t(), ctypes.c_void_p()
        lib.call(
            "pkmopt_results_population",
            self._open_handle(),
            lib.size(stage),
            ctypes.c_int64(generation),
            ctypes.byref(count),
            ctypes.byref(rows),
        )
        found: npt.NDArray[np.int64] = lib.taken_array(rows, (count.value,), np.int64)
        return found

    def _repr_html_(self) -> str:
        """The report, shown by Jupyter in a frame of its own."""
        handle, path = tempfile.mkstemp(suffix=".html")
        os.close(handle)
        try:
            self.report(path, overwrite=True)
            page = Path(path).read_text(encoding="utf-8")
        finally:
            os.unlink(path)
        return '<iframe srcdoc="%s" width="100%%" height="800" style="border:0"></iframe>' % html.escape(page)

    def __repr__(self) -> str:
        return "<Results %s: %s, %d evaluations>" % (self.path, self.state, sum(s["rows"] for s in self.stages))


def _columns(blocks: Sequence[Array]) -> Iterator[Any]:
    for block in blocks:
        for i in range(block.shape[1]):
            yield block, i


def open_study(path: Path_) -> Results:
    """Reads and verifies a study file.

    >>> with open_study("paper-problem.h5") as results:                               # doctest: +SKIP
    ...     print(results.best["objectives"])
    """
    return Results(path)
