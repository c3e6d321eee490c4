#!/usr/bin/env python3
"""Writes the records of this folder by SciPy and PyArrow: writers that are not ours.

    pip install numpy scipy pyarrow && python3 make.py

The record is that of `../record.rs`, made of sums, products and rounding alone, so that it is
the same to the bit wherever it is computed.
"""

import math
import pathlib

import numpy as np
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
