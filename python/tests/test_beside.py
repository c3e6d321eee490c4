"""The observer and learning, compared with their formulas written out here."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import bowden

DT = 0.001
#: The drive of the rig [N·m/unit, rad/s, 1], and how long a command takes to show [s].
PLANT = (0.6, 25.5, 0.265)
LATENCY = 0.003
PERIOD = 1.0


def observer(limit: float = 30.0) -> bowden.DisturbanceObserver:
    return bowden.DisturbanceObserver(
        bowden.NominalPlant(*PLANT), 0.0159, limit, latency=LATENCY, longest_dt=0.005
    )


def observed(sent: np.ndarray, measured: np.ndarray) -> np.ndarray:
    """d_hat = Q·u - Q·P⁻¹·y, with both lags of Q in the implicit form."""
    alpha, wn, zeta = PLANT
    tau, share = 0.0159, DT / (0.0159 + DT)
    w0 = w1 = w2 = sent[0]
    z1 = z2 = measured[0]
    found = []
    for u, y in zip(sent, measured):
        w0 += min(DT / LATENCY, 1.0) * (u - w0)
        w1 += share * (w0 - w1)
        w2 += share * (w1 - w2)
        z1 += share * (y - z1)
        z2 += share * (z1 - z2)
        rate, bend = z1 - z2, y - 2.0 * z1 + z2
        output = z2 + 2.0 * zeta / (wn * tau) * rate + bend / (wn * tau) ** 2
        found.append(w2 - output / alpha)
    return np.array(found)


def test_the_observer_is_its_formula() -> None:
    rng = np.random.default_rng(1)
    measured = 20.0 + rng.normal(0.0, 0.05, 400).cumsum()
    pi = bowden.PI(observer=observer(1e6))
    commands, seen = [], []
    for y in measured:
        commands.append(pi.step(DT, 20.0, y).command)
        seen.append(pi.disturbance)
    sent = np.concatenate([[0.0], commands[:-1]])
    np.testing.assert_allclose(seen, observed(sent, measured), rtol=1e-9, atol=1e-9)
    # What it sees is added, and nothing else has changed.
    plain = bowden.PI().run(DT, 20.0, measured, feed_forward=np.array(seen)).command
    np.testing.assert_array_equal(commands, plain)
    assert bowden.PI().disturbance is None


def phase_of(t: np.ndarray) -> np.ndarray:
    return (t / PERIOD) % 1.0


def learned_by_hand(error: np.ndarray, cells: int, gain: float, lead: int, half: int, kept: float) -> np.ndarray:
    """The cells as one row without an end: what was learned of cell j once it is known."""
    a_cell = len(error) // (3 * cells)
    mean = error.reshape(-1, a_cell).mean(axis=1)
    weights = np.array([half + 1 - abs(k) for k in range(-half, half + 1)]) / (half + 1) ** 2
    smoothed = np.zeros(4 * cells)
    raw = np.zeros(4 * cells)
    for j in range(half, 4 * cells - half):
        # The error `lead` cells after this one, a cycle ago; before the first there was nothing.
        for k in range(max(j, cells), j + half + 1):
            if k - cells + lead < len(mean):
                raw[k] = kept * smoothed[k - cells] + gain * mean[k - cells + lead]
        smoothed[j] = weights @ raw[j - half : j + half + 1]
    return smoothed


def test_learning_is_its_formula() -> None:
    rng = np.random.default_rng(2)
    cells, gain, lead, half, forgetting = 50, 4.0, 3, 2, 0.1
    t = np.arange(3 * 1000) * DT
    error = rng.normal(0.0, 1.0, len(t))
    own = bowden.IterativeLearning(
        gain, 1e6, cells=cells, lead=lead, half_width=half, forgetting=forgetting
    )
    # A law that does nothing: its command is the feed-forward.
    law = bowden.PI(1e-300, 0.0, learning=own)
    phase = (np.arange(len(t)) % 1000 + 0.5) / 1000
    commands = law.run(DT, error, np.zeros(len(t)), phase=phase).command
    row = learned_by_hand(error, cells, gain, lead, half, 1.0 - forgetting)
    third = np.arange(2000, 3000)
    middles = np.arange(4 * cells) + 0.5
    expected = np.interp(2.0 * cells + cells * phase[third], middles, row)
    np.testing.assert_allclose(commands[third], expected, rtol=1e-9, atol=1e-9)
    # From what was learned another controller goes on.
    known = law.learned
    assert known.shape == (cells,)
    again = bowden.PI(
        1e-300, 0.0, learning=bowden.IterativeLearning(gain, 1e6, cells=cells, learned=known)
    )
    now = again.step(DT, 0.0, 0.0, phase=0.5 / cells, learns=False).command
    assert now == pytest.approx(known[0])
    again.restart()
    np.testing.assert_array_equal(again.learned, known)


def gait(seconds: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Reference, its nominal feed-forward, and the phase: three tones that repeat."""
    t = np.arange(seconds * 1000) * DT
    tones = ((1, 8.0), (2, 4.0), (3, 2.0))

    def along(at: np.ndarray, order: int) -> Any:
        w = 2.0 * np.pi / PERIOD
        shift = 0.5 * np.pi * order
        return sum(size * (k * w) ** order * np.sin(k * w * at + shift) for k, size in tones)

    ahead = t + LATENCY
    plant = bowden.NominalPlant(*PLANT)
    feed = plant.feed_forward(15.0 + along(ahead, 0), along(ahead, 1), along(ahead, 2))
    return 15.0 + along(t, 0), feed, phase_of(t)


