"""The plots of the Python package: what they draw, and their labels."""

import os
import pathlib
import tempfile
import unittest

import numpy as np

import pkmopt
from pkmopt import plots

try:
    import matplotlib
except ImportError:
    raise unittest.SkipTest("matplotlib is not installed")

matplotlib.use("Agg")
from matplotlib import pyplot

DELTA = pathlib.Path(os.environ["PKM_EXPERIMENTS"]) / "mechanisms" / "rotary-delta.toml"
VARIABLES = {"a": (0.2, 0.5), "b": (0.5, 1.2)}


def is_drawn(axes):
    """Whether the figure can be rendered and shows more than one colour in the area of the axes."""
    canvas = axes.figure.canvas
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    height = pixels.shape[0]
    box = axes.get_window_extent()
    inside = pixels[int(height - box.y1) + 5 : int(height - box.y0) - 5, int(box.x0) + 5 : int(box.x1) - 5]
    return len(np.unique(inside.reshape(-1, 4), axis=0)) > 1


class PlotTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(pyplot.close, "all")
        self.folder = pathlib.Path(folder.name)

    def assert_labels(self, axes, *labels):
        found = [axes.get_xlabel(), axes.get_ylabel()] + ([axes.get_zlabel()] if hasattr(axes, "get_zlabel") else [])
        self.assertEqual(found, list(labels))
        self.assertTrue(is_drawn(axes))


class ResultsTest(PlotTest):
    def test_convergence(self):
        sum_ = {"type": "expression", "name": "sum", "expression": "1.0 - a - b", "unit": "m"}
        for direction in ("maximise", "minimise"):
            study = pkmopt.Study("4ppa-2par", VARIABLES, {"type": "workspace-volume", "direction": direction}, sum_,
                                 stages=[{"optimiser": "ga", "generations": 5, "population": 10}, "nlopt"])
            results = study.run(self.folder / (direction + ".h5"))
            axes = results.plot_convergence()
            self.assert_labels(axes, "evaluations", "best workspace-volume [m^2 rad]")
            (line,) = axes.lines
            self.assertEqual(line.get_drawstyle(), "steps-post")
            tables = [results.evaluations(0), results.evaluations(1)]
            values, status = (np.concatenate([t[name] for t in tables]) for name in ("workspace-volume", "status"))
            expected, best = [], None
            for number, (value, state) in enumerate(zip(values, status), 1):
                if state == pkmopt.FEASIBLE:
                    best = value if best is None else (max if direction == "maximise" else min)(best, value)
                if best is not None:
                    expected.append((number, best))
            self.assertLess(len(expected), len(values), "the first designs violate the constraint")
            np.testing.assert_array_equal(line.get_xydata(), expected)
            self.assertEqual(line.get_ydata()[-1], results.best["objectives"]["workspace-volume"])

    def test_front(self):
        study = pkmopt.Study("4ppa-2par", VARIABLES, ["workspace-volume", "workspace-ratio"],
                             stages={"optimiser": "nsga2", "generations": 5, "population": 20})
        results = study.run(self.folder / "front.h5")
        figure, axes = pyplot.subplots()
        self.assertIs(results.plot_front(axes), axes)
        self.assert_labels(axes, "workspace-volume [m^2 rad]", "workspace-ratio [rad]")
        (line,) = axes.lines
        front = results.front
        self.assertGreater(len(front), 1)
        np.testing.assert_array_equal(line.get_xdata(), front["workspace-volume"])
        np.testing.assert_array_equal(line.get_ydata(), front["workspace-ratio"])

    def test_a_front_needs_two_objectives(self):
        study = pkmopt.Study("4ppa-2par", VARIABLES, "workspace-volume", stages={"optimiser": "ga", "generations": 1})
        with self.assertRaisesRegex(ValueError, "one objective, workspace-volume"):
            study.run(self.folder / "one.h5").plot_front()


