#!/usr/bin/python3
"""The Python module against the program, against differences, and against solvers of SciPy: unittest, run by python_test.cpp.

checks.py PROGRAM [unittest option]...: PROGRAM is bench_integrators.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np
import scipy.integrate
import scipy.sparse.linalg

import drape

PROGRAM = sys.argv.pop(1)
KEYS = {"grid.n": 5, "material.tension": 200, "material.damping": 2, "material.shear": 2, "end.time": 0.2}


def explicit_euler(ode, t, h, y):
    return y.x + h * y.v, y.v + h * ode.acceleration(t, y.x, y.v)


def implicit_euler(ode, t, h, y):
    """Newton's method on v1 = v0 + h M⁻¹ f(x0 + h v1, v1)."""
    free, mass = ode.free.ravel(), np.repeat(ode.mass, 3)
    v = y.v.copy()
    for _ in range(20):
        x = y.x + h * v
        residual = (mass * (v - y.v).ravel() - h * ode.force(t + h, x, v).ravel())[free]
        df_dx, df_dv = ode.jacobian(t + h, x, v)
        matrix = (scipy.sparse.diags(mass) - h * df_dv - h**2 * df_dx).tocsr()[free][:, free]
        update = np.zeros(3 * ode.n)
        update[free] = scipy.sparse.linalg.spsolve(matrix.tocsc(), residual)
        v -= update.reshape(-1, 3)
        if np.abs(update).max() < 1e-12:
            break
    return y.x + h * v, v


def moved(ode, seed=1):
    """A state that is not special."""
    noise = np.random.default_rng(seed)
    x, v = ode.start
    return x + 0.02 * noise.standard_normal(x.shape), v + 0.3 * noise.standard_normal(v.shape)


class Equation(unittest.TestCase):
    def setUp(self):
        self.scene = drape.scene("hung-corners", KEYS)
        self.ode = self.scene.ode()

    def test_force_is_the_gradient_of_the_energy_and_damping(self):
        x, v = moved(self.ode)
        still = np.zeros_like(v)
        f = self.ode.force(0, x, still)
        for place in ((7, 0), (12, 1), (18, 2)):
            step = np.zeros_like(x)
            step[place] = 1e-6
            slope = (self.ode.energy(x + step) - self.ode.energy(x - step)) / 2e-6
            self.assertAlmostEqual(-slope, f[place], delta=1e-6 * np.abs(f).max())
        np.testing.assert_allclose(self.ode.force(0, x, v) - f, self.ode.damping @ v, atol=1e-12 * np.abs(f).max())

    def test_jacobian_equals_differences_of_the_force(self):
        x, v = moved(self.ode)
        df_dx, df_dv = self.ode.jacobian(0, x, v)
        self.assertEqual(df_dx.shape, (3 * self.ode.n,) * 2)
        direction = np.random.default_rng(2).standard_normal(x.shape)
        for matrix, dx, dv in ((df_dx, direction, 0), (df_dv, 0, direction)):
            e = 1e-6
            difference = (self.ode.force(0, x + e * dx, v + e * dv) - self.ode.force(0, x - e * dx, v - e * dv)) / (2 * e)
            np.testing.assert_allclose((matrix @ direction.ravel()).reshape(-1, 3), difference, atol=1e-6 * np.abs(difference).max())

    def test_linear_part_is_symmetric_and_has_no_gain(self):
        for matrix in (self.ode.stiffness, self.ode.damping):
            dense = matrix.toarray()
            np.testing.assert_array_equal(dense, dense.T)
            self.assertLess(np.linalg.eigvalsh(dense).max(), 1e-9 * np.abs(dense).max())

    def test_nothing_is_copied(self):
        x, v = moved(self.ode)
        out = np.empty_like(x)
        address = out.ctypes.data
        self.assertIs(self.ode.force(0, x, v, out), out)
        self.assertEqual(out.ctypes.data, address)
        np.testing.assert_array_equal(out, self.ode.force(0, x, v))
        self.assertIs(self.ode.acceleration(0, x, v, out), out)
        self.assertEqual(self.ode.copies, 0)
        self.assertEqual(self.ode.mass.ctypes.data, self.ode.mass.ctypes.data)
        self.assertFalse(self.ode.mass.flags.owndata)

    def test_arrays_that_are_not_aligned_are_copied_and_give_the_same(self):
        x, v = moved(self.ode)
        shifted = np.empty(x.size + 1)[1:].reshape(x.shape)
        shifted[:] = x
        self.assertNotEqual(shifted.ctypes.data % 64, 0)
        np.testing.assert_array_equal(self.ode.force(0, shifted, v), self.ode.force(0, x, v))
        self.assertEqual(self.ode.copies, 1)
        self.ode.force(0, x, v, shifted)
        self.assertEqual(self.ode.copies, 2)
        np.testing.assert_array_equal(shifted, self.ode.force(0, x, v))

    def test_new_arrays_are_aligned(self):
        arrays = [np.empty(k) for k in range(1, 200, 7)] + [np.zeros((400, 3)) + k for k in range(9)]
        grown = np.zeros(3)
        grown.resize(5000, refcheck=False)
        self.assertTrue(all(array.ctypes.data % 64 == 0 for array in arrays + [grown]))
        self.assertFalse(grown.any())

    def test_views_outlive_their_owner(self):
        mass = drape.scene("hung-corners", KEYS).ode().mass
        np.testing.assert_array_equal(mass, self.ode.mass)

    def test_derivative_leaves_pins_alone(self):
        x, v = self.ode.start
        dy = self.ode.derivative(0, np.concatenate((x, v), axis=None)).reshape(2, -1, 3)
        np.testing.assert_array_equal(dy[1][~self.ode.free], 0)
        np.testing.assert_array_equal(dy[1], self.ode.acceleration(0, x, v))
        r = np.ones_like(x)
        self.ode.filter(r)
        np.testing.assert_array_equal(r, self.ode.free.astype(float))
        self.assertEqual((~self.ode.free).sum(), 6)


