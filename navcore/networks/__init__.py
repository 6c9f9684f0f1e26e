"""The catalogue of damping networks: one file each, a line in `catalogue` (theory.md section 3)."""

from typing import TYPE_CHECKING, Any

from navcore.networks.base import MAX_ORDER, LinearNetwork, NetworkParameters
from navcore.networks.catalogue import NETWORKS, network_type
from navcore.networks.parse import parse_network

if TYPE_CHECKING:
    from navcore.networks.catalogue import Network

__all__ = ["MAX_ORDER", "NETWORKS", "LinearNetwork", "Network", "NetworkParameters", "parse_network"]


def __getattr__(name: str) -> Any:
    """Type of a field that holds any network, as of when it is asked for: networks can be added."""
    if name == "Network":
        return network_type()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
