#!/usr/bin/env python3
"""Writes the records of this folder by SciPy, PyArrow, h5py, hdf5storage and openpyxl: not our writers.

    pip install numpy scipy pyarrow h5py hdf5storage openpyxl && python3 make.py

The record is that of `../record.rs`, made of sums, products and rounding alone, so that it is
the same to the bit wherever it is computed.
"""

import math
import pathlib

import h5py
import hdf5storage
import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.io import savemat

FOLDER = pathlib.Path(__file__).parent


def rounded(value):
    return math.floor(value * 1024 + 0.5) / 1024


def triangle(i, period):
    return 4 * abs((i % period) / period - 0.5) - 1


def record():
    seed, play, rows = 1, 0.0, []
    for i in range(2560):
        x = rounded(6 * triangle(i, 640) + 3 * triangle(i + 40, 275))
        play = min(max(play, x - 1.5), x + 1.5)
        load = rounded(5 * triangle(i, 900))
        seed = (seed * 1103515245 + 12345) % 2**31
        noise = 0.1 * (seed / 2**31 - 0.5)
        f = rounded(2 * x + 3 * (x - play) + 0.25 * load + noise)
        rows.append((i / 256, x, f, load))
    return np.array(rows).T


def workbook(name, rows):
    """A workbook whose first sheet has words alone."""
    book = openpyxl.Workbook()
    cover, sheet = book.active, book.create_sheet("Run")
    cover.title = "Rig"
    cover["A1"], cover["B1"] = "Operator", "Ann"
    for row in rows:
        sheet.append(row)
    book.save(FOLDER / name)


def class_of(data, name, **others):
    data.attrs["MATLAB_class"] = np.bytes_(name)
    for attribute, value in others.items():
        data.attrs[attribute] = value


class Hdf5:
    """A file of version 7.3 by h5py, laid out as MATLAB does: a header of 512 bytes before it."""

    def __init__(self, name):
        self.path = FOLDER / name
        self.file = h5py.File(self.path, "w", userblock_size=512, libver="earliest")

    def numbers(self, where, values, name="double", **options):
        """An array, its dimensions in reverse order."""
        values = np.atleast_2d(values)
        values = values.T if values.shape[0] == 1 else values
        data = self.file.create_dataset(where, data=np.ascontiguousarray(values.T), **options)
        class_of(data, name)
        return data

    def text(self, where, text):
        data = self.file.create_dataset(where, data=np.array([[ord(c)] for c in text], np.uint16))
        class_of(data, "char", MATLAB_int_decode=np.int32(2))
        return data

    def done(self):
        self.file.close()
        text = "MATLAB 7.3 MAT-file, Platform: h5py, HDF5 schema 1.00 ."
        header = text.ljust(116).encode() + bytes(8) + b"\x00\x02IM"
        with self.path.open("r+b") as file:
            file.write(header.ljust(512, b"\0"))


t, x, f, load = record()
names = ["t", "x_mm", "f_N", "load_N"]

# The whole record: compressed vectors, with a scalar and a text beside them; Parquet.
savemat(
    FOLDER / "vectors.mat",
    {"t": t, "x_mm": x.reshape(-1, 1), "f_N": f, "load_N": load, "rate": 256.0, "who": "rig 3"},
    do_compression=True,
    oned_as="row",
)
pq.write_table(pa.table([t, x, f, load], names), FOLDER / "snappy.parquet", row_group_size=2000)
np.savez_compressed(
    FOLDER / "vectors.npz", t=t, x_mm=x, f_N=f, load_N=load, rate=256.0, who="rig 3"
)
workbook("vectors.xlsx", [names, *zip(t.tolist(), x.tolist(), f.tolist(), load.tolist())])
# The same in version 7.3: chunks, shuffled and compressed, as MATLAB writes long vectors.
file = Hdf5("vectors_7_3.mat")
for name, values in zip(names, [t, x, f, load]):
    file.numbers(name, values, chunks=(1, 1000), compression=3, shuffle=True)
file.numbers("rate", 256.0)
file.text("who", "rig 3")
file.done()

