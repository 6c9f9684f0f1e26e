"""Pareto fronts of two objectives: one for every network, and the settings on it."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from navcore.analysis.whole_system import duration
from navcore.design.measures import in_display_unit
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.text import Text


@dataclass(frozen=True)
class Point:
    """One setting of a network that no other of that network beats in both objectives.

    Attributes
    ----------
    values : (float, float)
        Objectives, SI.
    network : dict
        The network block that gives them.
    growth_per_s : float
        Fastest growth of the whole system with it as the law is sampled, 1/s.
    earth_growth : float
        Growth of the 24 h mode of the whole system with it, 1/s (theory.md 10); negative when it decays.
    """

    values: tuple[float, float]
    network: dict[str, Any]
    earth_growth: float = 0.0
    growth_per_s: float = 0.0

    @property
    def setting(self) -> str:
        """Its parameters in words, and how fast its whole system grows."""
        numbers = (
            f"{name} = {value:.4g}" for name, value in self.network.items() if isinstance(value, float)
        )
        words = ", ".join(numbers)
        if self.growth_per_s <= 0.0:
            return words
        every = duration(1.0 / self.growth_per_s)
        words = words or Text("no parameter")
        return Text("{words}; its whole system grows by e in {every}", words=words, every=every)


@dataclass(frozen=True)
class Pareto(Answer):
    """Fronts of all networks.

    Attributes
    ----------
    objectives : (str, str)
        What is on the axes.
    fronts : dict of tuple of Point
        By network id, in order of the first objective.
    present : (float, float) or None
        Of the method as it is; None where it has no finite values.
    floor : tuple of float or None
        Of each objective.
    stopped : bool
        The search was cancelled.
    """

    objectives: tuple[str, str]
    fronts: dict[str, tuple[Point, ...]]
    present: tuple[float, float] | None
    floor: tuple[float | None, float | None]
    stopped: bool

    @property
    def so_far(self) -> str:
        """That these are the fronts that were found by then."""
        return Text("these are the fronts so far")

    def document(self) -> dict[str, Any]:
        """Return a document that JSON can hold."""
        return {
            "objectives": list(self.objectives),
            "floor": list(self.floor),
            "present": None if self.present is None else list(self.present),
            "fronts": [
                {
                    "network": name,
                    "points": [
                        {"values": list(p.values), "network": p.network, "growth_per_s": p.growth_per_s}
                        for p in points
                    ],
                }
                for name, points in self.fronts.items()
            ],
            "stopped": self.stopped,
        }

    def rows(self) -> Iterator[Table]:
        """Give the ends of each front and the settings there, the present design and the floor."""
        heads = [Column(name, in_display_unit(name, None)[1]) for name in self.objectives]
        rows: list[tuple[str | float | None, ...]] = []
        for name, points in self.fronts.items():
            chosen = [points[0], points[len(points) // 2], points[-1]] if len(points) > 2 else list(points)
            for k, point in enumerate(chosen):
                rows.append((name if k == 0 else "", *self._shown(point.values), point.setting))
        if self.present is not None:
            rows.append((Text("as it is"), *self._shown(self.present), ""))
        rows.append((Text("floor"), *self._shown(self.floor), ""))
        yield Table((Column(), *heads, Column(left=True)), tuple(rows))

    def _shown(self, values: tuple[float | None, float | None]) -> list[float | None]:
        return [in_display_unit(name, value)[0] for name, value in zip(self.objectives, values, strict=True)]
