"""Settings: one line defines a keyword, an attribute, its documentation and its checks.

A class lists its settings as ``name: Any = setting(…)``. The native module stores the values in
the form of the core, and a read returns the value of the core. A setting cannot be assigned,
because the law would not notice the change.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Optional, TypeVar

import numpy as np

from . import _numbers
from ._error import CallError, Error, FrozenError

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_: Any) -> Callable[[Any], Any]:
        return lambda cls: cls


#: The largest float, which means no limit.
GREATEST = float(np.finfo(np.float64).max)

Convert = Callable[[str, Any], Any]


def real(name: str, value: Any) -> Any:
    """A finite number, or one for each lane."""
    return _each(name, _numbers.numbers(name, value, "a number, or one for each lane, is allowed"))


def duration(name: str, value: Any) -> Any:
    """A finite time in seconds, or one for each lane."""
    return _each(name, _numbers.seconds(name, value))


def _each(name: str, array: _numbers.Floats) -> Any:
    if array.ndim > 1:
        raise Error(f"{name}: shape {array.shape}; a number, or one for each lane, is allowed")
    if not np.isfinite(array).all():
        bad = array[~np.isfinite(array)].flat[0] if array.ndim else float(array)
        raise Error(f"{name}={bad}: finite numbers are allowed")
    return array if array.ndim else float(array)


def count(most: int) -> Convert:
    """A whole number, or one for each lane."""
    allowed = f"a whole number from 0 to {most} is allowed"

    def convert(name: str, value: Any) -> Any:
        if isinstance(value, np.ndarray) and value.ndim == 1:
            return np.array([_numbers.whole(name, one, 0, most, allowed) for one in value])
        return _numbers.whole(name, value, 0, most, allowed)

    return convert


def one_of(*names: str) -> Convert:
    """One of these words."""
    allowed = ", ".join(f'"{name}"' for name in names)

    def convert(name: str, value: Any) -> str:
        if not isinstance(value, str) or value not in names:
            raise Error(f"{name}={value!r}: one of {allowed} is allowed")
        return value

    return convert


def pair(low: str, high: str, first: Convert = real) -> Convert:
    """A pair of numbers with these names."""

    def convert(name: str, value: Any) -> dict[str, Any]:
        if isinstance(value, (str, Mapping)) or not isinstance(value, Sequence) or len(value) != 2:
            raise Error(f"{name}={value!r}: ({low}, {high}) is allowed")
        return {low: first(f"{name}[0]", value[0]), high: real(f"{name}[1]", value[1])}

    return convert


def instance(of: type) -> Convert:
    def convert(name: str, value: Any) -> Any:
        if not isinstance(value, of):
            raise Error(f"{name}: {type(value).__name__}; a {of.__name__} is allowed")
        return value

    return convert


class Setting:
    """The descriptor behind :func:`setting`."""

    def __init__(self, default: Any, doc: str, convert: Convert, kw_only: bool, core: bool):
        self.default, self.__doc__, self.convert = default, doc, convert
        self.kw_only, self.core, self.name = kw_only, core, ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: Any, owner: Optional[type] = None) -> Any:
        return self if instance is None else instance.settings[self.name]

    def __set__(self, instance: Any, value: Any) -> None:
        raise FrozenError(f"{self.name} cannot be assigned: {instance._INSTEAD.format(self.name)}")


def setting(
    *,
    default: Any = inspect.Parameter.empty,
    doc: str = "",
    convert: Convert = real,
    kw_only: bool = True,
    core: bool = True,
) -> Any:
    """A setting. A default of ``None`` means the default of the core. Without a default the setting
    is required. ``core=False`` is for a setting that the core stores in another form."""
    return Setting(default, doc, convert, kw_only, core)


_S = TypeVar("_S", bound="Settings")


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(setting,))
class Settings:
    """An immutable object made of settings."""

    _SETTINGS: ClassVar[dict[str, Setting]] = {}
    #: What to do instead of an assignment, with the name of the setting.
    _INSTEAD: ClassVar[str] = "make another object with {}=…"

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        # Of the first class first, a setting that a class states again at its old place.
        every: dict[str, Setting] = {}
        for base in reversed(cls.__mro__):
            every.update({k: v for k, v in vars(base).items() if isinstance(v, Setting)})
        cls._SETTINGS = every
        kinds = inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY
        all = sorted(every.values(), key=lambda own: own.kw_only)
        cls.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
            [inspect.Parameter(s.name, kinds[s.kw_only], default=s.default) for s in all]
        )
        lines = [f"    {s.name}\n        {s.__doc__}" for s in all]
        cls.__doc__ = "\n\n".join([(cls.__doc__ or "").rstrip(), "    Settings:", *lines])

    if not TYPE_CHECKING:

        def __init__(self, *args: Any, **given: Any) -> None:
            self._hold(self._made(self._given(args, given)))

    def _hold(self, parts: Mapping[str, Any]) -> None:
        """Sets attributes of this object itself."""
        self.__dict__.update(parts)

    @classmethod
    def _given(cls, args: Sequence[Any], given: Mapping[str, Any]) -> dict[str, Any]:
        """The given settings by name."""
        cls._check_names(given)
        places = [name for name, own in cls._SETTINGS.items() if not own.kw_only]
        if len(args) > len(places):
            raise CallError(
                f"{cls.__name__}: {len(args)} settings without a name; "
                f"only {', '.join(places) or 'none'} may come without"
            )
        found = dict(zip(places, args))
        twice = found.keys() & given.keys()
        if twice:
            raise CallError(f"{cls.__name__}: {twice.pop()} is given twice")
        every = {**{n: s.default for n, s in cls._SETTINGS.items()}, **found, **given}
        for name, value in every.items():
            if value is inspect.Parameter.empty:
                raise CallError(f"{cls.__name__}: {name} is needed")
        return every

    @classmethod
    def _check_names(cls, given: Mapping[str, Any]) -> None:
        for name in given:
            if name not in cls._SETTINGS:
                known = ", ".join(cls._SETTINGS)
                raise CallError(f"{cls.__name__}: no setting `{name}`; the settings are {known}")

    @classmethod
    def _converted(cls, given: Mapping[str, Any]) -> dict[str, Any]:
        every = cls._SETTINGS.items()
        return {
            n: None if given[n] is None and s.default is None else s.convert(n, given[n])
            for n, s in every
        }

    def _made(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """The parts of this object, made from its settings."""
        return {"_settings": self._converted(given)}

    @property
    def settings(self) -> dict[str, Any]:
        """The settings by name, as the constructor accepts them: ``type(it)(**it.settings)``."""
        return dict(self.__dict__["_settings"])

    if not TYPE_CHECKING:  # Without it a type checker refuses an assignment by itself.

        def __setattr__(self, name: str, value: Any) -> None:
            own = getattr(type(self), name, None)
            if own is None and not type(self).__module__.startswith("bowden."):
                # A class of the user's may have attributes of its own.
                self.__dict__[name] = value
                return
            if own is None:
                known = ", ".join(self._SETTINGS)
                raise FrozenError(f"no attribute `{name}` to assign; the settings are {known}")
            if isinstance(own, Setting):
                own.__set__(self, value)
            raise FrozenError(f"{name} can only be read")

        def __delattr__(self, name: str) -> None:
            raise FrozenError(f"{name} cannot be deleted")

    def __reduce__(self) -> tuple[Any, ...]:
        return _made_again, (type(self), self.settings)

    def __copy__(self: _S) -> _S:
        return self

    def __deepcopy__(self: _S, memo: object) -> _S:
        return self

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return False
        return all(np.array_equal(own, other.settings[n]) for n, own in self.settings.items())

    def __hash__(self) -> int:
        return hash((type(self), str(self)))

    def __repr__(self) -> str:
        given = self.settings.items()
        shown = [f"{name}={value!r}" for name, value in given if value is not None]
        return f"{type(self).__name__}({', '.join(shown)})"


def _made_again(cls: Any, settings: Mapping[str, Any]) -> Any:
    return cls(**settings)
