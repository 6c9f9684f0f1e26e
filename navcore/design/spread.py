"""Several scenarios over which one setting has to hold, and which of them counts (theory.md 18)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from navcore.scenario.model import Scenario


@dataclass(frozen=True)
class Spread:
    """Scenarios beside the one that is tuned, over which a setting has to hold too.

    Attributes
    ----------
    scenarios : tuple of Scenario
        Of other sensors, seas, latitudes; their methods do not count.
    quantile : float
        Which of all scenarios counts, by what a setting makes of them: 0 the worst, 0.5 the median.
    """

    scenarios: tuple[Scenario, ...] = ()
    quantile: float = 0.0

    def of_ratios(self, ratios: Sequence[float]) -> float:
        """Value over the limit that counts: large is bad."""
        return float(np.quantile(ratios, 1.0 - self.quantile, method="higher"))

    def of_shares(self, shares: Sequence[float]) -> float:
        """Share of seeds that counts: small is bad."""
        return float(np.quantile(shares, self.quantile, method="lower"))


NO_SPREAD = Spread()
"""The scenario alone."""
