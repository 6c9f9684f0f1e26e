"""The one reader of numbers that people type, paste or copy: all of it is understood, or it is refused.

It takes either decimal sign, digits in groups of three, every minus sign and every form of exponent.

- A point is the decimal point: ``1.234`` is 1.234, as this program writes it.
- A comma is the decimal comma (``0,02``), except where only groups fit (``1,234,567`` and ``1,234.5``). One
  comma before exactly three digits can be either, and ``1,234`` is refused.
- No-break and thin spaces and apostrophes group the digits (``1'234.5``); underscores stand between them, as
  in TOML. A plain blank groups nothing: it separates two numbers.
- An exponent is ``1e-3``, ``1·10^-3``, ``1 × 10⁻³`` or ``10⁻³``.
- Digits of other scripts are digits, and quotation marks around the whole are left out.
"""

import math
import re
import unicodedata

from navcore.foundation.text import Text

QUOTES = ('""', "''", "“”", "„“", "„”", "””", "‘’", "‚‘", "‚’", "’’", "«»", "»«", "‹›", "›‹", "「」", "＂＂")
"""Quotation marks as they stand around a text, of several languages."""
MINUS = "\u2212\u2013\u2010\u2011\u2012\ufe63\uff0d"
"""Signs that stand for a minus: the minus sign, the en dash of word processors, hyphens, full width."""
_INVISIBLE = "\u200b\u2060\ufeff\u200e\u200f\u061c\u2066\u2067\u2068\u2069\u202a\u202b\u202c"
_GROUPS = "\u00a0\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f'’\u066c"
_GROUP = "'"
_SUPERSCRIPT = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-", strict=True))
_SEEN = str.maketrans(dict.fromkeys(_INVISIBLE, ""))
_PLAIN = str.maketrans(
    dict.fromkeys(MINUS, "-")
    | dict.fromkeys(_GROUPS, _GROUP)
    | dict.fromkeys("\uff0b\ufe62", "+")
    | dict.fromkeys("\uff0e\u066b", ".")
    | {"\uff0c": ",", "\uff45": "e", "\uff25": "e", "\uff3f": "_", "\u3000": " ", "\t": " "}
)
_BLANK = f"[ {_GROUP}]*"
_SMALL = "".join(_SUPERSCRIPT)
_POWER = rf"10(?:(?P<small>[{_SMALL}]+)|(?:\^|\*\*)[({{]?(?P<raised>[-+]?\d+)[)}}]?)"
_FORM = re.compile(
    rf"(?P<sign>[-+]?)(?:(?P<digits>[\d.,_{_GROUP}]+?)"
    rf"(?:[eE](?P<exponent>[-+]?\d+)|{_BLANK}[·⋅∙×✕*xX]{_BLANK}{_POWER})?"
    rf"|{_POWER.replace('small', 'alone').replace('raised', 'lonely')})",
    re.ASCII,
)
_WHOLE = re.compile(r"[-+]?\d+")
_EXACT = 2.0**53
_LONGEST = 1000
NO_NUMBER = Text("must be a number, such as -0.02, 1e-3 or 0,02")
_FINITE = Text("must be a finite number")


class NotANumber(ValueError):
    """A text that is no number, or not one number alone.

    Parameters
    ----------
    text : str
        As it was given.
    allowed : str
        What is wrong with it, as in a `Fault`.

    Attributes
    ----------
    text, allowed : str
        The same.
    """

    def __init__(self, text: str, allowed: str) -> None:
        self.text, self.allowed = text, allowed
        super().__init__(Text("{text!r} {allowed}", text=text, allowed=allowed))


def read_number(text: str, decimal: str = "") -> float:
    """Read one number, however it is written.

    Parameters
    ----------
    text : str
        The number alone; blanks around it do not count.
    decimal : {"", ".", ","}
        Decimal sign, where it is known: ``1,234`` is 1.234 with a comma, and 1234 with a point.

    Returns
    -------
    float

    Raises
    ------
    NotANumber
        A `ValueError` whose message quotes the text: it is no number, may be either of two, holds more than a
        number, or is infinite or too small for a double.

    Examples
    --------
    >>> [read_number(text) for text in ("-0.02", "−0,02", "2E-4", "1·10^-3", "1×10⁻³", "1.234,5", "1'234.5")]
    [-0.02, -0.02, 0.0002, 0.001, 0.001, 1234.5, 1234.5]
    >>> read_number("1,234")
    Traceback (most recent call last):
        ...
    navcore.foundation.numbers.NotANumber: '1,234' may mean 1.234 or 1234: write one of these
    """
    plain = plain_number(text, decimal)
    value = float(plain)
    if math.isinf(value):
        raise NotANumber(text, _FINITE)
    if value == 0.0 and re.search("[1-9]", plain.partition("e")[0]):
        raise NotANumber(
            text, Text("must be a number that is not too small for the computer: it would become 0")
        )
    return value


