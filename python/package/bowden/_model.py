"""Models for firmware: load, save and run sample by sample."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, Optional, Union

import numpy as np

from . import _bowden
from ._columns import column_of_array, unmasked
from ._error import Error
from ._fields import Fields, wrapped
from ._numbers import positive_duration

_Path = Union[str, "os.PathLike[str]"]


class Model:
    """A model file of schema ``bowden.model/1``."""

    def __init__(self, toml: str, name: str = "(model)") -> None:
        self._native = _bowden.Model(toml)
        self._name = name

    @classmethod
    def load(cls, path: _Path) -> Model:
        """Reads a ``.toml`` from :meth:`save` or `bowden identify --model-out`."""
        name = os.fspath(path)
        try:
            with open(name, encoding="utf-8", newline="") as file:
                text = file.read()
        except FileNotFoundError:
            raise Error(f"{name}: no such file", file=name) from None
        except OSError as error:
            raise Error(f"{name}: cannot be read: {error.strerror}", file=name) from None
        except UnicodeDecodeError:
            raise Error(f"{name}: is no text; a TOML file is allowed", file=name) from None
        try:
            return cls(text, name)
        except Error as error:
            raise Error(f"{name}: {error}", file=name) from None

    def save(self, path: _Path) -> None:
        """Writes the model as ``.toml`` for tools, or ``.rs`` or ``.postcard`` for firmware."""
        name = os.fspath(path)
        ending = os.path.splitext(name)[1]
        if ending == ".toml":
            data = self._native.toml.encode()
        elif ending == ".rs":
            data = self._native.rust().encode()
        elif ending == ".postcard":
            data = self._native.postcard()
        else:
            raise Error(f"{name}: a name that ends in .toml, .rs or .postcard is allowed")
        with open(name, "wb") as file:
            file.write(data)

    @property
    def toml(self) -> str:
        """The model as the text of a ``.toml``."""
        return self._native.toml

    @property
    def name(self) -> str:
        """The file of the model, or its name."""
        return self._name

    @property
    def mode(self) -> str:
        """``torque`` or ``displacement``."""
        return self._native.mode

    @property
    def channels(self) -> list[str]:
        """Names of the channels that the model reads in addition to the input."""
        return self._native.channels

    def to_dict(self) -> dict[str, Any]:
        """The whole content of the model file."""
        found: dict[str, Any] = json.loads(self._native.json)
        return found

    @property
    def transmission(self) -> Optional[Fields]:
        """The Bouc-Wen transmission: gain, kappa_eta, offset, rho, sigma, n."""
        found = self.to_dict().get("transmission")
        return None if found is None else Fields(found)

    @property
    def terms(self) -> list[Fields]:
        """The effects, in order."""
        return list(wrapped(self.to_dict().get("terms", [])))

    def predict(
        self,
        t: Any = None,
        input: Any = None,
        channels: Optional[Mapping[str, Any]] = None,
        *,
        dt: Any = None,
        time_constant: Any = None,
        dtype: Any = np.float64,
    ) -> np.ndarray[Any, Any]:
        """Computes the output sample by sample as firmware does, starting from an initial state.

        ``input`` and each channel are arrays with shape (samples,) or (samples, 3). The three
        columns are position, velocity and acceleration. For (samples,), the causal filter `Rates`
        of the core computes velocity and acceleration with ``time_constant`` [s] (default: from the
        model file). Give either ``t`` or ``dt``. ``t`` is in seconds, or points in time as in
        :func:`bowden.identify`. ``dt`` is one sampling period [s], or a duration with a unit.
        ``dtype`` is the type in which the model runs, ``numpy.float64`` or ``numpy.float32``.
        """
        given = dict(channels or {})
        missing = [name for name in self.channels if name not in given]
        if missing:
            raise Error(f"channel `{missing[0]}`: the model reads it", column=missing[0])
        sources = [_motions("input", input)]
        sources += [_motions(name, given[name]) for name in self.channels]
        steps = _steps(t, dt, len(sources[0]))
        constant = (
            self._native.time_constant
            if time_constant is None
            else positive_duration("time_constant", time_constant)
        )
        if constant is None:
            if any(source.shape[1] == 1 for source in sources):
                raise Error("the model's file states no time constant: time_constant= is needed")
            constant = 1.0
        kind = np.dtype(dtype)
        if kind not in (np.dtype(np.float32), np.dtype(np.float64)):
            raise Error(f"dtype={kind}: float32 or float64 is allowed")
        single = kind == np.dtype(np.float32)
        answers = self._native.answers(steps, sources, float(constant), single)
        return answers.astype(kind, copy=False)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Model) and self.toml == other.toml

    def __hash__(self) -> int:
        return hash(self.toml)

    def __reduce__(self) -> tuple[type, tuple[str, str]]:
        return Model, (self.toml, self._name)

    def __repr__(self) -> str:
        effects = ", ".join(str(term.effect) for term in self.terms) or "no further effect"
        return f"<bowden.Model {self._name}: {self.mode} mode, {effects}>"


def _motions(name: str, array: Any) -> np.ndarray[Any, np.dtype[np.float64]]:
    values = np.asarray(unmasked(array))
    if values.ndim == 2 and values.shape[1] == 3 and values.dtype.kind in "fiu":
        return np.ascontiguousarray(values, dtype=np.float64)
    if values.ndim == 2:
        raise Error(f"column `{name}`: shape {values.shape}; (n,) or (n, 3) is allowed")
    _, unit, numbers = column_of_array(name, array, {})
    if unit is not None:
        raise Error(f"column `{name}`: values of {values.dtype}; numbers are allowed", column=name)
    return numbers.reshape(-1, 1)


def _steps(t: Any, dt: Any, samples: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    if (t is None) == (dt is None):
        raise Error("t and dt: exactly one of them is allowed")
    if t is None:
        return np.full(samples, positive_duration("dt", dt), dtype=np.float64)
    _, unit, time = column_of_array("t", t, {})
    if unit == "ns":
        time = time * 1e-9
    if len(time) != samples:
        raise Error(f"column `t`: {len(time)} values; {samples} are allowed", column="t")
    if not np.isfinite(time).all():
        row = int(np.argmin(np.isfinite(time)))
        raise Error(f"column `t`: t[{row}] = {time[row]}: no time", line=row + 1, column="t")
    steps = np.diff(time)
    if (steps <= 0.0).any():
        row = int(np.argmax(steps <= 0.0)) + 1
        raise Error(
            f"column `t`: t[{row}] = {time[row]} s is not after t[{row - 1}] = {time[row - 1]} s",
            line=row + 1,
            column="t",
        )
    first = np.median(steps) if len(steps) else 1.0
    return np.concatenate([[first], steps])
