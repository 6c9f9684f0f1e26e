"""A pair picked in a plot, dragged there, or typed, becomes parameters of the selected network."""

import math
import re
from dataclasses import dataclass
from typing import Any, Literal

from navcore.analysis import analyse
from navcore.analysis.placement import LEAST_DAMPING, place, placeable
from navcore.design.vary import network_not_in_force
from navcore.foundation.earth import EARTH_RATE
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.networks.base import NetworkParameters
from navcore.networks.pair import MainPair
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.editing.edits import with_network
from schuler_bench.plots.units import number

COMMAND = "place"
Block = Literal["network", "azimuth"]
"""Whose pair: of the level channels, in units of omega_s, or of the azimuth network, in units of Omega."""
SIGNS: dict[Block, str] = {"network": "ωₛ", "azimuth": "Ω"}
_FARTHEST = 1e6
_SAME = 1e-6


@dataclass(frozen=True)
class Placed:
    """Result of placing a pair.

    Attributes
    ----------
    scenario : Scenario
        With the changed network.
    words : str
        What the pair now is.
    note : str
        What could not be met; empty when all was.
    """

    scenario: Scenario
    words: str
    note: str


def read_point(text: str) -> complex:
    """Point of the pole map, units of omega_s, from ``re im``.

    Raises
    ------
    InputError
        Not two finite numbers of a sensible size.
    """
    words = text.split()
    try:
        real, imag = (float(word) for word in words)
    except ValueError:
        raise InputError(
            Fault("", "point", text[:60], Text("must be two numbers: Re and Im of s/ωₛ"))
        ) from None
    if not (abs(real) <= _FARTHEST and abs(imag) <= _FARTHEST) or real == imag == 0.0:
        raise InputError(
            Fault(
                "",
                "point",
                text[:60],
                Text("must lie within {farthest:g} ωₛ, and not at 0", farthest=_FARTHEST),
            )
        )
    return complex(real, imag)


def pair_at(point: complex) -> tuple[float, float]:
    """Damping ratio and frequency (units of omega_s) of the pair through a point of the left half plane.

    Raises
    ------
    InputError
        The point is unstable, or hardly damped.
    """
    size = abs(point)
    ratio = -point.real / size
    if ratio < LEAST_DAMPING:
        side = Text("grows without bound") if ratio < 0.0 else Text("is hardly damped")
        allowed = Text(
            "must be >= {least_damping:g}: a pair there {side}; the nearest possible one "
            "at ω = {size} ωₛ has ζ = {least_damping:g}",
            least_damping=LEAST_DAMPING,
            side=side,
            size=number(size, 3),
        )
        raise InputError(Fault("", Text("damping ratio ζ"), round(ratio, 4), allowed))
    return ratio, size


def unit_frequency(scenario: Scenario, block: Block) -> float:
    """Unit of frequency in which a pair is expressed, rad/s."""
    return EARTH_RATE if block == "azimuth" else scenario.omega_s


def _network(method: Method, block: Block) -> NetworkParameters:
    return getattr(method, block)


def _set_by_policy(method: Method, block: Block) -> str:
    """Why the method's policy leaves nothing to place; empty where it leaves the network as it is."""
    return network_not_in_force(method) if block == "network" else ""


def with_pair(
    scenario: Scenario,
    index: int,
    damping_ratio: float,
    ratio: float,
    h_slope_limit_s: float | None = None,
    block: Block = "network",
) -> Placed:
    """Give a method's network the closed-loop pair that is wanted.

    Parameters
    ----------
    scenario : Scenario
        Stays as it is.
    index : int
        Which method.
    damping_ratio, ratio : float
        Of the pair: xi, and |p| over `unit_frequency`.
    h_slope_limit_s : float, optional
        H(0) must be 1 and H'(0) no larger than this, s.
    block : {"network", "azimuth"}
        Which network of the method.

    Raises
    ------
    InputError
        The method or its network cannot; says why, and where its pair lies.
    """
    method = scenario.method[index]
    if method.undamped:
        allowed = Text(
            '{name} runs without its network: set its damping to "internal" or "external" first',
            name=method.name,
        )
        raise InputError(Fault("", f"method.{index}.damping", method.damping, allowed))
    if reason := _set_by_policy(method, block):
        raise InputError(Fault("", f"method.{index}.network", method.network.id, reason))
    omega_s, sign = unit_frequency(scenario, block), SIGNS[block]
    wanted = f"ζ = {number(damping_ratio, 3)}, ω = {number(ratio, 3)} {sign}"
    try:
        placed = place(
            _network(method, block), damping_ratio, ratio * omega_s, omega_s, h_slope_limit_s=h_slope_limit_s
        )
    except InputError as error:
        raise _why_not(method, block, wanted, omega_s, error) from None
    changed = with_network(scenario, index, placed.parameters.model_dump(exclude_none=True), block)
    words = f"ζ = {number(placed.damping_ratio, 3)}, ω = {number(placed.frequency / omega_s, 3)} {sign}"
    return Placed(changed, Text("{name}: pair at {words}", name=method.name, words=words), placed.note)


@dataclass(frozen=True)
class Drag:
    """Where a handle is dragged to.

    Attributes
    ----------
    gesture : str
        Marks the drag; all its places are one step of undo.
    method : int
        Whose handle it is.
    damping_ratio, ratio : float
        Of the pair wanted: xi, and |p| / omega_s.
    ends : bool
        The handle is let go.
    """

    gesture: str
    method: int
    damping_ratio: float
    ratio: float
    ends: bool


