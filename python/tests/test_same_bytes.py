"""The package and the program give the same bytes for the same record."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import polars
import pytest

import bowden
import records
from conftest import Run


def without_seconds(text: str) -> str:
    """All of it but the wall time, which no two runs share."""
    cut, count = re.subn(r'"seconds":\{[^{}]*\}', '"seconds":{}', text)
    assert count == 1, text[-300:]
    return cut


def both(program: Run, tmp_path: Path, record: dict[str, Any], *options: str) -> tuple[str, Path]:
    path = records.write_csv(tmp_path / "record.csv", record)
    return program("identify", path, "--json", *options).rstrip("\n"), path


def test_a_file(program: Run, tmp_path: Path, viscous: dict[str, Any]) -> None:
    expected, path = both(program, tmp_path, viscous)
    report = bowden.identify(path)
    assert without_seconds(report.json) == without_seconds(expected)
    assert report.to_dict() == json.loads(report.json)
    assert report.names == ["viscous"]


@pytest.mark.parametrize("kind", ["arrays", "pandas", "polars", "mapping", "structured", "pyarrow"])
def test_arrays_and_frames(
    program: Run, tmp_path: Path, viscous: dict[str, Any], kind: str
) -> None:
    expected, path = both(program, tmp_path, viscous, "--baseline", "bouc-wen,viscous@phi_p")
    options: dict[str, Any] = {"baseline": ["bouc-wen", "viscous@phi_p"], "label": str(path)}
    if kind == "arrays":
        ends = {name: viscous[name] for name in ("t", "tau_i", "tau_o")}
        report = bowden.identify(**ends, channels={"phi_p": viscous["phi_p"]}, **options)
    elif kind == "structured":
        rows = np.empty(len(viscous["t"]), dtype=[(name, "f8") for name in viscous])
        for name in viscous:
            rows[name] = viscous[name]
        report = bowden.identify(rows, **options)
    elif kind == "pyarrow":
        pyarrow = pytest.importorskip("pyarrow")
        report = bowden.identify(pyarrow.table(viscous), **options)
    else:
        frame = {"pandas": pandas.DataFrame, "polars": polars.DataFrame, "mapping": dict}[kind]
        report = bowden.identify(frame(viscous), **options)
    assert without_seconds(report.json) == without_seconds(expected)


@pytest.mark.parametrize(
    ("options", "given"),
    [
        (["--max-terms", "0"], {"max_terms": 0}),
        (["--cutoff", "8"], {"cutoff": 8}),
        (["--start", "2.5", "--end", "24"], {"start": 2.5, "end": 24}),
        (["--rate", "250"], {"rate": 250}),
        (["--invertible"], {"invertible": True}),
        (["--baseline", "bouc-wen,coulomb"], {"baseline": ["bouc-wen", "coulomb"]}),
        (["--channel", "other=tau_i-phi_p"], {"channels": {"other": "tau_i-phi_p"}}),
        (
            ["--mode", "displacement", "--input", "phi_p", "--output", "tau_o", "--time", "t"],
            {"mode": "displacement", "input": "phi_p", "output": "tau_o", "time": "t"},
        ),
    ],
)
def test_options(
    program: Run,
    tmp_path: Path,
    viscous: dict[str, Any],
    options: list[str],
    given: dict[str, Any],
) -> None:
    expected, path = both(program, tmp_path, viscous, *options)
    report = bowden.identify(pandas.DataFrame(viscous), label=str(path), **given)
    assert without_seconds(report.json) == without_seconds(expected)


def test_what_is_drawn_does_not_change_the_answer(viscous: dict[str, Any]) -> None:
    drawn, not_drawn = (bowden.identify(viscous, figures=f).json for f in (True, False))
    assert without_seconds(drawn) == without_seconds(not_drawn)


def test_any_float(viscous: dict[str, Any], program: Run, tmp_path: Path) -> None:
    single = {name: values.astype(np.float32) for name, values in viscous.items()}
    # A time in single precision jitters: it stays double.
    single["t"] = viscous["t"]
    expected, path = both(program, tmp_path, single)
    report = bowden.identify(single, label=str(path))
    assert without_seconds(report.json) == without_seconds(expected)
    strided = np.stack([viscous["tau_i"], viscous["tau_o"]], axis=1)
    assert strided[:, 0].strides == (16,)
    arrays = {"t": viscous["t"], "tau_i": strided[:, 0], "tau_o": strided[:, 1]}
    expected, path = both(program, tmp_path, arrays)
    report = bowden.identify(**arrays, label=str(path))
    assert without_seconds(report.json) == without_seconds(expected)


@pytest.mark.parametrize("own", [False, True])
def test_several_files(program: Run, tmp_path: Path, own: bool) -> None:
    gains = (0.95, 0.8) if own else (0.95, 0.95)
    all = [records.torque(seed=3 + k, gain=g, viscous=1.0) for k, g in enumerate(gains)]
    paths = [records.write_csv(tmp_path / f"{k}.csv", one) for k, one in enumerate(all)]
    option = ["--per-file", "gains"] if own else []
    model = tmp_path / "model.toml"
    expected = program("identify", *paths, "--json", "--model-out", model, *option).rstrip("\n")
    report = bowden.identify(list(map(str, paths)), per_file="gains" if own else None)
    assert without_seconds(report.json) == without_seconds(expected)
    frames = [bowden.read(one, label=str(path)) for one, path in zip(all, paths)]
    again = bowden.identify(frames, per_file="gains" if own else None)
    assert without_seconds(again.json) == without_seconds(expected)
    written = [tmp_path / "model-1.toml", tmp_path / "model-2.toml"] if own else [model]
    assert [m.toml for m in report.models] == [p.read_bytes().decode() for p in written]


def test_models_trace_and_figure(program: Run, tmp_path: Path, viscous: dict[str, Any]) -> None:
    path = records.write_csv(tmp_path / "record.csv", viscous)
    report = bowden.identify(path)
    for ending in ("toml", "rs", "postcard"):
        theirs, ours = tmp_path / f"theirs.{ending}", tmp_path / f"ours.{ending}"
        program("identify", path, "--model-out", theirs)
        report.model.save(ours)
        assert ours.read_bytes() == theirs.read_bytes(), ending
    assert report.vectors == [(tmp_path / "theirs.vector.csv").read_text(encoding="utf-8")]
    trace = tmp_path / "trace.csv"
    for name in ("loop", "residual", "trace", "shares"):
        figure = tmp_path / "figure.svg"
        program("identify", path, "--trace", trace, "--plot", figure, "--figure", name)
        assert report.figure(name) == figure.read_text(encoding="utf-8")
    assert report.trace_csv == trace.read_text(encoding="utf-8")
    page = tmp_path / "page.html"
    program("identify", path, "--report", page)
    # Pages differ in what was typed alone.
    typed = re.compile(r"<pre tabindex=\"0\"><code>.*?</code></pre>")
    ours, theirs = report.page(), page.read_text(encoding="utf-8")
    assert typed.sub("", ours) == typed.sub("", theirs)
    assert f"bowden.identify(&#39;{path}&#39;)" in ours or f"bowden.identify('{path}')" in ours


def test_check(
    program: Run, tmp_path: Path, viscous: dict[str, Any], plain: dict[str, Any]
) -> None:
    first = records.write_csv(tmp_path / "first.csv", viscous)
    second = records.write_csv(tmp_path / "second.csv", plain)
    third = records.write_csv(tmp_path / "third.csv", records.torque(seed=9, viscous=1.2))
    model = tmp_path / "model.toml"
    bowden.identify(first).model.save(model)
    for path, verdict in ((second, "does-not-hold"), (third, "holds")):
        trace = tmp_path / "trace.csv"
        expected = program("validate", model, path, "--json", "--trace", trace).rstrip("\n")
        found = bowden.validate(model, path)
        assert found.json == expected
        assert found.verdict == verdict
        assert found.trace_csv == trace.read_text(encoding="utf-8")
    loaded = bowden.Model.load(model)
    assert bowden.validate(loaded, plain, label=str(second)).nrmse == bowden.validate(model, second).nrmse
