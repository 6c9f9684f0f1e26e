"""What a design has to meet: limits that the user sets, what is measured against each, and who meets them."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict

from app.plots.effective import effective_network, reacts, response
from navcore.analysis import Loop, analyse
from navcore.engine.run import MethodRun, Run
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import allowed_range, extra_of, quantity
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, MINUTE
from navcore.networks.base import LinearNetwork

POINTS = 1200
"""Of the responses whose peaks are measured."""
_LONGEST_S = 48 * 3600.0
_SHORTEST_S = 1800.0
_BEYOND_SETTLED = 1.5
LOG_STEP_MPS = 1.0
_IN_SIGHT = 3.0
SETTLED = 0.02

Sense = Literal["<=", ">="]


def _limit(label: str, unit: str, sense: Sense, help: str, *, le: float, ge: float = 0.0) -> float | None:
    made = quantity(None, unit=unit, ge=ge, le=le, label=label, help=help)
    made.json_schema_extra["sense"] = sense
    return made


class Requirements(BaseModel):
    """Limits, None where there is none; each field's help says what is measured.

    Attributes
    ----------
    settling_min, overshoot_percent, damping_ratio : float or None
    h0_deviation, h_slope_s, log_tilt_arcsec : float or None
        Of the linear loop.
    tilt_max_arcsec, velocity_rms_mps, position_rms_m : float or None
        Of the run.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    settling_min: float | None = _limit(
        "settling",
        "min",
        "<=",
        "Last time at which the tilt after an initial tilt exceeds 2 % of it.",
        le=1e5,
    )
    overshoot_percent: float | None = _limit(
        "overshoot",
        "%",
        "<=",
        "Largest swing to the other side of the tilt after an initial tilt, as a part of that tilt.",
        le=1e3,
    )
    damping_ratio: float | None = _limit(
        "damping ratio", "", ">=", "Smallest damping ratio -Re/|p| of the closed-loop poles.", le=1.0
    )
    h0_deviation: float | None = _limit(
        "|H(0) - 1|",
        "",
        "<=",
        "How far the network's gain for constant errors is from 1: beyond it the loop is not Schuler-tuned.",
        le=1e3,
    )
    h_slope_s: float | None = _limit(
        "H'(0)",
        "s",
        "<=",
        "Slope of the network at s = 0. With H(0) = 1 and a slope of 0 or less the 24 h mode of the whole "
        "system does not grow; a negative slope damps it. The placement in the tab Poles keeps to it.",
        ge=-1e6,
        le=1e6,
    )
    log_tilt_arcsec: float | None = _limit(
        "tilt after log step",
        "arcsec",
        "<=",
        "Largest tilt after a step of the log's error by 1 m/s; 0 for a method without log.",
        le=1e6,
    )
    tilt_max_arcsec: float | None = _limit(
        "largest tilt",
        "arcsec",
        "<=",
        "Largest of the two tilts in this run, over what the tab Metrics measures.",
        le=1e6,
    )
    velocity_rms_mps: float | None = _limit(
        "velocity RMS",
        "m/s",
        "<=",
        "RMS of the horizontal velocity error of this run, over what the tab Metrics measures.",
        le=1e4,
    )
    position_rms_m: float | None = _limit(
        "position RMS",
        "m",
        "<=",
        "RMS of the horizontal position error of this run, over what the tab Metrics measures.",
        le=1e8,
    )

    @property
    def any(self) -> bool:
        """Whether there is a limit at all."""
        return any(getattr(self, name) is not None for name in type(self).model_fields)


def label_of(name: str) -> str:
    """Label of a limit's box: what, sense and unit, e.g. ``settling ≤ (min)``."""
    extra = extra_of(Requirements.model_fields[name])
    unit = f" ({extra['unit']})" if extra["unit"] else ""
    return f"{extra['label']} {sign_of(name)}{unit}"


def sign_of(name: str) -> str:
    """``≤`` or ``≥``."""
    return "≤" if extra_of(Requirements.model_fields[name])["sense"] == "<=" else "≥"


def read_limit(name: str, text: str) -> float | None:
    """Limit as typed; None for an empty text.

    Raises
    ------
    InputError
        Not a number, or outside what is allowed.
    """
    typed = text.strip().replace(",", ".")
    if not typed:
        return None
    allowed = Text(
        "{allowed_range}; leave it empty for no requirement",
        allowed_range=allowed_range(Requirements.model_fields[name]),
    )
    try:
        value = float(typed)
    except ValueError:
        raise InputError(
            Fault("", label_of(name), text, Text("must be a number: {allowed}", allowed=allowed))
        ) from None
    try:
        Requirements.model_validate({name: value})
    except ValueError:
        raise InputError(Fault("", label_of(name), text, allowed)) from None
    return value


# ---------------------------------------------------------------- measuring


@lru_cache(maxsize=64)
def _loop(network: LinearNetwork) -> Loop:
    return analyse(network)


