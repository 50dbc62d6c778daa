"""Recorded results as tables of pandas."""
from __future__ import annotations

import os
import typing
import warnings

import h5py
import numpy as np
import pandas as pd


def _text(value: typing.Any) -> typing.Any:
    return value.decode() if isinstance(value, bytes) else value


def _column(dataset: h5py.Dataset) -> np.ndarray:
    cells = dataset[()]
    return np.array([_text(cell) for cell in cells], dtype=object) if cells.dtype.kind == "O" else cells


def _frame(columns: dict[str, typing.Any], units: dict[str, str]) -> pd.DataFrame:
    frame = pd.DataFrame(columns)
    frame.attrs["units"] = units
    return frame


def _table(group: h5py.Group) -> pd.DataFrame:
    columns, units = {}, {}
    for name in map(_text, group["columns"][()]):
        columns[name] = _column(group[name])
        units[name] = group[name].attrs["unit"]
        if f"{name}.standing" in group:  # met, open or missed, and the detail
            pairs = zip(_column(group[f"{name}.standing"]), columns[name])
            columns[name] = [": ".join(filter(None, pair)) for pair in pairs]
    frame = _frame(columns, units)
    frame.attrs["title"] = _text(group.attrs.get("description", ""))
    return frame


TEXTS = ("scene", "overrides", "method", "outcome", "message")


def _run(group: h5py.Group) -> tuple[dict[str, typing.Any], dict[str, str], dict[str, pd.DataFrame]]:
    """A run's numbers by their paths in its group, their units, and its series."""
    row: dict[str, typing.Any] = {name: group.attrs[name] for name in TEXTS}
    units: dict[str, str] = {}

    def visit(path: str, item: typing.Any) -> None:
        if isinstance(item, h5py.Dataset) and item.shape == ():
            row[path], units[path] = item[()], item.attrs.get("unit", "")

    group.visititems(visit)
    times = group["times_ms"][()]
    row["time_ms"], units["time_ms"] = (float(np.median(times)) if len(times) else np.nan), "ms"
    series = {}
    for name in ("steps", "scene_keys"):
        if name in group:
            series[name] = _frame({key: _column(item) for key, item in group[name].items()},
                                  {key: item.attrs.get("unit", "") for key, item in group[name].items()})
    return row, units, series


def read(file: str | os.PathLike[str]) -> dict[str, pd.DataFrame]:
    """What is in a results file (HDF5), as tables.

    Tables of studies have their names. Runs are the rows of "runs": texts, and numbers by their paths as results/README.md lists
    them, "error/rms" or "work/forces", with the median time "time_ms"; "steps" and "scene_keys" have what is listed there with a
    column "run". `frame.attrs["units"]` has the unit of each column, `frame.attrs["provenance"]` where it comes from.
    """
    path = os.fspath(file)
    if not os.path.isfile(path):
        raise ValueError(f"{path}: expected a results file (HDF5), there is none")
    try:
        with h5py.File(path) as opened:
            return _read(path, opened)
    except OSError as error:
        raise ValueError(f"{path}: cannot be read as HDF5: {str(error).splitlines()[0]}") from None


def _read(path: str, opened: h5py.File) -> dict[str, pd.DataFrame]:
    if "schema_version" not in opened.attrs:
        raise ValueError(f"{path}: expected a results file of drape, it has no schema_version")
    if (version := int(opened.attrs["schema_version"])) < 6:
        raise ValueError(f"{path}: expected schema version 6, not {version}: record it again")
    provenance = {name: _text(value) for name, value in opened.attrs.items() if not name.endswith(".description")}
    tables = {name: _table(group) for name, group in opened.get("tables", {}).items()}
    rows, units = [], {}
    series: dict[str, list[pd.DataFrame]] = {}
    for number, group in enumerate(opened.get("runs", {}).values()):
        row, its_units, its_series = _run(group)
        rows.append(row)
        units.update(its_units)
        for name, frame in its_series.items():
            frame.insert(0, "run", number)
            series.setdefault(name, []).append(frame)
    if rows:
        tables["runs"] = _frame(rows, units)  # type: ignore[arg-type]
    for name, frames in series.items():
        its_units = frames[0].attrs["units"]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)
            tables[name] = pd.concat(frames, ignore_index=True)
        tables[name].attrs["units"] = its_units
    for frame in tables.values():
        frame.attrs["provenance"] = provenance
    return tables
