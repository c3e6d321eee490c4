"""Validates a model on another record."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

from . import _bowden
from ._close import command_of, records_of, threads_of
from ._error import Error
from ._model import Model
from ._numbers import number
from ._read import HERTZ, Channels, Reading
from ._report import CheckReport


def validate(
    model: Union[Model, str, "os.PathLike[str]"],
    t: Any = None,
    tau_i: Any = None,
    tau_o: Any = None,
    *,
    x: Any = None,
    f: Any = None,
    channels: Optional[Channels] = None,
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
    units: Optional[Mapping[str, str]] = None,
    label: Optional[str] = None,
    threads: Optional[int] = None,
) -> CheckReport:
    """Tests a model on another record of the same rig. Only a gain and an offset are fitted.

    ``model`` is a :class:`Model` or the path of a ``.toml``. The record and the reading options are
    as in :func:`bowden.identify`.

    Raises :class:`bowden.Error`.
    """
    own = model if isinstance(model, Model) else Model.load(model)
    if mode not in (None, own.mode):
        raise Error(f"{own.name}: mode={mode!r}: the model is of {own.mode} mode")
    reading = Reading(
        mode=own.mode,
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
    ends = {"tau_i": tau_i, "tau_o": tau_o, "x": x, "f": f}
    records = records_of(reading, t, ends)
    if len(records) != 1:
        raise Error(f"{len(records)} records are given; one is allowed")
    hertz = None if cutoff is None else number("cutoff", cutoff, HERTZ)
    checked = _bowden.check(own._native, own.name, records[0], hertz, threads_of(threads))
    given = {"cutoff": cutoff, "start": start or None, "end": end, "rate": rate}
    command = command_of("validate", [own.name], {}).rstrip(")")
    rest = command_of("validate", [records[0].path], given).partition("(")[2]
    return CheckReport(checked, f"{command}, {rest}")
