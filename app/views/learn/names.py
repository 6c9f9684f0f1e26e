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
``whole.N.slow``, ``.fastest``      damping ratio of the slow oscillation; time in which the fastest growing
                                    mode grows by e (h)
``direct.N.exact``, ``.rounded``    largest pole of the discrete network; of its difference equation with
                                    coefficients of single precision
``direct.N.growth``, ``.kept``      time in which that one grows by e (s); shift of the poles, of their size,
                                    where the change of the state is what is rounded
``error.N.Q.S``                     statistics of an error: Q a key of `navcore.quantities.ERRORS`, S of
                                    `STATISTICS`
``curve.N.Q.period``                twice the mean distance of its zero crossings (min)
``floor.tilt``, ``.velocity``       least steady error that any damping can reach (arcsec, m/s)
``budget.N.tilt``, ``.velocity``    steady error of one level channel at rest (arcsec, m/s)
``budget.N.tilt_times``             the same over the floor; ``velocity_times`` too
``budget.N.SOURCE``                 part of a source in the variance of the tilt (%)
``setting.PATH``                    a number of the scenario, in the unit of its field
==================================  ====================================================================
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from navcore.engine.measures import measure
from navcore.engine.run import Run
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.errors import InputError
from navcore.foundation.notation import with_unit
from navcore.foundation.parameters import extra_of
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, DEG, HOUR
from navcore.networks.discrete import discretise
from navcore.quantities import ERRORS, TILT, VELOCITY, Kind

COLUMNS = {error.key: column for column, error in enumerate(ERRORS)}
"""Key of an error -> its column in a plot."""
STATISTICS = {"max": "max_abs", "rms": "rms", "mean": "mean", "final": "final", "end": "final"}
"""Name -> statistic of a run; ``end`` is the magnitude of ``final``."""
_MIN, _DAY = 60.0, 86400.0
_LINE_DIGITS, _POLE_DIGITS = 4, 7


class Named(NamedTuple):
    """A number in a unit ("" for a pure one), and how many significant digits of it are shown."""

    value: float
    unit: str
    digits: int = 3

    @property
    def text(self) -> str:
        """Number and unit, to be read in a sentence."""
        if not math.isfinite(self.value):
            return Text("no number")
        value = 0.0 if abs(self.value) < 1e-12 else self.value
        text = f"{value:.{self.digits}g}"
        if "e" in text and abs(value) < 1e6:
            text = f"{float(text):.0f}" if abs(value) >= 1.0 else f"{value:.2e}"
        return with_unit(text, self.unit)


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
    number, _, what = rest.partition(".")
    try:
        if name in _OF_RUN:
            return _OF_RUN[name](run)
        if head in _OF_METHOD and number.isdigit():
            return _OF_METHOD[head](what, int(number), run)
        if head == "setting" and rest:
            return _setting(rest, run)
    except (KeyError, IndexError, ValueError, AttributeError, TypeError, InputError):
        pass
    raise KeyError(name)


def _up_rate(run: Run) -> float:
    """Up component of the Earth's rate at the site, rad/s, as a magnitude."""
    return EARTH_RATE * math.sin(abs(run.scenario.site.lat_deg) * DEG)


def _minutes(omega: float, turns: float = 1.0) -> Named:
    """Time of some turns at an angular rate (rad/s)."""
    return Named(turns * 2.0 * math.pi / omega / _MIN, "min", _LINE_DIGITS)


def _line(run: Run, sign: float) -> Named:
    """Period of a line beside the Schuler frequency."""
    up = _up_rate(run)
    return _minutes(math.hypot(run.scenario.omega_s, up) + sign * up)


def _foucault(run: Run, turns: float) -> Named:
    up = _up_rate(run)
    return Named(turns * 2.0 * math.pi / up / HOUR if up > 0.0 else math.inf, "h", _LINE_DIGITS)


def _floor(run: Run, what: str) -> Named:
    from schuler_bench.plots.budgets import steady_budget

    return _in_unit(getattr(steady_budget(run.scenario).floor.rms, _BUDGETED[what].figure), _BUDGETED[what])


def in_unit(value: float, key: str) -> Named:
    """Error (SI) with a key of `COLUMNS`, in the unit in which a lesson speaks of it."""
    return _in_unit(value, ERRORS[COLUMNS[key]].kind)


def _in_unit(value: float, kind: Kind) -> Named:
    """Error (SI) of a kind; angles in arcseconds."""
    return Named(value / ARCSEC, '"') if kind.dimension == "angle" else Named(value, kind.unit)


