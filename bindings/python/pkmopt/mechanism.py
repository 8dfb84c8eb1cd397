"""Mechanisms, their designs, and the workspaces of designs."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import _library as lib
from . import _toml
from ._library import Array

Number = Union[float, str]


class Parameter(NamedTuple):
    """A parameter of a mechanism; lengths in m, angles in rad."""

    name: str
    unit: str
    default: float
    min: float
    max: float
    meaning: str


class Quantity(NamedTuple):
    """A named number of a design, a pose or a motion."""

    name: str
    unit: str
    meaning: str
    depends_on: str


class Limit(NamedTuple):
    """A threshold of poses that a design or a study may set."""

    name: str
    unit: str
    min: float
    max: float
    meaning: str


class Dynamics(NamedTuple):
    """Inverse dynamics of several states; a row is NaN if its pose cannot be assembled or is singular."""

    forces: Array  #: drive forces [count, joints] in N, N m
    inertia: Array  #: joint-space inertia matrices [count, joints, joints]
    coriolis: Array  #: Coriolis and centrifugal forces at the joints [count, joints]
    gravity: Array  #: gravity at the joints [count, joints]


class Links(NamedTuple):
    """The links of several poses as capsules."""

    names: List[str]
    parts: List[str]  #: "frame", "platform", or the limb
    start: Array  #: start of the axis [count, links, 3]
    end: Array  #: end of the axis [count, links, 3]
    radius: Array  #: [count, links]


class Fields:
    """Quantities on a grid over a workspace; ``fields["lti"]`` is the array of the quantity with this name."""

    def __init__(self, info: Mapping[str, Any], values: Array) -> None:
        #: centres of the cells along each swept coordinate
        self.axes: Dict[str, Array] = {}
        for axis in info["axes"]:
            step = (axis["upper"] - axis["lower"]) / axis["cells"]
            self.axes[axis["name"]] = axis["lower"] + step * (np.arange(axis["cells"]) + 0.5)
        #: units of all coordinates, swept and fixed
        self.axis_units: Dict[str, str] = {axis["name"]: axis["unit"] for axis in [*info["axes"], *info["fixed"]]}
        #: values of the coordinates that are not swept
        self.fixed: Dict[str, float] = {fixed["name"]: fixed["value"] for fixed in info["fixed"]}
        #: arrays of the quantities by name, each with one dimension per axis; NaN where undefined
        self.values: Dict[str, Array] = {field["name"]: values[i] for i, field in enumerate(info["fields"])}
        self.units: Dict[str, str] = {field["name"]: field["unit"] for field in info["fields"]}
        #: volume of the feasible cells, in ``volume_unit``
        self.volume: float = info["volume"]
        self.volume_unit: str = info["volume_unit"]

    def __getitem__(self, name: str) -> Array:
        if name not in self.values:
            raise KeyError("%r; expected one of %s" % (name, ", ".join(self.values)))
        return self.values[name]

    def __repr__(self) -> str:
        return "<Fields over %s: %s>" % (", ".join(self.axes), ", ".join(self.values))


class Surface(NamedTuple):
    """The boundary of a workspace over three coordinates."""

    vertices: Array  #: [vertices, 3]
    triangles: Any  #: [triangles, 3], counter-clockwise seen from outside
    axes: Dict[str, str]  #: units of the three coordinates by their names


def mechanism_names() -> List[str]:
    """Names of the built-in mechanisms."""
    names: List[str] = lib.parsed("pkmopt_mechanism_names")
    return names


class Mechanism:
    """A mechanism: a built-in one, given by its name, or one from a mechanism file.

    >>> Mechanism("4ppa-2par").coordinates
    ['x', 'y', 'z', 'theta']
    """

    def __init__(self, name: str) -> None:
        if str(name).endswith(".toml"):
            raise lib.InputError("%r is a file; read it by Mechanism.from_file()" % name)
        self._set(lib.handle("pkmopt_mechanism_by_name", "pkmopt_mechanism_free", lib.encoded(name)))
        self._is_built_in = True
        self._file_name = name

    @classmethod
    def from_file(cls, path: Union[str, Path]) -> "Mechanism":
        """Reads a mechanism file in TOML."""
        self = cls.__new__(cls)
        self._set(lib.handle("pkmopt_mechanism_from_file", "pkmopt_mechanism_free", lib.encoded(str(path)), None))
        self._is_built_in = False
        self._file_name = str(path)
        return self

    @classmethod
    def from_text(cls, toml: str, file_name: str = "mechanism.toml", _limb_parameters: str = "") -> "Mechanism":
        """Reads the text of a mechanism file; messages mention ``file_name``."""
        self = cls.__new__(cls)
        self._set(
            lib.handle(
                "pkmopt_mechanism_from_text",
                "pkmopt_mechanism_free",
                lib.encoded(toml),
                lib.encoded(file_name),
                lib.encoded(_limb_parameters),
            )
        )
        self._is_built_in = False
        self._file_name = file_name
        return self

    def _set(self, handle: lib.Handle) -> None:
        self._handle = handle
        self.info: Dict[str, Any] = lib.parsed("pkmopt_mechanism_info", handle)

    @property
    def name(self) -> str:
        return str(self.info["name"])

    @property
    def coordinates(self) -> List[str]:
        """Names of the coordinates of a pose, in their order."""
        return list(self.info["coordinates"])

    @property
    def joints(self) -> List[str]:
        """Names of the actuated joints, in their order."""
        return list(self.info["joints"])

    @property
    def modes(self) -> List[str]:
        """Working modes; the first is the default."""
        return list(self.info["modes"])

    @property
    def parameters(self) -> Dict[str, Parameter]:
        return {p["name"]: Parameter(**p) for p in self.info["parameters"]}

    @property
    def quantities(self) -> Dict[str, Quantity]:
        return {q["name"]: Quantity(**q) for q in self.info["quantities"]}

    @property
    def limits(self) -> Dict[str, Limit]:
        return {l["name"]: Limit(l["name"], l["unit"], l["min"], l["max"], l["meaning"]) for l in self.info["limits"]}

    def to_toml(self) -> str:
        """The text of the mechanism file."""
        return lib.text("pkmopt_mechanism_text", self._handle)

    def with_masses(self, model: str) -> "Mechanism":
        """The mechanism with another mass model."""
        other = Mechanism.__new__(Mechanism)
        other._set(
            lib.handle("pkmopt_mechanism_with_masses", "pkmopt_mechanism_free", self._handle, lib.encoded(model))
        )
        other._is_built_in, other._file_name = self._is_built_in, self._file_name
        return other

    def design(
        self,
        parameters: Optional[Mapping[str, Number]] = None,
        *,
        mode: Optional[str] = None,
        limits: Optional[Mapping[str, Number]] = None,
        **more: Number,
    ) -> "Design":
        """A design: default parameters except those that are given, as numbers in SI units or texts such as "30 mm".

        A parameter of a single limb, such as ``{"arm2.l_b": "301 mm"}``, is given in ``parameters``.
        """
        given = {**(parameters or {}), **more}
        own = [name for name in given if "." in name and name not in self.parameters]
        if own:
            mechanism = Mechanism.from_text(self.to_toml(), self._file_name, ",".join(own))
            if self.info["masses"] != mechanism.info["masses"]:
                mechanism = mechanism.with_masses(self.info["masses"])
            return Design(mechanism, given, mode, limits or {})
        return Design(self, given, mode, limits or {})

    def _study_tables(self) -> Dict[str, Any]:
        """The table [mechanism] of a study."""
        table: Dict[str, Any] = {"type" if self._is_built_in else "file": self._file_name}
        if self.info["masses"] and self.info["masses"] != self.info["mass_models"][0]:
            table["masses"] = self.info["masses"]
        return {"mechanism": table}

    def _study_text(self) -> Optional[str]:
        """The text of the mechanism file that a study needs."""
        return None if self._is_built_in else self.to_toml()

    def __repr__(self) -> str:
        return "<Mechanism %s: %s -> %s>" % (self.name, ", ".join(self.joints), ", ".join(self.coordinates))


def _chosen(what: str, given: Mapping[str, Number], known: Mapping[str, Any]) -> Dict[str, float]:
    for name in given:
        if name not in known:
            hint = lib.suggestion(name, list(known))
            raise lib.InputError("unknown %s %r; expected one of %s%s" % (what, name, ", ".join(known), hint))
    return {name: lib.number(value, known[name].unit, name) for name, value in given.items()}


def _matching(values: Array, count: int, what: str) -> Array:
    """An array of ``count`` rows; a single row is repeated."""
    if len(values) == 1:
        return np.ascontiguousarray(np.broadcast_to(values, (count, values.shape[1])))
    if len(values) != count:
        raise ValueError("%s has %d rows; expected %d or 1" % (what, len(values), count))
    return values


class Design:
    """A mechanism with parameters, a working mode and limits. Made by :meth:`Mechanism.design`.

    Poses are arrays [count, coordinates] or a single pose [coordinates]; a dict of coordinates is accepted, too. Results
    have the same leading shape. Lengths are in m, angles in rad.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        parameters: Mapping[str, Number],
        mode: Optional[str],
        limits: Mapping[str, Number],
    ) -> None:
        known = mechanism.parameters
        chosen = _chosen("parameter", parameters, known)
        self.mechanism = mechanism
        self.parameters: Dict[str, float] = {name: chosen.get(name, p.default) for name, p in known.items()}
        self.limits: Dict[str, float] = _chosen("limit", limits, mechanism.limits)
        self.mode = mode or mechanism.modes[0]
        values = np.array(list(self.parameters.values()))
        thresholds = np.array([self.limits.get(name, np.nan) for name in mechanism.limits])
        self._handle = lib.handle(
            "pkmopt_design_create",
            "pkmopt_design_free",
            mechanism._handle,
            lib.pointer(values),
            lib.encoded(self.mode),
            lib.pointer(thresholds),
        )
        self._margin_names: Optional[List[str]] = None

    def _poses(self, poses: Any) -> Tuple[Array, bool]:
        return lib.rows(poses, "poses", self.mechanism.coordinates, self.mechanism.info["coordinate_units"])

    def _at(self, function: str, poses: Any, shape: Tuple[int, ...], threads: int, *before: Any) -> Array:
        """Calls function(design, *before, count, poses, values, options)."""
        x, single = self._poses(poses)
        values = np.empty((len(x),) + shape)
        options = lib.options(threads)
        lib.call(
            function,
            self._handle,
            *before,
            lib.size(len(x)),
            lib.pointer(x),
            lib.pointer(values),
            ctypes.byref(options),
        )
        result: Array = values[0] if single else values
        return result

    def inverse(self, poses: Any, threads: int = 0) -> Array:
        """Joint values [count, joints]; a row is NaN if the pose cannot be assembled in the working mode."""
        return self._at("pkmopt_design_inverse", poses, (len(self.mechanism.joints),), threads)

    def jacobian(self, poses: Any, threads: int = 0) -> Array:
        """Jacobians J [count, joints, coordinates] with joint rates = J coordinate rates."""
        shape = (len(self.mechanism.joints), len(self.mechanism.coordinates))
        return self._at("pkmopt_design_jacobians", poses, shape, threads)

    def quantity(self, name: str, poses: Any, threads: int = 0) -> Array:
        """A quantity [count], one of ``mechanism.quantities`` or "conditioning"; NaN where it is undefined."""
        return self._at("pkmopt_design_quantity", poses, (), threads, lib.encoded(name))

    @property
    def margin_names(self) -> List[str]:
        """Names of the constraints of poses, in the order of :meth:`margins`."""
        if self._margin_names is None:
            self._margin_names = lib.parsed("pkmopt_design_margin_names", self._handle)
        return list(self._margin_names)

    def margins(self, poses: Any, threads: int = 0) -> Array:
        """Margins of all constraints [count, constraints], satisfied if >= 0; NaN where one is undefined."""
        return self._at("pkmopt_design_margins", poses, (len(self.margin_names),), threads)

    def feasible(self, poses: Any, threads: int = 0) -> Any:
        """For each pose, whether the mechanism can be assembled and all constraints are satisfied [count]."""
        with np.errstate(invalid="ignore"):
            return np.all(self.margins(poses, threads) >= 0, axis=-1)

    def forward(self, joints: Any, near: Any = None, threads: int = 0) -> Any:
        """Forward kinematics: for each row of joint values the poses [found, coordinates].

        With ``near``, one pose or as many as rows, only the nearest pose that a search from there finds: an array
        [count, coordinates], NaN if there is none. How complete a list is depends on the mechanism: see `pkmopt forward`.
        """
        q, single = lib.rows(joints, "joints", self.mechanism.joints, self.mechanism.info["joint_units"])
        n = len(self.mechanism.coordinates)
        start = None if near is None else _matching(self._poses(near)[0], len(q), "near")
        capacity = 1 if start is not None else 16
        options = lib.options(threads)
        while True:
            poses = np.empty((len(q), capacity, n))
            found = np.zeros(len(q), dtype=np.uintp)
            lib.call(
                "pkmopt_design_forward",
                self._handle,
                lib.size(len(q)),
                lib.pointer(q),
                lib.pointer(start),
                lib.size(capacity),
                lib.pointer(poses),
                lib.pointer(found),
                ctypes.byref(options),
            )
            if start is not None:
                return poses[0, 0] if single else poses[:, 0]
            if len(q) == 0 or int(found.max()) <= capacity:
                lists = [poses[k, : int(found[k])].copy() for k in range(len(q))]
                return lists[0] if single else lists
            capacity = int(found.max())

    def dynamics(
        self, poses: Any, velocities: Any = None, accelerations: Any = None, wrenches: Any = None, threads: int = 0
    ) -> Dynamics:
        """Drive forces and equations of motion. Rates are those of the coordinates, by default 0; wrenches are forces
        and moments on the platform, [count, 6]: Fx Fy Fz Mx My Mz."""
        x, single = self._poses(poses)
        names = self.mechanism.coordinates
        n = len(self.mechanism.joints)

        def matching(values: Any, what: str, columns: Sequence[str], units: Sequence[str]) -> Optional[Array]:
            if values is None:
                return None
            return _matching(lib.rows(values, what, columns, units)[0], len(x), what)

        units = self.mechanism.info["coordinate_units"]
        v = matching(velocities, "velocities", names, [unit + "/s" for unit in units])
        a = matching(accelerations, "accelerations", names, [unit + "/s^2" for unit in units])
        w = matching(wrenches, "wrenches", ["Fx", "Fy", "Fz", "Mx", "My", "Mz"], 3 * ["N"] + 3 * ["N m"])
        result = Dynamics(
            np.empty((len(x), n)), np.empty((len(x), n, n)), np.empty((len(x), n)), np.empty((len(x), n))
        )
        options = lib.options(threads)
        lib.call(
            "pkmopt_design_dynamics",
            self._handle,
            lib.size(len(x)),
            *[lib.pointer(each) for each in (x, v, a, w, *result)],
            ctypes.byref(options),
        )
        return Dynamics(*[each[0] for each in result]) if single else result

    def links(self, poses: Any, threads: int = 0) -> Links:
        """The links as capsules, for drawings; NaN for a pose at which the mechanism cannot be assembled."""
        described = lib.parsed("pkmopt_design_link_names", self._handle)
        capsules = self._at("pkmopt_design_links", poses, (len(described), 7), threads)
        return Links(
            [each["name"] for each in described],
            [each["part"] for each in described],
            capsules[..., 0:3],
            capsules[..., 3:6],
            capsules[..., 6],
        )

    def workspace(self, **workspace: Any) -> "Workspace":
        """The workspace of this design. Keywords are the keys of [workspace] of a study, such as ``method="voxels"``,
        ``cells={"x": 40, ..}``, ``tolerance=1e-6``, ``theta=0`` to fix a coordinate, ``box={..}``."""
        return Workspace(self, workspace)

    def volume_and_gradient(self, threads: int = 0, **workspace: Any) -> Tuple[float, Dict[str, float]]:
        """The workspace volume and its derivatives with respect to all parameters; requires the method "columns"."""
        found = self.workspace(**workspace)
        return found.volume, found.gradient(threads)

    def __repr__(self) -> str:
        values = ", ".join("%s=%.6g" % item for item in self.parameters.items())
        return "<Design of %s: %s>" % (self.mechanism.name, values)


