"""Reads a record from any source."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

from . import _bowden
from ._columns import (
    check_units,
    column_of_array,
    columns_of_frame,
    is_frame,
    is_path,
    list_of_names,
    names_of,
    refuse_times,
)
from ._error import Error
from ._numbers import duration, number, whole

#: Names that identify a column as a signal.
SIGNALS = frozenset({"tau_i", "tau_o", "x", "f", "phi_p", "phi_d", "temperature", "load"})

#: The values that are allowed for a frequency.
HERTZ = "a number of Hz is allowed"

#: A channel is the name of a column, ``A-B`` or ``A+B`` of two, or an array.
Channels = Mapping[str, Any]


class Reading:
    """How the columns of all records of a call are read."""

    def __init__(
        self,
        *,
        mode: Optional[str],
        time: Optional[str],
        input: Optional[str],
        output: Optional[str],
        channels: Optional[Channels],
        start: float,
        end: Optional[float],
        rate: Optional[float],
        header_line: Optional[int],
        segment: Optional[int],
        sheet: Optional[str],
        names: Optional[Sequence[str]],
        drop_bad: bool,
        units: Optional[Mapping[str, str]],
        label: Optional[str],
    ) -> None:
        self.channels = dict(channels or {})
        self.units = dict(units or {})
        self.label = label
        if header_line is not None:
            header_line = whole(
                "header_line", header_line, 1, 2**31, "a line from 1 up is allowed"
            )
        if segment is not None:
            segment = whole("segment", segment, 1, 2**31, "a segment from 1 up is allowed")
        self.options: dict[str, Any] = {
            "mode": mode,
            "time": time,
            "input": input,
            "output": output,
            "channels": [
                (name, column if isinstance(column, str) else name)
                for name, column in self.channels.items()
            ],
            "start": duration("start", start),
            "end": None if end is None else duration("end", end),
            "rate": None if rate is None else number("rate", rate, HERTZ),
            "header_line": header_line,
            "segment": segment,
            "sheet": sheet,
            "names": list_of_names(names),
            "drop_bad": bool(drop_bad),
        }

    def of_ends(self, ends: Mapping[str, Any]) -> _bowden.Record:
        """A record from named arrays."""
        arrays = [(name, array) for name, array in ends.items() if array is not None]
        arrays += [(n, a) for n, a in self.channels.items() if not isinstance(a, str)]
        check_units(self.units, [name for name, _ in arrays])
        for name, array in arrays:
            if name != "t":
                refuse_times(name, array)
        columns = [column_of_array(name, array, self.units) for name, array in arrays]
        return _bowden.record_of_columns(columns, self.label or "(arrays)", self.options)

    def of(self, source: Any, number: Optional[int] = None) -> _bowden.Record:
        """A record from one source. ``number`` is the number of the source, from 1."""
        if isinstance(source, _bowden.Record):
            self._no_names("a bowden.Record", "it has its own")
            return source
        if is_path(source):
            self._no_arrays()
            self._no_names("a file", "it has its name, and units in its header")
            return _bowden.record_of_file(os.fspath(source), self.options)
        if is_frame(source):
            arrays = [name for name, own in self.channels.items() if not isinstance(own, str)]
            check_units(self.units, [*names_of(source), *arrays])
            there = {str(name) for name in names_of(source)}
            for name in sorted(self._signals() & there):
                refuse_times(name, source[name])
            for name in arrays:
                refuse_times(name, self.channels[name])
            columns = columns_of_frame(source, self.units)
            if number is not None:
                self._no_arrays()
            columns += [
                column_of_array(name, array, self.units)
                for name, array in self.channels.items()
                if not isinstance(array, str)
            ]
            label = self.label or ("(frame)" if number is None else f"(frame {number})")
            return _bowden.record_of_columns(columns, label, self.options)
        raise Error(
            f"{type(source).__name__}: a path, a frame, a bowden.Record or arrays are allowed"
        )

    def _signals(self) -> frozenset[str]:
        """Names of the columns that are signals, if they exist."""
        ends = {own for own in (self.options["input"], self.options["output"]) if own}
        columns = {column for _, column in self.options["channels"]}
        return (SIGNALS | ends | columns) - {self.options["time"] or "t"}

    def all_of(self, sources: Union[Any, Sequence[Any]]) -> list[_bowden.Record]:
        """Records from one source or a list of sources, in the units of the first one."""
        if not isinstance(sources, (list, tuple)):
            return [self.of(sources)]
        if not sources:
            raise Error("no record was given")
        paths = [os.fspath(source) for source in sources if is_path(source)]
        for index, path in enumerate(paths):
            if path in paths[:index]:
                raise Error(f"{path}: given twice", file=path)
        if len(sources) == 1:
            return [self.of(sources[0])]
        return _bowden.agree([self.of(s, k + 1) for k, s in enumerate(sources)])

    def _no_names(self, source: str, why: str) -> None:
        """Rejects a label or units for this source."""
        for option, given in (("label", self.label), ("units", self.units or None)):
            if given is not None:
                raise Error(
                    f"{option}={given!r}: is for arrays and frames; {source} was given, and {why}"
                )

    def _no_arrays(self) -> None:
        for name, column in self.channels.items():
            if not isinstance(column, str):
                raise Error(
                    f"channels: `{name}` is an array; the name of a column is allowed",
                    column=name,
                )


def read(
    path: Any,
    *,
    mode: Optional[str] = None,
    time: Optional[str] = None,
    input: Optional[str] = None,
    output: Optional[str] = None,
    channels: Optional[Channels] = None,
    start: float = 0.0,
    end: Optional[float] = None,
    rate: Optional[float] = None,
    header_line: Optional[int] = None,
    segment: Optional[int] = None,
    sheet: Optional[str] = None,
    names: Optional[Sequence[str]] = None,
    drop_bad: bool = False,
    units: Optional[Mapping[str, str]] = None,
    label: Optional[str] = None,
) -> _bowden.Record:
    """Reads one record from a file or a frame; the formats are those of :func:`identify`.

    The options are those of `bowden identify`.
    """
    reading = Reading(
        mode=mode,
        time=time,
        input=input,
        output=output,
        channels=channels,
        start=start,
        end=end,
        rate=rate,
        header_line=header_line,
        segment=segment,
        sheet=sheet,
        names=names,
        drop_bad=drop_bad,
        units=units,
        label=label,
    )
    return reading.of(path)
