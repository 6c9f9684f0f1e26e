"""Visitors none of whose pages is open, and how long what they have asked for goes on."""

import time
from collections.abc import Mapping

from navcore.foundation.errors import Fault, InputError

AWAY_MINUTES = "SCHULER_AWAY_MINUTES"
"""In the environment: how long the jobs of a visitor without an open page go on."""
AWAY_S, _MOST_MINUTES = 600.0, 1440.0


def away_seconds(environment: Mapping[str, str]) -> float:
    """Time that the jobs of a visitor without an open page go on: `AWAY_MINUTES` of an environment.

    Raises
    ------
    InputError
        It is no number from 0 to 1440.
    """
    given = environment.get(AWAY_MINUTES)
    if given is None:
        return AWAY_S
    try:
        minutes = float(given)
    except ValueError:
        minutes = -1.0
    if not 0.0 <= minutes <= _MOST_MINUTES:
        allowed = f"must be a number of minutes from 0 to {_MOST_MINUTES:g}"
        raise InputError(Fault("environment", AWAY_MINUTES, given, allowed))
    return 60.0 * minutes


class Away:
    """Since when visitors are away. The scheduler that asks locks it.

    Parameters
    ----------
    longest_s : float
        What they have asked for goes on for so long.
    """

    def __init__(self, longest_s: float = AWAY_S) -> None:
        self.longest_s = longest_s
        self._since_s: dict[object, float] = {}

    def __contains__(self, visitor: object) -> bool:
        return visitor in self._since_s

    def leave(self, visitor: object) -> None:
        """The visitor's last page has gone."""
        self._since_s[visitor] = time.monotonic()

    def come_back(self, visitor: object) -> bool:
        """Forget the visitor; whether one was away."""
        return self._since_s.pop(visitor, None) is not None

    def since_s(self, visitor: object) -> float:
        """When the visitor left, monotonic."""
        return self._since_s[visitor]

    def too_long(self, visitor: object) -> bool:
        """Whether the visitor is away, and has been for longer than `longest_s`."""
        since_s = self._since_s.get(visitor)
        return since_s is not None and time.monotonic() - since_s > self.longest_s
