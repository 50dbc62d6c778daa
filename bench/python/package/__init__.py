"""drape: time integrators of cloth beside a certified reference.

    import drape

    scene = drape.scene("hung-corners", damping=5)       # or a file: drape.scene("mine.toml")
    ode = scene.ode()                                    # M dv/dt = f(t, x, v): ode.mass, ode.force(t, x, v), ode.jacobian(t, x, v)
    truth = scene.reference([0.1, 0.2])                  # certified: truth.x, truth.uncertainty

    def step(ode, t, h, y):                              # an integrator of yours
        v = y.v + h * ode.acceleration(t, y.x, y.v)
        return y.x + h * v, v

    print(drape.measure(step, name="symplectic-euler", order=1, steps=[3e-4, 1e-4]))   # errors, orders, stability, work

help(drape.measure), help(drape.Ode) and help(drape.scene) say more; drape.scenes(), drape.scene_keys() and drape.methods() list what
there is. drape.run(scene, "bdf2", 0.01) runs a method of ours, drape.score(scene, times, x) measures another simulator's motion, and
drape.read("runs.h5") makes tables of recorded results. Bad input raises ValueError with one line.
"""
from drape._drape import Ode, Scene
from drape.files import read
from drape.measure import Measurement, measure
from drape.scenes import Reference, Run, methods, run, scene, scene_keys, scenes, score
from drape.solve_ivp import derivative_jacobian
from drape.state import State

__all__ = ["Measurement", "Ode", "Reference", "Run", "Scene", "State", "derivative_jacobian", "measure", "methods", "read", "run", "scene",
           "scene_keys", "scenes", "score"]
