"""States: hand-over, copies, what is stored and restored."""

from __future__ import annotations

import copy
import json
import pickle
from typing import Any, Callable

import numpy as np
import pytest

import bowden

DT = 0.001
RNG = np.random.default_rng(4)
SIGNAL = 20.0 + RNG.normal(0.0, 1.0, (2, 600)).cumsum(axis=1)


def helped() -> bowden.PI:
    plant = bowden.NominalPlant(0.6, 25.5, 0.265)
    observer = bowden.DisturbanceObserver(plant, 0.0159, 30.0, latency=0.003)
    learning = bowden.IterativeLearning(4.0, 30.0, cells=50, lead=3, half_width=2)
    return bowden.PI(12.0, 60.0, observer=observer, learning=learning, limits=(-90.0, 90.0))


def phase(k: Any) -> Any:
    return (k % 400 + 0.5) / 400


Run = Callable[[Any, slice], Any]

#: What has a state, and how it runs over a part of the signal.
MADE: dict[str, tuple[Callable[[], Any], Run]] = {
    "PI": (lambda: bowden.PI(limits=(-9.0, 90.0)), lambda o, s: o.run(DT, *SIGNAL[:, s])),
    "PID": (bowden.PID, lambda o, s: o.run(DT, *SIGNAL[:, s])),
    "PI of two": (
        lambda: bowden.PI(np.array([1.0, 2.0])),
        lambda o, s: o.run(DT, *SIGNAL[:, s]),
    ),
    "helped": (
        helped,
        lambda o, s: o.run(DT, *SIGNAL[:, s], phase=phase(np.arange(600)[s])),
    ),
    "Adaptive": (
        bowden.Adaptive,
        lambda o, s: o.run(DT, *SIGNAL[:, s], regressors=[SIGNAL[0, s], 0.1]),
    ),
    "Rig": (
        lambda: bowden.Rig(
            undeclared=[{"effect": "backlash", "gain": 0.5, "shapes": {"r": 0.4}}],
            drift={"time": 2.0, "b": 0.02, "kappa_eta": 0.1, "t0": 0.2},
        ),
        lambda o, s: o.run(SIGNAL[0, s]),
    ),
    "Rates": (lambda: bowden.Rates(0.01, period=7.0), lambda o, s: o.run(DT, SIGNAL[0, s])),
    "EdgeVelocity": (
        lambda: bowden.EdgeVelocity(0.5, 0.01, 0.1, period=7.0),
        lambda o, s: o.run(DT, np.floor(SIGNAL[0, s] * 2) / 2),
    ),
    "Relay": (
        lambda: bowden.Relay(
            reference=20.0,
            centre=5.0,
            amplitude=2.0,
            hysteresis=0.5,
            most_deviation=90.0,
            longest_time=20.0,
            longest_dt=0.01,
            limits=(-9.0, 90.0),
            fallback=(20, 0.0),
        ),
        lambda o, s: o.run(DT, SIGNAL[0, s]),
    ),
    "LowPass": (lambda: bowden.LowPass(0.01), lambda o, s: o.run(DT, SIGNAL[0, s])),
    "Biquad": (
        lambda: bowden.Biquad("notch", 35.0, 5.0, DT),
        lambda o, s: o.run(DT, SIGNAL[0, s]),
    ),
    "Ramp": (lambda: bowden.Ramp(5.0, 0.02, start=3.0), lambda o, s: o.run(DT, SIGNAL[0, s])),
    "Plausible": (
        lambda: bowden.Plausible(0.0, 90.0, rate=500.0),
        lambda o, s: o.run(DT, SIGNAL[0, s]),
    ),
}


def restored(own: Any) -> Any:
    """Through a text, into an object that has run elsewhere."""
    other = type(own)(**own.settings)
    other.load_state(json.loads(json.dumps(own.state)))
    return other


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, restored, "pickle"], ids=str)
@pytest.mark.parametrize("name", MADE)
def test_a_copy_goes_on_alike_and_by_itself(name: str, copied: Any) -> None:
    make, run = MADE[name]
    whole = run(make(), slice(0, 600))
    own = make()
    run(own, slice(0, 350))
    if copied == "pickle":
        other = pickle.loads(pickle.dumps(own))
    else:
        other = copied(own)
    assert type(other) is type(own) and other is not own
    np.testing.assert_equal(other.settings, own.settings)
    np.testing.assert_equal(other.state, own.state)
    rest, going_on = run(other, slice(350, 600)), run(own, slice(350, 600))
    np.testing.assert_equal(rest, going_on)
    # Nobody has seen the break.
    if isinstance(whole, dict):
        np.testing.assert_equal(rest, {name: signal[350:] for name, signal in whole.items()})
    elif isinstance(whole, tuple):
        np.testing.assert_equal(tuple(rest), tuple(signal[350:] for signal in whole))
    else:
        np.testing.assert_equal(rest, whole[350:])
    # They share nothing: the one that waits is where it was.
    before = other.state
    run(own, slice(0, 100))
    np.testing.assert_equal(other.state, before)


