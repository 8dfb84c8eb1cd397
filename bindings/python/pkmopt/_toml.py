"""Writes TOML, as far as studies and mechanism files need it."""

from __future__ import annotations

import json
import re
from typing import Any, List, Mapping

import numpy as np

_BARE = re.compile(r"^[A-Za-z0-9_-]+$")


def key(name: str) -> str:
    return name if _BARE.match(name) else json.dumps(name)


def value(item: Any) -> str:
    """A value in one line."""
    if isinstance(item, (bool, np.bool_)):
        return "true" if item else "false"
    if isinstance(item, (int, np.integer)):
        return str(int(item))
    if isinstance(item, (float, np.floating)):
        return repr(float(item))
    if isinstance(item, str):
        return json.dumps(item, ensure_ascii=False)
    if isinstance(item, Mapping):
        return "{ " + ", ".join("%s = %s" % (key(k), value(v)) for k, v in item.items()) + " }" if item else "{}"
    if isinstance(item, (list, tuple, np.ndarray)):
        return "[" + ", ".join(value(each) for each in item) + "]"
    if hasattr(item, "toml"):
        return str(item.toml())
    raise TypeError("%r of type %s; expected a number, a text, a list or a dict" % (item, type(item).__name__))


def lines(table: Mapping[str, Any]) -> str:
    return "".join("%s = %s\n" % (key(name), value(item)) for name, item in table.items())


def document(tables: Mapping[str, Any]) -> str:
    """Tables by name; a list of tables becomes [[name]]."""
    text: List[str] = []
    for name, table in tables.items():
        if isinstance(table, Mapping):
            text.append("[%s]\n%s" % (key(name), lines(table)))
        elif isinstance(table, (list, tuple)):
            text += ["[[%s]]\n%s" % (key(name), lines(each)) for each in table]
        else:
            text.insert(0, "%s = %s\n" % (key(name), value(table)))
    return "\n".join(text)
