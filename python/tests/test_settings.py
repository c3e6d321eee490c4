"""Settings: keyword, attribute, bumpless change; compared with closed forms written out here."""

from __future__ import annotations

import inspect
import json
import pickle
from typing import Any

import numpy as np
import pytest

import bowden

DT = 0.001

#: Each class with every setting that it has, none at its default.
FULL: dict[type, dict[str, Any]] = {
    bowden.PI: {
        "k_p": 3.0,
        "k_i": 7.0,
        "setpoint_weight": 0.5,
        "anti_windup": "back-calculation",
        "tracking_time": 0.25,
        "integral_limit": 4.0,
        "deadband": 0.125,
        "period": None,
        "limits": (-20.0, 60.0),
        "slew": 1000.0,
        "longest_dt": 0.005,
        "fallback": (20, 1.0),
        "fallback_weight": 2,
    },
    bowden.PID: {
        "k_p": 3.0,
        "k_i": 7.0,
        "k_d": 0.5,
        "derivative_time": 0.02,
        "derivative_weight": 1.0,
        "anti_windup": "clamp",
        "period": 360.0,
        "limits": (-20.0, 60.0),
    },
    bowden.PIV: {"k_p": 3.0, "k_i": 7.0, "k_d": 0.5, "anti_windup": "none"},
    bowden.Adaptive: {
        "gain": 20.0,
        "lambda_": 6.0,
        "epsilon": 0.5,
        "form": ("first-order", 0.001, 0.5),
        "smooth_sign": "clamp",
        "beta": {
            "initial": 1.0,
            "low": 0.5,
            "high": 1.5,
            "gain": 0.25,
            "leakage": 0.125,
            "prior": 1.0,
        },
        "delta": {
            "initial": 1.0,
            "low": 0.0,
            "high": 2.0,
            "gain": 0.5,
            "leakage": ("switching", 0.5, 1.5),
            "prior": 0.25,
        },
        "theta": (
            {
                "initial": 0.0,
                "low": None,
                "high": None,
                "gain": 0.0,
                "leakage": None,
                "prior": 0.0,
            },
        ),
        "z_limit": 3.0,
        "frozen": True,
        "missing": ("drop-regressor",),
        "limits": (-20.0, 60.0),
        "slew": 1000.0,
        "longest_dt": 0.005,
        "fallback": (20, 1.0),
        "fallback_weight": 2,
    },
    bowden.Rates: {"time_constant": 0.02, "longest_gap": 0.5, "period": 360.0},
    bowden.LowPass: {"time_constant": 0.02},
    bowden.Biquad: {"response": "notch", "frequency": 35.0, "q": 5.0, "sample_time": 0.002},
    bowden.Ramp: {"rate": 50.0, "time_constant": 0.02, "longest_dt": 0.005, "start": 3.0},
    bowden.Plausible: {
        "low": -5.0,
        "high": 9.0,
        "rate": 200.0,
        "stuck_after": 50,
        "sample_period": 0.01,
        "longest_dt": 0.005,
    },
    bowden.Rig: {
        "noise": 0.125,
        "sensor_lag": 0.002,
        "delay": 2,
        "drift": {"time": 2.0, "b": 0.02, "kappa_eta": 0.1, "t0": 0.2},
        "undeclared": [
            {"effect": "viscous", "source": "proximal", "gain": -2.0, "shapes": {}},
        ],
        "seed": 11,
    },
}


@pytest.mark.parametrize("kind", FULL, ids=lambda kind: kind.__name__)
def test_every_setting_is_a_keyword_and_an_attribute(kind: Any) -> None:
    given = FULL[kind]
    made = kind(**given)
    for name, value in given.items():
        assert getattr(made, name) == value, name
    assert set(given) <= set(made.settings)
    again = kind(**made.settings)
    assert again.settings == made.settings and repr(again) == repr(made)
    names = [*inspect.signature(kind).parameters]
    assert set(names) == set(made.settings)
    for name in names:
        assert f"\n    {name}\n" in kind.__doc__, name


def leaves(value: Any, path: str = "") -> set[str]:
    """The names of all numbers in a JSON."""
    if isinstance(value, dict):
        return {leaf for key, one in value.items() for leaf in leaves(one, f"{path}.{key}")}
    if isinstance(value, list):
        return {leaf for one in value for leaf in leaves(one, f"{path}[]")}
    return {path}


@pytest.mark.parametrize(
    "kind",
    [kind for kind in FULL if kind not in (bowden.PID, bowden.PIV)],
    ids=lambda kind: kind.__name__,
)
def test_the_core_has_no_setting_that_cannot_be_given(kind: Any) -> None:
    def core(made: Any) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(made._native.settings()[0])
        return dict(found.get("block", found))

    needed = ("time_constant", "rate", "low", "high", "response", "frequency", "q", "sample_time")
    given = FULL[kind]
    made = kind(**given)
    if kind is bowden.PI:
        # PI, PID and PIV share what the core calls a PID; each reaches some of its settings.
        others = [bowden.PID(1.0, 2.0, 0.5, period=360.0), bowden.PIV(1.0, 2.0)]
    else:
        others = [
            kind(**{n: v for n, v in given.items() if n in needed and kind is not bowden.Rig})
        ]
    for name, value in core(made).items():
        by_name = name in made.settings and name not in given
        moved = any(core(other).get(name) != value for other in others)
        assert moved or by_name or name in needed, f"no keyword reaches {name}"


