"""Describes a mechanism in Python: symbols and formulas, written as a mechanism file.

>>> with describe("slider") as d:
...     l = d.parameter("l", default="300 mm", min="100 mm", max="1 m")
...     x, y = d.platform(x="along x", y="along y")
...     _ = d.formula_limb("left", q1=x - (l**2 - y**2) ** 0.5, unit="m")
...     d.survey(x=(-1, 1), y=(0, l))
>>> d.mechanism().joints
['q1']
"""

from __future__ import annotations

import numbers
from typing import Any, Dict, List, Tuple, Union

from . import _toml
from .mechanism import Mechanism

Term = Union["Formula", float, int, str]

_SUM, _PRODUCT, _UNARY, _POWER, _ATOM = range(5)


class Formula:
    """A formula of named symbols. Operators and the functions of this module make formulas of formulas."""

    def __init__(self, text: str, level: int = _ATOM) -> None:
        self._text, self._level = text, level

    def toml(self) -> str:
        return _toml.value(self._text)

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return "Formula(%r)" % self._text

    def _in(self, level: int) -> str:
        return self._text if self._level >= level else "(%s)" % self._text

    def __add__(self, other: Term) -> "Formula":
        return Formula("%s + %s" % (self._in(_SUM), _formula(other)._in(_PRODUCT)), _SUM)

    def __radd__(self, other: Term) -> "Formula":
        return _formula(other) + self

    def __sub__(self, other: Term) -> "Formula":
        return Formula("%s - %s" % (self._in(_SUM), _formula(other)._in(_PRODUCT)), _SUM)

    def __rsub__(self, other: Term) -> "Formula":
        return _formula(other) - self

    def __mul__(self, other: Term) -> "Formula":
        return Formula("%s*%s" % (self._in(_PRODUCT), _formula(other)._in(_POWER)), _PRODUCT)

    def __rmul__(self, other: Term) -> "Formula":
        return _formula(other) * self

    def __truediv__(self, other: Term) -> "Formula":
        return Formula("%s/%s" % (self._in(_PRODUCT), _formula(other)._in(_POWER)), _PRODUCT)

    def __rtruediv__(self, other: Term) -> "Formula":
        return _formula(other) / self

    def __pow__(self, other: Term) -> "Formula":
        if not isinstance(other, (str, Formula)) and float(other) == 0.5:
            return sqrt(self)
        return Formula("%s^%s" % (self._in(_ATOM), _formula(other)._in(_ATOM)), _POWER)

    def __rpow__(self, other: Term) -> "Formula":
        return _formula(other) ** self

    def __neg__(self) -> "Formula":
        return Formula("-%s" % self._in(_POWER), _UNARY)


def _formula(term: Term) -> Formula:
    if isinstance(term, Formula):
        return term
    if isinstance(term, str):
        return Formula(term, _SUM)
    text = repr(int(term) if isinstance(term, numbers.Integral) else float(term))
    return Formula(text, _UNARY if text.startswith("-") else _ATOM)


def _call(name: str, *arguments: Term) -> Formula:
    return Formula("%s(%s)" % (name, ", ".join(str(_formula(each)) for each in arguments)))


def sqrt(x: Term) -> Formula:
    return _call("sqrt", x)


def sin(x: Term) -> Formula:
    return _call("sin", x)


def cos(x: Term) -> Formula:
    return _call("cos", x)


def tan(x: Term) -> Formula:
    return _call("tan", x)


def asin(x: Term) -> Formula:
    return _call("asin", x)


def acos(x: Term) -> Formula:
    return _call("acos", x)


def atan(x: Term) -> Formula:
    return _call("atan", x)


def atan2(y: Term, x: Term) -> Formula:
    return _call("atan2", y, x)


def absolute(x: Term) -> Formula:
    return _call("abs", x)


def minimum(x: Term, y: Term) -> Formula:
    return _call("min", x, y)


def maximum(x: Term, y: Term) -> Formula:
    return _call("max", x, y)


class Description:
    """The tables of a mechanism file, in the order in which they are described. A context manager, for reading only."""

    def __init__(self, name: str, title: str = "") -> None:
        self._head: Dict[str, Any] = {"name": name}
        if title:
            self._head["title"] = title
        self._tables: Dict[str, Any] = {}
        self._lists: Dict[str, List[Dict[str, Any]]] = {}
        self._coordinates: Dict[str, Any] = {}

    def __enter__(self) -> "Description":
        return self

    def __exit__(self, *_exception: Any) -> None:
        pass

    def parameter(self, name: str, *, default: Term, min: Term, max: Term, **more: Any) -> Formula:
        """A parameter with its range; ``unit`` if the values are numbers, ``meaning``. Returns its symbol."""
        table = self._tables.setdefault("parameters", {})
        table[name] = {"default": default, "min": min, "max": max, **more}
        return Formula(name)

    def platform(self, **coordinates: str) -> Tuple[Formula, ...]:
        """The coordinates of the platform, ``x="along x"``, ``theta="about z"``. Returns their symbols."""
        self._tables.setdefault("platform", {})["coordinates"] = dict(coordinates)
        return tuple(Formula(name) for name in coordinates)

    def let(self, name: str, formula: Term) -> Formula:
        """A named formula. Returns its symbol."""
        self._tables.setdefault("let", {})[name] = _formula(formula)
        return Formula(name)

    def limb(self, name: str, **keys: Any) -> None:
        """A limb with the keys of [[limb]]: ``drive``, ``base``, ``platform``, ``range``, .."""
        self._lists.setdefault("limb", []).append({"name": name, **keys})

    def formula_limb(self, name: str, *, unit: str, **joints: Term) -> Tuple[Formula, ...]:
        """A limb whose joints are formulas of the pose. Returns the symbols of the joints."""
        self.limb(name, drive="formula", unit=unit, joints={q: _formula(f) for q, f in joints.items()})
        return tuple(Formula(q) for q in joints)

    def margin(self, name: str, formula: Term, unit: str = "1") -> None:
        """A constraint of poses: the formula is >= 0."""
        self._lists.setdefault("margin", []).append({"name": name, "formula": _formula(formula), "unit": unit})

    def quantity(self, name: str, formula: Term, unit: str = "1", meaning: str = "") -> None:
        """A named number of a pose, usable as limit, objective, output, field."""
        table = {"name": name, "formula": _formula(formula), "unit": unit, "meaning": meaning or name}
        self._lists.setdefault("quantity", []).append(table)

    def survey(self, **box: Any) -> None:
        """The search box of workspaces: for each coordinate, its range (from, to), or a value at which it is fixed."""
        ranges = {c: list(r) for c, r in box.items() if isinstance(r, (tuple, list))}
        fixed = {c: r for c, r in box.items() if c not in ranges}
        self._tables["survey"] = {"sweep": list(ranges), "box": ranges, **({"fixed": fixed} if fixed else {})}

    def table(self, name: str, **keys: Any) -> None:
        """Adds keys to a table, such as [masses] or [platform], or adds an element to an array of tables, such as
        [[frame]] or [[link]]."""
        if name in ("frame", "link", "body", "joint", "design", "limit"):
            self._lists.setdefault(name, []).append(keys)
        else:
            self._tables.setdefault(name, {}).update(keys)

    def to_toml(self) -> str:
        """The mechanism file."""
        return _toml.document({"mechanism": self._head, **self._tables, **self._lists})

    def mechanism(self) -> Mechanism:
        return Mechanism.from_text(self.to_toml(), str(self._head["name"]) + ".toml")


def describe(name: str, title: str = "") -> Description:
    """Begins the description of a mechanism."""
    return Description(name, title)
