"""One visitor's verifications: the scenario as full strapdown beside the linear model, in the background."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.search import Search

if TYPE_CHECKING:
    from navcore.engine.verification import Verification


@dataclass(frozen=True)
class Verified:
    """A verification to be shown beside a run.

    Attributes
    ----------
    verification : Verification
        Of the same methods.
    old : bool
        It is of an earlier scenario.
    """

    verification: Verification
    old: bool


STOPPED, CHANGED = (
    Text("Stopped: nothing was verified."),
    Text("Stopped: the scenario was changed meanwhile."),
)

SEEDS = 4
"""Seeds over which the two models are compared."""

Verify = Callable[[Scenario, Callable[[float], None], Callable[[], bool]], "Verification"]


class Verifier(Search[Scenario, "Verification"]):
    """Verifies one scenario at a time; a change of the scenario stops it, and makes its result an old one.

    Parameters
    ----------
    tell : callable
        ``tell()`` whenever there is something new to show, from the thread that verifies.
    verify : callable, optional
        In place of `navcore.engine.verification.verify`.
    name : str
        Of the visitor, for the turns.
    """

    def __init__(
        self, tell: Callable[[], None], verify: Verify | None = None, name: str = "verifier"
    ) -> None:
        super().__init__(tell, verify or _verify, lambda found: found.complete, STOPPED, name)

    def follow(self, scenario: Scenario) -> None:
        """Take note that this is the scenario now."""
        self.words = ()
        if self.under_way is not None and self.under_way != scenario:
            self.cancel(CHANGED)

    def beside(self, scenario: Scenario) -> Verified | None:
        """Give the result for a run of this scenario, if its methods have the same names."""
        with self._lock:
            result, of = self.result, self.asked
        if result is None or of is None or [m.name for m in of.method] != [m.name for m in scenario.method]:
            return None
        return Verified(result, of != scenario)


def _verify(
    scenario: Scenario, progress: Callable[[float], None], cancelled: Callable[[], bool]
) -> Verification:
    from navcore.engine.verification import verify

    return verify(scenario, progress, cancelled, SEEDS)
