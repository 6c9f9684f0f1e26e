"""From a wanted closed-loop pole pair (damping ratio, frequency) to the parameters that give it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from navcore.errors import Fault, InputError
from navcore.network.base import NetworkParameters
from navcore.network.compass import CompassNetwork
from navcore.network.complementary import ComplementaryNetwork
from navcore.network.pole2 import Pole2Network
from navcore.network.unity2 import Unity2Network

LEAST_DAMPING, LARGEST_DAMPING = 0.01, 1.0
_SAME = 1e-6


@dataclass(frozen=True)
class Placement:
    """Parameters for a wanted pair.

    Attributes
    ----------
    parameters : NetworkParameters
        The network with that pair, as near as its structure allows.
    damping_ratio, frequency : float
        What the pair then is; frequency in rad/s.
    note : str
        What could not be met, in plain words; empty when all was.
    """

    parameters: NetworkParameters
    damping_ratio: float
    frequency: float
    note: str


def place(parameters: NetworkParameters, damping_ratio: float, frequency: float, omega_s: float) -> Placement:
    """Set a network's parameters so that its main closed-loop pair lies where it is wanted.

    Parameters
    ----------
    parameters : NetworkParameters
        The network; what the pair does not set stays.
    damping_ratio : float
        Wanted, 0.01..1 (a pair; above 1 there is none).
    frequency : float
        Wanted natural frequency |p|, rad/s.
    omega_s : float
        Schuler frequency, rad/s.

    Raises
    ------
    InputError
        The network has no parameter for it, or the wanted value lies outside what the parameter allows.
    """
    if not LEAST_DAMPING <= damping_ratio <= LARGEST_DAMPING:
        allowed = f"must be >= {LEAST_DAMPING} and <= {LARGEST_DAMPING:g}"
        raise InputError(Fault("", "damping ratio", damping_ratio, allowed))
    if not (math.isfinite(frequency) and frequency > 0.0):
        raise InputError(Fault("", "frequency", frequency, "must be > 0 (rad/s)"))
    xi = damping_ratio
    if isinstance(parameters, CompassNetwork):
        keep = {"realisation": parameters.realisation}
        return _placed(CompassNetwork, keep | {"sigma": xi * frequency, "xi": xi}, xi, frequency, "")
    if isinstance(parameters, Unity2Network):
        return _unity2(parameters, xi, frequency, omega_s)
    if isinstance(parameters, Pole2Network) and parameters.variant == "exact":
        data = parameters.model_dump() | {"xi": xi}
        return _placed(Pole2Network, data, xi, omega_s, _fixed(frequency, omega_s))
    if isinstance(parameters, ComplementaryNetwork):
        data = parameters.model_dump() | {"zeta": xi}
        return _placed(ComplementaryNetwork, data, xi, omega_s, _fixed(frequency, omega_s))
    allowed = "cannot be placed by a pole: use compass, unity2, complementary or pole2 (exact)"
    raise InputError(Fault("", "network", parameters.id, allowed))


def _unity2(parameters: Unity2Network, xi: float, frequency: float, omega_s: float) -> Placement:
    bounds = Unity2Network.model_fields["r"].metadata
    least = next(limit.ge for limit in bounds if hasattr(limit, "ge"))
    largest = next(limit.le for limit in bounds if hasattr(limit, "le"))
    r = min(max(frequency / omega_s, least), largest)
    note = ""
    if not math.isclose(r * omega_s, frequency, rel_tol=_SAME):
        note = f"the pair can only lie at {least:g} to {largest:g} omega_s: {r:g} omega_s is taken"
    data = parameters.model_dump(exclude_none=True) | {"zeta": xi, "r": r}
    return _placed(Unity2Network, data, xi, r * omega_s, note)


def _fixed(frequency: float, omega_s: float) -> str:
    if math.isclose(frequency, omega_s, rel_tol=_SAME):
        return ""
    return "this network's pair always lies at omega_s: only the damping ratio is taken"


def _placed(
    network: type[NetworkParameters], data: dict[str, Any], xi: float, frequency: float, note: str
) -> Placement:
    from pydantic import ValidationError

    from navcore.faults import faults_from

    try:
        return Placement(network.model_validate(data), xi, frequency, note)
    except ValidationError as error:
        raise InputError(faults_from(error, network, data, "")) from None
