"""The simulated rig."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, Optional

import numpy as np

from . import _bowden, _numbers
from ._control import Controller
from ._error import Error
from ._lanes import Lanes
from ._settings import count, duration, real, setting
from ._status import Command, command_of


def _seeds(name: str, value: Any) -> Any:
    """One seed, or a list with one seed for each lane."""
    allowed = "whole numbers from 0 to 2**64 - 1 are allowed"

    def one(seed: Any) -> int:
        return _numbers.whole(name, seed, 0, 2**64 - 1, allowed)

    if isinstance(value, (str, Mapping)) or not hasattr(value, "__len__"):
        return one(value)
    return [one(seed) for seed in value]


def _undeclared(name: str, value: Any) -> list[dict[str, Any]]:
    if isinstance(value, (str, Mapping)) or not isinstance(value, Sequence):
        raise Error(f"{name}={value!r}: a sequence of mappings is allowed")
    return [_term(f"{name}[{k}]", one) for k, one in enumerate(value)]


def _term(name: str, one: Any) -> dict[str, Any]:
    if not isinstance(one, Mapping):
        raise Error(f"{name}={one!r}: a mapping of effect, source, gain and shapes is allowed")

    def number(key: str, value: Any) -> float:
        return _numbers.finite(f"{name}.{key}", _numbers.number(f"{name}.{key}", value))

    shapes = [{"name": k, "value": number(k, v)} for k, v in one.get("shapes", {}).items()]
    numbers = {k: number(k, v) for k, v in one.items() if k in ("gain", "origin")}
    rest = {k: v for k, v in one.items() if k not in ("gain", "origin", "shapes")}
    return {"source": "input", **rest, **numbers, "shapes": shapes}


def _drift(name: str, value: Any) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise Error(f"{name}={value!r}: a mapping of time, b, kappa_eta and t0 is allowed")
    kinds = {"time": duration}
    return {key: kinds.get(key, real)(f"{name}.{key}", one) for key, one in value.items()}


class Rig(Lanes):
    """The simulated rig: motor, cable, joint with a spring, and sensors.

    If a setting is an array, there is one rig (lane) for each value. The defaults are the settings
    of the reference rig.
    """

    _INSTEAD = "make another Rig with {}=…"

    drive_gain: Any = setting(
        default=None, doc="Motor torque per command unit [N·m/command unit]."
    )
    drive_lag: Any = setting(
        default=None, convert=duration, doc="Time constant of the current loop [s]."
    )
    motor_inertia: Any = setting(
        default=None, doc="Inertia of motor, gear and proximal pulley [kg·m²]."
    )
    motor_damping: Any = setting(
        default=None, doc="Viscous friction of motor, gear and proximal pulley [N·m·s/rad]."
    )
    cable_stiffness: Any = setting(default=None, doc="Stiffness of the cable [N·m/rad].")
    cable_damping: Any = setting(default=None, doc="Damping of the cable [N·m·s/rad].")
    joint_inertia: Any = setting(default=None, doc="Inertia of the distal pulley [kg·m²].")
    joint_damping: Any = setting(default=None, doc="Damping of the joint [N·m·s/rad].")
    load_stiffness: Any = setting(
        default=None, doc="Stiffness of the load springs [N·m/rad]."
    )
    b: Any = setting(default=None, doc="Torque ratio B.")
    kappa_eta: Any = setting(default=None, doc="Hysteresis torque at saturation [N·m].")
    t0: Any = setting(default=None, doc="Preload T0 [N·m].")
    rho: Any = setting(default=None, doc="Bouc-Wen rho [1/(N·m)].")
    sigma: Any = setting(default=None, doc="Bouc-Wen sigma.")
    n: Any = setting(default=None, doc="Bouc-Wen n.")
    sensor_lag: Any = setting(
        default=None, convert=duration, doc="Time constant of both torque sensors [s]."
    )
    noise: Any = setting(default=None, doc="White noise on the distal torque [N·m rms].")
    input_noise: Any = setting(default=None, doc="White noise on the proximal torque [N·m rms].")
    output_range: Any = setting(
        default=None, doc="Range of the distal A/D converter, plus and minus [N·m]."
    )
    input_range: Any = setting(
        default=None, doc="Range of the proximal A/D converter, plus and minus [N·m]."
    )
    converter_counts: Any = setting(default=None, doc="Counts of an A/D converter over its range.")
    encoder_counts: Any = setting(default=None, doc="Counts of each encoder per turn.")
    velocity_lag: Any = setting(
        default=None,
        convert=duration,
        doc="Time constant of the filtered encoder velocity [s].",
    )
    delay: Any = setting(
        default=None, convert=count(255), doc="Delay from a command to the drive [samples]."
    )
    sub_step: Any = setting(
        default=None, convert=duration, doc="Longest integration step [s]."
    )
    drift: Any = setting(
        default=None,
        convert=_drift,
        doc="Drift due to motion of the conduit: time [s], b, kappa_eta, t0; None: no drift.",
    )
    undeclared: Any = setting(
        default=(),
        convert=_undeclared,
        core=False,
        doc="Effects that no controller knows: mappings of effect, source (input, proximal or "
        "distal), gain and, if the effect has them, shapes.",
    )
    seed: Any = setting(
        default=7,
        convert=_seeds,
        core=False,
        doc="Seed of the noise: one, from which each lane gets its own, or a list of one per lane.",
    )

    def _made(self, given: Mapping[str, Any]) -> dict[str, Any]:
        seed = _seeds("seed", given["seed"])
        lanes = len(seed) if given["lanes"] is None and isinstance(seed, list) else given["lanes"]
        return super()._made({**given, "lanes": lanes})

    @classmethod
    def _kept(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        return {"seed": values["seed"], "undeclared": values["undeclared"]}

    @classmethod
    def _start(cls, documents: list[str], kept: Mapping[str, Any]) -> _bowden.Rigs:
        seed, terms = kept["seed"], None
        if kept["undeclared"]:
            model = {
                "schema": "bowden.model/1",
                "mode": "torque",
                "channels": ["proximal", "distal"],
                "terms": kept["undeclared"],
            }
            terms = json.dumps(model)
        count = len(documents)
        own = seed if isinstance(seed, list) else [(seed + k) % 2**64 for k in range(count)]
        if len(own) != count:
            raise Error(f"seed: {len(own)} seeds for {count} rigs; one for each is allowed")
        return _bowden.Rigs(documents, terms, own)

    @property
    def settings(self) -> dict[str, Any]:
        """The settings by name, as the constructor accepts them: ``Rig(**rig.settings)``."""
        found = super().settings
        terms = found["undeclared"] or ()
        shown = [
            {**one, "shapes": {shape["name"]: shape["value"] for shape in one["shapes"]}}
            for one in terms
        ]
        return {**found, "undeclared": shown}

    def _named(
        self, signals: list[tuple[str, _numbers.Floats]], row: Optional[int]
    ) -> dict[str, Any]:
        def part(values: _numbers.Floats) -> Any:
            own = values if row is None else values[row]
            return own[..., 0] if self._alone else own

        found = {name: part(values) for name, values in signals}
        found["diverged"] = found["diverged"].astype(bool)
        if self._alone and row is not None:
            return {name: value.item() for name, value in found.items()}
        return found

    def sample(self) -> dict[str, Any]:
        """The current sample: the true torque (``tau_o``) and the sensor reading (``measured``)."""
        return self._named(self._native.sample(), 0)

    def step(self, command: Command, dt: Any = 0.001, load: Any = 0.0) -> dict[str, Any]:
        """Advances by ``dt`` [s], or by a duration with a unit, and returns the sample.

        ``command`` is in [command unit], or it is the result of a controller step. ``load`` is in
        [N·m]. With several lanes each argument has one value for each lane.
        """
        time = np.array([_numbers.duration("dt", dt)])
        return self._named(self._native.run(*self._signals(command, load, 1), time), 0)

    def run(self, commands: Command, dt: Any = 0.001, load: Any = 0.0) -> dict[str, Any]:
        """Runs many steps. The signals have the shape (samples,) or (samples, lanes).

        ``dt`` is one time or (samples,), in seconds or as durations with a unit.
        """
        samples = _numbers.samples_of(command_of(commands), dt, load)
        times = _numbers.along("dt", _numbers.seconds("dt", dt), samples)
        return self._named(self._native.run(*self._signals(commands, load, samples), times), None)

    def _signals(self, command: Any, load: Any, samples: int) -> list[_numbers.Floats]:
        lanes = len(self._native)
        both = {"command": command_of(command), "load": load}
        return [
            _numbers.spread(name, _numbers.numbers(name, own), samples, lanes)
            for name, own in both.items()
        ]

    def track(
        self,
        controller: Controller,
        reference: Any,
        dt: Any = 0.001,
        *,
        feed_forward: Any = 0.0,
        phase: Any = None,
    ) -> dict[str, Any]:
        """Runs the closed loop of each controller and its rig with one reference [N·m].

        ``dt`` is as in :meth:`run`. ``feed_forward`` [command unit] is added to each command.
        ``phase``, from 0 to 1, is the position of a sample in its cycle, for iterative learning.
        Each of these arguments is a number or (samples,).

        Returns the signals of the rig before each command, ``command``, ``status`` and ``fault``
        (numbers of :class:`Status` and :class:`Fault`), and ``error`` = tau_o - reference. The
        regressors of the adaptive law are velocity and acceleration of the proximal pulley.
        """
        if not isinstance(controller, Controller):
            kind = type(controller).__name__
            raise Error(f"controller: {kind}; PI, PID, PIV or Adaptive is allowed")
        wanted = np.ascontiguousarray(_numbers.numbers("reference", reference))
        if wanted.ndim != 1 or not len(wanted):
            raise Error(f"reference: shape {wanted.shape}; (samples,) is allowed")
        samples = len(wanted)
        more = {"feed_forward": feed_forward, "phase": controller._phase(phase)}
        both = [_numbers.along(n, _numbers.numbers(n, own), samples) for n, own in more.items()]
        times = _numbers.along("dt", _numbers.seconds("dt", dt), samples)
        signals, *codes = self._native.track(controller._native, wanted, *both, times)
        found = self._named(signals, None)
        found.update(zip(("command", "status", "fault"), map(self._rows, codes)))
        found["error"] = found["tau_o"] - (wanted if self._alone else wanted[:, None])
        return found


def paper_reference(t: Any, ramp: Any = 0.0) -> _numbers.Floats:
    """The reference [N·m] of Nguyen et al. (2018), section 4.2, at the times ``t`` [s].

    The reference rises smoothly within ``ramp`` [s].
    """
    rise = _numbers.finite("ramp", _numbers.duration("ramp", ramp))
    times = np.ascontiguousarray(_numbers.seconds("t", t))
    if times.ndim != 1:
        raise Error(f"t: shape {times.shape}; (samples,) is allowed")
    return _bowden.paper_reference(times, rise)