_BUDGETED = {kind.name: kind for kind in (TILT, VELOCITY)}
_OF_RUN: dict[str, Callable[[Run], Named]] = {
    "schuler.period": lambda run: _minutes(run.scenario.omega_s),
    "schuler.half": lambda run: _minutes(run.scenario.omega_s, 0.5),
    "schuler.omega": lambda run: Named(run.scenario.omega_s, "rad/s", _LINE_DIGITS),
    "schuler.fast": lambda run: _line(run, 1.0),
    "schuler.slow": lambda run: _line(run, -1.0),
    "foucault.period": lambda run: _foucault(run, 1.0),
    "foucault.quarter": lambda run: _foucault(run, 0.25),
    "day.period": lambda _: Named(2.0 * math.pi / EARTH_RATE / HOUR, "h", _LINE_DIGITS),
    "averaging.left": lambda run: Named(
        100.0 * math.sin(0.5 * math.pi * _up_rate(run) / run.scenario.omega_s), "%"
    ),
    "floor.tilt": lambda run: _floor(run, "tilt"),
    "floor.velocity": lambda run: _floor(run, "velocity"),
}


def _loop(what: str, number: int, run: Run) -> Named:
    method = run.methods[number]
    if what == "period":
        if method.method.undamped:
            return _minutes(run.scenario.omega_s)
        poles = method.loop.poles[np.abs(method.loop.poles.imag) > 1e-9]
        least = min(poles, key=lambda pole: -pole.real / abs(pole), default=0.0)
        return Named(2.0 * math.pi / abs(float(least.imag)) / _MIN if least else math.inf, "min")
    if what == "settling":
        return Named(measure(method, "settling_s") / _MIN, "min")
    return Named(measure(method, {"damping": "damping_ratio", "h0": "h0"}[what]), "")


def _whole(what: str, number: int, run: Run) -> Named:
    whole = run.methods[number].whole
    days = Named(abs(whole.e_folding_s) / _DAY, "days")
    growth = max(mode.growth for mode in whole.modes)
    slow = whole.slow_mode
    return {
        "days": days,
        "slope": Named(whole.h_slope, "s", _LINE_DIGITS),
        "slow": Named(math.inf if slow is None else slow.damping_ratio, ""),
        "fastest": Named(1.0 / growth / HOUR if growth > 0.0 else math.inf, "h"),
    }[what]


def _error(what: str, number: int, run: Run) -> Named:
    key, statistic = what.split(".")
    error = ERRORS[COLUMNS[key]]
    value = run.methods[number].errors[error.name][STATISTICS[statistic]]
    return _in_unit(abs(value) if statistic == "end" else value, error.kind)


def _curve(what: str, number: int, run: Run) -> Named:
    key, period = what.split(".")
    if period != "period":
        raise KeyError(what)
    plot = run.methods[number].plot
    values = plot.values[:, COLUMNS[key]]
    signs = np.sign(values)
    # A start at exactly zero is no crossing.
    at = np.flatnonzero(signs[1:] * signs[:-1] < 0)
    if len(at) < 2:
        return Named(math.inf, "min")
    share = values[at] / (values[at] - values[at + 1])
    times = plot.t_s[at] + share * (plot.t_s[at + 1] - plot.t_s[at])
    return Named(2.0 * float(np.mean(np.diff(times))) / _MIN, "min", _LINE_DIGITS)


def _budget(what: str, number: int, run: Run) -> Named:
    from schuler_bench.plots.budgets import steady_budget

    budget = steady_budget(run.scenario)
    method = budget.methods[number]
    if what in _BUDGETED:
        return _in_unit(getattr(method.total.rms, _BUDGETED[what].figure), _BUDGETED[what])
    if what.endswith("_times"):
        return Named(float(budget.times_floor(method)[what.removesuffix("_times")] or math.inf), "")
    own, total = method.sources[what].rms.tilt_rad, method.total.rms.tilt_rad
    if own is None or not total:
        raise KeyError(what)
    return Named(100.0 * (own / total) ** 2, "%")


def _direct(what: str, number: int, run: Run) -> Named:
    from navcore.exporting.rounding import direct_radius, pole_shift

    discrete = discretise(run.methods[number].network, run.scenario.law_step_s)
    rounded = direct_radius(discrete)
    exact = np.abs(np.linalg.eigvals(np.eye(discrete.order) + discrete.dA))
    return {
        "exact": Named(float(np.max(exact)), "", _POLE_DIGITS),
        "rounded": Named(rounded, "", _POLE_DIGITS),
        "growth": Named(run.scenario.law_step_s / math.log(rounded) if rounded > 1.0 else math.inf, "s"),
        "kept": Named(pole_shift(discrete), ""),
    }[what]


_OF_METHOD: dict[str, Callable[[str, int, Run], Named]] = {
    "loop": _loop,
    "whole": _whole,
    "error": _error,
    "curve": _curve,
    "budget": _budget,
    "direct": _direct,
}


def _setting(path: str, run: Run) -> Named:
    place: Any = run.scenario
    unit = ""
    for step in path.split("."):
        if step.isdigit():
            place = place[int(step)]
            continue
        unit = str(extra_of(type(place).model_fields[step]).get("unit", ""))
        place = getattr(place, step)
    if isinstance(place, bool) or not isinstance(place, int | float):
        raise KeyError(path)
    return Named(float(place), unit)