def loop_of(method: MethodRun) -> Loop:
    """Loop that a method really closes: the undamped one when it runs free."""
    network = effective_network(method)
    return method.loop if network is method.network else _loop(network)


def span_s(method: MethodRun) -> float:
    """Time over which the responses of a method are measured, s: beyond its settling."""
    settles = loop_of(method).settling_s
    wanted = _LONGEST_S if settles is None else _BEYOND_SETTLED * settles
    return min(max(wanted, _SHORTEST_S), _LONGEST_S)


def _settling_min(method: MethodRun) -> float:
    settles = loop_of(method).settling_s
    return math.inf if settles is None else settles / MINUTE


def _overshoot_percent(method: MethodRun) -> float:
    if not loop_of(method).stable:
        return math.inf
    tilt = response(method, "initial_tilt", "phi", span_s(method), POINTS)
    assert tilt is not None
    return 100.0 * max(0.0, -float(np.min(tilt)))


def _log_tilt_arcsec(method: MethodRun) -> float:
    if not reacts(method, "dv_r"):
        return 0.0
    if not loop_of(method).stable:
        return math.inf
    tilt = response(method, "dv_r", "phi", span_s(method), POINTS)
    assert tilt is not None
    return LOG_STEP_MPS * float(np.max(np.abs(tilt))) / ARCSEC


def _of_run(method: MethodRun, value: float) -> float:
    return value if method.status == "ok" and math.isfinite(value) else math.inf


def _largest_tilt(method: MethodRun) -> float:
    found = max(method.errors[name]["max_abs"] for name in ("phi_e_rad", "phi_n_rad"))
    return _of_run(method, found / ARCSEC)


def _velocity_rms(method: MethodRun) -> float:
    return _of_run(method, math.hypot(*(method.errors[name]["rms"] for name in ("dve_mps", "dvn_mps"))))


def _h_slope(method: MethodRun) -> float:
    slope = effective_network(method).h_slope
    return slope if math.isfinite(slope) else math.inf


MEASURES: dict[str, Callable[[MethodRun], float]] = {
    "settling_min": _settling_min,
    "overshoot_percent": _overshoot_percent,
    "damping_ratio": lambda m: loop_of(m).damping_ratio,
    "h0_deviation": lambda m: abs(effective_network(m).h0 - 1.0),
    "h_slope_s": _h_slope,
    "log_tilt_arcsec": _log_tilt_arcsec,
    "tilt_max_arcsec": _largest_tilt,
    "velocity_rms_mps": _velocity_rms,
    "position_rms_m": lambda m: _of_run(m, m.errors["position_m"]["rms"]),
}
"""What is measured of a method, in the unit of the limit; inf: it never gets there."""


@dataclass(frozen=True)
class Verdict:
    """One limit, and what the methods make of it.

    Attributes
    ----------
    name : str
        Field of `Requirements`.
    limit : float or None
        None: nothing is asked, the measured values stand alone.
    measured : tuple of float
        A value a method, in the limit's unit.
    passed : tuple of bool
        Whether each method meets it; True without a limit.
    """

    name: str
    limit: float | None
    measured: tuple[float, ...]
    passed: tuple[bool, ...]


def verdicts(run: Run, requirements: Requirements) -> tuple[Verdict, ...]:
    """Measure every method against every limit, in the order of the fields."""
    found = []
    for name, measure in MEASURES.items():
        limit = getattr(requirements, name)
        sense = extra_of(Requirements.model_fields[name])["sense"]
        values = tuple(measure(method) for method in run.methods)
        passed = tuple(
            limit is None or (value <= limit if sense == "<=" else value >= limit) for value in values
        )
        found.append(Verdict(name, limit, values, passed))
    return tuple(found)


def error_limits(requirements: Requirements, run: Run) -> dict[str, float]:
    """Limits to draw in the error plots, SI: key of `app.views.errors.figure.error_plots` -> value.

    One that lies far above all curves is left out: it would press them flat.
    """
    limits: dict[str, tuple[float, str]] = {}
    if requirements.tilt_max_arcsec is not None:
        size = requirements.tilt_max_arcsec * ARCSEC
        limits |= {"phi_e": (size, "phi_e_rad"), "phi_n": (size, "phi_n_rad")}
    if requirements.position_rms_m is not None:
        limits["position"] = requirements.position_rms_m, "position_m"
    return {
        key: size
        for key, (size, name) in limits.items()
        if size <= _IN_SIGHT * max(method.errors[name]["max_abs"] for method in run.methods)
    }


def fastest_rate(requirements: Requirements) -> float | None:
    """Decay rate (1/s) that a pole needs to have come down to 2 % in the settling time; None without one."""
    limit = requirements.settling_min
    return None if limit is None or limit <= 0.0 else math.log(1.0 / SETTLED) / (limit * MINUTE)
