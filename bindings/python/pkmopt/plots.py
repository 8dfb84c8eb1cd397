"""Plots of results, workspaces and mechanisms by matplotlib.

Each function draws into ``axes``, by default those of a new figure, and returns them. Axes are in SI units.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional

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
    axes.set_ylabel("best " + _label(objective["name"], objective["unit"]))
    return axes


def front(results: "Results", axes: Any = None) -> Any:
    """The Pareto front in the plane of the first two objectives."""
    objectives = results.study.info["objectives"]
    if len(objectives) < 2:
        raise ValueError("the study has one objective, %s; expected two or more" % objectives[0]["name"])
    axes = _axes(axes)
    first, second = objectives[:2]
    points = results.front
    axes.plot(points[first["name"]], points[second["name"]], "o", markersize=3)
    axes.set_xlabel(_label(first["name"], first["unit"]))
    axes.set_ylabel(_label(second["name"], second["unit"]))
    return axes


def slice(fields: "Fields", name: str, axes: Any = None, **at: float) -> Any:
    """A field in a plane of the workspace: ``at`` gives the coordinates that are not drawn, ``z=-0.4``; the nearest cells
    are drawn, and the title has the coordinate of their centres. A workspace over two coordinates needs none. The field
    "feasible" is drawn as an area, every other one in colours as a map."""
    values: Any = fields[name]
    drawn: List[str] = []
    held: Dict[str, float] = dict(fields.fixed)
    for axis, centres in reversed(list(enumerate(fields.axes.items()))):
        coordinate, cells = centres
        if coordinate in at:
            nearest = int(np.argmin(np.abs(cells - at[coordinate])))
            half = (cells[1] - cells[0]) / 2 if len(cells) > 1 else np.inf
            if not abs(cells[nearest] - at[coordinate]) <= 1.001 * half:
                raise ValueError(
                    "%s = %g is outside the grid; expected a value in [%g, %g]"
                    % (coordinate, at[coordinate], cells[0] - half, cells[-1] + half)
                )
            values = np.take(values, nearest, axis=axis)
            held[coordinate] = float(cells[nearest])
        else:
            drawn.insert(0, coordinate)
    unknown = [coordinate for coordinate in at if coordinate not in fields.axes]
    if unknown or len(drawn) != 2:
        raise ValueError(
            "at gives %s; expected all but two of %s" % (", ".join(at) or "nothing", ", ".join(fields.axes))
        )
    axes = _axes(axes)
    x, y = (fields.axes[coordinate] for coordinate in drawn)
    if name == "feasible":
        values = np.where(values > 0, 1.0, np.nan)
        axes.pcolormesh(x, y, values.T, shading="nearest", vmin=0, vmax=1, cmap="Blues", alpha=0.6)
    else:
        image = axes.pcolormesh(x, y, values.T, shading="nearest")
        bar = axes.inset_axes([1.04, 0, 0.05, 1])  # as high as the axes, whatever their aspect
        axes.figure.colorbar(image, cax=bar, label=_label(name, fields.units[name]))
    units = [fields.axis_units[coordinate] for coordinate in drawn]
    axes.set_xlabel(_label(drawn[0], units[0]))
    axes.set_ylabel(_label(drawn[1], units[1]))
    if units[0] == units[1]:
        axes.set_aspect("equal")
    axes.set_title(", ".join("%s = %.4g %s" % (key, value, fields.axis_units[key]) for key, value in held.items()))
    return axes


def surface(found: "Surface", axes: Any = None, **style: Any) -> Any:
    """The boundary of a workspace over three coordinates; ``style`` is that of ``plot_trisurf``."""
    axes = _axes(axes, "3d")
    axes.plot_trisurf(*found.vertices.T, triangles=found.triangles, **{"alpha": 0.4, "linewidth": 0, **style})
    _label_space(axes, found.axes)
    return axes


def mechanism(design: "Design", pose: Any, axes: Any = None) -> Any:
    """The links at a pose as lines, with a colour for the frame, the platform and each limb. A mechanism whose links move
    in the plane of x and y is drawn in two dimensions, if ``axes`` are not 3D ones."""
    links = design.links(pose)
    if np.ndim(links.radius) != 1:
        raise ValueError("%d poses; expected one" % len(links.radius))
    ends = np.stack([links.start, links.end], axis=1)  # [links, 2, 3]
    if np.isnan(ends).any():
        raise ValueError("the mechanism does not assemble at the pose %s" % (pose,))
    is_planar = bool(np.ptp(ends[..., 2]) == 0)
    axes = _axes(axes, None if is_planar else "3d")
    is_3d = hasattr(axes, "get_zlim3d")
    if not is_planar and not is_3d:
        raise ValueError('the links do not move in the plane of x and y; expected axes with projection="3d"')
    colours = {part: "C%d" % i for i, part in enumerate(dict.fromkeys(links.parts))}
    for part, line in zip(links.parts, ends):
        axes.plot(*line.T[: 3 if is_3d else 2], color=colours[part], linewidth=2)
    if is_3d:
        _label_space(axes, {"x": "m", "y": "m", "z": "m"})
    else:
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        axes.set_aspect("equal")
    return axes


def _label_space(axes: Any, units: Dict[str, str]) -> None:
    """Labels the axes of a drawing in three dimensions, and gives them the same scale if they have the same unit. The zoom
    leaves room for the labels."""
    for name, (coordinate, unit) in zip("xyz", units.items()):
        getattr(axes, "set_%slabel" % name)(_label(coordinate, unit))
    if len(set(units.values())) > 1:
        axes.set_box_aspect(None, zoom=0.8)
        return
    lengths = np.ptp([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()], axis=1)
    axes.set_box_aspect(lengths, zoom=0.8)
    for name, length in zip("xyz", lengths):  # ticks at about the same distance on all axes
        axes.locator_params(axis=name, nbins=max(2, round(7 * length / max(lengths))))
