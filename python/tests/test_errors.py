"""What is wrong is said with its place, in Python's words."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import polars
import pytest

import bowden
import records


def refused(record: Any, **options: Any) -> bowden.Error:
    with pytest.raises(bowden.Error) as found:
        bowden.identify(record, **options)
    assert isinstance(found.value, ValueError)
    return found.value


def test_of_a_file(tmp_path: Path, plain: dict[str, Any]) -> None:
    path = records.write_csv(tmp_path / "bad.csv", plain)
    lines = path.read_text().splitlines()
    lines[7] = lines[7].replace(lines[7].split(",")[1], "abc", 1)
    path.write_text("\n".join(lines))
    error = refused(path)
    assert (error.file, error.line, error.column) == (str(path), 8, "tau_i")
    assert str(error) == f"{path}:8: column `tau_i`: `abc` is not a number"
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.line, again.column) == (str(error), 8, "tau_i")
    missing = refused(tmp_path / "none.csv")
    assert str(missing) == f"{tmp_path / 'none.csv'}: no such file"
    assert (missing.file, missing.line, missing.column) == (str(tmp_path / "none.csv"), None, None)


@pytest.mark.parametrize("frame", [dict, pandas.DataFrame, polars.DataFrame])
def test_of_a_row(plain: dict[str, Any], frame: Any) -> None:
    bad = {name: values.copy() for name, values in plain.items()}
    bad["tau_o"][40] = np.nan
    error = refused(frame(bad), label="bench")
    assert (error.file, error.line, error.column) == ("bench", 41, "tau_o")
    assert "drop_bad=True drops such rows" in str(error)
    report = bowden.identify(frame(bad), drop_bad=True, max_terms=0)
    assert report.record.dropped == 1


def test_of_arrays(plain: dict[str, Any]) -> None:
    t, tau_i, tau_o = (plain[name] for name in ("t", "tau_i", "tau_o"))
    with pytest.raises(bowden.Error, match="column `tau_o`: the column has 9 values, but it must have 6000"):
        bowden.identify(t, tau_i, tau_o[:9])
    with pytest.raises(bowden.Error, match=r"column `tau_i`: shape \(6000, 1\); one dimension"):
        bowden.identify(t, tau_i[:, None], tau_o)
    with pytest.raises(bowden.Error, match="column `tau_i`: values of complex128; numbers"):
        bowden.identify(t, tau_i * 1j, tau_o)
    with pytest.raises(bowden.Error, match="column `tau_o`: no such column"):
        bowden.identify(t, tau_i)
    with pytest.raises(bowden.Error, match="no record is given"):
        bowden.identify()
    with pytest.raises(bowden.Error, match="int: a path, a frame"):
        bowden.identify(3)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"cutoff": -1}, "cutoff=-1: a positive frequency in Hz is allowed"),
        ({"max_terms": 9}, "max_terms=9: a whole number from 0 to 8 is allowed"),
        ({"time_limit": 0}, "time_limit=0: a positive number of seconds is allowed"),
        ({"per_file": "gains"}, 'per_file="gains": one record; two or more are allowed'),
        ({"per_file": "all"}, "per_file='all': \"gains\" is allowed"),
        ({"mode": "x"}, 'mode="x": "torque" or "displacement" is allowed'),
        ({"threads": 0}, "threads=0: one or more are allowed"),
        ({"start": -1}, "(frame): start=-1 is out of range (0 s or more)"),
    ],
)
def test_of_options(plain: dict[str, Any], options: dict[str, Any], message: str) -> None:
    assert str(refused(pandas.DataFrame(plain), **options)) == message


def test_options_have_their_names_in_python(plain: dict[str, Any]) -> None:
    unnamed = {"t": plain["t"], "a": plain["tau_i"], "b": plain["tau_o"]}
    message = str(refused(unnamed, input="a", output="b"))
    assert message.endswith("; set mode=torque or mode=displacement"), message
    message = str(refused({"a": plain["tau_i"], "b": plain["tau_o"]}, mode="torque"))
    assert "time= selects another one; rate= computes the time from the row number" in message
    assert "--" not in message


def test_of_an_effect_that_is_none(plain: dict[str, Any]) -> None:
    error = refused(plain, baseline=["bouc-wen", "viscus"], label="bench")
    assert str(error).startswith("bench: ") and "viscous" in str(error)
    assert error.file == "bench"


def test_of_a_model(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text("schema = 'other'\n")
    with pytest.raises(bowden.Error, match="model.toml: schema"):
        bowden.Model.load(path)
    with pytest.raises(bowden.Error, match="none.toml: no such file"):
        bowden.Model.load(tmp_path / "none.toml")


def test_points_in_time_count_from_the_first(plain: dict[str, Any]) -> None:
    start = np.datetime64("2026-03-01T12:00:00", "ns")
    stamps = start + (plain["t"] * 1e9).round().astype("timedelta64[ns]")
    expected = bowden.identify(plain, max_terms=0).final.nrmse.held_out
    for frame in (pandas.DataFrame, polars.DataFrame, dict):
        report = bowden.identify(frame({**plain, "t": stamps}), max_terms=0)
        assert report.record.rate_hz == pytest.approx(records.RATE, rel=1e-9)
        assert report.final.nrmse.held_out == pytest.approx(expected, rel=1e-6)
