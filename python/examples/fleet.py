"""Closes many records, each by itself, on worker processes of Dask: one row a record.

    python fleet.py 'runs/*.parquet' --out rows.parquet --workers 2

Dask rather than Ray: it is plain Python, starts worker processes under a nanny that replaces
one that dies, and the same client drives one machine or many. Each record is one task. Its row
is kept in ``rows.parquet.part/`` under a name made of the hash of the record's name, its bytes
and the version of bowden, written to a neighbour first and renamed: whatever is killed, a row
is there whole or not at all, and a second run computes what is missing only.
A record that cannot be closed becomes a row with its error. Exit status: 0 with all rows
written, errors among them or not; 2 for bad use.
"""

import argparse
import glob
import hashlib
import json
import os
import resource
import sys
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

NUMBERS = ("declared_held_out", "final_held_out", "floor")
COUNTS = ("evaluations", "jacobians", "columns_filtered", "searches")
SCHEMA = pa.schema(
    [("file", pa.string()), ("status", pa.string()), ("error", pa.string())]
    + [("line", pa.int64()), ("column", pa.string()), ("verdict", pa.string())]
    + [(name, pa.list_(pa.string())) for name in ("names", "grades")]
    + [(name, pa.float64()) for name in NUMBERS]
    + [("parameters", pa.list_(pa.string())), ("values", pa.list_(pa.float64()))]
    + [("units", pa.list_(pa.string()))]
    + [(name, pa.int64()) for name in COUNTS]
)
"""No times: the same records give the same bytes."""


def failed(file, error):
    """The row of a record that could not be closed."""
    line, column = getattr(error, "line", None), getattr(error, "column", None)
    row = dict.fromkeys(SCHEMA.names)
    row.update(file=file, status="error", error=str(error) or type(error).__name__)
    row.update(line=line, column=None if column is None else str(column))
    return row


def closed(file):
    """The row of a record."""
    import bowden

    try:
        report = bowden.close(file, figures=False, threads=1)
        report = json.loads(report.json)
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # a panic of a reader is no Exception
        return failed(file, error)
    floor, parameters = report["noise_floor"], report["final"]["parameters"]
    floor = floor.get("held_out") if isinstance(floor, dict) else floor
    row = dict.fromkeys(SCHEMA.names)
    row.update(file=file, status="ok", verdict=report["verdict"], floor=floor)
    row["names"] = [found["effect"] for found in report["rounds"]]
    row["grades"] = [found["grade"] for found in report["rounds"]]
    row["declared_held_out"] = report["declared"]["rmse"]["held_out"]
    row["final_held_out"] = report["final"]["rmse"]["held_out"]
    row["parameters"] = [parameter["name"] for parameter in parameters]
    row["values"] = [parameter["value"] for parameter in parameters]
    row["units"] = [parameter["unit"] for parameter in parameters]
    row.update({name: report["cost"][name] for name in COUNTS})
    return row


def keep(row, part):
    """Writes the part of a row, whole or not at all."""
    beside = f"{part}.{os.getpid()}.tmp"
    pq.write_table(pa.Table.from_pylist([row], schema=SCHEMA), beside)
    os.replace(beside, part)


def work(file, part):
    """What a worker does."""
    if not os.path.exists(part):
        keep(closed(file), part)


def part_of(folder, file, version):
    """Where the row of a record as it now is belongs."""
    digest = hashlib.sha256(f"{version}\0{file}\0".encode())
    digest.update(Path(file).read_bytes())
    return str(folder / f"{digest.hexdigest()}.parquet")


def join(parts, out):
    """All rows in the order of the files, a few at a time."""
    beside = f"{out}.{os.getpid()}.tmp"
    with pq.ParquetWriter(beside, SCHEMA) as writer:
        for at in range(0, len(parts), 256):
            rows = [pq.read_table(part) for part in parts[at : at + 256]]
            writer.write_table(pa.concat_tables(rows).combine_chunks())
    os.replace(beside, out)


def fleet(pattern, out, workers):
    """Closes all files of a pattern; the number of those that were computed now."""
    import bowden
    from dask.distributed import Client, LocalCluster, as_completed

    files = sorted(file for file in glob.glob(pattern) if os.path.isfile(file))
    if not files:
        raise SystemExit(f"fleet.py: {pattern}: no file has such a name")
    folder = Path(f"{out}.part")
    folder.mkdir(parents=True, exist_ok=True)
    version = getattr(bowden, "__version__", "")
    parts = [part_of(folder, file, version) for file in files]
    todo = iter([(f, p) for f, p in zip(files, parts) if not os.path.exists(p)])
    done = 0
    with LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, Client(cluster) as client:
        of = {}

        def submit():
            for file, part in todo:
                future = client.submit(work, file, part, pure=False)
                of[future.key] = (file, part)
                return future

        # A few tasks a worker at any time: the scheduler's memory does not grow.
        first = [future for _ in range(4 * workers) if (future := submit())]
        running = as_completed(first)
        first.clear()
        for future in running:
            file, part = of.pop(future.key)
            # A record that ends several workers in turn is given up by Dask.
            if future.status == "error" and not os.path.exists(part):
                keep(failed(file, future.exception()), part)
            done += 1
            if following := submit():
                running.add(following)
    join(parts, out)
    return done


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pattern")
    parser.add_argument("--out", required=True)
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    start = time.monotonic()
    done = fleet(asked.pattern, asked.out, asked.workers)
    took = time.monotonic() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{done} records in {took:.2f} s, peak of this process {peak:.0f} MiB", file=sys.stderr)


if __name__ == "__main__":
    main()
