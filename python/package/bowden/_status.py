"""What a step tells: its command, whether the sample was good, and what was wrong with it."""

from __future__ import annotations

import enum
from typing import Any, NamedTuple, Union

import numpy as np


class Code(enum.IntEnum):
    """A number with a name, which is its text."""

    def __str__(self) -> str:
        return self.name.lower().replace("_", " ")

    def __format__(self, spec: str) -> str:
        return format(str(self), spec)


class Status(Code):
    """What a step did: the greater, the worse."""

    GOOD = 0
    #: The command is of this sample, but the term of a regressor was dropped, or the observer or
    #: learning could not use the sample.
    DEGRADED = 1
    #: A bad sample: the last good command is held.
    HELD = 2
    #: Too many bad samples: the safe command is out until :meth:`Controller.acknowledge`.
    SAFE = 3


class Fault(Code):
    """Which input of a step could not be used; ``NONE`` is false."""

    NONE = 0
    #: ``dt`` is not finite.
    DT = 1
    DT_NOT_POSITIVE = 2
    #: ``dt`` is beyond ``longest_dt``, or beyond what the law is stable for.
    DT_TOO_LONG = 3
    REFERENCE = 4
    MEASURED = 5
    VELOCITY = 6
    FEED_FORWARD = 7
    #: The command to resume from.
    COMMAND = 8
    #: Every input is finite, but the command is not.
    OVERFLOW = 9
    #: The phase of a cycle is not from 0 to 1, or has jumped.
    PHASE = 10
    OTHER = 11
    POSITION = 12
    REGRESSOR_0 = 16
    REGRESSOR_1 = 17
    REGRESSOR_2 = 18
    REGRESSOR_3 = 19


class StepResult(NamedTuple):
    """One sample; of several lanes each is an array with one value for each lane."""

    #: What goes to the drive [command unit].
    command: Any
    #: A :class:`Status`; of several lanes an array of its numbers.
    status: Any
    #: A :class:`Fault`, likewise.
    fault: Any


class RunResult(NamedTuple):
    """Many samples: arrays of shape (samples,), or (samples, lanes) of several lanes."""

    #: What goes to the drive [command unit].
    command: Any
    #: Numbers of :class:`Status`: ``result.status == bowden.Status.HELD``.
    status: Any
    #: Numbers of :class:`Fault`.
    fault: Any


_STATUSES = tuple(Status)
_FAULTS = {int(fault): fault for fault in Fault}


def step_result(command: float, status: int, fault: int) -> StepResult:
    """Of the numbers of the native half."""
    return StepResult(command, _STATUSES[status], _FAULTS.get(fault, Fault.OTHER))


def command_of(given: Any) -> Any:
    """The command of a result, or what was given itself."""
    return given.command if isinstance(given, (StepResult, RunResult)) else given


#: For type checkers: what a controller's command may come in.
Command = Union[float, StepResult, RunResult, np.ndarray[Any, Any]]
