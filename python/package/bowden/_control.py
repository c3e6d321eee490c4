"""Base class of all controllers."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _bowden, _numbers
from ._beside import DisturbanceObserver, IterativeLearning
from ._error import Error
from ._fields import Fields
from ._lanes import Changing, merged
from ._settings import GREATEST, count, duration, instance, pair, setting
from ._status import RunResult, StepResult, step_result

#: No safe command, in the core's form.
_HOLD = {"after": 2**32 - 1, "weight": 4, "command": None}
#: No limits, in the core's form.
_UNLIMITED = {"low": -GREATEST, "high": GREATEST, "slew": None}
_MOST_COUNT = 2**32 - 1


def limits_of(name: str, value: Any) -> dict[str, Any]:
    """Two numbers, the first one below the second."""
    found: dict[str, Any] = pair("low", "high")(name, value)
    if np.any(found["low"] >= found["high"]):
        raise Error(f"{name}={value!r}: (low, high) with low < high is allowed")
    return found


_APPLIED = ("as-commanded", "at-upper-limit", "at-lower-limit")


def _applied(what: Any) -> str:
    words = ", ".join(f'"{own}"' for own in _APPLIED)
    if isinstance(what, str):
        if what not in _APPLIED:
            raise Error(f"what={what!r}: a command, or one of {words}, is allowed")
        return json.dumps(what)
    command = _numbers.number("what", what, f"a command, or one of {words}, is allowed")
    return json.dumps({"command": command} if np.isfinite(command) else _APPLIED[0])


class Controller(Changing):
    """A torque controller with its state: :class:`PI`, :class:`PID`, :class:`PIV` or
    :class:`Adaptive`.

    If a setting is an array, there is one controller (lane) for each value. ``lanes`` is
    the number of controllers with the same settings. Times are in seconds, or durations with a
    unit.

    Each setting is also a read-only attribute. :meth:`bumpless_transfer` changes the settings of a
    running controller without a jump in the command.

    The defaults are for a simulation. Without ``limits`` any finite command is applied, and without
    ``fallback`` the last good command is held indefinitely. Without ``longest_dt`` any positive
    ``dt`` is good, except that the first-order adaptive law has its own limit. Set all
    three on a machine.

    The estimate of the ``observer`` and the feed-forward of ``learning`` are added to the command
    of each lane before its limits.

    ``copy.copy``, ``copy.deepcopy`` and ``pickle`` copy the settings and the state. If two threads
    use a controller, one thread waits while the other thread steps.
    """

    limits: Any = setting(
        default=None,
        convert=limits_of,
        core=False,
        doc="Range (low, high) of the command [command unit]; None: no limits.",
    )
    slew: Any = setting(
        default=None,
        core=False,
        doc="Slew-rate limit of the command [command unit/s], with limits; None: no limit.",
    )
    longest_dt: Any = setting(
        default=None,
        convert=duration,
        core=False,
        doc="Longest dt of a good sample [s]; None: no limit.",
    )
    fallback: Any = setting(
        default=None,
        convert=pair("after", "command", count(_MOST_COUNT)),
        core=False,
        doc="(number of consecutive bad samples, safe command [command unit]); None: the last "
        "good command is held indefinitely.",
    )
    fallback_weight: Any = setting(
        default=None,
        convert=count(_MOST_COUNT),
        core=False,
        doc="Number of good samples that cancel a bad one, with fallback; None: 4.",
    )
    observer: Any = setting(
        default=None,
        convert=instance(DisturbanceObserver),
        core=False,
        doc="A DisturbanceObserver.",
    )
    learning: Any = setting(default=None, convert=instance(IterativeLearning), core=False, doc="An IterativeLearning.")

    @classmethod
    def _kept(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        return {name: values[name] for name in ("observer", "learning")}

    @classmethod
    def _regressors(cls, documents: list[str]) -> Any:
        """The number of regressors; None for a law without regressors."""
        return None

    @classmethod
    def _start(cls, documents: list[str], kept: Mapping[str, Any]) -> _bowden.Controllers:
        observer, learning = kept["observer"], kept["learning"]
        return _bowden.Controllers(
            documents,
            cls._regressors(documents),
            None if observer is None else observer._document,
            None if learning is None else learning._native,
        )

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        limits, slew, weight = (values[n] for n in ("limits", "slew", "fallback_weight"))
        if slew is not None and limits is None:
            raise Error("slew: limits=(low, high) is needed with it")
        if weight is not None and values["fallback"] is None:
            raise Error("fallback_weight: fallback=(bad samples, safe command) is needed with it")
        longest = values["longest_dt"]
        more = {} if weight is None else {"weight": weight}
        return {
            **super()._to_core(values),
            "longest_dt": GREATEST if longest is None else longest,
            "limits": _UNLIMITED if limits is None else {**limits, "slew": slew},
            "fallback": _HOLD if values["fallback"] is None else {**values["fallback"], **more},
        }

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        limits, fallback, longest = core["limits"], core["fallback"], core["longest_dt"]
        limited, falls = limits != _UNLIMITED, fallback["command"] is not None
        return {
            **super()._from_core(core),
            "limits": (limits["low"], limits["high"]) if limited else None,
            "slew": limits["slew"],
            "longest_dt": None if longest == GREATEST else longest,
            "fallback": (fallback["after"], fallback["command"]) if falls else None,
            "fallback_weight": fallback["weight"] if falls else None,
        }

    def step(
        self,
        dt: Any,
        reference: Any,
        measured: Any,
        *,
        next_reference: Any = None,
        velocity: Any = 0.0,
        feed_forward: Any = 0.0,
        regressors: Sequence[Any] = (),
        phase: Any = None,
        learns: Any = True,
    ) -> StepResult:
        """Processes one sample and returns the command, the status and the fault.

        ``dt`` is the time since the last sample [s], or a duration with a unit. ``reference`` and
        ``measured`` are in [N·m]. PIV reads ``velocity`` [rad/s]. The adaptive law reads
        ``regressors``, each with one number or one for each lane. Iterative learning reads
        ``phase``, the position in the cycle from 0 to 1. Set ``learns`` to False if a limit
        changed the command, or during another task.

        A bad sample (NaN, or a ``dt`` that is not positive) does not raise an error. The command is
        then held, and the status and the fault report the bad input. A value that is not a number
        raises :class:`bowden.Error`.
        """
        following = reference if next_reference is None else next_reference
        more = (velocity, feed_forward, phase, learns)
        if self._alone:
            numbers = self._numbers(reference, following, measured, *more)
            own = [
                _numbers.number(f"regressors[{k}]", x) for k, x in enumerate(self._each(regressors))
            ]
            command, status, fault = self._native.step(_numbers.duration("dt", dt), numbers, own)
            return step_result(command, status, fault)
        _numbers.duration("dt", dt)
        found = self._run(dt, 1, reference, measured, following, *more, regressors)
        return StepResult(*(own[0] for own in found))

    def run(
        self,
        dt: Any,
        reference: Any,
        measured: Any,
        *,
        next_reference: Any = None,
        velocity: Any = 0.0,
        feed_forward: Any = 0.0,
        regressors: Sequence[Any] = (),
        phase: Any = None,
        learns: Any = True,
    ) -> RunResult:
        """Processes many samples.

        The commands, statuses and faults have the shape (samples,) or (samples, lanes). ``dt`` is
        one time or (samples,), in seconds or as durations with a unit. Each signal is a number,
        (samples,) for all lanes, or (samples, lanes). By default, the reference at the next sample
        is the next row of the reference. See :meth:`step` for the signals.
        """
        samples = _numbers.samples_of(dt, reference, measured)
        more = (velocity, feed_forward, phase, learns, regressors)
        return self._run(dt, samples, reference, measured, next_reference, *more)

    def _run(
        self,
        dt: Any,
        samples: int,
        reference: Any,
        measured: Any,
        next_reference: Any,
        velocity: Any,
        feed_forward: Any,
        phase: Any,
        learns: Any,
        regressors: Sequence[Any],
    ) -> RunResult:
        def signal(name: str, values: Any) -> _numbers.Floats:
            return _numbers.spread(name, _numbers.numbers(name, values), samples, len(self._native))

        wanted = signal("reference", reference)
        following = (
            np.concatenate([wanted[1:], wanted[-1:]])
            if next_reference is None
            else signal("next_reference", next_reference)
        )
        found = self._native.run(
            _numbers.along("dt", _numbers.seconds("dt", dt), samples),
            [
                wanted,
                following,
                signal("measured", measured),
                signal("velocity", velocity),
                signal("feed_forward", feed_forward),
                signal("phase", self._phase(phase)),
                _numbers.spread(
                    "learns", _numbers.flags("learns", learns), samples, len(self._native)
                ),
            ],
            [signal(f"regressors[{k}]", own) for k, own in enumerate(self._each(regressors))],
        )
        return RunResult(*map(self._rows, found))

    def _numbers(
        self,
        reference: Any,
        next_reference: Any,
        measured: Any,
        velocity: Any,
        feed_forward: Any,
        phase: Any,
        learns: Any,
    ) -> list[float]:
        number = _numbers.number
        return [
            number("reference", reference),
            number("next_reference", next_reference),
            number("measured", measured),
            number("velocity", velocity),
            number("feed_forward", feed_forward),
            number("phase", self._phase(phase)),
            float(learns) if isinstance(learns, bool) else float(_numbers.flag("learns", learns)),
        ]

    def _each(self, regressors: Any) -> Any:
        own = self._rest.get("regressors", 0)
        if isinstance(regressors, (str, Mapping)) or not hasattr(regressors, "__len__"):
            raise Error(f"regressors={regressors!r}: a sequence of {own} is allowed")
        if len(regressors) != own:
            raise Error(f"regressors: {len(regressors)} are given; {own} is the law's number")
        return regressors

    def _phase(self, phase: Any) -> Any:
        if (phase is None) != (self._rest["learning"] is None):
            raise Error("phase: allowed and needed with learning=…, and only there")
        return 0.0 if phase is None else phase

    def terms(self) -> Fields:
        """The terms of the last step: ``terms().integral`` or ``terms()["integral"]``.

        With several lanes each term is an array. After a bad sample, the terms of PI, PID and PIV
        are those of the last good sample. The terms of the adaptive law contain the estimates that
        the step used.
        """
        return Fields(merged([json.loads(text) for text in self._native.terms()]))

    def resume_from(
        self,
        output: Any,
        reference: Any,
        measured: Any,
        *,
        next_reference: Any = None,
        velocity: Any = 0.0,
        feed_forward: Any = 0.0,
        regressors: Sequence[Any] = (),
    ) -> StepResult:
        """Restarts so that the command continues from ``output`` [command unit] without a jump.

        Use this method for a transfer from another controller or from manual control. The other
        arguments are the sample at the transfer. The method has no effect while the safe command is
        latched.
        """
        lanes = len(self._native)

        def each(name: str, value: Any) -> list[float]:
            row = _numbers.spread(name, _numbers.numbers(name, value), 1, lanes)[0]
            return [float(one) for one in row]

        following = reference if next_reference is None else next_reference
        signals = [
            each("reference", reference),
            each("next_reference", following),
            each("measured", measured),
            each("velocity", velocity),
            each("feed_forward", feed_forward),
            [0.0] * lanes,
            [1.0] * lanes,
        ]
        own = [each(f"regressors[{k}]", x) for k, x in enumerate(self._each(regressors))]
        rows = [[signal[lane] for signal in own] for lane in range(lanes)]
        samples = [[signal[lane] for signal in signals] for lane in range(lanes)]
        return self._told(self._native.resume_from(each("output", output), samples, rows))

    def _told(self, lanes: list[tuple[float, int, int]]) -> StepResult:
        if self._alone:
            return step_result(*lanes[0])
        return StepResult(*(np.array(own) for own in zip(*lanes)))

    def applied(self, what: Any) -> None:
        """Reports the response of the drive to the last command. Call it between two steps.

        ``what`` is the applied command [command unit], ``"at-upper-limit"`` (the drive applied less
        than the command, by an unknown amount), ``"at-lower-limit"`` or ``"as-commanded"``. With
        several lanes, ``what`` is one value for all lanes, or a sequence with one value for each. A
        number that is not finite is ignored.

        The slew-rate limit, anti-windup and a bumpless start then continue from the applied
        command.
        """
        lanes = len(self._native)
        one = isinstance(what, str) or not np.ndim(what)
        each = [what] * lanes if one else list(what)
        if len(each) != lanes:
            raise Error(
                f"what: {len(each)} values; one, or one for each of {lanes} lanes, is allowed"
            )
        self._native.applied([_applied(own) for own in each])

    def acknowledge(self) -> None:
        """Acknowledges the fault. The next good sample closes the loop again."""
        self._native.acknowledge()

    def reset(self) -> None:
        """Resets all except the applied command, the fault counter and a latched safe command."""
        self._native.reset()

    def restore(self) -> None:
        """Prepares a stored state for a restart after a power-off, when no command is applied.

        The estimates of an adaptive law are kept. A latched safe command stays latched.
        """
        self._native.restore()

    @property
    def is_latched(self) -> Any:
        """Whether the safe command is latched until :meth:`acknowledge`."""
        return self._single(self._native.are_latched())

    @property
    def last(self) -> StepResult:
        """The applied command, with the status and the fault of the last sample."""
        return self._told(self._native.last())

    @property
    def command(self) -> Any:
        """The applied command [command unit]."""
        return self.last.command

    @property
    def status(self) -> Any:
        """The :class:`Status` of the last sample."""
        return self.last.status

    @property
    def fault(self) -> Any:
        """The :class:`Fault` of the last sample."""
        return self.last.fault

    @property
    def estimates(self) -> Any:
        """beta_hat, delta_hat and each theta_hat of an adaptive law; the integral of other laws."""
        all = self._native.estimates()
        return np.asarray(all[0] if self._alone else all)

    @property
    def disturbance(self) -> Any:
        """d_hat of the observer [command unit]; ``None`` without an observer."""
        all = self._native.disturbances()
        return all if all is None else all[0] if self._alone else np.asarray(all)

    @property
    def learned(self) -> Any:
        """The learned value of each cell [command unit], (cells,) or (lanes, cells).

        ``None`` without learning. Pass these values to ``IterativeLearning(…, learned=…)`` to
        continue learning.
        """
        all = self._native.learned()
        return all if all is None else np.asarray(all[0] if self._alone else all)
