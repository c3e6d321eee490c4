"""Wrong use raises `bowden.Error`, and what is not a number is not taken for one."""

from __future__ import annotations

import hashlib
import os
import threading
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pytest

import bowden
import records


@pytest.fixture(scope="module")
def model(viscous: dict[str, Any]) -> bowden.Model:
    return bowden.identify(viscous).model


def test_points_in_time_are_seconds_in_predict(model: bowden.Model, plain: dict[str, Any]) -> None:
    channels = {"phi_p": plain["phi_p"]}
    expected = model.predict(plain["t"], plain["tau_i"], channels)
    since = (plain["t"] * 1e9).round().astype("timedelta64[ns]")
    for t in (since, np.datetime64("2026-03-01T12:00:00", "ns") + since):
        found = model.predict(t, plain["tau_i"], channels)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)
    with pytest.raises(bowden.Error, match="column `input`: values of timedelta64"):
        model.predict(plain["t"], since, channels)


def test_what_is_masked_is_no_number(model: bowden.Model, plain: dict[str, Any]) -> None:
    masked = np.ma.masked_array(plain["tau_o"], mask=False)
    masked[40] = np.ma.masked
    record = {**plain, "tau_o": masked}
    with pytest.raises(bowden.Error) as found:
        bowden.identify(record)
    assert (found.value.line, found.value.column) == (41, "tau_o")
    assert bowden.identify(record, drop_bad=True, max_terms=0).record.dropped == 1
    t = np.ma.masked_array(plain["t"], mask=plain["t"] == plain["t"][7])
    with pytest.raises(bowden.Error, match=r"t\[7\] = nan") as found:
        model.predict(t, plain["tau_i"], {"phi_p": plain["phi_p"]})
    assert (found.value.line, found.value.column) == (8, "t")
    pi = bowden.PI()
    run = pi.run(0.001, 1.0, np.ma.masked_array([0.5, 0.5], mask=[False, True]))
    assert run.status.tolist() == [bowden.Status.GOOD, bowden.Status.HELD]


def test_the_page_states_what_was_read(tmp_path: Path, plain: dict[str, Any]) -> None:
    path = records.write_csv(tmp_path / "record.csv", plain)
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    model = tmp_path / "model.toml"
    report = bowden.identify(path)
    report.model.save(model)
    reports = [report, bowden.validate(model, path), bowden.identify(bowden.read(path))]
    path.write_text("something else")
    assert all(digest in report.page() for report in reports)
    path.unlink()
    assert all(digest in report.page() for report in reports)


@pytest.mark.parametrize("kind", ["datetime64[ns]", "timedelta64[ns]", "int64", "uint64", "Int64"])
def test_nanoseconds_are_kept_far_from_where_time_began(plain: dict[str, Any], kind: str) -> None:
    # 200 days and 55 years: a double has steps of 2 and 256 ns there.
    start = 200 * 86_400 * 10**9 if kind == "timedelta64[ns]" else 1_750_000_000 * 10**9
    count = np.arange(len(plain["t"]), dtype=np.int64)
    t: Any = start + 1_000_001 * count
    units = {} if "[ns]" in kind else {"t": "ns"}
    t = pytest.importorskip("pandas").array(t, dtype=kind) if kind == "Int64" else t.astype(kind)
    found = bowden.read({**plain, "t": t}, mode="torque", units=units).t
    # Half a nanosecond would be seen; 30 s in doubles have steps of 4e-15 s.
    assert np.abs(np.diff(found) - 1.000001e-3).max() < 1e-13


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with a name")
def test_the_page_states_the_hash_of_what_came_through_a_pipe(
    tmp_path: Path, plain: dict[str, Any]
) -> None:
    content = records.write_csv(tmp_path / "record.csv", plain).read_bytes()
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    # Once: a second reading would wait for ever.
    writer = threading.Thread(target=pipe.write_bytes, args=(content,), daemon=True)
    writer.start()
    report = bowden.identify(pipe)
    writer.join()
    assert hashlib.sha256(content).hexdigest() in report.page()


