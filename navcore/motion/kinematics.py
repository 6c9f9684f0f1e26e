"""A motion as compiled loops read it: one layout of plain arrays for all kinds."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from navcore.motion.truth import COLUMNS

REST, SWING, COURSE, PROFILE, WAVES, PIECES = range(6)
"""Layouts of a motion in compiled loops. PIECES, polynomials of time, serves any motion."""
KINDS = (REST, SWING, COURSE, PROFILE, WAVES, PIECES)

WIDTH = 72
"""Width of a row of the buffer that a motion is filled into, quantity by quantity: quantity j (a column of
`navcore.motion.truth`) lies from j * WIDTH on. Known when compiling, or LLVM would not vectorise."""

FREQUENCY, PHASE = 2, 3
"""Columns of every table of oscillations: Hz, cycles at t = 0."""


@dataclass(frozen=True)
class Kinematics:
    """A motion as compiled loops take it; arrays that a kind does not use are empty shells.

    Attributes
    ----------
    kind : int
        REST, SWING, COURSE, PROFILE, WAVES or PIECES.
    rest : ndarray, shape (15,)
        Row of truth of what does not move.
    oscillations : ndarray, shape (m, c)
        SWING: one row an angle (`SwingMotion.packed`); WAVES: one row a component.
    legs : ndarray, shape (m, c)
        Pieces of the motion in time, the first column when each begins (s): legs of a course, polynomials
        (`navcore.motion.pieces`).
    nodes : ndarray, shape (k, 6)
        Position nodes of a course (`navcore.motion.course`).
    attitude : ndarray, shape (m, 6)
        PROFILE: pitch, roll, heading at each leg's start and their changes, rad.
    """

    kind: int
    rest: np.ndarray
    oscillations: np.ndarray = field(default_factory=lambda: np.zeros((3, 4)))
    legs: np.ndarray = field(default_factory=lambda: np.zeros((1, 8)))
    nodes: np.ndarray = field(default_factory=lambda: np.zeros((2, 6)))
    attitude: np.ndarray = field(default_factory=lambda: np.zeros((1, 6)))

    def __post_init__(self) -> None:
        assert self.rest.shape == (COLUMNS,)
        if self.kind not in KINDS:  # compiled loops would take it for a vehicle at rest
            raise ValueError(f"no compiled loop knows motions of kind {self.kind}")

    def moved(self, seconds: float) -> Kinematics:
        """Return the same motion, t = 0 being ``seconds`` later on it (earlier when negative)."""
        oscillations, legs, nodes = self.oscillations.copy(), self.legs.copy(), self.nodes.copy()
        oscillations[:, PHASE] += seconds * oscillations[:, FREQUENCY]
        legs[:, 0] -= seconds
        nodes[:, 0] -= seconds
        return replace(self, oscillations=oscillations, legs=legs, nodes=nodes)

    def turns(self, step_s: float) -> np.ndarray:
        """Cosine and sine of each oscillation's angle after 0, 1, ... steps, from phase 0 on.

        Returns
        -------
        ndarray, shape (2 m WIDTH,)
            Cosines of the first oscillation, its sines, cosines of the second, ...
        """
        angle = 2.0 * np.pi * np.outer(self.oscillations[:, FREQUENCY], np.arange(WIDTH) * step_s)
        return np.stack([np.cos(angle), np.sin(angle)], axis=1).reshape(-1)
