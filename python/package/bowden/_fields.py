"""JSON objects whose keys are attributes."""

from __future__ import annotations

import keyword
from typing import Any, Iterator


class Fields:
    """A JSON object as a read-only mapping. Each key is an attribute (``from`` is ``from_``)."""

    __slots__ = ("_all",)

    def __init__(self, all: dict[str, Any]) -> None:
        self._all = all

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        key = name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name
        try:
            return wrapped(self._all[key])
        except KeyError:
            known = ", ".join(self._all)
            raise AttributeError(f"no {name!r} among {known}") from None

    def __getitem__(self, key: str) -> Any:
        return wrapped(self._all[key])

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __contains__(self, key: object) -> bool:
        return key in self._all

    def keys(self) -> Any:
        return self._all.keys()

    def to_dict(self) -> dict[str, Any]:
        """The object as plain dictionaries and lists."""
        return self._all

    def __dir__(self) -> list[str]:
        own = [key + "_" if keyword.iskeyword(key) else key for key in self._all]
        return sorted({*super().__dir__(), *own})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fields) and self._all == other._all

    def __getstate__(self) -> dict[str, Any]:
        return self._all

    def __setstate__(self, all: dict[str, Any]) -> None:
        self._all = all

    def __repr__(self) -> str:
        inside = ", ".join(f"{key}={wrapped(value)!r}" for key, value in self._all.items())
        return f"Fields({inside})"


def wrapped(value: Any) -> Any:
    """A JSON value whose objects are :class:`Fields`."""
    if isinstance(value, dict):
        return Fields(value)
    if isinstance(value, list):
        return [wrapped(one) for one in value]
    return value