def read_whole(text: str) -> int:
    """Read one whole number, to its last digit; raises `NotANumber`.

    Examples
    --------
    >>> read_whole("12"), read_whole("1e3"), read_whole("9007199254740993")
    (12, 1000, 9007199254740993)
    """
    plain = plain_number(text)
    if _WHOLE.fullmatch(plain):
        return int(plain)
    value = read_number(text)
    if value != math.floor(value) or abs(value) > _EXACT:
        raise NotANumber(text, Text("must be a whole number"))
    return int(value)


def plain_number(text: str, decimal: str = "") -> str:
    """Write a number as Python and TOML read it: a point, a hyphen and ``e``; raises `NotANumber`.

    The parameters are those of `read_number`.

    Examples
    --------
    >>> plain_number("−1 234,5 · 10⁻³".replace(" ", chr(0x202F), 1))
    '-1234.5e-3'
    """
    if len(text) > _LONGEST:
        raise NotANumber(text, NO_NUMBER)
    bare = unquoted(text.translate(_SEEN).strip()).strip().translate(_PLAIN)
    if re.fullmatch(r"(?i)[-+]?(inf(inity)?|nan|∞)", bare):
        raise NotANumber(text, _FINITE)
    ascii_only = "".join(str(unicodedata.decimal(sign, sign)) for sign in bare)
    match = _FORM.fullmatch(ascii_only)
    if match is None:
        raise NotANumber(text, NO_NUMBER)
    digits = match["digits"]
    small = match["small"] or match["alone"]
    power = match["exponent"] or match["raised"] or match["lonely"]
    if small is not None:
        power = "".join(_SUPERSCRIPT[sign] for sign in small)
        if not re.fullmatch(r"[-+]?\d+", power):
            raise NotANumber(text, NO_NUMBER)
    mantissa = "1" if digits is None else _mantissa(digits, text, decimal)
    return f"{match['sign']}{mantissa}" + (f"e{power}" if power else "")


def unquoted(text: str) -> str:
    """Leave out the quotation marks around a text, straight or typographic ones.

    Examples
    --------
    >>> unquoted("„0.02“"), unquoted('"0.02"'), unquoted('0.02"')
    ('0.02', '0.02', '0.02"')
    """
    return text[1:-1] if len(text) > 1 and text[0] + text[-1] in QUOTES else text


def _mantissa(digits: str, text: str, decimal: str) -> str:
    """Return digits with a point, if need be, from digits with either sign and with groups."""
    digits = re.sub(r"(?<=\d)_(?=\d)", "", digits)
    grouped = _GROUP in digits
    if grouped:
        digits = _ungrouped(digits, text)
    found = [sign for sign in ".," if sign in digits]
    if len(found) == 2:
        sign = max(found, key=digits.rfind)
        digits = _parted(digits, sign, ".,".replace(sign, ""), text, decimal)
    elif found and digits.count(found[0]) > 1:
        digits = _joined(digits, found[0], text)
    elif found:
        whole, _, rest = digits.partition(found[0])
        either = len(rest) == 3 and re.fullmatch(r"[1-9]\d{0,2}", whole) and not grouped
        if either and found[0] != (decimal or "."):
            if decimal == ".":
                return f"{whole}{rest}"
            both = {"point": f"{whole}.{rest}", "whole": f"{whole}{rest}"}
            raise NotANumber(text, Text("may mean {point} or {whole}: write one of these", **both))
        digits = f"{whole}.{rest}" if rest or found[0] == "." else ""
    if not re.fullmatch(r"\d++\.?\d*|\.\d+", digits):
        raise NotANumber(text, NO_NUMBER)
    return digits


def _parted(digits: str, sign: str, other: str, text: str, decimal: str) -> str:
    """Return digits with a point, of a number with both signs; the last is its decimal sign."""
    whole, _, rest = digits.partition(sign)
    if (decimal and sign != decimal) or other in rest:
        raise NotANumber(text, NO_NUMBER)
    return f"{_joined(whole, other, text)}.{rest}"


def _joined(digits: str, sign: str, text: str) -> str:
    """Return digits without the sign between their groups of three."""
    if not re.fullmatch(rf"[1-9]\d{{0,2}}(?:{re.escape(sign)}\d{{3}})+", digits):
        raise NotANumber(text, NO_NUMBER)
    return digits.replace(sign, "")


def _ungrouped(digits: str, text: str) -> str:
    """Return digits without the spaces between groups of three, before and behind the decimal sign."""
    whole, point, rest = re.fullmatch(r"([^.,]*)([.,]?)(.*)", digits).groups()  # pyright: ignore[reportOptionalMemberAccess]
    if _GROUP in whole:
        whole = _joined(whole, _GROUP, text)
    if not re.fullmatch(rf"\d*|\d{{3}}(?:{_GROUP}\d{{3}})*(?:{_GROUP}\d{{1,3}})?", rest):
        raise NotANumber(text, NO_NUMBER)
    rest = rest.replace(_GROUP, "")
    # A space has grouped the digits, so that the comma does not.
    return f"{whole}.{rest}" if point else whole
