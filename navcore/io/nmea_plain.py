"""Lines of a log that hold one sentence with a checksum, as most do: all lines of a block at once."""

import re
from string import hexdigits

import numpy as np

from navcore.io.stamps import LONGEST_STAMP

LONGEST_LINE = 2048
"""Longer lines are no sentences (an NMEA 0183 sentence has 82 characters) and are left out unread."""
_NAME = np.arange(10)
"""Places of the letters of the longest address."""
_IN_ADDRESS = np.array([re.fullmatch("[A-Z0-9]", chr(k)) is not None for k in range(128)])
_HEXADECIMAL = np.array([int(chr(k), 16) if chr(k) in hexdigits else -256 for k in range(128)])


class Block:
    """Successive lines of a log.

    Attributes
    ----------
    text : str
        The lines.
    letters : ndarray of uint32
        Its characters.
    commas, points : ndarray of int
        Where these stand.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.letters = np.frombuffer(text.encode("utf-32-le"), np.uint32)
        self.commas, self.points = self.places(","), self.places(".")

    def places(self, letter: str) -> np.ndarray:
        """Where a letter stands."""
        return np.flatnonzero(self.letters == ord(letter))

    def texts(self, begins: np.ndarray, ends: np.ndarray) -> list[str]:
        """Texts at some places."""
        return [self.text[begin:end] for begin, end in zip(begins.tolist(), ends.tolist(), strict=True)]

    def next_of(self, places: np.ndarray, begins: np.ndarray) -> np.ndarray:
        """First of some places at or behind each begin; the size of the text where there is none."""
        return np.append(places, self.letters.size)[np.searchsorted(places, begins)]

    def ascii(self, places: np.ndarray) -> np.ndarray:
        """Letters at some places, below 128; 127 for all others."""
        return np.minimum(self.letters.take(places, mode="clip"), 127)


LINE = np.dtype(
    [("begin", int), ("end", int), ("plain", bool), ("mark", int), ("star", int), ("checksum", int)]
)
"""Of a line: its place in the text, up to the line feed; whether it holds one sentence with a checksum, else
the rest means nothing; the places of ``$`` or ``!`` and of ``*``; the checksum that is written."""


def lines_of(block: Block) -> np.ndarray:
    """Lines of a block, of `LINE`, shape (n,)."""
    letters = block.letters
    ends = block.places("\n")
    ends = ends if letters[-1] == ord("\n") else np.append(ends, letters.size)
    begins = np.concatenate([[0], ends[:-1] + 1])
    starts = np.flatnonzero((letters == ord("$")) | (letters == ord("!")))
    marks = block.next_of(starts, begins)
    stars, behind = block.next_of(block.places("*"), marks), block.next_of(block.commas, marks)
    width, head = behind - marks - 1, letters[begins]
    named = _IN_ADDRESS[block.ascii(marks[:, None] + 1 + _NAME)] | (_NAME >= width[:, None])
    high, low = (_HEXADECIMAL[block.ascii(stars + k)] for k in (1, 2))
    plain = (
        (np.searchsorted(starts, ends) - np.searchsorted(starts, begins) == 1)
        & ((head > ord(" ")) & (head < 127) & (head != ord("#")))
        & ((marks - begins <= LONGEST_STAMP) & (ends - begins <= LONGEST_LINE))
        & ((width >= 3) & (width <= _NAME.size) & named.all(axis=1))
        & ((behind < stars) & (stars + 2 < ends) & (high >= 0) & (low >= 0))
    )
    return np.rec.fromarrays([begins, ends, plain, marks, stars, 16 * high + low], LINE)
