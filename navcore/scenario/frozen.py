"""Scenarios as results: everything given on which H(s) depends."""

from navcore.foundation.earth import EARTH_RATE
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario


def frozen(scenario: Scenario) -> Scenario:
    """Return the scenario with networks that take nothing from it any more.

    What is written, downloaded or taken over is complete: an `optimal` network bears the figures of sensors
    and log and the Schuler frequency that it was designed for, so that H(s) is the same to the last digit in
    a replay, in another scenario and in ``schuler network``.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.

    Examples
    --------
    >>> from navcore import load
    >>> optimal = frozen(load("zha-fast", ['method.0.damping="external"', 'method.0.network="optimal"']))
    >>> optimal.method[0].network.log_noise_mps
    0.2
    """
    methods = tuple(frozen_method(method, scenario.omega_s) for method in scenario.method)
    return scenario.model_copy(update={"method": methods})


def frozen_method(method: Method, omega_s: float) -> Method:
    """Return a method whose networks take nothing from its scenario; Schuler frequency in rad/s."""
    networks = {
        "network": method.network.frozen(omega_s),
        "azimuth": method.azimuth.frozen(EARTH_RATE),
    }
    changed = {name: network for name, network in networks.items() if network is not getattr(method, name)}
    return method.model_copy(update=changed) if changed else method
