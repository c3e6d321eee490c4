"""Additions to the command of a controller: disturbance observer and iterative learning."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _bowden, _numbers
from ._error import Error
from ._settings import GREATEST, Settings, instance, setting


def _real(name: str, value: Any) -> float:
    return _numbers.finite(name, _numbers.number(name, value))


def _time(name: str, value: Any) -> float:
    return _numbers.finite(name, _numbers.duration(name, value))


def _count(name: str, value: Any) -> int:
    return _numbers.whole(name, value, 0, 65_535, "a whole number from 0 to 65535 is allowed")


class NominalPlant(Settings):
    """Nominal plant alpha/(s²/wn² + 2·zeta·s/wn + 1) from command to output.

    If the gain and the natural frequency are uncertain, choose low values for both.
    """

    gain: float = setting(convert=_real, kw_only=False, doc="alpha [N·m/command unit].")
    natural_frequency: float = setting(convert=_real, kw_only=False, doc="wn [rad/s].")
    damping_ratio: float = setting(convert=_real, kw_only=False, doc="zeta.")

    def _made(self, given: Mapping[str, Any]) -> dict[str, Any]:
        settings = self._converted(given)
        document = json.dumps({k: v for k, v in settings.items() if v is not None})
        # Refuses what makes no sense.
        _bowden.nominal_feed_forward(document, [np.zeros(1)] * 3)
        return {"_settings": settings, "_document": document}

    @classmethod
    def of_mechanics(cls, gain: Any, inertia: Any, damping: Any, stiffness: Any) -> NominalPlant:
        """The plant of a motor: inertia [kg·m²], damping [N·m·s/rad], stiffness [N·m/rad]."""
        inertia, stiffness = _real("inertia", inertia), _real("stiffness", stiffness)
        damping = _real("damping", damping)
        if not (inertia > 0.0 and stiffness > 0.0):
            raise Error(f"inertia={inertia}, stiffness={stiffness}: numbers above zero are allowed")
        frequency = float(np.sqrt(stiffness / inertia))
        ratio = damping / (2.0 * float(np.sqrt(stiffness * inertia)))
        return cls(gain=gain, natural_frequency=frequency, damping_ratio=ratio)

    def feed_forward(self, output: Any, velocity: Any = 0.0, acceleration: Any = 0.0) -> Any:
        """The command [command unit] for which the output of the plant has this motion.

        The arguments, in [N·m], [N·m/s] and [N·m/s²], are numbers or arrays of the same shape.
        """
        named = {"output": output, "velocity": velocity, "acceleration": acceleration}
        given = [_numbers.numbers(name, own) for name, own in named.items()]
        try:
            wanted = np.broadcast_arrays(*given)
        except ValueError:
            shapes = ", ".join(str(own.shape) for own in given)
            raise Error(
                f"output, velocity, acceleration: shapes {shapes}; one is allowed"
            ) from None
        flat = [np.ascontiguousarray(own).ravel() for own in wanted]
        document: str = self.__dict__["_document"]
        found = _bowden.nominal_feed_forward(document, flat)
        return found.reshape(wanted[0].shape) if wanted[0].ndim else float(found[0])


class DisturbanceObserver(Settings):
    """Disturbance observer: estimates friction and load by comparison with the nominal plant.

    Pass the observer to a controller (``PI(observer=…)``), which adds the estimate to its command.
    ``bowden certify`` shows whether the loop is stable for plants near the reference rig.
    """

    plant: NominalPlant = setting(
        convert=instance(NominalPlant), kw_only=False, doc="Nominal plant, a NominalPlant."
    )
    time_constant: float = setting(
        convert=_time, kw_only=False, doc="tau of the filter Q = 1/(tau·s + 1)² [s]."
    )
    limit: float = setting(
        convert=_real, kw_only=False, doc="Largest magnitude of the estimate [command unit]."
    )
    latency: float = setting(
        default=0.0,
        convert=_time,
        doc="Delay from a command to the measured output, without the response of the nominal "
        "plant [s].",
    )
    longest_dt: Any = setting(
        default=None, convert=_time, doc="Longest dt of a good sample [s]; None: no limit."
    )

    def _made(self, given: Mapping[str, Any]) -> dict[str, Any]:
        settings = self._converted(given)
        longest, plant = settings["longest_dt"], settings["plant"]
        core = {
            **{k: v for k, v in settings.items() if v is not None},
            "longest_dt": GREATEST if longest is None else longest,
            "plant": None if plant is None else plant.settings,
        }
        document = json.dumps(core)
        _bowden.check_beside(document, None)
        return {"_settings": settings, "_document": document}


class IterativeLearning(Settings):
    """Learns a feed-forward from the error in earlier cycles of a repeating task.

    Pass this object to a controller (``PI(learning=…)``). Each sample then needs a ``phase``.
    """

    gain: float = setting(
        convert=_real, kw_only=False, doc="Learning gain [command unit/(N·m)]."
    )
    limit: float = setting(
        convert=_real, kw_only=False, doc="Largest magnitude of the learned values [command unit]."
    )
    cells: int = setting(convert=_count, doc="Number of cells in a cycle.")
    lead: int = setting(
        default=0, convert=_count, doc="Number of cells between a command and its effect."
    )
    half_width: int = setting(default=0, convert=_count, doc="Half-width of the filter [cells].")
    forgetting: float = setting(
        default=0.0, convert=_real, doc="Fraction that is forgotten per cycle, 0 to 1."
    )
    learned: Any = setting(
        default=None,
        convert=_numbers.numbers,
        doc="Initial learned values, such as `learned` of another controller; None: zeros.",
    )

    def _made(self, given: Mapping[str, Any]) -> dict[str, Any]:
        settings = self._converted(given)
        cells = settings["cells"]
        if cells is None:
            raise Error("cells: a whole number from 0 to 65535 is needed")
        learned = settings["learned"]
        first = np.zeros(cells) if learned is None else learned
        if first.shape != (cells,):
            raise Error(f"learned: shape {first.shape}; {(cells,)} is allowed")
        apart = ("cells", "learned")
        core = {k: v for k, v in settings.items() if k not in apart and v is not None}
        native = (json.dumps(core), first.tolist())
        _bowden.check_beside(None, native)
        return {"_settings": settings, "_native": native}