_NUMBER = r"([0-9]{1,12}(?:\.[0-9]{0,12})?(?:e[+-]?[0-9]{1,3})?)"
_DRAG = re.compile(rf"([0-9]{{1,15}}) ([0-9]{{1,3}}) {_NUMBER} {_NUMBER} ([01])")


def read_drag(text: str) -> Drag | None:
    """Read what a page says of a handle that is dragged; None for anything else.

    Examples
    --------
    >>> read_drag("17 2 0.5 1.25 0")
    Drag(gesture='17', method=2, damping_ratio=0.5, ratio=1.25, ends=False)
    >>> read_drag("17 2 nan 1.25 0"), read_drag("17 2 0.5 0 0")
    (None, None)
    """
    match = _DRAG.fullmatch(text.strip())
    if match is None:
        return None
    damping_ratio, ratio = float(match[3]), float(match[4])
    if not (0.0 < damping_ratio <= _FARTHEST and 0.0 < ratio <= _FARTHEST):
        return None
    return Drag(match[1], int(match[2]), damping_ratio, ratio, match[5] == "1")


def with_nearest_pair(
    scenario: Scenario,
    index: int,
    damping_ratio: float,
    ratio: float,
    h_slope_limit_s: float | None = None,
    block: Block = "network",
) -> Placed:
    """Give a method's network the possible pair that is next to a wanted one; ``note`` says if it is another.

    Parameters
    ----------
    scenario, index, damping_ratio, ratio, h_slope_limit_s, block
        As for `with_pair`.

    Raises
    ------
    InputError
        As `with_pair`, except for a pair out of the parameters' range.
    """
    pair, omega_s = main_pair(scenario, index, block), unit_frequency(scenario, block)
    if pair is None:
        return with_pair(scenario, index, damping_ratio, ratio, h_slope_limit_s, block)
    damping, frequency = pair.nearest(damping_ratio, ratio * omega_s)
    placed = with_pair(scenario, index, damping, frequency / omega_s, h_slope_limit_s, block)
    met = math.isclose(damping, damping_ratio, rel_tol=_SAME)
    if met and math.isclose(frequency, ratio * omega_s, rel_tol=_SAME):
        return placed
    return Placed(
        placed.scenario, placed.words, Text("the parameters allow {allowed}", allowed=pair.allowed(omega_s))
    )


def main_pair(scenario: Scenario, index: int, block: Block = "network") -> MainPair | None:
    """Pair of a method that can be placed, as it is; None where there is none."""
    method = scenario.method[index]
    if method.undamped or _set_by_policy(method, block):
        return None
    return _network(method, block).main_pair(unit_frequency(scenario, block))


def handle_of(scenario: Scenario, index: int, block: Block = "network") -> dict[str, Any]:
    """Describe the handle of a method's pair to a page, frequencies in units of `unit_frequency`.

    Without a handle ``pair`` is missing, and ``told`` says why. The shown run may lack the method.
    """
    if index >= len(scenario.method):
        return {}
    method, pair = scenario.method[index], main_pair(scenario, index, block)
    omega_s = unit_frequency(scenario, block)
    if pair is None:
        reason = Text("it runs without its network")
        if not method.undamped:
            reason = _set_by_policy(method, block) or _network(method, block).no_handle
        return {"told": Text("No handle for {name}: {reason}.", name=method.name, reason=reason)}
    return {
        "method": index,
        "name": method.name,
        "pair": [pair.damping_ratio, pair.frequency / omega_s],
        "dampings": list(pair.dampings),
        "frequencies": [[min(end / omega_s, _FARTHEST) for end in ends] for ends in pair.frequencies],
        "omega_s": omega_s,
        "unit": SIGNS[block],
    }


def _why_not(method: Method, block: Block, wanted: str, omega_s: float, error: InputError) -> InputError:
    """Say why the network cannot, what it does now, and what can."""
    network = _network(method, block)
    loop = analyse(network.at_earth_rate() if block == "azimuth" else network.transfer(omega_s))
    now = Text(
        "its least damped pair stays at ζ = {damping_ratio}, ω = {natural_frequency} {sign}",
        damping_ratio=number(loop.damping_ratio, 3),
        natural_frequency=number(loop.natural_frequency / omega_s, 3),
        sign=SIGNS[block],
    )
    fault = error.faults[0]
    if fault.field == "network":
        reason = Text(
            "this network has no parameter that puts a pair at {wanted}; {now}; use {placeable}",
            wanted=wanted,
            now=now,
            placeable=placeable(),
        )
        return InputError(Fault("", Text("{name}, network", name=method.name), network.id, reason))
    return InputError(
        Fault(
            "",
            Text("{name}, {field}", name=method.name, field=fault.field),
            fault.value,
            Text("{allowed}, for {wanted}; {now}", allowed=fault.allowed, wanted=wanted, now=now),
        )
    )


def typed_pair(damping_ratio: float, ratio: float) -> tuple[float, float]:
    """Check a typed pair; the same bounds as of a picked one.

    Raises
    ------
    InputError
        Not a number, or not a pair.
    """
    if not (math.isfinite(damping_ratio) and LEAST_DAMPING <= damping_ratio <= 1.0):
        allowed = Text(
            "must be >= {least_damping:g} and <= 1 (above 1 there is no pair)", least_damping=LEAST_DAMPING
        )
        raise InputError(Fault("", "pair ζ", damping_ratio, allowed))
    if not (math.isfinite(ratio) and 0.0 < ratio <= _FARTHEST):
        raise InputError(
            Fault("", "pair ω/ωₛ", ratio, Text("must be > 0 and <= {farthest:g}", farthest=_FARTHEST))
        )
    return damping_ratio, ratio
