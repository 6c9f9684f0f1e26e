"""The closed-loop pole pair that parameters set: where it is, where it can be, what became of a wish."""

import math
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from pydantic import ValidationError

from navcore.foundation.errors import InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.parameters import Parameters, bounds_of
from navcore.foundation.text import Text

LEAST_DAMPING, LARGEST_DAMPING = 0.01, 1.0
"""Damping ratios that a pair can be placed at: above 1 there is no pair."""
_SAME = 1e-6
_ROUNDING = 1e-12
"""A product that is to stay within a range is kept so far inside it."""
Range = tuple[float, float]
"""Lowest and highest value."""
Network = TypeVar("Network", bound=Parameters)
"""Class of a network's parameters (`navcore.networks.base.NetworkParameters`)."""


@dataclass(frozen=True)
class MainPair:
    """The closed-loop pair that a network's parameters set, and the pairs that they can set.

    Attributes
    ----------
    damping_ratio : float
        Of the pair as it is; above 1 its poles are real.
    frequency : float
        |p| of the pair as it is, rad/s.
    dampings : (float, float)
        Damping ratios that it can have.
    frequencies : tuple of (float, float)
        Frequencies that it can have, rad/s, ascending; one with equal ends where it always lies.
    rates : (float, float)
        Allowed products of both, 1/s: what is left of a range of sigma.
    """

    damping_ratio: float
    frequency: float
    dampings: Range
    frequencies: tuple[Range, ...]
    rates: Range = (0.0, math.inf)

    def nearest(self, damping_ratio: float, frequency: float) -> tuple[float, float]:
        """Return damping ratio and frequency (rad/s) of the pair that is possible next to a wanted one.

        The damping ratio is met first; then the frequency that is nearest by its ratio to the wanted one.

        Parameters
        ----------
        damping_ratio : float
            Wanted.
        frequency : float
            Wanted, rad/s; above 0.
        """
        damping_ratio = _within(damping_ratio, self.dampings)
        low = self.rates[0] / damping_ratio * (1.0 + _ROUNDING)
        high = self.rates[1] / damping_ratio * (1.0 - _ROUNDING)
        ranges = [(max(least, low), min(most, high)) for least, most in self.frequencies]
        possible = [_within(frequency, ends) for ends in ranges if ends[0] <= ends[1]]
        if not possible:
            return self.damping_ratio, self.frequency
        return damping_ratio, min(possible, key=lambda candidate: abs(math.log(candidate / frequency)))

    def allowed(self, omega_s: float) -> str:
        """Say which pairs are possible; frequencies in units of omega_s (rad/s).

        Examples
        --------
        >>> MainPair(0.5, 1.2, (0.01, 1.0), ((0.1, 0.99), (1.01, 10.0))).allowed(1.0)
        'ζ = 0.01…1, ω = 0.1…0.99 or 1.01…10 ωₛ'
        """
        parts = [f"ζ = {self.dampings[0]:g}…{self.dampings[1]:g}"]
        finite = [ends for ends in self.frequencies if ends[1] < math.inf]
        if finite:
            spans = " or ".join(f"{low / omega_s:g}…{high / omega_s:g}" for low, high in finite)
            parts.append(Text("ω = {spans} ωₛ", spans=spans))
        if self.rates[1] < math.inf:
            parts.append(f"ζ ω = {self.rates[0]:g}…{self.rates[1]:g} 1/s")
        return ", ".join(parts)


def dampings(network: type[Parameters], field: str) -> Range:
    """Range of damping ratios that a field can give a pair."""
    low, high = bounds_of(network.model_fields[field])
    return max(low, LEAST_DAMPING), min(high, LARGEST_DAMPING)


def _within(value: float, ends: Range) -> float:
    return min(max(value, ends[0]), ends[1])


@dataclass(frozen=True)
class Placement(Generic[Network]):
    """Parameters for a wanted pair.

    Attributes
    ----------
    parameters : Network
        The network with that pair, as near as its structure allows.
    damping_ratio, frequency : float
        What the pair then is; frequency in rad/s.
    note : str
        What could not be met; empty when all was.
    """

    parameters: Network
    damping_ratio: float
    frequency: float
    note: str = ""


def placement(
    network: type[Network], data: dict[str, Any], damping_ratio: float, frequency: float, note: str
) -> Placement[Network]:
    """Check the parameters found for a pair.

    Parameters
    ----------
    network : type
        The network's class.
    data : dict
        Its fields.
    damping_ratio, frequency, note
        As in `Placement`.

    Raises
    ------
    InputError
        A parameter lies outside its range.
    """
    try:
        return Placement(network.model_validate(data), damping_ratio, frequency, note)
    except ValidationError as error:
        raise InputError(faults_from(error, network, data, "")) from None


def same_frequency(one: float, other: float) -> bool:
    """Whether two frequencies count as one: they differ by less than 1e-6 of their size."""
    return math.isclose(one, other, rel_tol=_SAME)


def placement_at_omega_s(
    parameters: Network,
    changes: dict[str, Any],
    damping_ratio: float,
    wanted: float,
    omega_s: float,
) -> Placement[Network]:
    """Check the parameters of a network whose pair always lies at omega_s; another frequency is noted.

    Parameters
    ----------
    parameters : Network
        The network as it is.
    changes : dict
        Fields that give the damping ratio.
    damping_ratio : float
        Of the pair.
    wanted : float
        Frequency asked for, rad/s.
    omega_s : float
        Schuler frequency, rad/s.
    """
    note = ""
    if not same_frequency(wanted, omega_s):
        note = Text("this network's pair always lies at ωₛ: only the damping ratio is taken")
    data = parameters.model_dump(exclude_none=True) | changes
    return placement(type(parameters), data, damping_ratio, omega_s, note)
