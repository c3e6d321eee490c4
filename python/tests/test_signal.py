"""Rates, filters, ramp and plausibility, compared with closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import bowden

DT = 0.001


def test_rates_of_a_ramp_have_its_slope_through_a_wrap() -> None:
    counter = (4000 + 3 * np.arange(2001)) % 4096
    rates = bowden.Rates.for_cutoff(5.0, period=4096.0)
    assert rates.time_constant == pytest.approx(1.0 / (2.0 * np.pi * 2.5 * 5.0))
    run = rates.run(DT, counter)
    assert run.position[-1] == 10_000.0
    # V·(1 - e^(-t/tau)): at t = 2 s rounding is what is left.
    assert run.velocity[-1] == pytest.approx(3000.0, rel=1e-9)
    settled = 5.0 * rates.time_constant
    t = np.arange(2001) * DT
    expected = np.where(t > settled + 2 * DT, 0, bowden.RatesStatus.SETTLING)
    assert (run.status[t < settled - DT] == bowden.RatesStatus.SETTLING).all()
    assert (run.status[expected == 0] == bowden.RatesStatus.GOOD).all()
    stepped = bowden.Rates.for_cutoff(5.0, period=4096.0)
    last = [stepped.step(np.timedelta64(1, "ms"), int(c)) for c in counter][-1]
    assert last[:3] == tuple(own[-1] for own in run[:3])


def test_rates_of_a_bad_sample_are_held() -> None:
    rates = bowden.Rates(0.01)
    rates.run(DT, np.arange(100.0))
    before = rates.step(DT, 100.0)
    held = rates.step(DT, np.nan)
    assert held[:3] == before[:3]
    assert held[3:] == (bowden.RatesStatus.HELD, bowden.Fault.POSITION)
    assert rates.step(0.0, 1.0).fault == bowden.Fault.DT_NOT_POSITIVE


def test_a_ramp_moves_at_its_rate_and_starts_where_it_is_told() -> None:
    wanted = np.full(1000, 25.0)
    ramp = bowden.Ramp(50.0, start=5.0)
    expected = np.minimum(5.0 + 50.0 * DT * np.arange(1, 1001), 25.0)
    np.testing.assert_allclose(ramp.run(DT, wanted), expected, rtol=1e-12)
    ramp.restart()
    assert ramp.step(DT, 25.0) == pytest.approx(5.05)
    many = bowden.Ramp(np.array([10.0, 20.0]))
    np.testing.assert_allclose(many.step(DT, [1.0, 1.0]), [0.01, 0.02])
    assert many.run(DT, np.ones((5, 2))).shape == (5, 2)


def test_a_sample_that_cannot_be_true_is_nan_with_its_reason() -> None:
    sound = bowden.Plausible(-5.0, 5.0, rate=100.0, stuck_after=3)
    fault = bowden.Implausible
    samples = np.array([0.0, 0.05, 9.0, np.nan, 4.0, 0.1, 0.1, 0.1, 0.1])
    run = sound.run(DT, samples)
    assert [fault(f) for f in run.fault] == [
        *(fault.NONE, fault.NONE, fault.OUT_OF_RANGE, fault.NOT_FINITE, fault.TOO_FAST),
        *(fault.NONE, fault.NONE, fault.NONE, fault.STUCK),
    ]
    assert (np.isnan(run.value) == (run.fault != 0)).all()
    still = bowden.Plausible(-5.0, 5.0, stuck_after=3).run(DT, np.full(9, 0.1), moves=False)
    assert not still.fault.any()
    assert sound.step(DT, 9.0).fault is fault.OUT_OF_RANGE


def test_a_longer_dt_than_the_longest_moves_no_ramp() -> None:
    ramp = bowden.Ramp(50.0, longest_dt=np.timedelta64(5, "ms"))
    assert ramp.longest_dt == 0.005
    assert ramp.step(0.006, 25.0) == 0.0
    assert ramp.step(0.005, 25.0) == pytest.approx(0.25)


def test_a_low_pass_is_its_lag() -> None:
    samples = np.random.default_rng(1).normal(size=300)
    expected = [samples[0]]
    for sample in samples[1:]:
        expected.append(expected[-1] + DT / (0.01 + DT) * (sample - expected[-1]))
    np.testing.assert_allclose(bowden.LowPass(0.01).run(DT, samples), expected, rtol=1e-12)
    low_pass = bowden.LowPass(0.01)
    assert [low_pass.step(DT, x) for x in (2.0, np.nan, 2.0)] == [2.0, 2.0, 2.0]


def test_a_biquad_has_the_gain_that_it_is_designed_for() -> None:
    t = np.arange(4000) * DT
    for response, frequency, gain in (
        ("notch", 35.0, 0.0),
        ("notch", 1.0, 1.0),
        ("low-pass", 35.0, np.sqrt(0.5)),
    ):
        q = 5.0 if response == "notch" else np.sqrt(0.5)
        out = bowden.Biquad(response, 35.0, q, DT).run(DT, np.sin(2.0 * np.pi * frequency * t))
        # The last second has whole periods; the start has died out to 1e-9 by then.
        found = np.sqrt(2.0 * np.mean(out[-1000:] ** 2))
        assert found == pytest.approx(gain, abs=2e-4), (response, frequency)
    with pytest.raises(bowden.Error, match="frequency < 1/"):
        bowden.Biquad("low-pass", 600.0, 1.0, DT)
    with pytest.raises(bowden.Error, match="^response='high-pass'"):
        bowden.Biquad("high-pass", 60.0, 1.0, DT)


def test_the_velocity_between_counts_is_the_speed_and_ends_at_a_stop() -> None:
    # 20 counts a second in a loop of 1 kHz, through a wrap; then a stop.
    counter = np.concatenate([(4090 + np.arange(1000) // 50) % 4096, np.full(201, 13)])
    edges = bowden.EdgeVelocity(1.0, 0.01, 0.2, period=4096.0)
    run = edges.run(DT, counter)
    status = bowden.EdgeStatus
    # Two counts are known after the second one, at sample 100.
    assert (run.status[:100] == status.SETTLING).all() and not run.velocity[:100].any()
    assert (run.status[100:1000] == status.GOOD).all()
    np.testing.assert_allclose(run.velocity[100:1000], 20.0, rtol=1e-9)
    # Without a count the bound count/t falls, until the longest gap.
    late = np.arange(1000, 1150)
    np.testing.assert_allclose(
        run.velocity[late], np.minimum(20.0, 1.0 / ((late - 950) * DT)), rtol=1e-9
    )
    assert edges.step(DT, 13) == (0.0, status.STOPPED, bowden.Fault.NONE)
    assert edges.step(DT, np.nan) == (0.0, status.HELD, bowden.Fault.POSITION)
    with pytest.raises(bowden.Error, match="count"):
        bowden.EdgeVelocity(0.0, 0.01, 0.2)
