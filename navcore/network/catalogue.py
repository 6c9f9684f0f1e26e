"""The registry of networks and the type of a field that holds any of them."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from navcore.network.base import NetworkParameters
from navcore.network.classic import Classic2Network, Classic3Network
from navcore.network.compass import CompassNetwork
from navcore.network.complementary import ComplementaryNetwork
from navcore.network.custom import CustomNetwork
from navcore.network.pole2 import Pole2Network
from navcore.network.undamped import UndampedNetwork
from navcore.network.unity2 import Unity2Network

NETWORKS: dict[str, type[NetworkParameters]] = {
    "none": UndampedNetwork,
    "classic2": Classic2Network,
    "classic3": Classic3Network,
    "compass": CompassNetwork,
    "complementary": ComplementaryNetwork,
    "pole2": Pole2Network,
    "unity2": Unity2Network,
    "custom": CustomNetwork,
}
"""All networks by id, in the order in which the page offers them."""

Network = Annotated[
    UndampedNetwork
    | Classic2Network
    | Classic3Network
    | CompassNetwork
    | ComplementaryNetwork
    | Pole2Network
    | Unity2Network
    | CustomNetwork,
    Field(discriminator="id"),
]
"""Type of a field that holds any network, told apart by ``id``."""
