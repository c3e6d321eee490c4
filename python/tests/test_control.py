"""Controllers and the rig, compared with the same laws written out here."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import bowden

DT = 0.001


def by_hand(k_p: float, k_i: float, reference: np.ndarray, measured: np.ndarray) -> np.ndarray:
    """PI (15): u = -k_p e - k_i ∫e, with e = y - y_r."""
    error = measured - reference
    return -k_p * error - k_i * np.cumsum(error) * DT


def test_pi_is_its_formula_by_steps_and_at_once() -> None:
    rng = np.random.default_rng(1)
    reference, measured = rng.normal(20.0, 3.0, (2, 500))
    expected = by_hand(30.0, 18.0, reference, measured)
    at_once = bowden.PI().run(DT, reference, measured).command
    # Rounding: the integral is a compensated sum, numpy's is not.
    np.testing.assert_allclose(at_once, expected, rtol=1e-12, atol=1e-10)
    pi = bowden.PI()
    stepped = [pi.step(DT, r, y).command for r, y in zip(reference, measured)]
    np.testing.assert_array_equal(stepped, at_once)
    assert pi.status == bowden.Status.GOOD and pi.command == stepped[-1]
    pi.restart()
    assert pi.step(DT, reference[0], measured[0]).command == stepped[0]


def test_lanes_are_controllers_of_their_own() -> None:
    rng = np.random.default_rng(2)
    reference, measured = rng.normal(20.0, 3.0, (2, 200))
    gains = np.array([10.0, 30.0, 60.0])
    many = bowden.PI(k_p=gains, k_i=18.0)
    assert many.lanes == 3
    commands = many.run(DT, reference, measured).command
    assert commands.shape == (200, 3)
    for lane, gain in enumerate(gains):
        alone = bowden.PI(gain, 18.0).run(DT, reference, measured).command
        np.testing.assert_array_equal(commands[:, lane], alone)
    own = rng.normal(20.0, 3.0, (2, 200, 3))
    each = bowden.PI(k_p=gains).run(DT, own[0], own[1]).command
    for lane, gain in enumerate(gains):
        alone = bowden.PI(gain, 18.0).run(DT, own[0, :, lane], own[1, :, lane]).command
        np.testing.assert_array_equal(each[:, lane], alone)
    again = bowden.PI(k_p=gains)
    assert again.step(DT, reference[0], measured[0]).command.shape == (3,)


def test_piv_reads_the_velocity_and_pid_the_rate() -> None:
    piv, pi = bowden.PIV(), bowden.PI()
    damped = piv.step(DT, 1.0, 0.5, velocity=0.1).command
    assert damped == pytest.approx(pi.step(DT, 1.0, 0.5).command - 1.0)
    pid = bowden.PID(k_d=2.0, derivative_time=0.0)
    first, second = (pid.step(DT, 0.0, y).command for y in (0.0, 0.01))
    assert first == 0.0
    assert second == pytest.approx(-30.0 * 0.01 - 18.0 * 0.01 * DT - 2.0 * 0.01 / DT)


def test_limits_bad_samples_and_the_safe_command() -> None:
    pi = bowden.PI(limits=(-20.0, 60.0), fallback=(3, 0.0), longest_dt=0.005)
    bad = (bowden.Fault.MEASURED,)
    assert pi.step(DT, 30.0, 0.0) == (60.0, bowden.Status.GOOD, bowden.Fault.NONE)
    assert pi.step(DT, 30.0, np.nan) == (60.0, bowden.Status.HELD, *bad) == pi.last
    pi.step(DT, 30.0, np.nan)
    assert pi.step(DT, 30.0, np.nan) == (0.0, bowden.Status.SAFE, *bad)
    assert pi.step(DT, 30.0, 29.9) == (0.0, bowden.Status.SAFE, *bad) and pi.is_latched
    pi.acknowledge()
    assert pi.step(DT, 30.0, 29.9).status == bowden.Status.GOOD and not pi.is_latched
    with pytest.raises(bowden.Error, match="k_p and k_i must have the same sign"):
        bowden.PI(30.0, -1.0)
    with pytest.raises(bowden.Error, match="k_p"):
        bowden.PI(float("nan"), 1.0)


def test_the_adaptive_law_learns_and_wants_its_regressors() -> None:
    law = bowden.Adaptive()
    assert law.step(DT, 25.0, 24.7, regressors=[0.1, -0.3]).command == 0.0
    beta, delta, *theta = law.estimates
    assert beta > 0.0 and delta != 7.0 and len(theta) == 2
    with pytest.raises(bowden.Error, match="regressors: 0 are given; 2 is the law's number"):
        law.step(DT, 25.0, 24.7)
    lag = bowden.Adaptive(
        epsilon=0.1,
        form=("first-order", 0.001, 1.0),
        beta={"initial": 1.0, "low": 0.8, "high": 1.2, "gain": 2.5e-4, "leakage": 0.01},
        delta={"initial": 1.0, "low": 0.0, "high": 7.0, "gain": 6e-3, "leakage": 0.01},
        theta=[],
    )
    assert np.isfinite(lag.step(DT, 25.0, 24.7).command)


def test_the_rig_in_a_loop_is_the_same_step_by_step() -> None:
    t = np.arange(1500) * DT
    reference = bowden.paper_reference(t, ramp=1.0)
    assert bowden.paper_reference([0.0])[0] == 25.0
    at_once = bowden.Rig(seed=7).track(bowden.PI(), reference)
    rig, pi = bowden.Rig(seed=7), bowden.PI()
    errors = []
    for wanted in reference:
        now = rig.sample()
        errors.append(now["tau_o"] - wanted)
        rig.step(pi.step(DT, wanted, now["measured"]), DT)
    np.testing.assert_array_equal(at_once["error"], errors)
    assert np.sqrt(np.mean(at_once["error"][500:] ** 2)) < 2.0
    assert not at_once["diverged"].any() and (at_once["status"] == 0).all()


def test_rigs_side_by_side_have_seeds_and_settings_of_their_own() -> None:
    commands = 20.0 * np.sin(np.arange(400) * DT * 6.0)
    many = bowden.Rig(noise=np.array([0.0, 0.28]), seed=3).run(commands)
    assert many["tau_o"].shape == (400, 2)
    for lane, noise in enumerate((0.0, 0.28)):
        alone = bowden.Rig(noise=noise, seed=3 + lane).run(commands)
        np.testing.assert_array_equal(many["measured"][:, lane], alone["measured"])
    friction = {"effect": "viscous", "source": "proximal", "gain": -2.0}
    with_friction = bowden.Rig(noise=0.0, seed=3, undeclared=[friction]).run(commands)
    added = with_friction["tau_o"] - many["tau_o"][:, 0]
    assert np.max(np.abs(added)) > 0.01
    with pytest.raises(bowden.Error, match="Rig: no setting `inertia`; the settings are .*joint_inertia"):
        bowden.Rig(inertia=1.0)


def test_a_record_of_the_rig_can_be_closed() -> None:
    t = np.arange(20_000) * DT
    run: dict[str, Any] = bowden.Rig(seed=5, noise=0.02, input_noise=0.02).track(
        bowden.PI(), bowden.paper_reference(t, ramp=1.0)
    )
    report = bowden.identify(run["time"], run["measured_input"], run["measured"], max_terms=0)
    gain = report.baseline.parameters[0]
    assert gain.value == pytest.approx(0.9978, abs=0.1)
