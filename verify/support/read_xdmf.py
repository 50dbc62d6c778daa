"""Reads XDMF as its specification says, numbers through h5py, and prints what a viewer would get: a line for each run, and one for
each of its frames with its time, the grid's shape, names of fields and, as sums over the particles, all they contain.

usage: read_xdmf.py FILE.xdmf
"""

import os
import sys
import xml.etree.ElementTree

import h5py
import numpy


def numbers(item, folder):
    """The array of a DataItem `file:path|start:stride:count:shape`."""
    place, selection = item.text.split("|")
    file, path = place.split(":")
    start, stride, count, shape = ([int(n) for n in part.split()] for part in selection.split(":"))
    with h5py.File(os.path.join(folder, file)) as opened:
        dataset = opened[path]
        kind = {"Float": "f", "Int": "i"}[item.get("NumberType")] + item.get("Precision")
        assert list(dataset.shape) == shape and dataset.dtype == numpy.dtype(kind)
        chosen = dataset[tuple(slice(a, a + n * s, s) for a, s, n in zip(start, stride, count))]
    assert list(chosen.shape) == [int(n) for n in item.get("Dimensions").split()]
    return chosen[0]


def short(number):
    return f"{number:.9g}"


def show_frame(grid, folder):
    topology, geometry = grid.find("Topology"), grid.find("Geometry")
    shape = topology.get("Dimensions").split()
    x = numbers(geometry.find("DataItem"), folder)
    assert topology.get("TopologyType") == "3DSMesh" and geometry.get("GeometryType") == "XYZ"
    assert numpy.prod([int(n) for n in shape]) == len(x)
    print(grid.find("Time").get("Value"), "x".join(shape), *map(short, x.sum(axis=0)))
    for attribute in grid.findall("Attribute"):
        values = numbers(attribute.find("DataItem"), folder)
        assert len(values) == len(x) and values.ndim == {"Vector": 2, "Scalar": 1}[attribute.get("AttributeType")]
        print(" ", attribute.get("Name"), *map(short, numpy.atleast_1d(values.sum(axis=0))))


for series in xml.etree.ElementTree.parse(sys.argv[1]).getroot().find("Domain"):
    assert series.get("CollectionType") == "Temporal"
    print("run", series.get("Name"))
    for grid in series:
        show_frame(grid, os.path.dirname(sys.argv[1]))