class AgainstOthers(unittest.TestCase):
    def test_steps_are_those_of_the_program(self):
        """Explicit Euler in Python and in the program, on a scene in a file."""
        scene = drape.scene("hung-corners", KEYS)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "sheet.toml")
            file.write_text(scene.toml)
            out = os.path.join(folder, "out.h5")
            subprocess.run([PROGRAM, "run", "--scene", file, "--method", "explicit-euler", "--step", "0.0005", "--until", "0.05",
                            "--repeat", "1", "--no-reference", "--out", out], check=True, stdout=subprocess.DEVNULL)
            with h5py.File(out) as opened:
                x1, v1 = opened["runs/000/final_state/x"][()], opened["runs/000/final_state/v"][()]
            ode = drape.scene(file).ode()
            y = ode.start
            for k in range(100):
                y = drape.State(*explicit_euler(ode, k * 0.0005, 0.0005, y))
        self.assertGreater(np.abs(x1 - ode.start.x).max(), 1e-3)
        np.testing.assert_allclose(y.x, x1, rtol=0, atol=1e-12)
        np.testing.assert_allclose(y.v, v1, rtol=0, atol=1e-10)

    def test_solve_ivp_agrees_with_the_reference(self):
        scene = drape.scene("hung-corners", KEYS)
        ode = scene.ode()
        truth = scene.reference([0.1, 0.2])
        y0 = np.concatenate(ode.start, axis=None)
        found = scipy.integrate.solve_ivp(ode.derivative, (0, 0.2), y0, "RK45", truth.times, rtol=1e-9, atol=1e-11)
        x = found.y[:3 * ode.n].T.reshape(2, -1, 3)
        distance = np.sqrt(((x - truth.x)**2).sum(axis=2).mean(axis=1))
        self.assertTrue((distance < truth.uncertainty + 1e-8).all(), distance)
        self.assertTrue((truth.uncertainty < 1e-7 * scene.size).all())
        self.assertGreater(np.abs(truth.x - ode.start.x).max(), 0.05)
        self.assertEqual(set(truth.families), {"cvode-bdf", "arkode-esdirk"})


