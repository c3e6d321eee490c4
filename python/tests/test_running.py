"""Threads, progress, signals, processes."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Optional

import pytest
from tqdm import tqdm

import bowden
import records


def test_progress_tells_each_step(viscous: dict[str, Any]) -> None:
    told: list[tuple[Optional[float], str]] = []
    thread = threading.get_ident()

    def hear(share: Optional[float], message: str) -> None:
        assert threading.get_ident() == thread
        told.append((share, message))

    report = bowden.identify(viscous, progress=hear)
    assert report.names == ["viscous"]
    shares = [share for share, _ in told if share is not None]
    assert shares == sorted(shares) and shares[0] == 0.0 and 0.9 < shares[-1] <= 1.0
    messages = [message for _, message in told]
    assert messages[0] == "reading"
    assert "fitting the baseline model" in messages
    assert any(m.startswith("searching for missing terms, round 1") for m in messages)


def test_a_bar_of_tqdm_ends_full(viscous: dict[str, Any]) -> None:
    with open(os.devnull, "w") as nowhere, tqdm(total=100, file=nowhere) as bar:
        bowden.identify(viscous, progress=bar)
        assert bar.n == pytest.approx(100)
    bowden.identify(viscous, max_terms=0, progress=True)
    with pytest.raises(TypeError, match="progress"):
        bowden.identify(viscous, progress=3)


def test_what_progress_raises_ends_the_call(viscous: dict[str, Any]) -> None:
    def stop(share: Optional[float], message: str) -> None:
        if message.startswith("searching"):
            raise KeyError(message)

    with pytest.raises(KeyError, match="round 1"):
        bowden.identify(viscous, progress=stop)
    assert bowden.identify(viscous).names == ["viscous"]


LONG = """
import sys
sys.path.insert(0, {tests!r})
import bowden, records
record = records.hard()
channels = {{name: name for name in record if name.startswith("c")}}
print("begun", flush=True)
try:
    bowden.identify(record, channels=channels, threads=1)
    print("done", flush=True)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_stops_it() -> None:
    script = LONG.format(tests=str(Path(__file__).parent))
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=120)
    assert rest == "interrupted\n" and process.returncode == 0
    # Signals are looked for every 50 ms; undisturbed, the call takes some ten seconds more.
    assert time.monotonic() - sent < 3.0


def test_other_threads_run_meanwhile(viscous: dict[str, Any]) -> None:
    counted, done = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted
    bowden.identify(viscous)
    after = counted
    done.set()
    thread.join()
    # A call takes some tenths of a second: with the lock held not one would be counted.
    assert after - before > 20


def test_numbers_do_not_depend_on_threads(viscous: dict[str, Any]) -> None:
    one, all = (bowden.identify(viscous, threads=threads) for threads in (1, None))
    assert one.final == all.final and one.terms == all.terms


def test_calls_side_by_side_do_not_mix() -> None:
    all = [records.torque(seed=k, viscous=1.2) for k in range(1, 5)]
    alone = [bowden.identify(one) for one in all]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(bowden.identify, all))
    assert [r.final for r in together] == [r.final for r in alone]
    assert [r.terms for r in together] == [r.terms for r in alone]
    assert len({r.final.nrmse.held_out for r in alone}) == 4


def names(seed: int) -> list[str]:
    return bowden.identify(records.torque(seed=seed, viscous=1.2), threads=None).names


@pytest.mark.skipif(
    "fork" not in multiprocessing.get_all_start_methods(), reason="nothing forks here"
)
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_has_threads_of_its_own(viscous: dict[str, Any]) -> None:
    bowden.identify(viscous)
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(names, (1,)).get(timeout=60) == ["viscous"]


def test_a_report_goes_to_another_process(viscous: dict[str, Any]) -> None:
    report = bowden.identify(viscous)
    again = pickle.loads(pickle.dumps(report))
    assert again.json == report.json and again.model == report.model
    assert again.final.nrmse.held_out == report.final.nrmse.held_out
    assert report.summary in again._repr_html_().replace("&#x27;", "'")
    with pytest.raises(bowden.Error, match="another process"):
        again.trace()


def test_what_a_report_shows(viscous: dict[str, Any]) -> None:
    report = bowden.identify(viscous)
    shown = report._repr_html_()
    assert shown.count("<img ") == 2 and shown.count("<iframe ") == 1
    assert repr(report) == f"<Report {report.verdict}: {report.summary}>"
    pandas_trace, polars_trace = report.trace(), report.trace("polars")
    plain_trace = report.trace("dict")
    assert list(pandas_trace.columns) == polars_trace.columns == list(plain_trace)
    assert pandas_trace["residual"].equals(pandas_trace["measured"] - pandas_trace["final"])
    light = bowden.identify(viscous, figures=False)
    with pytest.raises(bowden.Error, match="figures=False"):
        light.model
    assert "<img" not in light._repr_html_()
    with pytest.raises(AttributeError, match="no 'verdikt' among schema"):
        report.verdikt
