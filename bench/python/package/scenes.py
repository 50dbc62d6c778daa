"""Scenes, their certified references, and what other motions are worth."""
from __future__ import annotations

import contextlib
import dataclasses
import functools
import json
import os
import pathlib
import sys
import tempfile
import typing

import h5py
import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from drape import _drape
from drape._drape import Scene
from drape.files import read


@functools.cache
def _keys() -> dict[str, str]:
    """Keys of scenes, each by its path and, where that tells it from others, by its last word."""
    paths = [path for path, _ in _drape.scene_keys()]
    words = [path.rpartition(".")[2] for path in paths]
    return {**{word: path for word, path in zip(words, paths) if words.count(word) == 1}, **{path: path for path in paths}}


def _path(key: str) -> str:
    known = _keys()
    if key in known:
        return known[key]
    several = [path for path in known if path.rpartition(".")[2] == key]
    if several:
        raise ValueError(f"{key}: expected one of {', '.join(several)}, by a dictionary: scene(name, {{{several[0]!r}: ...}})")
    return key  # what is no key, the reader of scenes says


def _toml(key: str, value: typing.Any) -> str:
    """A value as a scene file has it."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, (bool, str)):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, typing.Mapping):
        return "{" + ", ".join(f"{name} = {_toml(key, item)}" for name, item in value.items()) + "}"
    if isinstance(value, typing.Sequence):
        return "[" + ", ".join(_toml(key, item) for item in value) + "]"
    raise ValueError(f"{key}: expected a number, a text, a truth value, or a list or dictionary of these, not {type(value).__name__}")


def scene(name_or_file: str | os.PathLike[str], overrides: typing.Mapping[str, typing.Any] | None = None, **keys: typing.Any) -> Scene:
    """A scene: one of drape.scenes(), or a file (.toml; a mesh, .obj or .ply; a pattern, .json), with some
    keys set differently.

    Keys are given by their last words, if these tell them from others, or by their paths in a dictionary:

        drape.scene("hung-corners", damping=5, n=10)
        drape.scene("hung-corners", {"material.damping": 5, "end.time": 0.5})

    Raises ValueError, naming the file, line or key and what would be right.
    """
    sets = [f"{_path(key)}={_toml(key, value)}" for key, value in {**(overrides or {}), **keys}.items()]
    return _drape.load_scene(os.fspath(name_or_file), sets)


def scenes() -> dict[str, str]:
    """The built-in scenes with their descriptions."""
    return dict(_drape.scenes())


def scene_keys() -> dict[str, str]:
    """The keys of scenes with their descriptions and units."""
    return dict(_drape.scene_keys())


def methods() -> dict[str, str]:
    """Our methods with their descriptions."""
    return dict(_drape.methods())


@dataclasses.dataclass(frozen=True, eq=False)
class Reference:
    """The motion of a scene as two families of solvers that agree compute it.

    Raised instead if they do not: RuntimeError, which names the scene and says by how much they differ.
    """

    times: NDArray[np.float64]  #: F [s]
    x: NDArray[np.float64]  #: positions, shape (F, n, 3) [m]
    v: NDArray[np.float64]  #: velocities, shape (F, n, 3) [m/s]
    uncertainty: NDArray[np.float64]  #: how far the families differ, root mean square over the particles, shape (F,) [m]
    growth: NDArray[np.float64]  #: of a small perturbation of the start, over its size there, shape (F,)
    families: tuple[str, str]  #: the solvers, the first is the one whose motion this is


@contextlib.contextmanager
def recording_folder(out: str | os.PathLike[str] | None) -> typing.Iterator[pathlib.Path]:
    """A folder for recorded files: a new one that is asked for and stays if anything was recorded, or one that goes away."""
    if out is None:
        with tempfile.TemporaryDirectory(prefix="drape-") as folder:
            yield pathlib.Path(folder)
        return
    folder = pathlib.Path(out)
    if folder.exists():
        raise ValueError(f"{folder}: expected the name of a new folder, this exists")
    folder.mkdir(parents=True)
    try:
        yield folder
    finally:
        if not any(folder.iterdir()):
            folder.rmdir()


def command_line() -> str:
    """What results were made by, for their provenance."""
    return "python " + " ".join(sys.argv)


def score(scene: Scene, times: ArrayLike, x: ArrayLike, v: ArrayLike | None = None) -> dict[str, pd.DataFrame]:
    """Measures the motion of another simulator against the certified reference of a scene.

    times: F [s], from 0 to at most the scene's end. x: positions, shape (F, m, 3) [m], where m vertices in any order include all
    particles, found by where they are at the start; v: velocities [m/s], or differences of the positions. Returns "summary": one
    row, errors over the scene's size, lag [s] and damping [1/s] with their uncertainties; and "frames": a row a frame, with
    energies. The columns' units are in `frame.attrs["units"]`. Raises ValueError if the motion is not one of this scene.
    """
    with tempfile.TemporaryDirectory(prefix="drape-") as folder:
        motion, out = os.path.join(folder, "motion.h5"), os.path.join(folder, "score.h5")
        with h5py.File(motion, "w") as file:
            for name, values in (("time", times), ("positions", x), ("velocities", v)):
                if values is not None:
                    file[name] = np.asarray(values, dtype=np.float64)
        _drape.score(scene, motion, out, command_line())
        tables = read(out)
        return {"summary": tables["score-summary"], "frames": tables["score"]}


@dataclasses.dataclass(frozen=True, eq=False)
class Run:
    """One run of one method on a scene."""

    row: pd.Series  #: outcome, errors, work and times: a row of read()["runs"]
    steps: pd.DataFrame  #: time [s], energies [J] and iterations of each step
    times: NDArray[np.float64]  #: of frames, F [s]; F = 0 if none were asked for
    x: NDArray[np.float64]  #: positions of the frames, shape (F, n, 3) [m]
    v: NDArray[np.float64]  #: velocities of the frames, shape (F, n, 3) [m/s]
    end_x: NDArray[np.float64]  #: positions where it ended, shape (n, 3) [m]
    end_v: NDArray[np.float64]  #: velocities where it ended, shape (n, 3) [m/s]


def run(scene: Scene, method: str, step: float, every: float | None = None, reference: bool = True, repetitions: int = 1) -> Run:
    """Runs one of our methods, "bdf2" or "bdf2/newton", on a scene with steps of `step` seconds.

    every: simulated seconds between the frames that are kept. reference: whether its error is measured. repetitions: how often it is
    timed besides the run that is recorded.
    """
    with tempfile.TemporaryDirectory(prefix="drape-") as folder:
        out = os.path.join(folder, "run.h5")
        _drape.sweep([(scene, [(method, step)])], out, repetitions, reference, every, command_line())
        tables = read(out)
        with h5py.File(out) as file:
            group = file["runs/000"]
            frames = group.get("trajectory")
            none = np.empty((0, 0, 3))
            return Run(tables["runs"].iloc[0], tables["steps"].drop(columns="run"), frames["t"][()] if frames else np.empty(0),
                       frames["x"][()] if frames else none, frames["v"][()] if frames else none, group["final_state/x"][()],
                       group["final_state/v"][()])
