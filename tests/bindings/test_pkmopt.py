"""The Python package: against the engine's own results, numpy, and misuse."""

import doctest
import multiprocessing
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import pkmopt
from pkmopt import formulas

EXPERIMENTS = pathlib.Path(os.environ["PKM_EXPERIMENTS"])
DELTA = EXPERIMENTS / "mechanisms" / "rotary-delta.toml"
VARIABLES = {"a": (0.2, 0.5), "b": (0.5, 1.2)}


def small_study(**more):
    stages = {"optimiser": "ga", "generations": 12, "population": 20}
    return pkmopt.Study("4ppa-2par", VARIABLES, "workspace-volume", **{"stages": stages, **more})


def same(a, b):
    """Whether two tables of evaluations are equal but for the times."""
    return all(np.array_equal(a[name], b[name]) for name in a.dtype.names if name != "seconds")


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)


class MechanismTest(unittest.TestCase):
    def setUp(self):
        self.delta = pkmopt.Mechanism.from_file(DELTA)
        self.design = self.delta.design()
        rng = np.random.default_rng(1)
        self.poses = rng.uniform([-0.1, -0.1, -0.45], [0.1, 0.1, -0.35], (50, 3))

    def test_description(self):
        self.assertEqual(self.delta.coordinates, ["x", "y", "z"])
        self.assertEqual(self.delta.joints, ["arm1", "arm2", "arm3"])
        self.assertEqual(self.delta.parameters["l_a"].unit, "m")
        self.assertIn("lti", self.delta.quantities)
        self.assertEqual(pkmopt.Mechanism.from_text(self.delta.to_toml()).info, self.delta.info)
        self.assertEqual(pkmopt.Mechanism("4ppa-2par").name, "4ppa-2par")
        self.assertIn("4ppa-2par", pkmopt.mechanism_names())

    def test_inverse_is_the_closed_form(self):
        """One crank in its plane: the elbow is where a circle meets the sphere of the rod."""
        p = self.design.parameters
        q = self.design.inverse(self.poses)[:, 0]
        elbow = np.stack([p["R"] + p["l_a"] * np.cos(q), np.zeros(50), -p["l_a"] * np.sin(q)], axis=1)
        joint = self.poses + [p["r"], 0, 0]
        np.testing.assert_allclose(np.linalg.norm(elbow - joint, axis=1), p["l_b"], rtol=1e-13)

    def test_jacobian_is_the_derivative(self):
        J = self.design.jacobian(self.poses)
        for k in range(3):
            step = np.zeros(3)
            step[k] = 1e-6
            difference = (self.design.inverse(self.poses + step) - self.design.inverse(self.poses - step)) / 2e-6
            np.testing.assert_allclose(J[:, :, k], difference, atol=1e-7)

    def test_forward_inverts_inverse(self):
        q = self.design.inverse(self.poses)
        near = self.design.forward(q, near=self.poses + 0.01)
        np.testing.assert_allclose(near, self.poses, atol=1e-9)
        for pose, found in zip(self.poses, self.design.forward(q)):
            self.assertLess(np.abs(found - pose).max(axis=1).min(), 1e-9)

    def test_near_selects_the_nearest_pose(self):
        """Also among the poses that are unusual in practice, and where the forward kinematics is a closed form."""
        for name, pose in (
            ("4ppa-2par", [0.42, 0.02, -0.31, 0.1]),
            ("4ppa-2par", [0.45, 0.75, -0.72, 0.5]),
            ("quadrupteron", [0.19, 0.15, 0.19, -0.11]),
            ("2t1r-p-hybrid", [-0.03, 0.19, 0.24, -0.15]),
        ):
            design = pkmopt.Mechanism(name).design()
            joints = design.inverse(pose)
            near = design.forward(joints, near=np.add(pose, 0.003))
            np.testing.assert_allclose(near, pose, atol=1e-9, err_msg=name)

    def test_forces_are_those_of_virtual_work(self):
        """At rest, drive forces and a wrench in equilibrium do no work: J^T tau + W = 0, besides gravity."""
        wrench = [3, -2, 5, 0, 0, 0]
        with_wrench = self.design.dynamics(self.poses, wrenches=wrench).forces
        difference = with_wrench - self.design.dynamics(self.poses).forces
        work = np.einsum("kij,ki->kj", self.design.jacobian(self.poses), difference)
        np.testing.assert_allclose(work, np.broadcast_to(np.negative(wrench[:3]), (50, 3)), atol=1e-11)

    def test_one_pose_has_the_shape_of_one(self):
        pose = self.poses[0]
        self.assertEqual(self.design.inverse(pose).shape, (3,))
        self.assertEqual(self.design.inverse({"x": 0, "y": 0, "z": -0.4}).shape, (3,))
        self.assertEqual(self.design.inverse({"x": 0, "y": 0, "z": [-0.4, -0.41]}).shape, (2, 3))
        self.assertEqual(self.design.jacobian(pose).shape, (3, 3))
        self.assertEqual(np.shape(self.design.quantity("lti", pose)), ())
        self.assertEqual(self.design.dynamics(pose).inertia.shape, (3, 3))
        self.assertEqual(self.design.links(pose).start.shape, (9, 3))
        self.assertEqual(self.design.forward(self.design.inverse(pose), near=pose).shape, (3,))
        self.assertEqual(self.design.inverse(np.empty((0, 3))).shape, (0, 3))
        self.assertEqual(self.design.inverse([]).shape, (0, 3))
        np.testing.assert_array_equal(
            self.design.inverse({"x": "10 mm", "y": 0, "z": "-400 mm"}), self.design.inverse([0.01, 0, -0.4]))
        forward = self.design.forward(self.design.inverse(self.poses[:3]), near=[0, 0, -0.4])
        np.testing.assert_allclose(forward, self.poses[:3], atol=1e-9)

    def test_feasible_poses_are_those_of_the_margins(self):
        poses = [[0, 0, -0.4], [0, 0, -4], [0.3, 0, -0.2]]
        self.assertEqual(self.design.feasible(poses).tolist(), [True, False, False])
        self.assertTrue(np.isnan(self.design.inverse(poses)[1]).all())

    def test_threads_do_not_matter(self):
        poses = np.tile(self.poses, (100, 1))
        for function in (self.design.inverse, self.design.margins, self.design.jacobian):
            np.testing.assert_array_equal(function(poses, threads=1), function(poses, threads=2))

    def test_units_and_names(self):
        self.assertEqual(self.delta.design(l_a="250 mm").parameters["l_a"], 0.25)
        other = self.delta.design({"arm2.l_b": "501 mm"})
        self.assertEqual(other.parameters["arm2.l_b"], 0.501)
        self.assertNotEqual(other.inverse([0, 0, -0.4])[1], self.design.inverse([0, 0, -0.4])[1])
        wrong = [
            (lambda: self.delta.design(l_c=1), "unknown parameter 'l_c'"),
            (lambda: self.delta.design(la=1), "did you mean 'l_a'?"),
            (lambda: self.delta.design(l_a="3 kg"), "l_a: found '3 kg'"),
            (lambda: self.design.inverse({"x": 0, "y": 0, "z": "400 kg"}), "z: found '400 kg'"),
            (lambda: self.delta.design(l_a=-1), "outside"),
            (lambda: self.delta.design(limits={"lti": 1}), "unknown limit"),
            (lambda: self.delta.design(mode="x"), "mode"),
            (lambda: self.design.inverse([1, 2]), "expected (3,)"),
            (lambda: self.design.inverse({"x": 1, "y": 2}), "expected x, y, z"),
            (lambda: self.design.quantity("ltj", [0, 0, -0.4]), "did you mean 'lti'?"),
            (lambda: self.design.inverse([0, 0, 0], threads=-1), "threads"),
            (lambda: self.design.forward(np.zeros((3, 3)), near=np.zeros((2, 3))), "near has 2 rows; expected 3 or 1"),
            (lambda: pkmopt.Mechanism("rotary-delta.toml"), "Mechanism.from_file"),
            (lambda: pkmopt.Mechanism("4ppa"), "did you mean '4ppa-2par'?"),
            (lambda: pkmopt.Mechanism.from_text("[mechanism"), "mechanism.toml:1"),
        ]
        for call, message in wrong:
            with self.assertRaisesRegex(ValueError, message.replace("(", r"\(").replace(")", r"\)").replace("?", r"\?")):
                call()
        for call in (
            lambda: pkmopt.Mechanism(3),
            lambda: self.delta.design(l_a=None),
            lambda: self.design.inverse(np.full((2, 3), 1j)),
        ):
            with self.assertRaisesRegex(TypeError, "expected"):
                call()


