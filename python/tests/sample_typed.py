"""What a user may write, for `mypy --strict`; the tests run it too."""

from pathlib import Path
from typing import Optional

import numpy as np

import bowden


def first_name(path: Path) -> Optional[str]:
    report = bowden.identify(path, baseline=["bouc-wen"], progress=None)
    held_out: float = report.final.nrmse.held_out
    names: list[str] = report.names
    for round in report.terms:
        p: Optional[float] = round.p
        print(round.effect, p, round.rmse_after.held_out)
    model: bowden.Model = report.model
    checked: bowden.CheckReport = bowden.validate(model, path)
    print(checked.verdict, checked.gain.value, held_out)
    return names[0] if names else None


def commands(reference: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> float:
    rig, pi = bowden.Rig(seed=1), bowden.PI(k_p=30.0, k_i=18.0)
    found = rig.track(pi, reference)
    return float(np.max(np.abs(found["error"])))


def steps(pi: bowden.PI) -> tuple[float, bowden.Status, bowden.Fault]:
    result = pi.step(np.timedelta64(1, "ms"), 1.0, 0.5)
    command, status, fault = result
    run: bowden.RunResult = pi.run(0.001, np.ones(3), np.zeros(3))
    print(run.status == bowden.Status.GOOD, pi.terms().integral, result.fault)
    pi.bumpless_transfer(k_p=20.0)
    pi.load_state(pi.state)
    gain: float = pi.k_p
    made = bowden.PID(gain, 2.0, 0.5, np.timedelta64(20, "ms"), anti_windup="clamp", limits=(-1, 1))
    adaptive = bowden.Adaptive(lambda_=6.0, missing="drop-regressor", theta=[{"gain": 0.1}])
    rates: bowden.RatesResult = bowden.Rates(0.01, period=360.0).step(0.001, 3.0)
    edges: bowden.EdgeVelocityResult = bowden.EdgeVelocity(1.0, 0.01, 0.2).step(0.001, 3.0)
    relay = bowden.Relay(
        reference=5.0,
        centre=10.0,
        amplitude=8.0,
        hysteresis=0.05,
        most_deviation=8.0,
        longest_time=20.0,
        longest_dt=0.05,
        limits=(-20.0, 60.0),
        fallback=(20, 0.0),
    )
    phase: bowden.RelayPhase = relay.step(0.001, 4.9).phase
    print(edges.velocity, phase, relay.ultimate)
    print(made.derivative_time, adaptive.z_limit, rates.velocity)
    return command, status, fault


def wrong(pi: bowden.PI) -> list[str]:
    """What type checkers refuse too: `--strict` tells where one of these is no error any more."""
    told = []
    try:
        pi.k_p = 200.0  # type: ignore[misc]
    except bowden.Error as error:
        told.append(str(error))
    try:
        pi.setpoint = 5.0  # type: ignore[attr-defined]
    except bowden.Error as error:
        told.append(str(error))
    try:
        bowden.PI(k_q=1.0)  # type: ignore[call-arg]
    except bowden.Error as error:
        told.append(str(error))
    try:
        bowden.Rates()  # type: ignore[call-arg]
    except bowden.Error as error:
        told.append(str(error))
    return told


def place(error: bowden.Error) -> tuple[Optional[str], Optional[int], Optional[str]]:
    return error.file, error.line, error.column
