"""The state of a cloth."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class State(NamedTuple):
    """Positions x [m] and velocities v [m/s] of n particles, each of shape (n, 3)."""

    x: NDArray[np.float64]
    v: NDArray[np.float64]
