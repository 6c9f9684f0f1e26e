"""The scenario: joins the parameter models of the parts (schema 1) and checks what only the whole can tell."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

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
from navcore.parameters import Parameters, quantity
from navcore.sensors.imu import Imu
from navcore.sensors.reference import LogEvent, Reference
from navcore.units import ARCMIN, ARCSEC, DEG, HOUR

SCHEMA = 1
MAX_STEPS = 3_000_000
"""About 35 days at 1 s: bounds the memory of a run to some hundred MB and its time to seconds."""
MAX_METHODS = 12

Text = Field(default="", max_length=300)


class RunSettings(Parameters):
    """Block ``run``: fidelity, duration, steps, seed, Earth."""

    fidelity: Literal["channel", "error_model"] = Field(
        "error_model", description="channel: two decoupled level channels; error_model: the full linear model."
    )
    duration_h: float = quantity(
        10.0, unit="h", gt=0.0, le=8760.0, slider=(0.5, 72.0), log=True, label="duration", help="Length of the run."
    )
    step_s: float = quantity(
        1.0, unit="s", ge=0.005, le=10.0, label="step", help="Integration step; the law runs at the same step."
    )
    rate_hz: float = quantity(100.0, unit="Hz", ge=1.0, le=1000.0, help="IMU rate of a strapdown run.")
    output_step_s: float = quantity(
        10.0, unit="s", gt=0.0, le=86400.0, label="output step", help="Interval of the output rows."
    )
    seed: int = Field(1, ge=0, le=2**31 - 1, description="Seed of every random number of the run.")
    earth: Literal["wgs84", "sphere"] = Field("wgs84", description="Earth model; the sphere is for textbook formulas.")


class SiteSettings(Parameters):
    """Block ``site``: where the motion starts."""

    lat_deg: float = quantity(
        32.06, unit="deg", ge=-89.0, le=89.0, slider=(-80.0, 80.0), label="latitude", help="Geodetic latitude."
    )
    lon_deg: float = quantity(118.8, unit="deg", ge=-180.0, le=180.0, label="longitude", help="Longitude.")
    height_m: float = quantity(0.0, unit="m", ge=-500.0, le=20000.0, label="height", help="Height above the ellipsoid.")

    def site(self) -> Site:
        """Start position in SI."""
        return Site(self.lat_deg * DEG, self.lon_deg * DEG, self.height_m)


class Alignment(Parameters):
    """Block ``alignment``: navigation starts from ``initial_error`` directly."""

    kind: Literal["none"] = "none"
    duration_s: float = quantity(600.0, unit="s", gt=0.0, le=86400.0, help="Length of the alignment, before t = 0.")


class InitialError(Parameters):
    """Block ``initial_error``: computed minus true at t = 0."""

    attitude_arcmin: tuple[float, float, float] = Field(
        (0.0, 0.0, 0.0), description="phi_E, phi_N, phi_U, arcmin; each within +-600."
    )
    velocity_mps: tuple[float, float] = Field((0.0, 0.0), description="dV_E, dV_N, m/s; each within +-100.")
    position_arcsec: tuple[float, float] = Field(
        (0.0, 0.0), description="Latitude, longitude, arcsec; each within +-36000."
    )

    def state(self) -> list[float]:
        """Seven error states in SI: dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U."""
        angles = [value * ARCMIN for value in self.attitude_arcmin]
        return [*self.velocity_mps, *(value * ARCSEC for value in self.position_arcsec), *angles]

    def faults(self) -> Iterator[Fault]:
        """Range of each element."""
        for name, limit, unit in (
            ("attitude_arcmin", 600.0, "arcmin"),
            ("velocity_mps", 100.0, "m/s"),
            ("position_arcsec", 36000.0, "arcsec"),
        ):
            for i, value in enumerate(getattr(self, name)):
                if abs(value) > limit:
                    allowed = f"must be >= -{limit:g} and <= {limit:g} ({unit})"
                    yield Fault("", f"initial_error.{name}.{i}", value, allowed)


class View(Parameters):
    """Block ``view``: where the dashboard opens."""

    focus: Literal["errors", "bode", "step"] = "errors"


class Method(Parameters):
    """One ``[[method]]``: a way of damping, run on the same truth, IMU and log as the others."""

    name: str = Field("", max_length=60, description="Name on plots and in files; made from the network when empty.")
    damping: Literal["free", "internal", "external"] = Field(
        "free", description="free: none; internal: own velocity; external: against the reference velocity."
    )
    network: Network = Field(default_factory=UndampedNetwork)
    policy: Policy = Field(default_factory=Constant)
    switching: Switching = Field(default_factory=Hard)
    event: tuple[LogEvent, ...] = Field(
        (), max_length=50, description="Log events that only this method sees: several cases in one scenario."
    )

    def label(self) -> str:
        """Name, or one made from the damping and network."""
        if self.name:
            return self.name
        return "free" if self.damping == "free" else f"{self.network.id} ({self.damping})"


class Scenario(Parameters):
    """A complete, checked scenario. Build it with `Scenario.parse` or `navcore.scenario_file.load`."""

    schema_version: Literal[1] = Field(SCHEMA, alias="schema")
    title: str = Text
    source: str = Text
    run: RunSettings = RunSettings()
    site: SiteSettings = SiteSettings()
    motion: Motion = Field(default_factory=StaticMotion)
    imu: Imu = Imu()
    alignment: Alignment = Alignment()
    initial_error: InitialError = InitialError()
    reference: Reference = Reference()
    method: tuple[Method, ...] = Field((Method(name="free"),), min_length=1, max_length=MAX_METHODS)
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
            yield Fault("", "run.duration_h", run.duration_h, f"must hold at least one step of {run.step_s:g} s")
        if self.steps > MAX_STEPS:
            yield Fault(
                "", "run.duration_h", run.duration_h,
                f"{run.duration_h * HOUR / run.step_s:.3g} steps of {run.step_s:g} s: at most {MAX_STEPS} are run",
            )  # fmt: skip
        yield from self.initial_error.faults()
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
            yield Fault("", f"{at}.damping", "external", 'needs a reference velocity: reference.kind must not be "none"')
        if method.policy.needs_reference and method.damping != "free" and scenario.reference.kind == "none":
            yield Fault(
                "", f"{at}.policy.id", method.policy.id, 'needs a reference velocity: reference.kind must not be "none"'
            )
        if method.event and scenario.reference.kind != "log":
            yield Fault("", f"{at}.event", None, 'needs reference.kind = "log"')
        try:
            method.network.transfer(scenario.omega_s)
        except InputError as error:
            yield from error.located("", f"{at}.network.").faults
