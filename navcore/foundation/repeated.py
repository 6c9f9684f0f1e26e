"""Something that lasts for a while, once or again and again."""

import numpy as np
from pydantic import model_validator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.foundation.units import HOUR


class Repeated(EitherUnit):
    """Base of what begins at a time, lasts for a while and comes back."""

    t_h: float = quantity(
        0.0,
        unit="h",
        ge=0.0,
        le=10000.0,
        slider=(0.0, 72.0),
        label=Text("begins"),
        help=Text("Time at which it begins; where it is repeated, the first time."),
    )
    duration_s: float = quantity(
        600.0, unit="s", gt=0.0, le=1e7, log=True, label=Text("lasts"), help=Text("Its length.")
    )
    repeat: int = quantity(
        1, unit="1", ge=1, le=10_000, slider=(1, 100), label=Text("times"), help=Text("How often it occurs.")
    )
    every_h: float = quantity(
        1.0,
        unit="h",
        gt=0.0,
        le=10000.0,
        slider=(0.1, 24.0),
        label=Text("every"),
        help=Text("With repeat: time from one beginning to the next, at least duration_s."),
    )

    @model_validator(mode="after")
    def _apart(self) -> "Repeated":
        shortest = self.duration_s / HOUR
        if self.repeat > 1 and self.every_h < shortest * (1.0 - 1e-9):
            allowed = Text("must be >= {shortest:g} (h), which is duration_s", shortest=shortest)
            raise InputError(Fault("", "every_h", self.every_h, allowed))
        return self

    def since(self, time_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Time since the latest beginning, and how many occurrences lie before that one.

        Parameters
        ----------
        time_s : ndarray, shape (m,)
            Times, s.

        Returns
        -------
        elapsed : ndarray, shape (m,)
            s; negative before the first beginning, larger than ``duration_s`` in between.
        before : ndarray, shape (m,)
            0 to ``repeat`` - 1.
        """
        elapsed = time_s - self.t_h * HOUR
        if self.repeat == 1:
            return elapsed, np.zeros(time_s.size)
        every = self.every_h * HOUR
        before = np.clip(np.floor(elapsed / every + 1e-12), 0.0, self.repeat - 1.0)
        return elapsed - before * every, before

    def holds(self, time_s: np.ndarray) -> np.ndarray:
        """Whether it is under way at each time, ndarray of bool, shape (m,)."""
        begin = self.t_h * HOUR
        time_s = time_s - self.since(time_s)[1] * (self.every_h * HOUR)
        return (time_s >= begin) & (time_s < begin + self.duration_s)
