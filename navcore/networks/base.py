"""Base of the damping networks: checked parameters that give an LTI object H(s).

All polynomials are formed in normalised frequency p = s / omega_s, where their coefficients lie near 1; the
physical ones (rad/s, as low as 1e-12) are exact multiples of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from navcore.foundation.drawing import drawn
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.registry import Entry
from navcore.foundation.text import Text
from navcore.foundation.units import EARTH_RATE
from navcore.networks.pair import MainPair, Placement
from navcore.networks.roots import fixed, leading, sorted_roots
from navcore.networks.transfer_function import transfer_function

if TYPE_CHECKING:
    from control import TransferFunction

    from navcore.networks.lqg import ControlProblem, SensorFigures

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

MAX_ORDER = 8
"""Highest order of a network: the compiled control law has room for this many states a channel."""


@dataclass(frozen=True, eq=False)
class LinearNetwork:
    """A damping network H(s) = num/den at one Schuler frequency; arrays are read-only.

    Attributes
    ----------
    id : str
        Name in the catalogue (theory.md section 3).
    num, den : ndarray, shapes (m + 1,) and (n + 1,)
        Coefficients in descending powers of s, rad/s; den monic, m <= n.
    omega_s : float
        Schuler frequency the network was made for, rad/s.
    zeros, poles : ndarray of complex, shapes (m,) and (n,)
        rad/s.
    gain : float
        Leading coefficient of num.
    num_p, den_p : ndarray
        The same polynomials in p = s / omega_s.
    warnings : tuple of str
        What the user should know about these parameters.
    realisation : str
        How the mechanization carries it out under external damping: "network", "feedback" or "as_printed".
    feedback_p : ndarray or None
        Of a network with two outputs, velocity feedback beside Q = 1 - H: numerator over ``den_p`` of
        G(p) = a/(omega_s u), of lower degree, with u = V_r - V_c (m/s) and a fed back into the velocity
        (m/s^2). None where there is none, or where gains make it (`compass`).
    closed_loop_p : ndarray of complex or None
        Closed-loop poles / omega_s where the design gives them exactly (a repeated pole found as a root of
        the polynomial is right to 1e-5 only); None: to be computed.
    """

    id: str
    num: FloatArray
    den: FloatArray
    omega_s: float
    zeros: ComplexArray
    poles: ComplexArray
    gain: float
    num_p: FloatArray
    den_p: FloatArray
    warnings: tuple[str, ...] = ()
    realisation: str = "network"
    feedback_p: FloatArray | None = field(default=None, repr=False)
    closed_loop_p: ComplexArray | None = field(default=None, repr=False)

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        arrays = self.num_p, self.den_p, self.poles, self.feedback_p, self.closed_loop_p
        return *(b"" if one is None else one.tobytes() for one in arrays), self.omega_s, self.realisation

    def __eq__(self, other: object) -> bool:
        """Whether another network has the same coefficients and poles, as the key of a cache."""
        return isinstance(other, LinearNetwork) and self._key == other._key

    def __hash__(self) -> int:
        """Hash of coefficients and poles."""
        return hash(self._key)

    @property
    def order(self) -> int:
        """Number of poles."""
        return len(self.den) - 1

    @property
    def h0(self) -> float:
        """Gain at rest H(0); inf for a pole at zero. A loop with H(0) = 1 rejects a standing log error."""
        if self.den_p[-1] == 0.0:
            return math.inf
        with np.errstate(over="ignore"):  # a pole next to zero
            return float(self.num_p[-1] / self.den_p[-1])

    @property
    def h_slope(self) -> float:
        """Slope H'(0) = dH/ds at s = 0, s; nan for a pole at zero (theory.md 10)."""
        d0 = float(self.den_p[-1])
        if d0 == 0.0:
            return math.nan
        n0 = float(self.num_p[-1])
        n1 = float(self.num_p[-2]) if len(self.num_p) > 1 else 0.0
        d1 = float(self.den_p[-2]) if len(self.den_p) > 1 else 0.0
        return (n1 - n0 / d0 * d1) / d0 / self.omega_s

    @property
    def loop_num_p(self) -> FloatArray:
        """Numerator over ``den_p`` of H + p G: the loop is p^2 + H + p G, with G = 0 but for two outputs."""
        if self.feedback_p is None:
            return self.num_p
        return np.asarray(np.polyadd(self.num_p, np.append(self.feedback_p, 0.0)), dtype=np.float64)

    def loop_response(self, omega: np.ndarray | float) -> ComplexArray:
        """Return (H + p G)(j omega), shape of ``omega`` (rad/s): H, but for a network with two outputs."""
        p = 1j * np.asarray(omega, dtype=float) / self.omega_s
        return np.polyval(self.loop_num_p, p) / np.polyval(self.den_p, p)

    def response(self, omega: np.ndarray | float) -> ComplexArray:
        """Return the complex frequency response H(j omega).

        Parameters
        ----------
        omega : array_like
            Angular frequency, rad/s.

        Returns
        -------
        ndarray of complex, shape of ``omega``
        """
        p = 1j * np.asarray(omega, dtype=float) / self.omega_s
        return np.polyval(self.num_p, p) / np.polyval(self.den_p, p)

    def to_control(self, *, normalised: bool = False) -> TransferFunction:
        """Return H(s) as a `control.TransferFunction` (python-control).

        Parameters
        ----------
        normalised : bool
            In p = s / omega_s, time in units of 1/omega_s. To be preferred for anything numerical: the
            coefficients in rad/s are as small as 1e-12.

        Examples
        --------
        >>> from navcore.networks import parse_network
        >>> network = parse_network('id = "unity2"').transfer(1.24e-3)
        >>> bool(abs(network.to_control().dcgain() - 1.0) < 1e-12)
        True
        """
        return transfer_function(self.num, self.den, self.omega_s if normalised else None)


