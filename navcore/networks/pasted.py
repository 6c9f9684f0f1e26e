"""A network from text that another program or a paper gives.

``tf([...], [...])``, ``zpk([...], [...], k)``, a fraction in LaTeX or in plain signs, a MATLAB file with
``num`` and ``den``, a table that ``schuler export --as table`` has written: each becomes a `custom` network.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

LARGEST_BYTES = 1_000_000
_SPHERE_OMEGA_S = 1.24e-3
"""Schuler frequency of a sphere, rad/s, for the judgement of a loop (theory.md 3.6)."""
_FAST_RAD_S = 0.3
"""Mean size of zeros and poles from which a network is none in rad/s."""
_CALL = re.compile(r"\b(tf|zpk)\s*\((.*)", re.DOTALL)
"""A call without its closing bracket."""
_LIST = re.compile(r"\[([^\[\]]*)\]")
_POWER_OF_TEN = re.compile(r"(\d\.?)\s*(?:\\times|\\cdot|×|·|\*)\s*10\s*\^\s*\{?\s*([-−+]?\d+)\s*\}?")
"""From the last digit of the factor on: its start cannot be found in linear time."""
_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)|(?P<frac>\\[dt]?frac)|(?P<s>s)|"
    r"(?P<sign>\\times|\\cdot|[-+*/^(){}×·]))"
)
_ASSIGNED = r"^\s*{name}\s*=\s*\[([^\]]*)\]"


class _Ratio(NamedTuple):
    """Numerator and denominator, descending powers of s."""

    num: np.ndarray
    den: np.ndarray


def is_pasted(text: str) -> bool:
    """Whether a text is meant as a transfer function, or names a file that holds one."""
    return bool(
        re.search(r"\b(tf|zpk)\s*\(|\\[dt]?frac|[)\d}s]\s*/\s*[(\d{s]", text)
        or re.search(r"\.(m|toml)\s*$", text.strip())
    )


def pasted(text: str, where: str = "network") -> dict[str, Any]:
    r"""Return the block of the `custom` network that a text stands for.

    Parameters
    ----------
    text : str
        The transfer function H(s), s in rad/s, or the path of a file.
    where : str
        Place named in the faults.

    Raises
    ------
    InputError
        It cannot be read, is improper or unstable, or is in other units of s; each with the remedy.

    Examples
    --------
    >>> pasted(r"H(s) = \frac{203.5 s + 0.9045}{s + 2.64 \times 10^{-2}}")["den"]
    [1.0, 0.0264]
    """
    path = text.strip()
    try:
        ratio = _of_file(Path(path)) if re.search(r"\.(m|toml)$", path) else _of_text(text)
    except _UnreadableError as error:
        raise InputError(Fault(where, "", text.strip()[:120], error.reason)) from None
    num, den = np.trim_zeros(ratio.num, "f"), np.trim_zeros(ratio.den, "f")
    if reason := _refused(num, den):
        raise InputError(Fault(where, "", text.strip()[:120], reason))
    return {"id": "custom", "num": num.tolist(), "den": den.tolist()}


class _UnreadableError(Exception):
    """A text that is no transfer function."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


def _refused(num: np.ndarray, den: np.ndarray) -> str:
    """Say what is wrong with a transfer function; empty where nothing is."""
    if not len(num) or not len(den):
        return Text("must have a numerator and a denominator that are not 0")
    if len(num) > len(den):
        return Text(
            "is improper: {zeros} zeros and {poles} poles; H(s) must have no more zeros than poles",
            zeros=len(num) - 1,
            poles=len(den) - 1,
        )
    poles, zeros = np.roots(den), np.roots(num)
    sizes = np.abs(np.concatenate([poles, zeros]))
    sizes = sizes[sizes > 0.0]
    mean = float(np.exp(np.mean(np.log(sizes)))) if len(sizes) else 0.0
    if mean > _FAST_RAD_S:
        return Text(
            "has zeros and poles of {size:.3g} rad/s on average, so its s is in other units: put s/0.00124 "
            "in the place of an s in units of ωₛ, 60 s of one per minute, 3600 s of one per hour",
            size=mean,
        )
    if np.any(poles.real > 0.0):
        return Text(
            "is unstable: a pole at {pole:.4g} rad/s lies in the right half plane; look for a wrong sign",
            pole=float(np.max(poles.real)),
        )
    scale = _SPHERE_OMEGA_S ** np.arange(len(den) - 1, -1, -1)
    loop = np.roots(np.polyadd(np.append(den * scale, [0.0, 0.0]), num * scale[len(den) - len(num) :]))
    if np.max(loop.real) > 1e-9 * np.max(np.abs(loop)):
        return Text(
            "makes the loop s² + ωₛ² H unstable (it grows with {rate:.3g} 1/s): H must be the network "
            "itself, not 1 - H, with s in rad/s",
            rate=float(np.max(loop.real)) * _SPHERE_OMEGA_S,
        )
    return ""