class Measured(unittest.TestCase):
    def test_orders_are_one_and_the_rows_those_of_ours(self):
        found = drape.measure(explicit_euler, order=1, scenes=drape.scene("hung-corners", KEYS), steps=[0.002, 0.001, 0.0005],
                              beside=["explicit-euler"], stability=False, repetitions=1)
        orders = found.orders.set_index("method")
        self.assertAlmostEqual(orders.loc["mine", "order"], 1, delta=0.1)
        self.assertTrue(orders.loc["mine", "verdict"].startswith("met"))
        mine, ours = (found.errors[found.errors.method == name] for name in ("mine", "explicit-euler"))
        for column in ("error", "velocity", "energy", "momentum", "angular_momentum"):
            self.assertTrue((mine[column] > 0).all())
            np.testing.assert_allclose(mine[column], ours[column], rtol=1e-6, err_msg=column)
        np.testing.assert_array_equal(mine.forces, ours.forces)
        self.assertTrue((mine.time_ms > 0).all() and (mine.nu_h > 0).all() and (mine.hk_d > 0).all())
        self.assertIn("largest rms distance", found.errors.attrs["meanings"]["error"])
        self.assertEqual(set(found.work_precision().step), {0.002, 0.001, 0.0005})

    def test_implicit_euler_is_ours(self):
        found = drape.measure(implicit_euler, "newton", order=1, scenes=drape.scene("hung-corners", KEYS), steps=[0.01],
                              beside=["implicit-euler"], stability=False, repetitions=1)
        self.assertAlmostEqual(found.orders.set_index("method").loc["newton", "order"], 1, delta=0.1)
        errors = found.errors.error
        self.assertAlmostEqual(errors[0] / errors[1], 1, delta=0.02)  # ours leaves a tenth of the step's error in its stages

    def test_a_wrong_order_is_missed(self):
        found = drape.measure(explicit_euler, order=2, scenes=drape.scene("hung-corners", KEYS), steps=[0.001], beside=[],
                              stability=False, repetitions=1)
        self.assertTrue(found.orders.verdict[0].startswith("missed"), found.orders.verdict[0])

    def test_stability_is_that_of_ours(self):
        found = drape.measure(explicit_euler, scenes=drape.scene("hung-corners", KEYS), steps=[0.05], beside=["explicit-euler"],
                              orders=False, repetitions=1)
        limits = found.stability.pivot(index=["tension", "damping"], columns="method", values="stable")
        np.testing.assert_array_equal(limits["mine"], limits["explicit-euler"])
        self.assertTrue((limits["mine"].fillna(0) < 0.01).all())
        self.assertEqual(set(found.errors.outcome), {"unstable"})
        self.assertIn("stable", str(found))

    def test_solvers_of_scipy_are_rows(self):
        found = drape.measure("RK45", scenes=drape.scene("hung-corners", KEYS), tolerances=[1e-3, 1e-6], beside=[], repetitions=1)
        self.assertEqual(list(found.errors.method), ["RK45-rtol=0.001", "RK45-rtol=1e-06"])
        self.assertLess(found.errors.error[1], 0.1 * found.errors.error[0])
        self.assertGreater(found.errors.forces[1], found.errors.forces[0])
        radau = drape.measure("Radau", scenes=drape.scene("hung-corners", KEYS), tolerances=[1e-5], beside=[], repetitions=1)
        self.assertLess(radau.errors.error[0], 1e-4)

    def test_a_class_is_made_for_every_run(self):
        class Counting:
            made = 0

            def __init__(self):
                type(self).made += 1
                self.first = True

            def __call__(self, ode, t, h, y):
                if self.first != (t == 0):
                    raise RuntimeError("it remembers another run")
                self.first = False
                return explicit_euler(ode, t, h, y)

        drape.measure(Counting, scenes=drape.scene("hung-corners", KEYS), steps=[0.001], beside=[], orders=False, stability=False,
                      repetitions=2)
        self.assertEqual(Counting.made, 3)

    def test_results_are_recorded_for_the_report(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "mine")
            found = drape.measure(explicit_euler, scenes=drape.scene("hung-corners", KEYS), steps=[0.001], beside=["verlet"],
                                  stability=False, repetitions=1, out=out)
            self.assertEqual([file.name for file in found.files], ["runs.h5", "orders.h5"])
            self.assertIn(f"bench/run report {out}/runs.h5 {out}/orders.h5 --out report", str(found))
            tables = drape.read(out / "runs.h5")
            self.assertEqual(list(tables["runs"].method), ["mine", "verlet"])
            self.assertEqual((tables["steps"].run == 0).sum(), 200)
            self.assertEqual(tables["steps"].attrs["units"]["kinetic_energy"], "J")
            subprocess.run([PROGRAM, "report", *found.files, "--out", os.path.join(folder, "report")], check=True,
                           stdout=subprocess.DEVNULL)
            self.assertIn("mine", pathlib.Path(folder, "report/index.html").read_text())

    def test_failures_of_a_method_are_rows_and_errors_of_the_program_are_not(self):
        scene = drape.scene("hung-corners", KEYS)

        def measured(step):
            return drape.measure(step, scenes=scene, steps=[0.05], beside=[], orders=False, stability=False, repetitions=1).errors

        def singular(ode, t, h, y):
            np.linalg.inv(np.zeros((2, 2)))

        def divides(ode, t, h, y):
            return y.x / (1 // 0), y.v

        self.assertEqual(list(measured(lambda ode, t, h, y: (y.x * np.nan, y.v)).outcome), ["not finite"])
        for step, message in ((singular, "Singular matrix"), (divides, "zero")):
            rows = measured(step)
            self.assertEqual(list(rows.outcome), ["failed"])
            self.assertIn(message, rows.message[0])
        with self.assertRaisesRegex(KeyError, "typing"):
            measured(lambda ode, t, h, y: {}["typing"])

    def test_an_equation_ends_with_its_run(self):
        kept = []

        def keeps(ode, t, h, y):
            kept.append(ode)
            return explicit_euler(ode, t, h, y)

        scene = drape.scene("hung-corners", KEYS)
        drape.measure(keeps, scenes=scene, steps=[0.01], beside=[], orders=False, stability=False, repetitions=1)
        with self.assertRaisesRegex(ValueError, "^ode: expected one of a scene, or of a run that has not ended$"):
            kept[0].force(0, *scene.ode().start)

    def test_ctrl_c_ends_it(self):
        scene = drape.scene("hung-corners", {"end.time": 1000})
        with subprocess.Popen(["/bin/sh", "-c", f"sleep 1; kill -INT {os.getpid()}"]), self.assertRaises(KeyboardInterrupt):
            drape.run(scene, "bdf2", 0.0001)
        self.assertEqual(drape.run(drape.scene("hung-corners", KEYS), "bdf2", 0.01, reference=False).row.outcome, "success")


class Runs(unittest.TestCase):
    def test_a_run_of_ours(self):
        scene = drape.scene("hung-corners", KEYS)
        run = drape.run(scene, "bdf2/newton", 0.01, every=0.05)
        self.assertEqual((run.row["method"], run.row["outcome"], len(run.steps)), ("bdf2/newton", "success", 20))
        np.testing.assert_allclose(run.times, [0, 0.05, 0.1, 0.15, 0.2])
        np.testing.assert_array_equal(run.x[-1], run.end_x)
        truth = scene.reference([0.2])
        error = np.sqrt(((run.end_x - truth.x[-1])**2).sum(axis=1).mean()) / scene.size
        self.assertAlmostEqual(error / run.row["error/rms"], 1, delta=1e-3)

    def test_score_of_a_motion_that_is_known(self):
        scene = drape.scene("hung-corners", KEYS)
        times = np.linspace(0, 0.2, 5)
        start = scene.ode().start.x
        frames = np.concatenate(([start], scene.reference(times[1:]).x))
        frames[1:, :, 2] += 1e-3
        found = drape.score(scene, times, frames[:, ::-1])  # vertices in another order
        self.assertAlmostEqual(found["summary"]["error"][0] * scene.size, 1e-3, delta=1e-6)
        np.testing.assert_allclose(found["frames"]["rms"] * scene.size, [0] + [1e-3] * 4, atol=1e-6)

    def test_names(self):
        self.assertEqual(list(drape.methods())[:2], ["imex-euler", "implicit-euler"])
        self.assertIn("hung-corners", drape.scenes())
        self.assertIn("material.damping", drape.scene_keys())

    def test_scenes_by_keys(self):
        self.assertIn("material.damping = [7, 7]", drape.scene("hung-corners", damping=7).toml)
        self.assertEqual(drape.scene("hung-corners", {"grid.n": [4, 3]}).ode().n, 12)
        self.assertEqual(drape.scene("hung-corners", time=np.float64(0.25)).end, 0.25)


class Refusals(unittest.TestCase):
    def refused(self, line, function, *arguments, **keywords):
        with self.assertRaisesRegex(ValueError, line) as caught:
            function(*arguments, **keywords)
        self.assertNotIn("\n", str(caught.exception))

    def test_scenes(self):
        self.refused("unknown scene 'hung-corner'", drape.scene, "hung-corner")
        self.refused("^material.damping = -1: expected a number of at least 0$", drape.scene, "hung-corners", damping=-1)
        self.refused("dampening", drape.scene, "hung-corners", dampening=1)
        self.refused("material.damping: expected a number", drape.scene, "hung-corners", {"material.damping": object()})
        self.refused("no-file.toml", drape.scene, "no-file.toml")

    def test_arrays(self):
        ode = drape.scene("hung-corners", KEYS).ode()
        x, v = ode.start
        expected = r"expected an array of shape \(25, 3\) and type float64, row by row \(C order\)"
        self.refused(rf"^x: {expected}, not shape \(24, 3\)$", ode.force, 0, x[1:], v)
        self.refused(rf"^v: {expected}, not type float32$", ode.force, 0, x, v.astype(np.float32))
        self.refused(rf"^x: {expected}, not list$", ode.force, 0, x.tolist(), v)
        self.refused(rf"^x: {expected}, not one in another order$", ode.energy, np.asfortranarray(x))
        self.refused(r"^x: .* not type >f8$", ode.energy, x.astype(">f8"))
        out = np.empty_like(x)
        out.flags.writeable = False
        self.refused("^out: .* and writeable, not one that is read-only$", ode.force, 0, x, v, out)
        self.refused("^y: expected 150 numbers", ode.derivative, 0, np.zeros(149))
        with self.assertRaises(ValueError):
            ode.mass[0] = 1

    def test_measurements(self):
        scene = drape.scene("hung-corners", KEYS)
        self.refused("'bdf2' is a method of ours", drape.measure, explicit_euler, "bdf2", scenes=scene)
        self.refused("^name: expected 1 to 60 letters", drape.measure, explicit_euler, "a b", scenes=scene)
        self.refused("^step: expected a function", drape.measure, 3, scenes=scene)
        self.refused("^step: expected a function or one of RK23", drape.measure, "RK4", scenes=scene)
        self.refused("^tolerances: expected with solvers", drape.measure, explicit_euler, tolerances=[1e-3])
        self.refused("^steps: RK45 chooses its own", drape.measure, "RK45", steps=[0.1])
        self.refused("^step: expected a positive number of seconds, not -1", drape.measure, explicit_euler, scenes=scene, steps=[-1])
        self.refused("unknown method 'bdf9'", drape.measure, explicit_euler, scenes=scene, beside=["bdf9"])
        self.refused("^beside: expected a list of names", drape.measure, explicit_euler, scenes=scene, beside="bdf2")
        self.refused("^scenes: expected", drape.measure, explicit_euler, scenes=["hung-corners"])
        self.refused("one with contact$", drape.measure, explicit_euler, scenes=drape.scene("box_swing"))
        self.refused(r"^step: expected it to return y = \(x, v\), or an object that has both, not NoneType$", drape.measure,
                     lambda *_: None, scenes=scene)
        self.refused(r"^step: expected y = \(x, v\) with v of shape \(25, 3\), not an array of shape \(3,\)$", drape.measure,
                     lambda ode, t, h, y: (y.x, y.v[0]), scenes=scene)
        with tempfile.TemporaryDirectory() as folder:
            self.refused("expected the name of a new folder", drape.measure, explicit_euler, scenes=scene, out=folder)

    def test_files_and_motions(self):
        self.refused("none.h5: expected a results file", drape.read, "none.h5")
        self.refused("cannot be read as HDF5", drape.read, __file__)
        scene = drape.scene("hung-corners", KEYS)
        x = scene.ode().start.x
        self.refused("times that increase", drape.score, scene, [0, 0], [x, x])
        self.refused("up to the scene's end", drape.score, scene, [0, 9], [x, x])
        self.refused("reference|times", scene.reference, [0.2, 0.1])


if __name__ == "__main__":
    unittest.main(verbosity=2)
