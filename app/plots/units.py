"""Which unit a plot shows: chosen by the size of what it shows, named in its label.

The time plots' axis labels and cursor values have at most three decimals, so a unit must keep the peak well
above 0.01; the bounds below leave a factor of two to spare.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from navcore.foundation.notation import unit_sign
from navcore.foundation.text import Text
from navcore.foundation.units import ARCMIN, ARCSEC, HOUR, MINUTE, NAUTICAL_MILE, UNITS


@dataclass(frozen=True)
class Unit:
    """A unit on screen.

    Attributes
    ----------
    name : str
        As written in a label.
    si : float
        One unit in SI.
    """

    name: str
    si: float


AUTO = "auto"
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
NAMED = {name: Unit(unit_sign(name), size) for name, size in UNITS.items()}
"""Units that a user can ask for, by name."""
_LEAST = 0.02
"""Peak below which three decimals say too little."""

# Smallest peak (SI) from which each unit is used; the last whose bound is reached counts.
_ANGLES = (
    (0.0, Unit("µas", 1e-6 * ARCSEC)),
    (2e-5 * ARCSEC, Unit("mas", 1e-3 * ARCSEC)),
    (0.02 * ARCSEC, NAMED["arcsec"]),
    (180.0 * ARCSEC, NAMED["arcmin"]),
    (180.0 * ARCMIN, NAMED["deg"]),
)
_SPEEDS = (
    (0.0, Unit("µm/s", 1e-6)),
    (2e-5, Unit("mm/s", 1e-3)),
    (0.02, NAMED["m/s"]),
    (5e3, Unit("km/s", 1e3)),
)
_LENGTHS = (
    (0.0, Unit("µm", 1e-6)),
    (2e-5, Unit("mm", 1e-3)),
    (0.02, NAMED["m"]),
    (3e3, Unit("km", 1e3)),
    (10.0 * NAUTICAL_MILE, NAMED["nmi"]),
)


def angle_unit(peak_rad: float) -> Unit:
    """Unit for angles up to ``peak_rad``: arcsec below 3', arcmin below 3 deg."""
    return _chosen(_ANGLES, peak_rad, NAMED["arcsec"])


def speed_unit(peak_mps: float) -> Unit:
    """Unit for velocities up to ``peak_mps``: m/s from 2 cm/s."""
    return _chosen(_SPEEDS, peak_mps, NAMED["m/s"])


def length_unit(peak_m: float) -> Unit:
    """Unit for lengths up to ``peak_m``: m below 3 km, km below 10 nmi, then nmi."""
    return _chosen(_LENGTHS, peak_m, NAMED["m"])


def time_unit(span_s: float, wanted: str = AUTO) -> Unit:
    """Minutes below 3 h, else hours; or the one that is wanted by name."""
    if wanted != AUTO:
        return NAMED[wanted]
    return NAMED["min"] if span_s < 3.0 * HOUR else NAMED["h"]


def wanted_unit(name: str, peak: float, chosen: Callable[[float], Unit]) -> Unit:
    """Unit that is asked for by name, legibly scaled; with ``AUTO`` what ``chosen`` gives for the peak."""
    return chosen(peak) if name == AUTO else scaled_unit(name, peak)


def scaled_unit(name: str, peak: float) -> Unit:
    """The named unit, or a thousandth, a millionth ... of it where the peak (SI) needs that to be legible.

    Examples
    --------
    >>> scaled_unit("m", 3.0).name, scaled_unit("nmi", 3.0).name
    ('m', '10⁻³ nmi')
    """
    unit = NAMED[name]
    if not math.isfinite(peak) or peak <= 0.0 or peak >= _LEAST * unit.si:
        return unit
    parts = ((1e-3, "10⁻³"), (1e-6, "10⁻⁶"), (1e-9, "10⁻⁹"))
    part, word = next((each for each in parts if peak >= _LEAST * unit.si * each[0]), parts[-1])
    return Unit(Text("{word} {name}", word=word, name=unit.name), unit.si * part)


def _chosen(table: tuple[tuple[float, Unit], ...], peak: float, otherwise: Unit) -> Unit:
    if not math.isfinite(peak) or peak <= 0.0:
        return otherwise
    return [unit for bound, unit in table if peak >= bound][-1]


