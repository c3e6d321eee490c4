"""The sample that mypy checks runs, too."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bowden
import records
import sample_typed


def test_the_sample_runs(tmp_path: Path, viscous: dict[str, Any]) -> None:
    path = records.write_csv(tmp_path / "record.csv", viscous)
    assert sample_typed.first_name(path) == "viscous"
    assert 0.0 < sample_typed.commands(bowden.paper_reference([0.0, 0.001, 0.002])) < 40.0
    command, status, fault = sample_typed.steps(bowden.PI())
    assert command > 0.0 and status is bowden.Status.GOOD and not fault
    refused = sample_typed.wrong(bowden.PI())
    assert [text.split()[0] for text in refused] == ["k_p", "no", "PI:", "Rates:"]
    assert sample_typed.place(bowden.Error("a", "b", 3, "c")) == ("b", 3, "c")
