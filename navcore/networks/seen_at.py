"""One H(s) at two Schuler frequencies: what was designed at one place and runs at another."""

from dataclasses import replace

import numpy as np

from navcore.networks.base import LinearNetwork
from navcore.networks.roots import fixed


def seen_at(network: LinearNetwork, omega_s: float) -> LinearNetwork:
    """Return the same H(s) at another Schuler frequency: num, den, zeros, poles and gain stay exactly.

    The closed loop is that of the other frequency.

    Parameters
    ----------
    network : LinearNetwork
        As designed.
    omega_s : float
        Where it runs, rad/s.
    """
    ratio = network.omega_s / omega_s
    degree = network.order
    shift = degree + 1 - len(network.num_p)
    feedback = network.feedback_p
    if feedback is not None:  # G = a/(omega_s u): one more power of omega_s than the polynomials in p
        powers = degree - np.arange(len(feedback))[::-1]
        feedback = fixed(feedback * ratio ** (1.0 + powers))
    return replace(
        network,
        omega_s=omega_s,
        num_p=fixed(network.num_p * ratio ** (shift + np.arange(len(network.num_p)))),
        den_p=fixed(network.den_p * ratio ** np.arange(degree + 1)),
        feedback_p=feedback,
        closed_loop_p=None,
    )
