"""Numbers and times with a unit, of any type. Other values are errors."""

from __future__ import annotations

import datetime
import operator
from typing import Any, Optional

import numpy as np

from ._columns import values_of
from ._error import Error

Floats = np.ndarray[Any, np.dtype[np.float64]]

#: The values that are allowed for a time in seconds.
DURATIONS = "seconds (numbers) or durations with a unit (timedelta) are allowed"
_SECOND = np.timedelta64(1, "s")


def numbers(name: str, value: Any, allowed: str = "numbers are allowed") -> Floats:
    """An array of numbers without a unit, of any shape. NaN is allowed."""
    array = _array(value)
    if array is None or array.dtype.kind not in "fiu":
        raise Error(f"{name}: {_described(value, array)}; {allowed}")
    return np.asarray(array, dtype=np.float64)


def seconds(name: str, value: Any) -> Floats:
    """An array of seconds, from numbers in seconds or from durations with a unit.

    A missing duration (``NaT``) becomes NaN. A point in time is not a duration. ``_columns`` does
    the same for the columns of a record.
    """
    array = _array(value)
    if array is not None and array.dtype.kind == "O" and array.size:
        array = _of_objects(array)
    if array is None or array.dtype.kind != "m":
        return numbers(name, value, DURATIONS)
    if np.datetime_data(array.dtype)[0] in ("generic", "Y", "M"):
        raise Error(f"{name}: {array.dtype} has no fixed length; {DURATIONS}")
    # A quotient of whole numbers: correctly rounded, which a product with 1e-9 is not.
    return np.asarray(array / _SECOND, dtype=np.float64)


def number(name: str, value: Any, allowed: str = "a number is allowed") -> float:
    """One number. NaN is allowed."""
    if isinstance(value, float):
        return float(value)
    return _one(name, value, numbers(name, value, allowed), allowed)


def duration(name: str, value: Any) -> float:
    """One time in seconds."""
    if isinstance(value, float):
        return float(value)
    return _one(name, value, seconds(name, value), DURATIONS)


def finite(name: str, value: float, allowed: str = "finite numbers are allowed") -> float:
    if not np.isfinite(value):
        raise Error(f"{name}={value}: {allowed}")
    return value


def positive_duration(name: str, value: Any) -> float:
    """One positive time in seconds."""
    found = duration(name, value)
    if not 0.0 < found < np.inf:
        raise Error(f"{name}={value!r}: a positive number of seconds is allowed")
    return found


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise Error(f"{name}={value!r}: True or False is allowed")
    return bool(value)


def flags(name: str, value: Any) -> Floats:
    """An array of True and False as ones and zeros."""
    array = _array(value)
    if array is None or array.dtype.kind != "b":
        raise Error(f"{name}: {_described(value, array)}; True or False is allowed")
    return np.asarray(array, dtype=np.float64)


def whole(name: str, value: Any, least: int, most: int, allowed: str) -> int:
    """A whole number within a range."""
    try:
        count = operator.index(value)
    except TypeError:
        count = None
    if count is None or isinstance(value, (bool, np.bool_, np.timedelta64)):
        raise Error(f"{name}={value!r}: {allowed}")
    if not least <= count <= most:
        raise Error(f"{name}={count}: {allowed}")
    return count


def spread(name: str, values: Floats, samples: int, lanes: int) -> Floats:
    """A signal as (samples, lanes), from one number, (samples,) or (samples, lanes)."""
    shape = (samples, lanes)
    if values.ndim == 1 and values.shape[0] == samples and samples > 1:
        values = values[:, None]
    try:
        return np.ascontiguousarray(np.broadcast_to(values, shape))
    except ValueError:
        wanted = " or ".join(str(s) for s in dict.fromkeys([(), (samples,), shape]))
        raise Error(f"{name}: shape {values.shape}; {wanted} is allowed") from None


def samples_of(*signals: Any) -> int:
    """The number of samples of the longest array; one without an array."""
    arrays = [own for own in map(_array, signals) if own is not None and own.ndim]
    return max((own.shape[0] for own in arrays), default=1)


def along(name: str, values: Floats, samples: int) -> Floats:
    """A signal that all lanes share, as (samples,)."""
    if values.shape not in ((), (samples,)):
        raise Error(f"{name}: shape {values.shape}; () or {(samples,)} is allowed")
    return np.ascontiguousarray(np.broadcast_to(values, (samples,)))


def _one(name: str, value: Any, array: Floats, allowed: str) -> float:
    if array.ndim:
        raise Error(f"{name}: shape {array.shape}; {allowed}, not an array")
    return float(array)


def _array(value: Any) -> Optional[np.ndarray[Any, Any]]:
    if hasattr(value, "to") and (hasattr(value, "unit") or hasattr(value, "units")):
        return None  # A quantity of astropy or pint: numpy would drop its unit.
    if isinstance(value, (datetime.timedelta, datetime.date)) and not hasattr(value, "to_numpy"):
        value = np.asarray(value, dtype="m8" if isinstance(value, datetime.timedelta) else "M8")
    return values_of(value)


def _of_objects(array: np.ndarray[Any, Any]) -> Optional[np.ndarray[Any, Any]]:
    """Durations from a list of `datetime.timedelta` or from pandas."""
    flat = [_array(one) for one in array.ravel()]
    if any(one is None or one.dtype.kind != "m" for one in flat):
        return None
    return np.array(flat).reshape(array.shape)


def _described(value: Any, array: Optional[np.ndarray[Any, Any]]) -> str:
    """A short description of the value."""
    if value is None:
        return "None"
    if array is None or array.dtype.kind in "OSU" or isinstance(value, bool):
        text = repr(value)
        return f"{type(value).__name__} {text if len(text) <= 40 else text[:37] + '…'}"
    return f"values of {array.dtype}" if array.ndim else f"{array.dtype} {value}"
