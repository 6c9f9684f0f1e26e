"""What a method can be tuned for, or be required to keep: one number a name."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from navcore.analysis import Loop, analyse, time_response
from navcore.analysis.whole_system import WholeSystem, whole_system
from navcore.design.figures import Figures, mean_figures
from navcore.design.form import law_form
from navcore.design.level import level, steady_parts
from navcore.design.seeds import no_covariance, seed_variance
from navcore.design.ship import Ship
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import ARCMIN, ARCSEC, DEG, HOUR, MINUTE
from navcore.law.combination import realisation_of
from navcore.networks.base import LinearNetwork
from navcore.scenario.method import Method

TUNING_INTERVALS = 360
"""Of a run during a search: coarser than the budget, which is made once."""
TUNING_SEEDS = 4
_STEP_POINTS = 800
_STEP_PERIODS = 6.0
UNITS = {
    "rad": 1.0,
    "deg": DEG,
    "arcmin": ARCMIN,
    "arcsec": ARCSEC,
    "s": 1.0,
    "min": MINUTE,
    "h": HOUR,
    "m/s": 1.0,
    "m": 1.0,
    "km": 1000.0,
}


class Setting:
    """One method with one set of parameters, measured as far as it is asked for.

    Parameters
    ----------
    ship : Ship
        What stays.
    method : Method
        The method, its network for the ship's sensors.
    """

    def __init__(self, ship: Ship, method: Method) -> None:
        self.ship, self.method = ship, method

    @cached_property
    def network(self) -> LinearNetwork:
        """H(s) as the method's policy runs it."""
        return self.method.kind.network(self.method).transfer(self.ship.scenario.omega_s)

    @cached_property
    def loop(self) -> Loop:
        """Closed loop of one channel."""
        return analyse(self.network)

    @cached_property
    def whole(self) -> WholeSystem:
        """Both channels with heading and latitude at the site."""
        scenario = self.ship.scenario
        place = scenario.site.lat_deg * DEG, scenario.earth, scenario.site.height_m
        return whole_system(self.method.kind.acting(self.network), *place)

    @cached_property
    def figures(self) -> Figures:
        """Root mean squares of the errors; infinite where there is none."""
        ship = self.ship
        if not ship.along_run:
            parts = steady_parts(
                level(law_form(self.method, ship.scenario.omega_s), ship.model, ship.scenario.omega_s)
            )
            return Figures(
                _root_sum([part.tilt_rad for part in parts.values()]),
                _root_sum([part.velocity_mps for part in parts.values()]),
            )
        if not self.loop.stable:
            return Figures(math.inf, math.inf, math.inf, math.inf)
        if no_covariance(ship.scenario, self.method):
            try:
                t_s, variance = seed_variance(ship.scenario, self.method, TUNING_SEEDS)
            except InputError:
                return Figures(math.inf, math.inf, math.inf, math.inf)
            return mean_figures(t_s, variance)
        variances = ship.along(self.method)
        total = np.where(np.isfinite(variances.total), variances.total, np.inf)
        return mean_figures(variances.t_s, total)

    @cached_property
    def log_step(self) -> tuple[float, float]:
        """Largest velocity error (m/s) and tilt (rad) after a step of the log's error by 1 m/s."""
        if not self.method.kind.referenced or not self.loop.stable:
            return (0.0, 0.0) if self.loop.stable else (math.inf, math.inf)
        slowest = self.loop.settling_s or _STEP_PERIODS * 2.0 * math.pi / self.network.omega_s
        time_s = np.linspace(0.0, min(2.0 * slowest, 200.0 * HOUR), _STEP_POINTS)
        form = realisation_of(self.method.kind.law, self.method.kind.network(self.method))
        velocity = time_response(self.network, "dv_r", "dv", time_s, realisation=form)
        tilt = time_response(self.network, "dv_r", "phi", time_s, realisation=form)
        return float(np.max(np.abs(velocity))), float(np.max(np.abs(tilt)))


