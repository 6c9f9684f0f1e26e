"""A gyrocompass while navigating: the azimuth loop of the alignment on the log (theory.md 3.8)."""

from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from navcore.damping.base import Configured, Need
from navcore.damping.external import External
from navcore.damping.whole import AZIMUTH_NEEDS
from navcore.foundation.earth import SEMI_MAJOR_AXIS, SPHERE
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import Parameters, quantity
from navcore.foundation.text import Text
from navcore.networks.azimuth_loop import AzimuthGains, azimuth_gains, azimuth_polynomial


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
    k1: float | None = quantity(
        None,
        unit="1/s",
        ge=0.0,
        le=10.0,
        slider=(1e-4, 0.1),
        log=True,
        label=Text("gyrocompass K_U1"),
        help=Text("Velocity feedback (Deng 2019, section II B); when not given, 2σ."),
    )
    k2: float | None = quantity(
        None,
        ge=-1.0,
        le=1e6,
        slider=(0.1, 1e3),
        log=True,
        label=Text("gyrocompass K_U2"),
        help=Text(
            "Extra gain of the turn by the velocity (Deng 2019, section II B); when not given, "
            "2σ²/(ζ² ωₛ²) - 1."
        ),
    )
    k3: float | None = quantity(
        None,
        unit="rad/(m s)",
        gt=0.0,
        le=1.0,
        slider=(1e-14, 1e-6),
        log=True,
        label=Text("gyrocompass K_U3"),
        help=Text(
            "Gain of the turn about the vertical (Deng 2019, section II B); when not given, σ⁴/(ζ⁴ g)."
        ),
    )
    k4: float | None = quantity(
        None,
        unit="1/s",
        gt=0.0,
        le=10.0,
        slider=(1e-4, 0.1),
        log=True,
        label=Text("gyrocompass K_U4"),
        help=Text("Decay rate of the turn about the vertical (Deng 2019, section II B); when not given, 2σ."),
    )

    def gains(self, omega_s: float, gravity: float) -> AzimuthGains:
        """K_U1 to K_U4 as given, those left out from sigma and xi; omega_s in rad/s, gravity in m/s^2."""
        made = azimuth_gains(self.sigma, self.xi, omega_s, gravity)
        own = {name: value for name in AzimuthGains._fields if (value := getattr(self, name)) is not None}
        return made._replace(**own)


class GyrocompassExternal(External):
    """External damping of the east channel; the north channel drives the azimuth loop."""

    needs: ClassVar[tuple[Need, ...]] = (*External.needs, *AZIMUTH_NEEDS)

    def azimuth(self, method: Configured, omega_s: float) -> AzimuthGains | None:
        """Gains at the site."""
        own = method.gyrocompass
        if own is None:
            return None
        return own.gains(omega_s, omega_s**2 * SEMI_MAJOR_AXIS)

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
        for name in ("k1", "k4"):
            rate = None if own is None else getattr(own, name)
            if rate is not None and rate * law_step_s > 2.0 * _FASTEST:
                reason = Text(
                    "must be <= {limit:g} 1/s at a law step of {step:g} s",
                    limit=2.0 * _FASTEST / law_step_s,
                    step=law_step_s,
                )
                yield Fault("", f"gyrocompass.{name}", rate, reason)

    def notices(self, method: Configured) -> Iterator[str]:
        """Yield also that gains of one's own leave the heading's loop unstable."""
        yield from super().notices(method)
        own = method.gyrocompass
        if own is None:
            return
        omega_s = SPHERE.schuler_frequency(0.0)
        gravity = omega_s**2 * SEMI_MAJOR_AXIS
        poles = np.roots(azimuth_polynomial(own.gains(omega_s, gravity), omega_s, gravity))
        if poles.real.max() >= 0.0:
            yield Text("gyrocompass: with these K_U the loop of the heading is unstable")


_FASTEST = 0.1
"""Decay rate times the law's step up to which the loop is sampled well."""
