"""The registry of networks and the type of a field that holds any of them."""

from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

from pydantic import BeforeValidator

from navcore.foundation.registry import registry
from navcore.networks.base import NetworkParameters
from navcore.networks.pasted import is_pasted, pasted

NETWORKS = registry(
    NetworkParameters,
    "id",
    "navcore.networks.undamped:UndampedNetwork",
    "navcore.networks.classic:Classic2Network",
    "navcore.networks.classic:Classic3Network",
    "navcore.networks.compass:CompassNetwork",
    "navcore.networks.complementary:ComplementaryNetwork",
    "navcore.networks.pole2:Pole2Network",
    "navcore.networks.unity2:Unity2Network",
    "navcore.networks.optimal:OptimalNetwork",
    "navcore.networks.custom:CustomNetwork",
)
"""All networks by id, in the order in which the page offers them."""


def network_type() -> Any:
    """Type of a field that holds any network, told apart by ``id``, as of now."""
    return Annotated[
        NETWORKS.field_type,
        BeforeValidator(
            lambda value: pasted(value) if isinstance(value, str) and is_pasted(value) else value
        ),
    ]


if TYPE_CHECKING:
    Network: TypeAlias = NetworkParameters
    """Type of a field that holds any network, told apart by ``id``."""
