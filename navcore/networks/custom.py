"""A network of the user's own: zeros, poles and gain, or numerator and denominator."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, model_validator

from navcore.foundation.errors import InputError
from navcore.foundation.parameters import bounded, given, quantity
from navcore.foundation.text import Text
from navcore.networks.base import (
    MAX_ORDER,
    LinearNetwork,
    NetworkParameters,
    linear_network,
    refuse,
)
from navcore.networks.roots import fixed

_CONJUGATE_TOLERANCE = 1e-6
_LARGEST_RATE = 1e4
_ROOTS, _POLYNOMIALS = ("zeros", "poles", "gain"), ("num", "den")


def _as_pair(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else (value, 0.0)


def _as_tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


_Part = Annotated[float, bounded(unit="rad/s", ge=-_LARGEST_RATE, le=_LARGEST_RATE)]
_Root = Annotated[
    tuple[_Part, _Part], BeforeValidator(lambda value: value if isinstance(value, tuple) else _as_pair(value))
]
_Roots = Annotated[tuple[_Root, ...], BeforeValidator(_as_tuple)]
_Coefficient = Annotated[float, bounded(ge=-1e30, le=1e30)]
_Coefficients = Annotated[tuple[_Coefficient, ...], BeforeValidator(_as_tuple)]


class CustomNetwork(NetworkParameters):
    """Any proper network of up to eight poles; with nothing given, the zeros and poles of `classic2`.

    A complex zero or pole is a pair [re, im] and comes with its conjugate; a real one is a number.
    """

    title: ClassVar[str] = Text("Custom")
    source: ClassVar[str] = "theory.md 3"
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (_ROOTS, _POLYNOMIALS)
    no_handle: ClassVar[str] = Text("its zeros and poles are given one by one")
    id: Literal["custom"] = "custom"
    zeros: _Roots | None = quantity(
        None,
        unit="rad/s",
        label=Text("zeros"),
        help=Text("Zeros of H(s), each a number or [re, im]; none when left out."),
    )
    poles: _Roots | None = quantity(
        None,
        unit="rad/s",
        label=Text("poles"),
        help=Text("Poles of H(s), each a number or [re, im]; none when left out."),
    )
    gain: float | None = quantity(
        None,
        ge=-1e12,
        le=1e12,
        label=Text("gain"),
        help=Text("Leading coefficient of the numerator; 1 when left out."),
    )
    num: _Coefficients | None = quantity(
        None,
        label=Text("numerator"),
        help=Text("Coefficients of N(s) in descending powers of s (rad/s), with den."),
    )
    den: _Coefficients | None = quantity(
        None,
        label=Text("denominator"),
        help=Text("Coefficients of D(s) in descending powers of s (rad/s), with num."),
    )

    @model_validator(mode="before")
    @classmethod
    def _one_way_only(cls, data: Any) -> Any:
        roots, polynomials = given(data, _ROOTS), given(data, _POLYNOMIALS)
        if roots and polynomials:
            allowed = Text("must not be given together with {roots}", roots=", ".join(roots))
            raise refuse(polynomials[0], data[polynomials[0]], allowed)
        if len(polynomials) == 1:
            other = "den" if polynomials[0] == "num" else "num"
            raise refuse(
                polynomials[0], data[polynomials[0]], Text("needs {other} too: give both", other=other)
            )
        if not isinstance(data, dict) or polynomials:
            return data
        if roots:
            return {
                **{"zeros": [], "poles": [], "gain": 1.0},
                **{k: v for k, v in data.items() if v is not None},
            }
        return {**data, "zeros": [-8.5e-4, -9.412e-2], "poles": [-8.0e-3, -1.0e-2], "gain": 1.0}

    @model_validator(mode="after")
    def _proper(self) -> CustomNetwork:
        if self.num is not None and self.den is not None:
            self._check_polynomials(self.num, self.den)
            return self
        _conjugate("zeros", self.zeros or ())
        _conjugate("poles", self.poles or ())
        _check_degrees("zeros", self.zeros, len(self.zeros or ()), "poles", self.poles, len(self.poles or ()))
        if self.gain == 0.0:
            raise refuse("gain", self.gain, Text("must not be 0: H would be zero"))
        return self

    @staticmethod
    def _check_polynomials(num: tuple[float, ...], den: tuple[float, ...]) -> None:
        for name, coefficients in (("num", num), ("den", den)):
            if not any(coefficients):
                raise refuse(name, list(coefficients), Text("must have a coefficient that is not 0"))
        degrees = [len(np.trim_zeros(np.array(c), "f")) - 1 for c in (num, den)]
        _check_degrees("num", num, degrees[0], "den", den, degrees[1])

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) as entered, for a Schuler frequency in rad/s.

        Raises
        ------
        InputError
            A coefficient is out of all proportion to omega_s.
        """
        if self.num is not None and self.den is not None:
            network = self._from_polynomials(np.array(self.num), np.array(self.den), omega_s)
        else:
            network = self._from_roots(omega_s)
        if not all(np.all(np.isfinite(c)) for c in (network.num_p, network.den_p, network.num, network.den)):
            raise refuse(
                "num" if self.num else "gain", None, Text("H(s) overflows: coefficients too far apart")
            )
        return network

    def following(self, network: LinearNetwork) -> dict[str, Any]:
        """Return zeros, poles and gain, and the coefficients, of the network made."""
        roots = {"zeros": list(network.zeros), "poles": list(network.poles), "gain": network.gain}
        return roots | {"num": network.num.tolist(), "den": network.den.tolist()}

    def _from_roots(self, omega_s: float) -> LinearNetwork:
        zeros = np.array([complex(*root) for root in _conjugate("zeros", self.zeros or ())]) / omega_s
        poles = np.array([complex(*root) for root in _conjugate("poles", self.poles or ())]) / omega_s
        gain = (1.0 if self.gain is None else self.gain) * omega_s ** (len(zeros) - len(poles))
        num, den = gain * np.atleast_1d(np.real(np.poly(zeros))), np.atleast_1d(np.real(np.poly(poles)))
        return linear_network(
            "custom", omega_s, num, den, zeros_p=zeros, poles_p=poles, warnings=_own_stability(poles)
        )

    def _from_polynomials(self, num: np.ndarray, den: np.ndarray, omega_s: float) -> LinearNetwork:
        num, den = np.trim_zeros(num, "f"), np.trim_zeros(den, "f")
        degree = len(den) - 1
        with np.errstate(over="ignore", invalid="ignore"):
            den_p = den * omega_s ** np.arange(degree, -1, -1) / (den[0] * omega_s**degree)
            num_p = num * omega_s ** np.arange(len(num) - 1, -1, -1) / (den[0] * omega_s**degree)
        if not (np.all(np.isfinite(num_p)) and np.all(np.isfinite(den_p)) and num_p[0] != 0.0):
            raise refuse("den", list(den), Text("H(s) overflows: coefficients too far apart"))
        network = linear_network("custom", omega_s, num_p, den_p)
        if len(network.poles) and np.max(np.abs(network.poles)) > _LARGEST_RATE:
            raise refuse(
                "den",
                list(den),
                Text("must have poles of at most {largest_rate:g} rad/s", largest_rate=_LARGEST_RATE),
            )
        network = linear_network(
            "custom", omega_s, num_p, den_p, warnings=_own_stability(network.poles / omega_s)
        )
        if den[0] != 1.0 or len(den) != len(network.den):
            return network
        # as given, to the last digit: what is exported and read again is the same
        return replace(network, num=fixed(num), den=fixed(den), gain=float(num[0]))