def test_what_was_not_given_is_as_the_core_has_it() -> None:
    pid = bowden.PID()
    assert (pid.setpoint_weight, pid.anti_windup, pid.derivative_weight) == (
        1.0,
        "conditional",
        0.0,
    )
    assert (pid.limits, pid.slew, pid.longest_dt, pid.fallback) == (None,) * 4
    assert (bowden.Adaptive().smooth_sign, bowden.Adaptive().missing) == ("tanh", ("hold", "hold"))
    assert bowden.Rates(0.01).longest_gap == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("thing", "name", "instead"),
    [
        (bowden.PI(), "k_p", "bumpless_transfer(k_p=…)"),
        (bowden.PI(), "limits", "bumpless_transfer(limits=…)"),
        (bowden.PI(), "setpoint", "no attribute `setpoint` to assign; the settings are"),
        (bowden.PI(), "status", "status can only be read"),
        (bowden.Adaptive(), "frozen", "bumpless_transfer(frozen=…)"),
        (bowden.Rig(), "noise", "make another Rig with noise=…"),
        (bowden.Ramp(5.0), "rate", "make another object with rate=…"),
        (bowden.NominalPlant(0.6, 25.0, 0.2), "gain", "make another object with gain=…"),
        (bowden.IterativeLearning(4.0, 30.0, cells=50), "cell", "the settings are gain, limit, cells"),
    ],
)
def test_an_assignment_is_refused_and_says_what_to_do(thing: Any, name: str, instead: str) -> None:
    before = thing.settings
    for kind in (bowden.Error, AttributeError):
        with pytest.raises(kind) as found:
            setattr(thing, name, 3.0)
        assert instead in str(found.value)
    assert str(pickle.loads(pickle.dumps(found.value))) == str(found.value)
    with pytest.raises(bowden.Error, match="cannot be deleted"):
        delattr(thing, name)
    assert thing.settings == before


def test_a_keyword_that_is_none_is_an_error_and_a_type_error() -> None:
    for kind in (bowden.Error, TypeError):
        with pytest.raises(kind, match="PI: no setting `k_q`; the settings are .*k_p, k_i"):
            bowden.PI(k_q=1.0)
        with pytest.raises(kind, match="PI: 3 settings without a name; only k_p, k_i may"):
            bowden.PI(1.0, 2.0, 3.0)
        with pytest.raises(kind, match="PI: k_p is given twice"):
            bowden.PI(1.0, k_p=2.0)
        with pytest.raises(kind, match="Ramp: rate is needed"):
            bowden.Ramp()


def test_settings_of_lanes_are_arrays_where_they_differ() -> None:
    low, high = np.array([-1.0, -2.0]), np.array([1.0, 2.0])
    many = bowden.PI(np.array([10.0, 30.0]), 18.0, limits=(low, high))
    np.testing.assert_array_equal(many.k_p, [10.0, 30.0])
    assert many.k_i == 18.0 and many.lanes == 2
    np.testing.assert_array_equal(many.limits[1], high)
    np.testing.assert_array_equal(many.step(DT, 30.0, 0.0).command, high)
    estimate = {"initial": np.array([1.0, 2.0])}
    both = bowden.Adaptive(beta=estimate)
    np.testing.assert_array_equal(both.estimates[:, 0], [1.0, 2.0])
    with pytest.raises(bowden.Error, match=r"different numbers of lanes \(k_p: 2, k_i: 3\)"):
        bowden.PI(np.ones(2), np.ones(3))


def integral(anti_windup: str, tracking_time: Any = None) -> float:
    limits = (-10.0, 10.0)
    pi = bowden.PI(2.0, 5.0, limits=limits, anti_windup=anti_windup, tracking_time=tracking_time)
    pi.run(DT, np.full(1000, 8.0), 0.0)
    return float(pi.terms().integral)


def test_each_anti_windup_does_what_it_says() -> None:
    # The proportional term alone asks for 16 of 10; the error is 8 for a second.
    assert integral("none") == pytest.approx(40.0)
    assert integral("clamp") == 10.0
    assert integral("conditional") == 0.0
    # At rest what flows back in T_t is what the integral adds: the excess is k_i·e·T_t = 2, so
    # that the sum is 12 and the integral -4; after a second of e^(-t/0.05) it is there.
    assert integral("back-calculation", 0.05) == pytest.approx(12.0 - 16.0, abs=0.05)
    assert integral("back-calculation", np.timedelta64(50, "ms")) == integral(
        "back-calculation", 0.05
    )


