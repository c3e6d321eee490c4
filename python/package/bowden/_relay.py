"""The relay experiment: PI gains from a limit cycle of the closed loop."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, NamedTuple, Optional

import numpy as np

from . import _bowden
from ._control import limits_of
from ._error import Error
from ._fields import Fields
from ._settings import count, duration, pair, setting
from ._signal import Block
from ._status import Code, Fault

_MOST_COUNT = 2**32 - 1
_RULES = ("tyreus-luyben", "ziegler-nichols")
_RESULT = ("gain", "period", "amplitude", "duty")


class RelayPhase(Code):
    """Phase of a :class:`Relay`. A number above ``DONE`` is a failure."""

    RUNNING = 0
    #: A bad sample: the last command is held.
    HELD = 1
    #: The experiment has succeeded. The command is the centre.
    DONE = 2
    #: Too many bad samples. After a failure the safe command is applied.
    BAD_SAMPLES = 3
    #: The distance of the output from the reference exceeded ``most_deviation``.
    OUTPUT_OUT_OF_RANGE = 4
    #: There was no complete cycle within ``longest_time``.
    NO_OSCILLATION = 5
    #: The cycles did not agree within ``longest_time``.
    TIME_OUT = 6
    OTHER = 7


class RelayResult(NamedTuple):
    """Result of a step. For many samples or lanes each field is an array."""

    #: The command for the drive [command unit].
    command: Any
    #: A :class:`RelayPhase`, or an array of its numbers.
    phase: Any
    #: A :class:`Fault`, or an array of its numbers.
    fault: Any


class Relay(Block):
    """A relay experiment: the loop oscillates, and the relay measures ultimate gain and period.

    Start with the output near the reference. Step the relay instead of the controller until its
    phase is ``DONE`` or a failure. After ``DONE``, :meth:`pi` returns the gains. After a failure,
    the safe command is applied until :meth:`acknowledge`.
    """

    reference: Any = setting(doc="Reference about which the output oscillates [output unit].")
    centre: Any = setting(doc="Mean of the two command levels [command unit].")
    amplitude: Any = setting(
        doc="Distance from the centre to each level [command unit], with the sign of the plant "
        "gain."
    )
    hysteresis: Any = setting(
        doc="Hysteresis of the relay [output unit], at least the peak of the noise."
    )
    most_deviation: Any = setting(
        doc="Largest distance of the output from the reference [output unit], above hysteresis."
    )
    cycles: Any = setting(
        default=4,
        convert=count(_MOST_COUNT),
        doc="Number of consecutive cycles in the average, at least 2.",
    )
    agreement: Any = setting(
        default=0.05,
        doc="Largest relative deviation of a cycle from the mean of earlier ones, 0 to 1.",
    )
    longest_time: Any = setting(
        convert=duration, doc="Maximum duration of the experiment [s]."
    )
    longest_dt: Any = setting(convert=duration, doc="Longest dt of a good sample [s].")
    limits: Any = setting(
        convert=limits_of, core=False, doc="Range (low, high) of the command [command unit]."
    )
    fallback: Any = setting(
        convert=pair("after", "command", count(_MOST_COUNT)),
        core=False,
        doc="(number of consecutive bad samples, safe command [command unit]).",
    )

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        found = super()._to_core(values)
        found["block"].update(
            limits={**values["limits"], "slew": None}, fallback=values["fallback"]
        )
        return found

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        limits, fallback = core["block"]["limits"], core["block"]["fallback"]
        return {
            **super()._from_core(core),
            "limits": (limits["low"], limits["high"]),
            "fallback": (fallback["after"], fallback["command"]),
        }

    def step(self, dt: Any, measured: Any) -> RelayResult:
        """Processes one output sample, ``dt`` [s] (or a duration) after the previous one."""
        (command, *_), phase, fault = self._one(dt, "measured", measured)
        if self._alone:
            return RelayResult(command, RelayPhase(phase), Fault(fault))
        return RelayResult(command, phase, fault)

    def run(self, dt: Any, measured: Any) -> RelayResult:
        """Processes (samples,) or (samples, lanes). ``dt`` is one time, or one time per sample."""
        (command, *_), phase, fault = self._many(dt, "measured", measured)
        return RelayResult(command, phase, fault)

    def acknowledge(self) -> None:
        """Acknowledges a failure. The next good sample restarts the experiment."""
        self._native.acknowledge()

    @property
    def ultimate(self) -> Optional[Fields]:
        """Gain, period [s], amplitude [output unit] and duty; None without a result.

        With several lanes each field is an array, with NaN for a lane without a result.
        """
        found = self._results()
        if self._alone:
            return None if found[0] is None else Fields(found[0])
        lost = dict.fromkeys(_RESULT, np.nan)
        return Fields({name: np.array([(one or lost)[name] for one in found]) for name in _RESULT})

    def pi(self, rule: str = "tyreus-luyben") -> Fields:
        """k_p and k_i of a PI: ``bowden.PI(**relay.pi())``.

        ``rule`` is "tyreus-luyben" (conservative) or "ziegler-nichols" (fast). Without a result the
        method raises :class:`bowden.Error`.
        """
        if rule not in _RULES:
            words = ", ".join(f'"{own}"' for own in _RULES)
            raise Error(f"rule={rule!r}: one of {words} is allowed")
        found = self._results()
        if None in found:
            raise Error("pi: the experiment has no result; it is allowed at phase DONE")
        gains = [_bowden.pi_gains(json.dumps(one), json.dumps(rule)) for one in found]
        k_p, k_i = zip(*gains)
        return Fields({"k_p": self._single(k_p), "k_i": self._single(k_i)})

    def _results(self) -> list[Any]:
        return [json.loads(text)["result"] for text in self._native.states()]
