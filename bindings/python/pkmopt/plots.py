"""Plots of results, workspaces and mechanisms by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, List, Optional

import numpy as np

if TYPE_CHECKING:
    from .mechanism import Design, Fields, Surface
    from .study import Results


def _axes(axes: Any, projection: Optional[str] = None) -> Any:
    if axes is not None:
        return axes
    from matplotlib import pyplot  # type: ignore[import]

    return pyplot.figure().add_subplot(projection=projection)


def _label(name: str, unit: str) -> str:
    return name if unit in ("1", "") else "%s [%s]" % (name, unit)


def convergence(results: "Results", axes: Any = None) -> Any:
    """The best feasible value of the first objective so far against the number of evaluations."""
    axes = _axes(axes)
    objective = results.study.info["objectives"][0]
    stages = [results.evaluations(k) for k in range(len(results.stages))]
    values = np.concatenate([table[objective["name"]] for table in stages])
    feasible = np.concatenate([table["status"] for table in stages]) == 0
    sign = -1.0 if objective["maximise"] else 1.0
    best = sign * np.minimum.accumulate(np.where(feasible, sign * values, np.inf))
    known = np.isfinite(best)
    axes.plot(np.arange(1, len(best) + 1)[known], best[known], drawstyle="steps-post")
    axes.set_xlabel("evaluations")
    axes.set_ylabel(_label(objective["name"], objective["unit"]))
    return axes


def front(results: "Results", axes: Any = None) -> Any:
    """The Pareto front in the plane of the first two objectives."""
    axes = _axes(axes)
    first, second = results.study.info["objectives"][:2]
    points = results.front
    axes.plot(points[first["name"]], points[second["name"]], "o", markersize=3)
    axes.set_xlabel(_label(first["name"], first["unit"]))
    axes.set_ylabel(_label(second["name"], second["unit"]))
    return axes


def slice(fields: "Fields", name: str, axes: Any = None, **at: float) -> Any:
    """A field in a plane of the workspace: ``at`` gives the coordinates that are not drawn, ``z=-0.4``. A workspace
    over two coordinates needs none."""
    axes = _axes(axes)
    values: Any = fields[name]
    drawn: List[str] = []
    for axis, centres in reversed(list(enumerate(fields.axes.items()))):
        coordinate, cells = centres
        if coordinate in at:
            nearest = int(np.argmin(np.abs(cells - at[coordinate])))
            values = np.take(values, nearest, axis=axis)
        else:
            drawn.insert(0, coordinate)
    unknown = [coordinate for coordinate in at if coordinate not in fields.axes]
    if unknown or len(drawn) != 2:
        raise ValueError(
            "at gives %s; expected all but two of %s" % (", ".join(at) or "nothing", ", ".join(fields.axes))
        )
    x, y = (fields.axes[coordinate] for coordinate in drawn)
    image = axes.pcolormesh(x, y, values.T, shading="nearest")
    axes.figure.colorbar(image, ax=axes, label=_label(name, fields.units[name]))
    axes.set_xlabel(drawn[0])
    axes.set_ylabel(drawn[1])
    return axes


def surface(found: "Surface", axes: Any = None, **style: Any) -> Any:
    """The boundary of a workspace over three coordinates."""
    axes = _axes(axes, "3d")
    axes.plot_trisurf(*found.vertices.T, triangles=found.triangles, **{"alpha": 0.4, "linewidth": 0, **style})
    return axes


def mechanism(design: "Design", pose: Any, axes: Any = None) -> Any:
    """The links at a pose as lines."""
    axes = _axes(axes, "3d")
    links = design.links(pose)
    colours = {part: "C%d" % i for i, part in enumerate(dict.fromkeys(links.parts))}
    for part, start, end in zip(links.parts, links.start, links.end):
        axes.plot(*np.stack([start, end]).T, color=colours[part], linewidth=2)
    axes.set_box_aspect(np.ptp([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()], axis=1))
    return axes
