"""An integrator from outside beside ours."""
from __future__ import annotations

import dataclasses
import os
import pathlib
import typing

import numpy as np
import pandas as pd

from drape import _drape
from drape._drape import Ode, Scene, Stepper
from drape.files import read
from drape.scenes import command_line, recording_folder, scene
from drape.solve_ivp import solver_class, steps_of
from drape.state import State

Step = typing.Callable[[Ode, float, float, State], typing.Any]

#: Columns of Measurement.errors, and what they are called in read()["runs"].
COLUMNS = {
    "scene": "scene", "set": "overrides", "method": "method", "step": "step", "outcome": "outcome", "error": "motion_error/position",
    "reference_error": "error/reference_error", "growth": "error/growth", "velocity": "motion_error/velocity",
    "energy": "motion_error/energy", "momentum": "motion_error/momentum", "angular_momentum": "motion_error/angular_momentum",
    "forces": "forces", "time_ms": "time_ms", "nu_h": "numerical_stiffness", "hk_d": "stiffness_to_damping", "message": "message"}

#: What the same columns are.
MEANINGS = {
    "error": "largest rms distance from the reference at the tenths of the run, over the scene's size",
    "reference_error": "the reference's uncertainty in the same measure: an error below ten times it is not a number to rely on",
    "growth": "of a small perturbation of the start; beyond 100 the error says little about a method",
    "velocity": "as error, over the reference's largest velocity",
    "energy": "drift of the total energy from the reference's, over the largest energy of its motion",
    "momentum": "drift of the momentum, over mass times the reference's largest velocity",
    "angular_momentum": "drift of the angular momentum, over that times the size",
    "forces": "evaluations of the force or its explicit part",
    "time_ms": "median wall time of the repetitions, interleaved with those of the other rows",
    "nu_h": "h² k/(ρ l²)", "hk_d": "h k/d"}


@dataclasses.dataclass(frozen=True, eq=False)
class Measurement:
    """What drape.measure has found. print() shows all of it; drape.measure's help says what the columns are."""

    errors: pd.DataFrame  #: a row for each scene, method and step
    orders: pd.DataFrame | None  #: a row for each method: its order on a soft sheet, with verdict
    stability: pd.DataFrame | None  #: the largest usable steps for several h k/d
    files: list[pathlib.Path]  #: what is recorded; empty if no folder was asked for
    refinements: pd.DataFrame | None = None  #: errors and orders from step to step, of which `orders` is made

    def work_precision(self, by: str = "forces") -> pd.DataFrame:
        """The rows of `errors` that no other row of their scene betters in error and in work, "forces" or "time_ms"."""
        if by not in ("forces", "time_ms"):
            raise ValueError(f"by: expected forces or time_ms, not {by!r}")
        best = []
        for _, rows in self.errors[self.errors["error"].notna()].groupby(["scene", "set"], sort=False):
            rows = rows.sort_values([by, "error"])
            best.append(rows[rows["error"] < rows["error"].cummin().shift(fill_value=np.inf)])
        return pd.concat(best) if best else self.errors.iloc[:0]

    def __str__(self) -> str:
        parts = [("Errors against the certified reference", self.errors), ("Orders on a soft sheet", self.orders),
                 ("Largest usable steps of a sheet hung by two corners", self.stability)]
        texts = [f"{title}\n{_shown(frame)}" for title, frame in parts if frame is not None]
        if self.files:
            texts.append(f"report: bench/run report {' '.join(map(str, self.files))} --out report")
        return "\n\n".join(texts)


def _shown(frame: pd.DataFrame) -> str:
    shown = frame.loc[:, [column for column in frame if frame[column].notna().any() and (frame[column] != "").any()]]
    return shown.to_string(index=False, float_format=lambda value: f"{value:.4g}", na_rep="")


def _steppers(step: typing.Any, name: str | None, order: int, steps: typing.Sequence[float] | None,
              tolerances: typing.Sequence[float] | None) -> list[Stepper]:
    solver = solver_class(step)
    if solver is None:
        if tolerances is not None:
            raise ValueError("tolerances: expected with solvers of scipy.integrate alone; a function takes steps=[...]")
        return [Stepper(name or "mine", order, step)]
    if steps is not None:
        raise ValueError(f"steps: {solver.__name__} chooses its own; expected tolerances=[...]")
    return [Stepper(f"{name or solver.__name__}-rtol={rtol:g}", order, steps_of(solver, rtol)) for rtol in tolerances or (1e-4, 1e-6)]


def _errors(file: pathlib.Path) -> pd.DataFrame:
    runs = read(file)["runs"]
    counted = [column for column in ("work/forces", "work/explicit_forces") if column in runs]
    runs["forces"] = runs[counted].sum(axis=1).astype(int)
    frame = pd.DataFrame({name: runs[path] if path in runs else np.nan for name, path in COLUMNS.items()})
    frame.attrs = {"provenance": runs.attrs["provenance"], "meanings": MEANINGS}
    return frame


