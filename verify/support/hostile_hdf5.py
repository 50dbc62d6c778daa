"""Changes an HDF5 file as other programs, or an attacker, might.

usage: hostile_hdf5.py KIND FILE.h5
"""

import os
import sys

import h5py
import numpy


def fresh(group, name):
    if name in group:
        del group[name]


def rewritten(group, name, **how):
    """A dataset that is declared with the texts of another, but stored in another way."""
    texts = {key: group[name].attrs[key] for key in ("unit", "description") if key in group[name].attrs}
    fresh(group, name)
    made = group.create_dataset(name, **how)
    made.attrs.update(texts)


def first_table(file):
    return next(iter(file["tables"].values()))


def number_column(table):
    return next(name for name, column in table.items() if column.dtype.kind == "f")


def text_column(table):
    return next(name for name, column in table.items() if column.dtype.kind == "O")


def pipe(path):
    name = path + ".raw"
    os.mkfifo(name)
    return name


def nested(file):
    group = file
    for _ in range(100):
        group = group.create_group("g")


def many_references(file):
    """A text of 50 KB in each of 100 000 rows, stored once."""
    table = first_table(file)
    name = text_column(table)
    fresh(table, name)
    made = table.create_dataset(name, (1,), h5py.string_dtype())
    made[0] = "x" * 50000
    made.attrs["unit"], made.attrs["description"] = "", ""
    address = made.id.get_offset()
    file.flush()
    with open(file.filename, "rb") as raw:
        raw.seek(address)
        reference = raw.read(16)
    fresh(table, name)
    made = table.create_dataset(name, (100000,), h5py.string_dtype())
    made[:] = ""
    made.attrs["unit"], made.attrs["description"] = "", ""
    made.id.flush()
    address, path = made.id.get_offset(), file.filename
    file.close()
    with open(path, "r+b") as raw:
        raw.seek(address)
        raw.write(reference * 100000)


def links(file, count):
    for k in range(count):
        file["tables"][f"link {k}"] = file["runs" if "000" in file["runs"] else "tables"]


def cycle(file):
    file["tables/again"] = file["/"]
    file["runs/001"] = file["runs"]


def virtual(group, name, path):
    layout = h5py.VirtualLayout(shape=(4,), dtype="f8")
    layout[:] = h5py.VirtualSource(path, "/tables", shape=(4,))
    fresh(group, name)
    group.create_virtual_dataset(name, layout)


def linked(group, name, link):
    fresh(group, name)
    group[name] = link


huge = dict(shape=(1 << 33,), dtype="f8")
KINDS = {
    "opened": lambda f: None,
    "annotated": lambda f: annotate(f),
    "altered": lambda f: f["runs/000/steps/t"].write_direct(numpy.full(f["runs/000/steps/t"].shape, 7.0)),
    "altered-text": lambda f: f["runs/000"].attrs.modify("method", "another"),
    "removed": lambda f: fresh(f["runs"], "000"),
    "renamed": lambda f: f["runs"].move("000", "001"),
    "cycle": cycle,
    "links": lambda f: links(f, 10000),
    "nested": nested,
    "huge-table": lambda f: rewritten(first_table(f), number_column(first_table(f)), **huge),
    "huge-chunked": lambda f: rewritten(first_table(f), number_column(first_table(f)), chunks=(1 << 20,), **huge),
    "huge-chunk": lambda f: rewritten(first_table(f), number_column(first_table(f)), shape=(4,), maxshape=(None,), chunks=((1 << 28),), dtype="f8"),
    "huge-texts": lambda f: rewritten(first_table(f), text_column(first_table(f)), shape=(1 << 33,), dtype=h5py.string_dtype()),
    "many-references": many_references,
    "bomb": lambda f: rewritten(first_table(f), number_column(first_table(f)), data=numpy.zeros(1 << 26), chunks=(1 << 20,), compression=9),
    "external": lambda f: rewritten(first_table(f), number_column(first_table(f)), shape=(4,), dtype="f8", external=[(pipe(f.filename), 0, 32)]),
    "virtual": lambda f: virtual(first_table(f), number_column(first_table(f)), pipe(f.filename)),
    "external-link": lambda f: linked(first_table(f), number_column(first_table(f)), h5py.ExternalLink(pipe(f.filename), "/")),
    "soft-link": lambda f: linked(first_table(f), number_column(first_table(f)), h5py.SoftLink("/tables")),
    "short-column": lambda f: rewritten(first_table(f), number_column(first_table(f)), data=numpy.zeros(1)),
    "motion-huge": lambda f: rewritten(f, "positions", shape=(1 << 24, 12, 3), dtype="f8"),
    "motion-chunked": lambda f: rewritten(f, "positions", shape=(1 << 24, 12, 3), dtype="f8", chunks=(1, 12, 3)),
    "motion-bomb": lambda f: rewritten(f, "positions", data=numpy.zeros((1 << 21, 12, 3)), chunks=(1 << 15, 12, 3), compression=9),
    "motion-external": lambda f: rewritten(f, "positions", shape=(2, 12, 3), dtype="f8", external=[(pipe(f.filename), 0, 576)]),
    "motion-virtual": lambda f: virtual(f, "positions", pipe(f.filename)),
    "motion-external-link": lambda f: linked(f, "positions", h5py.ExternalLink(pipe(f.filename), "/")),
}


def annotate(file):
    file.attrs["note"] = "checked by me"
    file["runs/000"].attrs["rating"] = 5
    file["runs/000/steps/t"].attrs["colour"] = "red"
    file["mine/deep/numbers"] = numpy.arange(5)
    file["runs/000/curve"] = numpy.arange(3.0)
    file["runs/000/steps"]["same"] = file["runs/000/steps/t"]


def main(kind, path):
    with h5py.File(path, "r+") as file:
        KINDS[kind](file)


main(*sys.argv[1:])
