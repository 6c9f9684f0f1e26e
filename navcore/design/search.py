"""A bounded global search with a local finish over the parameters of a method, by scipy (theory.md 18)."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from navcore.design.measures import Objective, Requirement, Setting, Ship
from navcore.design.vary import Varied, changed
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

MISSED = 1e12
"""Cost of a setting that misses a requirement, above every one that meets all."""
BOUNDLESS = 0.9 * MISSED
"""Cost of a setting that meets them and whose objective has no finite value."""
UNSTABLE = 5e17
"""Cost of a setting whose level loop grows as it is sampled, and more the faster it grows."""
REFUSED = 1e18
"""Cost of a setting that makes no method at all."""
_SEED = 1


@dataclass(frozen=True)
class Effort:
    """Limits of a search.

    Attributes
    ----------
    population, generations : int
        Of the global search, a parameter; generations at most.
    finish : int
        Evaluations of the local finish.
    """

    population: int
    generations: int
    finish: int


STEADY = Effort(10, 22, 160)
ALONG = Effort(7, 9, 50)
"""A run of a day takes some 30 ms an evaluation."""
EXPLAIN = Effort(6, 8, 60)
"""To tell what is in reach, to three digits or so."""


class _Stopped(Exception):
    """The user stopped the search."""


class Search:
    """Cost of a set of parameters, with all that stays the same.

    Parameters
    ----------
    ships : sequence of Ship
        The scenario that is tuned, and others on which the worst case counts.
    varied : sequence of Varied
        What may move.
    objective : Objective
        What to make small.
    requirements : sequence of Requirement
        What to keep.
    progress, cancelled : callable, optional
        Told the fraction done; asked before each evaluation.
    """

    def __init__(
        self,
        ships: Sequence[Ship],
        varied: Sequence[Varied],
        objective: Objective,
        requirements: Sequence[Requirement],
        progress: Callable[[float], None] | None = None,
        cancelled: Callable[[], bool] | None = None,
    ) -> None:
        self.ships, self.varied, self.objective = ships, varied, objective
        self.requirements = tuple(requirements)
        self.progress, self.cancelled = progress, cancelled
        self.done, self.expected = 0, 1
        self.reference: dict[str, float] = {}
        self.scale = 1.0
        self.best: tuple[float, np.ndarray] | None = None
        self.refused: InputError | None = None
        self.unstable = ""

    def settings(self, places: np.ndarray) -> list[Setting]:
        """Return the method at a place of the ranges, on each ship; raises InputError where there is none."""
        values = self.values(places)
        return [Setting(ship, changed(ship.scenario, self.varied, values)) for ship in self.ships]

    def now(self) -> list[Setting]:
        """Return the method as it is set, on each ship."""
        return [Setting(ship, ship.scenario.method[self.varied[0].method]) for ship in self.ships]

    def values(self, places: np.ndarray) -> list[float]:
        """Values of the fields at places 0..1 of their ranges."""
        return [one.value(float(place)) for one, place in zip(self.varied, places, strict=True)]

    def value(self, settings: Sequence[Setting]) -> float:
        """Objective of the worst ship."""
        return max(self.objective.value(setting, self.reference) for setting in settings)

    def excess(self, settings: Sequence[Setting]) -> float:
        """Sum of what misses the requirements, on the worst ship."""
        return max(sum(one.excess(setting) for one in self.requirements) for setting in settings)

    def cost(self, places: np.ndarray) -> float:
        """Objective relative to its scale, above `MISSED` where a requirement is missed."""
        if self.cancelled is not None and self.cancelled():
            raise _Stopped
        self.done += 1
        if self.progress is not None:
            self.progress(min(1.0, self.done / self.expected))
        places = np.clip(places, 0.0, 1.0)
        try:
            settings = self.settings(places)
            missed = self.excess(settings) if self.requirements else 0.0
            self.unstable = max(setting.instability for setting in settings)
            if self.unstable:
                cost = UNSTABLE * (1.0 + min(0.5, max(setting.growth_per_s for setting in settings)))
            elif missed > 0.0:
                cost = MISSED * (1.0 + min(missed, 1e5))
            else:
                cost = min(self.value(settings) / self.scale, BOUNDLESS)
        except InputError as error:
            self.refused, cost = error, REFUSED
        except np.linalg.LinAlgError:
            cost = REFUSED
        if not math.isfinite(cost):
            cost = BOUNDLESS
        if self.best is None or cost < self.best[0]:
            self.best = (cost, places.copy())
        return cost

    def run(self, effort: Effort, start: np.ndarray | None) -> bool:
        """Search; the best is then in `best`. Return whether the search was stopped."""
        from scipy.optimize import differential_evolution

        count = len(self.varied)
        self.done, self.best = 0, None
        self.expected = effort.population * count * (effort.generations + 1) // 2 + effort.finish
        bounds = [(0.0, 1.0)] * count
        try:
            if start is not None:
                self.cost(start)
            differential_evolution(
                self.cost,
                bounds,
                popsize=effort.population,
                maxiter=effort.generations,
                tol=1e-4,
                rng=_SEED,
                init="sobol",
                polish=False,
                x0=start,
            )
            assert self.best is not None
            for _ in range(2):  # again from where it stood: a flat valley shrinks the simplex
                self._local(self.best[1], effort.finish // 2)
        except _Stopped:
            return True
        return False

    def near(self, start: np.ndarray, evaluations: int) -> bool:
        """Search around a place; the best is then in `best`. Return whether the search was stopped."""
        self.best = None
        try:
            self._local(start, evaluations)
        except _Stopped:
            return True
        return False

    def _local(self, start: np.ndarray, evaluations: int) -> None:
        """Nelder-Mead from a place."""
        from scipy.optimize import minimize

        count = len(self.varied)
        simplex = start + 0.04 * np.vstack([np.zeros(count), np.eye(count)])
        simplex = np.where(simplex > 1.0, simplex - 0.08, simplex)
        options = {"initial_simplex": simplex, "maxfev": evaluations, "xatol": 1e-6, "fatol": 1e-9}
        bounds = [(0.0, 1.0)] * count
        minimize(self.cost, start, method="Nelder-Mead", bounds=bounds, options=options)


def no_method(search: Search, vary: str) -> Iterator[Fault]:
    """Say why no value within the ranges can be run."""
    yield Fault("", "--vary", vary, Text("no value within these ranges makes a method"))
    if search.refused is not None:
        yield from search.refused.faults
