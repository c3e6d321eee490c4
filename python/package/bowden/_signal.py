"""Signal conditioning that rejects bad samples."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from . import _bowden, _numbers
from ._error import Error
from ._lanes import Lanes
from ._settings import GREATEST, count, duration, one_of, real, setting
from ._status import Code, Fault


class RatesStatus(Code):
    """Validity of the motion from :class:`Rates`."""

    GOOD = 0
    #: A good sample, but the rates started from zero less than five time constants ago.
    SETTLING = 1
    #: A good position after an unknown time. The rates are held.
    RESUMED = 2
    #: A bad sample: the last good motion is held.
    HELD = 3


class EdgeStatus(Code):
    """Validity of a velocity from :class:`EdgeVelocity`."""

    GOOD = 0
    #: Fewer than two counts are known, or the time between them is unknown.
    SETTLING = 1
    #: No count for longer than ``longest_gap``, so the velocity is zero.
    STOPPED = 2
    #: A bad sample: the last velocity is held.
    HELD = 3


class Implausible(Code):
    """Reason why a sample is implausible. ``NONE`` is false."""

    NONE = 0
    NOT_FINITE = 1
    OUT_OF_RANGE = 2
    TOO_FAST = 3
    STUCK = 4
    OTHER = 5


class RatesResult(NamedTuple):
    """A motion. For many samples or lanes each field is an array."""

    position: Any
    velocity: Any
    acceleration: Any
    #: A :class:`RatesStatus`, or an array of its numbers.
    status: Any
    #: A :class:`Fault`, or an array of its numbers.
    fault: Any


class EdgeVelocityResult(NamedTuple):
    """A velocity. For many samples or lanes each field is an array."""

    #: Velocity [channel unit/s]; zero until two counts are known.
    velocity: Any
    #: An :class:`EdgeStatus`, or an array of its numbers.
    status: Any
    #: A :class:`Fault`, or an array of its numbers.
    fault: Any


class PlausibleResult(NamedTuple):
    """A checked sample. For many samples or lanes each field is an array."""

    #: The sample, or NaN if it is implausible.
    value: Any
    #: An :class:`Implausible`, or an array of its numbers.
    fault: Any


class Block(Lanes):
    """Base class of all blocks."""

    @classmethod
    def _start(cls, documents: list[str], kept: Mapping[str, Any]) -> _bowden.Blocks:
        return _bowden.Blocks(cls.__name__, documents)

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        own = super()._to_core(values)
        if "longest_dt" in cls._SETTINGS:
            own.setdefault("longest_dt", GREATEST)
        return {"block": own, "start": values.get("start", 0.0)}

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        found = super()._from_core(core["block"])
        if found.get("longest_dt") == GREATEST:
            found["longest_dt"] = None
        return {**found, "start": core["start"]}

    def _one(
        self, dt: Any, name: str, sample: Any, moves: Any = True
    ) -> tuple[list[Any], Any, Any]:
        """The signals of one sample, and the codes of status and fault."""
        _numbers.duration("dt", dt)
        signals, status, fault = self._many(dt, name, sample, moves, 1)
        first = [float(own[0]) if self._alone else own[0] for own in signals]
        return first, status[0], fault[0]

    def _many(
        self, dt: Any, name: str, samples: Any, moves: Any = True, count: int = 0
    ) -> tuple[list[Any], Any, Any]:
        """The signals of many samples, and the codes of status and fault."""
        if not count:
            count = _numbers.samples_of(dt, samples)
        lanes = len(self._native)
        signals, *codes = self._native.run(
            _numbers.along("dt", _numbers.seconds("dt", dt), count),
            _numbers.spread(name, _numbers.numbers(name, samples), count, lanes),
            _numbers.spread("moves", _numbers.flags("moves", moves), count, lanes),
        )
        status, fault = map(self._rows, codes)
        return [self._rows(own) for own in signals], status, fault


class Rates(Block):
    """Causal velocity and acceleration from position samples, with gaps and wrap-around.

    Well below the sampling rate, the transfer functions are ``V/X = s/(tau·s + 1)`` and
    ``A/X = s²/(tau·s + 1)²``.
    """

    time_constant: Any = setting(
        convert=duration,
        kw_only=False,
        doc="tau [s], the delay of the velocity and half the delay of the acceleration.",
    )
    longest_gap: Any = setting(
        default=None,
        convert=duration,
        core=False,
        doc="Longest gap between good samples that is bridged [s]; None: 10 time constants.",
    )
    period: Any = setting(
        default=None,
        doc="Period of a position that wraps [channel unit]; None: it does not wrap.",
    )

    @classmethod
    def for_cutoff(cls, cutoff: Any, **settings: Any) -> Rates:
        """Rates for a model fitted with this cut-off [Hz]: tau = 1/(2·pi·2.5·cutoff)."""
        corner = np.asarray(real("cutoff", cutoff)) * (2.0 * np.pi * 2.5)
        if not (corner > 0.0).all():
            raise Error(f"cutoff={cutoff}: a frequency above zero is allowed")
        return cls(time_constant=1.0 / corner, **settings)

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        found, tau, gap = super()._to_core(values), values["time_constant"], values["longest_gap"]
        if tau is not None:
            found["block"]["longest_gap"] = 10.0 * tau if gap is None else gap
        return found

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        return {**super()._from_core(core), "longest_gap": core["block"]["longest_gap"]}

    def step(self, dt: Any, position: Any) -> RatesResult:
        """Processes one ``position``, ``dt`` [s] (or a duration) after the previous one."""
        (x, v, a), status, fault = self._one(dt, "position", position)
        if self._alone:
            return RatesResult(x, v, a, RatesStatus(status), Fault(fault))
        return RatesResult(x, v, a, status, fault)

    def run(self, dt: Any, position: Any) -> RatesResult:
        """Processes (samples,) or (samples, lanes). ``dt`` is one time, or one time per sample."""
        (x, v, a), status, fault = self._many(dt, "position", position)
        return RatesResult(x, v, a, status, fault)


class EdgeVelocity(Block):
    """Velocity of a slow encoder from the time between its counts (period measurement).

    At a constant speed of f counts per second the relative error is at most f·dt/(1 − f·dt) while
    f·dt < 1. A speed below ``count/longest_gap`` is reported as zero.
    """

    count: Any = setting(
        kw_only=False, doc="Size of one count [channel unit], positive."
    )
    time_constant: Any = setting(
        convert=duration, kw_only=False, doc="Averaging time for counts at shorter intervals [s]."
    )
    longest_gap: Any = setting(
        convert=duration, kw_only=False, doc="Time without a count that means a stop [s]."
    )
    period: Any = setting(
        default=None,
        doc="Period of a position that wraps [channel unit]; None: it does not wrap.",
    )

    def step(self, dt: Any, position: Any) -> EdgeVelocityResult:
        """Processes one ``position``, ``dt`` [s] (or a duration) after the previous one."""
        (velocity, *_), status, fault = self._one(dt, "position", position)
        if self._alone:
            return EdgeVelocityResult(velocity, EdgeStatus(status), Fault(fault))
        return EdgeVelocityResult(velocity, status, fault)

    def run(self, dt: Any, position: Any) -> EdgeVelocityResult:
        """Processes (samples,) or (samples, lanes). ``dt`` is one time, or one time per sample."""
        (velocity, *_), status, fault = self._many(dt, "position", position)
        return EdgeVelocityResult(velocity, status, fault)


class _Filter(Block):
    """A block with one input and one output signal."""

    def step(self, dt: Any, sample: Any) -> Any:
        """Processes one sample, ``dt`` [s] (or a duration) after the previous one.

        A bad sample (NaN, or a ``dt`` that is not positive) leaves the output unchanged.
        """
        return self._one(dt, "sample", sample)[0][0]

    def run(self, dt: Any, sample: Any) -> Any:
        """Processes (samples,) or (samples, lanes). ``dt`` is one time, or one time per sample."""
        return self._many(dt, "sample", sample)[0][0]


class LowPass(_Filter):
    """First-order low-pass filter. At the first good sample, the filter starts in steady state."""

    time_constant: Any = setting(
        convert=duration, kw_only=False, doc="tau [s]; the corner frequency is 1/(2·pi·tau) [Hz]."
    )


class Biquad(_Filter):
    """Second-order low-pass or notch filter. It starts in steady state at the first good sample."""

    response: Any = setting(
        convert=one_of("low-pass", "notch"), kw_only=False, doc="Filter type, low-pass or notch."
    )
    frequency: Any = setting(
        kw_only=False,
        doc="Corner of a low-pass or centre of a notch [Hz], below half the sampling rate.",
    )
    q: Any = setting(
        kw_only=False,
        doc="Quality factor: 1/sqrt(2) for a Butterworth low-pass; notch width = frequency/q [Hz].",
    )
    sample_time: Any = setting(
        convert=duration, kw_only=False, doc="Nominal sampling period [s]."
    )


class Ramp(Block):
    """Shapes a reference with a rate limit and a lag that rounds the corners."""

    rate: Any = setting(kw_only=False, doc="Rate limit [signal unit/s], positive.")
    time_constant: Any = setting(
        default=0.0, kw_only=False, convert=duration, doc="Time constant of the lag [s]; 0: no lag."
    )
    longest_dt: Any = setting(
        default=None, convert=duration, doc="Longest dt that moves the reference [s]; None: any."
    )
    start: Any = setting(default=0.0, core=False, doc="Initial reference [signal unit].")

    def step(self, dt: Any, wanted: Any) -> Any:
        """Moves the reference towards ``wanted`` for the time ``dt`` [s] or a duration."""
        return self._one(dt, "wanted", wanted)[0][0]

    def run(self, dt: Any, wanted: Any) -> Any:
        """Processes (samples,) or (samples, lanes). ``dt`` is one time, or one time per sample."""
        return self._many(dt, "wanted", wanted)[0][0]


class Plausible(Block):
    """Plausibility check of sensor samples: range, rate and stuck value.

    Check each input of a controller. An implausible sample becomes NaN, and the controller then
    holds its command.
    """

    low: Any = setting(kw_only=False, doc="Lowest plausible value [signal unit].")
    high: Any = setting(kw_only=False, doc="Highest plausible value [signal unit].")
    rate: Any = setting(default=None, doc="Largest rate of change [signal unit/s]; None: no limit.")
    stuck_after: Any = setting(
        default=None,
        convert=count(2**32 - 1),
        doc="Number of repetitions of a reading, while the machine moves, that indicate a stuck "
        "sensor; 0 or None: no check.",
    )
    sample_period: Any = setting(
        default=None,
        convert=duration,
        doc="Longest time between two readings of the sensor [s], with rate; None: unknown.",
    )
    longest_dt: Any = setting(
        default=None,
        convert=duration,
        doc="A longer dt counts as this dt [s]; None: no limit.",
    )

    def step(self, dt: Any, sample: Any, moves: Any = True) -> PlausibleResult:
        """Checks a sample. Set ``moves`` while the machine moves and the signal must change."""
        (value, *_), _, fault = self._one(dt, "sample", sample, moves)
        return PlausibleResult(value, Implausible(fault) if self._alone else fault)

    def run(self, dt: Any, sample: Any, moves: Any = True) -> PlausibleResult:
        """Processes (samples,) or (samples, lanes). ``dt`` is one time, or one time per sample."""
        (value, *_), _, fault = self._many(dt, "sample", sample, moves)
        return PlausibleResult(value, fault)
