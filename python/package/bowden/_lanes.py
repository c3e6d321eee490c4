"""Objects with one or many lanes, and with a state that can be copied and stored."""

from __future__ import annotations

import json
import threading
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Optional, TypeVar

import numpy as np

from . import _numbers
from ._error import Error
from ._settings import Settings, setting

#: Schema of the stored form of a state.
SCHEMA = "bowden.state/1"

#: Guards settings from their reading to their writing.
_CHANGES = threading.Lock()

_L = TypeVar("_L", bound="Lanes")


def _number_of_lanes(name: str, value: Any) -> int:
    return _numbers.whole(name, value, 1, 2**31, "a whole number from 1 is allowed")


class Lanes(Settings):
    """Lanes that run side by side. Several threads may use them, but only one at a time."""

    lanes: Any = setting(
        default=None,
        convert=_number_of_lanes,
        core=False,
        doc="Number of lanes side by side; None: one, or one for each value of a setting that is "
        "an array. With several lanes, each argument and each result has one value for each lane.",
    )

    if TYPE_CHECKING:
        # Of each object; `ClassVar` tells type checkers that they are no settings.
        _native: ClassVar[Any]
        _alone: ClassVar[bool]
        _rest: ClassVar[dict[str, Any]]

    # Two that run are two, whatever their settings.
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def _made(self, given: Mapping[str, Any]) -> dict[str, Any]:
        values = self._converted(given)
        kept = self._kept(values)
        documents, alone = each_lane(self._to_core(values), values["lanes"])
        kept["lanes"] = None if alone else len(documents)
        try:
            native = self._start(documents, kept)
        except Error as error:
            raise Error(f"{type(self).__name__}: {error}") from None
        return {"_native": native, "_alone": alone, "_rest": kept}

    @classmethod
    def _kept(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        """The settings that the native module does not know."""
        return {}

    @classmethod
    def _start(cls, documents: list[str], kept: Mapping[str, Any]) -> Any:
        """The native object, from the settings of each lane."""
        raise NotImplementedError

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        """Settings in the form of the core."""
        own = {n: values[n] for n, s in cls._SETTINGS.items() if s.core}
        return {name.rstrip("_"): value for name, value in own.items() if value is not None}

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        """Settings of one lane, from the form of the core."""
        return {n: core.get(n.rstrip("_")) for n, s in cls._SETTINGS.items() if s.core}

    @property
    def settings(self) -> dict[str, Any]:
        """The settings by name, as the constructor accepts them: ``type(it)(**it.settings)``.

        With several lanes, a setting is one common value or an array with one value for each lane.
        """
        lanes = [self._from_core(json.loads(text)) for text in self._native.settings()]
        found = {**merged(lanes), **self._rest}
        return {name: found[name] for name in self._SETTINGS}

    @property
    def state(self) -> dict[str, Any]:
        """The whole state as numbers, lists and mappings, which JSON can store."""
        lanes = [json.loads(text) for text in self._native.states()]
        return {"schema": SCHEMA, "of": type(self).__name__, "lanes": lanes}

    def load_state(self, state: Mapping[str, Any]) -> None:
        """Continues from the :attr:`state` of an object with the same settings.

        Raises :class:`bowden.Error` if the class, the number of lanes or the number of regressors
        differs, or if these settings do not allow a number in the state. An error changes nothing.
        """
        own = type(self).__name__
        if not isinstance(state, Mapping) or state.get("schema") != SCHEMA:
            raise Error(f"state: a mapping of schema {SCHEMA!r} is allowed, as `.state` gives it")
        if state.get("of") != own:
            raise Error(f"state: of {state.get('of')!r}; a state of {own!r} is allowed")
        lanes = state.get("lanes")
        if not isinstance(lanes, list):
            raise Error("state: `lanes` is no list")
        try:
            self._native.load_state([json.dumps(one, allow_nan=False) for one in lanes])
        except (ValueError, TypeError) as error:
            raise Error(f"state: {error}") from None

    def restart(self) -> None:
        """Returns to the initial state, before the first sample."""
        self._native.restart()

    def _single(self, values: Any) -> Any:
        """The value of one lane, or an array with one value for each lane."""
        return values[0] if self._alone else np.asarray(values)

    def _rows(self, values: Any) -> Any:
        """The rows of one lane, or of all lanes."""
        return values[:, 0] if self._alone else values

    def __copy__(self: _L) -> _L:
        return _held(type(self), {**self.__dict__, "_native": self._native.copied()})

    def __deepcopy__(self: _L, memo: object) -> _L:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        native = self._native.copied()
        parts = (type(self), native.settings(), self._rest, self._alone, native.states())
        own = {k: v for k, v in self.__dict__.items() if k not in ("_native", "_alone", "_rest")}
        return (_restored, parts, own) if own else (_restored, parts)


class Changing(Lanes):
    """Lanes whose settings can change while they run."""

    _INSTEAD: ClassVar[str] = "bumpless_transfer({}=…) changes it without a jump of the command"

    def bumpless_transfer(self, **settings: Any) -> None:
        """Changes the given settings without a jump in the command (bumpless transfer).

        ``lanes``, ``observer``, ``learning`` and the number of regressors cannot change. An error
        changes nothing.
        """
        self._check_names(settings)
        for name in self._rest.keys() & settings.keys():
            raise Error(f"{name} cannot change while it runs: make another object with {name}=…")
        with _CHANGES:
            values = self._converted({**self.settings, **settings})
            if self._kept(values).get("regressors") != self._rest.get("regressors"):
                raise Error("theta: the number of regressors cannot change while it runs")
            documents, _ = each_lane(self._to_core(values), self.lanes)
            self._native.bumpless_transfer(documents)


def _held(cls: type[_L], parts: Mapping[str, Any]) -> _L:
    made = cls.__new__(cls)
    made._hold(parts)
    return made


def _restored(
    cls: type[_L], documents: list[str], kept: dict[str, Any], alone: bool, states: list[str]
) -> _L:
    native = cls._start(documents, kept)
    native.load_state(states)
    return _held(cls, {"_native": native, "_alone": alone, "_rest": kept})


def each_lane(settings: Mapping[str, Any], lanes: Optional[int]) -> tuple[list[str], bool]:
    """The settings of each lane as JSON, and whether there is only one lane."""
    lengths = {name: length for name, length in _lengths("", settings)}
    counts = set(lengths.values()) | ({lanes} if lanes is not None else set())
    if len(counts) > 1:
        told = ", ".join(f"{name}: {length}" for name, length in lengths.items())
        wanted = "" if lanes is None else f", lanes={lanes}"
        raise Error(f"settings of different numbers of lanes ({told}{wanted}); one is allowed")
    if 0 in counts:
        raise Error(
            f"{next(iter(lengths))}: shape (0,); a number, or one for each lane, is allowed"
        )
    if not counts:
        return [json.dumps(settings)], True
    return [json.dumps(_of_lane(settings, lane)) for lane in range(counts.pop())], False


def _lengths(name: str, value: Any) -> list[tuple[str, int]]:
    if isinstance(value, np.ndarray):
        return [(name, len(value))]
    if isinstance(value, Mapping):
        inside = [(f"{name}.{key}" if name else key, one) for key, one in value.items()]
    elif isinstance(value, list):
        inside = [(f"{name}[{k}]", one) for k, one in enumerate(value)]
    else:
        return []
    return [found for path, one in inside for found in _lengths(path, one)]


def _of_lane(value: Any, lane: int) -> Any:
    if isinstance(value, np.ndarray):
        return value[lane].item()
    if isinstance(value, Mapping):
        return {key: _of_lane(one, lane) for key, one in value.items()}
    return [_of_lane(one, lane) for one in value] if isinstance(value, list) else value


def merged(lanes: list[Any]) -> Any:
    """Merges the values of several lanes: each is one common value or an array of numbers."""
    first = lanes[0]
    if all(one == first for one in lanes):
        return first
    if isinstance(first, Mapping):
        return {key: merged([one[key] for one in lanes]) for key in first}
    if isinstance(first, (list, tuple)):
        return type(first)(merged(list(ones)) for ones in zip(*lanes))
    return np.array(lanes)
