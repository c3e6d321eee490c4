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


def start(folder, out, workers=2, *more, **env):
    command = [sys.executable, FLEET, str(folder / "r*.parquet"), "--out", out, *more]
    command = [*map(str, command), "--workers", str(workers)]
    return subprocess.Popen(command, start_new_session=True, env={**os.environ, **env})


def until_parts(out, count, run):
    parts = Path(f"{out}.part")
    end = time.monotonic() + 60
    while len(list(parts.glob("*.parquet"))) < count:
        assert run.poll() is None and time.monotonic() < end
        time.sleep(0.005)


def kill_at_work(out):
    """Kills a worker that has a record in hand; the claim that it leaves behind."""
    parts, end = Path(f"{out}.part"), time.monotonic() + 60
    while time.monotonic() < end:
        for claim in parts.glob("*.claim"):
            try:
                worker = int(claim.read_text())
                os.kill(worker, signal.SIGSTOP)
            except (OSError, ValueError):  # gone, or not yet written
                continue
            # It stands still: with its claim there and its row not, it is at work on it.
            if claim.exists() and not claim.with_suffix(".parquet").exists():
                os.kill(worker, signal.SIGKILL)
                return claim
            os.kill(worker, signal.SIGCONT)
    raise AssertionError("no worker was seen at work")


def check(out, folder, *more):
    rows = pq.read_table(out).to_pylist()
    assert [row["file"] for row in rows] == sorted(map(str, folder.glob("r*.parquet")))
    bad = [Path(row["file"]).name for row in rows if row["status"] == "error"]
    assert bad == sorted(["r03.parquet", "r05.parquet", *more])
    assert all(row["error"] for row in rows if row["status"] == "error")
    assert all(row["verdict"] for row in rows if row["status"] == "ok")


def test_a_killed_worker_and_a_killed_run_lose_nothing(folder):
    plain, killed, resumed = (folder / f"{n}.rows" for n in ("plain", "killed", "resumed"))
    assert start(folder, plain, 1).wait(120) == 0
    check(plain, folder)

    run = start(folder, killed)
    until_parts(killed, 3, run)
    claim = kill_at_work(killed)
    assert run.wait(120) == 0
    assert killed.read_bytes() == plain.read_bytes()
    # The record was closed by another one, once.
    assert claim.with_suffix(".parquet").exists() and not claim.exists()
    assert len(list(Path(f"{killed}.part").glob("*"))) == RECORDS

    run = start(folder, resumed)
    until_parts(resumed, 3, run)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait(10)
    kept = {p: p.stat().st_mtime_ns for p in Path(f"{resumed}.part").glob("*.parquet")}
    # As a worker leaves it that is killed while it writes a row, and after it renamed one.
    some = next(iter(kept))
    some.with_suffix(".claim").write_text("1")
    Path(f"{some}.1.tmp").write_bytes(some.read_bytes()[:100])
    assert 3 <= len(kept) < RECORDS and not resumed.exists()
    assert start(folder, resumed).wait(120) == 0
    assert all(p.stat().st_mtime_ns == at for p, at in kept.items())
    assert resumed.read_bytes() == plain.read_bytes()
    assert len(list(Path(f"{resumed}.part").glob("*"))) == RECORDS


POISON = """
import os, signal, bowden
close = bowden.identify
def poisoned(file, **options):
    if str(file).endswith("r07.parquet"):
        os.kill(os.getpid(), signal.SIGKILL)
    return close(file, **options)
bowden.identify = poisoned
"""


def test_a_record_that_ends_every_worker_is_one_row_and_the_others_are_closed(folder):
    site = folder / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(POISON)
    out = folder / "rows"
    assert start(folder, out, PYTHONPATH=str(site)).wait(240) == 0
    check(out, folder, "r07.parquet")
    row = pq.read_table(out).to_pylist()[7]
    assert "r07" in row["file"] and "worker" in row["error"].lower()


def test_what_cannot_be_read_is_a_row_and_options_are_part_of_what_is_kept(folder):
    for path in sorted(folder.glob("r*.parquet"))[4:]:
        path.unlink()
    (folder / "r99.parquet").mkdir()
    out = folder / "rows"

    def rows(*more):
        assert start(folder, out, 1, *more).wait(120) == 0
        return {Path(row["file"]).stem: row for row in pq.read_table(out).to_pylist()}

    found = rows()
    assert found["r99"]["status"] == "error" and "r99" in found["r99"]["error"]
    assert found["r00"]["status"] == "ok" and found["r00"]["parameters"]
    parts = len(list(Path(f"{out}.part").glob("*.parquet")))
    bare = rows("--max-terms", "0", "--baseline", "bouc-wen,viscous")
    assert "viscous" in bare["r00"]["parameters"] and "viscous" not in found["r00"]["parameters"]
    assert len(list(Path(f"{out}.part").glob("*.parquet"))) == 2 * parts
    assert rows() == found
    # A record that was replaced is closed again.
    record(folder / "r00.parquet", 77)
    assert rows()["r00"] != found["r00"]


def test_the_program_writes_the_same_rows(folder, program):
    out, rows = folder / "rows", folder / "rows.parquet"
    assert start(folder, out, 2, "--baseline", "bouc-wen").wait(120) == 0
    pattern = folder / "r*.parquet"
    program("identify", "--glob", pattern, "--out", rows, "--baseline", "bouc-wen")
    fleet, ours = pq.read_table(out), pq.read_table(rows)
    assert [(f.name, str(f.type)) for f in fleet.schema] == [
        (f.name, str(f.type)) for f in ours.schema
    ]
    # Messages speak of options, which have other names in Python.
    assert fleet.drop_columns("error").to_pylist() == ours.drop_columns("error").to_pylist()
    errors = [
        [error is None for error in table.column("error").to_pylist()] for table in (fleet, ours)
    ]
    assert errors[0] == errors[1] and errors[0].count(False) == 2


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (["no-such-*.csv", "--out", "rows"], "no-such-*.csv: no file has such a name"),
        (["*", "--out", "rows", "--workers", "0"], "--workers 0: at least 1 is allowed"),
        (["*", "--out", "no/rows"], "--out no/rows: a file in a folder that exists is allowed"),
        (["*", "--out", "rows", "--channel", "x"], "--channel x: NAME=COL is allowed"),
    ],
)
def test_bad_use_is_one_line_and_status_2(folder, asked, line):
    command = [sys.executable, str(FLEET), *asked]
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (2, f"fleet.py: {line}\n")
    assert not (folder / "rows").exists() and not (folder / "rows.part").exists()
