"""Times have units, numbers have none: converted or refused, wherever they are given."""

from __future__ import annotations

import datetime
from typing import Any, Callable

import numpy as np
import pandas
import polars
import pytest

import bowden
import records

DT = 0.001

#: A millisecond.
TIMES: dict[str, Any] = {
    "seconds": 0.001,
    "numpy.float32": np.float32(0.001),
    "timedelta64[ms]": np.timedelta64(1, "ms"),
    "timedelta64[us]": np.timedelta64(1000, "us"),
    "timedelta64[ns]": np.timedelta64(1_000_000, "ns"),
    "array of no dimension": np.array(1000, dtype="m8[us]"),
    "pandas.Timedelta": pandas.Timedelta("1ms"),
    "datetime.timedelta": datetime.timedelta(milliseconds=1),
}


def exact(name: str) -> float:
    return float(np.float32(0.001)) if name == "numpy.float32" else 0.001


@pytest.mark.parametrize("name", TIMES)
def test_a_time_is_its_seconds_wherever_one_is_given(name: str, plain: dict[str, Any]) -> None:
    dt, s = TIMES[name], exact(name)
    one, zero = np.ones(5), np.zeros(5)
    assert bowden.PI(2, 10).step(dt, 1.0, 0.0) == bowden.PI(2, 10).step(s, 1.0, 0.0)
    np.testing.assert_equal(bowden.PI(2, 10).run(dt, one, zero), bowden.PI(2, 10).run(s, one, zero))
    assert bowden.PI(longest_dt=dt).longest_dt == s
    assert bowden.PID(derivative_time=dt).derivative_time == s
    assert bowden.Adaptive(form=("as-published", dt)).form == ("as-published", s)
    tracked = bowden.PI(anti_windup="back-calculation", tracking_time=dt)
    assert tracked.tracking_time == s
    plant = bowden.NominalPlant(0.6, 25.5, 0.265)
    observer = bowden.DisturbanceObserver(plant, dt, 1.0, latency=dt, longest_dt=dt)
    assert (observer.time_constant, observer.latency, observer.longest_dt) == (s, s, s)
    assert bowden.Rates(dt).time_constant == bowden.Rates(1.0, longest_gap=dt).longest_gap == s
    assert bowden.Ramp(1.0, dt).time_constant == s
    assert bowden.Ramp(1.0).step(dt, 9.0) == pytest.approx(s)
    rest = {"b": 0.02, "kappa_eta": 0.1, "t0": 0.2}
    assert bowden.Rig(sensor_lag=dt).sensor_lag == s
    assert bowden.Rig(drift={"time": dt, **rest}).drift == {"time": s, **rest}
    assert bowden.Rig().step(10.0, dt) == bowden.Rig().step(10.0, s)
    for each in (dt, [dt] * 3, np.array([dt] * 3)):
        found = bowden.Rig().run(np.ones(3), each)
        np.testing.assert_array_equal(found["time"], bowden.Rig().run(np.ones(3), s)["time"])
    track = bowden.Rig().track(bowden.PI(), one, dt)
    np.testing.assert_array_equal(track["tau_o"], bowden.Rig().track(bowden.PI(), one, s)["tau_o"])
    np.testing.assert_array_equal(
        bowden.paper_reference([0.5], dt), bowden.paper_reference([0.5], s)
    )


def test_seconds_of_close_and_check_and_predict(plain: dict[str, Any]) -> None:
    def samples(**given: Any) -> Any:
        return bowden.identify(plain, max_terms=0, figures=False, **given).record.samples

    expected = samples(start=2.0, end=20.0)
    assert expected < samples()
    assert samples(start=np.timedelta64(2, "s"), end=pandas.Timedelta("20s")) == expected
    assert (
        samples(start=datetime.timedelta(seconds=2), end=20, time_limit=np.timedelta64(9, "m"))
        == expected
    )
    model = bowden.identify(plain, max_terms=0).model
    last = bowden.validate(model, plain, start=datetime.timedelta(seconds=2)).record.samples
    assert last == bowden.validate(model, plain, start=2.0).record.samples
    motion = np.zeros((50, 3))
    motion[:, 0] = np.linspace(0.0, 5.0, 50)
    given: dict[str, Any] = {
        "input": motion[:, 0],
        "channels": {name: motion[:, 0] for name in model.channels},
    }
    by_seconds = model.predict(dt=0.005, time_constant=0.01, **given)
    by_unit = model.predict(
        dt=np.timedelta64(5, "ms"), time_constant=pandas.Timedelta("10ms"), **given
    )
    np.testing.assert_array_equal(by_seconds, by_unit)


