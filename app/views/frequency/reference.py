"""The optimal network for the scenario's own sensors, as a reference curve beside the methods' H."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork
from navcore.networks.lqg import SensorFigures
from navcore.networks.optimal import OptimalNetwork
from navcore.scenario.model import Scenario


@dataclass(frozen=True, eq=False)
class Reference:
    """Optimal network that is drawn, or why there is none.

    Attributes
    ----------
    label : str
        In the legend.
    network : LinearNetwork or None
        None where these sensors have no optimal network.
    """

    label: str
    network: LinearNetwork | None = None


def optimal_reference(scenario: Scenario) -> Reference:
    """Optimal network (theory.md 17) with its default weights, for the scenario's own sensors and log."""
    return _reference(scenario.figures(), scenario.reference.kind, scenario.omega_s)


@lru_cache(maxsize=16)
def _reference(figures: SensorFigures, log: str, omega_s: float) -> Reference:
    if log == "none":
        return Reference("no optimal H: the scenario has no log")
    known = {"gyros and accelerometers": figures.inertial, "log": figures.log}
    missing = [sensors for sensors, there in known.items() if not there]
    if missing:
        return Reference(Text("no optimal H: no random error of {missing}", missing=" and ".join(missing)))
    try:
        optimal = OptimalNetwork().with_sensors(figures)
        network = optimal.transfer(omega_s)
    except InputError as error:
        return Reference(Text("no optimal H: {allowed}", allowed=error.faults[0].allowed))
    fragile = ", fragile" if network.warnings else ""
    return Reference(
        Text("optimal for these sensors (ρ = {rho:g}{fragile})", rho=optimal.rho, fragile=fragile), network
    )
