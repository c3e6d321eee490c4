"""The fleet: a killed worker or a killed run loses and doubles nothing, errors are rows."""

import math
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytest.importorskip("bowden", reason="the wheel is not installed")
pytest.importorskip("distributed", reason="Dask is not installed")
pa = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
pq = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")

FLEET = Path(__file__).parent.parent / "examples" / "fleet.py"
RECORDS = 24


def record(path, seed):
    """Backlash-like play with noise: shares nothing with the code that fits it."""
    noise, held = random.Random(seed), 0.0
    columns = {"t": [], "tau_i": [], "tau_o": []}
    for row in range(1200):
        t = row / 200
        u = 3 * math.sin(4 * t) + 1.5 * math.sin(7.3 * t + seed)
        held = min(max(held, u - 0.4), u + 0.4)
        for name, value in zip(columns, (t, u, 0.8 * held + noise.gauss(0, 0.01))):
            columns[name].append(value)
    pq.write_table(pa.table(columns), path)


@pytest.fixture
def folder(tmp_path):
    for seed in range(RECORDS):
        record(tmp_path / f"r{seed:02}.parquet", seed)
    whole = (tmp_path / "r03.parquet").read_bytes()
    (tmp_path / "r03.parquet").write_bytes(whole[: len(whole) // 2])
    nan = pq.read_table(tmp_path / "r05.parquet").to_pydict()
    nan["tau_o"][7] = math.nan
    pq.write_table(pa.table(nan), tmp_path / "r05.parquet")
    return tmp_path


def start(folder, out, workers=2):
    command = [sys.executable, FLEET, str(folder / "r*.parquet"), "--out", out]
    return subprocess.Popen([*map(str, command), "--workers", str(workers)], start_new_session=True)


def until_parts(out, count, run):
    parts = Path(f"{out}.part")
    end = time.monotonic() + 60
    while len(list(parts.glob("*.parquet"))) < count:
        assert run.poll() is None and time.monotonic() < end
        time.sleep(0.005)


def workers_of(pid):
    """The processes below one that a nanny has started (Linux)."""
    found, below = [], [pid]
    while below:
        for task in Path(f"/proc/{below.pop()}/task").glob("*/children"):
            children = [int(child) for child in task.read_text().split()]
            below += children
            found += children
    return [p for p in found if b"spawn_main" in Path(f"/proc/{p}/cmdline").read_bytes()]


def check(out, folder):
    rows = pq.read_table(out).to_pylist()
    assert [row["file"] for row in rows] == sorted(map(str, folder.glob("r*.parquet")))
    bad = [Path(row["file"]).name for row in rows if row["status"] == "error"]
    assert bad == ["r03.parquet", "r05.parquet"]
    assert all(row["error"] for row in rows if row["status"] == "error")
    assert all(row["verdict"] for row in rows if row["status"] == "ok")


def test_a_killed_worker_and_a_killed_run_lose_nothing(folder):
    plain, killed, resumed = (folder / f"{n}.rows" for n in ("plain", "killed", "resumed"))
    assert start(folder, plain, 1).wait(120) == 0
    check(plain, folder)

    run = start(folder, killed)
    until_parts(killed, 3, run)
    worker = workers_of(run.pid)[0]
    os.kill(worker, signal.SIGKILL)
    assert len(list(Path(f"{killed}.part").glob("*.parquet"))) < RECORDS, "killed too late"
    assert run.wait(120) == 0
    assert killed.read_bytes() == plain.read_bytes()

    run = start(folder, resumed)
    until_parts(resumed, 3, run)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait(10)
    kept = {p: p.stat().st_mtime_ns for p in Path(f"{resumed}.part").glob("*.parquet")}
    assert 3 <= len(kept) < RECORDS and not resumed.exists()
    assert start(folder, resumed).wait(120) == 0
    assert all(p.stat().st_mtime_ns == at for p, at in kept.items())
    assert resumed.read_bytes() == plain.read_bytes()
