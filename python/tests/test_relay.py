"""The relay experiment on plants whose ultimate gain is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import bowden

DT = 0.01
SETTINGS: dict[str, Any] = {
    "reference": 5.0,
    "centre": 10.0,
    "amplitude": 8.0,
    "hysteresis": 0.05,
    "most_deviation": 8.0,
    "longest_time": 20.0,
    "longest_dt": np.timedelta64(50, "ms"),
    "limits": (-20.0, 60.0),
    "fallback": (3, 0.0),
}


def ended(relay: bowden.Relay, gain: Any = 0.5) -> bowden.RelayResult:
    """Three lags of 0.1 s each, from their rest at the reference."""
    lags = np.full((3, *np.shape(gain)), 5.0)
    for _ in range(5000):
        out = relay.step(DT, lags[2])
        if np.all(out.phase >= bowden.RelayPhase.DONE):
            return out
        for k, value in enumerate([gain * out.command, *lags[:2].copy()]):
            lags[k] += (value - lags[k]) * DT / 0.1
    raise AssertionError("the experiment has not ended")


def test_the_gains_follow_from_the_limit_cycle() -> None:
    relay = bowden.Relay(**SETTINGS)
    assert relay.ultimate is None
    with pytest.raises(bowden.Error, match="^pi: the experiment has no result"):
        relay.pi()
    out = ended(relay)
    assert out == (10.0, bowden.RelayPhase.DONE, bowden.Fault.NONE)
    found = relay.ultimate
    assert found is not None
    # k_u = 8/0.5 and T_u = 2·pi·0.1/sqrt(3) of the continuous plant. Hysteresis and the samples make
    # the cycle slower: up to four samples, and a tenth of the period.
    assert 0.6 * 16.0 < found.gain < 16.0
    assert 0.3628 < found.period < 1.1 * 0.3628 + 4 * DT
    assert found.duty == pytest.approx(0.5, abs=0.1)
    gains = relay.pi()
    assert gains.k_p == pytest.approx(found.gain / 3.2)
    assert gains.k_i == pytest.approx(gains.k_p / (2.2 * found.period))
    fast = relay.pi("ziegler-nichols")
    assert fast.k_p == pytest.approx(0.45 * found.gain)
    assert bowden.PI(**gains).k_p == gains.k_p
    with pytest.raises(bowden.Error, match="^rule='x': one of"):
        relay.pi("x")


def test_each_lane_has_its_own_result() -> None:
    relay = bowden.Relay(**{**SETTINGS, "amplitude": np.array([8.0, 6.0]), "most_deviation": 9.0})
    gain = np.array([0.5, 0.5])
    ended(relay, gain)
    found, gains = relay.ultimate, relay.pi()
    assert found is not None and found.gain.shape == (2,)
    np.testing.assert_allclose(gains.k_p, found.gain / 3.2)
    alone = bowden.Relay(**{**SETTINGS, "amplitude": 6.0, "most_deviation": 9.0})
    ended(alone)
    one = alone.ultimate
    assert one is not None and one.gain == found.gain[1]


def test_a_failure_keeps_the_safe_command_until_it_is_acknowledged() -> None:
    relay, phase = bowden.Relay(**SETTINGS), bowden.RelayPhase
    assert relay.step(DT, 4.9) == (18.0, phase.RUNNING, bowden.Fault.NONE)
    assert relay.step(DT, np.nan) == (18.0, phase.HELD, bowden.Fault.MEASURED)
    relay.run(DT, np.full(2, np.nan))
    assert relay.step(DT, 4.9) == (0.0, phase.BAD_SAMPLES, bowden.Fault.MEASURED)
    relay.acknowledge()
    assert relay.step(DT, 4.9) == (18.0, phase.RUNNING, bowden.Fault.NONE)
    assert relay.step(DT, 14.0) == (0.0, phase.OUTPUT_OUT_OF_RANGE, bowden.Fault.NONE)
    still = bowden.Relay(**SETTINGS).run(DT, np.full(3000, 4.9))
    assert still.phase[-1] == phase.NO_OSCILLATION and still.command[-1] == 0.0


def test_what_is_refused_says_what_is_allowed() -> None:
    for change, message in [
        ({"cycles": 1}, "cycles"),
        ({"amplitude": 60.0}, "centre ± amplitude must lie within the limits"),
        ({"limits": (5.0, 1.0)}, "low < high is allowed"),
        ({"fallback": (3, 99.0)}, "the safe command lies within the limits"),
    ]:
        with pytest.raises(bowden.Error, match=message):
            bowden.Relay(**{**SETTINGS, **change})
    assert bowden.Relay(**SETTINGS).settings["limits"] == (-20.0, 60.0)