def test_deadband_period_and_the_limit_of_the_integral() -> None:
    waits = bowden.PI(2.0, 10.0, deadband=0.5)
    waits.run(DT, np.full(100, 0.5), 0.0)
    assert waits.terms().integral == 0.0
    bounded = bowden.PI(2.0, 10.0, integral_limit=0.25)
    bounded.run(DT, np.full(1000, 1.0), 0.0)
    assert bounded.terms().integral == pytest.approx(0.25)
    turns = bowden.PI(2.0, 0.0, period=360.0)
    assert turns.step(DT, 359.0, 1.0).command == pytest.approx(-4.0)
    assert bowden.PI(2.0, 0.0).step(DT, 359.0, 1.0).command == pytest.approx(716.0)


def test_the_derivative_acts_on_the_measurement_unless_it_is_asked() -> None:
    for weight, kick in ((None, 0.0), (0.0, 0.0), (1.0, 2.0 * 5.0 / DT), (0.5, 2.0 * 2.5 / DT)):
        pid = bowden.PID(1e-9, 0.0, 2.0, 0.0, derivative_weight=weight)
        pid.step(DT, 0.0, 0.0)
        assert pid.step(DT, 5.0, 0.0).command == pytest.approx(kick, abs=1e-6)


def test_the_fallback_counts_with_its_weight() -> None:
    # A bad sample adds the weight, a good one takes 1 away, 3·weight is too many: with 4 the
    # fourth of alternating bad samples makes 3·(4 - 1) + 4 = 13 of 12, with 1 there is never more than 1.
    for weight, latched in ((1, False), (4, True), (None, True)):
        pi = bowden.PI(fallback=(3, 0.5), fallback_weight=weight)
        measured = np.tile([np.nan, 0.0], 4)
        pi.run(DT, 1.0, measured[:6])
        assert not pi.is_latched
        pi.run(DT, 1.0, measured[6:])
        assert pi.is_latched == latched


def test_a_regressor_that_is_missing_holds_or_is_dropped() -> None:
    for policy, status in (("hold", bowden.Status.HELD), ("drop-regressor", bowden.Status.DEGRADED)):
        law = bowden.Adaptive(missing=policy)
        law.step(DT, 25.0, 20.0, regressors=[0.1, 0.0])
        bad = law.step(DT, 25.0, 20.0, regressors=[0.1, np.nan])
        assert (bad.status, bad.fault) == (status, bowden.Fault.REGRESSOR_1)
    mixed = bowden.Adaptive(missing=("drop-regressor", "hold"))
    assert mixed.step(DT, 1.0, 0.0, regressors=[np.nan, 0.0]).status == bowden.Status.DEGRADED
    assert mixed.step(DT, 1.0, 0.0, regressors=[0.0, np.nan]).status == bowden.Status.HELD


def test_the_accumulated_error_stays_within_its_limit_and_frozen_estimates_stay() -> None:
    law = bowden.Adaptive(z_limit=0.01, frozen=True, theta=())
    before = law.estimates
    law.run(DT, np.full(100, 1.0), 0.0)
    assert law.terms().z == pytest.approx(-0.01)
    np.testing.assert_array_equal(law.estimates, before)


def test_a_change_of_gains_does_not_move_the_command() -> None:
    pi = bowden.PI(3.0, 1.0)
    before = pi.step(DT, 2.0, 1.5).command
    pi.bumpless_transfer(k_p=30.0)
    assert (pi.k_p, pi.k_i) == (30.0, 1.0)
    # One step of the integral, 1·0.5·dt, and not 27·0.5 of the proportional term.
    assert pi.step(DT, 2.0, 1.5).command == pytest.approx(before + 0.0005, abs=1e-12)
    assert bowden.PI(30.0, 1.0).step(DT, 2.0, 1.5).command == pytest.approx(15.0005)

    law = bowden.Adaptive(gain=24.0)
    law.run(DT, np.full(200, 25.0), 20.0, regressors=[0.1, 0.0])
    out = law.command
    assert abs(out) > 0.1
    law.bumpless_transfer(gain=30.0)
    assert law.step(DT, 25.0, 20.0, regressors=[0.1, 0.0]).command == pytest.approx(out, abs=1e-9)
    # Before the first sample the new initial estimates count.
    fresh = bowden.Adaptive()
    fresh.bumpless_transfer(beta={"initial": 0.5})
    assert fresh.estimates[0] == 0.5


def test_a_change_that_is_refused_changes_nothing() -> None:
    many = bowden.PI(np.array([10.0, 30.0]))
    many.step(DT, 1.0, 0.0)
    before = many.settings, many.state
    for settings, message in (
        ({"k_i": np.array([1.0, -1.0])}, "k_p and k_i must have the same sign"),
        ({"k_q": 1.0}, "no setting `k_q`"),
        ({"lanes": 3}, "lanes cannot change while it runs"),
        ({"k_p": np.ones(3)}, "different numbers of lanes"),
        ({"observer": None}, "observer cannot change while it runs"),
    ):
        with pytest.raises(bowden.Error, match=message):
            many.bumpless_transfer(**settings)
    np.testing.assert_equal((many.settings, many.state), before)
    with pytest.raises(bowden.Error, match="the number of regressors cannot change"):
        bowden.Adaptive().bumpless_transfer(theta=[])