class WorkspaceTest(unittest.TestCase):
    def test_volume_has_the_gradient_of_differences(self):
        mechanism = pkmopt.Mechanism("4ppa-2par")
        volume, gradient = mechanism.design().volume_and_gradient()
        for name in ("a", "b", "l_u"):
            x = mechanism.parameters[name].default
            above, below = (mechanism.design({name: x + s}).workspace().volume for s in (1e-5, -1e-5))
            self.assertAlmostEqual(gradient[name], (above - below) / 2e-5, delta=1e-5)
        self.assertAlmostEqual(volume, mechanism.design().workspace().volume, delta=0)
        self.assertEqual(mechanism.design().workspace().unit, "m^2 rad")

    def test_methods_agree(self):
        delta = pkmopt.Mechanism.from_file(DELTA).design()
        exact = delta.workspace()
        self.assertLess(exact.error, 1e-7)
        voxels = delta.workspace(method="voxels", cells={"x": 30, "y": 30, "z": 30})
        self.assertAlmostEqual(voxels.volume, exact.volume, delta=0.02 * exact.volume)
        fields = voxels.fields()
        self.assertEqual(fields["lti"].shape, (30, 30, 30))
        self.assertAlmostEqual(fields.volume, voxels.volume)
        self.assertEqual(fields["feasible"].sum(), np.isfinite(fields["lti"]).sum())
        surface = voxels.surface()
        a, b, c = (surface.vertices[surface.triangles[:, i]] for i in range(3))
        enclosed = np.sum(np.einsum("ij,ij->i", a, np.cross(b, c))) / 6
        self.assertAlmostEqual(enclosed, exact.volume, delta=0.02 * exact.volume)

    def test_limits_cut(self):
        cells = {"x": 20, "y": 20, "z": 20}
        design = pkmopt.Mechanism.from_file(DELTA).design()
        whole = design.workspace(method="voxels", cells=cells)
        limited = design.workspace(method="voxels", cells=cells, limits={"lti": {"min": 0.8}})
        self.assertLess(limited.volume, whole.volume)
        cut = pkmopt.Mechanism("4ppa-2par").design(limits={"beta_max": "50 deg"}).workspace()
        self.assertLess(cut.volume, pkmopt.Mechanism("4ppa-2par").design().workspace().volume)

    def test_other_working_modes_are_refused(self):
        mechanism = pkmopt.Mechanism("4ppa-2par")
        with self.assertRaisesRegex(pkmopt.InputError, "working mode"):
            mechanism.design(mode=mechanism.modes[1]).workspace()


