"""Base of the kinds of damping: one class a kind, from which the other rooms take the rest.

A kind names what it needs of the rooms above by a word of a short list, and the room above has one table of
how that is done: `Need` in `navcore.scenario.needs`, `Carrying` in `navcore.engine.drivers`, `Covering` in
`navcore.design`, for the steady state and for the bands.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from typing import ClassVar, Literal, NamedTuple, Protocol

from navcore.foundation.errors import Fault
from navcore.foundation.parameters import Parameters
from navcore.foundation.text import Text
from navcore.law.combination import combination_faults, combination_warnings, network_in_force
from navcore.law.policy.base import PolicyParameters
from navcore.law.records import LawKind
from navcore.law.switching.base import SwitchingParameters
from navcore.networks.azimuth_loop import AzimuthChannel, AzimuthGains
from navcore.networks.base import LinearNetwork, NetworkParameters
from navcore.networks.known import transfer_at
from navcore.networks.undamped import UndampedNetwork

Carrying = Literal["law", "copies", "filter", "user"]
"""How the engine carries a method out: one navigation with the damping law, averaged copies of a free one, a
free one that a Kalman filter corrects, or one with a law of the user's own."""
Covering = Literal["covariance", "seeds", "filter"]
"""Where the error budget comes from: the covariance of the loop, an ensemble of seeds, or the covariance that
a Kalman filter keeps itself."""


class Need(NamedTuple):
    """A condition on the rest of the scenario.

    Attributes
    ----------
    of : {"reference", "log", "coupled channels", "simulated IMU", "standing start", "below 85 deg"}
        The condition.
    because : str
        The fault's text where it is not met.
    """

    of: Literal["reference", "log", "coupled channels", "simulated IMU", "standing start", "below 85 deg"]
    because: str


class GyrocompassSettings(Protocol):
    """Settings of an azimuth loop."""

    @property
    def sigma(self) -> float:
        """Decay rate, 1/s."""
        ...

    def gains(self, omega_s: float, gravity: float) -> AzimuthGains:
        """Gains at a Schuler frequency (rad/s) and a gravity (m/s^2)."""
        ...


class Configured(Protocol):
    """A block ``[[method]]`` as a kind of damping sees it."""

    @property
    def network(self) -> NetworkParameters:
        """Network as configured."""
        ...

    @property
    def azimuth(self) -> NetworkParameters:
        """Network of the azimuth channel as configured; "none": it is not damped."""
        ...

    @property
    def gyrocompass(self) -> GyrocompassSettings | None:
        """Azimuth loop as configured."""
        ...

    @property
    def policy(self) -> PolicyParameters:
        """Policy as configured."""
        ...

    @property
    def switching(self) -> SwitchingParameters:
        """Switching method as configured."""
        ...