def rms(error: np.ndarray) -> float:
    return float(np.sqrt(np.mean(error[-5000:] ** 2)))


def test_both_lower_the_error_of_a_task_that_repeats() -> None:
    reference, feed, phase = gait(15)
    rig = bowden.Rig(noise=0.02, seed=5)
    plain = rig.track(bowden.PI(), reference, feed_forward=feed)
    rig.restart()
    soft = rig.track(bowden.PI(12.0, 60.0), reference, feed_forward=feed)
    rig.restart()
    seen = rig.track(bowden.PI(12.0, 60.0, observer=observer()), reference, feed_forward=feed)
    rig.restart()
    law = bowden.PI(learning=bowden.IterativeLearning(4.0, 30.0, cells=250, lead=3, half_width=4))
    taught = rig.track(law, reference, feed_forward=feed, phase=phase)
    # Each beside the same gains without it. A third and a quarter is left.
    assert rms(seen["error"]) < 0.5 * rms(soft["error"])
    assert rms(taught["error"]) < 0.5 * rms(plain["error"])
    assert np.abs(law.learned).max() > 0.0 and np.abs(law.learned).max() <= 30.0
    assert (taught["status"] == 0).all()


def test_the_loop_is_the_same_step_by_step_and_lanes_learn_by_themselves() -> None:
    reference, feed, phase = gait(3)

    def both(lanes: Any = None) -> bowden.PI:
        own = bowden.IterativeLearning(4.0, 30.0, cells=250, lead=3, half_width=4)
        return bowden.PI(12.0, 60.0, observer=observer(), learning=own, lanes=lanes)

    rig, law = bowden.Rig(seed=7), both()
    at_once = rig.track(law, reference, feed_forward=feed, phase=phase)
    rig.restart()
    stepped = both()
    errors = []
    for k, wanted in enumerate(reference):
        now = rig.sample()
        errors.append(now["tau_o"] - wanted)
        command = stepped.step(
            DT, wanted, now["measured"], feed_forward=feed[k], phase=phase[k]
        )
        rig.step(command, DT)
    np.testing.assert_array_equal(at_once["error"], errors)
    np.testing.assert_array_equal(law.learned, stepped.learned)
    many = both(lanes=2)
    loop = bowden.Rig(seed=[7, 8]).track(many, reference, feed_forward=feed, phase=phase)
    np.testing.assert_array_equal(loop["error"][:, 0], errors)
    assert many.learned.shape == (2, 250) and many.disturbance.shape == (2,)
    assert (many.learned[0] != many.learned[1]).any()


