"""Closes many records, each by itself, on worker processes of Dask: one row a record.

    python fleet.py 'runs/*.parquet' --out rows.parquet --workers 2 --baseline bouc-wen

Dask rather than Ray: it is plain Python, starts worker processes under a nanny that replaces
one that dies, and the same client drives one machine or many (``--scheduler tcp://host:8786``
with a folder that all of them reach). Each record is one task. Its row is kept in
``rows.parquet.part/`` under the hash of the record's name and bytes, of the options and of the
version of bowden, written to a neighbour first and renamed: whatever is killed, a row is there
whole or not at all, and a second run computes what is missing only.

A record that cannot be closed becomes a row with its error, as does one that ends several
workers in turn. Exit status: 0 with all rows written, errors among them or not; 2 for bad use.
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

NUMBERS = ("baseline_held_out", "final_held_out", "floor")
COUNTS = ("evaluations", "jacobians", "columns_filtered", "searches")
SCHEMA = pa.schema(
    [("file", pa.string()), ("status", pa.string()), ("error", pa.string())]
    + [("line", pa.int64()), ("column", pa.string()), ("verdict", pa.string())]
    + [(name, pa.list_(pa.string())) for name in ("mechanisms", "names", "confidences")]
    + [(name, pa.float64()) for name in NUMBERS]
    + [("parameters", pa.list_(pa.string())), ("values", pa.list_(pa.float64()))]
    + [("units", pa.list_(pa.string()))]
    + [(name, pa.int64()) for name in COUNTS]
)
"""No times: the same records give the same bytes."""

QUIET = {
    "distributed.admin.log-length": 100,
    "distributed.admin.low-level-log-length": 100,
    "distributed.scheduler.dashboard.tasks.task-stream-length": 100,
    "distributed.comm.timeouts.connect": "60s",
}
"""What the scheduler remembers of tasks that are done, or its memory grows with the records."""


def failed(file, error):
    """The row of a record that could not be closed."""
    line, column = getattr(error, "line", None), getattr(error, "column", None)
    row = dict.fromkeys(SCHEMA.names)
    row.update(file=file, status="error", error=str(error) or type(error).__name__)
    row.update(line=line, column=None if column is None else str(column))
    return row


def closed(file, options):
    """The row of a record."""
    import bowden

    try:
        report = bowden.identify(file, figures=False, threads=1, **options)
        report = json.loads(report.json)
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # a panic of a reader is no Exception
        return failed(file, error)
    floor, parameters = report["noise_floor"], report["final"]["parameters"]
    floor = floor.get("held_out") if isinstance(floor, dict) else floor
    row = dict.fromkeys(SCHEMA.names)
    row.update(file=file, status="ok", verdict=report["verdict"], floor=floor)
    row["mechanisms"] = [f"{lack['mechanism']}@{lack['channel']}" for lack in report["lacks"]]
    row["names"] = [found["effect"] for found in report["terms"]]
    row["confidences"] = [found["confidence"] for found in report["terms"]]
    row["baseline_held_out"] = report["baseline"]["rmse"]["held_out"]
    row["final_held_out"] = report["final"]["rmse"]["held_out"]
    row["parameters"] = [parameter["name"] for parameter in parameters]
    row["values"] = [parameter["value"] for parameter in parameters]
    row["units"] = [parameter["unit"] for parameter in parameters]
    row.update({name: report["cost"][name] for name in COUNTS})
    return row


def key(file, options):
    """The name under which the row of a record as it now is belongs."""
    import bowden

    digest = hashlib.sha256(json.dumps([bowden.__version__, options, file]).encode())
    try:
        with open(file, "rb") as record:
            while block := record.read(1 << 20):
                digest.update(block)
    except OSError as error:  # its row says so; once it can be read, the key is another one
        digest.update(str(error).encode())
    return digest.hexdigest()


def keep(row, part):
    """Writes the part of a row, whole or not at all."""
    beside = f"{part}.{os.getpid()}.tmp"
    pq.write_table(pa.Table.from_pylist([row], schema=SCHEMA), beside)
    os.replace(beside, part)


def work(file, folder, options):
    """What a worker does: the name of the row's part, and whether it was computed now."""
    name = key(file, options)
    part = os.path.join(folder, f"{name}.parquet")
    if os.path.exists(part):
        return name, False
    # Says which process has the record in hand: what stays behind was killed.
    claim = Path(folder, f"{name}.claim")
    claim.write_text(str(os.getpid()))
    keep(closed(file, options), part)
    claim.unlink(missing_ok=True)
    return name, True


def join(folder, names, out):
    """All rows in the order of the files, a few at a time; how many of them are errors."""
    beside, errors = f"{out}.{os.getpid()}.tmp", 0
    with pq.ParquetWriter(beside, SCHEMA) as writer:
        for at in range(0, len(names), 256):
            parts = (folder / f"{name}.parquet" for name in names[at : at + 256])
            rows = [pq.read_table(part) for part in parts]
            rows = pa.concat_tables(rows).combine_chunks()
            errors += rows.column("status").to_pylist().count("error")
            writer.write_table(rows)
    os.replace(beside, out)
    return errors


