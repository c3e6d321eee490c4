"""What goes beside a controller: a disturbance observer, and learning over a cycle."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from . import _bowden
from ._columns import unmasked, whole
from ._error import Error
from ._toml import document

_Floats = np.ndarray[Any, np.dtype[np.float64]]


class NominalPlant:
    """alpha/(s²/wn² + 2·zeta·s/wn + 1) from command to output.

    ``gain`` alpha [N·m/unit], ``natural_frequency`` wn [rad/s], ``damping_ratio`` zeta. Where they
    are uncertain, err low with the first two.
    """

    def __init__(self, gain: float, natural_frequency: float, damping_ratio: float) -> None:
        self._settings = {
            "gain": float(gain),
            "natural_frequency": float(natural_frequency),
            "damping_ratio": float(damping_ratio),
        }
        # Refuses what makes no sense.
        self.feed_forward(0.0)

    @classmethod
    def of_mechanics(
        cls, gain: float, inertia: float, damping: float, stiffness: float
    ) -> NominalPlant:
        """A motor with inertia [kg·m²] and damping [N·m·s/rad] against a stiffness [N·m/rad]."""
        if not (inertia > 0.0 and stiffness > 0.0):
            raise Error(f"inertia={inertia}, stiffness={stiffness}: both above zero were expected")
        frequency = float(np.sqrt(stiffness / inertia))
        return cls(gain, frequency, damping / (2.0 * float(np.sqrt(stiffness * inertia))))

    def feed_forward(self, output: Any, velocity: Any = 0.0, acceleration: Any = 0.0) -> Any:
        """The command [units] at which the plant's output moves so [N·m, N·m/s, N·m/s²].

        Numbers, or arrays of one shape.
        """
        given = [np.asarray(own, dtype=np.float64) for own in (output, velocity, acceleration)]
        try:
            wanted = np.broadcast_arrays(*given)
        except ValueError:
            shapes = ", ".join(str(own.shape) for own in given)
            raise Error(f"output, velocity, acceleration: one shape was expected, not {shapes}") from None
        flat = [np.ascontiguousarray(own).ravel() for own in wanted]
        found = _bowden.nominal_feed_forward(document(self._settings), flat)
        return found.reshape(wanted[0].shape) if wanted[0].ndim else float(found[0])

    def __repr__(self) -> str:
        return f"NominalPlant({', '.join(f'{k}={v!r}' for k, v in self._settings.items())})"


class DisturbanceObserver:
    """Compares what a command does with what the plant would do, and takes the rest out.

    ``time_constant`` tau of Q = 1/(tau·s + 1)² [s]; ``limit`` of the estimate [units]; ``latency``
    [s] after which a command shows in what is measured, beside the plant itself; ``longest_dt``
    [s], beyond which a sample is a bad one. Given to a controller (``PI(observer=…)``), which adds
    the estimate to its command; whether the loop is stable, ``bowden certify`` says for the rig's
    own numbers.
    """

    def __init__(
        self,
        plant: NominalPlant,
        time_constant: float,
        limit: float,
        *,
        latency: float = 0.0,
        longest_dt: Optional[float] = None,
    ) -> None:
        if not isinstance(plant, NominalPlant):
            raise Error(f"plant: a NominalPlant was expected, not {type(plant).__name__}")
        longest = np.finfo(np.float64).max if longest_dt is None else longest_dt
        self._document = document(
            {
                "plant": plant._settings,
                "time_constant": float(time_constant),
                "limit": float(limit),
                "longest_dt": float(longest),
                "latency": float(latency),
            }
        )
        _bowden.check_beside(self._document, None)


class Learning:
    """Learns from cycle to cycle what a task that repeats has lacked so far, and feeds it forward.

    ``gain`` [units/(N·m)] of the error; ``limit`` [units] of what is learned; ``cells`` a cycle is
    divided into; ``lead`` and ``half_width`` of the filter in cells; ``forgetting``, the share that
    is forgotten each time. ``learned`` is what another controller's ``learned`` was: it goes on from
    there. Given to a controller (``PI(learning=…)``), whose samples then have a ``phase``.
    """

    def __init__(
        self,
        gain: float,
        limit: float,
        *,
        cells: int,
        lead: int = 0,
        half_width: int = 0,
        forgetting: float = 0.0,
        learned: Any = None,
    ) -> None:
        expected = "a whole number from 0 to 65535 was expected"
        cells = whole("cells", cells, 0, 65_535, expected)
        first = np.zeros(cells) if learned is None else np.asarray(unmasked(learned), dtype=np.float64)
        if first.shape != (cells,):
            raise Error(f"learned: shape {first.shape}, {(cells,)} was expected")
        settings = {
            "gain": float(gain),
            "limit": float(limit),
            "lead": whole("lead", lead, 0, 65_535, expected),
            "half_width": whole("half_width", half_width, 0, 65_535, expected),
            "forgetting": float(forgetting),
        }
        self._native = (document(settings), first.tolist())
        _bowden.check_beside(None, self._native)
