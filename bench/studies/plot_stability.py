#!/usr/bin/python3
"""Heat maps of the study `stability` from its HDF5 file: plot_stability.py FILE.h5 writes FILE-<n>-<h>.png and .svg beside it.

A panel for each method, a cell for each run: colour and symbol are its verdict, a frame goes round what linear theory predicts
to fail.
"""
import pathlib
import sys

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

import plot_files

matplotlib.rcParams["font.size"] = 7

# Okabe and Ito's colours, which the colour-blind tell apart, and symbols for those who print in black and white.
VERDICTS = {
    "accurate": ("#56B4E9", ""),
    "stable but wrong": ("#F0E442", "w"),
    "stable, error unknown": ("#CFE8F7", "?"),
    "unstable": ("#D55E00", "U"),
    "not converged": ("#CC79A7", "x"),
    "not finished": ("#999999", "…"),
}


def power_of_ten(value):
    return f"$10^{{{np.log10(value):.0f}}}$" if np.isfinite(value) else "∞"


def draw_failing(axes, failing):
    """Lines between cells of which one is predicted to fail and the other is not."""
    rows, columns = failing.shape
    for i in range(rows):
        for j in range(columns):
            if i + 1 < rows and failing[i, j] != failing[i + 1, j]:
                axes.plot([j - 0.5, j + 0.5], [i + 0.5, i + 0.5], "k", linewidth=1.8)
            if j + 1 < columns and failing[i, j] != failing[i, j + 1]:
                axes.plot([j + 0.5, j + 0.5], [i - 0.5, i + 0.5], "k", linewidth=1.8)


def draw_method(axes, atlas, chosen, method):
    chosen = chosen & (atlas["method"] == method)
    nus, ratios = np.unique(atlas["nu"][chosen]), np.unique(atlas["to_damping"][chosen])
    names = list(VERDICTS)
    verdicts = np.zeros((len(nus), len(ratios)), int)
    failing = np.zeros(verdicts.shape, bool)
    for k in np.flatnonzero(chosen):
        at = np.searchsorted(nus, atlas["nu"][k]), np.searchsorted(ratios, atlas["to_damping"][k])
        verdicts[at] = names.index(atlas["verdict"][k])
        failing[at] = atlas["predicted"][k] != "stable"
    colours = matplotlib.colors.ListedColormap([colour for colour, _ in VERDICTS.values()])
    axes.imshow(verdicts, cmap=colours, vmin=-0.5, vmax=len(names) - 0.5, origin="lower", aspect="auto")
    for (i, j), verdict in np.ndenumerate(verdicts):
        axes.text(j, i, VERDICTS[names[verdict]][1], ha="center", va="center")
    draw_failing(axes, failing)
    everything = ": predicted to fail everywhere" if failing.all() else ""
    axes.set_title(method + everything, fontsize=8)
    axes.set_xticks(range(len(ratios)), map(power_of_ten, ratios))
    axes.set_yticks(range(len(nus)), map(power_of_ten, nus))
    axes.set_xlabel("h k/d (∞: undamped)")
    axes.set_ylabel("ν_h = h² k/(ρ l²)")


def draw_sheet(path, atlas, n, step):
    chosen = (atlas["n"] == n) & (atlas["step"] == step)
    methods = list(dict.fromkeys(atlas["method"][chosen]))
    figure, grid = plt.subplots(-(-len(methods) // 4), 4, figsize=(11, 9), squeeze=False, layout="constrained")
    for axes in grid.flat[len(methods):]:
        axes.set_visible(False)
    for axes, method in zip(grid.flat, methods):
        draw_method(axes, atlas, chosen, method)
    figure.suptitle(f"{n} × {n} particles, h = {step:g} s; thick lines: where linear theory predicts failure")
    handles = [
        matplotlib.patches.Patch(facecolor=colour, edgecolor="k", label=f"{symbol}  {name}" if symbol else name)
        for name, (colour, symbol) in VERDICTS.items()
    ]
    figure.get_layout_engine().set(rect=(0, 0.04, 1, 0.96))  # below is the legend
    figure.legend(handles=handles, loc="lower center", ncols=len(handles))
    plot_files.save(figure, path, f"{n}-{step:g}")


def main():
    path = pathlib.Path(sys.argv[1])
    atlas = plot_files.read_table(path, "stability-atlas")
    for n, step in sorted(set(zip(atlas["n"], atlas["step"]))):
        draw_sheet(path, atlas, n, step)


if __name__ == "__main__":
    main()
