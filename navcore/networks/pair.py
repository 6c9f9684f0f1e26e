"""What became of a closed-loop pole pair that is wanted of a network."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from navcore.foundation.errors import InputError
from navcore.foundation.faults import faults_from
from navcore.networks.base import NetworkParameters

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
        What could not be met; empty when all was.
    """

    parameters: NetworkParameters
    damping_ratio: float
    frequency: float
    note: str = ""


def placement(
    network: type[NetworkParameters], data: dict[str, Any], damping_ratio: float, frequency: float, note: str
) -> Placement:
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
    parameters: NetworkParameters,
    changes: dict[str, Any],
    damping_ratio: float,
    wanted: float,
    omega_s: float,
) -> Placement:
    """Check the parameters of a network whose pair always lies at omega_s; another frequency is noted.

    Parameters
    ----------
    parameters : NetworkParameters
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
        note = "this network's pair always lies at omega_s: only the damping ratio is taken"
    data = parameters.model_dump(exclude_none=True) | changes
    return placement(type(parameters), data, damping_ratio, omega_s, note)
