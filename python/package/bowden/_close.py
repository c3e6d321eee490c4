"""The identification of a record."""

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
    segment: Optional[int] = None,
    sheet: Optional[str] = None,
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
    """Fits the baseline model, finds the effects that it lacks, adds them, and compares the models.

    The record is one of

    * arrays: ``identify(t, tau_i=…, tau_o=…)`` in torque mode, ``identify(t, x=…, f=…)`` in
      displacement mode; they are one-dimensional, have the same length and any numeric type;
      ``t`` is in seconds, or ``None`` with ``rate``;
    * a record: a path (CSV, JSON, .xlsx, .mat v5 and v7.3, Parquet, .npz or .npy, each also in gzip), a frame of pandas or
      polars, a table of pyarrow, a mapping of names to arrays, or a :class:`bowden.Record`;
    * a list of such records of one rig, for one joint model; with three or more, the last one is
      held out as a whole.

    Options of the program `bowden identify`, under the same names:

    channels
        Further channels by name (``phi_p``, ``phi_d``, ``temperature``, ``load``, or any other).
        Each is an array, the name of a column, or ``"A-B"`` or ``"A+B"`` of two columns.
    baseline
        The baseline model: ``bouc-wen`` and any effects; ``"NAME@CHANNEL"`` reads a channel.
        Either a list, or one text with commas as for the program.
    mode
        ``"torque"`` or ``"displacement"``; default: from the columns.
    time, input, output
        Names of columns; default: ``t``, ``tau_i`` or ``x``, and ``tau_o`` or ``f``.
    start, end
        Seconds after the first time stamp at which the record is cut.
    cutoff
        Cut-off of the low-pass filter [Hz]; default: from the spectrum of the input.
    rate
        Sampling rate [Hz]; time is then computed from the row number.
    header_line
        Line of the column names of a CSV, from 1.
    segment
        Which segment of a CSV is read if its column names are repeated, from 1; default: all of
        them as one record if the time continues.
    sheet
        The sheet of an Excel workbook; default: the first one with a table.
    names
        Names of the columns of a text file without names, each with its unit if it has one
        (``["t", "x [mm]", "f"]``). A column with an empty name is not read.
    drop_bad
        Leave out rows with an empty cell, a NaN or a repeated time stamp.
    max_terms, time_limit
        Highest number of added terms (0 to 8); time after which the search ends [s].
    per_file
        ``"gains"``: the gains may differ from file to file.
    invertible
        Fit the exported model within what a feed-forward can invert.

    Further options in Python:

    units
        Unit of each column by name, as in the header of a CSV (``{"tau_i": "N·m"}``); for arrays
        and frames.
    label
        Replaces the file's name in messages and in the JSON, for arrays and frames.
    figures
        ``False`` keeps no figures, page, trace or model; for many records.
    threads
        Number of threads; default: all threads of the machine. The results do not depend on it.
    progress
        ``True`` for a new tqdm bar, an existing tqdm bar, or a function. The function is called
        with the share that is done (``None`` if unknown) and the current task. If it raises, the
        call ends. Ctrl-C ends the call too.

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
        segment=segment,
        sheet=sheet,
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
        "segment": segment,
        "sheet": sheet,
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
    """The call as a user could type it, for the page."""
    record = repr(paths[0]) if len(paths) == 1 else repr(paths)
    options = [f"{name}={value!r}" for name, value in given.items() if value is not None]
    return f"bowden.{function}({', '.join([record, *options])})"
