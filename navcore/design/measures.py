"""Objectives and requirements of a search, and how it measures a setting against them."""

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from navcore.analysis import Loop, analyse
from navcore.analysis.filter_loop import filter_loop
from navcore.analysis.heading_settling import heading_settling
from navcore.analysis.held_log import held_log
from navcore.analysis.judged import JudgedLoop, loop_value
from navcore.analysis.whole_system import WholeSystem, duration, whole_system
from navcore.design.figures import Figures, mean_figures, total_of
from navcore.design.level import Level
from navcore.design.sampled import SampledLevel, timing_of
from navcore.design.seeds import alone, no_covariance, seed_variance
from navcore.design.ship import Ship
from navcore.design.steady import constant_parts, instability, loops_of, random_parts
from navcore.engine.drivers.common import growth_under_way, network_of
from navcore.engine.ensemble import SEARCHED
from navcore.engine.simulation import simulate
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import NotANumber, read_number
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, UNITS
from navcore.networks.base import LinearNetwork
from navcore.quantities import ERRORS, HEADING, OBJECTIVES, QUANTITIES, TILT, TUNED, VELOCITY, components
from navcore.scenario.method import Method

TUNING_INTERVALS = 360
"""Of a run during a search: coarser than the budget, which is made once."""
TUNING_SEEDS = 4


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
        """H(s) in force; where the policy re-tunes it, at the mean coefficient of a run."""
        if self.method.policy.tunes and not self.method.undamped:
            return simulate(alone(self.ship.scenario, self.method)).methods[0].network
        return network_of(self.ship.scenario, self.method)

    @cached_property
    def loop(self) -> Loop:
        """Closed loop of one channel; of a Kalman filter its steady estimator."""
        if self.method.kind.covering == "filter":
            return self._filter or analyse(self.network)
        return analyse(self.network)

    @cached_property
    def whole(self) -> WholeSystem:
        """Both channels with heading and latitude at the site."""
        scenario = self.ship.scenario
        place = scenario.site.lat_deg * DEG, scenario.earth, scenario.site.height_m
        kind = self.method.kind
        return whole_system(
            kind.acting(self.network), *place, azimuth=kind.azimuth(self.method, self.network.omega_s)
        )

    @cached_property
    def heading_settling_s(self) -> float:
        """Settling of the heading that an azimuth loop holds; infinite where nothing holds it."""
        scenario, kind = self.ship.scenario, self.method.kind
        azimuth = kind.azimuth(self.method, self.network.omega_s) if kind.uses_network else None
        place = scenario.site.lat_deg * DEG, scenario.earth, scenario.site.height_m
        return heading_settling(kind.acting(self.network), *place, azimuth)

    @cached_property
    def growth_per_s(self) -> float:
        """Growth of the whole system along the motion as the law is sampled, 1/s; nan where it cannot run."""
        scenario, timing = self.ship.scenario, timing_of(self.ship.scenario)
        if self.method.kind.covering == "filter":
            return math.nan if self._filter is None else float(np.max(self._filter.poles.real))
        if not self.method.kind.uses_network:
            return 0.0
        period_s = timing.step_s * (timing.hold if self.method.kind.referenced else 1)
        kind, log = self.method.kind, scenario.reference
        acting, azimuth = kind.acting(self.network), kind.azimuth(self.method, self.network.omega_s)
        times_s = period_s, timing.step_s
        if scenario.run.fidelity == "channel":
            place = scenario.site.lat_deg * DEG, scenario.earth
            return held_log(acting, *times_s, *place, coupled=False, azimuth=azimuth).growth_per_s
        turned = kind.referenced and log.frame == "body"
        return growth_under_way(scenario, acting, self.ship.stretches, times_s, azimuth, turned)

    @property
    def _filter(self) -> Loop | None:
        return filter_loop(self.ship.model.figures, self.ship.scenario.omega_s)

    @cached_property
    def instability(self) -> str:
        """Say how fast the level loop grows as it is sampled; empty where it does not, or nobody knows."""
        if self.method.policy.tunes or not self.method.kind.uses_network:
            return ""
        return instability(self._loops[1])

    @cached_property
    def _loops(self) -> tuple[Level, SampledLevel]:
        return loops_of(self.ship.scenario, self.method, self.ship.model)

    @cached_property
    def figures(self) -> Figures:
        """Root mean squares of the errors; None, infinite or NaN where there is none."""
        ship = self.ship
        if ship.scenario.on_ins:
            return self._recorded
        if self.instability or (ship.along_run and not self.loop.stable):
            return Figures()
        if not ship.along_run:
            parts = random_parts(*self._loops) | constant_parts(self._loops[0], ship.model)
            return total_of(parts.values())
        if no_covariance(ship.scenario, self.method):
            try:
                return mean_figures(*seed_variance(ship.scenario, self.method, TUNING_SEEDS, first=SEARCHED))
            except InputError:
                return Figures()
        variances = ship.along(self.method)
        return mean_figures(variances.t_s, variances.total)

    @property
    def _recorded(self) -> Figures:
        """Root mean squares over a recording of an INS, against its reference."""
        scenario = self.ship.scenario
        if self.instability or not self.loop.stable:
            return Figures()
        run = simulate(alone(scenario, self.method)).methods[0]
        if scenario.truth.file is None or run.status != "ok":
            return Figures()
        of = run.errors
        level = (_both(*(of[name] for name in components(kind))) for kind in (TILT, VELOCITY))
        return Figures(*level, *(_told(of[name]["rms"]) for name in (*components(HEADING), ERRORS[-1].name)))


