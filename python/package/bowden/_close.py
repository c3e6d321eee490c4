"""The main question."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

from . import _bowden
from ._error import Error
from ._numbers import duration, number, whole
from ._progress import Progress
from ._read import HERTZ, Channels, Reading
from ._report import Report


def identify(
    t: Any = None,
    tau_i: Any = None,
    tau_o: Any = None,
    *,
    x: Any = None,
    f: Any = None,
    channels: Optional[Channels] = None,
    baseline: Union[str, Sequence[str], None] = None,
    mode: Optional[str] = None,
    time: Optional[str] = None,
    input: Optional[str] = None,
    output: Optional[str] = None,
    start: float = 0.0,
    end: Optional[float] = None,
    cutoff: Optional[float] = None,
    rate: Optional[float] = None,
    header_line: Optional[int] = None,
    names: Optional[Sequence[str]] = None,
    drop_bad: bool = False,
    max_terms: Optional[int] = None,
    time_limit: Optional[float] = None,
    per_file: Optional[str] = None,
    invertible: bool = False,
    units: Optional[Mapping[str, str]] = None,
    label: Optional[str] = None,
    figures: bool = True,
    threads: Optional[int] = None,
    progress: Any = None,
) -> Report:
    """Fits the baseline model, finds the effect that it lacks, adds it, compares.

    The record is one of

    * arrays: ``identify(t, tau_i=…, tau_o=…)`` in torque mode, ``identify(t, x=…, f=…)`` in
      displacement mode, one-dimensional, of one length, of any numeric type; ``t`` in seconds,
      or ``None`` with ``rate``;
    * a record: a path (CSV, .mat v5 and v7.3, Parquet, each also in gzip), a frame of pandas or polars, a
      table of pyarrow, a mapping of names to arrays, or a :class:`bowden.Record`;
    * a list of such records of one rig, for one joint model; of three or more the last is held
      out as a whole.

    Options of the program `bowden identify`, under the same names:

    channels
        Further channels by name (``phi_p``, ``phi_d``, ``temperature``, ``load``, or any other):
        an array, or the name of a column, ``"A-B"`` or ``"A+B"`` of two.
    baseline
        The baseline model: ``bouc-wen`` and any effects; ``"NAME@CHANNEL"`` reads a channel.
        A list, or one text with commas as for the program.
    mode
        ``"torque"`` or ``"displacement"``; from the columns where it is not given.
    time, input, output
        Names of columns; ``t``, ``tau_i`` or ``x``, ``tau_o`` or ``f`` where not given.
    start, end
        Seconds after the first time stamp at which the record is cut.
    cutoff
        Cut-off of the one filter [Hz]; from the input's spectrum where it is not given.
    rate
        Sampling rate [Hz]; time is then taken from the row number.
    header_line
        Line of the column names of a CSV, from 1.
    names
        Names of the columns of a text without names, each with its unit where it has one
        (``["t", "x [mm]", "f"]``); an empty one is that of a column which is not read.
    drop_bad
        Leave out rows with an empty cell, a NaN or a time stamp that repeats.
    max_terms, time_limit
        Highest number of added terms (0 to 8); time after which the search ends [s].
    per_file
        ``"gains"``: the gains may differ from file to file.
    invertible
        Fit the exported model within what a feed-forward can invert.

    And of Python:

    units
        Unit of each column by name, as in the header of a CSV (``{"tau_i": "N·m"}``); for arrays
        and frames.
    label
        What stands for the file's name in messages and in the JSON; for arrays and frames.
    figures
        ``False``: no figures, page, trace or model are kept, for many records.
    threads
        Number of threads; all of the machine's where it is not given. The numbers do not depend
        on it.
    progress
        ``True`` for a bar of tqdm, a bar of tqdm, or a function that is called with the share
        that is done (``None`` where unknown) and what is done now. Where it raises, the call
        ends. Ctrl-C ends it too.

    Raises :class:`bowden.Error`.
    """
    if per_file not in (None, "gains"):
        raise Error(f'per_file={per_file!r}: "gains" is allowed')
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
        names=names,
        drop_bad=drop_bad,
        units=units,
        label=label,
    )
    wanted = {
        "baseline": [own.strip() for own in baseline.split(",")]
        if isinstance(baseline, str)
        else list(baseline or []),
        "max_terms": None
        if max_terms is None
        else whole("max_terms", max_terms, 0, 8, "a whole number from 0 to 8 is allowed"),
        "time_limit": None if time_limit is None else duration("time_limit", time_limit),
        "cutoff": None if cutoff is None else number("cutoff", cutoff, HERTZ),
        "own_gains": per_file is not None,
        "invertible": bool(invertible),
        "figures": bool(figures),
    }
    with Progress(progress) as told:
        if told is not None:
            told(0.0, "reading")
        records = records_of(reading, t, {"tau_i": tau_i, "tau_o": tau_o, "x": x, "f": f})
        closed = _bowden.close(records, wanted, threads_of(threads), told)
    given = {
        "channels": sorted(reading.channels) or None,
        "baseline": wanted["baseline"] or None,
        "mode": mode,
        "time": time,
        "input": input,
        "output": output,
        "start": start or None,
        "end": end,
        "cutoff": cutoff,
        "rate": rate,
        "header_line": header_line,
        "names": names,
        "drop_bad": drop_bad or None,
        "max_terms": max_terms,
        "time_limit": time_limit,
        "per_file": per_file,
        "invertible": invertible or None,
    }
    return Report(closed, command_of("identify", [r.path for r in records], given), figures)


def records_of(
    reading: Reading, first: Any, ends: Mapping[str, Any]
) -> list[_bowden.Record]:
    """The records of a call."""
    if any(end is not None for end in ends.values()):
        return [reading.of_ends({"t": first, **ends})]
    if first is None:
        raise Error("no record is given: arrays, a frame or a path are needed")
    return reading.all_of(first)


def threads_of(threads: Optional[int]) -> Optional[int]:
    """The number of threads, checked."""
    if threads is None:
        return None
    return whole("threads", threads, 1, 2**16, "one or more are allowed")


def command_of(function: str, paths: list[str], given: Mapping[str, Any]) -> str:
    """The call as it may be typed, for the page."""
    record = repr(paths[0]) if len(paths) == 1 else repr(paths)
    options = [f"{name}={value!r}" for name, value in given.items() if value is not None]
    return f"bowden.{function}({', '.join([record, *options])})"
