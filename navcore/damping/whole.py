"""Whole damping: a network Y(s) in the azimuth channel beside those of the level channels (theory.md 3.7)."""

from collections.abc import Iterator
from typing import ClassVar

from navcore.damping.base import Configured, Need, NetworkDamping
from navcore.damping.external import External
from navcore.damping.internal import Internal
from navcore.foundation.earth import EARTH_RATE, SPHERE
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR
from navcore.networks.base import LinearNetwork

_UNITY = 1e-3
"""How far Y(0) may lie from 1."""


class _Whole(NetworkDamping):
    def azimuth(self, method: Configured, omega_s: float) -> LinearNetwork | None:
        """Y(s) at Omega."""
        return method.azimuth.at_earth_rate()

    def faults(self, method: Configured, law_step_s: float) -> Iterator[Fault]:
        """Refuse also what is no network Y(s), and an internal one that leaves a part of the Earth's rate."""
        yield from super().faults(method, law_step_s)
        try:
            network = method.azimuth.at_earth_rate()
        except InputError as error:
            yield from error.located("", "azimuth.").faults
            return
        if network.feedback_p is not None:
            reason = Text("must be a network with one output: its velocity feedback has no azimuth channel")
            yield Fault("", "azimuth.id", network.id, reason)
        elif not network.poles.real.max(initial=-1.0) < 0.0:
            reason = Text("must have poles with a negative real part only")
            yield Fault("", "azimuth.id", network.id, reason)
        elif abs(network.h0 - 1.0) > _UNITY and (not self.uses_log or method.policy.changes_input):
            reason = Text(
                "must have Y(0) = 1 within {unity:g} with internal damping, not {h0:.4g}: a part of the "
                "Earth's rate would be left out",
                unity=_UNITY,
                h0=network.h0,
            )
            yield Fault("", "azimuth.id", network.id, reason)

    def notices(self, method: Configured) -> Iterator[str]:
        """Yield also what is left undamped, and what the azimuth network costs."""
        yield from super().notices(method)
        network = method.azimuth.at_earth_rate()
        if method.network.id == "none":
            yield Text(
                "azimuth network without level damping: it makes the Schuler oscillations grow; choose a "
                "level network"
            )
        elif self.uses_log and self.network(method).external_form == "feedback":
            yield Text(
                "azimuth network: velocity feedback leaves no slow oscillation, so that the azimuth network "
                'changes nothing; choose network.realisation = "network"'
            )
        if self.uses_log and abs(network.h0 - 1.0) > _UNITY:
            yield Text(
                "azimuth network: Y(0) = {h0:.4g} is not 1, so that a standing error of the log turns the "
                "heading",
                h0=network.h0,
            )
        if not self.uses_log:
            yield Text(
                "internal azimuth network: a speed V north leaves a heading rate Y'(0) Ω cos L V/R, "
                "Y'(0) = {slope:.5g} s: {rate:.3g} °/h times cos L for each m/s",
                slope=network.h_slope,
                rate=network.h_slope * EARTH_RATE / SPHERE.radii(0.0)[0] / DEG_PER_HOUR,
            )


AZIMUTH_NEEDS = (
    Need(
        "coupled channels",
        Text(
            'needs run.fidelity "error_model" or "strapdown" for its azimuth channel: one channel has no '
            "heading"
        ),
    ),
    Need("below 85 deg", Text("needs abs(site.lat_deg) <= 85 for its azimuth channel")),
)
"""Conditions of whatever acts in the azimuth channel."""


class WholeExternal(_Whole, External):
    """External damping of level channels and azimuth."""

    needs: ClassVar[tuple[Need, ...]] = (*External.needs, *AZIMUTH_NEEDS)


class WholeInternal(_Whole, Internal):
    """Internal damping of level channels and azimuth."""

    needs: ClassVar[tuple[Need, ...]] = (*Internal.needs, *AZIMUTH_NEEDS)
