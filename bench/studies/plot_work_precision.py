#!/usr/bin/python3
"""Time against error from the study `work-precision`: plot_work_precision.py FILE.h5 writes FILE-<scene>.png and .svg beside it.

Small dots are all runs of ours, small crosses all of SUNDIALS; lines join what nobody of the same kind beats in both time and
error. In the grey band errors are beyond what the reference can tell. The title says how SUNDIALS was built.
"""
import pathlib
import re
import sys

import h5py
import matplotlib
import matplotlib.pyplot as plt
import numpy as np

import plot_files

matplotlib.rcParams["font.size"] = 8

OURS = ("drape", "explicit", "thesis")
# Okabe and Ito's colours, which the colour-blind tell apart; the marks tell them apart in black and white.
STYLES = {
    "our best": ("#000000", "o"),
    "automatic": ("#0072B2", "s"),
    "explicit": ("#009E73", "^"),
    "thesis": ("#D55E00", "v"),
    "SUNDIALS, tuned": ("#CC79A7", "D"),
}


def read_trials(path, name):
    trials = plot_files.read_table(path, name)
    measured = trials["error"] > 0
    return {key: column[measured] for key, column in trials.items()}


def front(error, time):
    """Indices of what is beaten in neither, from the smallest time on."""
    order = np.lexsort((error, time))
    best = np.minimum.accumulate(error[order])
    return order[np.r_[True, best[1:] < best[:-1]]] if len(order) else order


def draw(path, scene, trials):
    error, time, code = trials["error"], trials["time"], trials["code"]
    ours = np.isin(code, OURS)
    kinds = {"our best": ours, "automatic": trials["method"] != ""}
    kinds |= {name: code == name for name in STYLES if name in code}
    kinds |= {"SUNDIALS, tuned": ~ours}
    figure, axes = plt.subplots(figsize=(7.5, 4.8), layout="constrained")
    axes.loglog(error[ours], time[ours], ".", color="0.7", markersize=3, label="all of ours")
    axes.loglog(error[~ours], time[~ours], "x", color="0.7", markersize=2, label="all of SUNDIALS")
    for name, belongs in kinds.items():
        chosen = np.flatnonzero(belongs)
        chosen = chosen[front(error[chosen], time[chosen])]
        colour, mark = STYLES[name]
        axes.loglog(error[chosen], time[chosen], color=colour, marker=mark, markersize=5, label=name)
    uncertainty = trials["uncertainty"].max()
    low, high = error.min() / 2, error.max() * 2
    axes.axvspan(low, max(low, 10 * uncertainty), color="0.9")
    axes.set_xlim(high, low)  # better is to the right
    axes.grid(alpha=0.3, which="both")
    axes.set_title(f"{scene}\n{trials['build'][0]}", fontsize=7)
    axes.set_xlabel(f"error: largest RMS distance at all tenths of the end, over the scene's size (uncertain by {uncertainty:.0e})")
    axes.set_ylabel("CPU time of the solver [ms]")
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
    plot_files.save(figure, path, re.sub("[ =]", "-", scene))


def main():
    path = pathlib.Path(sys.argv[1])
    prefix = "trials: "
    with h5py.File(path) as file:
        scenes = [name.removeprefix(prefix) for name in file["tables"] if name.startswith(prefix)]
    for scene in scenes:
        draw(path, scene, read_trials(path, prefix + scene))


if __name__ == "__main__":
    main()
