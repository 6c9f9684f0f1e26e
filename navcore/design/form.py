"""A method's law as linear equations: what its network makes of the difference V_r - V_c, in one channel."""

from dataclasses import dataclass

import numpy as np

from navcore.law.combination import realisation_of
from navcore.networks.base import NetworkParameters
from navcore.networks.known import transfer_at
from navcore.networks.state_space import state_spaces
from navcore.scenario.method import Method


@dataclass(frozen=True, eq=False)
class LawForm:
    """xi' = A xi + B u, c = C xi + D u, a = E xi + F u, in normalised time tau = omega_s t.

    u is the law's input (m/s), c is added to the velocity that forms the transport rate (m/s), a is fed back
    into the velocity integrator (omega_s m/s).

    Attributes
    ----------
    acts : bool
        Whether u counts: minus the computed velocity, or V_r - V_c.
    uses_log : bool
        Whether u holds the reference velocity V_r.
    A : ndarray, shape (n, n)
    B, C, E : ndarray, shape (n,)
    D, F : float
    as_printed : bool
        The transport rate is formed from c alone, without the reference's own (Deng 4).
    """

    acts: bool
    uses_log: bool
    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float
    E: np.ndarray
    F: float
    as_printed: bool = False

    @property
    def order(self) -> int:
        """States of the network in one channel."""
        return len(self.B)

    @property
    def self_referenced(self) -> bool:
        """Whether u is minus the computed velocity, so that the ship's manoeuvres enter."""
        return self.acts and not self.uses_log


def law_form(method: Method, omega_s: float) -> LawForm:
    """Form in which a method runs at a site, without its policy and switching.

    Parameters
    ----------
    method : Method
        Of a kind of damping whose loop has a covariance.
    omega_s : float
        Schuler frequency of the site, rad/s.
    """
    kind = method.kind
    if not kind.uses_network:
        empty = np.zeros(0)
        return LawForm(False, False, np.zeros((0, 0)), empty, empty, 0.0, empty, 0.0)
    parameters = kind.network(method)
    realisation = realisation_of(kind.law, parameters)
    gains = parameters.feedback_gains(omega_s)
    if realisation != "network" and gains is not None:
        return feedback_form(gains, omega_s, realisation == "as_printed")
    return _network_form(kind.referenced, parameters, omega_s)


def feedback_form(gains: tuple[float, float, float], omega_s: float, as_printed: bool = False) -> LawForm:
    """Velocity feedback: c = -K2 u + P, P' = -K3 u, a = K1 u (theory.md 3.1).

    Parameters
    ----------
    gains : tuple of float
        K1 (1/s), K2, K3 (1/s).
    omega_s : float
        Schuler frequency, rad/s.
    as_printed : bool
        As in Deng 4.
    """
    k1, k2, k3 = gains
    one = np.ones(1)
    return LawForm(
        True, True, np.zeros((1, 1)), -k3 / omega_s * one, one, -k2, np.zeros(1), k1 / omega_s, as_printed
    )


def _network_form(uses_log: bool, parameters: NetworkParameters, omega_s: float) -> LawForm:
    network = transfer_at(parameters, omega_s)
    nums = [network.num_p] if network.feedback_p is None else [network.num_p, network.feedback_p]
    h, *others = state_spaces(nums, network.poles / omega_s)
    E, F = (others[0].C, others[0].D) if others else (np.zeros(len(h.B)), 0.0)
    return LawForm(True, uses_log, h.A, h.B, -h.C, 1.0 - h.D, E, F)
