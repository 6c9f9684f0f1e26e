"""Methods by the share of seeds on which they meet all limits, as an answer."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from navcore.design.needed import MOST, Needed
from navcore.design.shares import Share
from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.text import Text


@dataclass(frozen=True)
class Designs(Answer):
    """Methods by the share of seeds on which they meet all requirements.

    Attributes
    ----------
    seeds : int
        Runs of each method.
    methods : tuple of Share
        Best first.
    assumed_zero : tuple of str
        Standard deviations that the scenario states neither by themselves nor by a number: 0 is assumed.
    left_out : tuple of (str, str)
        Networks for which there is no method, and why.
    needed : tuple of Needed
        Where no method meets all limits on half of the seeds: figures that would have to be better.
    stopped : bool
        It was cancelled: fewer seeds, or methods that were not tuned to the end.
    """

    seeds: int
    methods: tuple[Share, ...]
    assumed_zero: tuple[str, ...]
    left_out: tuple[tuple[str, str], ...] = ()
    needed: tuple[Needed, ...] = ()
    stopped: bool = False

    @property
    def met(self) -> bool:
        """Whether a method meets all limits on half of the seeds."""
        return self.methods[0].met >= 0.5

    @property
    def so_far(self) -> str:
        """How many seeds the shares are of."""
        return Text("these are the shares of {seeds} seeds", seeds=self.seeds)

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "seeds": self.seeds,
            "methods": [share.as_dict() for share in self.methods],
            "assumed_zero": list(self.assumed_zero),
            "left_out": dict(self.left_out),
            "needed": [one.as_dict() for one in self.needed],
            "stopped": self.stopped,
        }

    def rows(self) -> Iterator[Table | str]:
        """Give a row a method: its share, and the limit that is missed most often; then the settings."""
        yield Text("{seeds} seeds, each with its own noise and constants", seeds=self.seeds)
        heads = Text("method"), Text("met %"), Text("95 % interval"), Text("missed most often")
        rows = []
        for share in self.methods:
            worst = min(share.limits, key=lambda limit: limit.met)
            missed: list[str | float | None] = ["-", "", ""]
            if worst.met < 1.0:
                missed = [worst.requirement.quantity, worst.median, worst.requirement.limit]
            low, high = (number(100.0 * end, 3) for end in (share.low, share.high))
            interval = Text("{low} to {high}", low=low, high=high)
            rows.append((share.method.label(), number(100.0 * share.met, 3), interval, *missed))
        yield Table(tuple(map(Column, (*heads, Text("median"), Text("limit")))), tuple(rows))
        yield ""
        if not self.met:
            yield from (*self._alone(), *self._needed(), "")
        for share in self.methods:
            yield Text("{name}: {setting}", name=share.method.label(), setting=share.setting)
        yield from left_out_lines(self.left_out)

    def _alone(self) -> Iterator[str]:
        """Say for each limit the largest share that meets it by itself."""
        yield Text("no method meets all limits on half of the seeds; each limit by itself:")
        for k, one in enumerate(self.methods[0].limits):
            best = max(self.methods, key=lambda share: share.limits[k].met)
            yield Text(
                "  {quantity} {sense} {limit}: at most {share} % ({name})",
                quantity=one.requirement.quantity,
                sense=one.requirement.sense,
                limit=number(one.requirement.limit),
                share=number(100.0 * best.limits[k].met, 3),
                name=best.method.label(),
            )

    def _needed(self) -> Iterator[str]:
        """Say which figures are enough, least factor first, or that no single one is."""
        if not self.needed:
            return
        yield Text("enough for the median of the seeds, with the settings below:")
        every = Text("all limits")
        for one in self.needed:
            words = {"limit": one.quantity or every, "method": one.method}
            if one.factor is None:
                yield Text(
                    "  {limit}: no single figure is enough, not even {most:.0f} times better ({method})",
                    most=MOST,
                    **words,
                )
                continue
            yield Text(
                "  {limit}: {figures} {factor} times better ({method}): met on {before} % of the seeds "
                "before, {after} % after",
                figures=", ".join(one.figures),
                factor=number(one.factor, 3),
                before=number(100.0 * one.before, 3),
                after="-" if one.after is None else number(100.0 * one.after, 3),
                **words,
            )


def left_out_lines(left_out: Iterable[tuple[str, str]]) -> Iterator[str]:
    """Yield the networks for which there is no method, and why."""
    for name, reason in left_out:
        yield Text("{name}: left out: {reason}", name=name, reason=reason)