STAMPS = pandas.date_range("2026-01-01", periods=5, freq="1ms")


@pytest.mark.parametrize(
    "dt",
    [
        np.diff(STAMPS.values, prepend=STAMPS.values[0] - np.timedelta64(1, "ms")),
        STAMPS.to_series().diff().fillna(pandas.Timedelta("1ms")),
        pandas.to_timedelta(np.ones(5), unit="ms"),
        polars.Series([datetime.timedelta(milliseconds=1)] * 5),
        [datetime.timedelta(milliseconds=1)] * 5,
        [pandas.Timedelta("1ms")] * 5,
        np.full(5, 0.001),
        [0.001] * 5,
    ],
    ids=lambda dt: type(dt).__name__,
)
def test_an_array_of_times_has_one_for_each_sample(dt: Any) -> None:
    run = bowden.PI(2, 10).run(dt, np.ones(5), np.zeros(5))
    np.testing.assert_allclose(run.command, [2.01, 2.02, 2.03, 2.04, 2.05], rtol=1e-12)
    assert not run.status.any()


def test_each_sample_has_its_own_time() -> None:
    dt = np.array([1, 5, 2], dtype="m8[ms]")
    run = bowden.PI(2, 10).run(dt, 1.0, 0.0)
    np.testing.assert_allclose(run.command, 2.0 + 10.0 * np.cumsum([0.001, 0.005, 0.002]))
    # A duration that is missing is a bad sample, and no error.
    dt[1] = np.timedelta64("NaT")
    bad = bowden.PI(2, 10).run(dt, 1.0, 0.0)
    assert bad.fault.tolist() == [0, bowden.Fault.DT, 0]
    series = STAMPS.to_series().diff()
    assert bowden.PI(2, 10).run(series, 1.0, 0.0).fault.tolist() == [bowden.Fault.DT, 0, 0, 0, 0]


class Quantity:
    """As those of astropy and pint: numpy would take the bare number."""

    unit = "ms"

    def to(self, unit: str) -> float:
        return 0.001

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return np.array(1.0)


#: What is neither a number nor a time.
NEITHER: dict[str, Any] = {
    "True": True,
    "numpy.True_": np.True_,
    "text": "1",
    "bytes": b"1",
    "None": None,
    "complex": 1j,
    "object": object(),
    "mapping": {},
    "datetime64": np.datetime64("2026-01-01"),
    "datetime": datetime.datetime(2026, 1, 1),
    "date": datetime.date(2026, 1, 1),
    "pandas.Timestamp": pandas.Timestamp("2026-01-01"),
    "quantity": Quantity(),
    "ragged": [[1.0], [1.0, 2.0]],
    "array of texts": np.array(["1", "2"]),
    "array of bools": np.array([True, False]),
    "array of objects": np.array([1.0, None]),
    "too many dimensions": np.ones((2, 2, 2)),
}
#: No number, and no time of a known length.
NO_NUMBER = {
    **NEITHER,
    "timedelta64": np.timedelta64(1, "ms"),
    "timedelta": datetime.timedelta(1),
    "pandas.Timedelta": pandas.Timedelta("1s"),
    "array of timedelta64": np.array([1, 2], dtype="m8[ms]"),
}
NO_TIME = {
    **NEITHER,
    "timedelta64 without a unit": np.timedelta64(1),
    "a month": np.timedelta64(1, "M"),
}

Call = Callable[[Any], object]
RIG, PI = bowden.Rig(), bowden.PI()
PLANT = bowden.NominalPlant(0.6, 25.5, 0.265)

