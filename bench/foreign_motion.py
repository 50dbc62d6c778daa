#!/usr/bin/python3
"""foreign_motion.py OUT.h5 FRAME_TIME FILE...: brings the motion of another simulator into one plain HDF5 file.

FILE is one HDF5 file with /time, /positions and maybe /velocities (FRAME_TIME is then "none"), or meshes that meshio
reads, one a frame, in the natural order of their names: sheet-9.obj comes before sheet-10.obj. Should a damaged file
crash a library, then only this process ends. What is wrong with a file is said in the last line, by exit code 1.
"""
import re
import resource
import sys

import h5py
import numpy as np


MOST_BYTES = 1 << 30  # of a dataset, as bench_integrators allows for files


def natural(name):
    return [int(part) if k % 2 else part for k, part in enumerate(re.split(r"(\d+)", name))]


def dataset(path, file, name, rank):
    item = file.get(name) if isinstance(file.get(name, getlink=True), h5py.HardLink) else None
    if not isinstance(item, h5py.Dataset):
        sys.exit(f"{path}: expected a dataset /{name}")
    if item.external or item.is_virtual:
        sys.exit(f"{path}: /{name}: expected numbers in the file itself, not in another one")
    if item.dtype.kind not in "iuf":
        sys.exit(f"{path}: /{name}: expected numbers")
    if item.ndim != rank or (rank == 3 and item.shape[2] != 3):
        sys.exit(f"{path}: /{name}: expected the shape {'F x N x 3' if rank == 3 else 'F'}, not {' x '.join(map(str, item.shape))}")
    if item.size * 8 > MOST_BYTES:
        sys.exit(f"{path}: /{name}: expected at most {MOST_BYTES >> 20} MB of numbers, not {item.size * 8 >> 20} MB")
    return item[()].astype("f8")


def read_hdf5(path):
    try:
        with h5py.File(path, "r") as file:
            motion = {"time": dataset(path, file, "time", 1), "positions": dataset(path, file, "positions", 3)}
            if "velocities" in file:
                motion["velocities"] = dataset(path, file, "velocities", 3)
    except OSError as error:
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
    motion = read_hdf5(paths[0]) if frame_time == "none" else read_meshes(sorted(paths, key=natural), float(frame_time))
    with h5py.File(out, "w") as file:
        for name, values in motion.items():
            file[name] = values


if resource.getrlimit(resource.RLIMIT_DATA)[0] == resource.RLIM_INFINITY:
    resource.setrlimit(resource.RLIMIT_DATA, (8 * MOST_BYTES, resource.RLIM_INFINITY))
try:
    main(*sys.argv[1:])
except MemoryError:
    sys.exit(f"{sys.argv[3]}: expected a motion of at most {MOST_BYTES >> 20} MB")
except RecursionError:
    sys.exit(f"{sys.argv[3]}: cannot be read: it is nested too deeply")
