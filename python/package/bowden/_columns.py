"""Arrays and frames as columns of numbers."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Optional

import numpy as np

from ._error import Error

#: A column for the native half: name, unit, values.
Column = tuple[str, Optional[str], "np.ndarray[Any, np.dtype[np.float64]]"]


def list_of_names(names: Any) -> list[str]:
    """The column names for a text file without names, as a list of texts."""
    if names is None:
        return []
    allowed = "a list of names is allowed"
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise Error(f"names={names!r}: {allowed}")
    every = list(names)
    if not every or not all(isinstance(name, str) for name in every):
        raise Error(f"names={every!r}: {allowed}")
    return every


def unmasked(values: Any) -> Any:
    """The values of a masked array, with NaN or NaT at masked entries."""
    if not isinstance(values, np.ma.MaskedArray):
        return values
    kind = values.dtype.kind
    if kind not in "fiubmM":
        return values
    plain = np.array(values.data, dtype=values.dtype if kind in "mM" else np.float64)
    missing = {"M": np.datetime64("NaT"), "m": np.timedelta64("NaT")}.get(kind, np.nan)
    plain[np.ma.getmaskarray(values)] = missing
    return plain


def is_path(source: object) -> bool:
    return isinstance(source, (str, os.PathLike))


def is_frame(source: object) -> bool:
    """Whether it is a frame, a pyarrow table, a mapping or a structured array."""
    if isinstance(source, np.ndarray):
        return source.dtype.names is not None
    return isinstance(source, Mapping) or hasattr(source, "columns") or hasattr(source, "column_names")


def check_units(units: Mapping[str, str], names: Iterable[object]) -> None:
    """Rejects a unit for a column that does not exist."""
    known = [str(name) for name in names]
    for name, unit in units.items():
        if name not in known:
            there = ", ".join(known)
            raise Error(f"units: `{name}`: no such column; the columns are {there}", column=str(name))
        if not isinstance(unit, str):
            raise Error(f"units: `{name}`: {unit!r}: a text is allowed", column=name)


def names_of(frame: Any) -> Iterable[object]:
    if isinstance(frame, np.ndarray):
        return frame.dtype.names or ()
    if isinstance(frame, Mapping):
        return frame.keys()
    # A table of pyarrow has the columns themselves in `columns`.
    names: Iterable[object] = getattr(frame, "column_names", None) or frame.columns
    return names


def columns_of_frame(frame: Any, units: Mapping[str, str]) -> list[Column]:
    """The numeric columns of a frame. Other columns are dropped, as in a Parquet file."""
    found: list[Column] = []
    for name in names_of(frame):
        column = values_of(frame[name])
        numbers = None if column is None else _numbers(column)
        if numbers is not None:
            values, unit = numbers
            found.append((str(name), units.get(str(name), unit), values))
    return found


def is_timed(column: Any) -> bool:
    """Whether the values are durations or points in time."""
    found = values_of(column)
    return found is not None and found.dtype.kind in "mM"


def refuse_times(name: str, column: Any) -> None:
    """Rejects durations and points in time for a signal."""
    if is_timed(column):
        raise Error(
            f"column `{name}`: values of {getattr(column, 'dtype', type(column).__name__)}; "
            "numbers are allowed, times only in the time column",
            column=name,
        )


def column_of_array(name: str, array: Any, units: Mapping[str, str]) -> Column:
    """A column from a one-dimensional array."""
    found = values_of(array)
    numbers = None if found is None else _numbers(found)
    if found is None or numbers is None:
        kind = type(array).__name__ if found is None else f"{found.dtype}"
        raise Error(f"column `{name}`: values of {kind}; numbers are allowed", column=name)
    values, unit = numbers
    if values.ndim != 1:
        raise Error(
            f"column `{name}`: shape {values.shape}; one dimension is allowed", column=name
        )
    return name, units.get(name, unit), values


def values_of(column: Any) -> Optional[np.ndarray[Any, Any]]:
    """The values of a column from any library."""
    dtype = getattr(column, "dtype", None)
    if hasattr(column, "to_numpy"):
        # Of pandas' own types: those with a mask have no array of their own.
        if hasattr(dtype, "na_value") and not isinstance(dtype, np.dtype):
            kind = getattr(dtype, "kind", "O")
            if kind not in "fiub":
                return np.asarray(column) if kind in "mM" else None
            if kind in "iu" and not column.isna().any():
                return np.asarray(column.to_numpy(dtype=kind + "8"))
            return np.asarray(column.to_numpy(dtype="float64", na_value=np.nan))
        return np.asarray(column.to_numpy())
    try:
        return np.asarray(unmasked(column))
    except ValueError:
        return None


def _numbers(
    values: np.ndarray[Any, Any],
) -> Optional[tuple[np.ndarray[Any, np.dtype[np.float64]], Optional[str]]]:
    """The values as doubles, without a copy if they are doubles already.

    Points in time are relative to the first one. So are durations and whole numbers that are too
    large for a double, such as time stamps in nanoseconds.
    """
    if values.dtype.kind in "iu" and values.ndim == 1 and _is_beyond(values):
        # Differences of 64 bits are right, whatever the sign of the first.
        since = values.astype(np.int64) - values[:1].astype(np.int64)
        return since.astype(np.float64), None
    if values.dtype.kind in "fiub":
        return np.ascontiguousarray(values, dtype=np.float64), None
    if values.dtype.kind in "mM" and values.ndim == 1:
        known = values[~np.isnat(values)]
        if known.size:
            # In whole nanoseconds: a double has them up to 104 days.
            from_first = values.dtype.kind == "M" or _is_long(known)
            since = values - known[0] if from_first else values
            nanoseconds = since.astype("timedelta64[ns]").astype(np.float64)
            nanoseconds[np.isnat(values)] = np.nan
            return nanoseconds, "ns"
    return None


def _is_long(durations: np.ndarray[Any, Any]) -> bool:
    return _is_beyond(durations.astype("timedelta64[ns]").astype(np.int64))


def _is_beyond(numbers: np.ndarray[Any, Any]) -> bool:
    """Whether a double cannot represent one of these whole numbers exactly."""
    return bool(numbers.size) and (int(numbers.max()) > 2**53 or int(numbers.min()) < -(2**53))
