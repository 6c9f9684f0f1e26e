"""The catalogue of damping networks: one file each, a line in `catalogue` (physics.md section 3)."""

from __future__ import annotations

from navcore.network.base import MAX_ORDER, LinearNetwork, NetworkParameters
from navcore.network.catalogue import NETWORKS, Network
from navcore.network.parse import parse_network

__all__ = ["MAX_ORDER", "NETWORKS", "LinearNetwork", "Network", "NetworkParameters", "parse_network"]