def _root_sum(values: list[float | None]) -> float:
    return math.sqrt(sum(math.inf if value is None else value * value for value in values))


def _settling(setting: Setting) -> float:
    return math.inf if setting.loop.settling_s is None else setting.loop.settling_s


def _rms(name: str) -> Callable[[Setting], float]:
    def measure(setting: Setting) -> float:
        value = getattr(setting.figures, name)
        return math.inf if value is None or math.isnan(value) else value

    return measure


MEASURES: dict[str, tuple[Callable[[Setting], float], str, str]] = {
    "tilt_rms": (_rms("tilt_rad"), "rad", "root mean square of the tilt of one channel"),
    "velocity_rms": (_rms("velocity_mps"), "m/s", "root mean square of the velocity error of one channel"),
    "heading_rms": (_rms("heading_rad"), "rad", "root mean square of the heading error over the run"),
    "position_rms": (_rms("position_m"), "m", "root mean square of the position error over the run"),
    "settling_s": (_settling, "s", "last time at which the answer to an initial tilt exceeds 2 %"),
    "overshoot": (lambda s: s.log_step[0], "m/s", "largest velocity error after a log step of 1 m/s"),
    "log_tilt": (lambda s: s.log_step[1], "rad", "largest tilt after a log step of 1 m/s"),
    "damping_ratio": (lambda s: s.loop.damping_ratio, "", "smallest damping ratio of the closed loop"),
    "h0_deviation": (lambda s: abs(s.network.h0 - 1.0), "", "distance of H(0) from 1"),
    "h_slope_s": (
        lambda s: s.network.h_slope,
        "s",
        "H'(0): negative damps the 24 h mode of a network with H(0) = 1",
    ),
    "earth_mode_growth_per_s": (
        lambda s: s.whole.earth_growth,
        "1/s",
        "growth of the 24 h mode of the whole system at the site; negative when it decays",
    ),
}
"""How a number is measured, its unit and what it is."""
_TYPICAL = {"h_slope_s": 100.0}
"""Sizes of measures whose limit is 0 as a rule, SI."""
ALONG_ONLY = ("heading_rms", "position_rms")
NO_OBJECTIVES = ("damping_ratio",)
"""Measures of which more is better: to be required, not to be made small."""
OBJECTIVES = tuple(name for name in MEASURES if name not in NO_OBJECTIVES)
FLOORED = {
    "tilt_rms": "tilt_rad",
    "velocity_rms": "velocity_mps",
    "heading_rms": "heading_rad",
    "position_rms": "position_m",
}
"""Measures that have a floor, and which figure of it."""
_TERM = re.compile(r"(?:(?P<weight>[0-9.]+(?:e[+-]?[0-9]+)?)\s*\*\s*)?(?P<name>[a-z][a-z0-9_]*)\Z")
_REQUIREMENT = re.compile(
    r"\s*(?P<name>[a-z][a-z0-9_]*)\s*(?P<sense><=|>=)\s*(?P<value>[-+0-9.eE]+?)\s*(?P<unit>[a-z/]*)\s*\Z"
)