def _orders(rows: pd.DataFrame, undeclared: set[str]) -> pd.DataFrame:
    first = rows.drop_duplicates("method")[["method", "fitted_order", "spread", "verdict"]].reset_index(drop=True)
    first.loc[first["method"].isin(undeclared), "verdict"] = ""
    return first.rename(columns={"fitted_order": "order", "spread": "between"})


def _stability(rows: pd.DataFrame, particles: int) -> pd.DataFrame:
    sheets = [scene("hung-corners", n=particles, tension=k, damping=d) for k, d in zip(rows["tension"], rows["damping"])]
    rows["nu_h"] = [sheet.numerical_stiffness(h) if h > 0 else np.nan for sheet, h in zip(sheets, rows["stable"])]
    rows["hk_d"] = [sheet.stiffness_to_damping(h) if h > 0 else np.nan for sheet, h in zip(sheets, rows["stable"])]
    return rows


def measure(step: Step | type | str, name: str | None = None, *, order: int | None = None,
            scenes: typing.Sequence[Scene] | Scene | None = None, steps: typing.Sequence[float] | None = None,
            tolerances: typing.Sequence[float] | None = None,
            beside: typing.Sequence[str] = ("imex-euler", "implicit-euler", "bdf2", "midpoint", "verlet"), orders: bool = True,
            stability: bool = True, repetitions: int = 3, out: str | os.PathLike[str] | None = None) -> Measurement:
    """Measures a time integrator beside methods of ours.

    step: a function step(ode, t, h, y) that returns the y at t + h, where y is a drape.State (x, v), and what is returned an (x, v)
        or an object that has both; ode is a drape.Ode. A class is made again for every run, for integrators that remember. Or a solver
        of scipy.integrate: its name, "RK45", or its class; it chooses its steps by `tolerances`.
    name: what its rows are called ["mine", or the solver's name]. order: its order, if there is one to be confirmed.
    scenes: drape.scene(...) or several [a sheet of 10 x 10 particles hung by two corners, d = 5, 0.3 s], without contact.
    steps: [s] [0.01, 0.005, 0.0025, 0.00125]. tolerances: rtol, and atol in m and m/s [1e-4, 1e-6].
    beside: methods of ours that take the same steps. repetitions: how often runs are timed, interleaved, besides the one recorded.
    orders, stability: whether these are measured, on sheets of their own.
    out: a new folder for what is recorded, which `bench/run report` makes a page of.

    Returns a Measurement. In its `errors` the column "error" is the largest rms distance from the certified reference at the tenths of
    the run, over the scene's size, and "reference_error" what that is uncertain by; `errors.attrs["meanings"]` explains the others.
    A run fails, as a row, by ArithmeticError, numpy.linalg.LinAlgError, values that are not finite, or by an energy beyond all that the
    scene can have; other exceptions of `step` pass through.
    """
    mine = _steppers(step, name, order or 1, steps, tolerances)
    adaptive = tolerances is not None or solver_class(step) is not None
    every = [scene("hung-corners", n=10, damping=5, time=0.3)] if scenes is None else [scenes] if isinstance(scenes, Scene) else list(scenes)
    if not every:
        raise ValueError("scenes: expected at least one drape.scene(...)")
    if isinstance(beside, str) or any(not isinstance(method, str) for method in beside):
        raise ValueError("beside: expected a list of names of methods, [\"bdf2\", \"verlet\"]")
    if any(not isinstance(one, Scene) for one in every):
        raise ValueError("scenes: expected drape.scene(...), or a list of such")
    sizes = [float(h) for h in (steps if steps is not None else (0.01, 0.005, 0.0025, 0.00125))]
    methods: list[Stepper | str] = [*mine, *beside]
    rows = [(one, [(method, h) for method in mine for h in ([one.end / 10] if adaptive else sizes)] +
             [(method, h) for method in beside for h in sizes]) for one in every]
    with recording_folder(out) as folder:
        files = [folder / "runs.h5"]
        _drape.sweep(rows, str(files[0]), repetitions, True, None, command_line())
        fitted = refinements = limits = None
        if orders and not adaptive:
            files.append(folder / "orders.h5")
            _drape.orders(methods, 1e6, str(files[-1]), command_line())
            refinements = read(files[-1])["orders-soft"]
            fitted = _orders(refinements, set() if order else {one.name for one in mine})
        if stability and not adaptive:
            files.append(folder / "stability.h5")
            _drape.stability(methods, False, str(files[-1]), command_line())
            limits = _stability(read(files[-1])["stability-steps"], particles=10)
        return Measurement(_errors(files[0]), fitted, limits, files if out is not None else [], refinements)
