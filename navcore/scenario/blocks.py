"""Blocks of a scenario that belong to no other room: run, site, alignment, view."""

from collections.abc import Iterator
from typing import Literal

from pydantic import Field

from navcore.alignment.loop import SHORTEST_COARSE_S, CompassLoop
from navcore.averaging import AlignmentMotion
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import Parameters, choice, quantity
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.foundation.units import DEG
from navcore.motion.truth import Site


class RunSettings(EitherUnit):
    """Block ``run``: fidelity, duration, steps, seed, Earth."""

    fidelity: Literal["channel", "error_model", "strapdown"] = choice(
        "error_model",
        help=Text(
            "channel: two decoupled level channels; error_model: the full linear model; strapdown: the full "
            "nonlinear mechanization on simulated or recorded IMU samples."
        ),
    )
    duration_h: float = quantity(
        10.0,
        unit="h",
        gt=0.0,
        le=8760.0,
        slider=(0.5, 72.0),
        log=True,
        label=Text("duration"),
        help=Text(
            "Length of the run. At most 3,000,000 steps (833 h at 1 s, 8333 h at 10 s; in strapdown, "
            "recorded states): truth, sensor errors and log are kept for every step, up to 0.5 kB a step. At "
            "most 12 methods run side by side."
        ),
    )
    step_s: float = quantity(
        1.0,
        unit="s",
        ge=0.005,
        le=10.0,
        label=Text("step"),
        help=Text(
            "Integration step; the law runs at the same step. strapdown: interval of the recorded states, "
            "and of the law unless a log is faster (rounded to whole samples)."
        ),
    )
    rate_hz: float = quantity(
        100.0,
        unit="Hz",
        ge=10.0,
        le=1000.0,
        label=Text("IMU rate"),
        help=Text("IMU rate of a strapdown run; a recorded IMU has its own."),
    )
    vertical: Literal["locked", "altimeter"] = choice(
        "locked",
        help=Text(
            "Vertical channel of a strapdown run. locked: height held, no vertical velocity (a ship); "
            "altimeter: damped by an altimeter without error (third order, 100 s)."
        ),
    )
    compensation: bool = Field(
        default=True,
        strict=True,
        description=Text("Coning and sculling compensation of a strapdown run."),
        json_schema_extra={"label": Text("coning and sculling compensation")},
    )
    output_step_s: float = quantity(
        10.0,
        unit="s",
        gt=0.0,
        le=86400.0,
        label=Text("output step"),
        help=Text("Interval of the output rows."),
    )
    seed: int = Field(
        default=1,
        strict=True,
        ge=0,
        le=2**31 - 1,
        description=Text("Seed of every random number of the run."),
    )
    earth: Literal["wgs84", "sphere"] = choice(
        "wgs84", help=Text("Earth model; the sphere is for textbook formulas.")
    )


class SiteSettings(Parameters):
    """Block ``site``: where the motion starts."""

    lat_deg: float = quantity(
        32.06,
        unit="deg",
        ge=-89.0,
        le=89.0,
        slider=(-80.0, 80.0),
        label=Text("latitude"),
        help=Text("Geodetic latitude."),
    )
    lon_deg: float = quantity(
        118.8, unit="deg", ge=-180.0, le=180.0, label=Text("longitude"), help=Text("Longitude.")
    )
    height_m: float = quantity(
        0.0, unit="m", ge=-500.0, le=20000.0, label="height", help=Text("Height above the ellipsoid.")
    )

    def site(self) -> Site:
        """Start position in SI."""
        return Site(self.lat_deg * DEG, self.lon_deg * DEG, self.height_m)


class Alignment(EitherUnit):
    """Block ``alignment``: how navigation gets its first attitude (strapdown).

    ``compass`` (theory.md 6.1): the compass loop with V_r = 0, first its level channels, then the azimuth,
    on a vehicle that does not travel; ``initial_error`` is what it starts from. With ``coarse_s`` it starts
    from a coarse alignment by the turning gravity vector (Deng 2019, section 3) instead, to which
    ``initial_error`` is added; a recorded IMU always has one. The sensors of the alignment are those of the
    navigation (same biases), so that its result is correlated with their errors.
    """

    kind: Literal["none", "compass"] = choice(
        "none",
        help=Text(
            "none: navigation starts from initial_error at t = 0. compass: initial_error holds at the start "
            "of an alignment before t = 0 (strapdown only; |latitude| <= 85°)."
        ),
    )
    duration_s: float = quantity(
        600.0, unit="s", ge=10.0, le=86400.0, help=Text("Length of the alignment, before t = 0.")
    )
    coarse_s: float = quantity(
        0.0,
        unit="s",
        ge=0.0,
        le=86400.0,
        label=Text("coarse alignment"),
        help=Text(
            "Length of the coarse alignment with which it begins: gravity, which turns with the Earth, gives "
            "up and east. The compass loop has the rest. 0: none, the loop starts from initial_error."
        ),
    )
    level_s: float = quantity(
        120.0, unit="s", gt=0.0, le=86400.0, help=Text("Length of its first part, level channels only.")
    )
    level_sigma: float = quantity(
        0.03,
        unit="1/s",
        gt=0.0,
        le=10.0,
        label=Text("level decay rate σ"),
        help=Text("Decay rate of the level loops in the first part."),
    )
    sigma: float = quantity(
        0.02,
        unit="1/s",
        gt=0.0,
        le=10.0,
        label=Text("decay rate σ"),
        help=Text("Decay rate of level and azimuth loops in the second part."),
    )
    xi: float = quantity(
        0.707, gt=0.0, le=5.0, label=Text("damping ratio ζ"), help=Text("Damping ratio of the loops.")
    )
    motion: tuple[AlignmentMotion, ...] = Field(
        default=(),
        max_length=100,
        description=Text(
            "Small motions of the base in the record from which half-period averaging forecasts."
        ),
    )

    def loop(self) -> CompassLoop:
        """Design of the compass loop."""
        return CompassLoop(self.level_s, self.level_sigma, self.sigma, self.xi)

    def faults(self) -> Iterator[Fault]:
        """Yield the faults of a coarse alignment and of motions that do not lie within the alignment."""
        if 0.0 < self.coarse_s < SHORTEST_COARSE_S:
            allowed = Text(
                "must be 0 or >= {shortest:g} (s): in less, gravity turns too little with the Earth",
                shortest=SHORTEST_COARSE_S,
            )
            yield Fault("", "alignment.coarse_s", self.coarse_s, allowed)
        elif self.kind == "compass" and self.coarse_s >= self.duration_s:
            allowed = Text(
                "must be < {duration_s:g} (s), the length of the whole alignment: the compass loop needs the "
                "rest",
                duration_s=self.duration_s,
            )
            yield Fault("", "alignment.coarse_s", self.coarse_s, allowed)
        for i, motion in enumerate(self.motion):
            if motion.t_s < -self.duration_s:
                yield Fault(
                    "",
                    f"alignment.motion.{i}.t_s",
                    motion.t_s,
                    Text(
                        "must be >= {duration_s:g} (s): the alignment begins there",
                        duration_s=-self.duration_s,
                    ),
                )
            elif motion.t_s + motion.duration_s > 0.0:
                yield Fault(
                    "",
                    f"alignment.motion.{i}.duration_s",
                    motion.duration_s,
                    Text("must be <= {t_s:g} (s): navigation starts at 0", t_s=-motion.t_s),
                )


class View(Parameters):
    """Block ``view``: where the dashboard opens."""

    focus: Literal["errors", "bode", "step"] = choice(
        "errors", help=Text("Which panel the dashboard brings to the front.")
    )