class Damping:
    """A kind of damping. This base is a navigation without a network.

    Attributes
    ----------
    id : str
        Name in the scenario.
    help : str
        What it does, in one clause.
    settings : type or None
        Parameters of the kind's own, the block of the method that bears the kind's name.
    blocks : tuple of str
        Blocks of the method that act, in the order in which the page offers them.
    uses_network, uses_log : bool
        Whether the method's network acts, and whether the log's velocity enters the navigation. What does not
        enter is 0 in the error budget, and no floor with a log stands beside it.
    law : {"free", "internal", "external"}
        Law of `navcore.law.law.prepare_law`.
    carrying, covering : str
        See `Carrying` and `Covering`.
    no_covariance : str
        Why the covariance of the loop does not describe it; empty where it does.
    no_loop : str
        Why no closed loop stands for it; empty where one does.
    needs : tuple of Need
        Conditions on the rest of the scenario.
    """

    id: ClassVar[str]
    help: ClassVar[str]
    settings: ClassVar[type[Parameters] | None] = None
    blocks: ClassVar[tuple[str, ...]] = ("network", "policy", "switching")
    uses_network: ClassVar[bool] = False
    uses_log: ClassVar[bool] = False
    law: ClassVar[LawKind] = "free"
    carrying: ClassVar[Carrying] = "law"
    covering: ClassVar[Covering] = "covariance"
    no_covariance: ClassVar[str] = ""
    no_loop: ClassVar[str] = ""
    needs: ClassVar[tuple[Need, ...]] = ()

    @property
    def referenced(self) -> bool:
        """Whether the network is fed with the difference to the log, so that the log's errors enter."""
        return self.uses_network and self.uses_log

    @property
    def self_referenced(self) -> bool:
        """Whether the network is fed with the system's own velocity, so that manoeuvres enter."""
        return self.uses_network and not self.uses_log

    def of(self, method: Configured) -> "Damping":
        """Return the kind that a method is by its settings: this one."""
        return self

    def reads_log(self, method: Configured) -> bool:
        """Whether the log changes a run: by its velocity, or by the difference that a policy decides by."""
        return self.uses_log or (self.uses_network and method.policy.needs_reference)

    def label(self, method: Configured) -> str:
        """Name of a method without a name of its own."""
        return self.id

    def description(self, method: Configured) -> str:
        """Describe the method in a line."""
        return self.label(method)

    def network(self, method: Configured) -> NetworkParameters:
        """Network in force: as configured, or the one that the policy brings; H = 1 where none acts."""
        return network_in_force(self.law, method.network, method.policy)

    def azimuth(self, method: Configured, omega_s: float) -> AzimuthChannel | None:
        """Y(s) or gyrocompass of the azimuth channel at a Schuler frequency (rad/s); None: neither."""
        return None

    def acting(self, network: LinearNetwork) -> LinearNetwork:
        """H(s) as it closes the loop: H = 1 where no network acts.

        Parameters
        ----------
        network : LinearNetwork
            H(s) of the method's network.
        """
        return transfer_at(UndampedNetwork(), network.omega_s)

    def faults(self, method: Configured, law_step_s: float) -> Iterator[Fault]:
        """Yield what does not go together within the method; fields relative to it.

        Parameters
        ----------
        method : Configured
            The method.
        law_step_s : float
            Time between two calls of the law, s.
        """
        return iter(())

    def notices(self, method: Configured) -> Iterator[str]:
        """Yield what the user should know about a method that has no faults."""
        if method.network.id != "none":
            yield Text('damping = "{damping}": the network is not used', damping=self.id)


class NetworkDamping(Damping):
    """A kind in which the method's network acts, by its policy and switching method."""

    blocks: ClassVar[tuple[str, ...]] = ("network", "azimuth", "policy", "switching")
    uses_network: ClassVar[bool] = True

    def label(self, method: Configured) -> str:
        """Network and kind."""
        return Text("{id} ({id2})", id=method.network.id, id2=self.id)

    def description(self, method: Configured) -> str:
        """Kind, network, policy and switching method."""
        return Text(
            "{damping}, network {network}, policy {policy}, switching {switching}",
            damping=self.id,
            network=method.network.id,
            policy=method.policy.id,
            switching=method.switching.id,
        )

    def acting(self, network: LinearNetwork) -> LinearNetwork:
        """H(s); the network form of it where the kind has no reference (theory.md 3)."""
        return network if self.uses_log or network.realisation == "network" else _network_form(network)

    def faults(self, method: Configured, law_step_s: float) -> Iterator[Fault]:
        """Yield what does not go together of network, policy and switching method."""
        return combination_faults(self.law, method.network, method.policy, method.switching, law_step_s)

    def notices(self, method: Configured) -> Iterator[str]:
        """Yield what policy and switching method say of the network."""
        yield from combination_warnings(method.network, method.policy, method.switching)


@lru_cache(maxsize=256)
def _network_form(network: LinearNetwork) -> LinearNetwork:
    return replace(network, realisation="network")
