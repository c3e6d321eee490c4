"""The result of a step: command, status and fault."""

from __future__ import annotations

import enum
from typing import Any, NamedTuple, Union

import numpy as np


class Code(enum.IntEnum):
    """A number with a name as its text."""

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")

    def __format__(self, spec: str) -> str:
        return format(str(self), spec)


class Status(Code):
    """Status of a step. A larger number is a worse status."""

    GOOD = 0
    #: The command belongs to this sample, but the term of a regressor was dropped, or the
    #: observer or iterative learning could not use the sample.
    DEGRADED = 1
    #: A bad sample. The last good command is held.
    HELD = 2
    #: Too many bad samples. The safe command is applied until :meth:`Controller.acknowledge`.
    SAFE = 3


class Fault(Code):
    """Bad input of a step. ``NONE`` is false."""

    NONE = 0
    #: ``dt`` is not finite.
    DT = 1
    DT_NOT_POSITIVE = 2
    #: ``dt`` exceeds ``longest_dt`` or the stability limit of the adaptive law.
    DT_TOO_LONG = 3
    REFERENCE = 4
    MEASURED = 5
    VELOCITY = 6
    FEED_FORWARD = 7
    #: The command to resume from.
    COMMAND = 8
    #: Every input is finite, but the command is not finite.
    OVERFLOW = 9
    #: The phase of a cycle lies outside 0 to 1, or has jumped.
    PHASE = 10
    OTHER = 11
    POSITION = 12
    REGRESSOR_0 = 16
    REGRESSOR_1 = 17
    REGRESSOR_2 = 18
    REGRESSOR_3 = 19


class StepResult(NamedTuple):
    """Result for one sample. For several lanes each field is an array."""

    #: The command for the drive [command unit].
    command: Any
    #: A :class:`Status`; for several lanes an array of its numbers.
    status: Any
    #: A :class:`Fault`; for several lanes an array of its numbers.
    fault: Any


class RunResult(NamedTuple):
    """Results for many samples, as arrays with shape (samples,) or (samples, lanes)."""

    #: The command for the drive [command unit].
    command: Any
    #: Numbers of :class:`Status`: ``result.status == bowden.Status.HELD``.
    status: Any
    #: Numbers of :class:`Fault`.
    fault: Any


_STATUSES = tuple(Status)
_FAULTS = {int(fault): fault for fault in Fault}


def step_result(command: float, status: int, fault: int) -> StepResult:
    """The result from the numbers of the native module."""
    return StepResult(command, _STATUSES[status], _FAULTS.get(fault, Fault.OTHER))


def command_of(given: Any) -> Any:
    """The command of a result, or the given value itself."""
    return given.command if isinstance(given, (StepResult, RunResult)) else given


#: For type checkers: the types in which a controller's command may be given.
Command = Union[float, StepResult, RunResult, np.ndarray[Any, Any]]