Wrong = Callable[[bowden.Model, dict[str, Any]], object]
WRONG: list[tuple[Wrong, str]] = [
    (lambda m, r: bowden.validate("none.toml", r), r"^none.toml: no such file$"),
    (lambda m, r: bowden.Model.load("none.toml"), r"^none.toml: no such file$"),
    (lambda m, r: bowden.Model.load(Path(__file__).parent), "cannot be read"),
    (lambda m, r: bowden.identify(r, max_terms=-1), "^max_terms=-1: a whole number from 0 to 8 is allowed$"),
    (lambda m, r: bowden.identify(r, max_terms=1.5), "^max_terms=1.5: a whole number from 0 to 8 is allowed$"),
    (lambda m, r: bowden.identify(r, names="t,x,f"), "^names='t,x,f': a list of names is allowed"),
    (lambda m, r: bowden.identify(r, names=["t", 3]), "^names=.'t', 3.: a list of names"),
    (lambda m, r: bowden.identify(r, header_line=-1), "^header_line=-1: a line from 1 up"),
    (lambda m, r: bowden.identify(r, threads=-1), "^threads=-1: one or more are allowed$"),
    (lambda m, r: bowden.validate(m, r, threads=-1), "^threads=-1: one or more are allowed$"),
    (lambda m, r: bowden.Rig(seed=-1), r"^seed=-1: whole numbers from 0 to 2\*\*64 - 1"),
    (lambda m, r: bowden.Rig(seed=[3, 2**64]), "^seed=18446744073709551616: whole numbers"),
    (lambda m, r: bowden.PI(lanes=0), "^lanes=0: a whole number from 1 is allowed$"),
    (lambda m, r: bowden.Rig(lanes=-2), "^lanes=-2: a whole number from 1 is allowed$"),
    (lambda m, r: bowden.PI(np.array([])), r"^k_p: shape \(0,\); a number, or one for each lane, is allowed$"),
    (lambda m, r: predict(m, r, dt=0.0), "^dt=0.0: a positive number of seconds"),
    (lambda m, r: predict(m, r, dt=np.nan), "^dt=nan: a positive number of seconds"),
    (lambda m, r: predict(m, r, t=r["t"][::-1]), r"t\[1\] = .* s is not after t\[0\] = "),
    (lambda m, r: bowden.identify("none.csv", label="bench"), "label='bench': is for arrays"),
    (lambda m, r: bowden.identify("none.csv", units={"x": "m"}), "units={'x': 'm'}: is for arrays"),
    (lambda m, r: bowden.identify(bowden.read(r), label="bench"), "label='bench': is for arrays"),
    (lambda m, r: bowden.identify(r, units={"tau_1": "N"}), "units: `tau_1`: no such column; the"),
    (lambda m, r: bowden.identify(r, units={"tau_i": 3}), "units: `tau_i`: 3: a text"),
    (lambda m, r: bowden.identify(r["t"], r["tau_i"], r["tau_o"], units={"x": "m"}), "units: `x`"),
]


def predict(model: bowden.Model, record: dict[str, Any], **time: Any) -> object:
    return model.predict(input=record["tau_i"], channels={"phi_p": record["phi_p"]}, **time)


@pytest.mark.parametrize("case", range(len(WRONG)))
def test_wrong_use_is_an_error(model: bowden.Model, plain: dict[str, Any], case: int) -> None:
    wrong, message = WRONG[case]
    with pytest.raises(bowden.Error, match=message):
        wrong(model, plain)


def test_an_effect_is_declared_as_for_the_program(viscous: dict[str, Any]) -> None:
    report = bowden.identify(viscous, baseline="bouc-wen,viscous@phi_p", max_terms=0)
    assert report.json.count("viscous") and not report.names
    both = bowden.identify(viscous, baseline=["bouc-wen", "viscous@phi_p"], max_terms=0)
    assert report.final.nrmse.held_out == both.final.nrmse.held_out
