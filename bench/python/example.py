#!/usr/bin/python3
"""An integrator of ten lines, from nothing to its first certified table of errors. Cells as notebooks have them (`# %%`).

    eval "$(bench/run --python)" && /usr/bin/python3 bench/python/example.py
"""
# %% A scene: its equation of motion, and its certified reference
import numpy as np
import scipy.sparse.linalg

import drape

scene = drape.scene("hung-corners", n=6, damping=5, time=0.2)
ode = scene.ode()
x, v = ode.start
print(f"{scene}: {ode.n} particles, {ode.mass.sum():.3g} kg, force at the start {np.abs(ode.force(0, x, v)).max():.3g} N")
truth = scene.reference([0.1, 0.2])
print(f"the reference moves by {np.abs(truth.x[-1] - x).max():.3g} m, uncertain by {truth.uncertainty.max():.1g} m")


# %% An integrator: linearly implicit Euler   [Baraff, Witkin 1998, (6)]
#    (M - h df/dv - h² df/dx) dv = h (f + h df/dx v),   in the free coordinates
def linear_euler(ode, t, h, y):
    df_dx, df_dv = ode.jacobian(t, y.x, y.v)
    free = ode.free.ravel()
    matrix = scipy.sparse.diags(np.repeat(ode.mass, 3)) - h * df_dv - h**2 * df_dx
    right = h * (ode.force(t, y.x, y.v).ravel() + h * (df_dx @ y.v.ravel()))
    dv = np.zeros(3 * ode.n)
    dv[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free].tocsc(), right[free])
    v = y.v + dv.reshape(-1, 3)
    return y.x + h * v, v


# %% Beside our methods
measured = drape.measure(linear_euler, name="linear-euler", order=1, scenes=scene, steps=[0.02, 0.01, 0.005], beside=["bdf2", "verlet"],
                         stability=False, repetitions=1)
print(measured)
print("\nbest at their work\n", measured.work_precision("forces")[["method", "step", "error", "forces"]].to_string(index=False))

# %% A solver of SciPy
print(drape.measure("RK45", scenes=scene, tolerances=[1e-3, 1e-5], beside=[], repetitions=1))

# %% A motion of another simulator, here the reference itself, moved by a millimetre
times = np.linspace(0, scene.end, 5)
frames = np.concatenate(([x], scene.reference(times[1:]).x)) + [0, 0, 1e-3] * (times > 0)[:, None, None]
print(drape.score(scene, times, frames)["summary"][["error", "reference_error", "lag", "damping"]].to_string(index=False))
