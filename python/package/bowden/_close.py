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
    """Fits a baseline model, adds the effects that it lacks, and compares the models.

    The record is one of

    * arrays: ``identify(t, tau_i=…, tau_o=…)`` in torque mode, ``identify(t, x=…, f=…)`` in
      displacement mode. The arrays are one-dimensional, of equal length and of any numeric type.
      ``t`` is in seconds, or ``None`` with ``rate``.
    * a record: a pandas or polars frame, a pyarrow table, a mapping of names to arrays, a
      :class:`bowden.Record`, or the path of a file (CSV, JSON, .xlsx, .mat v5 or v7.3, Parquet,
      .npz or .npy; gzip is allowed).
    * a list of such records of one rig, for one joint model. If there are three or more
      records, the last one is held out as a whole, unless ``per_file`` is given.

    Options of the program `bowden identify`, with the same names (``channels`` is ``--channel``):

    channels
        Further channels by name (``phi_p``, ``phi_d``, ``temperature``, ``load``, or any other).
        Each is an array, a column name, or ``"A-B"`` or ``"A+B"`` of two columns.
    baseline
        Baseline model: ``bouc-wen`` and any effects, as a list or as one text with commas.
        ``"NAME@CHANNEL"`` reads a channel.
    mode
        ``"torque"`` or ``"displacement"``; default: from the columns.
    time, input, output
        Column names; default: ``t``, ``tau_i`` or ``x``, and ``tau_o`` or ``f``.
    start, end
        Start and end of the used part of the record, from the first time stamp [s].
    cutoff
        Cut-off frequency of the low-pass filter [Hz]; default: from the spectrum of the input.
    rate
        Sampling rate [Hz]. Time is then computed from the row number.
    header_line
        Line number of the column names in a CSV, from 1.
    segment
        Segment to read from a CSV whose column names are repeated, from 1; default: all segments
        as one record if the time continues.
    sheet
        Sheet of an Excel workbook; default: the first sheet with a table.
    names
        Column names for a text file without names, with units if known
        (``["t", "x [mm]", "f"]``). A column with an empty name is not read.
    drop_bad
        Drop rows with an empty cell, a NaN or a repeated time stamp.
    max_terms, time_limit
        Maximum number of added terms (0 to 8); time limit of the search [s].
    per_file
        ``"gains"``: the gains may differ between files. The end of each file is then held out.
    invertible
        Restrict the exported model to models that a feed-forward can invert.

    Further options in Python:

    units
        Units of the columns of arrays and frames by name (``{"tau_i": "N·m"}``).
    label
        Name of arrays or of a frame in messages and in the JSON.
    figures
        ``False`` keeps no figures, page, trace or model. Use it for many records.
    threads
        Number of threads; default: all threads of the machine. The results do not depend on
        this number.
    progress
        ``True`` for a new tqdm bar (without tqdm: lines on stderr), an existing tqdm bar, or a
        function. The function is called with the completed fraction (``None`` if unknown) and the
        current task. An exception in the function ends the call, and so does Ctrl-C.

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
    """Checks the number of threads."""
    if threads is None:
        return None
    return whole("threads", threads, 1, 2**16, "one or more are allowed")


def command_of(function: str, paths: list[str], given: Mapping[str, Any]) -> str:
    """The call as a user could type it, for the page."""
    record = repr(paths[0]) if len(paths) == 1 else repr(paths)
    options = [f"{name}={value!r}" for name, value in given.items() if value is not None]
    return f"bowden.{function}({', '.join([record, *options])})"