def number(value: float, digits: int = 5) -> str:
    """Number with at most ``digits`` significant digits, without an exponent where that is readable.

    Examples
    --------
    >>> number(1234567.0), number(0.012345678), number(2.5), number(-1e-9)
    ('1.2346×10⁶', '0.012346', '2.5', '-1×10⁻⁹')
    """
    if not math.isfinite(value):
        return "∞" if value > 0 else "-∞" if value < 0 else "n/a"
    return in_powers(f"{value:.{digits}g}")


def in_powers(text: str) -> str:
    """Number with its exponent as a power of ten.

    Examples
    --------
    >>> in_powers("6.4e+06"), in_powers("2.50e-05"), in_powers("0.1")
    ('6.4×10⁶', '2.50×10⁻⁵', '0.1')
    """
    mantissa, has, exponent = text.partition("e")
    return f"{mantissa}×10{str(int(exponent)).translate(_RAISED)}" if has else text


def rounded(value: float, digits: int = 3) -> str:
    """Number with ``digits`` significant digits, trailing zeros included, without an exponent where readable.

    Examples
    --------
    >>> rounded(2820.2), rounded(9.558), rounded(0.91542), rounded(0.0), rounded(1.5e-7)
    ('2820', '9.56', '0.915', '0', '1.50×10⁻⁷')
    """
    if not math.isfinite(value) or value == 0.0:
        return number(value)
    text = f"{value:.{digits - 1}e}"
    size = abs(float(text))
    if not 1e-4 <= size < 1e7:
        return in_powers(text)
    return f"{float(text):.{max(0, digits - 1 - math.floor(math.log10(size)))}f}"


_AS_FACTOR = 10.0
"""A change from here on is a factor: nobody reads "+97224 %"."""


def relative(new: float, old: float, digits: int = 0) -> str:
    """Change of a number against an old one that is not 0, in per cent or as a factor; "" where none is left.

    Examples
    --------
    >>> relative(1.2, 1.0), relative(0.5, 0.4444, 1), relative(973.2, 1.0), relative(1.0001, 1.0)
    ('+20 %', '+12.5 %', '× 973', '')
    """
    if new / old >= _AS_FACTOR:
        return f"× {number(new / old, 3)}"
    part = round(100.0 * (new - old) / abs(old), digits)
    return f"{part:+.{digits}f} %" if part else ""


def settling(seconds: float | None) -> str:
    """Time to settle, in minutes wherever the page tells it; "never" for None or inf.

    Examples
    --------
    >>> settling(11982.0), settling(None)
    ('200 min', 'never')
    """
    return (
        Text("never")
        if seconds is None or math.isinf(seconds)
        else Text("{seconds} min", seconds=rounded(seconds / MINUTE))
    )


def duration(seconds: float, digits: int = 3) -> str:
    """Period or duration in the unit a navigator would use.

    Examples
    --------
    >>> duration(5067.0), duration(86164.0), duration(45.0), duration(7e5)
    ('84.5 min', '23.9 h', '45 s', '8.1 d')
    """
    for bound, size, name in ((100.0, 1.0, "s"), (3.0 * HOUR, MINUTE, "min"), (100.0 * HOUR, HOUR, "h")):
        if seconds < bound:
            return f"{seconds / size:.{digits}g} {name}"
    return f"{seconds / (24.0 * HOUR):.{digits}g} d"


def round_down(value: float, mantissas: tuple[float, ...] = (1.0, 2.0, 5.0)) -> float:
    """Largest number of the form mantissa x 10^k that is not above ``value`` (> 0)."""
    power = 10.0 ** math.floor(math.log10(value))
    scaled = value / power * (1.0 + 1e-12)
    return max(m for m in mantissas if m <= scaled) * power


def round_up(value: float, mantissas: tuple[float, ...] = (1.0, 2.0, 5.0)) -> float:
    """Smallest number of the form mantissa x 10^k that is not below ``value`` (> 0)."""
    power = 10.0 ** math.floor(math.log10(value))
    scaled = value / power * (1.0 - 1e-12)
    return next((m for m in mantissas if m >= scaled), 10.0 * mantissas[0]) * power