def tidy(folder, names):
    """Removes what killed processes left of rows that are there: halves and claims."""
    there = set(names)
    for left in [*folder.glob("*.tmp"), *folder.glob("*.claim")]:
        if left.name.partition(".")[0] in there:
            left.unlink(missing_ok=True)


class Drive:
    """Has files closed by the workers of a client."""

    def __init__(self, client, files, folder, options):
        self.client, self.files, self.folder, self.options = client, files, folder, options
        self.names = [None] * len(files)
        """Of their parts."""
        self.computed = 0
        """How many of them now."""

    def run(self, indices, at_once, suspects=None):
        """Has some of the files closed, so many at a time; those that ended their workers go to
        ``suspects``, or become rows."""
        from dask.distributed import as_completed

        todo, of = iter(indices), {}

        def submit():
            for index in todo:
                asked = self.files[index], str(self.folder), self.options
                future = self.client.submit(work, *asked, pure=False)
                of[future.key] = index
                return future

        running = as_completed([future for _ in range(at_once) if (future := submit())])
        for future in running:
            index = of.pop(future.key)
            if future.status != "error":
                self.names[index], new = future.result()
                self.computed += new
            elif suspects is not None:
                suspects.append(index)
            else:
                self.fail(index, future.exception())
            future.release()
            if following := submit():
                running.add(following)

    def fail(self, index, error):
        """Keeps the row of a record that ended its worker or whose part could not be kept."""
        self.names[index] = key(self.files[index], self.options)
        self.computed += 1
        keep(failed(self.files[index], error), self.folder / f"{self.names[index]}.parquet")

    def all(self, at_once):
        """Has all files closed. The names of their parts, and how many were computed now."""
        # A few tasks a worker at any time: the scheduler's memory does not grow. When a worker
        # has died several times Dask gives up all tasks that it had then, so that those are tried
        # again, one at a time: only the record that ends its worker alone is at fault.
        suspects = []
        self.run(range(len(self.files)), at_once, suspects)
        self.run(sorted(suspects), 1)
        return self.names, self.computed


def fleet(files, out, workers, options, scheduler=None):
    """Closes all files; how many were computed now, and how many of all are errors."""
    import dask
    from dask.distributed import Client, LocalCluster

    folder = Path(f"{out}.part")
    folder.mkdir(exist_ok=True)
    with dask.config.set(QUIET):
        if scheduler:
            with Client(scheduler) as client:
                at_once = 4 * max(1, sum(client.nthreads().values()))
                names, computed = Drive(client, files, folder, options).all(at_once)
        else:
            local = {"threads_per_worker": 1, "processes": True, "dashboard_address": None}
            with LocalCluster(n_workers=workers, **local) as cluster, Client(cluster) as client:
                names, computed = Drive(client, files, folder, options).all(4 * workers)
    errors = join(folder, names, out)
    tidy(folder, names)
    return computed, errors


def refuse(line):
    """Bad use: one line, and status 2."""
    print(f"fleet.py: {line}", file=sys.stderr)
    raise SystemExit(2)


def main():
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pattern", help="the records, such as 'runs/*.csv'")
    parser.add_argument("--out", required=True, metavar="ROWS.parquet")
    parser.add_argument("--workers", type=int, default=2, metavar="N")
    parser.add_argument("--scheduler", metavar="URL", help="of a cluster that runs already")
    parser.add_argument("--baseline", metavar="A,B", help="as in `bowden identify`")
    parser.add_argument("--channel", action="append", default=[], metavar="NAME=COL")
    parser.add_argument("--max-terms", type=int, metavar="N")
    asked = parser.parse_args()
    # Folders too: that one of that name is no record is said in its row.
    files = sorted(glob.glob(asked.pattern))
    if not files:
        refuse(f"{asked.pattern}: no file has such a name")
    if asked.workers < 1:
        refuse(f"--workers {asked.workers}: at least 1 is allowed")
    if not Path(asked.out).absolute().parent.is_dir() or Path(asked.out).is_dir():
        refuse(f"--out {asked.out}: a file in a folder that exists is allowed")
    channels = [pair.partition("=") for pair in asked.channel]
    if wrong := [pair for pair, parts in zip(asked.channel, channels) if not all(parts)]:
        refuse(f"--channel {wrong[0]}: NAME=COL is allowed")
    given = {
        "baseline": asked.baseline.split(",") if asked.baseline else None,
        "channels": {name: column for name, _, column in channels} or None,
        "max_terms": asked.max_terms,
    }
    options = {name: value for name, value in given.items() if value is not None}
    start = time.monotonic()
    computed, errors = fleet(files, asked.out, asked.workers, options, asked.scheduler)
    took = time.monotonic() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{len(files)} records, {computed} of them closed now, in {took:.2f} s; rows with an error:"
        f" {errors}; peak of this process {peak:.0f} MiB",
        file=sys.stderr,
    )


if __name__ == "__main__":
    main()
