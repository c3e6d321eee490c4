"""Hysteretic cable transmissions: closes the loop between a model and measured data.

>>> import bowden
>>> report = bowden.close("record.csv")               # doctest: +SKIP
>>> report.verdict, report.names                       # doctest: +SKIP
('explained', ['viscous'])
"""

from importlib.metadata import version as _version

from ._bowden import Record
from ._beside import DisturbanceObserver, Learning, NominalPlant
from ._check import check
from ._close import close
from ._control import PI, PID, PIV, STATUS, Adaptive, Controller, Rig, paper_reference
from ._error import Error
from ._fields import Fields
from ._model import Model
from ._read import read
from ._report import CheckReport, Report

__version__ = _version("bowden")

__all__ = [
    "PI",
    "PID",
    "PIV",
    "STATUS",
    "Adaptive",
    "CheckReport",
    "Controller",
    "DisturbanceObserver",
    "Error",
    "Fields",
    "Learning",
    "Model",
    "NominalPlant",
    "Record",
    "Report",
    "Rig",
    "check",
    "close",
    "paper_reference",
    "read",
]
