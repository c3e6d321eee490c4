"""The main question."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

from . import _bowden
from ._columns import whole
from ._error import Error
from ._progress import Progress
from ._read import Channels, Reading
from ._report import Report


def close(
    t: Any = None,
    tau_i: Any = None,
    tau_o: Any = None,
    *,
    x: Any = None,
    f: Any = None,
    channels: Optional[Channels] = None,
    declare: Union[str, Sequence[str], None] = None,
    mode: Optional[str] = None,
    time: Optional[str] = None,
    input: Optional[str] = None,
    output: Optional[str] = None,
    skip: float = 0.0,
    until: Optional[float] = None,
    cutoff: Optional[float] = None,
    rate: Optional[float] = None,
    header_line: Optional[int] = None,
    names: Optional[Sequence[str]] = None,
    drop_bad: bool = False,
    rounds: Optional[int] = None,
    budget: Optional[float] = None,
    per_file: Optional[str] = None,
    invertible: bool = False,
    units: Optional[Mapping[str, str]] = None,
    label: Optional[str] = None,
    figures: bool = True,
    threads: Optional[int] = None,
    progress: Any = None,
) -> Report:
    """Fits the declared model, finds the effect that it lacks, adds it, compares.

    What is closed is one of

    * arrays: ``close(t, tau_i=…, tau_o=…)`` in torque mode, ``close(t, x=…, f=…)`` in
      displacement mode, one-dimensional, of one length, of any numeric type; ``t`` in seconds,
      or ``None`` with ``rate``;
    * a record: a path (CSV, .mat v5 and v7.3, Parquet, each also in gzip), a frame of pandas or polars, a
      table of pyarrow, a mapping of names to arrays, or a :class:`bowden.Record`;
    * a list of such records of one rig, for one joint model; of three or more the last is held
      out as a whole.

    Options of the program `bowden close`, under the same names:

    channels
        Further channels by name (``phi_p``, ``phi_d``, ``temperature``, ``load``, or any other):
        an array, or the name of a column, ``"A-B"`` or ``"A+B"`` of two.
    declare
        The declared model: ``bouc-wen`` and any effects; ``"NAME@CHANNEL"`` reads a channel.
        A list, or one text with commas as for the program.
    mode
        ``"torque"`` or ``"displacement"``; from the columns where it is not given.
    time, input, output
        Names of columns; ``t``, ``tau_i`` or ``x``, ``tau_o`` or ``f`` where not given.
    skip, until
        Seconds from the first time stamp: what lies outside is left out.
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
    rounds, budget
        At most so many effects (0 to 8), at most so many seconds.
    per_file
        ``"gains"``: the gains may differ from file to file.
    invertible
        Fit the model that is handed over within what a feed-forward can invert.

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
        raise Error(f'per_file={per_file!r}: "gains" was expected')
    reading = Reading(
        mode=mode,
        time=time,
        input=input,
        output=output,
        channels=channels,
        skip=skip,
        until=until,
        rate=rate,
        header_line=header_line,
        names=names,
        drop_bad=drop_bad,
        units=units,
        label=label,
    )
    wanted = {
        "declare": [own.strip() for own in declare.split(",")]
        if isinstance(declare, str)
        else list(declare or []),
        "rounds": None
        if rounds is None
        else whole("rounds", rounds, 0, 8, "0 to 8 were expected"),
        "budget": None if budget is None else float(budget),
        "cutoff": None if cutoff is None else float(cutoff),
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
        "declare": wanted["declare"] or None,
        "mode": mode,
        "time": time,
        "input": input,
        "output": output,
        "skip": skip or None,
        "until": until,
        "cutoff": cutoff,
        "rate": rate,
        "header_line": header_line,
        "names": names,
        "drop_bad": drop_bad or None,
        "rounds": rounds,
        "budget": budget,
        "per_file": per_file,
        "invertible": invertible or None,
    }
    return Report(closed, command_of("close", [r.path for r in records], given), figures)


def records_of(
    reading: Reading, first: Any, ends: Mapping[str, Any]
) -> list[_bowden.Record]:
    """The records of a call."""
    if any(end is not None for end in ends.values()):
        return [reading.of_ends({"t": first, **ends})]
    if first is None:
        raise Error("no record was given: arrays, a frame or a path were expected")
    return reading.all_of(first)


def threads_of(threads: Optional[int]) -> Optional[int]:
    """The number of threads, checked."""
    if threads is None:
        return None
    return whole("threads", threads, 1, 2**16, "one or more were expected")


def command_of(function: str, paths: list[str], given: Mapping[str, Any]) -> str:
    """The call as it may be typed, for the page."""
    record = repr(paths[0]) if len(paths) == 1 else repr(paths)
    options = [f"{name}={value!r}" for name, value in given.items() if value is not None]
    return f"bowden.{function}({', '.join([record, *options])})"