# Its beginning in other shapes.
t, x, f, load = t[:240], x[:240], f[:240], load[:240]
# A structure, not compressed; a column of small integers beside it.
run = {"t": t, "x_mm": x, "f_N": f, "load_N": load, "count": np.arange(240, dtype=np.int16)}
savemat(FOLDER / "structure.mat", {"run": run})
# A matrix whose columns are named elsewhere, by cells and by rows of letters.
matrix = np.array([t, x, f, load])
cells = np.array(names, dtype=object)
savemat(FOLDER / "cells.mat", {"data": matrix.T, "names": cells}, do_compression=True)
savemat(FOLDER / "letters.mat", {"data": matrix, "names": np.array(names)}, do_compression=True)
savemat(FOLDER / "nameless.mat", {"data": matrix.T}, do_compression=True)
np.savez(FOLDER / "matrix.npz", data=matrix.T, names=np.array(names))
log = np.rec.fromarrays([t, x, f, load], dtype=[(name, "<f8") for name in names])
np.savez_compressed(FOLDER / "structured.npz", log=log)
np.save(FOLDER / "structured.npy", log)
np.save(FOLDER / "matrix.npy", matrix)
# A seed of the fuzz target.
workbook("tiny.xlsx", [names[:3], *zip(t[:9].tolist(), x[95:104].tolist(), f[:9].tolist())])
np.save(FOLDER / "tiny.npy", np.array([t[:9], x[95:104], f[:9]]).T)
# As trace exports write it: an axis and signals with names, units and data.
signals = np.zeros(3, dtype=[("Name", object), ("Unit", object), ("Data", object)])
for own, signal in zip(signals, [("x", "mm", x), ("f", "N", f), ("load", "N", load)]):
    own["Name"], own["Unit"], own["Data"] = signal
axis = {"Name": "t", "Unit": "s", "Data": t}
savemat(FOLDER / "trace.mat", {"trace": {"X": axis, "Y": signals}}, do_compression=True)
savemat(FOLDER / "lengths.mat", {"t": t, "x": x, "f": f[:-1]}, do_compression=True)
savemat(FOLDER / "complex.mat", {"t": t, "x": x * 1j, "f": f}, do_compression=True)
savemat(FOLDER / "words.mat", {"who": "rig 3", "rate": 256.0})
savemat(FOLDER / "version_4.mat", {"t": t[:9]}, format="4")

# Version 7.3. A structure; beside it small integers, single precision, a truth, an empty array.
file = Hdf5("structure_7_3.mat")
run = file.file.create_group("run")
class_of(run, "struct")
for name, values in zip(names, [t, x, f, load]):
    file.numbers(f"run/{name}", values)
file.numbers("run/count", np.arange(240, dtype=np.int16), "int16")
file.numbers("run/single", x.astype(np.float32), "single", fletcher32=True, chunks=(1, 100))
file.numbers("run/moves", (f > 0).astype(np.uint8), "logical")
empty = file.file.create_dataset("run/empty", data=np.zeros(2, np.uint64))
class_of(empty, "double", MATLAB_empty=np.uint8(1))
file.done()
# A matrix whose columns are named by cells, and signals of a trace, by another writer.
modern = {"format": "7.3", "store_python_metadata": False, "matlab_compatible": True}
hdf5storage.savemat(FOLDER / "cells_7_3.mat", {"data": matrix.T, "names": cells}, **modern)
hdf5storage.savemat(FOLDER / "trace_7_3.mat", {"trace": {"X": axis, "Y": signals}}, **modern)
pairs = np.zeros((1, 240), dtype=[("real", float), ("imag", float)])
file = Hdf5("complex_7_3.mat")
file.numbers("t", t)
class_of(file.file.create_dataset("x", data=pairs), "double")
file.numbers("f", f)
file.done()
# A seed of the fuzz target.
file = Hdf5("tiny_7_3.mat")
for name, values in zip(["t", "x", "f"], [t[:9], x[95:104], f[:9]]):
    file.numbers(name, values, chunks=(1, 9), compression=3)
file.done()

for codec in ["none", "gzip", "lz4", "zstd", "brotli"]:
    table = pa.table([t, x, f, load, ["rig"] * 240], names + ["who"])
    pq.write_table(table, FOLDER / f"{codec}.parquet", compression=codec)
nulls = pa.array([None if i == 99 else v for i, v in enumerate(x)])
pq.write_table(pa.table([t, nulls, f], ["t", "x", "f"]), FOLDER / "null.parquet")
# Points in time, single precision, unsigned integers.
stamps = pa.array((1_770_000_000_000_000 + t * 1e6).astype(np.int64), pa.timestamp("us"))
single = pa.array(x.astype(np.float32))
table = pa.table([stamps, single, f, np.arange(240, dtype=np.uint32)], ["t", "x", "f", "load"])
pq.write_table(table, FOLDER / "stamps.parquet", compression="gzip")
# A seed of the fuzz target.
few = pa.table([t[:9], nulls[95:104], f[:9].astype(np.float32)], ["t", "x", "f"])
pq.write_table(few, FOLDER / "tiny.parquet", write_statistics=False, store_schema=False)
pq.write_table(pa.table([["a", "b"]], ["who"]), FOLDER / "words.parquet")