def _check_degrees(
    upper: str, upper_value: object, zeros: int, lower: str, lower_value: object, poles: int
) -> None:
    if poles > MAX_ORDER:
        raise refuse(
            lower,
            lower_value,
            Text("must make at most {max_order} poles, here {poles}", max_order=MAX_ORDER, poles=poles),
        )
    if zeros > poles:
        allowed = Text(
            "must not make more zeros ({zeros}) than poles ({poles}): H(infinity) would be infinite",
            zeros=zeros,
            poles=poles,
        )
        raise refuse(upper, upper_value, allowed)


def _conjugate(name: str, roots: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
    """Return the roots with exact conjugates; raise where one is missing."""
    result = [root for root in roots if root[1] == 0.0]
    lower = [root for root in roots if root[1] < 0.0]
    for re, im in (root for root in roots if root[1] > 0.0):
        size = abs(complex(re, im))
        match = next(
            (r for r in lower if abs(complex(*r) - complex(re, -im)) <= _CONJUGATE_TOLERANCE * size), None
        )
        if match is None:
            raise _lonely(name, re, im)
        lower.remove(match)
        result += [(re, im), (re, -im)]
    if lower:
        raise _lonely(name, *lower[0])
    return result


def _lonely(name: str, re: float, im: float) -> InputError:
    return refuse(
        name,
        [[re, im]],
        Text("[{re:g}, {im:g}] must come with its conjugate [{re:g}, {im_2:g}]", re=re, im=im, im_2=-im),
    )


def _own_stability(poles_p: np.ndarray) -> tuple[str, ...]:
    if np.any(poles_p == 0.0):
        return (Text("the network has a pole at zero: it has no steady state for a constant input"),)
    if np.any(np.real(poles_p) >= 0.0):
        return (Text("the network itself is unstable"),)
    return ()
