"""The fields of NMEA sentences of one kind, read column by column into SI values.

What is not given is NaN, what makes no sense is infinite.
"""

import math
from collections.abc import Callable

import numpy as np

from navcore.foundation.units import DEG, KNOT
from navcore.io import nmea_values as value
from navcore.io.decimals import decimals
from navcore.io.nmea_flags import Flag, letters_of
from navcore.io.nmea_lines import Sentences

_FASTEST = 1000.0
"""Greatest speed that makes sense, m/s."""


class Fields:
    """Fields of n sentences of one kind, by column; those that a sentence leaves out are empty.

    Parameters
    ----------
    sentences : Sentences
        Among which they are.
    rows : ndarray of int, shape (n,)
        Which they are.
    carried : dict
        Flags of the last sentence of each instrument that speaks of others, as numbers.

    Attributes
    ----------
    count : ndarray of int, shape (n,)
        How many each sentence has.
    proven : ndarray of bool, shape (n,)
        Whether each has a checksum.
    """

    def __init__(self, sentences: Sentences, rows: np.ndarray, carried: dict[str, int]) -> None:
        self._sentences, self._rows, self.carried = sentences, rows, carried
        self._block, begins = sentences.block, sentences.rows["begin"][rows]
        self._ends = sentences.rows["end"][rows]
        self.proven = sentences.rows["checksum"][rows] >= 0
        self._stops = np.append(self._block.commas, self._block.letters.size)
        self._first = np.searchsorted(self._block.commas, begins)
        self.count = np.searchsorted(self._block.commas, self._ends) - self._first

    @property
    def sources(self) -> list[str]:
        """Instruments of the sentences."""
        return [self._sentences.sources[row] for row in self._rows.tolist()]

    def _places(self, place: int) -> tuple[np.ndarray, np.ndarray]:
        """Where the fields begin and end."""
        begins, ends = (
            np.minimum(self._stops.take(self._first + place + k, mode="clip") + 1 - k, self._ends)
            for k in (0, 1)
        )
        return begins, ends

    def texts(self, place: int) -> list[str]:
        """Fields at a place behind the address."""
        return self._block.texts(*self._places(place))

    def are(self, place: int, text: str) -> np.ndarray:
        """Whether the fields at a place are this text."""
        begins, ends = self._places(place)
        same = ends - begins == len(text)
        for k, letter in enumerate(text):
            same &= self._block.ascii(begins + k) == ord(letter)
        return same

    def codes(self, *flags: Flag) -> np.ndarray:
        """What flags say of the readings, as numbers of `navcore.io.nmea_flags`; of several the worst."""
        worst = np.zeros(self.count.size, np.int8)
        for flag in flags:
            begins, ends = self._places(flag.place)
            letters, empty, code_of = letters_of(flag)
            found = np.where(ends > begins, letters[self._block.ascii(begins)], empty)
            for row in np.flatnonzero(ends > begins + 1).tolist():
                found[row] = code_of(self._block.text[begins[row] : ends[row]])
            worst = np.maximum(worst, found)
        return worst

    def of(self, read: Callable[..., float], *places: int) -> np.ndarray:
        """Values of the fields at some places."""
        return np.fromiter(map(read, *(self.texts(place) for place in places)), float, self.count.size)

    def numbers(self, place: int, low: float, high: float) -> np.ndarray:
        """Optional numbers within a range."""
        begins, ends = self._places(place)
        numbers = decimals(self._block.letters, begins, ends)
        for row in np.flatnonzero(np.isnan(numbers) & (begins < ends)).tolist():
            numbers[row] = value.number(self._block.text[begins[row] : ends[row]])
        return np.where((numbers < low) | (numbers > high), math.inf, numbers)

    def speeds(self, place: int, unit: float = KNOT) -> np.ndarray:
        """Optional speeds, m/s."""
        return self.numbers(place, -_FASTEST / unit, _FASTEST / unit) * unit

    def headings(self, place: int) -> np.ndarray:
        """Optional headings in [0, 2 pi), rad."""
        degrees = self.numbers(place, 0.0, 360.0)
        return (np.where(degrees == 360.0, 0.0, degrees) + 0.0) * DEG

    def angles(self, place: int, positive: str, negative: str, most: float) -> np.ndarray:
        """Latitudes or longitudes, ``dddmm.mmmm`` and the side in the next field, rad."""
        begins, ends = self._places(place)
        minutes = self._block.next_of(self._block.points, begins) - 2
        plain = (minutes > begins) & (minutes + 3 < ends)
        for where in (begins, minutes):
            plain &= self._block.ascii(where) - np.uint32(ord("0")) < 10
        whole = decimals(self._block.letters, begins, minutes)
        degrees = whole + decimals(self._block.letters, minutes, ends) / 60.0
        for row in np.flatnonzero(~plain | np.isnan(degrees)).tolist():
            degrees[row] = value.degrees(self._block.text[begins[row] : ends[row]])
        sides = self.are(place + 1, positive), self.are(place + 1, negative)
        signed = np.where(sides[0], degrees, -degrees) * DEG
        return np.where((degrees <= most) & (sides[0] | sides[1]), signed, math.inf)