class NetworkParameters(Entry):
    """Base of the ``network`` block of a method; subclasses narrow ``id`` to a Literal.

    Attributes
    ----------
    title : str
        Name on the page.
    alternatives : tuple of tuple of str
        Groups of fields that stand for each other: giving one group takes the others away.
    placeable : str
        Name in the list of networks that a pole pair can place (`with_pair`); empty: it cannot be placed.
    no_handle : str
        Why its pair cannot be placed, as the page says it; empty where it can.
    """

    title: ClassVar[str] = ""
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = ()
    placeable: ClassVar[str] = ""
    no_handle: ClassVar[str] = Text("its parameters set no pair")
    id: Any  # a Literal in each subclass; str here would be narrowed against the rule for mutable fields

    def at_earth_rate(self) -> LinearNetwork:
        """Return Y(s) of the azimuth channel: the network with Omega for omega_s (theory.md 3.7)."""
        return self.transfer(EARTH_RATE)

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) for a Schuler frequency in rad/s.

        Raises
        ------
        InputError
            These parameters make no network (field names relative to the network block).
        """
        raise NotImplementedError

    def control_problem(self) -> ControlProblem | None:
        """Return the control problem of one channel that the network solves; None where it solves none."""
        return None

    def figure(self, name: str = "bode", lat_deg: float = 45.0, **options: Any) -> Any:
        """Draw the network damping with a log at a latitude, as `plotly.graph_objects.Figure`.

        ``name`` is "bode", "nyquist", "poles" or "step", ``options`` as of `navcore.Run.figure`; raises
        `InputError` for another name, or parameters that make no network.
        """
        return drawn("network_figure", self, name, lat_deg, **options)

    @property
    def damping_field(self) -> str:
        """Name of the field that sets the damping, xi or zeta; empty where none is given."""
        return next((name for name in ("xi", "zeta") if getattr(self, name, None) is not None), "")

    def damping_coefficient(self) -> float | None:
        """Return the parameter that sets the damping (xi or zeta); None where none is given."""
        return getattr(self, self.damping_field) if self.damping_field else None

    def tuning(self, omega_s: float) -> list[float] | None:
        """Return code and parameters for `navcore.networks.retuning` (``omega_s`` in rad/s).

        None where a run cannot re-tune the network.
        """
        return None

    def with_damping(self, coefficient: float) -> NetworkParameters:
        """Return a network that has a `damping_field` with another coefficient, xi or zeta.

        It is not checked against the range of the field.
        """
        return self.model_copy(update={self.damping_field: coefficient})

    def with_pair(
        self, damping_ratio: float, frequency: float, omega_s: float
    ) -> Placement[NetworkParameters] | None:
        """Return parameters whose main closed-loop pair lies where it is wanted; None where none can.

        Parameters
        ----------
        damping_ratio, frequency, omega_s : float
            Wanted, 0.01..1; wanted natural frequency |p| and Schuler frequency, rad/s.

        Raises
        ------
        InputError
            The pair needs a parameter outside its range.
        """
        return None

    def main_pair(self, omega_s: float) -> MainPair | None:
        """Return the closed-loop pair that `with_pair` sets (``omega_s`` in rad/s); None where there is none.

        ``with_pair`` with the damping ratio and frequency of this pair gives the same loop again.
        """
        return None

    @classmethod
    def design_fields(cls) -> tuple[str, ...]:
        """Return the parameters that a design chooses; if not said otherwise, all that have a number."""
        return tuple(name for name, info in cls.model_fields.items() if isinstance(info.default, float))

    def with_sensors(self, figures: SensorFigures) -> NetworkParameters:
        """Return the network for the random errors of a scenario; the same where it does not look at them."""
        return self

    def changed(self, field: str, value: Any) -> NetworkParameters:
        """Return the same network with one field changed, checked.

        Raises
        ------
        ValueError
            The value is refused.
        """
        return type(self).model_validate(self.model_dump(exclude_none=True) | {field: value})

    def values(self, omega_s: float) -> dict[str, Any]:
        """Return the values of all parameters (``omega_s`` in rad/s), those that follow from others included.

        A parameter without a value (sigma and xi of gains that no (sigma, xi) gives) is missing.
        """
        names = type(self).model_fields
        given = {name: value for name in names if (value := getattr(self, name)) is not None}
        return self.following(self.transfer(omega_s)) | given if self.alternatives else given

    def taken(self) -> dict[str, Any]:
        """Return the values of parameters that are not given and are those of the scenario."""
        return {}

    def frozen(self, omega_s: float) -> NetworkParameters:
        """Return the network that takes nothing from its scenario, at a Schuler frequency in rad/s."""
        return self

    def following(self, network: LinearNetwork) -> dict[str, Any]:
        """Return the values of the `alternatives`, computed from the network that the parameters make."""
        return {}

    @property
    def stated_omega_s(self) -> float | None:
        """Schuler frequency that the parameters state, rad/s; None where they hold at every one."""
        return None

    @property
    def external_form(self) -> str:
        """Realisation with external damping: ``"network"``, or one of velocity feedback (theory.md 3.1)."""
        return "network"

    def feedback_gains(self, omega_s: float) -> tuple[float, float, float] | None:
        """Return K1 (1/s), K2, K3 (1/s) of the velocity feedback; None for a network that is none."""
        del omega_s
        return None

    @property
    def requires_reference(self) -> bool:
        """Whether the network as realised has no form without a reference velocity."""
        return False

    def least_coefficient(self) -> float:
        """Return the damping coefficient above which the loop is stable; 0 where all are."""
        return 0.0


def refuse(name: str, value: object, allowed: str) -> InputError:
    """Make the error of one field, named relative to the network block."""
    return InputError(Fault("", name, value, allowed))


def linear_network(
    id: str,
    omega_s: float,
    num_p: Sequence[float] | np.ndarray,
    den_p: Sequence[float] | np.ndarray,
    *,
    zeros_p: Sequence[complex] | np.ndarray | None = None,
    poles_p: Sequence[complex] | np.ndarray | None = None,
    closed_loop_p: Sequence[complex] | np.ndarray | None = None,
    warnings: tuple[str, ...] = (),
    realisation: str = "network",
    feedback_p: Sequence[float] | np.ndarray | None = None,
) -> LinearNetwork:
    """Make a `LinearNetwork` from polynomials in p = s / omega_s.

    Parameters
    ----------
    id : str
        Name in the catalogue.
    omega_s : float
        rad/s.
    num_p, den_p : array_like
        Coefficients, descending powers of p; leading zeros are removed, den is made monic.
    zeros_p, poles_p, closed_loop_p : array_like of complex, optional
        Roots where they are known exactly; else zeros and poles are computed.
    warnings, realisation, feedback_p
        See `LinearNetwork`; the denominator of ``feedback_p`` is ``den_p`` as given.

    Raises
    ------
    InputError
        omega_s is not positive, H is zero, improper or of too high an order.
    """
    if not (math.isfinite(omega_s) and omega_s > 0.0):
        raise refuse("omega_s", omega_s, Text("must be > 0 (rad/s)"))
    num, den = leading(num_p), leading(den_p)
    if len(den) == 0 or len(num) == 0:
        raise refuse("", None, Text("H(s) must have a numerator and a denominator that are not zero"))
    if len(num) > len(den):
        proper = Text("H(s) must be proper: no more zeros than poles, or H(infinity) is not finite")
        raise refuse("", None, proper)
    if len(den) - 1 > MAX_ORDER:
        most = Text(
            "H(s) has {den} poles: at most {max_order} can run", den=len(den) - 1, max_order=MAX_ORDER
        )
        raise refuse("", None, most)
    feedback = None if feedback_p is None else np.asarray(feedback_p, dtype=float) / den[0]
    num, den = num / den[0], den / den[0]
    while num[-1] == 0.0 and den[-1] == 0.0:  # a common root at s = 0 would make H(0) = 0/0
        num, den, zeros_p, poles_p = num[:-1], den[:-1], None, None
    zeros = np.roots(num) if zeros_p is None else np.asarray(zeros_p)
    poles = np.roots(den) if poles_p is None else np.asarray(poles_p)
    degree = len(den) - len(num)
    return LinearNetwork(
        id=id,
        num=fixed(num * omega_s ** (degree + np.arange(len(num)))),
        den=fixed(den * omega_s ** np.arange(len(den))),
        omega_s=omega_s,
        zeros=fixed(sorted_roots(zeros) * omega_s),
        poles=fixed(sorted_roots(poles) * omega_s),
        gain=float(num[0] * omega_s**degree),
        num_p=fixed(num),
        den_p=fixed(den),
        warnings=warnings,
        realisation=realisation,
        feedback_p=None if feedback is None else fixed(feedback),
        closed_loop_p=None if closed_loop_p is None else fixed(sorted_roots(np.asarray(closed_loop_p))),
    )