@dataclass(frozen=True)
class Objective:
    """A measure to make small, or a weighted sum of several.

    Attributes
    ----------
    text : str
        As given.
    terms : tuple of (str, float)
        Names and weights. Of a sum each value counts relative to that before the tuning.
    """

    text: str
    terms: tuple[tuple[str, float], ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Measures that it looks at."""
        return tuple(name for name, _ in self.terms)

    def value(self, setting: Setting, before: dict[str, float]) -> float:
        """Value of a setting; ``before`` are the measures of the setting that the search began with."""
        if len(self.terms) == 1:
            return MEASURES[self.terms[0][0]][0](setting)
        total = 0.0
        for name, weight in self.terms:
            unit = before.get(name, 1.0)
            unit = unit if math.isfinite(unit) and unit > 0.0 else 1.0
            total += weight * MEASURES[name][0](setting) / unit
        return total


@dataclass(frozen=True)
class Requirement:
    """A limit on a measure.

    Attributes
    ----------
    text : str
        As given.
    name, sense : str
        Measure, and "<=" or ">=".
    limit : float
        SI.
    """

    text: str
    name: str
    sense: str
    limit: float

    def excess(self, setting: Setting) -> float:
        """By how much it is missed, relative to the limit; 0 when it is met."""
        value = MEASURES[self.name][0](setting)
        miss = value - self.limit if self.sense == "<=" else self.limit - value
        if math.isnan(miss):
            return math.inf
        return max(0.0, miss / self._scale)

    def active(self, setting: Setting) -> bool:
        """Whether a setting stands at the limit, to 1 %."""
        value = MEASURES[self.name][0](setting)
        return abs(value - self.limit) <= 0.01 * self._scale

    @property
    def _scale(self) -> float:
        """Size that a miss is divided by: the limit; where that may be 0, at least a typical value."""
        return max(abs(self.limit), _TYPICAL.get(self.name, 1e-12))


def in_display_unit(name: str, value: float | None) -> tuple[float | None, str]:
    """Value of a measure in the unit in which it is shown, and that unit; of a sum it has none."""
    unit = MEASURES[name][1] if name in MEASURES else ""
    if unit == "rad":
        return None if value is None else value / ARCSEC, "arcsec"
    return value, unit


def in_words(name: str, value: float) -> str:
    """Value of a measure with its unit."""
    if not math.isfinite(value):
        return "no finite value"
    in_unit, unit = in_display_unit(name, value)
    return f"{in_unit:.4g} {unit}".rstrip()


def read_objective(text: str) -> Objective:
    """Read ``tilt_rms`` or ``tilt_rms + 0.5 * velocity_rms``.

    Raises
    ------
    InputError
        A name is not known, is there only to be required, or a weight is no number above 0.
    """
    terms = []
    for part in text.split("+"):
        match = _TERM.match(part.strip())
        if match is None or match["name"] not in MEASURES:
            allowed = Text(
                "must be one of {objectives}, or a sum such as tilt_rms + 0.5*velocity_rms",
                objectives=", ".join(OBJECTIVES),
            )
            raise InputError(Fault("", "--objective", text, allowed))
        if match["name"] in NO_OBJECTIVES:
            allowed = Text(
                "is better when larger: ask for it as a requirement, {name}>=0.5", name=match["name"]
            )
            raise InputError(Fault("", "--objective", text, allowed))
        try:
            weight = float(match["weight"] or 1.0)
        except ValueError:
            weight = 0.0
        if not 0.0 < weight < math.inf:
            raise InputError(Fault("", "--objective", text, "weights must be numbers > 0"))
        terms.append((match["name"], weight))
    return Objective(text, tuple(terms))


def read_requirement(text: str) -> Requirement:
    """Read ``settling_s<=3600`` or ``tilt_rms<=5arcsec``; without a unit the limit is in SI.

    Raises
    ------
    InputError
        Not of this form, or a name or unit is not known.
    """
    match = _REQUIREMENT.match(text)
    if match is None or match["name"] not in MEASURES:
        allowed = Text(
            "must have the form NAME<=VALUE or NAME>=VALUE with NAME one of {measures}",
            measures=", ".join(MEASURES),
        )
        raise InputError(Fault("", "--require", text, allowed))
    unit = match["unit"]
    own = MEASURES[match["name"]][1]
    same = {"rad": ("rad", "deg", "arcmin", "arcsec"), "s": ("s", "min", "h"), "m": ("m", "km")}.get(
        own, (own,)
    )
    if unit and unit not in same:
        raise InputError(
            Fault("", "--require", text, Text("unit must be one of {same}", same=", ".join(same) or "none"))
        )
    try:
        limit = float(match["value"]) * (UNITS[unit] if unit else 1.0)
    except ValueError:
        raise InputError(Fault("", "--require", text, "the limit must be a number")) from None
    return Requirement(text.strip(), match["name"], match["sense"], limit)