# ---------------------------------------------------------------- files


def _of_file(path: Path) -> _Ratio:
    try:
        if path.stat().st_size > LARGEST_BYTES:
            raise _UnreadableError(Text("is larger than {bytes} bytes: no network", bytes=LARGEST_BYTES))
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise _UnreadableError(Text("cannot be read: {error}", error=error)) from None
    if path.suffix == ".m":
        return _of_matlab(text)
    try:
        network = tomllib.loads(text)["network"]
        return _Ratio(np.array(network["num"], dtype=float), np.array(network["den"], dtype=float))
    except (tomllib.TOMLDecodeError, KeyError, TypeError, ValueError):
        raise _UnreadableError(Text("must be a table with network.num and network.den")) from None


def _of_matlab(text: str) -> _Ratio:
    """The lists num and den of a MATLAB file, or the first tf or zpk with lists in it."""
    lines = "\n".join(line.partition("%")[0] for line in text.splitlines())
    found = [re.search(_ASSIGNED.format(name=name), lines, re.MULTILINE) for name in ("num", "den")]
    if all(found):
        num, den = (_numbers(one[1]) for one in found if one)
        return _Ratio(num.real, den.real)
    for line in lines.splitlines():
        if (call := _call_at_end_of(line)) and len(_LIST.findall(call[2])) >= 2:
            return _of_call(call[1], call[2])
    raise _UnreadableError(Text("must hold num = [...]; den = [...]; or tf([...], [...])"))


# ---------------------------------------------------------------- text


def _of_text(text: str) -> _Ratio:
    plain = text.strip().rstrip(";").strip()
    if call := _call_at_end_of(plain):
        return _of_call(call[1], call[2])
    plain = re.sub(r"^[A-Za-z_]\w*\s*(\(\s*s\s*\))?\s*=", "", plain).strip("$ \n")
    plain = plain.replace("\\left", "").replace("\\right", "").replace("\\,", " ").replace("−", "-")
    plain = plain.replace("\\;", " ").replace("\\!", "")
    plain = _POWER_OF_TEN.sub(r"\1e\2", plain)
    return _Parser(plain).whole()


def _call_at_end_of(text: str) -> re.Match[str] | None:
    """A call of tf or zpk that the text ends with: kind, and what is between its brackets."""
    plain = text.strip().rstrip(";").rstrip()
    return _CALL.search(plain[:-1]) if plain.endswith(")") else None


def _of_call(kind: str, inside: str) -> _Ratio:
    """``tf(num, den)`` or ``zpk(zeros, poles, gain)``."""
    lists = [_numbers(one) for one in _LIST.findall(inside)]
    rest = [one for one in re.sub(r"\[[^\[\]]*\]", "", inside).replace(",", " ").split() if one]
    if kind == "tf" and len(lists) == 2:
        if rest and rest[0] not in ("'s'", '"s"'):
            raise _UnreadableError(
                Text(
                    "is in discrete time (sample time {step}): give the continuous transfer function, d2c(H)",
                    step=rest[0],
                )
            )
        return _Ratio(lists[0].real, lists[1].real)
    if kind == "zpk" and len(lists) == 2 and len(rest) == 1:
        gain = _numbers(rest[0])[0].real
        return _Ratio(gain * _polynomial(lists[0]), _polynomial(lists[1]))
    example = "tf([203.5, 0.9045], [1, 0.0264])" if kind == "tf" else "zpk([-0.0044], [-0.0264], 203.5)"
    raise _UnreadableError(Text("must have the form {example}", example=example))


def _polynomial(roots: Any) -> np.ndarray:
    found: Any = np.atleast_1d(np.poly(roots))
    if np.max(np.abs(found.imag), initial=0.0) > 1e-9 * np.max(np.abs(found)):
        raise _UnreadableError(Text("has complex zeros or poles without their conjugates"))
    return found.real