class WorkspacePlotTest(PlotTest):
    CELLS = {"x": 10, "y": 12, "z": 14}

    def setUp(self):
        super().setUp()
        self.design = pkmopt.Mechanism.from_file(DELTA).design()
        self.workspace = self.design.workspace(method="voxels", cells=self.CELLS)
        self.fields = self.workspace.fields()

    def test_map(self):
        axes = plots.slice(self.fields, "lti", z=-0.4)
        self.assert_labels(axes, "x [m]", "y [m]")
        level = int(np.argmin(np.abs(self.fields.axes["z"] + 0.4)))
        self.assertEqual(axes.get_title(), "z = %.4g m" % self.fields.axes["z"][level])
        (mesh,) = axes.collections
        drawn = mesh.get_array().filled(np.nan).reshape(12, 10)
        np.testing.assert_array_equal(drawn, self.fields["lti"][:, :, level].T)
        corners = mesh.get_coordinates()  # of the cells, around their centres
        centres = (corners[1:, 1:] + corners[:-1, :-1]) / 2
        np.testing.assert_allclose(centres[0, :, 0], self.fields.axes["x"])
        np.testing.assert_allclose(centres[:, 0, 1], self.fields.axes["y"])
        self.assertEqual(axes.get_aspect(), 1)
        self.assertEqual(mesh.colorbar.ax.get_ylabel(), "lti")
        torque = [name for name, unit in self.fields.units.items() if unit not in ("1", "")][0]
        axes = plots.slice(self.fields, torque, z=-0.4)
        self.assertEqual(axes.collections[0].colorbar.ax.get_ylabel(), "%s [%s]" % (torque, self.fields.units[torque]))

    def test_slice(self):
        axes = plots.slice(self.fields, "feasible", y=0.0)
        self.assert_labels(axes, "x [m]", "z [m]")
        level = int(np.argmin(np.abs(self.fields.axes["y"])))
        (mesh,) = axes.collections
        drawn = ~np.ma.getmaskarray(mesh.get_array()).reshape(14, 10)
        np.testing.assert_array_equal(drawn, self.fields["feasible"][:, level, :].T > 0)
        self.assertIsNone(mesh.colorbar)

    def test_fixed_coordinates_and_units(self):
        robot = pkmopt.Mechanism("3crr-r-cru").design()
        fields = robot.workspace(method="voxels", cells=self.CELLS, phi=0.25).fields()
        axes = plots.slice(fields, "feasible", z=float(fields.axes["z"][3]))
        self.assertEqual(axes.get_title(), "phi = 0.25 rad, z = %.4g m" % fields.axes["z"][3])
        cells = {"x": 8, "z": 9, "theta": 10}
        fields = pkmopt.Mechanism("4ppa-2par").design().workspace(method="voxels", cells=cells).fields()
        axes = plots.slice(fields, "feasible", x=float(fields.axes["x"][4]))
        self.assert_labels(axes, "z [m]", "theta [rad]")
        self.assertEqual(axes.get_aspect(), "auto")

    def test_mistakes_of_slices(self):
        for at, message in (({}, "all but two"), ({"q": 0}, "all but two"), ({"x": 0, "y": 0}, "all but two"),
                            ({"z": 0.1}, "z = 0.1 is outside the grid")):
            with self.assertRaisesRegex(ValueError, message):
                plots.slice(self.fields, "lti", **at)
        with self.assertRaisesRegex(KeyError, "ltj"):
            plots.slice(self.fields, "ltj", z=-0.4)
        self.assertEqual(pyplot.get_fignums(), [], "an empty figure is left")

    def test_surface(self):
        found = self.workspace.surface()
        self.assertEqual(found.axes, {"x": "m", "y": "m", "z": "m"})
        axes = plots.surface(found, color="green")
        self.assert_labels(axes, "x [m]", "y [m]", "z [m]")
        (mesh,) = axes.collections
        drawn = np.asarray(mesh._vec)[:3].T.reshape(-1, 3, 3)
        np.testing.assert_allclose(drawn, found.vertices[found.triangles])
        box = np.ptp([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()], axis=1)
        aspect = np.asarray(axes._box_aspect)
        np.testing.assert_allclose(aspect / aspect[0], box / box[0])

    def test_mechanism(self):
        pose = [0.05, 0, -0.4]
        axes = plots.mechanism(self.design, pose)
        self.assert_labels(axes, "x [m]", "y [m]", "z [m]")
        links = self.design.links(pose)
        self.assertEqual(len(axes.lines), len(links.names))
        colours = {}
        for line, part, start, end in zip(axes.lines, links.parts, links.start, links.end):
            np.testing.assert_array_equal(np.transpose(line.get_data_3d()), [start, end])
            self.assertEqual(colours.setdefault(part, line.get_color()), line.get_color())
        self.assertEqual(len(set(colours.values())), len(colours))
        with self.assertRaisesRegex(ValueError, "does not assemble"):
            plots.mechanism(self.design, [0, 0, -4])
        with self.assertRaisesRegex(ValueError, "2 poses; expected one"):
            plots.mechanism(self.design, [pose, pose])
