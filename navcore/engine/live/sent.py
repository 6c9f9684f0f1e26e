"""Sentences of an INS sent on with the damped output in them, as `schuler damp` writes them."""

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np

from navcore.engine.live.damping import Piece
from navcore.engine.live.heard import Reading
from navcore.io.rewritten import Moved
from navcore.io.rewritten_nmea import rewritten_line


@dataclass
class Sent:
    """Writes each sentence of the INS once, as a method would have given it out.

    Attributes
    ----------
    method : str
        Whose damping it is.
    """

    method: str
    _last: Moved | None = None

    def lines(self, reading: Reading, piece: Piece, pinned: dict[str, str]) -> Iterator[str]:
        """Yield the sentences of the steps of a piece.

        Parameters
        ----------
        reading : Reading
            What was heard, with these steps in it.
        piece : Piece
            The newest one.
        pinned : dict
            Sentences that give each quantity, `navcore.engine.live.heard.Heard.pinned`.
        """
        moved, last = piece.moved_by(self.method), self._last
        goes_on = last is not None and 0.0 < moved.time_s[0] - last.time_s[-1] < 2.0
        if goes_on and last is not None:
            moved = _joined(last, moved)
        self._last = moved.row(len(moved.time_s) - 1)
        ordered = reading.ordered
        time_s = ordered.time_s + reading.shift_s
        with np.errstate(invalid="ignore"):
            inside = (time_s > moved.time_s[0] if goes_on else time_s >= moved.time_s[0]) & (
                time_s <= moved.time_s[-1]
            )
        lines = reading.text.split("\n")
        for place in np.flatnonzero(inside).tolist():
            address = ordered.names[int(ordered.kinds[place])]
            if not _of_ins(address, pinned):
                continue
            line = lines[int(ordered.lines[place]) - 1].strip()
            yield rewritten_line(line, moved.at(time_s[place : place + 1]))

    def begin_anew(self) -> None:
        """Forget where the last piece ended."""
        self._last = None


def _of_ins(address: str, pinned: dict[str, str]) -> bool:
    """Whether a sentence is of the INS: its receiver's positions, or what gives velocity or attitude."""
    if address in (pinned.get("velocity"), pinned.get("heading"), pinned.get("attitude")):
        return True
    return bool(pinned.get("position")) and address[:2] == pinned["position"]


def _joined(first: Moved, then: Moved) -> Moved:
    parts = {
        one.name: np.concatenate([getattr(first, one.name), getattr(then, one.name)]) for one in fields(Moved)
    }
    parts["heading"] = np.unwrap(parts["heading"])
    return Moved(**parts)
