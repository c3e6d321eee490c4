"""Models: what is answered is what firmware would."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bowden


def rows_of(vector: str) -> dict[str, np.ndarray]:
    rows = list(csv.reader(io.StringIO(vector)))
    columns = zip(*[[float(cell) for cell in row] for row in rows[1:]])
    return {name: np.array(column) for name, column in zip(rows[0], columns)}


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_test_vector_comes_out_digit_by_digit(viscous: dict[str, Any], dtype: Any) -> None:
    report = bowden.identify(viscous)
    vector = rows_of(report.vectors[0])

    def motion(name: str) -> np.ndarray:
        ends = ("", ".velocity", ".acceleration")
        return np.stack([vector[name + end] for end in ends], axis=1)

    model = report.model
    assert model.channels == ["phi_p"]
    assert len(set(vector["dt"])) == 1
    answers = model.predict(
        dt=vector["dt"][0], input=motion("input"), channels={"phi_p": motion("phi_p")}, dtype=dtype
    )
    expected = vector["output_f32" if dtype is np.float32 else "output_f64"].astype(dtype)
    assert answers.dtype == dtype
    np.testing.assert_array_equal(answers, expected)


def test_predictions_are_as_good_as_the_model_says(viscous: dict[str, Any]) -> None:
    report = bowden.identify(viscous)
    answers = report.model.predict(
        viscous["t"], viscous["tau_i"], channels={"phi_p": viscous["phi_p"]}
    )
    held_out = slice(-1500, -100)
    error = (answers - viscous["tau_o"])[held_out]
    share = np.std(error) / np.std(viscous["tau_o"][held_out])
    causal = report.final.causal_nrmse
    assert causal is not None
    # The one is unfiltered, with the noise of both sensors: 0.02·sqrt(2) of 6 N·m.
    assert share < 3.0 * causal.held_out + 0.006
    with pytest.raises(bowden.Error, match="channel `phi_p`: the model reads it"):
        report.model.predict(viscous["t"], viscous["tau_i"])
    with pytest.raises(bowden.Error, match="t and dt: exactly one"):
        report.model.predict(input=viscous["tau_i"], channels={"phi_p": viscous["phi_p"]})


def test_a_model_comes_back_as_it_was(tmp_path: Path, viscous: dict[str, Any]) -> None:
    model = bowden.identify(viscous).model
    model.save(tmp_path / "model.toml")
    again = bowden.Model.load(tmp_path / "model.toml")
    assert again == model and again.terms[0].effect == "viscous"
    assert again.transmission is not None
    assert again.transmission.gain == pytest.approx(0.95, rel=0.02)
    assert again.terms[0].gain == pytest.approx(-1.2, rel=0.02)
    with pytest.raises(bowden.Error, match="ends in .toml, .rs or .postcard"):
        model.save(tmp_path / "model.json")
