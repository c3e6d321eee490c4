"""Controllers and the simulated rig, one or many side by side."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np

from . import _bowden
from ._beside import DisturbanceObserver, Learning
from ._columns import unmasked, whole
from ._error import Error
from ._toml import document

_Floats = np.ndarray[Any, np.dtype[np.float64]]

#: Without a limit: every float.
GREATEST = float(np.finfo(np.float64).max)
#: Without a safe command.
HOLD_FOR_EVER = {"after": 2**32 - 1}

#: What the numbers of :attr:`Controller.status` mean.
STATUS = ("good", "degraded", "held", "safe")


def _lanes(settings: Mapping[str, Any], lanes: Optional[int]) -> tuple[list[str], bool]:
    """The settings of each lane, and whether there is one alone: arrays give one lane each."""
    if lanes is not None:
        lanes = whole("lanes", lanes, 1, 2**31, "one or more were expected")
    arrays = {k: v for k, v in settings.items() if isinstance(v, np.ndarray) and v.ndim}
    lengths = {len(v) for v in arrays.values()} | ({lanes} if lanes is not None else set())
    if len(lengths) > 1 or any(v.ndim != 1 for v in arrays.values()):
        raise Error(f"settings of {sorted(lengths)} lanes: arrays of one length were expected")
    if 0 in lengths:
        raise Error("settings of no lane: arrays of one value or more were expected")
    alone = {k: (v.item() if isinstance(v, np.ndarray) and not v.ndim else v) for k, v in settings.items()}
    if not lengths:
        return [document(alone)], True
    count = lengths.pop()
    each = ({**alone, **{k: v[lane].item() for k, v in arrays.items()}} for lane in range(count))
    return [document(one) for one in each], False


class Controller:
    """A torque controller with its state: :class:`PI`, :class:`PID`, :class:`PIV`, :class:`Adaptive`.

    A setting that is an array makes one controller of each value, side by side; with ``lanes``
    there are as many of the same settings.

    As in a simulation, no setting is there that was not given: without ``limits`` any command goes
    out, without ``longest_dt`` [s] any positive ``dt`` is a good one, and without ``fallback``,
    ``(bad samples, safe command)``, the last good command is held for ever. A machine needs all
    three.

    What an ``observer`` estimates and what ``learning`` knows of a phase are added to the command
    before its limits, for each lane by itself. A status is ``degraded`` where the law had a good
    sample that one of these could not use.
    """

    def __init__(
        self,
        settings: Mapping[str, Any],
        regressors: Optional[int],
        lanes: Optional[int],
        observer: Optional[DisturbanceObserver] = None,
        learning: Optional[Learning] = None,
    ):
        texts, self._alone = _lanes(settings, lanes)
        if not isinstance(observer, (DisturbanceObserver, type(None))):
            raise Error(f"observer: a DisturbanceObserver was expected, not {type(observer).__name__}")
        if not isinstance(learning, (Learning, type(None))):
            raise Error(f"learning: a Learning was expected, not {type(learning).__name__}")
        self._native = _bowden.Controllers(
            texts,
            regressors,
            None if observer is None else observer._document,
            None if learning is None else learning._native,
        )
        self._learning = learning
        self._regressors = regressors or 0
        self._status: np.ndarray[Any, np.dtype[np.uint8]] = np.zeros(len(texts), dtype=np.uint8)

    @property
    def lanes(self) -> int:
        """Controllers side by side."""
        return len(self._native)

    def _signal(self, name: str, values: Any, samples: int) -> _Floats:
        shape = (samples, self.lanes)
        array = np.asarray(unmasked(values), dtype=np.float64)
        if array.ndim == 1 and array.shape[0] == samples and samples > 1:
            array = array[:, None]
        try:
            return np.ascontiguousarray(np.broadcast_to(array, shape))
        except ValueError:
            raise Error(f"{name}: shape {array.shape}, {shape} was expected") from None

    def run(
        self,
        dt: float,
        reference: Any,
        measured: Any,
        *,
        next_reference: Any = None,
        velocity: Any = 0.0,
        feed_forward: Any = 0.0,
        regressors: Sequence[Any] = (),
        phase: Any = None,
        learns: Any = True,
    ) -> Any:
        """Many samples: commands of shape (samples,), or (samples, lanes) of several lanes.

        Each signal is a number, (samples,) for all lanes, or (samples, lanes). The reference at
        the next sample is the next row of the reference unless it is given. ``phase`` from 0 to 1
        and ``learns`` are for learning: see :meth:`step`.
        """
        sizes = [np.shape(s)[0] for s in (reference, measured) if np.ndim(s)]
        samples = max(sizes, default=1)
        more = (velocity, feed_forward, phase, learns, regressors)
        return self._run(dt, samples, reference, measured, next_reference, *more)

    def step(
        self,
        dt: float,
        reference: Any,
        measured: Any,
        *,
        next_reference: Any = None,
        velocity: Any = 0.0,
        feed_forward: Any = 0.0,
        regressors: Sequence[Any] = (),
        phase: Any = None,
        learns: Any = True,
    ) -> Any:
        """One sample: the command, of several lanes one for each.

        ``dt`` [s]; ``reference``, ``measured`` [N·m]; ``velocity`` [rad/s] for PIV;
        ``regressors`` one number (or one for each lane) each, for the adaptive law; ``phase`` where
        in its cycle a sample is, from 0 to 1, for learning, and ``learns`` whether it is learned
        from (not where a limit cut the command, nor during another task). A bad sample
        raises nothing: the command is held, and :attr:`status` says so.
        """
        following = reference if next_reference is None else next_reference
        more = (velocity, feed_forward, phase, learns, regressors)
        commands = self._run(dt, 1, reference, measured, following, *more)
        return float(commands[0]) if self._alone else commands[0]

    def _run(
        self,
        dt: float,
        samples: int,
        reference: Any,
        measured: Any,
        next_reference: Any,
        velocity: Any,
        feed_forward: Any,
        phase: Any,
        learns: Any,
        regressors: Sequence[Any],
    ) -> Any:
        if len(regressors) != self._regressors:
            raise Error(f"regressors: {len(regressors)}; {self._regressors} were expected")
        wanted = self._signal("reference", reference, samples)
        following = (
            np.concatenate([wanted[1:], wanted[-1:]])
            if next_reference is None
            else self._signal("next_reference", next_reference, samples)
        )
        commands, status = self._native.run(
            np.full(samples, dt, dtype=np.float64),
            wanted,
            following,
            self._signal("measured", measured, samples),
            self._signal("velocity", velocity, samples),
            self._signal("feed_forward", feed_forward, samples),
            self._signal("phase", self._phase(phase), samples),
            self._signal("learns", learns, samples),
            [self._signal(f"regressors[{k}]", own, samples) for k, own in enumerate(regressors)],
        )
        self._status = status[-1]
        return commands[:, 0] if self._alone else commands

    def _phase(self, phase: Any) -> Any:
        if (phase is None) != (self._learning is None):
            raise Error("phase: one was expected beside learning, and only there")
        return 0.0 if phase is None else phase

    def restart(self) -> None:
        """Back to a state that has seen no sample, and has learned nothing from one."""
        self._native.restart()
        self._status = np.zeros(self.lanes, dtype=np.uint8)

    def acknowledge(self) -> None:
        """Takes note of a safe command: the next good sample closes the loop again."""
        self._native.acknowledge()

    @property
    def status(self) -> Any:
        """Of the last sample: ``good``, ``degraded``, ``held`` or ``safe``; a list of several lanes."""
        names = [STATUS[int(code)] for code in self._status]
        return names[0] if self._alone else names

    @property
    def command(self) -> Any:
        """The command that is out."""
        commands = self._native.commands()
        return commands[0] if self._alone else np.asarray(commands)

    @property
    def estimates(self) -> Any:
        """beta_hat, delta_hat and each theta_hat of an adaptive law; the integral of another."""
        all = self._native.estimates()
        return np.asarray(all[0] if self._alone else all)

    @property
    def disturbance(self) -> Any:
        """d_hat of the observer, which is added to the command [units]; ``None`` without one."""
        all = self._native.disturbances()
        return all if all is None else all[0] if self._alone else np.asarray(all)

    @property
    def learned(self) -> Any:
        """What each cell of a cycle has learned [units], (cells,) or (lanes, cells); ``None``
        without learning. ``Learning(…, learned=…)`` goes on from it."""
        all = self._native.learned()
        return all if all is None else np.asarray(all[0] if self._alone else all)


def _shared(
    limits: Optional[tuple[float, float]],
    slew: Optional[float],
    longest_dt: Any,
    fallback: Optional[tuple[int, float]],
) -> dict[str, Any]:
    if slew is not None and limits is None:
        raise Error("slew: limits=(low, high) were expected beside it")
    return {
        "longest_dt": GREATEST if longest_dt is None else longest_dt,
        "limits": {"low": -GREATEST, "high": GREATEST}
        if limits is None
        else {"low": float(limits[0]), "high": float(limits[1]), "slew": slew},
        "fallback": HOLD_FOR_EVER
        if fallback is None
        else {"after": int(fallback[0]), "weight": 4, "command": float(fallback[1])},
    }


class PI(Controller):
    """PI (15); with ``lanes`` or arrays of gains several side by side. Gains as in Table 1.

    No limits, longest ``dt`` or fallback unless they are given: see :class:`Controller`.
    """

    def __init__(
        self,
        k_p: Any = 30.0,
        k_i: Any = 18.0,
        *,
        setpoint_weight: Any = None,
        limits: Optional[tuple[float, float]] = None,
        slew: Optional[float] = None,
        longest_dt: Any = None,
        fallback: Optional[tuple[int, float]] = None,
        observer: Optional[DisturbanceObserver] = None,
        learning: Optional[Learning] = None,
        lanes: Optional[int] = None,
    ) -> None:
        settings = {"k_p": k_p, "k_i": k_i, "setpoint_weight": setpoint_weight}
        shared = _shared(limits, slew, longest_dt, fallback)
        super().__init__({**settings, **shared}, None, lanes, observer, learning)


class PID(Controller):
    """PID (14): the derivative is filtered over ``derivative_time`` [s]."""

    def __init__(
        self,
        k_p: Any = 30.0,
        k_i: Any = 18.0,
        k_d: Any = 2.0,
        derivative_time: Any = 0.1,
        *,
        derivative_weight: float = 1.0,
        setpoint_weight: Any = None,
        limits: Optional[tuple[float, float]] = None,
        slew: Optional[float] = None,
        longest_dt: Any = None,
        fallback: Optional[tuple[int, float]] = None,
        observer: Optional[DisturbanceObserver] = None,
        learning: Optional[Learning] = None,
        lanes: Optional[int] = None,
    ) -> None:
        settings = {
            "k_p": k_p,
            "k_i": k_i,
            "k_d": k_d,
            "derivative_time": derivative_time,
            "damping": {"rate": {"weight": float(derivative_weight)}},
            "setpoint_weight": setpoint_weight,
        }
        shared = _shared(limits, slew, longest_dt, fallback)
        super().__init__({**settings, **shared}, None, lanes, observer, learning)


class PIV(Controller):
    """PIV (16): ``k_d`` on the measured distal velocity."""

    def __init__(
        self,
        k_p: Any = 30.0,
        k_i: Any = 18.0,
        k_d: Any = 10.0,
        *,
        setpoint_weight: Any = None,
        limits: Optional[tuple[float, float]] = None,
        slew: Optional[float] = None,
        longest_dt: Any = None,
        fallback: Optional[tuple[int, float]] = None,
        observer: Optional[DisturbanceObserver] = None,
        learning: Optional[Learning] = None,
        lanes: Optional[int] = None,
    ) -> None:
        settings = {
            "k_p": k_p,
            "k_i": k_i,
            "k_d": k_d,
            "damping": "velocity",
            "setpoint_weight": setpoint_weight,
        }
        shared = _shared(limits, slew, longest_dt, fallback)
        super().__init__({**settings, **shared}, None, lanes, observer, learning)


class Adaptive(Controller):
    """The robust adaptive law (17)-(26), by default with the numbers of Table 2.

    ``form`` is ``("literal", time_constant)`` or ``("lag", step, plant_gain)``; an estimate is a
    mapping of ``initial``, ``low``, ``high``, ``gain``, ``leakage`` [1/s] and ``prior``.
    """

    #: Estimates of Table 2: lambda times the gains is what the paper states.
    BETA: Mapping[str, float] = {"initial": 0.0, "gain": 0.002 / 8.0, "leakage": 0.01}
    DELTA: Mapping[str, float] = {"initial": 7.0, "gain": 0.05 / 8.0, "leakage": 0.01}
    THETA: Sequence[Mapping[str, float]] = ({"initial": 0.0, "gain": 0.004 / 8.0, "leakage": 0.01},) * 2

    def __init__(
        self,
        gain: Any = 24.0,
        lambda_: Any = 8.0,
        epsilon: Any = 0.05,
        *,
        form: tuple[Any, ...] = ("literal", 0.005),
        beta: Mapping[str, float] = BETA,
        delta: Mapping[str, float] = DELTA,
        theta: Sequence[Mapping[str, float]] = THETA,
        z_limit: Any = None,
        frozen: bool = False,
        limits: Optional[tuple[float, float]] = None,
        slew: Optional[float] = None,
        longest_dt: Any = None,
        fallback: Optional[tuple[int, float]] = None,
        observer: Optional[DisturbanceObserver] = None,
        learning: Optional[Learning] = None,
        lanes: Optional[int] = None,
    ) -> None:
        settings = {
            "form": _form(form),
            "gain": gain,
            "lambda": lambda_,
            "epsilon": epsilon,
            "beta": _estimator(beta),
            "delta": _estimator(delta),
            "theta": [_estimator(one) for one in theta],
            "z_limit": z_limit,
            "frozen": bool(frozen),
        }
        shared = _shared(limits, slew, longest_dt, fallback)
        super().__init__({**settings, **shared}, len(theta), lanes, observer, learning)


def _form(form: tuple[Any, ...]) -> dict[str, Any]:
    kind, *numbers = form
    if kind == "literal" and len(numbers) == 1:
        return {"literal": {"time_constant": float(numbers[0])}}
    if kind == "lag" and len(numbers) == 2:
        return {"lag": {"step": float(numbers[0]), "plant_gain": float(numbers[1])}}
    raise Error(f'form={form!r}: ("literal", time_constant) or ("lag", step, plant_gain) was expected')


def _estimator(one: Mapping[str, float]) -> dict[str, Any]:
    settings: dict[str, Any] = {key: float(value) for key, value in one.items()}
    leakage = settings.pop("leakage", 0.0)
    if leakage:
        settings["leakage"] = {"constant": {"rate": leakage}}
    return {"low": -GREATEST, "high": GREATEST, **settings}


class Rig:
    """The simulated rig: motor, cable, joint against its spring, sensors; one or many.

    Any field of the rig's configuration may be given; an array makes one rig of each value.
    ``undeclared`` are effects that no controller knows of: mappings of ``effect``, ``source``
    (``input``, ``proximal`` or ``distal``), ``gain`` and, where the effect has them, ``shapes``.
    """

    def __init__(
        self,
        *,
        undeclared: Sequence[Mapping[str, Any]] = (),
        seed: Union[int, Sequence[int]] = 7,
        lanes: Optional[int] = None,
        **config: Any,
    ) -> None:
        seeds = None if isinstance(seed, (int, np.integer)) else [_seed(one) for one in seed]
        if seeds is not None and lanes is None:
            lanes = len(seeds)
        texts, self._alone = _lanes(config, lanes)
        terms = None
        if undeclared:
            terms = document(
                {
                    "schema": "bowden.model/1",
                    "mode": "torque",
                    "channels": ["proximal", "distal"],
                    "terms": [_term(one) for one in undeclared],
                }
            )
        own = seeds if seeds is not None else [(_seed(seed) + k) % 2**64 for k in range(len(texts))]
        if len(own) != len(texts):
            raise Error(f"seed: {len(own)} of {len(texts)} rigs")
        self._native = _bowden.Rigs(texts, terms, own)

    @property
    def lanes(self) -> int:
        """Rigs side by side."""
        return len(self._native)

    def _named(self, signals: list[tuple[str, _Floats]], row: Optional[int]) -> dict[str, Any]:
        def part(values: _Floats) -> Any:
            own = values if row is None else values[row]
            return own[..., 0] if self._alone else own

        found = {name: part(values) for name, values in signals}
        found["diverged"] = found["diverged"].astype(bool)
        if self._alone and row is not None:
            return {name: value.item() for name, value in found.items()}
        return found

    def restart(self) -> None:
        """At rest, with the same seeds."""
        self._native.restart()

    def sample(self) -> dict[str, Any]:
        """What is read off now: the truth (``tau_o``) beside what the sensor tells (``measured``)."""
        return self._named(self._native.sample(), 0)

    def step(self, command: Any, dt: float = 0.001, load: Any = 0.0) -> dict[str, Any]:
        """One step of ``dt`` [s]: what is read off after it; arrays of several lanes."""
        shape = (1, self.lanes)
        both = [np.ascontiguousarray(np.broadcast_to(np.asarray(v, float), shape)) for v in (command, load)]
        return self._named(self._native.run(both[0], both[1], float(dt)), 0)

    def run(self, commands: Any, dt: float = 0.001, load: Any = 0.0) -> dict[str, Any]:
        """Many steps: signals of shape (samples,), or (samples, lanes) of several lanes."""
        given = np.asarray(commands, dtype=np.float64)
        given = given[:, None] if given.ndim == 1 else given
        shape = (given.shape[0], self.lanes)
        loads = np.asarray(load, dtype=np.float64)
        loads = loads[:, None] if loads.ndim == 1 and len(loads) == shape[0] else loads
        both = [np.ascontiguousarray(np.broadcast_to(v, shape)) for v in (given, loads)]
        return self._named(self._native.run(both[0], both[1], float(dt)), None)

    def track(
        self,
        controller: Controller,
        reference: Any,
        dt: float = 0.001,
        *,
        feed_forward: Any = 0.0,
        phase: Any = None,
    ) -> dict[str, Any]:
        """The closed loop: each controller on its rig, all on one reference [N·m].

        ``feed_forward`` [units] is added to each command; ``phase``, from 0 to 1, is where in its
        cycle a sample is, for learning. Each is a number or (samples,).

        Gives what was read off before each command, ``command``, ``status`` (places in
        :data:`STATUS`) and ``error`` = tau_o - reference. The adaptive law's regressors are
        velocity and acceleration of the proximal pulley.
        """
        wanted = np.ascontiguousarray(reference, dtype=np.float64)
        if wanted.ndim != 1 or not len(wanted):
            raise Error(f"reference: shape {wanted.shape}, (samples,) was expected")
        more = {"feed_forward": feed_forward, "phase": controller._phase(phase)}
        feeds = {name: np.asarray(unmasked(own), dtype=np.float64) for name, own in more.items()}
        for name, own in feeds.items():
            if own.shape not in ((), wanted.shape):
                raise Error(f"{name}: shape {own.shape}, {wanted.shape} was expected")
        both = [np.ascontiguousarray(np.broadcast_to(own, wanted.shape)) for own in feeds.values()]
        native = controller._native
        signals, commands, status = self._native.track(native, wanted, both[0], both[1], float(dt))
        controller._status = status[-1]
        found = self._named(signals, None)
        found["command"] = commands[:, 0] if self._alone else commands
        found["status"] = status[:, 0] if self._alone else status
        found["error"] = found["tau_o"] - (wanted if self._alone else wanted[:, None])
        return found


def _seed(seed: Any) -> int:
    return whole("seed", seed, 0, 2**64 - 1, "whole numbers from 0 to 2**64 - 1 were expected")


def _term(one: Mapping[str, Any]) -> dict[str, Any]:
    shapes = [{"name": name, "value": float(v)} for name, v in one.get("shapes", {}).items()]
    numbers = {k: float(v) for k, v in one.items() if k in ("gain", "origin")}
    rest = {k: v for k, v in one.items() if k not in ("gain", "origin", "shapes")}
    return {"source": "input", **rest, **numbers, "shapes": shapes}


def paper_reference(t: Any, ramp: float = 0.0) -> _Floats:
    """The paper's reference [N·m] (section 4.2) at times [s], rising smoothly in ``ramp`` [s]."""
    if not math.isfinite(ramp):
        raise Error(f"ramp={ramp}: seconds were expected")
    return _bowden.paper_reference(np.ascontiguousarray(t, dtype=np.float64), float(ramp))
