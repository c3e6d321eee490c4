"""The errors for a bad record, a bad option or a bad model."""

from __future__ import annotations

import re
from typing import Optional


class Error(ValueError):
    """One line that describes the error and, if known, its position.

    ``file``, ``line`` (from 1; the row in arrays and in files without lines) and ``column`` are
    ``None`` if they do not apply.
    """

    def __init__(
        self,
        message: str,
        file: Optional[str] = None,
        line: Optional[int] = None,
        column: Optional[str] = None,
    ) -> None:
        super().__init__(_in_python(message))
        self.file = file
        self.line = line
        self.column = column

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (str(self), self.file, self.line, self.column)


class FrozenError(Error, AttributeError):
    """An assignment to a read-only attribute."""


class CallError(Error, TypeError):
    """A call with an unknown keyword."""


#: The program's options that have other names here.
_OTHER = {
    "--channel NAME=COL": "channels",
    "--drop-bad": "drop_bad=True",
    "--names t,x,f": 'names=["t", "x", "f"]',
    "--names A,B,…": 'names=["A", "B", …]',
    "--invertible": "invertible=True",
    "--per-file gains": 'per_file="gains"',
}
_OPTION = re.compile(
    r"--(channel|time|input|output|mode|start|end|cutoff|rate|header-line|segment|names|baseline|max-terms|time-limit)\b"
    r"(?: (?:COL|HZ)\b)?(?: (?=[-\d']|N\b|torque|displacement))?"
)


def _in_python(message: str) -> str:
    """The message with the Python names of the options."""
    for program, python in _OTHER.items():
        message = message.replace(program, python)
    return _OPTION.sub(lambda found: found.group(1).replace("-", "_") + "=", message)