NUMBERS: dict[str, Call] = {
    "k_p": lambda v: bowden.PI(k_p=v),
    "slew": lambda v: bowden.PI(slew=v if v is not None else "x", limits=(-1, 1)),
    "limits": lambda v: bowden.PI(limits=(-1e9, v)),
    "fallback": lambda v: bowden.PI(fallback=(3, v)),
    "gain": lambda v: bowden.Adaptive(gain=v),
    "beta.gain": lambda v: bowden.Adaptive(beta={"gain": v if v is not None else "x"}),
    "form": lambda v: bowden.Adaptive(form=("first-order", 0.001, v)),
    "reference": lambda v: bowden.PI().step(DT, v, 0.0),
    "measured": lambda v: bowden.PI().run(DT, 1.0, v),
    "velocity": lambda v: bowden.PI().run(DT, 1.0, 0.0, velocity=v),
    "feed_forward": lambda v: bowden.PI().step(DT, 1.0, 0.0, feed_forward=v),
    "regressors": lambda v: bowden.Adaptive(theta=[{}]).step(DT, 1.0, 0.0, regressors=[v]),
    "output": lambda v: bowden.PI().resume_from(v, 1.0, 0.0),
    "natural_frequency": lambda v: bowden.NominalPlant(1.0, v, 1.0),
    "velocity of a plant": lambda v: (
        PLANT.feed_forward(1.0, v) if v is not NEITHER["too many dimensions"] else no()
    ),
    "limit": lambda v: bowden.DisturbanceObserver(PLANT, 0.01, v),
    "forgetting": lambda v: bowden.IterativeLearning(1.0, 1.0, cells=50, forgetting=v),
    "command": lambda v: bowden.Rig().step(v),
    "load": lambda v: bowden.Rig().run(np.ones(2), load=v),
    "noise": lambda v: bowden.Rig(noise=v if v is not None else "x"),
    "undeclared": lambda v: bowden.Rig(undeclared=[{"effect": "viscous", "gain": v}]),
    "reference of track": lambda v: bowden.Rig().track(bowden.PI(), v),
    "position": lambda v: bowden.Rates(0.01).step(DT, v),
    "wanted": lambda v: bowden.Ramp(1.0).run(DT, v),
    "sample": lambda v: bowden.Plausible(-1, 1).step(DT, v),
    "rate": lambda v: bowden.Ramp(v),
    "cutoff of rates": lambda v: bowden.Rates.for_cutoff(v),
    "cutoff": lambda v: bowden.identify({}, cutoff=v if v is not None else "x"),
    "rate of close": lambda v: bowden.identify({}, rate=v if v is not None else "x"),
}


def no() -> None:
    raise bowden.Error("velocity: three dimensions are arrays of one shape there")


SECONDS: dict[str, Call] = {
    "dt": lambda v: bowden.PI().step(v, 1.0, 0.0),
    "dt of run": lambda v: bowden.PI().run(v, np.ones(3), 0.0),
    "dt of lanes": lambda v: bowden.PI(lanes=2).step(v, 1.0, 0.0),
    "longest_dt": lambda v: bowden.PI(longest_dt=v if v is not None else "x"),
    "derivative_time": lambda v: bowden.PID(derivative_time=v),
    "form": lambda v: bowden.Adaptive(form=("as-published", v)),
    "time_constant": lambda v: bowden.DisturbanceObserver(PLANT, v, 1.0),
    "latency": lambda v: bowden.DisturbanceObserver(PLANT, 0.1, 1.0, latency=v),
    "time_constant of rates": lambda v: bowden.Rates(v),
    "dt of rates": lambda v: bowden.Rates(0.1).step(v, 1.0),
    "dt of a ramp": lambda v: bowden.Ramp(1.0).run(v, np.ones(3)),
    "sensor_lag": lambda v: bowden.Rig(sensor_lag=v if v is not None else "x"),
    "drift": lambda v: bowden.Rig(drift={"time": v}),
    "dt of a rig": lambda v: bowden.Rig().step(1.0, v),
    "dt of run of a rig": lambda v: bowden.Rig().run(np.ones(3), v),
    "dt of track": lambda v: bowden.Rig().track(bowden.PI(), np.ones(3), v),
    "ramp": lambda v: bowden.paper_reference([0.0], v),
    "t": lambda v: bowden.paper_reference(v),
    "start": lambda v: bowden.identify({}, start=v),
    "end": lambda v: bowden.identify({}, end=v if v is not None else "x"),
    "time_limit": lambda v: bowden.identify({"t": np.zeros(3)}, time_limit=v if v is not None else "x"),
}