def _both(east: dict[str, float], north: dict[str, float]) -> float | None:
    """Root mean square of one level channel from that of both."""
    return _told(math.sqrt(0.5 * (east["rms"] ** 2 + north["rms"] ** 2)))


def _told(value: float) -> float | None:
    return value if math.isfinite(value) else None


def growing(setting: Setting) -> Iterator[str]:
    """Yield a sentence for each mode of the whole system that grows, as it is sampled too."""
    growth = setting.growth_per_s
    if growth > 0.0 and setting.whole.stable:
        every = duration(1.0 / growth)
        yield Text("whole system: it grows as it is sampled, by e every {every}", every=every)
    yield from setting.whole.warnings


def measure(setting: Setting, key: str) -> float:
    """Value of a quantity of a setting, SI; infinite where there is none.

    Parameters
    ----------
    setting : Setting
        Errors are judged in the steady state or of the ensemble of runs, as its ship says.
    key : str
        One of `navcore.quantities.TUNED`.
    """
    kind = QUANTITIES[key].kind
    if kind is None:
        return loop_value(key, _judged(setting))
    value = getattr(setting.figures, kind.figure)
    return math.inf if value is None or math.isnan(value) else value


def _judged(setting: Setting) -> JudgedLoop:
    uses_log = setting.method.kind.referenced
    whole, growth = lambda: setting.whole, lambda: setting.growth_per_s
    heading = lambda: setting.heading_settling_s  # noqa: E731
    return JudgedLoop(setting.network, setting.loop, uses_log, whole, growth, heading)


def over_run(keys: Iterable[str]) -> bool:
    """Whether one of some quantities has no steady state, so that all are judged over the run."""
    return any([*QUANTITIES[key].names] == ["ensemble"] for key in keys)


