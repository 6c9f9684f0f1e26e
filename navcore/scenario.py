"""The scenario: joins the parameter models of the parts, checks what only the whole can tell."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from navcore.control.policy import Policy
from navcore.control.policy.constant import Constant
from navcore.control.switching import Switching
from navcore.control.switching.hard import Hard
from navcore.earth import EARTHS, Earth
from navcore.errors import Fault, InputError
from navcore.faults import faults_from
from navcore.motion import Motion, StaticMotion
from navcore.motion.base import Site
from navcore.network import Network
from navcore.network.undamped import UndampedNetwork
from navcore.parameters import Parameters, bounded, choice, quantity, vector_quantity
from navcore.sensors.imu import Imu
from navcore.sensors.reference import LogEvent, Reference
from navcore.units import ARCMIN, ARCSEC, DEG, HOUR

SCHEMA = 1
MAX_STEPS = 3_000_000
"""About 35 days at 1 s: bounds a run to seconds, and its memory to 0.3 GB (1.6 GB along a moving truth)."""
MAX_METHODS = 12


class RunSettings(Parameters):
    """Block ``run``: fidelity, duration, steps, seed, Earth."""

    fidelity: Literal["channel", "error_model"] = choice(
        "error_model", help="channel: two decoupled level channels; error_model: the full linear model."
    )
    duration_h: float = quantity(
        10.0,
        unit="h",
        gt=0.0,
        le=8760.0,
        slider=(0.5, 72.0),
        log=True,
        label="duration",
        help="Length of the run.",
    )
    step_s: float = quantity(
        1.0,
        unit="s",
        ge=0.005,
        le=10.0,
        label="step",
        help="Integration step; the law runs at the same step.",
    )
    rate_hz: float = quantity(100.0, unit="Hz", ge=1.0, le=1000.0, help="IMU rate of a strapdown run.")
    output_step_s: float = quantity(
        10.0, unit="s", gt=0.0, le=86400.0, label="output step", help="Interval of the output rows."
    )
    seed: int = Field(
        default=1, strict=True, ge=0, le=2**31 - 1, description="Seed of every random number of the run."
    )
    earth: Literal["wgs84", "sphere"] = choice(
        "wgs84", help="Earth model; the sphere is for textbook formulas."
    )


class SiteSettings(Parameters):
    """Block ``site``: where the motion starts."""

    lat_deg: float = quantity(
        32.06,
        unit="deg",
        ge=-89.0,
        le=89.0,
        slider=(-80.0, 80.0),
        label="latitude",
        help="Geodetic latitude.",
    )
    lon_deg: float = quantity(118.8, unit="deg", ge=-180.0, le=180.0, label="longitude", help="Longitude.")
    height_m: float = quantity(
        0.0, unit="m", ge=-500.0, le=20000.0, label="height", help="Height above the ellipsoid."
    )

    def site(self) -> Site:
        """Start position in SI."""
        return Site(self.lat_deg * DEG, self.lon_deg * DEG, self.height_m)


class Alignment(Parameters):
    """Block ``alignment``: navigation starts from ``initial_error`` directly."""

    kind: Literal["none"] = choice("none", help="none: navigation starts from initial_error at t = 0.")
    duration_s: float = quantity(
        600.0, unit="s", gt=0.0, le=86400.0, help="Length of the alignment, before t = 0."
    )


_Tilt = Annotated[float, bounded(unit="arcmin", ge=-600.0, le=600.0)]
_Velocity = Annotated[float, bounded(unit="m/s", ge=-100.0, le=100.0)]
_Position = Annotated[float, bounded(unit="arcsec", ge=-36000.0, le=36000.0)]


class InitialError(Parameters):
    """Block ``initial_error``: computed minus true at t = 0."""

    attitude_arcmin: tuple[_Tilt, _Tilt, _Tilt] = vector_quantity(
        (0.0, 0.0, 0.0), unit="arcmin", elements=("phi_E", "phi_N", "phi_U"), slider=(-10.0, 10.0),
        label="initial misalignment", help="Misalignment at t = 0.",
    )  # fmt: skip
    velocity_mps: tuple[_Velocity, _Velocity] = vector_quantity(
        (0.0, 0.0), unit="m/s", elements=("E", "N"), slider=(-2.0, 2.0),
        label="initial velocity error", help="Velocity error at t = 0.",
    )  # fmt: skip
    position_arcsec: tuple[_Position, _Position] = vector_quantity(
        (0.0, 0.0), unit="arcsec", elements=("latitude", "longitude"), slider=(-60.0, 60.0),
        label="initial position error", help="Position error at t = 0.",
    )  # fmt: skip

    def state(self) -> list[float]:
        """Seven error states in SI: dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U."""
        angles = [value * ARCMIN for value in self.attitude_arcmin]
        return [*self.velocity_mps, *(value * ARCSEC for value in self.position_arcsec), *angles]


class View(Parameters):
    """Block ``view``: where the dashboard opens."""

    focus: Literal["errors", "bode", "step"] = choice(
        "errors", help="Which panel the dashboard brings to the front."
    )


class Method(Parameters):
    """One ``[[method]]``: a way of damping, run on the same truth, IMU and log as the others."""

    name: str = Field(
        default="", max_length=60, description="Name on plots and in files; made from the network when empty."
    )
    damping: Literal["free", "internal", "external"] = Field(
        default="free",
        description="free: none; internal: own velocity; external: against the reference velocity.",
    )
    network: Network = Field(default_factory=UndampedNetwork)
    policy: Policy = Field(default_factory=Constant)
    switching: Switching = Field(default_factory=Hard)
    event: tuple[LogEvent, ...] = Field(
        default=(),
        max_length=50,
        description="Log events that only this method sees: several cases in one scenario.",
    )

    def label(self) -> str:
        """Name, or one made from the damping and network."""
        if self.name:
            return self.name
        return "free" if self.damping == "free" else f"{self.network.id} ({self.damping})"


class Scenario(Parameters):
    """A complete, checked scenario.

    Build it with `Scenario.parse` or `navcore.scenario_file.load`.
    """

    schema_version: Literal[1] = Field(default=SCHEMA, alias="schema", description="Version of this format.")
    title: str = Field(default="", max_length=300, description="What the scenario shows, in one line.")
    source: str = Field(default="", max_length=300, description="Where it is from: paper and figure, say.")
    run: RunSettings = RunSettings()
    site: SiteSettings = SiteSettings()
    motion: Motion = Field(default_factory=StaticMotion)
    imu: Imu = Imu()
    alignment: Alignment = Alignment()
    initial_error: InitialError = InitialError()
    reference: Reference = Reference()
    method: tuple[Method, ...] = (Method(name="free"),)
    view: View = View()

    @classmethod
    def parse(cls, data: dict[str, Any], where: str = "") -> Scenario:
        """Validate a mapping as read from TOML; names are filled in and made unique.

        Raises
        ------
        InputError
            One fault per field that is wrong, each with value and allowed range.
        """
        try:
            scenario = cls.model_validate(data)
        except ValidationError as error:
            raise InputError(faults_from(error, cls, data, where)) from None
        faults = list(scenario.faults())
        if faults:
            raise InputError(faults).located(where)
        methods = tuple(m.model_copy(update={"name": m.label()}) for m in scenario.method)
        return scenario.model_copy(update={"method": methods})

    @property
    def earth(self) -> Earth:
        """Earth model of the run."""
        return EARTHS[self.run.earth]

    @property
    def omega_s(self) -> float:
        """Schuler frequency of the site, rad/s (contract)."""
        return self.earth.schuler_frequency(self.site.lat_deg * DEG)

    @property
    def steps(self) -> int:
        """Whole integration steps within the duration."""
        return int(self.run.duration_h * HOUR / self.run.step_s + 1e-9)

    def faults(self) -> Iterator[Fault]:
        """What only the whole scenario can tell: lengths, names, missing references, refused networks."""
        run = self.run
        if self.steps < 1:
            yield Fault(
                "", "run.duration_h", run.duration_h, f"must hold at least one step of {run.step_s:g} s"
            )
        if self.steps > MAX_STEPS:
            yield Fault(
                "", "run.duration_h", run.duration_h,
                f"is {run.duration_h * HOUR / run.step_s:.3g} steps of {run.step_s:g} s; at most {MAX_STEPS}",
            )  # fmt: skip
        if not 1 <= len(self.method) <= MAX_METHODS:
            yield Fault("", "method", len(self.method), f"must be 1 to {MAX_METHODS} blocks [[method]]")
        yield from _method_faults(self)

    def canonical(self) -> dict[str, Any]:
        """Complete mapping of every field, as written to scenario.toml (None left out)."""
        return self.model_dump(mode="json", by_alias=True, exclude_none=True)


def _method_faults(scenario: Scenario) -> Iterator[Fault]:
    seen: dict[str, int] = {}
    for i, method in enumerate(scenario.method):
        at = f"method.{i}"
        other = seen.setdefault(method.label(), i)
        if other != i:
            yield Fault("", f"{at}.name", method.label(), f"must differ from the name of method.{other}")
        if method.damping == "external" and scenario.reference.kind == "none":
            yield Fault(
                "",
                f"{at}.damping",
                "external",
                'needs a reference velocity: reference.kind must not be "none"',
            )
        if method.policy.needs_reference and method.damping != "free" and scenario.reference.kind == "none":
            yield Fault(
                "",
                f"{at}.policy.id",
                method.policy.id,
                'needs a reference velocity: reference.kind must not be "none"',
            )
        if method.event and scenario.reference.kind != "log":
            yield Fault("", f"{at}.event", None, 'needs reference.kind = "log"')
        try:
            method.network.transfer(scenario.omega_s)
        except InputError as error:
            yield from error.located("", f"{at}.network.").faults
