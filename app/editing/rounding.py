"""Round numbers: ends and steps of sliders, and what a slider's place is read as."""

import math


def round_step(width: float) -> float:
    """Largest of 1, 2, 5 times a power of ten that is at most ``width``.

    Examples
    --------
    >>> round_step(0.0130), round_step(0.0051), round_step(7.0)
    (0.01, 0.005, 5.0)
    """
    power = math.floor(math.log10(width))
    mantissa = width / 10.0**power
    factor = next(f for f in (5, 2, 1) if mantissa >= f - 1e-9)
    return float(f"{factor}e{power}")


def round_away(value: float, *, up: bool) -> float:
    """Nearest of 0 and of 1, 2, 5 times a power of ten, of either sign: from a value upwards or downwards.

    Examples
    --------
    >>> round_away(3.4, up=True), round_away(3.4, up=False), round_away(-12.0, up=False)
    (5.0, 2.0, -20.0)
    """
    size = abs(value)
    if size == 0.0:
        return 0.0
    if up != (value > 0.0):
        return math.copysign(round_step(size), value)
    power = math.floor(math.log10(size))
    larger = (float(f"{factor}e{power}") for factor in (1, 2, 5, 10))
    return math.copysign(next(number for number in larger if number >= size * (1.0 - 1e-9)), value)


def significant(value: float, digits: int) -> float:
    """Round to significant digits.

    Examples
    --------
    >>> significant(0.0087902, 3), significant(12345.6, 3), significant(0.0, 3)
    (0.00879, 12300.0, 0.0)
    """
    return float(f"{value:.{digits - 1}e}") if math.isfinite(value) else value
