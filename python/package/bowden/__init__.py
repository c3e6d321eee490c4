"""Identifies models of hysteretic cable transmissions, and simulates and controls rigs.

>>> import bowden
>>> report = bowden.identify("record.csv")               # doctest: +SKIP
>>> report.verdict, report.names                       # doctest: +SKIP
('explained', ['viscous'])
"""

from importlib.metadata import version as _version

from ._bowden import Record
from ._beside import DisturbanceObserver, IterativeLearning, NominalPlant
from ._check import validate
from ._close import identify
from ._control import Controller
from ._error import Error
from ._fields import Fields
from ._laws import PI, PID, PIV, Adaptive
from ._model import Model
from ._read import read
from ._relay import Relay, RelayPhase, RelayResult
from ._report import CheckReport, Report
from ._rig import Rig, paper_reference
from ._signal import (
    Biquad,
    EdgeStatus,
    EdgeVelocity,
    EdgeVelocityResult,
    Implausible,
    LowPass,
    Plausible,
    PlausibleResult,
    Ramp,
    Rates,
    RatesResult,
    RatesStatus,
)
from ._status import Fault, RunResult, Status, StepResult

__version__ = _version("bowden")

__all__ = [
    "Adaptive",
    "Biquad",
    "CheckReport",
    "Controller",
    "DisturbanceObserver",
    "EdgeStatus",
    "EdgeVelocity",
    "EdgeVelocityResult",
    "Error",
    "Fault",
    "Fields",
    "Implausible",
    "IterativeLearning",
    "LowPass",
    "Model",
    "NominalPlant",
    "PI",
    "PID",
    "PIV",
    "Plausible",
    "PlausibleResult",
    "Ramp",
    "Rates",
    "RatesResult",
    "RatesStatus",
    "Record",
    "Relay",
    "RelayPhase",
    "RelayResult",
    "Report",
    "Rig",
    "RunResult",
    "Status",
    "StepResult",
    "identify",
    "paper_reference",
    "read",
    "validate",
]
