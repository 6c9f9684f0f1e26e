"""The numbers a lesson may speak of: each has a name, is computed from a run, and carries its unit.

A lesson's text holds ``{{name}}``; its questions compare names. There is no other way for a lesson to reach a
number, and nothing in a lesson is evaluated as code. ``N`` stands for the number of a method, from 0:

==================================  ====================================================================
``schuler.period``, ``.omega``      2 pi / omega_s (min), omega_s (rad/s), at the scenario's site
``schuler.half``                    half of that period (min)
``schuler.fast``, ``schuler.slow``  periods of the two lines omega_s' +- Omega sin L (min; theory.md 1)
``foucault.period``, ``.quarter``   2 pi / (Omega sin L) and a quarter of it (h)
``day.period``                      2 pi / Omega (h)
``averaging.left``                  sin(pi Omega sin L / (2 omega_s)) (%; theory.md 5)
``loop.N.period``                   of the least damped closed-loop pair (min)
``loop.N.damping``, ``loop.N.h0``   its damping ratio; H(0)
``loop.N.settling``                 to 2 % of an initial tilt (min)
``whole.N.days``, ``.slope``         e-folding time of the 24 h mode (days), growing or not; H'(0) (s)
``error.N.Q.S``                     statistics of a quantity: Q of `QUANTITIES`, S of `STATISTICS`
``curve.N.Q.period``                twice the mean distance of its zero crossings (min)
``floor.tilt``, ``.velocity``       least steady error that any damping can reach (arcsec, m/s)
``budget.N.tilt``, ``.velocity``    steady error of one level channel at rest (arcsec, m/s)
``budget.N.tilt_times``             the same over the floor; ``velocity_times`` too
``budget.N.SOURCE``                 part of a source in the variance of the tilt (%)
``setting.PATH``                    a number of the scenario, in the unit of its field
==================================  ====================================================================
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.engine.run import MethodRun, Run
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.errors import InputError
from navcore.foundation.notation import with_unit
from navcore.foundation.parameters import extra_of
from navcore.foundation.units import ARCSEC, DEG, HOUR
from navcore.mechanization.recorder import NAMES

QUANTITIES: dict[str, tuple[int, float, str]] = {
    "phi_e": (0, ARCSEC, '"'),
    "phi_n": (1, ARCSEC, '"'),
    "phi_u": (2, ARCSEC, '"'),
    "dve": (3, 1.0, "m/s"),
    "dvn": (4, 1.0, "m/s"),
    "position": (7, 1.0, "m"),
}
"""Name -> column of `navcore.mechanization.recorder.NAMES`, its unit in SI, and the unit's name."""
STATISTICS = {"max": "max_abs", "rms": "rms", "mean": "mean", "final": "final", "end": "final"}
"""Name -> statistic of a run; ``end`` is the magnitude of ``final``."""
_MIN, _DAY = 60.0, 86400.0
_LINE_DIGITS = 4


@dataclass(frozen=True)
class Named:
    """A number with its unit.

    Attributes
    ----------
    value : float
        In the unit.
    unit : str
        Empty for a pure number.
    digits : int
        Significant digits that are shown.
    """

    value: float
    unit: str
    digits: int = 3

    @property
    def text(self) -> str:
        """Number and unit, to be read in a sentence."""
        if not math.isfinite(self.value):
            return "no number"
        value = 0.0 if abs(self.value) < 1e-12 else self.value
        shown = f"{value:.{self.digits}g}"
        if "e" in shown and abs(value) < 1e6:
            shown = f"{float(shown):.0f}" if abs(value) >= 1.0 else f"{value:.2e}"
        return with_unit(shown, self.unit)


def named(name: str, run: Run) -> Named:
    """Look a number up.

    Parameters
    ----------
    name : str
        As in the module's table.
    run : Run
        Where it is taken from.

    Raises
    ------
    KeyError
        There is no such name, or the run has no such method.
    """
    head, _, rest = name.partition(".")
    find = _FINDERS.get(head)
    if find is None or not rest:
        raise KeyError(name)
    try:
        return find(rest, run)
    except (IndexError, ValueError, AttributeError, TypeError, InputError):
        raise KeyError(name) from None


def _schuler(rest: str, run: Run) -> Named:
    omega_s, up = run.scenario.omega_s, _up_rate(run)
    split = math.hypot(omega_s, up)
    values = {
        "period": Named(2.0 * math.pi / omega_s / _MIN, "min", _LINE_DIGITS),
        "half": Named(math.pi / omega_s / _MIN, "min", _LINE_DIGITS),
        "omega": Named(omega_s, "rad/s", _LINE_DIGITS),
        "fast": Named(2.0 * math.pi / (split + up) / _MIN, "min", _LINE_DIGITS),
        "slow": Named(2.0 * math.pi / (split - up) / _MIN, "min", _LINE_DIGITS),
    }
    return values[rest]


def _foucault(rest: str, run: Run) -> Named:
    up = _up_rate(run)
    period_h = 2.0 * math.pi / up / HOUR if up > 0.0 else math.inf
    return Named({"period": period_h, "quarter": period_h / 4.0}[rest], "h", _LINE_DIGITS)


