"""Solvers of scipy.integrate as steppers."""
from __future__ import annotations

import typing

import numpy as np
import scipy.integrate
import scipy.sparse

from drape._drape import Ode
from drape.state import State

METHODS: dict[str, type[scipy.integrate.OdeSolver]] = {
    name: getattr(scipy.integrate, name) for name in ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")}


def solver_class(step: typing.Any) -> type[scipy.integrate.OdeSolver] | None:
    """The solver that solve_ivp has under a name, or a class of one; None of anything else."""
    if isinstance(step, str):
        if step not in METHODS:
            raise ValueError(f"step: expected a function or one of {', '.join(METHODS)}, not {step!r}")
        return METHODS[step]
    return step if isinstance(step, type) and issubclass(step, scipy.integrate.OdeSolver) else None


def derivative_jacobian(ode: Ode, t: float, y: np.ndarray) -> scipy.sparse.csc_matrix:
    """The Jacobian of ode.derivative, shape (6n, 6n), for solvers that want it."""
    x, v = y.reshape(2, ode.n, 3)
    free = scipy.sparse.diags((ode.free / ode.mass[:, None]).ravel())
    df_dx, df_dv = ode.jacobian(t, x, v)
    return scipy.sparse.bmat([[None, scipy.sparse.identity(3 * ode.n)], [free @ df_dx, free @ df_dv]], format="csc")


def steps_of(solver: type[scipy.integrate.OdeSolver], rtol: float) -> type:
    """A stepper that lets a solver run with steps of its own, with rtol and atol = rtol [m, m/s], and reads its dense output."""
    implicit = {"jac"} & set(solver.__init__.__code__.co_varnames) and solver is not scipy.integrate.LSODA

    class Steps:
        def __init__(self) -> None:
            self.solver: scipy.integrate.OdeSolver | None = None

        def __call__(self, ode: Ode, t: float, h: float, y: State) -> State:
            if self.solver is None:
                options = {"jac": lambda s, z: derivative_jacobian(ode, s, z)} if implicit else {}
                self.solver = solver(ode.derivative, t, np.concatenate((y.x, y.v), axis=None), np.inf, rtol=rtol, atol=rtol, **options)
            while self.solver.t < t + h:
                message = self.solver.step()
                if self.solver.status == "failed":
                    raise ArithmeticError(message)
            return State(*self.solver.dense_output()(t + h).reshape(2, ode.n, 3))

    return Steps