class ProblemTest(unittest.TestCase):
    def setUp(self):
        rng = np.random.default_rng(2)
        self.X = rng.uniform([0.2, 0.5], [0.5, 1.2], (40, 2))
        sum_ = {"type": "expression", "name": "sum", "expression": "1.5 - a - b", "unit": "m"}
        self.problem = pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume", sum_)

    def test_values(self):
        found = self.problem.evaluate(self.X)
        np.testing.assert_allclose(found.constraints[:, 0], 1.5 - self.X.sum(axis=1), atol=1e-15)
        np.testing.assert_array_equal(found.status == pkmopt.FEASIBLE, found.constraints[:, 0] >= 0)
        for x, objective in zip(self.X, found.objectives[:, 0]):
            self.assertEqual(self.problem.evaluate(x).objectives[0], objective)
        mechanism = pkmopt.Mechanism("4ppa-2par")
        a, b = self.X[0]
        self.assertAlmostEqual(found.objectives[0, 0], mechanism.design(a=a, b=b).workspace().volume, delta=1e-12)

    def test_arrays_of_all_kinds_are_read(self):
        expected = self.problem.evaluate(self.X).objectives
        read_only = self.X.copy()
        read_only.flags.writeable = False
        columns = {"a": self.X[:, 0], "b": self.X[:, 1]}
        for X in (read_only, np.asfortranarray(self.X), np.repeat(self.X, 2, axis=0)[::2], self.X.tolist(), columns):
            np.testing.assert_array_equal(self.problem.evaluate(X).objectives, expected)
        for _ in range(2):
            self.assertEqual(self.problem.evaluate(read_only[3]).objectives[0], expected[3, 0])
        self.assertEqual(self.problem.evaluate(self.X[:0]).objectives.shape, (0, 1))

    def test_fixed_parameters(self):
        problem = pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume", parameters={"l_u": "650 mm"})
        design = pkmopt.Mechanism("4ppa-2par").design(a=0.3, b=0.9, l_u=0.65)
        self.assertAlmostEqual(problem.evaluate([0.3, 0.9]).objectives[0], design.workspace().volume, delta=1e-12)

    def test_derivatives(self):
        found = self.problem.differentiate(self.X)
        for i in range(2):
            step = np.eye(2)[i] * 1e-6
            above, below = (self.problem.evaluate(self.X + s) for s in (step, -step))
            difference = (above.objectives - below.objectives) / 2e-6
            np.testing.assert_allclose(found.objectives[:, :, i], difference, atol=2e-6)
        np.testing.assert_allclose(found.constraints, -1)

    def test_a_failed_design_says_why(self):
        problem = pkmopt.Problem("4ppa-2par", {"a": (0.2, 0.5)}, {"type": "expression", "name": "root", "expression":
                                 "sqrt(0.3 - a)", "unit": "1"})
        found = problem.evaluate([[0.25], [0.4]])
        self.assertEqual(found.status.tolist(), [pkmopt.FEASIBLE, pkmopt.FAILED])
        self.assertTrue(np.isnan(found.objectives[1, 0]))
        self.assertIn("root", problem.why_failed([0.4]))
        self.assertEqual(problem.why_failed([0.25]), "")
        with self.assertRaisesRegex(ValueError, "expected one"):
            problem.why_failed([[0.25], [0.3]])

    def test_designs_outside_of_the_model_fail(self):
        """A length of -1 m or NaN is no design, but one outside of the bounds of the variables is."""
        outside = [[0.3, 0.9], [-1, 0.9], [0.6, 0.9], [np.nan, 0.9]]
        found = self.problem.evaluate(outside)
        self.assertEqual((found.status == pkmopt.FAILED).tolist(), [False, True, False, True])
        np.testing.assert_array_equal(np.isnan(found.objectives[:, 0]), [False, True, False, True])
        for k in range(4):
            np.testing.assert_array_equal(self.problem.evaluate(outside[k]).objectives, found.objectives[k])
        slopes = self.problem.differentiate(outside).objectives
        np.testing.assert_array_equal(slopes[2], self.problem.differentiate(outside[2]).objectives)
        self.assertTrue(np.isnan(slopes[1]).all())
        self.assertIn("a = -1 is outside the model's range", self.problem.why_failed([-1, 0.9]))
        self.assertEqual(self.problem.evaluate([-1, 0.9]).status, pkmopt.FAILED)

    def test_scipy_interface(self):
        scipy = self.problem.as_scipy()
        x = self.X[0]
        self.assertEqual(scipy.fun(x), -self.problem.evaluate(x).objectives[0])
        np.testing.assert_array_equal(scipy.jac(x), -self.problem.differentiate(x).objectives[0])
        self.assertEqual(scipy.penalised(self.X.T).shape, (40,))
        worst_satisfied = scipy.penalised(self.X.T)[self.X.sum(axis=1) <= 1.5].max()
        self.assertGreater(scipy.penalised(np.array([0.5, 1.2])), worst_satisfied)

    def test_mistakes(self):
        for call in (
            lambda: pkmopt.Problem("4ppa-2par", {"aa": (0, 1)}, "workspace-volume"),
            lambda: pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volum"),
            lambda: pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume", workspase={}),
            lambda: pkmopt.Problem("4ppa-2par", {"a": (1, 2, 3, 4)}, "workspace-volume"),
            lambda: pkmopt.Problem("4ppa-2par", {"a": "0.5"}, "workspace-volume"),
            lambda: self.problem.evaluate([1, 2, 3]),
        ):
            with self.assertRaises(ValueError):
                call()