def _numbers(text: str) -> Any:
    """Numbers of a list, separated by commas, semicolons or blanks; complex ones with i or j."""
    words = re.split(r"[,;\s]+", text.strip()) if text.strip() else []
    try:
        return np.array([complex(word.replace("i", "j").replace("*", "")) for word in words], dtype=complex)
    except ValueError:
        raise _UnreadableError(Text('"{text}" is no list of numbers', text=text.strip()[:60])) from None


class _Parser:
    """Reads a rational expression in s: numbers, powers, products without a sign, brackets, fractions."""

    def __init__(self, text: str) -> None:
        self._tokens: list[tuple[str, str]] = []
        at = 0
        while at < len(text.rstrip()):
            match = _TOKEN.match(text, at)
            if match is None:
                raise _UnreadableError(
                    Text(
                        "cannot be read from {rest} on: write it with numbers, s, powers and brackets",
                        rest=f'"{text[at : at + 20].strip()}"',
                    )
                )
            kind = match.lastgroup or ""
            self._tokens.append((kind, match[kind]))
            at = match.end()
        self._place = 0

    def whole(self) -> _Ratio:
        """Read all of it."""
        found = self._sum()
        if self._place < len(self._tokens):
            raise self._unreadable()
        return found

    def _unreadable(self) -> _UnreadableError:
        left = "".join(text for _, text in self._tokens[self._place : self._place + 6]) or "the end"
        return _UnreadableError(Text('is no transfer function: "{left}" is not expected there', left=left))

    def _next(self, *texts: str) -> bool:
        """Whether one of these signs comes next; it is taken."""
        if self._place < len(self._tokens) and self._tokens[self._place][1] in texts:
            self._place += 1
            return True
        return False

    def _sum(self) -> _Ratio:
        total = self._product()
        while self._place < len(self._tokens):
            sign = 1.0 if self._next("+") else -1.0 if self._next("-") else 0.0
            if not sign:
                break
            other = self._product()
            num = np.polyadd(np.polymul(total.num, other.den), sign * np.polymul(other.num, total.den))
            total = _Ratio(num, np.polymul(total.den, other.den))
        return total

    def _product(self) -> _Ratio:
        total = self._factor()
        while self._place < len(self._tokens):
            if self._next("/"):
                other = self._factor()
                total = _Ratio(np.polymul(total.num, other.den), np.polymul(total.den, other.num))
                continue
            times = self._next("*", "\\times", "\\cdot", "×", "·")
            kind, text = self._tokens[self._place] if self._place < len(self._tokens) else ("", "")
            if not times and not (kind in ("number", "frac", "s") or text in ("(", "{")):
                break
            other = self._factor()
            total = _Ratio(np.polymul(total.num, other.num), np.polymul(total.den, other.den))
        return total

    def _factor(self) -> _Ratio:
        if self._next("-"):
            found = self._factor()
            return _Ratio(-found.num, found.den)
        if self._next("+"):
            return self._factor()
        base = self._base()
        if not self._next("^"):
            return base
        braces = self._next("{")
        sign = -1 if self._next("-") else 1
        kind, text = self._tokens[self._place] if self._place < len(self._tokens) else ("", "")
        if kind != "number" or not text.isdigit() or int(text) > 16:
            raise self._unreadable()
        self._place += 1
        if braces and not self._next("}"):
            raise self._unreadable()
        num, den = (base.num, base.den) if sign > 0 else (base.den, base.num)
        power = _Ratio(np.ones(1), np.ones(1))
        for _ in range(int(text)):
            power = _Ratio(np.polymul(power.num, num), np.polymul(power.den, den))
        return power

    def _base(self) -> _Ratio:
        if self._place >= len(self._tokens):
            raise self._unreadable()
        kind, text = self._tokens[self._place]
        self._place += 1
        if kind == "number":
            return _Ratio(np.array([float(text)]), np.ones(1))
        if kind == "s":
            return _Ratio(np.array([1.0, 0.0]), np.ones(1))
        if kind == "frac":
            over, under = self._braced(), self._braced()
            return _Ratio(np.polymul(over.num, under.den), np.polymul(over.den, under.num))
        if text in ("(", "{"):
            found = self._sum()
            if not self._next(")" if text == "(" else "}"):
                raise self._unreadable()
            return found
        self._place -= 1
        raise self._unreadable()

    def _braced(self) -> _Ratio:
        if not self._next("{"):
            raise self._unreadable()
        found = self._sum()
        if not self._next("}"):
            raise self._unreadable()
        return found
