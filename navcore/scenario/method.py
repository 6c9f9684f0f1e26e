"""Block ``[[method]]``: a way of damping."""

from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field, create_model

from navcore.damping import GYROCOMPASS, KINDS, WHOLE
from navcore.damping.base import Damping
from navcore.damping.gyrocompass import Gyrocompass
from navcore.foundation.parameters import Parameters
from navcore.foundation.text import Text
from navcore.law.policy import Policy
from navcore.law.policy.constant import Constant
from navcore.law.switching import Switching
from navcore.law.switching.hard import Hard
from navcore.networks import Network
from navcore.networks.undamped import UndampedNetwork
from navcore.sensors.log_errors.events import LogEvent

if TYPE_CHECKING:
    KindName = str
else:
    KindName = Literal[tuple(KINDS)]


class _Named(Parameters):
    name: str = Field(
        default="",
        max_length=60,
        description=Text("Name on plots and in files; made from the network when empty."),
    )
    damping: KindName = Field(
        default=next(iter(KINDS)),
        description=Text.joined(
            "; ", (Text("{id}: {help}", id=kind.id, help=kind.help) for kind in KINDS.values())
        )
        + ".",
    )


if TYPE_CHECKING:
    _Settled = _Named
else:
    _Settled = create_model(
        "_Settled",
        __base__=_Named,
        **{kind.id: (kind.settings, kind.settings()) for kind in KINDS.values() if kind.settings},
    )


class Method(_Settled):
    """One ``[[method]]``: a way of damping, run on the same truth, IMU and log as the others."""

    network: Network = Field(default_factory=UndampedNetwork)
    azimuth: Network = Field(
        default_factory=UndampedNetwork,
        json_schema_extra={"label": "azimuth network"},
        description=Text(
            "Network Y(s) of the azimuth channel beside the level networks (whole damping), at the Earth's "
            "rate in place of the Schuler frequency; none: the azimuth is not damped."
        ),
    )
    gyrocompass: Gyrocompass | None = Field(
        default=None,
        json_schema_extra={"label": "gyrocompass"},
        description=Text(
            "Azimuth loop on the north channel's difference to the log (gyrocompass during navigation); the "
            "network then damps the east channel only. Not together with azimuth."
        ),
    )
    policy: Policy = Field(default_factory=Constant)
    switching: Switching = Field(default_factory=Hard)
    event: tuple[LogEvent, ...] = Field(
        default=(),
        max_length=50,
        description=Text("Log events that only this method sees: several cases in one scenario."),
    )

    @property
    def kind(self) -> Damping:
        """Kind of damping."""
        if self.gyrocompass is not None and self.damping == GYROCOMPASS.id:
            return GYROCOMPASS
        whole = WHOLE.get(self.damping) if self.azimuth.id != "none" else None
        return whole or KINDS[self.damping].of(self)

    @property
    def reads_log(self) -> bool:
        """Whether the log changes a run of the method."""
        return self.kind.reads_log(self)

    @property
    def settings(self) -> Any:
        """Parameters of the kind's own; None where it has none."""
        return getattr(self, self.damping, None)

    @property
    def undamped(self) -> bool:
        """Whether the network does not act."""
        return not self.kind.uses_network

    def label(self) -> str:
        """Name, or one made from the damping and network."""
        return self.name or self.kind.label(self)