class Workspace:
    """The workspace of a design. Made by :meth:`Design.workspace`."""

    def __init__(self, design: Design, workspace: Mapping[str, Any]) -> None:
        if design.mode != design.mechanism.modes[0]:
            raise lib.InputError(
                "the design has the working mode %r, but workspaces are those of the first one, %r"
                % (design.mode, design.mechanism.modes[0])
            )
        tables = design.mechanism._study_tables()
        tables["workspace"] = dict(workspace)
        changes = ["limit %s=%r" % item for item in design.limits.items()]
        own = ["set %s=%r" % (name, value) for name, value in design.parameters.items() if "." in name]
        self.design = design
        self._study = lib.handle(
            "pkmopt_study_from_text",
            "pkmopt_study_free",
            lib.encoded(_toml.document(tables)),
            b"workspace",
            lib.encoded(design.mechanism._study_text()),
            lib.encoded(design.mechanism._file_name),
            lib.encoded("\n".join(own + changes)),
        )
        self.info: Dict[str, Any] = lib.parsed("pkmopt_study_info", self._study)
        names = [p["name"] for p in self.info["parameters"]]
        self._parameters = np.array([design.parameters[name] for name in names])
        self._volume: Optional[Tuple[float, float]] = None

    def _measure(self, gradient: Optional[Array], threads: int) -> Tuple[float, float]:
        volume, error = ctypes.c_double(), ctypes.c_double()
        options = lib.options(threads)
        lib.call(
            "pkmopt_study_volume",
            self._study,
            lib.pointer(self._parameters),
            ctypes.byref(volume),
            ctypes.byref(error),
            lib.pointer(gradient),
            ctypes.byref(options),
        )
        self._volume = volume.value, error.value
        return self._volume

    @property
    def volume(self) -> float:
        """The volume, in ``unit``."""
        return (self._volume or self._measure(None, 0))[0]

    @property
    def error(self) -> float:
        """Estimated relative error of the volume, without components that no sample has found; NaN for voxels."""
        return (self._volume or self._measure(None, 0))[1]

    @property
    def unit(self) -> str:
        return str(self.info["volume_unit"])

    def gradient(self, threads: int = 0) -> Dict[str, float]:
        """Derivatives of the volume with respect to all parameters; requires the method "columns"."""
        values = np.empty(len(self._parameters))
        self._measure(values, threads)
        return {p["name"]: float(d) for p, d in zip(self.info["parameters"], values)}

    def fields(self, threads: int = 0) -> Fields:
        """Quantities of the poses on a grid of voxels."""
        description, values = ctypes.c_void_p(), ctypes.c_void_p()
        options = lib.options(threads)
        lib.call(
            "pkmopt_study_fields",
            self._study,
            lib.pointer(self._parameters),
            lib.encoded(self.design.mode),
            ctypes.byref(description),
            ctypes.byref(values),
            ctypes.byref(options),
        )
        info = lib.taken_json(description)
        shape = tuple(axis["cells"] for axis in info["axes"])
        return Fields(info, lib.taken_array(values, (len(info["fields"]),) + shape, np.float64))

    def surface(self, threads: int = 0) -> Surface:
        """The boundary surface; the workspace is over three coordinates."""
        vertices, triangles = ctypes.c_void_p(), ctypes.c_void_p()
        vertex_count, triangle_count = ctypes.c_size_t(), ctypes.c_size_t()
        options = lib.options(threads)
        lib.call(
            "pkmopt_study_surface",
            self._study,
            lib.pointer(self._parameters),
            ctypes.byref(vertex_count),
            ctypes.byref(vertices),
            ctypes.byref(triangle_count),
            ctypes.byref(triangles),
            ctypes.byref(options),
        )
        points = lib.taken_array(vertices, (vertex_count.value, 3), np.float64)
        indices = lib.taken_array(triangles, (triangle_count.value, 3), np.uint32)
        return Surface(points, indices, {axis["name"]: axis["unit"] for axis in self.info["swept"]})

    def __repr__(self) -> str:
        return "<Workspace of %r: %.6g %s>" % (self.design.mechanism.name, self.volume, self.unit)

