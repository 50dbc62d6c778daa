#!/usr/bin/python3
"""external_motion.py OUT.h5 FRAME_TIME FILE...: brings the motion of another simulator into one plain HDF5 file.

FILE is one HDF5 file with /time, /positions and maybe /velocities (FRAME_TIME is then "none"), or meshes that meshio
reads, one a frame, in the natural order of their names: sheet-9.obj comes before sheet-10.obj. Should a damaged file
crash a library, or let it take all memory, then only this process ends. What is wrong with a file is said in the last
line, by exit code 1.
"""
import math
import os
import re
import resource
import sys

import h5py
import numpy as np


DENSEST = 1032  # what deflate can do


def limit(sizes):
    """Memory beyond that of now, and processor time, by the bytes of the files. The largest motion has some copies for a while."""
    with open("/proc/self/statm") as statm:
        now = int(statm.read().split()[5]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_DATA, (now + (128 << 20) + 512 * sizes,) * 2)
    resource.setrlimit(resource.RLIMIT_CPU, (20 + sizes // (1 << 20),) * 2)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def natural(name):
    return [int(part) if k % 2 else part for k, part in enumerate(re.split(r"(\d+)", name))]


def dataset(path, file, name, rank):
    if not isinstance(file.get(name, getlink=True), h5py.HardLink) or not isinstance(file[name], h5py.Dataset):
        sys.exit(f"{path}: expected a dataset /{name}")
    item = file[name]
    if item.is_virtual or item.external:
        sys.exit(f"{path}: /{name}: is stored in other files")
    if item.dtype.kind not in "iuf":
        sys.exit(f"{path}: /{name}: expected numbers")
    if item.ndim != rank or (rank == 3 and item.shape[2] != 3):
        sys.exit(f"{path}: /{name}: expected the shape {'F x N x 3' if rank == 3 else 'F'}, not {' x '.join(map(str, item.shape))}")
    declared, stored = math.prod(item.shape) * item.dtype.itemsize, item.id.get_storage_size()
    if declared > stored * (DENSEST if item.chunks else 1):
        sys.exit(f"{path}: /{name}: declares {declared} bytes, but stores only {stored}")
    return item[()].astype("f8")


def read_hdf5(path):
    try:
        with h5py.File(path, "r") as file:
            motion = {"time": dataset(path, file, "time", 1), "positions": dataset(path, file, "positions", 3)}
            if "velocities" in file:
                motion["velocities"] = dataset(path, file, "velocities", 3)
    except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
        sys.exit(f"{path}: cannot be read: {str(error).splitlines()[0]}")
    for name in motion:
        if len(motion[name]) != len(motion["time"]):
            sys.exit(f"{path}: /{name}: expected {len(motion['time'])} frames as in /time, not {len(motion[name])}")
    if "velocities" in motion and motion["velocities"].shape != motion["positions"].shape:
        sys.exit(f"{path}: /velocities: expected the shape of /positions")
    return motion


def read_points(path):
    try:
        import meshio
    except ImportError:
        sys.exit("meshes are read by meshio: install the Debian package python3-meshio")
    try:
        points = np.asarray(meshio.read(path).points, "f8")
    except (Exception, SystemExit) as error:  # its readers raise whatever they stumble over
        reason = str(error).strip().split("\n")[0]
        sys.exit(f"{path}: cannot be read as a mesh{': ' + reason if reason and reason != '1' else ''}; expected OBJ, PLY, VTK or VTU")
    if points.ndim != 2 or not 2 <= points.shape[1] <= 3 or len(points) == 0:
        sys.exit(f"{path}: expected a mesh with vertices in space")
    return np.pad(points, ((0, 0), (0, 3 - points.shape[1])))


def read_meshes(paths, frame_time):
    frames = [read_points(path) for path in paths]
    for path, frame in zip(paths, frames):
        if len(frame) != len(frames[0]):
            sys.exit(f"{path}: expected {len(frames[0])} vertices as in {paths[0]}, not {len(frame)}")
    return {"time": frame_time * np.arange(len(paths)), "positions": np.stack(frames)}


def main(out, frame_time, *paths):
    limit(sum(os.path.getsize(path) for path in paths))
    motion = read_hdf5(paths[0]) if frame_time == "none" else read_meshes(sorted(paths, key=natural), float(frame_time))
    with h5py.File(out, "w") as file:
        for name, values in motion.items():
            file[name] = values


try:
    main(*sys.argv[1:])
except MemoryError:
    sys.exit(f"{sys.argv[3]}: takes more memory than a motion in a file of its size")
except RecursionError:
    sys.exit(f"{sys.argv[3]}: cannot be read: it is nested too deeply")