_TERM = re.compile(r"(?:(?P<weight>[0-9.]+(?:e[+-]?[0-9]+)?)\s*\*\s*)?(?P<name>[a-z][a-z0-9_]*)\Z")
_REQUIREMENT = re.compile(
    r"\s*(?P<name>[a-z][a-z0-9_]*)\s*(?P<sense><=|>=)\s*(?P<value>\S.*?)\s*(?P<unit>[a-z/]*)\s*\Z"
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

    def reference(self, settings: Iterable[Setting]) -> dict[str, float]:
        """Largest value of each measure in some settings: what the terms of a sum count relative to."""
        settings = [*settings]
        return {name: max(measure(setting, name) for setting in settings) for name in self.names}

    def value(self, setting: Setting, before: dict[str, float]) -> float:
        """Value of a setting; ``before`` are the measures of the setting that the search began with."""
        if len(self.terms) == 1:
            return measure(setting, self.terms[0][0])
        total = 0.0
        for name, weight in self.terms:
            unit = before.get(name, 1.0)
            unit = unit if math.isfinite(unit) and unit > 0.0 else 1.0
            total += weight * measure(setting, name) / unit
        return total


@dataclass(frozen=True)
class Requirement:
    """A limit on a measure.

    Attributes
    ----------
    text : str
        As given: a `Text` that keeps the measure and the limit, ``limited`` and ``si``, for whoever words it.
    name, sense : str
        Measure, and "<=" or ">=".
    limit : float
        SI.
    """

    text: str
    name: str
    sense: str
    limit: float

    @classmethod
    def of(cls, name: str, sense: str, limit: float) -> "Requirement":
        """Make a limit of its parts; its text is as `read_requirement` reads it."""
        return cls(Text("{limited}{sense}{si!r}", limited=name, sense=sense, si=limit), name, sense, limit)

    def excess(self, setting: Setting) -> float:
        """By how much it is missed, relative to the limit; 0 when it is met."""
        value = measure(setting, self.name)
        miss = value - self.limit if self.sense == "<=" else self.limit - value
        if math.isnan(miss):
            return math.inf
        return max(0.0, miss / self._scale)

    def active(self, setting: Setting) -> bool:
        """Whether a setting stands at the limit, to 1 %."""
        value = measure(setting, self.name)
        return abs(value - self.limit) <= 0.01 * self._scale

    @property
    def _scale(self) -> float:
        """Size that a miss is divided by: the limit; where that may be 0, at least a typical value."""
        return max(abs(self.limit), QUANTITIES[self.name].typical)


def in_display_unit(name: str, value: float | None) -> tuple[float | None, str]:
    """Value of a measure in the unit in which it is shown, and that unit; of a sum it has none."""
    quantity = QUANTITIES.get(name)
    if quantity is None:
        return value, ""
    shown = quantity.shown if quantity.unit == "rad" else quantity.unit
    return None if value is None else value / UNITS[shown], shown


def in_words(name: str, value: float) -> str:
    """Value of a measure with its unit."""
    if not math.isfinite(value):
        return Text("no finite value")
    in_unit, unit = in_display_unit(name, value)
    if name not in QUANTITIES:
        return f"{in_unit:.4g}"
    template = "{in_unit:.4g} {unit}" if unit else "{in_unit:.4g}"
    return Text(template, in_unit=in_unit, unit=unit, quantity=name, si=value)


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
        if match is None or match["name"] not in TUNED:
            allowed = Text(
                "must be one of {objectives}, or a sum such as tilt_rms + 0.5*velocity_rms",
                objectives=", ".join(OBJECTIVES),
            )
            raise InputError(Fault("", "--objective", text, allowed))
        if match["name"] not in OBJECTIVES:
            allowed = Text(
                "is better when larger: ask for it as a requirement, {name}>=0.5", name=match["name"]
            )
            raise InputError(Fault("", "--objective", text, allowed))
        try:
            weight = float(match["weight"] or 1.0)
        except ValueError:
            weight = 0.0
        if not 0.0 < weight < math.inf:
            raise InputError(Fault("", "--objective", text, Text("weights must be numbers > 0")))
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
    if match is None or match["name"] not in TUNED:
        allowed = Text(
            "must have the form NAME<=VALUE or NAME>=VALUE with NAME one of {measures}",
            measures=", ".join(TUNED),
        )
        raise InputError(Fault("", "--require", text, allowed))
    unit = match["unit"]
    own = QUANTITIES[match["name"]].unit
    same = {"rad": ("rad", "deg", "arcmin", "arcsec"), "s": ("s", "min", "h"), "m": ("m", "km")}.get(
        own, (own,)
    )
    if unit and unit not in same:
        raise InputError(
            Fault("", "--require", text, Text("unit must be one of {same}", same=", ".join(same) or "none"))
        )
    try:
        limit = read_number(match["value"]) * (UNITS[unit] if unit else 1.0)
    except NotANumber as error:
        allowed = Text("the limit {error}", error=str(error))
        raise InputError(Fault("", "--require", text, allowed)) from None
    given = Text("{text}", text=text.strip(), limited=match["name"], si=limit)
    return Requirement(given, match["name"], match["sense"], limit)
