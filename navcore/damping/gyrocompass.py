"""A gyrocompass while navigating: the azimuth loop of the alignment on the log (theory.md 3.8)."""

from collections.abc import Iterator
from typing import ClassVar

from navcore.damping.base import Configured, Need
from navcore.damping.external import External
from navcore.damping.whole import AZIMUTH_NEEDS
from navcore.foundation.earth import SEMI_MAJOR_AXIS
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import Parameters, quantity
from navcore.foundation.text import Text
from navcore.networks.azimuth_loop import AzimuthGains, azimuth_gains


class Gyrocompass(Parameters):
    """Azimuth loop on the north channel's difference to the log (theory.md 3.8)."""

    sigma: float = quantity(
        0.002,
        unit="1/s",
        gt=0.0,
        le=1.0,
        slider=(1e-4, 0.05),
        log=True,
        label=Text("gyrocompass σ"),
        help=Text("Decay rate of the azimuth loop."),
    )
    xi: float = quantity(
        0.707,
        gt=0.0,
        le=5.0,
        slider=(0.2, 2.0),
        label=Text("gyrocompass ζ"),
        help=Text("Damping ratio of the azimuth loop."),
    )


class GyrocompassExternal(External):
    """External damping of the east channel; the north channel drives the azimuth loop."""

    needs: ClassVar[tuple[Need, ...]] = (*External.needs, *AZIMUTH_NEEDS)

    def azimuth(self, method: Configured, omega_s: float) -> AzimuthGains | None:
        """Gains at the site."""
        own = method.gyrocompass
        if own is None:
            return None
        return azimuth_gains(own.sigma, own.xi, omega_s, omega_s**2 * SEMI_MAJOR_AXIS)

    def faults(self, method: Configured, law_step_s: float) -> Iterator[Fault]:
        """Refuse also an azimuth network beside it, and a loop too fast for the law's step."""
        yield from super().faults(method, law_step_s)
        if method.azimuth.id != "none":
            reason = Text("must be left out beside gyrocompass: one azimuth channel has one loop")
            yield Fault("", "azimuth.id", method.azimuth.id, reason)
        if method.policy.changes_input:
            reason = Text("must be another beside gyrocompass, which has no internal damping")
            yield Fault("", "policy.id", method.policy.id, reason)
        own = method.gyrocompass
        if own is not None and own.sigma * law_step_s > _FASTEST:
            reason = Text(
                "must be <= {limit:g} 1/s at a law step of {step:g} s",
                limit=_FASTEST / law_step_s,
                step=law_step_s,
            )
            yield Fault("", "gyrocompass.sigma", own.sigma, reason)


_FASTEST = 0.1
"""Decay rate times the law's step up to which the loop is sampled well."""
