"""The control laws: PI, PID, PIV and the robust adaptive law."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from . import _numbers
from ._control import Controller
from ._error import Error
from ._settings import GREATEST, duration, one_of, real, setting


class Linear(Controller):
    """Base class of PI, PID and PIV."""

    k_p: Any = setting(
        default=30.0, kw_only=False, doc="Proportional gain [command unit/output unit]."
    )
    k_i: Any = setting(
        default=18.0, kw_only=False, doc="Integral gain [command unit/(output unit·s)]."
    )
    setpoint_weight: Any = setting(
        default=None, doc="Set-point weight b of the proportional term, 0 to 1; None: 1."
    )
    anti_windup: Any = setting(
        default=None,
        convert=one_of("none", "clamp", "back-calculation", "conditional"),
        core=False,
        doc="Anti-windup method: none, clamp, back-calculation (requires tracking_time) or "
        "conditional; None: conditional.",
    )
    tracking_time: Any = setting(
        default=None,
        convert=duration,
        core=False,
        doc="Time constant T_t of back-calculation [s]; k_p/k_i is a usual choice.",
    )
    integral_limit: Any = setting(
        default=None,
        doc="Largest magnitude of the integral term [command unit]; None: no limit.",
    )
    deadband: Any = setting(
        default=None,
        doc="Deadband of the integral: it is frozen while |error| is at most this value "
        "[output unit]; None: 0.",
    )
    period: Any = setting(
        default=None,
        doc="Period of an output that wraps [output unit], such as 360; None: the output does not "
        "wrap. The error is measured along the shorter way round.",
    )

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        found, way, time = super()._to_core(values), values["anti_windup"], values["tracking_time"]
        if (way == "back-calculation") != (time is not None):
            raise Error(
                'tracking_time: needed with anti_windup="back-calculation", and allowed only there'
            )
        if way is not None:
            found["anti_windup"] = way if time is None else {way: {"tracking_time": time}}
        return found

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        way = core["anti_windup"]
        own = way if isinstance(way, Mapping) else {way: {}}
        (name, inside), *_ = own.items()
        more = {"anti_windup": name, "tracking_time": inside.get("tracking_time")}
        return {**super()._from_core(core), **more}


class PI(Linear):
    """PI controller, equation (15) of Nguyen et al. (2018).

    The default gains are those of Table 1. :class:`Controller` describes limits, longest ``dt`` and
    fallback.
    """


class PID(Linear):
    """PID controller, equation (14), with a filtered derivative."""

    k_d: Any = setting(
        default=2.0, kw_only=False, doc="Derivative gain [command unit·s/output unit]."
    )
    derivative_time: Any = setting(
        default=0.1,
        kw_only=False,
        convert=duration,
        doc="Time constant of the derivative filter [s]; 0: no filter.",
    )
    derivative_weight: Any = setting(
        default=None,
        core=False,
        doc="Set-point weight c of the derivative, 0 (measurement) to 1 (error); None: 0.",
    )

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        found, weight = super()._to_core(values), values["derivative_weight"]
        return found if weight is None else {**found, "damping": {"rate": {"weight": weight}}}

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        weight = core["damping"]["rate"]["weight"]
        return {**super()._from_core(core), "derivative_weight": weight}


class PIV(Linear):
    """PIV controller, equation (16): ``k_d`` multiplies the measured distal velocity."""

    k_d: Any = setting(
        default=10.0, kw_only=False, doc="Velocity gain [command unit·s/rad]."
    )

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        return {**super()._to_core(values), "damping": "velocity"}


def _form(name: str, value: Any) -> dict[str, Any]:
    kind, *given = value if isinstance(value, (tuple, list)) else (value,)
    if kind == "as-published" and len(given) == 1:
        return {"as-published": {"time_constant": duration(f"{name}[1]", given[0])}}
    if kind == "first-order" and len(given) == 2:
        step, gain = duration(f"{name}[1]", given[0]), real(f"{name}[2]", given[1])
        return {"first-order": {"step": step, "plant_gain": gain}}
    raise Error(
        f'{name}={value!r}: ("as-published", time_constant) or ("first-order", step, plant_gain) is allowed'
    )


def _leakage(name: str, value: Any) -> Any:
    if value is None:
        return "none"
    if not isinstance(value, (tuple, list)):
        return {"constant": {"rate": real(name, value)}}
    if len(value) == 3 and value[0] == "switching":
        rate, bound = real(f"{name}[1]", value[1]), real(f"{name}[2]", value[2])
        return {"switching": {"rate": rate, "bound": bound}}
    raise Error(f'{name}={value!r}: a rate [1/s], ("switching", rate, bound) or None is allowed')


_ESTIMATOR = ("initial", "low", "high", "gain", "leakage", "prior")


def _estimator(name: str, value: Any) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise Error(f"{name}={value!r}: a mapping of {', '.join(_ESTIMATOR)} is allowed")
    for key in value:
        if key not in _ESTIMATOR:
            raise Error(f"{name}: `{key}`; a mapping of {', '.join(_ESTIMATOR)} is allowed")
    found: dict[str, Any] = {"low": -GREATEST, "high": GREATEST}
    for key, one in value.items():
        if key == "leakage":
            found[key] = _leakage(f"{name}.{key}", one)
        elif one is not None:
            found[key] = real(f"{name}.{key}", one)
    return found


def _shown_estimator(core: Mapping[str, Any]) -> dict[str, Any]:
    found = {**core, "leakage": core["leakage"]}
    for end, none in (("low", -GREATEST), ("high", GREATEST)):
        found[end] = None if core[end] == none else core[end]
    leakage = core["leakage"]
    if leakage == "none":
        found["leakage"] = None
    elif "constant" in leakage:
        found["leakage"] = leakage["constant"]["rate"]
    else:
        found["leakage"] = ("switching", *leakage["switching"].values())
    return found


def _estimators(name: str, value: Any) -> list[dict[str, Any]]:
    if isinstance(value, (str, Mapping)) or not isinstance(value, Sequence):
        raise Error(f"{name}={value!r}: a sequence of mappings, one for each regressor, is allowed")
    return [_estimator(f"{name}[{k}]", one) for k, one in enumerate(value)]


def _missing(name: str, value: Any) -> Any:
    policy = one_of("hold", "drop-regressor")
    if isinstance(value, str):
        return policy(name, value)
    if not isinstance(value, Sequence):
        raise Error(
            f'{name}={value!r}: "hold", "drop-regressor", or one of them for each regressor is allowed'
        )
    return [policy(f"{name}[{k}]", one) for k, one in enumerate(value)]


class Adaptive(Controller):
    """The robust adaptive law, equations (17)-(26) of Nguyen et al. (2018).

    The defaults are those of Table 2. An estimate is a mapping with the keys ``initial``, ``low``,
    ``high`` (None: no bound), ``gain``, ``leakage`` and ``prior``. The leakage is a rate [1/s],
    ``("switching", rate, bound)`` or None.
    """

    gain: Any = setting(default=24.0, kw_only=False, doc="Control gain k.")
    lambda_: Any = setting(
        default=8.0, kw_only=False, doc="lambda [1/s]: weight of the accumulated error."
    )
    epsilon: Any = setting(
        default=0.05, kw_only=False, doc="epsilon [N·m]: width of the smoothed sign function."
    )
    form: Any = setting(
        default=("as-published", 0.005),
        convert=_form,
        core=False,
        doc='("as-published", time_constant [s]) or ("first-order", step [s], plant_gain [N·m/command unit]).',
    )
    smooth_sign: Any = setting(
        default=None, convert=one_of("tanh", "clamp"), doc="Smoothed sign function; None: tanh."
    )
    beta: Any = setting(
        default={"initial": 0.0, "gain": 0.002 / 8.0, "leakage": 0.01},
        convert=_estimator,
        core=False,
        doc="Estimate of 1/alpha [command unit/(N·m)].",
    )
    delta: Any = setting(
        default={"initial": 7.0, "gain": 0.05 / 8.0, "leakage": 0.01},
        convert=_estimator,
        core=False,
        doc="Estimate of the bound on the disturbance [N·m].",
    )
    theta: Any = setting(
        default=({"initial": 0.0, "gain": 0.004 / 8.0, "leakage": 0.01},) * 2,
        convert=_estimators,
        core=False,
        doc="Estimate for each of 0 to 4 regressors [N·m/unit of the regressor].",
    )
    z_limit: Any = setting(
        default=None,
        core=False,
        doc="Largest magnitude of the accumulated error [N·m·s]; None: no limit.",
    )
    frozen: Any = setting(
        default=None,
        convert=_numbers.flag,
        doc="True freezes the estimates; None: False.",
    )
    missing: Any = setting(
        default=None,
        convert=_missing,
        core=False,
        doc="Response to a regressor that is not finite: hold or drop-regressor, as one text for "
        "all regressors or one for each; None: hold.",
    )

    @classmethod
    def _kept(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        return {**super()._kept(values), "regressors": len(values["theta"] or ())}

    @classmethod
    def _regressors(cls, documents: list[str]) -> int:
        return len(json.loads(documents[0])["theta"])

    @classmethod
    def _to_core(cls, values: Mapping[str, Any]) -> dict[str, Any]:
        found, missing, theta = super()._to_core(values), values["missing"], values["theta"]
        for name in ("form", "beta", "delta", "theta", "z_limit"):
            if values[name] is not None:
                found[name] = values[name]
        if missing is not None:
            found["missing"] = [missing] * len(theta) if isinstance(missing, str) else missing
        return found

    @classmethod
    def _from_core(cls, core: Mapping[str, Any]) -> dict[str, Any]:
        (form, inside), *_ = core["form"].items()
        z_limit = core["z_limit"]
        return {
            **super()._from_core(core),
            "form": (form, *inside.values()),
            "beta": _shown_estimator(core["beta"]),
            "delta": _shown_estimator(core["delta"]),
            "theta": tuple(_shown_estimator(one) for one in core["theta"]),
            "z_limit": None if z_limit == GREATEST else z_limit,
            "missing": tuple(core["missing"]),
        }
