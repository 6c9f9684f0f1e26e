"""TOML as people write it: numbers and quotation marks that TOML cannot read, with what to write for them.

A number with a decimal comma, a minus sign copied from a plot, quotation marks of a word processor: the fault
names the field, what stands there and how TOML writes it. On the command line they are understood.
"""

import re
import tomllib
import unicodedata
from typing import Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import MINUS, NO_NUMBER, NotANumber, plain_number, read_number
from navcore.foundation.text import Text

_COMMA = r"(?<![\d.])[+-]?\d+,\d+(?![\d.])"
_NUMBER = re.compile(_COMMA)
_GIVEN = re.compile(rf"([\w-]+)\s*=\s*(?:({_COMMA})|\[[^#\]]*?((?<![\d.])[+-]?\d+,0\d*[1-9]))")
"""A field and its value; in a list only what is no two numbers of TOML, which have no leading zero."""
_LINE = re.compile(r"at line (\d+)")
_FIELD = re.compile(r"\s*([\w.-]+)\s*=\s*(.*\S)\s*")
_ELEMENT = re.compile(r"[^\s,\[\]{}=][^,\[\]{}=]*")
_QUOTES = dict.fromkeys("“”„‟«»″＂", '"') | dict.fromkeys("‘’‚‛", "'")
_SIGNS = (
    _QUOTES
    | dict.fromkeys(MINUS, "-")
    | dict.fromkeys("\u00a0\u2007\u2009\u200a\u202f\u3000", " ")
    | dict.fromkeys("\u200b\u2060\ufeff\u200e\u200f", "")
    | {"，": ",", "＝": "=", "［": "[", "］": "]", "｛": "{", "｝": "}", "＃": "#"}
)
"""Signs that word processors, plots and web pages put in the place of TOML's own."""


def number_refused(value: object) -> str:
    """Say how a text that is given for a number is written as one; empty for what is no number at all.

    Examples
    --------
    >>> number_refused("1,5"), number_refused("half")
    ('must be a number with a decimal point, 1.5, not with a decimal comma', '')
    >>> number_refused("−0.02")
    'must be a number (write -0.02 without quotation marks)'
    """
    if not isinstance(value, str):
        return ""
    if _NUMBER.fullmatch(value.strip()):
        return _comma_refused(value, 0)
    try:
        return Text("must be a number (write {plain} without quotation marks)", plain=_toml_number(value))
    except NotANumber as error:
        return "" if error.allowed == NO_NUMBER else error.allowed


def read_toml_text(text: str, where: str) -> dict[str, Any]:
    """Parse TOML text.

    Parameters
    ----------
    text : str
        TOML.
    where : str
        Place named in the faults.

    Raises
    ------
    InputError
        Names the field, what stands there, the line and what TOML wants in its place, where that is known.
    ValueError
        What TOML's reader says of everything else.
    """
    try:
        return tomllib.loads(text, parse_float=read_toml_float)
    except NotANumber as error:
        lines = enumerate(text.split("\n"), 1)
        number, line = next((n, line) for n, line in lines if error.text in _code(line))
        field = _FIELD.fullmatch(_code(line))
        allowed = Text("{allowed} (line {line})", allowed=error.allowed, line=number)
        raise InputError(Fault(where, field[1] if field else "", error.text, allowed)) from None
    except ValueError as error:
        _refuse(text, str(error), where)
        raise


def read_toml_float(text: str) -> float:
    """Read a number of TOML; raises `NotANumber` where a double would make 0 or infinity of it."""
    return float(text) if text.lstrip("+-") in ("inf", "nan") else read_number(text)


def read_value(text: str) -> Any:
    """Read a value from the command line: as TOML, else as a number, else as TOML once its signs are TOML's.

    Returns
    -------
    object
        The text itself where it is none of these.

    Examples
    --------
    >>> read_value("[0.01, −0.02]"), read_value("0,5"), read_value("“compass”"), read_value("compass")
    ([0.01, -0.02], 0.5, 'compass', 'compass')
    """
    for written in (lambda: text, lambda: _toml_number(text), lambda: mended(text)):
        try:
            return tomllib.loads(f"value = {written()}", parse_float=read_toml_float)["value"]
        except ValueError:
            continue
    return text


