#!/usr/bin/python3
"""What a force costs from Python above one within C++: interleaved, medians over rounds with quartiles. Exits with 1 above 2 µs.

    eval "$(bench/run --python)" && /usr/bin/python3 bench/python/overhead.py
"""
import sys
import time

import numpy as np

import drape

ROUNDS, MOST_US = 41, 2.0


def from_python(ode, count, x, v, out):
    force = ode.force
    begin = time.perf_counter()
    for _ in range(count):
        force(0.0, x, v, out)
    return 1e9 * (time.perf_counter() - begin) / count


def quartiles(values):
    return "{1:.2f} ({0:.2f} to {2:.2f})".format(*np.quantile(values, [0.25, 0.5, 0.75]))


worst = 0.0
print("n x n       C++ [µs]               Python [µs]            above [µs]")
for n, count in ((10, 2000), (20, 1000), (100, 40)):
    ode = drape.scene("hung-corners", n=n, damping=5).ode()
    x, v = ode.start
    out = np.empty_like(x)
    ode.time_force(count, 0.0, x, v), from_python(ode, count, x, v, out)
    pairs = [(ode.time_force(count, 0.0, x, v) / 1e3, from_python(ode, count, x, v, out) / 1e3) for _ in range(ROUNDS)]
    inside, outside = np.array(pairs).T
    above = outside - inside
    worst = max(worst, float(np.median(above)))
    print(f"{n:3} x {n:<3} {quartiles(inside):>22} {quartiles(outside):>22} {quartiles(above):>22}")
    if ode.copies:
        sys.exit(f"{ode.copies} arrays were copied: expected none")
sys.exit(worst > MOST_US)