def refused(call: Call, value: Any, name: str) -> None:
    with pytest.raises(bowden.Error) as found:
        call(value)
    message = str(found.value)
    # The argument's name, and what is allowed.
    assert name.split(" of ")[0].split(".")[0] in message, message
    assert "allowed" in message or "arrays of one shape" in message, message


@pytest.mark.parametrize("value", NO_NUMBER)
@pytest.mark.parametrize("name", NUMBERS)
def test_what_is_no_number_is_refused_by_name(name: str, value: str) -> None:
    refused(NUMBERS[name], NO_NUMBER[value], name)


@pytest.mark.parametrize("value", NO_TIME)
@pytest.mark.parametrize("name", SECONDS)
def test_what_is_no_time_is_refused_by_name(name: str, value: str) -> None:
    refused(SECONDS[name], NO_TIME[value], name)


@pytest.mark.parametrize("value", [True, "1", None, 1.5, np.timedelta64(1, "s"), [1], -1])
@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("lanes", lambda v: bowden.PI(lanes=v if v is not None else "x")),
        ("seed", lambda v: bowden.Rig(seed=v if v != [1] else "x")),
        ("cells", lambda v: bowden.IterativeLearning(1.0, 1.0, cells=v)),
        ("lead", lambda v: bowden.IterativeLearning(1.0, 1.0, cells=50, lead=v)),
        ("delay", lambda v: bowden.Rig(delay=v if v is not None else "x")),
        ("stuck_after", lambda v: bowden.Plausible(-1, 1, stuck_after=v if v is not None else "x")),
        ("fallback", lambda v: bowden.PI(fallback=(v, 0.0))),
        ("max_terms", lambda v: bowden.identify({}, max_terms=v if v is not None else "x")),
        ("threads", lambda v: bowden.identify(records.torque(), threads=v if v is not None else "x")),
    ],
)
def test_what_counts_nothing_is_refused_by_name(name: str, call: Call, value: Any) -> None:
    with pytest.raises(bowden.Error, match=f"^{name}.*(allowed|expected)"):
        call(value)


@pytest.mark.parametrize("value", [1, 0.0, "yes", None, np.array([1.0])])
def test_what_is_neither_true_nor_false_is_refused_by_name(value: Any) -> None:
    learning = bowden.IterativeLearning(4.0, 30.0, cells=50)
    with pytest.raises(bowden.Error, match="^learns.*True or False is allowed"):
        bowden.PI(learning=learning).step(DT, 1.0, 0.0, phase=0.5, learns=value)
    with pytest.raises(bowden.Error, match="^moves.*True or False is allowed"):
        bowden.Plausible(-1.0, 1.0).run(DT, np.zeros(3), moves=value)


