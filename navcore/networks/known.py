"""H(s) of a network at a site, made once however often it is asked for."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from navcore.networks.base import LinearNetwork, NetworkParameters


def transfer_at(parameters: NetworkParameters, omega_s: float) -> LinearNetwork:
    """Return ``parameters.transfer(omega_s)``, whose arrays cannot be written to.

    Parameters
    ----------
    parameters : NetworkParameters
        Of the network.
    omega_s : float
        Schuler frequency, rad/s.

    Raises
    ------
    InputError
        As `navcore.networks.base.NetworkParameters.transfer`.
    """
    frozen: Any = parameters  # and so hashable, which its type does not say
    return _made(frozen, omega_s)


@lru_cache(maxsize=512)
def _made(parameters: Any, omega_s: float) -> LinearNetwork:
    return parameters.transfer(omega_s)
