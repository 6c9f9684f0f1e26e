"""The catalogue of damping networks: one file each, a line in `catalogue` (theory.md section 3)."""

from navcore.networks.base import MAX_ORDER, LinearNetwork, NetworkParameters
from navcore.networks.catalogue import NETWORKS, Network
from navcore.networks.parse import parse_network

__all__ = ["MAX_ORDER", "NETWORKS", "LinearNetwork", "Network", "NetworkParameters", "parse_network"]