def test_settings_objects_can_be_copied() -> None:
    law = helped()
    for own in (law.observer, law.learning, law.observer.plant):
        for other in (copy.copy(own), copy.deepcopy(own), pickle.loads(pickle.dumps(own))):
            assert type(other) is type(own)
            assert other == own and hash(other) == hash(own)
    assert law.observer != law.observer.plant != bowden.NominalPlant(0.6, 25.5, 0.266)


@pytest.mark.parametrize(
    ("law", "state", "message"),
    [
        (bowden.PI(), {}, "a mapping of schema 'bowden.state/1'"),
        (bowden.PI(), None, "a mapping of schema 'bowden.state/1'"),
        (bowden.PI(), bowden.PID().state, "of 'PID'; a state of 'PI'"),
        (bowden.PI(), bowden.Adaptive().state, "of 'Adaptive'; a state of 'PI'"),
        (bowden.PI(), bowden.PI(lanes=2).state, "2 lanes; 1 is the number"),
        (bowden.PI(), helped().state, "another observer"),
        (helped(), bowden.PI().state, "another observer"),
        (bowden.Adaptive(theta=[{}]), bowden.Adaptive().state, "too many items"),
        (
            bowden.Adaptive(beta={"initial": 1.0, "low": 0.5, "high": 2.0}),
            bowden.Adaptive().state,
            "outside of what these settings allow",
        ),
        (bowden.Rates(0.01), bowden.Ramp(5.0).state, "of 'Ramp'; a state of 'Rates'"),
    ],
)
def test_a_foreign_state_is_refused_and_nothing_has_changed(
    law: Any, state: Any, message: str
) -> None:
    before = law.state
    with pytest.raises(bowden.Error, match=f"^state: .*{message}"):
        law.load_state(state)
    assert law.state == before


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), "3", None, [1.0]])
def test_a_state_with_a_bad_number_is_refused(bad: Any) -> None:
    pi = bowden.PI(lanes=2)
    pi.step(DT, 1.0, 0.0)
    state = pi.state
    # The second lane is bad: the first one must not change either.
    state["lanes"][0]["law"]["controller"]["integral"]["value"] = 9.0
    state["lanes"][1]["law"]["controller"]["integral"]["value"] = bad
    with pytest.raises(bowden.Error, match="^state: "):
        pi.load_state(state)
    np.testing.assert_allclose(pi.estimates[:, 0], [0.018, 0.018], rtol=1e-15)
    del state["lanes"][1]["law"]["controller"]["integral"]
    with pytest.raises(bowden.Error, match="missing field `integral`"):
        pi.load_state(state)


def test_the_terms_add_up_and_are_of_the_step_that_was() -> None:
    piv = bowden.PIV(2.0, 10.0, 3.0, limits=(-20.0, 60.0))
    command = piv.step(DT, 1.0, 0.25, velocity=0.5, feed_forward=4.0).command
    terms = piv.terms()
    assert (terms.error, terms.proportional, terms.velocity) == (-0.75, 1.5, -1.5)
    assert terms.integral == pytest.approx(10.0 * 0.75 * DT)
    assert terms.unlimited == command and terms["feed_forward"] == 4.0 and not terms.saturated
    assert set(terms.keys()) == {
        *("error", "proportional", "integral", "derivative"),
        *("velocity", "feed_forward", "unlimited", "saturated"),
    }
    # (17), (18) and the paper's virtual command (23) at the first sample, in numbers.
    law = bowden.Adaptive(20.0, 8.0, 0.5, form=("as-published", 0.005), beta={"initial": 0.75}, theta=())
    command = law.step(DT, 25.0, 24.0).command
    terms = law.terms()
    assert (terms.error, terms.z, terms.s, terms.beta_hat) == (-1.0, 0.0, -1.0, 0.75)
    ubar = 20.0 + 25.0 - 7.0 * np.tanh(-1.0 / 0.5)
    assert terms.virtual_command == pytest.approx(ubar)
    assert command == pytest.approx(0.75 * ubar) == terms.law
    many = bowden.PI(np.array([1.0, 2.0]))
    many.step(DT, 1.0, 0.0)
    np.testing.assert_allclose(many.terms().proportional, [1.0, 2.0])


def test_a_controller_resumes_at_a_command_that_is_out() -> None:
    pi = bowden.PI()
    told = pi.resume_from(42.0, 25.0, 25.0, feed_forward=20.0)
    assert told == (42.0, bowden.Status.GOOD, bowden.Fault.NONE)
    assert pi.step(DT, 25.0, 25.0, feed_forward=20.0).command == 42.0
    bad = pi.resume_from(np.nan, 25.0, 25.0)
    assert bad == (42.0, bowden.Status.HELD, bowden.Fault.COMMAND)
    law = bowden.Adaptive(beta={"initial": 1.2, "low": 0.5, "high": 2.0}, theta=[{}])
    law.resume_from(31.0, 25.0, 24.0, regressors=[0.3])
    assert law.step(DT, 25.0, 24.0, regressors=[0.3]).command == pytest.approx(31.0, abs=1e-9)
    # What learning adds to the command is part of the command that is out.
    known = bowden.IterativeLearning(4.0, 30.0, cells=50, learned=np.full(50, 2.0))
    taught = bowden.PI(learning=known)
    assert taught.step(DT, 1.0, 1.0, phase=0.5, learns=False).command == pytest.approx(2.0)
    taught.resume_from(7.0, 1.0, 1.0)
    assert taught.step(DT, 1.0, 1.0, phase=0.5, learns=False).command == pytest.approx(7.0)
    many = bowden.PI(lanes=2)
    np.testing.assert_array_equal(many.resume_from([3.0, 4.0], 1.0, 1.0).command, [3.0, 4.0])
    np.testing.assert_array_equal(many.step(DT, 1.0, 1.0).command, [3.0, 4.0])


