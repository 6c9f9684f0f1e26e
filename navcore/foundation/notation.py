"""How units and parameters are written for a reader: signs and Greek letters in place of what keys can hold.

A scenario file, a column or an option spells a unit or a parameter with plain letters (``deg/h``, ``xi``).
What a person reads has the sign (``°/h``, ``ζ``).
"""

import re

_UNITS = {
    "deg": "°",
    "deg/s": "°/s",
    "deg/h": "°/h",
    "deg/sqrt(h)": "°/√h",
    "deg/deg": "°/°",
    "ug": "µg",
    "ug/sqrt(Hz)": "µg/√Hz",
    "m/s2": "m/s²",
    "m/s^2": "m/s²",
    "m/s/sqrt(h)": "m/s/√h",
    "1": "",
}
_SYMBOLS = {
    "sigma": "σ",
    "xi": "ζ",
    "zeta": "ζ",
    "zeta2": "ζ₂",
    "eta": "η",
    "rho": "ρ",
    "alpha": "α",
    "k1": "K₁",
    "k2": "K₂",
    "k3": "K₃",
    "n1": "n₁",
    "n2": "n₂",
    "t1": "T₁",
    "t2": "T₂",
}
"""Parameters of networks. The damping ratio is ζ; Deng, Sun and Zha write ξ for it, and so do the keys."""

_SPELLED = _SYMBOLS | {"omega_s": "ωₛ"}
_WORDS = re.compile(r"`[^`]*`|\b(" + "|".join(sorted(_SPELLED, key=len, reverse=True)) + r")\b")


def unit_sign(unit: str) -> str:
    """Unit as a reader knows it; the unit itself where it has no other sign.

    Examples
    --------
    >>> unit_sign("deg/sqrt(h)"), unit_sign("ug"), unit_sign("m/s"), unit_sign("1")
    ('°/√h', 'µg', 'm/s', '')
    """
    return _UNITS.get(unit, unit)


def with_unit(value: str, unit: str) -> str:
    """Number and unit in a sentence: no space before the signs of an angle.

    Examples
    --------
    >>> with_unit("32.1", "deg"), with_unit("5", "ug"), with_unit("2", "")
    ('32.1°', '5 µg', '2')
    """
    sign = unit_sign(unit)
    return value + sign if sign in ("°", '"') else f"{value} {sign}".rstrip()


def symbol(name: str) -> str:
    """Symbol of a network's parameter from its key; the key in words for what has no symbol.

    Examples
    --------
    >>> symbol("xi"), symbol("k1"), symbol("duration_h")
    ('ζ', 'K₁', 'duration h')
    """
    return _SYMBOLS.get(name, name.replace("_", " "))


def in_symbols(text: str) -> str:
    """Prose in which parameters have their symbols; what stands in backticks is a key and stays.

    Examples
    --------
    >>> in_symbols("sigma = 0.0088, xi = 0.7 at 10 omega_s: `network.xi`")
    'σ = 0.0088, ζ = 0.7 at 10 ωₛ: `network.xi`'
    """
    return _WORDS.sub(lambda match: _SPELLED.get(match[1], match[0]), text)