class StudyTest(InFolder):
    def program(self, *arguments):
        """Runs `pkmopt`, if the build has it beside the library."""
        program = pathlib.Path(os.environ["PKMOPT_LIBRARY"]).parent.parent / "bin" / "pkmopt"
        return subprocess.run([program, *arguments], check=True, capture_output=True, text=True)

    def test_has_the_bits_of_the_program(self):
        for stage in (
            {"optimiser": "ga", "generations": 8},
            {"optimiser": "sweep", "points": 6},
            {"optimiser": "nlopt", "algorithm": "slsqp", "start": "best"},
            {"optimiser": "ipopt", "start": "best"},
        ):
            study = small_study(stages=[stage])
            mine = study.run("mine.h5", overwrite=True).evaluations()
            pathlib.Path("study.toml").write_text(study.to_toml(), encoding="utf-8")
            self.program("run", "study.toml", "--output", "theirs.h5", "--force", "--quiet")
            self.assertTrue(same(mine, pkmopt.open_study("theirs.h5").evaluations()), stage)

    def test_fronts(self):
        study = pkmopt.Study("4ppa-2par", VARIABLES, ["workspace-volume", "workspace-ratio"],
                             stages={"optimiser": "nsga2", "generations": 5, "population": 20})
        results = study.run("front.h5")
        front = results.front
        self.assertGreater(len(front), 1)
        self.assertTrue((np.diff(front["workspace-volume"]) <= 0).all())
        self.assertEqual(len(results.population()), 20)
        self.assertEqual(results.stages[0]["generations"], 6)

    def test_callbacks_stop_and_resume(self):
        whole = small_study().run("whole.h5")
        generations = []
        stopped = small_study().run("stopped.h5", callback=lambda p: generations.append(p.generation) or p.generation == 3)
        self.assertEqual(generations, [0, 1, 2, 3])
        self.assertEqual((stopped.state, stopped.outcome["stopped"]), ("interrupted", "request"))
        self.program("resume", "stopped.h5", "--quiet")
        with pkmopt.open_study("stopped.h5") as resumed:
            self.assertTrue(same(resumed.evaluations(), whole.evaluations()))
        with self.assertRaises(ValueError):
            resumed.evaluations()
        self.assertEqual(len(pkmopt.resume("whole.h5", generations=14).evaluations()), 300)

    def test_killed_and_resumed_by_the_program(self):
        """A process that runs a study is killed within a generation; the program continues from the last checkpoint."""
        study = small_study(checkpoint={"every": 0})
        whole = study.run("whole.h5").evaluations()
        pathlib.Path("study.toml").write_text(study.to_toml(), encoding="utf-8")
        code = ("import pkmopt, time\n"
                "def wait(p): p.generation == 7 and (print('waits', flush=True), time.sleep(60))\n"
                "pkmopt.Study.from_toml('study.toml').run('killed.h5', callback=wait)")
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
            self.assertEqual(process.stdout.readline(), "waits\n")
            process.kill()
        self.assertEqual(process.returncode, -signal.SIGKILL)
        with pkmopt.open_study("killed.h5") as killed:
            self.assertEqual(killed.state, "interrupted")
            self.assertGreater(len(killed.evaluations()), 100)
            self.assertLess(len(killed.evaluations()), len(whole))
        self.program("resume", "killed.h5", "--quiet")
        self.assertTrue(same(pkmopt.open_study("killed.h5").evaluations(), whole))

    def test_studies_on_two_threads_at_once(self):
        whole = [small_study().run("whole-%d.h5" % seed, seed=seed).evaluations() for seed in (1, 2)]
        found, generations = {}, {1: [], 2: []}

        def work(seed):
            callback = lambda p: generations[seed].append(p.generation) and None
            found[seed] = small_study().run("thread-%d.h5" % seed, seed=seed, callback=callback).evaluations()

        def fail():
            with self.assertRaisesRegex(KeyError, "mine"):
                small_study().run("fails.h5", callback=lambda p: {}["mine"])
            found["failed"] = True

        workers = [threading.Thread(target=work, args=(1,)), threading.Thread(target=work, args=(2,)),
                   threading.Thread(target=fail)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertTrue(found["failed"])
        for seed in (1, 2):
            self.assertTrue(same(found[seed], whole[seed - 1]))
            self.assertEqual(generations[seed], list(range(13)))

    def test_files_are_read_on_two_threads_at_once(self):
        for generations in (1, 2):
            small_study(stages={"optimiser": "ga", "generations": generations}).run("%d.h5" % generations)
        wrong = []

        def read(generations):
            for _ in range(50):
                found = len(pkmopt.open_study("%d.h5" % generations).evaluations())
                if found != 20 * (generations + 1):
                    wrong.append(found)

        workers = [threading.Thread(target=read, args=(generations,)) for generations in (1, 2)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertEqual(wrong, [])

    def test_callbacks_run_on_the_calling_thread_and_may_raise(self):
        threads = set()

        def fail(progress):
            threads.add(threading.get_ident())
            if progress.generation == 2:
                raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            small_study().run("raised.h5", callback=fail)
        self.assertEqual(threads, {threading.get_ident()})
        self.assertEqual(pkmopt.open_study("raised.h5").state, "interrupted")

    def test_callbacks_may_use_the_library(self):
        values = []
        study = small_study()
        study.run("nested.h5", callback=lambda p: values.append(study.evaluate([0.3, 1.0]).objectives[0]) and None)
        self.assertEqual(len(set(values)), 1)

    def test_ctrl_c_leaves_a_checkpoint(self):
        endless = small_study(stages={"optimiser": "ga", "generations": 1000000})
        handler = signal.getsignal(signal.SIGINT)
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        start = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            endless.run("endless.h5")
        self.assertLess(time.monotonic() - start, 5)
        timer.join()
        self.assertEqual(signal.getsignal(signal.SIGINT), handler)
        results = pkmopt.open_study("endless.h5")
        self.assertEqual(results.state, "interrupted")
        self.assertGreater(len(results.evaluations()), 100)

    def test_ctrl_c_ends_computations(self):
        cells = {"x": 100, "z": 100, "theta": 100}
        problem = pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume",
                                 workspace={"method": "voxels", "cells": cells})
        X = np.random.default_rng(0).uniform([0.2, 0.5], [0.5, 1.2], (1000000, 2))
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            problem.evaluate(X)
        # Evaluations of microseconds, of which there are seconds.
        problem = pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume")
        X = np.tile(X, (3, 1))
        begin = time.process_time()
        problem.evaluate(X[:100000])
        whole = 30 * (time.process_time() - begin)
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        begin = time.process_time()
        with self.assertRaises(KeyboardInterrupt):
            problem.evaluate(X)
        self.assertLess(time.process_time() - begin, whole / 2)

    def test_seeds_and_existing_files(self):
        first, second = (small_study().run("seed-%d.h5" % seed, seed=seed).evaluations() for seed in (1, 2))
        self.assertFalse(same(first, second))
        with self.assertRaisesRegex(pkmopt.FileError, "exists already; set overwrite"):
            small_study().run("seed-1.h5")
        for wrong in ({"seed": -5}, {"time_limit": 0}, {"time_limit": -1}, {"threads": "2"}):
            with self.assertRaisesRegex(ValueError, "expected"):
                small_study().run("seed-1.h5", overwrite=True, **wrong)
        with self.assertRaisesRegex(ValueError, "generations is -10"):
            pkmopt.resume("seed-1.h5", generations=-10)
        with self.assertRaisesRegex(pkmopt.InputError, "at least one"):
            small_study(stages=[]).run("none.h5")
        with self.assertRaises(OSError):
            pkmopt.open_study("missing.h5")

    def test_a_mechanism_file_travels_with_the_study(self):
        delta = pkmopt.Mechanism.from_file(DELTA)
        cells = {"x": 12, "y": 12, "z": 12}
        study = pkmopt.Study(delta, {"l_a": ("150 mm", "400 mm")}, "workspace-volume",
                             stages={"optimiser": "ga", "generations": 3, "population": 8},
                             workspace={"method": "voxels", "cells": cells})
        best = study.run("delta.h5").best
        again = pkmopt.open_study("delta.h5").study.evaluate([best["design"]["l_a"]])
        self.assertEqual(again.objectives[0], best["objectives"]["workspace-volume"])

    def test_report(self):
        results = small_study().run("report.h5")
        try:
            path = results.report()
        except RuntimeError as error:  # a build without the page
            self.skipTest(str(error))
        self.assertEqual(path, "report.html")
        self.assertIn("workspace-volume", pathlib.Path(path).read_text(encoding="utf-8"))
        self.assertTrue(results._repr_html_().startswith("<iframe"))
        with self.assertRaises(OSError):
            results.report()


FUNCTIONS = '''
def cost(design):
    return (design["a"] - 0.3) ** 2 + design["b"]

def partial(design):
    if design["a"] > 0.35:
        raise KeyError("too wide")
    return design["a"]
'''


class FunctionTest(InFolder):
    """Functions in Python as objectives and constraints."""

    def setUp(self):
        super().setUp()
        pathlib.Path("mine.py").write_text(FUNCTIONS, encoding="utf-8")
        sys.modules.pop("mine", None)

    def study(self, objective, **more):
        return pkmopt.Study("4ppa-2par", VARIABLES, objective,
                            stages={"optimiser": "ga", "generations": 8, "population": 12}, **more)

    def test_values_and_tracebacks(self):
        width = lambda design: 2 * design["a"]
        problem = pkmopt.Problem("4ppa-2par", VARIABLES, [{"type": "python", "call": width, "direction": "maximise"}],
                                 constraints=[{"type": "python", "call": lambda d: d["b"], "min": 0.8, "name": "b"}],
                                 outputs="workspace-volume")
        found = problem.evaluate([[0.3, 1.0], [0.4, 0.7]])
        self.assertEqual(found.objectives.tolist(), [[0.6], [0.8]])
        self.assertEqual(found.status.tolist(), [pkmopt.FEASIBLE, pkmopt.INFEASIBLE])
        self.assertTrue((found.outputs > 0).all())

        def fails(design):
            if design["a"] > 0.35:
                raise KeyError("too wide")
            return design["a"]

        problem = pkmopt.Problem("4ppa-2par", VARIABLES, fails)
        self.assertEqual(problem.evaluate([[0.3, 1], [0.4, 1]]).status.tolist(), [pkmopt.FEASIBLE, pkmopt.FAILED])
        self.assertEqual(problem.evaluate([0.4, 1]).status, pkmopt.FAILED)
        self.assertRegex(problem.why_failed([0.4, 1]), r"KeyError: 'too wide' \(test_pkmopt.py:\d+ in fails\)")
        with self.assertRaisesRegex(pkmopt.InputError, "gradients"):
            problem.differentiate([0.3, 1])

    def test_has_the_bits_of_worker_processes_and_of_the_program(self):
        study = self.study({"type": "python", "call": "mine.py:cost"})
        runs = [study.run("here.h5"), study.run("workers.h5", workers=2)]
        pathlib.Path("study.toml").write_text(study.to_toml(), encoding="utf-8")
        program = pathlib.Path(os.environ["PKMOPT_LIBRARY"]).parent.parent / "bin" / "pkmopt"
        subprocess.run([program, "run", "study.toml", "-o", "program.h5", "--quiet"], check=True)
        runs += [pkmopt.open_study("program.h5"), pkmopt.Study.from_toml("study.toml").run("read.h5")]
        for each in runs[1:]:
            self.assertTrue(same(each.evaluations(), runs[0].evaluations()), each.path)

    def test_resuming_needs_the_same_functions(self):
        def cost(design):
            return design["a"]

        self.study(cost).run("whole.h5")
        self.study(cost).run("stopped.h5", callback=lambda p: p.generation == 3)
        with self.assertRaisesRegex(pkmopt.InputError, "in no file"):
            pkmopt.resume("stopped.h5")
        with self.assertRaisesRegex(pkmopt.FileError, "the function cost was changed"):
            pkmopt.resume("stopped.h5", functions={"cost": lambda design: 0})
        with pkmopt.open_study("stopped.h5") as results:
            self.assertEqual(results.study.info["functions"], ["cost"])
            self.assertEqual(results.study.evaluate([0.3, 1]).status, pkmopt.FAILED)
            results.study.connect([cost])
            self.assertEqual(results.study.evaluate([0.3, 1]).objectives[0], 0.3)
        resumed = pkmopt.resume("stopped.h5", functions=[cost])
        self.assertTrue(same(resumed.evaluations(), pkmopt.open_study("whole.h5").evaluations()))

    def test_the_program_resumes_a_study_that_python_stopped(self):
        study = self.study({"type": "python", "call": "mine.py:cost"})
        whole = study.run("whole.h5")
        study.run("stopped.h5", callback=lambda p: p.generation == 3)
        program = pathlib.Path(os.environ["PKMOPT_LIBRARY"]).parent.parent / "bin" / "pkmopt"
        subprocess.run([program, "resume", "stopped.h5", "--quiet"], check=True)
        self.assertTrue(same(pkmopt.open_study("stopped.h5").evaluations(), whole.evaluations()))

    def test_ctrl_c_in_a_function_leaves_a_checkpoint(self):
        calls = []

        def slow(design):
            calls.append(design)
            if len(calls) == 20:
                os.kill(os.getpid(), signal.SIGINT)
            return design["a"]

        with self.assertRaises(KeyboardInterrupt):
            self.study(slow).run("interrupted.h5")
        self.assertEqual(pkmopt.open_study("interrupted.h5").state, "interrupted")

    def test_functions_are_called_on_the_calling_thread(self):
        threads = set()
        self.study(lambda design: threads.add(threading.get_ident()) or design["a"]).run("thread.h5", threads=2)
        self.assertEqual(threads, {threading.get_ident()})

    def test_mistakes(self):
        entry = {"type": "python", "call": "mine.py:cots"}
        for call, error, message in (
            (lambda: self.study(entry), pkmopt.InputError, "did you mean cost"),
            (lambda: self.study({"type": "python", "call": "missing.py:cost"}), pkmopt.InputError, "no file"),
            (lambda: self.study(len).run("len.h5", workers=1), pkmopt.InputError, "in no file"),
            (lambda: self.study("workspace-volume").connect({"cost": len}), ValueError, "no function, not cost"),
        ):
            with self.assertRaisesRegex(error, message):
                call()

    def test_files_may_import_others_and_have_any_name(self):
        """The file "math.py" does not replace the module, and imports a file beside it when its function is called."""
        pathlib.Path("study").mkdir()
        pathlib.Path("study", "helper_of_math.py").write_text("WEIGHT = 3\n", encoding="utf-8")
        pathlib.Path("study", "math.py").write_text(
            "def cost(design):\n    import helper_of_math\n    return helper_of_math.WEIGHT * design['a']\n"
            "def deep(design):\n    return deep(design)\n", encoding="utf-8")
        modules = dict(sys.modules)
        for name in ("cost", "deep"):
            pathlib.Path("study", name + ".toml").write_text(
                "mechanism = { type = '4ppa-2par' }\nvariables = { a = { min = 0.2, max = 0.5 } }\n"
                "objective = [{ type = 'python', call = 'math.py:%s' }]\n" % name, encoding="utf-8")
        for start_workers in (False, True):
            cost, deep = (pkmopt.Problem.from_toml("study/%s.toml" % name) for name in ("cost", "deep"))
            if start_workers:
                cost.start_workers(1)
                deep.start_workers(1)
            self.assertAlmostEqual(cost.evaluate([0.25]).objectives[0], 0.75)
            self.assertRegex(deep.why_failed([0.25]), r"RecursionError: .*called from \d+ more\)$")
            self.assertLess(len(deep.why_failed([0.25])), 500)
        self.assertIs(sys.modules["math"], modules["math"])

    def test_a_file_that_runs_its_own_study_is_refused(self):
        pathlib.Path("script.py").write_text(
            "import pkmopt\ndef cost(design):\n    return design['a']\n"
            "study = pkmopt.Study('4ppa-2par', {'a': (0.2, 0.5)}, cost, stages={'optimiser': 'ga', 'generations': 2})\n"
            "study.run('script.h5', workers=1)\n", encoding="utf-8")
        path = os.pathsep.join(sys.path)
        ended = subprocess.run([sys.executable, "script.py"], capture_output=True, text=True,
                               env={**os.environ, "PYTHONPATH": path}, timeout=60)
        self.assertIn('if __name__ == "__main__":', ended.stderr)
        self.assertFalse(pathlib.Path("script.h5").exists())


class OptimiserTest(InFolder):
    BOUNDS = [(-2, 2), (-2, 2)]

    def drive(self, optimiser, batch=None):
        while not optimiser.finished:
            X = optimiser.ask(batch)
            optimiser.tell(X, ((X - [1, -0.5]) ** 2).sum(axis=1))
        return optimiser

    def test_designs_do_not_depend_on_the_batches(self):
        whole = self.drive(pkmopt.Optimiser("ga", self.BOUNDS, generations=20, seed=3)).evaluations
        parts = self.drive(pkmopt.Optimiser("ga", self.BOUNDS, generations=20, seed=3), 3).evaluations
        np.testing.assert_array_equal(whole.designs, parts.designs)
        self.assertLess(whole.objectives[whole.best, 0], 1e-2)

    def test_are_those_of_the_built_in_run(self):
        study = small_study()
        run = study.run("run.h5").evaluations()
        optimiser = pkmopt.Optimiser("ga", VARIABLES.values(), maximise=True, generations=12, population=20)
        while not optimiser.finished:
            X = optimiser.ask()
            optimiser.tell(X, study.evaluate(X, complete=False).objectives)
        np.testing.assert_array_equal(optimiser.evaluations.designs, np.stack([run["a"], run["b"]], axis=1))

    def test_constraints_and_several_objectives(self):
        optimiser = pkmopt.Optimiser("nsga2", self.BOUNDS, objectives=2, constraints=1, generations=30, population=24)
        while not optimiser.finished:
            X = optimiser.ask()
            optimiser.tell(X, np.stack([X[:, 0] ** 2, (X[:, 0] - 1) ** 2], axis=1), X[:, 1])
        told = optimiser.evaluations
        last = told.designs[-24:]
        self.assertTrue((last[:, 1] > -0.2).mean() > 0.9)
        self.assertEqual(told.status[told.best], pkmopt.FEASIBLE)

    def test_gradients(self):
        optimiser = pkmopt.Optimiser("nlopt", self.BOUNDS, algorithm="slsqp", start="best")
        self.assertTrue(optimiser.needs_derivatives)
        while not optimiser.finished:
            X = optimiser.ask()
            D = X - [1, -0.5]
            optimiser.tell(X, (D**2).sum(axis=1), dF=2 * D)
        np.testing.assert_allclose(optimiser.best, [1, -0.5], atol=1e-6)

    def test_starts_at_given_designs(self):
        given = {"x1": 0.5, "x2": 1.5}
        optimiser = pkmopt.Optimiser("nlopt", self.BOUNDS, algorithm="slsqp", start="none", designs=[given])
        np.testing.assert_array_equal(optimiser.ask(), [[0.5, 1.5]])

    def test_failed_designs(self):
        optimiser = pkmopt.Optimiser("ga", self.BOUNDS, generations=10)
        while not optimiser.finished:
            X = optimiser.ask()
            optimiser.tell(X, np.where(X[:, 0] < 0, np.nan, X[:, 0]))
        told = optimiser.evaluations
        np.testing.assert_array_equal(told.status == pkmopt.FAILED, told.designs[:, 0] < 0)

    def test_is_saved_within_a_generation(self):
        whole = self.drive(pkmopt.Optimiser("ga", self.BOUNDS, generations=10, seed=5)).evaluations
        optimiser = pkmopt.Optimiser("ga", self.BOUNDS, generations=10, seed=5)
        for _ in range(31):
            X = optimiser.ask(1)
            optimiser.tell(X, ((X - [1, -0.5]) ** 2).sum(axis=1))
        optimiser.save("half.npz")
        again = self.drive(pkmopt.Optimiser.load("half.npz")).evaluations
        np.testing.assert_array_equal(whole.designs, again.designs)

    def test_mistakes(self):
        for call in (
            lambda: pkmopt.Optimiser("gaa", self.BOUNDS),
            lambda: pkmopt.Optimiser("ga", self.BOUNDS, generation=3),
            lambda: pkmopt.Optimiser("ga", [(1, 0)]),
            lambda: pkmopt.Optimiser("ga", self.BOUNDS, objectives=2, maximise=[True]),
            lambda: pkmopt.Optimiser("ga", self.BOUNDS).tell([[0, 0]], [1]),
            lambda: pkmopt.Optimiser("nlopt", [(0, 1, 0.5)], algorithm="slsqp"),
        ):
            with self.assertRaises(ValueError):
                call()
        for arguments, options, message in (
            ([[]], {}, "bounds"),
            ([[(1,)]], {}, "bounds"),
            ([[1, 2]], {}, "bounds"),
            ([self.BOUNDS], {"objectives": 0}, "objectives is 0"),
            ([self.BOUNDS], {"constraints": -1}, "constraints is -1"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                pkmopt.Optimiser("ga", *arguments, **options)
        np.savez("other.npz", a=1)
        with self.assertRaisesRegex(pkmopt.FileError, "other.npz: found no saved optimiser"):
            pkmopt.Optimiser.load("other.npz")
        optimiser = pkmopt.Optimiser("ga", self.BOUNDS)
        with self.assertRaisesRegex(ValueError, "n is -1"):
            optimiser.ask(-1)
        X = optimiser.ask()
        self.assertEqual(repr(optimiser), "<Optimiser ga: 2 variables, 0 evaluations>")
        with self.assertRaisesRegex(ValueError, "in their order"):
            optimiser.tell(X[::-1], X[:, 0])
        with self.assertRaisesRegex(ValueError, "F has shape"):
            optimiser.tell(X, [1, 2])


class DescribeTest(unittest.TestCase):
    def test_a_five_bar(self):
        """The five-bar of the experiments, written with formulas, has the same joints."""
        file = pkmopt.Mechanism.from_file(EXPERIMENTS / "mechanisms" / "five-bar.toml").design()
        p = file.parameters
        with pkmopt.describe("five-bar", "two cranks and two rods") as d:
            half = d.parameter("d", default="%r m" % p["d"], min="1 mm", max="1 m")
            crank = d.parameter("l_a", default="%r m" % p["l_a"], min="1 mm", max="1 m")
            rod = d.parameter("l_b", default="%r m" % p["l_b"], min="1 mm", max="1 m")
            x, y = d.platform(x="along x", y="along y")
            left = d.let("u", x + half)
            square = d.let("s", left**2 + y**2)
            along = (crank**2 + square - rod**2) / (2 * crank)
            turn = formulas.acos(along / formulas.sqrt(square))
            d.formula_limb("left", unit="rad", q1=formulas.atan2(y, left) + turn)
            d.quantity("product", -x * (y - 1) / 2, "m^2")
            d.survey(x=(-0.5, 0.5), y=(0, 0.6))
        design = d.mechanism().design()
        poses = np.array([[0, 0.4], [0.1, 0.35], [-0.05, 0.45]])
        np.testing.assert_allclose(design.inverse(poses)[:, 0], file.inverse(poses)[:, 0], atol=1e-12)
        x, y = poses.T
        np.testing.assert_allclose(design.quantity("product", poses), -x * (y - 1) / 2, atol=1e-16)

    def test_numbers_of_all_kinds_are_terms(self):
        x = formulas.Formula("x")
        for formula, text in (
            (2**x, "2^x"), (np.float64(0.5) * x, "0.5*x"), (x - np.int64(-3), "x - -3"), ((-x) ** 2, "(-x)^2"),
            (1 / (x + "y - z"), "1/(x + (y - z))"),
        ):
            self.assertEqual(str(formula), text)


def evaluate_in_child(connection):
    try:
        connection.send(pkmopt.Mechanism("4ppa-2par").name)
    except RuntimeError as error:
        connection.send(str(error))


class ProcessTest(unittest.TestCase):
    def child(self, method):
        context = multiprocessing.get_context(method)
        here, there = context.Pipe()
        process = context.Process(target=evaluate_in_child, args=(there,))
        process.start()
        answer = here.recv()
        process.join()
        return answer

    def test_forked_processes_are_told_to_spawn(self):
        pkmopt.Mechanism("4ppa-2par")
        self.assertIn('get_context("spawn")', self.child("fork"))
        self.assertEqual(self.child("spawn"), "4ppa-2par")

    def test_two_threads_at_once(self):
        problem = pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume")
        X = np.random.default_rng(0).uniform([0.2, 0.5], [0.5, 1.2], (500, 2))
        expected = problem.evaluate(X).objectives
        wrong = []

        def work():
            for _ in range(20):
                if not np.array_equal(problem.evaluate(X).objectives, expected):
                    wrong.append(1)

        workers = [threading.Thread(target=work) for _ in range(2)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertEqual(wrong, [])

    def test_a_missing_library_is_explained(self):
        program = "import sys; sys.path.insert(0, %r); import pkmopt" % os.environ["PYTHONPATH"].split(os.pathsep)[0]
        failed = subprocess.run([sys.executable, "-c", program], env={"PKMOPT_LIBRARY": "/nowhere.so", "PATH": "/bin"},
                                capture_output=True, text=True)
        self.assertIn("ImportError", failed.stderr)
        self.assertIn("experiments/quickstart.sh", failed.stderr)

    def test_the_command_that_the_quickstart_prints(self):
        """In a copy of the source tree, with the library where the quickstart builds it."""
        with tempfile.TemporaryDirectory(prefix="source tree ") as tree:
            root = pathlib.Path(tree).resolve()
            shutil.copytree(pathlib.Path(pkmopt.__file__).parent, root / "bindings" / "python" / "pkmopt")
            (root / "build" / "quickstart" / "lib").mkdir(parents=True)
            (root / "build" / "quickstart" / "lib" / "libpkmopt.so.0").symlink_to(os.environ["PKMOPT_LIBRARY"])
            lines = (EXPERIMENTS / "quickstart.sh").read_text(encoding="utf-8").splitlines()
            (line,) = [line for line in lines if "Use it from Python" in line]
            printed = subprocess.run(["bash", "-c", line], cwd=root, check=True, capture_output=True, text=True).stdout
            command = printed.split(":", 1)[1].strip()
            self.assertRegex(command, r'^PYTHONPATH=.*bindings/python python3 -c "import pkmopt"$')
            command = command.replace('"import pkmopt"', '"import pkmopt; print(pkmopt.__file__, pkmopt.version)"')
            path = os.path.dirname(sys.executable) + ":/usr/bin:/bin"
            done = subprocess.run(["bash", "-c", command], cwd="/", env={"PATH": path}, capture_output=True, text=True)
            self.assertEqual(done.stdout, "%s/bindings/python/pkmopt/__init__.py %s\n" % (root, pkmopt.version), done.stderr)

    def test_memory_stays_flat(self):
        problem = pkmopt.Problem("4ppa-2par", VARIABLES, "workspace-volume")
        design = pkmopt.Mechanism("4ppa-2par").design()

        def call(times):
            for _ in range(times):
                problem.evaluate([0.3, 1.0])
                design.inverse([0.25, 0.85, -0.8, 0.5])

        def pages():
            return int(pathlib.Path("/proc/self/statm").read_text(encoding="ascii").split()[1])

        call(2000)
        before = pages()
        call(20000)
        self.assertLessEqual(pages() - before, 128)


def load_tests(loader, tests, ignore):
    for name in ("mechanism", "study", "optimiser", "formulas"):
        module = __import__("pkmopt." + name, fromlist=[name])
        finder = {"Mechanism": pkmopt.Mechanism, "Problem": pkmopt.Problem, "Study": pkmopt.Study}
        tests.addTests(doctest.DocTestSuite(module, extraglobs=finder))
    return tests


if __name__ == "__main__":
    unittest.main()
