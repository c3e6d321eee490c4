"""What type checkers are told of a report is what is in it."""

from __future__ import annotations

import ast
import contextlib
import io
import re
from pathlib import Path
from typing import Any

import pytest

import bowden
import records

PACKAGE = Path(bowden.__file__).parent


def fields(tree: ast.AST) -> dict[str, set[str]]:
    """Of each class the names that it annotates, those under TYPE_CHECKING included."""
    classes = (node for node in ast.walk(tree) if isinstance(node, ast.ClassDef))
    return {
        one.name: {
            node.target.id
            for part in one.body
            if isinstance(part, (ast.AnnAssign, ast.If))
            for node in ast.walk(part)
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
        }
        for one in classes
    }


@pytest.fixture(scope="module")
def told() -> dict[str, set[str]]:
    all: dict[str, set[str]] = {}
    for name in ("_parts.pyi", "_report.py"):
        all.update(fields(ast.parse((PACKAGE / name).read_text(encoding="utf-8"))))
    return all


def test_the_fields_are_those_of_the_json(told: dict[str, set[str]]) -> None:
    one = bowden.identify(records.torque(seed=1, viscous=1.2))
    stuck = records.torque(seed=2)
    stuck["tau_o"][900:2400] = stuck["tau_o"][900]
    two = bowden.identify([records.torque(seed=k, viscous=1.2) for k in (3, 4)])
    spoilt = bowden.identify(stuck)
    checked = bowden.validate(one.model, records.torque(seed=5, viscous=1.2))
    assert told["Report"] == {*one.keys(), *two.keys()}
    assert told["CheckReport"] == {*checked.keys()}
    assert told["RecordPart"] == {*one.record.keys(), *two.records[0].keys()}
    by_file = {"rmse_by_file", "nrmse_by_file"}
    term = {*one.terms[0].keys(), *two.terms[0].keys()}
    assert told["Term"] - {"models", "not_refitted_without"} == term
    findings = {key for report in (one, spoilt) for own in report.findings for key in own.keys()}
    assert told["Finding"] == findings
    found: dict[str, Any] = {
        "Segments": one.output_std,
        "Coefficient": one.terms[0].coefficients[0],
        "CheckedRecord": checked.record,
        "ModelPart": one.baseline,
        "FinalPart": one.final,
        "Rejected": one.rejected[0],
        "Defect": spoilt.defects[0],
        "Fitted": checked.gain,
        "Cost": one.cost,
    }
    for name, part in found.items():
        assert told[name] == {*part.keys()} - by_file, name
    parameter = {*one.final.parameters[0].keys()}
    assert told["Parameter"] | told["Coefficient"] == parameter


def test_what_the_readme_shows_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    readme = Path(__file__).resolve().parents[1] / "README.md"
    blocks = re.findall(r"```python\n(.*?)```", readme.read_text(encoding="utf-8"), re.DOTALL)
    assert len(blocks) == 6
    monkeypatch.chdir(tmp_path)
    with contextlib.redirect_stdout(io.StringIO()) as said:
        exec(compile("\n".join(blocks), str(readme), "exec"), {})
    assert "The baseline model lacks friction over the velocity of phi_p" in said.getvalue()
    assert "record.csv: no such file" in said.getvalue()
    assert "\nheld measured\n" in said.getvalue() and "OUT_OF_RANGE" in said.getvalue()
    assert {p.name for p in tmp_path.iterdir()} == {"report.html", "model.toml"}
