"""Threads: a second one waits; what two do at once is what one would do twice."""

from __future__ import annotations

import sys
import threading
import time
from typing import Any, Callable

import numpy as np
import pytest

import bowden

DT = 0.001


@pytest.fixture(autouse=True)
def often() -> Any:
    """Threads change places as often as they can."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def at_once(*works: Callable[[], object]) -> None:
    failed: list[BaseException] = []

    def guarded(work: Callable[[], object]) -> None:
        try:
            work()
        except BaseException as error:
            failed.append(error)

    threads = [threading.Thread(target=guarded, args=(work,)) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive()
    if failed:
        raise failed[0]


def test_a_display_reads_while_the_loop_steps() -> None:
    pi, stop, seen = bowden.PI(2.0, 10.0), threading.Event(), []

    def display() -> None:
        while not stop.is_set():
            seen.append((pi.last, pi.terms(), pi.k_p, pi.state))

    def loop() -> None:
        for _ in range(5000):
            pi.step(DT, 1.0, 0.0)
        stop.set()

    at_once(display, loop)
    assert seen and pi.estimates[0] == pytest.approx(10.0 * DT * 5000)


def test_two_threads_that_step_one_controller_take_turns() -> None:
    pi, rig = bowden.PI(2.0, 10.0), bowden.Rig()
    ones = np.ones(200_000)

    def steps() -> None:
        for _ in range(5000):
            pi.step(DT, 1.0, 0.0)

    at_once(steps, steps, lambda: pi.run(DT, ones, 0.0), lambda: pi.run(DT, ones, 0.0))
    # Every sample has counted once: the integral is k_i·e·dt of each.
    assert pi.estimates[0] == pytest.approx(10.0 * DT * (2 * 5000 + 2 * len(ones)))
    at_once(*(lambda: rig.run(np.ones(2000)),) * 3)
    # Rounding of a sum of 6000 steps.
    assert rig.sample()["time"] == pytest.approx(6.0, abs=1e-9)


def test_two_loops_over_the_same_pair_do_not_wait_for_each_other() -> None:
    rig, pi = bowden.Rig(), bowden.PI()
    reference = np.full(1000, 10.0)
    at_once(*(lambda: rig.track(pi, reference),) * 2, lambda: pi.run(DT, reference, 0.0))
    assert rig.sample()["time"] == pytest.approx(2.0)


def test_changes_of_settings_from_two_threads_are_both_there() -> None:
    pi = bowden.PI(1.0, 1.0)

    def p() -> None:
        for k in range(200):
            pi.bumpless_transfer(k_p=float(k + 1))

    def i() -> None:
        for k in range(200):
            pi.bumpless_transfer(k_i=float(k + 1))

    at_once(p, i)
    assert (pi.k_p, pi.k_i) == (200.0, 200.0)


def test_python_goes_on_while_a_run_computes() -> None:
    pi, ones = bowden.PI(), np.ones((3_000_000, 1))
    # What numpy does before it takes as long, so that it would hide a lock that is held.
    native, signals = pi._native, [ones] * 7
    running = threading.Thread(target=lambda: native.run(DT * ones[:, 0], signals, []))
    began = last = time.perf_counter()
    longest = 0.0
    running.start()
    while running.is_alive():
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    longest = max(longest, time.perf_counter() - last)
    # With the interpreter's lock held, this thread would wait for almost all of the run.
    assert longest < 0.5 * (time.perf_counter() - began)
