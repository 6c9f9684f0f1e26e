"""Equations of a method with the numbers in force, as LaTeX and as plain text (theory.md 3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from navcore.engine.drivers.common import network_of
from navcore.foundation.text import Text
from navcore.law.combination import realisation_of
from navcore.networks.azimuth_loop import AzimuthGains
from navcore.networks.base import LinearNetwork
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario


class Equation(NamedTuple):
    """One equation.

    Attributes
    ----------
    about : str
        What it says.
    latex, text : str
        The equation; s in rad/s, SI units.
    """

    about: str
    latex: str
    text: str


def equations_of(scenario: Scenario, method: Method, digits: int | None = None) -> tuple[Equation, ...]:
    """Return the equations of a method's networks, as they act.

    Parameters
    ----------
    scenario : Scenario
        Gives the site.
    method : Method
        One of its methods.
    digits : int, optional
        Significant digits of the numbers; by default all, so that a transfer function that is read back
        (`navcore.networks.pasted`) has the same coefficients.

    Returns
    -------
    tuple of Equation
        Empty where no network acts.
    """
    if not method.kind.uses_network:
        return ()
    write = _Writer(digits)
    network = network_of(scenario, method)
    azimuth = method.kind.azimuth(method, network.omega_s)
    found = [*_level(write, method, network), *_loop(write, method.kind.acting(network))]
    if isinstance(azimuth, AzimuthGains):
        found += _gyrocompass(write, azimuth)
    elif azimuth is not None:
        found += _azimuth(write, azimuth, external=method.kind.uses_log)
    return tuple(found)


def as_latex(equations: tuple[Equation, ...]) -> str:
    """Write equations as a LaTeX environment of amsmath."""
    lines = " \\\\\n".join(one.latex for one in equations)
    return f"\\begin{{gather*}}\n{lines}\n\\end{{gather*}}\n"


def as_text(equations: tuple[Equation, ...]) -> str:
    """Write equations as plain text, one a line."""
    return "".join(f"{one.text}\n" for one in equations)


class _Writer:
    """Writes numbers and polynomials."""

    def __init__(self, digits: int | None) -> None:
        self._digits = digits

    def text(self, value: float) -> str:
        """A number as plain text."""
        written = repr(float(value)) if self._digits is None else f"{value:.{self._digits}g}"
        return written.removesuffix(".0")

    def latex(self, value: float) -> str:
        """A number as LaTeX."""
        factor, _, exponent = self.text(value).partition("e")
        return f"{factor} \\times 10^{{{int(exponent)}}}" if exponent else factor

    def both(self, template: str, plain: str, **values: float) -> tuple[str, str]:
        """Fill numbers into an equation as LaTeX, whose braces are < and >, and as text.

        A number that may be negative stands behind its own sign.
        """
        latex = template.format(**{name: self.latex(value) for name, value in values.items()})
        text = plain.format(**{name: self.text(value) for name, value in values.items()})
        for wrong, right in (("+-", "-"), ("--", "+"), ("+ -", "- "), ("- -", "+ ")):
            latex, text = latex.replace(wrong, right), text.replace(wrong, right)
        return latex.replace("<", "{").replace(">", "}"), text

    def fraction(self, num: np.ndarray, den: np.ndarray) -> tuple[str, str]:
        """num/den as LaTeX and as text."""
        if len(den) == 1 and den[0] == 1.0:
            return _polynomial(num, self.latex, "^{{{}}}"), _polynomial(num, self.text, "^{}")
        over, under = (_polynomial(one, self.latex, "^{{{}}}") for one in (num, den))
        plain = (_polynomial(one, self.text, "^{}") for one in (num, den))
        return f"\\frac{{{over}}}{{{under}}}", "({})/({})".format(*plain)


def _polynomial(coefficients: np.ndarray, number: Callable[[float], str], power: str) -> str:
    """Write a polynomial in s, descending powers."""
    written = ""
    for place, value in enumerate(coefficients):
        degree = len(coefficients) - 1 - place
        if value == 0.0 and (written or degree):
            continue
        of_s = "" if degree == 0 else "s" if degree == 1 else f"s{power.format(degree)}"
        size = "" if abs(value) == 1.0 and of_s else number(abs(value))
        sign = (" - " if value < 0.0 else " + ") if written else "-" if value < 0.0 else ""
        written += sign + " ".join(filter(None, (size, of_s)))
    return written or "0"


def _level(write: _Writer, method: Method, network: LinearNetwork) -> Iterator[Equation]:
    """The level channels: what forms the transport rate, and what is fed back into the velocity."""
    kind, parameters = method.kind, method.kind.network(method)
    latex, text = write.fraction(network.num, network.den)
    yield Equation(Text("Damping network"), f"H(s) = {latex}", f"H(s) = {text}")
    realisation = realisation_of(kind.law, parameters)
    gains = parameters.feedback_gains(network.omega_s) if realisation != "network" else None
    if gains is not None:
        yield from _velocity_feedback(write, gains, realisation)
    elif kind.uses_log:
        yield Equation(
            Text("Velocity of the transport rate"),
            r"V^{*} = V_c + \left[1 - H(s)\right] \left(V_r - V_c\right)",
            "V* = V_c + [1 - H(s)] (V_r - V_c)",
        )
    else:
        yield Equation(Text("Velocity of the transport rate"), r"V^{*} = H(s) V_c", "V* = H(s) V_c")
    if gains is None and network.feedback_p is not None:
        latex, text = write.fraction(_feedback(network), network.den)
        yield Equation(
            Text("Fed back into the velocity, m/s²"),
            rf"a = {latex} \left(V_r - V_c\right)",
            f"a = {text} (V_r - V_c)",
        )
    yield Equation(
        Text("Transport rate"),
        r"\omega_E = -\frac{V^{*}_N}{M + h}, \quad \omega_N = \frac{V^{*}_E}{N + h}",
        "omega_E = -V*_N/(M + h), omega_N = V*_E/(N + h)",
    )


def _feedback(network: LinearNetwork) -> np.ndarray:
    """Numerator of G(s) = a/u over ``den``, 1/s, of its normalised form G(p) = a/(omega_s u)."""
    assert network.feedback_p is not None
    degree = np.arange(len(network.feedback_p) - 1, -1, -1)
    return network.feedback_p * network.omega_s ** (network.order - degree + 1.0)


def _velocity_feedback(
    write: _Writer, gains: tuple[float, float, float], realisation: str
) -> Iterator[Equation]:
    k1, k2, k3 = gains
    begin = "V_c + " if realisation == "feedback" else ""
    latex, text = write.both(
        rf"V^<*> = {begin}{{k2}} \delta v + {{k3}} \int \delta v \, dt, \quad \delta v = V_c - V_r",
        f"V* = {begin}{{k2}} dv + {{k3}} integral(dv dt), dv = V_c - V_r",
        k2=k2,
        k3=k3,
    )
    yield Equation(Text("Velocity of the transport rate"), latex, text)
    latex, text = write.both(r"a = -{k1} \delta v", "a = -{k1} dv", k1=k1)
    yield Equation(Text("Fed back into the velocity, m/s²"), latex, text)


def _loop(write: _Writer, network: LinearNetwork) -> Iterator[Equation]:
    """The closed loop of one channel."""
    num = network.loop_num_p * network.omega_s ** (
        network.order - np.arange(len(network.loop_num_p) - 1.0, -1.0, -1.0)
    )
    loop = np.polyadd(np.append(network.den, [0.0, 0.0]), network.omega_s**2 * num)
    latex, text = write.fraction(loop, np.ones(1))
    yield Equation(Text("Closed loop of one level channel"), f"{latex} = 0", f"{text} = 0")


def _azimuth(write: _Writer, network: LinearNetwork, *, external: bool) -> Iterator[Equation]:
    latex, text = write.fraction(network.num, network.den)
    yield Equation(Text("Network of the azimuth channel"), f"Y(s) = {latex}", f"Y(s) = {text}")
    inner = (r"\left(\omega_{Ur} - \omega_U\right)", "(omega_Ur - omega_U)")
    signed = ("", inner) if external else ("-", (r"\omega_U", "omega_U"))
    sign, (latex, text) = signed
    yield Equation(
        Text("Added to the rate about the vertical, rad/s"),
        rf"c_U = {sign}\left[1 - Y(s)\right] {latex}",
        f"c_U = {sign}[1 - Y(s)] {text}",
    )


def _gyrocompass(write: _Writer, gains: AzimuthGains) -> Iterator[Equation]:
    latex, text = write.both(
        r"\omega_E = -\frac<V_<cN> + {k2} \delta v_N><M + h>, \quad a_N = -{k1} \delta v_N, "
        r"\quad \delta v_N = V_<cN> - V_<rN>",
        "omega_E = -(V_cN + {k2} dv_N)/(M + h), a_N = -{k1} dv_N, dv_N = V_cN - V_rN",
        k1=gains.k1,
        k2=gains.k2,
    )
    yield Equation(Text("North channel of the gyrocompass, in the place of its network"), latex, text)
    latex, text = write.both(
        r"\dot<c>_U = -{k4} c_U + \frac<{k3}><\Omega \cos L_c> \delta v_N",
        "d/dt c_U = -{k4} c_U + {k3} dv_N/(Omega cos L_c)",
        k3=gains.k3,
        k4=gains.k4,
    )
    yield Equation(Text("Added to the rate about the vertical, rad/s"), latex, text)
