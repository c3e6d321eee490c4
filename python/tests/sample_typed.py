"""What a user may write, for `mypy --strict`; the tests run it too."""

from pathlib import Path
from typing import Optional

import numpy as np

import bowden


def first_name(path: Path) -> Optional[str]:
    report = bowden.close(path, declare=["bouc-wen"], progress=None)
    held_out: float = report.final.nrmse.held_out
    names: list[str] = report.names
    for round in report.rounds:
        p: Optional[float] = round.p
        print(round.effect, p, round.rmse_after.held_out)
    model: bowden.Model = report.model
    checked: bowden.CheckReport = bowden.check(model, path)
    print(checked.verdict, checked.gain.value, held_out)
    return names[0] if names else None


def commands(reference: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> float:
    rig, pi = bowden.Rig(seed=1), bowden.PI(k_p=30.0, k_i=18.0)
    found = rig.track(pi, reference)
    return float(np.max(np.abs(found["error"])))


def place(error: bowden.Error) -> tuple[Optional[str], Optional[int], Optional[str]]:
    return error.file, error.line, error.column