def _day(rest: str, run: Run) -> Named:
    del run
    return {"period": Named(2.0 * math.pi / EARTH_RATE / HOUR, "h", _LINE_DIGITS)}[rest]


def _averaging(rest: str, run: Run) -> Named:
    left = math.sin(0.5 * math.pi * _up_rate(run) / run.scenario.omega_s)
    return {"left": Named(100.0 * left, "%")}[rest]


def _loop(rest: str, run: Run) -> Named:
    from app.plots.effective import effective_network

    number, _, what = rest.partition(".")
    method = _method(number, run)
    free, loop = effective_network(method) is not method.network, method.loop
    if what == "period":
        poles = loop.poles[np.abs(loop.poles.imag) > 1e-9]
        if free or not len(poles):
            return _schuler("period", run) if free else Named(math.inf, "min")
        least = poles[np.argmin(-poles.real / np.abs(poles))]
        return Named(2.0 * math.pi / abs(float(least.imag)) / _MIN, "min")
    if what == "settling":
        settled = None if free else loop.settling_s
        return Named(math.inf if settled is None else settled / _MIN, "min")
    return Named({"damping": 0.0, "h0": 1.0}[what] if free else _of_loop(loop, what), "")


def _of_loop(loop: Any, what: str) -> float:
    return float({"damping": loop.damping_ratio, "h0": loop.h0}[what])


def _whole(rest: str, run: Run) -> Named:
    number, _, what = rest.partition(".")
    whole = _method(number, run).whole
    values = {
        "days": Named(abs(whole.e_folding_s) / _DAY, "days"),
        "slope": Named(whole.h_slope, "s", _LINE_DIGITS),
    }
    return values[what]


def _error(rest: str, run: Run) -> Named:
    number, quantity, statistic = rest.split(".")
    column, unit, unit_name = QUANTITIES[quantity]
    value = _method(number, run).errors[NAMES[column]][STATISTICS[statistic]] / unit
    return Named(abs(value) if statistic == "end" else value, unit_name)


def _curve(rest: str, run: Run) -> Named:
    number, quantity, what = rest.split(".")
    if what != "period":
        raise KeyError(rest)
    plot = _method(number, run).plot
    values = plot.values[:, QUANTITIES[quantity][0]]
    signs = np.sign(values)
    # A start at exactly zero is no crossing.
    at = np.flatnonzero(signs[1:] * signs[:-1] < 0)
    if len(at) < 2:
        return Named(math.inf, "min")
    share = values[at] / (values[at] - values[at + 1])
    times = plot.t_s[at] + share * (plot.t_s[at + 1] - plot.t_s[at])
    return Named(2.0 * float(np.mean(np.diff(times))) / _MIN, "min", _LINE_DIGITS)


_BUDGETED = {"tilt": ("tilt_rad", ARCSEC, '"'), "velocity": ("velocity_mps", 1.0, "m/s")}


def _floor(rest: str, run: Run) -> Named:
    from app.plots.budgets import steady_budget

    field, unit, unit_name = _BUDGETED[rest]
    return Named(getattr(steady_budget(run.scenario).floor.rms, field) / unit, unit_name)


def _budget(rest: str, run: Run) -> Named:
    from app.plots.budgets import steady_budget

    number, _, what = rest.partition(".")
    found = steady_budget(run.scenario)
    if not number.isdigit():
        raise KeyError(number)
    method = found.methods[int(number)]
    if what in _BUDGETED:
        field, unit, unit_name = _BUDGETED[what]
        return Named(getattr(method.total.rms, field) / unit, unit_name)
    if what.endswith("_times"):
        return Named(float(found.times_floor(method)[what.removesuffix("_times")] or math.inf), "")
    own, total = method.sources[what].rms.tilt_rad, method.total.rms.tilt_rad
    if own is None or not total:
        raise KeyError(rest)
    return Named(100.0 * (own / total) ** 2, "%")


def _setting(rest: str, run: Run) -> Named:
    place: Any = run.scenario
    unit = ""
    for step in rest.split("."):
        if step.isdigit():
            place = place[int(step)]
            continue
        unit = str(extra_of(type(place).model_fields[step]).get("unit", ""))
        place = getattr(place, step)
    if isinstance(place, bool) or not isinstance(place, int | float):
        raise KeyError(rest)
    return Named(float(place), unit)


_FINDERS = {
    "schuler": _schuler,
    "foucault": _foucault,
    "day": _day,
    "averaging": _averaging,
    "loop": _loop,
    "whole": _whole,
    "error": _error,
    "curve": _curve,
    "floor": _floor,
    "budget": _budget,
    "setting": _setting,
}


def _up_rate(run: Run) -> float:
    """Up component of the Earth's rate at the site, rad/s, as a magnitude."""
    return EARTH_RATE * math.sin(abs(run.scenario.site.lat_deg) * DEG)


def _method(number: str, run: Run) -> MethodRun:
    if not number.isdigit():
        raise KeyError(number)
    return run.methods[int(number)]
