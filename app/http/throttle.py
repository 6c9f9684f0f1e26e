"""How often a token may be guessed: a few times at once, then slowly; by address."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field

_MOST_ADDRESSES = 4096


@dataclass
class Throttle:
    """A bucket of guesses for each address; an empty one is refilled slowly.

    Attributes
    ----------
    burst : int
        Wrong guesses that are judged at once.
    refill_s : float
        So long it takes until one more is.
    clock : callable
        Seconds, monotonic.
    guesses : int
        Wrong ones so far.
    """

    burst: int = 10
    refill_s: float = 2.0
    clock: Callable[[], float] = time.monotonic
    guesses: int = 0
    _spent: OrderedDict[str, tuple[float, float]] = field(default_factory=OrderedDict)

    def wait_s(self, address: str) -> float:
        """Seconds until a guess of this address is judged again; 0: now."""
        return max(0.0, (self._level(address) - self.burst + 1.0) * self.refill_s)

    def failed(self, address: str) -> None:
        """Note a wrong guess."""
        self.guesses += 1
        level = self._level(address) + 1.0
        self._spent.pop(address, None)
        self._spent[address] = (level, self.clock())
        while len(self._spent) > _MOST_ADDRESSES:
            self._spent.popitem(last=False)

    def _level(self, address: str) -> float:
        level, at_s = self._spent.get(address, (0.0, 0.0))
        return max(0.0, level - (self.clock() - at_s) / self.refill_s)
