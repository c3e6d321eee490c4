"""Throughput and memory of fleet.py: python fleet_measure.py [RECORDS …], Linux.

Each number of records is closed on one worker and on two. The peak is that of the largest
process of the run (client with scheduler, or a worker). Starting the processes is included.
"""

import math
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

ROWS, RATE = 1200, 200.0


def record(path, seed):
    """Play with noise."""
    noise, held = random.Random(seed), 0.0
    columns = {"t": [], "tau_i": [], "tau_o": []}
    for row in range(ROWS):
        t = row / RATE
        u = 3 * math.sin(4 * t) + 1.5 * math.sin(7.3 * t + seed)
        held = min(max(held, u - 0.4), u + 0.4)
        for name, value in zip(columns, (t, u, 0.8 * held + noise.gauss(0, 0.01))):
            columns[name].append(value)
    pq.write_table(pa.table(columns), path)


def measure(folder, out, workers):
    """Seconds and the peak [MiB] of the largest process."""
    fleet = Path(__file__).with_name("fleet.py")
    command = [sys.executable, str(fleet), f"{folder}/*.parquet", "--out", str(out)]
    start = time.monotonic()
    run = subprocess.Popen([*command, "--workers", str(workers)], stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(run.pid, 0)
    if status != 0:
        raise SystemExit("fleet.py failed")
    return time.monotonic() - start, usage.ru_maxrss / 1024


def main():
    """One line of a table for each run."""
    print("| records | workers | seconds | records/s | peak [MiB] |\n|---|---|---|---|---|")
    for count in map(int, sys.argv[1:] or ("1000", "10000")):
        with tempfile.TemporaryDirectory() as top:
            folder = Path(top, "records")
            folder.mkdir()
            for seed in range(count):
                record(folder / f"{seed:06}.parquet", seed)
            for workers in (1, 2):
                took, peak = measure(folder, Path(top, f"{workers}.rows"), workers)
                rate = count / took
                print(f"| {count} | {workers} | {took:.1f} | {rate:.1f} | {peak:.0f} |", flush=True)
            if Path(top, "1.rows").read_bytes() != Path(top, "2.rows").read_bytes():
                raise SystemExit("the rows depend on the number of workers")


if __name__ == "__main__":
    main()