def test_a_bad_sample_of_either_is_seen() -> None:
    law = bowden.PI(learning=bowden.IterativeLearning(4.0, 30.0, cells=50))
    good = law.step(DT, 20.0, 19.0, phase=0.5)
    assert good.command > 0.0 and good[1:] == (bowden.Status.GOOD, bowden.Fault.NONE)
    unused = law.step(DT, 20.0, 19.0, phase=np.nan)
    assert unused[1:] == (bowden.Status.DEGRADED, bowden.Fault.PHASE)
    held = law.step(DT, 20.0, np.nan, phase=0.5)
    assert held == (unused.command, bowden.Status.HELD, bowden.Fault.MEASURED)
    late = bowden.PI(observer=observer()).step(0.02, 20.0, 19.0)
    assert late.command > 0.0 and late[1:] == (bowden.Status.DEGRADED, bowden.Fault.DT_TOO_LONG)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: bowden.NominalPlant(0.0, 25.0, 0.2), "gain"),
        (lambda: bowden.NominalPlant(0.6, -1.0, 0.2), "natural_frequency"),
        (lambda: bowden.NominalPlant.of_mechanics(0.6, 0.0, 1.0, 1.0), "inertia=0.0"),
        (lambda: observer(0.0), "limit"),
        (lambda: bowden.DisturbanceObserver((0.6, 25.5, 0.265), 0.01, 1.0), "plant: tuple; a NominalPlant is allowed"),
        (lambda: bowden.IterativeLearning(0.0, 30.0, cells=250), "gain"),
        (lambda: bowden.IterativeLearning(4.0, 30.0, cells=12, lead=3, half_width=4), "cells"),
        (lambda: bowden.IterativeLearning(4.0, 30.0, cells=250.5), "cells"),
        (lambda: bowden.IterativeLearning(4.0, 30.0, cells=250, learned=np.zeros(249)), r"learned: shape \(249,\); \(250,\) is allowed"),
        (lambda: bowden.PI(learning=observer()), "learning: DisturbanceObserver; a IterativeLearning is allowed"),
        (lambda: bowden.PI(observer=3.0), "observer: float; a DisturbanceObserver is allowed"),
        (lambda: bowden.PI().step(DT, 1.0, 1.0, phase=0.5), "phase: allowed and needed with learning=…, and only there"),
        (
            lambda: bowden.PI(learning=bowden.IterativeLearning(4.0, 30.0, cells=50)).step(DT, 1.0, 1.0),
            "phase: allowed and needed with learning=…, and only there",
        ),
        (lambda: bowden.Rig().track(bowden.PI(), np.ones(5), feed_forward=np.ones(4)), r"feed_forward: shape \(4,\)"),
    ],
)
def test_what_makes_no_sense_is_refused(make: Any, message: str) -> None:
    with pytest.raises(bowden.Error, match=message):
        make()


def test_the_plant_turned_round() -> None:
    alpha, wn, zeta = PLANT
    plant = bowden.NominalPlant(*PLANT)
    y, v, a = np.random.default_rng(3).normal(size=(3, 2, 5))
    found = plant.feed_forward(y, v, a)
    assert found.shape == (2, 5)
    np.testing.assert_allclose(found, (y + 2.0 * zeta / wn * v + a / wn**2) / alpha, rtol=1e-12)
    assert plant.feed_forward(12.0) == pytest.approx(20.0)
    same = bowden.NominalPlant.of_mechanics(0.6, 0.2, 2.7, 130.0)
    assert same.feed_forward(0.0, 0.0, 1.0) == pytest.approx(0.2 / 130.0 / 0.6)
    assert repr(plant).startswith("NominalPlant(gain=0.6")