@pytest.mark.parametrize("number", [3, 3.0, np.float32(3), np.int64(3), np.array(3), np.uint8(3)])
def test_any_kind_of_number_is_one(number: Any) -> None:
    pi = bowden.PI(number, number, limits=(-float(number), 3 * float(number)))
    assert (pi.k_p, pi.k_i) == (3.0, 3.0)
    expected = bowden.PI(3.0, 3.0, limits=(-3.0, 9.0)).step(DT, 3.0, 0.0)
    assert pi.step(DT, number, 0) == expected


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: PI.step([DT] * 2, 1.0, 0.0), r"^dt: shape \(2,\)"),
        (lambda: PI.step(DT, [1.0, 2.0], 0.0), r"^reference: shape \(2,\)"),
        (lambda: PI.run(DT, np.ones(5), np.ones(4)), r"^measured: shape \(4,\); \(\) or \(5,\)"),
        (lambda: PI.run(np.ones(4), np.ones(5), 0.0), r"^dt: shape \(4,\); \(\) or \(5,\)"),
        (lambda: bowden.PI(lanes=2).step(DT, np.ones(3), 0.0), r"^reference: shape \(3,\)"),
        (lambda: bowden.PI(k_p=np.ones((2, 2))), r"^k_p: shape \(2, 2\)"),
        (lambda: RIG.step([1.0, 2.0]), r"^command: shape \(2,\)"),
        (lambda: RIG.run(np.ones((5, 3))), r"^command: shape \(5, 3\)"),
        (lambda: RIG.track(bowden.PI(), np.ones((5, 1))), r"^reference: shape \(5, 1\)"),
        (lambda: RIG.track(bowden.PI(lanes=2), np.ones(5)), "2 controllers on 1 rigs"),
        (lambda: RIG.track(3, np.ones(5)), "^controller: int; PI, PID, PIV or Adaptive"),
        (lambda: PI.step(DT, 1.0, 0.0, regressors=[1.0]), "^regressors: 1 are given; 0"),
        (lambda: PI.step(DT, 1.0, 0.0, regressors=3), "^regressors=3: a sequence"),
        (lambda: bowden.PI(limits=5.0), r"^limits=5.0: \(low, high\)"),
        (lambda: bowden.PI(limits="ab"), r"^limits='ab': \(low, high\)"),
        (lambda: bowden.PI(limits=(5.0, 1.0)), r"^limits=\(5.0, 1.0\): .*low < high"),
        (lambda: bowden.PI(slew=5.0), "^slew: limits="),
        (lambda: bowden.PI(fallback_weight=5), "^fallback_weight: fallback="),
        (lambda: bowden.PI(anti_windup="clam"), '^anti_windup=\'clam\': one of "none", "clamp"'),
        (lambda: bowden.PI(anti_windup="back-calculation"), "^tracking_time: needed"),
        (lambda: bowden.PI(tracking_time=0.1), "^tracking_time: .*allowed only there"),
        (lambda: bowden.Adaptive(beta={"initail": 1.0}), "^beta: `initail`; a mapping of initial"),
        (lambda: bowden.Adaptive(beta=3.0), "^beta=3.0: a mapping of initial"),
        (lambda: bowden.Adaptive(theta=[{}] * 5), "5 estimates; 0 to 4 are allowed"),
        (lambda: bowden.Adaptive(form=("first-order", 0.1)), r"^form=\('first-order', 0.1\): \(\"as-published\""),
        (lambda: bowden.Adaptive(missing="x"), "^missing='x'"),
        (lambda: bowden.Adaptive(frozen=1), "^frozen=1: True or False"),
        (lambda: bowden.Adaptive(delta={"leakage": ("switching", 1.0)}), "^delta.leakage="),
        (lambda: bowden.PI(k_p=np.inf), "^k_p=inf: finite numbers"),
    ],
)
def test_a_wrong_shape_or_word_is_refused_by_name(call: Callable[[], object], message: str) -> None:
    with pytest.raises(bowden.Error, match=message):
        call()


def test_only_the_time_column_has_times(plain: dict[str, Any]) -> None:
    timed = (plain["tau_i"] * 1e6).astype("m8[us]")
    refusal = "column `tau_i`: values of timedelta64.*times only in the time column"
    for record in ({**plain, "tau_i": timed}, pandas.DataFrame({**plain, "tau_i": timed})):
        with pytest.raises(bowden.Error, match=refusal):
            bowden.identify(record)
    with pytest.raises(bowden.Error, match=refusal):
        bowden.identify(plain["t"], tau_i=timed, tau_o=plain["tau_o"])
    with pytest.raises(bowden.Error, match="column `phi`: values of timedelta64"):
        bowden.identify(plain, channels={"phi": timed})