def mended(line: str) -> str:
    """Return a line with TOML's own signs, outside of its texts, for those of word processors and plots.

    Examples
    --------
    >>> mended("a = [−1, 2]  # −"), mended("b = “the − sign”"), mended("c = '−'")
    ('a = [-1, 2]  # −', 'b = "the − sign"', "c = '−'")
    """
    out, inside = [], ""
    for sign in line:
        plain = _SIGNS.get(sign, sign)
        if inside:
            ends = sign == inside or (inside in _QUOTES and plain == _QUOTES[inside])
            out.append(_QUOTES.get(inside, inside) if ends else sign)
            inside = "" if ends else inside
        elif sign == "#":
            return "".join(out) + line[len(out) :]
        else:
            inside = sign if plain in ('"', "'") else ""
            out.append(plain)
    if inside and (closing := [at for at, sign in enumerate(out) if _QUOTES.get(sign) == inside]):
        out[closing[-1]] = inside  # a text that begins with TOML's sign and ends with another
    return "".join(out)


def _toml_number(text: str) -> str:
    """Write a number as TOML does; raises `NotANumber`."""
    plain = plain_number(text)
    value = read_number(text)
    try:
        tomllib.loads(f"value = {plain}")
    except tomllib.TOMLDecodeError:  # a point without a digit beside it, a zero before the number
        return repr(value)
    return plain


def _comma_refused(value: str, line: int) -> str:
    point = value.strip().replace(",", ".")
    try:
        read_number(value)
    except NotANumber as error:
        return (
            error.allowed if not line else Text("{allowed} (line {line})", allowed=error.allowed, line=line)
        )
    if line:
        return Text(
            "must be a number with a decimal point, {point}, not with a decimal comma (line {line})",
            point=point,
            line=line,
        )
    return Text("must be a number with a decimal point, {point}, not with a decimal comma", point=point)


def _refuse(text: str, reason: str, where: str) -> None:
    """Refuse text whose faulty line holds a number, or signs, that are not as TOML writes them."""
    lines = text.rstrip().split("\n")
    named = _LINE.search(reason)
    number = int(named[1]) if named else len(lines)
    if number > len(lines):
        return
    line = lines[number - 1]
    if match := _GIVEN.search(_code(line)):
        value = match[2] or match[3]
        raise InputError(
            Fault(where, match[1], value, _comma_refused(value, number if named else 0))
        ) from None
    code = _code(line)
    right = _right(mended(code)) or _right(code)
    sign = next((each for each in code if each in _SIGNS), "")
    if right == code or (right is None and not sign):
        return
    field = _FIELD.fullmatch(code)
    value, shown = (field[2], (right or "").partition("=")[2]) if field else (code, right or "")
    parts = [Text("must be written {right}", right=shown.strip())] if right else []
    if sign:
        name = unicodedata.name(sign, "").lower()
        told = Text(
            "{sign} (U+{code}, {name}) is no sign of TOML", sign=sign, code=f"{ord(sign):04X}", name=name
        )
        parts.append(told)
    allowed = Text("{told} (line {line})", told=Text.joined(": ", parts), line=number)
    raise InputError(Fault(where, field[1] if field else "", value.strip(), allowed)) from None


def _code(line: str) -> str:
    """Return a line without its comment."""
    inside = ""
    for at, sign in enumerate(line):
        if inside:
            inside = "" if sign == inside else inside
        elif sign == "#":
            return line[:at]
        elif sign in "\"'":
            inside = sign
    return line


def _right(line: str) -> str | None:
    """Return a line that TOML reads, from one whose numbers it may not read; None where there is none."""
    key, equals, value = line.partition("=")
    tries = [line, f"{key}{equals} {_as_toml(value.strip())}"]
    if not re.search(r"\d,\d", line):  # which may be a decimal comma
        tries.append(_ELEMENT.sub(lambda found: _as_toml(found[0]), line))
    for right in tries:
        for whole in (right, f"value = [{right}]"):  # a part of a list that goes over several lines
            try:
                tomllib.loads(whole)
            except ValueError:
                continue
            return right
    return None


def _as_toml(text: str) -> str:
    """Return a number as TOML writes it, and everything else as it is."""
    try:
        return text if text[:1] in ('"', "'") else _toml_number(text)
    except NotANumber:
        return text