def test_reset_power_up_and_restart_forget_what_they_say() -> None:
    limits: dict[str, Any] = {"limits": (-20.0, 60.0), "fallback": (2, 5.0), "slew": 1e5}
    for forget, command, integral in (
        ("reset", 60.0, 0.0),
        ("restore", 0.0, 0.0),
        ("restart", 0.0, 0.0),
    ):
        pi = bowden.PI(**limits)
        pi.run(DT, np.full(50, 30.0), np.linspace(29.0, 10.0, 50))
        assert pi.command == 60.0
        getattr(pi, forget)()
        assert (pi.command, pi.estimates[0]) == (command, integral), forget
        pi.run(DT, 30.0, [np.nan, np.nan])
        assert pi.is_latched and pi.command == 5.0
        getattr(pi, forget)()
        assert pi.is_latched == (forget != "restart")
    law = bowden.Adaptive()
    law.run(DT, np.full(100, 25.0), 20.0, regressors=[0.1, 0.2])
    learned = law.estimates
    law.restore()
    np.testing.assert_array_equal(law.estimates, learned)
    law.reset()
    np.testing.assert_array_equal(law.estimates, bowden.Adaptive().estimates)


def test_the_law_counts_from_what_the_drive_did() -> None:
    settings: dict[str, Any] = {"limits": (-20.0, 60.0), "slew": 100.0}
    pi, both = bowden.PI(1.0, 10.0, **settings), bowden.PI(1.0, 10.0, lanes=2, **settings)
    for _ in range(2000):
        pi.step(DT, 20.0, 0.0)
        both.step(DT, 20.0, 0.0)
        pi.applied(0.0)
        both.applied([0.0, "as-commanded"])
    # 100/s for 1 ms, from zero; not from the 60 that were commanded.
    assert pi.step(DT, 20.0, 0.0).command == pytest.approx(0.1)
    np.testing.assert_allclose(both.step(DT, 20.0, 0.0).command, [0.1, 60.0])
    full = bowden.PI(1.0, 10.0)
    full.step(DT, 1.0, 0.0)
    before = full.terms().integral
    full.applied("at-upper-limit")
    full.step(DT, 1.0, 0.0)
    assert full.terms().integral == before
    full.applied(np.nan)
    full.step(DT, 1.0, 0.0)
    assert full.terms().integral == pytest.approx(before + 0.01)
    for wrong in ("at-limit", None, True, [1.0, 2.0]):
        with pytest.raises(bowden.Error, match="^what"):
            full.applied(wrong)


def test_a_run_tells_status_and_fault_of_each_sample() -> None:
    measured = np.array([0.0, np.nan, np.nan, 0.0, 0.0])
    dt = np.array([DT, DT, DT, -1.0, DT])
    run = bowden.PI(2.0, 10.0, fallback=(20, 0.0)).run(dt, np.ones(5), measured)
    status, fault = bowden.Status, bowden.Fault
    assert [status(s) for s in run.status] == [
        *(status.GOOD, status.HELD, status.HELD),
        *(status.HELD, status.GOOD),
    ]
    assert [fault(f) for f in run.fault] == [
        *(fault.NONE, fault.MEASURED, fault.MEASURED),
        *(fault.DT_NOT_POSITIVE, fault.NONE),
    ]
    assert str(status.HELD) == "held" and f"{fault.DT_NOT_POSITIVE}" == "dt not positive"
    np.testing.assert_allclose(run.command, [2.01, 2.01, 2.01, 2.01, 2.02])
    loop = bowden.Rig().track(bowden.PI(), np.array([1.0, np.nan, 1.0]))
    assert loop["fault"].tolist() == [0, fault.REFERENCE, 0]
    assert loop["status"].tolist() == [0, status.HELD, 0]


class Logged(bowden.PI):
    """A class of a user's, with an attribute of its own."""

    def __init__(self) -> None:
        super().__init__(2.0, 10.0)
        self.log = [1]


def test_a_class_of_ones_own_has_attributes_of_its_own() -> None:
    own = Logged()
    own.step(DT, 1.0, 0.0)
    for other in (copy.copy(own), copy.deepcopy(own), pickle.loads(pickle.dumps(own))):
        assert other.log == [1] and other.state == own.state
    with pytest.raises(bowden.Error, match="k_p cannot be assigned"):
        own.k_p = 3.0  # type: ignore[misc]
