"""The scenario: joins the parameter models of the parts, checks what only the whole can tell."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Any, Literal

from pydantic import Field, ValidationError

from navcore.alignment.loop import CompassLoop
from navcore.averaging import AlignmentMotion, Averaging
from navcore.foundation.earth import EARTHS, Earth
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.parameters import Parameters, choice, quantity
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.law.combination import combination_faults
from navcore.law.policy import Policy
from navcore.law.policy.constant import Constant
from navcore.law.switching import Switching
from navcore.law.switching.hard import Hard
from navcore.motion import Motion, StaticMotion
from navcore.motion.base import Site
from navcore.networks import Network
from navcore.networks.lqg import SensorFigures
from navcore.networks.undamped import UndampedNetwork
from navcore.scenario.averaging_faults import averaging_faults
from navcore.scenario.bounds import MAX_METHODS
from navcore.scenario.initial_error import InitialError
from navcore.scenario.kalman_faults import kalman_faults
from navcore.scenario.sampling import Sampling, sampling
from navcore.scenario.strapdown_faults import strapdown_faults
from navcore.sensors.imu import Imu
from navcore.sensors.log_errors.events import LogEvent
from navcore.sensors.reference import Reference

SCHEMA = 1
MAX_STEPS = 3_000_000
"""About 35 days at 1 s: bounds a run to seconds, and its memory to 0.3 GB (1.6 GB along a moving truth)."""
_METHODS_ALLOWED = Text("must be 1 to {max_methods} blocks [[method]]", max_methods=MAX_METHODS)


class RunSettings(Parameters):
    """Block ``run``: fidelity, duration, steps, seed, Earth."""

    fidelity: Literal["channel", "error_model", "strapdown"] = choice(
        "error_model",
        help="channel: two decoupled level channels; error_model: the full linear model; strapdown: the full "
        "nonlinear mechanization on simulated or recorded IMU samples.",
    )
    duration_h: float = quantity(
        10.0,
        unit="h",
        gt=0.0,
        le=8760.0,
        slider=(0.5, 72.0),
        log=True,
        label="duration",
        help="Length of the run. At most 3,000,000 steps (833 h at 1 s, 8333 h at 10 s; in strapdown, "
        "recorded states): truth, sensor errors and log are kept for every step, up to 0.5 kB a step. At "
        "most 12 methods run side by side.",
    )
    step_s: float = quantity(
        1.0,
        unit="s",
        ge=0.005,
        le=10.0,
        label="step",
        help="Integration step; the law runs at the same step. strapdown: interval of the recorded states, "
        "and of the law unless a log is faster (rounded to whole samples).",
    )
    rate_hz: float = quantity(
        100.0,
        unit="Hz",
        ge=10.0,
        le=1000.0,
        label="IMU rate",
        help="IMU rate of a strapdown run; a recorded IMU has its own.",
    )
    vertical: Literal["locked", "altimeter"] = choice(
        "locked",
        help="Vertical channel of a strapdown run. locked: height held, no vertical velocity (a ship); "
        "altimeter: damped by an altimeter without error (third order, 100 s).",
    )
    compensation: bool = Field(
        default=True,
        strict=True,
        description="Coning and sculling compensation of a strapdown run.",
        json_schema_extra={"label": "coning and sculling compensation"},
    )
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
    """Block ``alignment``: how navigation gets its first attitude (strapdown).

    ``compass`` (theory.md 6.1): the compass loop with V_r = 0, first its level channels, then the azimuth,
    on a vehicle that does not travel; ``initial_error`` is what it starts from. With a recorded IMU a coarse
    alignment by the turning gravity vector comes first. The sensors of the alignment are those of the
    navigation (same biases), so that its result is correlated with their errors.
    """

    kind: Literal["none", "compass"] = choice(
        "none",
        help="none: navigation starts from initial_error at t = 0. compass: initial_error holds at the start "
        "of an alignment before t = 0 (strapdown only; |latitude| <= 85°).",
    )
    duration_s: float = quantity(
        600.0, unit="s", ge=10.0, le=86400.0, help="Length of the alignment, before t = 0."
    )
    level_s: float = quantity(
        120.0, unit="s", gt=0.0, le=86400.0, help="Length of its first part, level channels only."
    )
    level_sigma: float = quantity(
        0.03,
        unit="1/s",
        gt=0.0,
        le=10.0,
        label="level decay rate σ",
        help="Decay rate of the level loops in the first part.",
    )
    sigma: float = quantity(
        0.02,
        unit="1/s",
        gt=0.0,
        le=10.0,
        label="decay rate σ",
        help="Decay rate of level and azimuth loops in the second part.",
    )
    xi: float = quantity(0.707, gt=0.0, le=5.0, label="damping ratio ζ", help="Damping ratio of the loops.")
    motion: tuple[AlignmentMotion, ...] = Field(
        default=(),
        max_length=100,
        description="Small motions of the base in the record from which half-period averaging forecasts.",
    )

    def loop(self) -> CompassLoop:
        """Design of the compass loop."""
        return CompassLoop(self.level_s, self.level_sigma, self.sigma, self.xi)


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
    damping: Literal["free", "internal", "external", "averaging", "kalman"] = Field(
        default="free",
        description="free: none; internal: own velocity; external: against the reference velocity; "
        "averaging: none, but copies of the navigation half a period ahead are averaged (Zhao 2015); "
        "kalman: no network, but a Kalman filter that is told the scenario's own figures and measures "
        "against the log (error_model and strapdown).",
    )
    averaging: Averaging = Averaging()
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
        if self.damping == "averaging":
            return Text("averaging ({variant})", variant=self.averaging.variant)
        if self.damping == "kalman":
            return "kalman"
        return "free" if self.undamped else f"{self.network.id} ({self.damping})"

    @property
    def undamped(self) -> bool:
        """Whether no network acts: free, averaging of free copies, and the Kalman filter."""
        return self.damping in ("free", "averaging", "kalman")


class Scenario(Parameters):
    """A complete, checked scenario.

    Build it with `Scenario.parse` or `navcore.scenario.file.load`.
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
        methods = data.get("method")
        if isinstance(methods, list | tuple) and len(methods) > MAX_METHODS:
            raise InputError(Fault(where, "method", len(methods), _METHODS_ALLOWED))
        try:
            scenario = cls.model_validate(data)
        except ValidationError as error:
            raise InputError(faults_from(error, cls, data, where)) from None
        scenario = scenario.with_sensors()
        faults = list(scenario.faults())
        if faults:
            raise InputError(faults).located(where)
        methods = tuple(m.model_copy(update={"name": m.label()}) for m in scenario.method)
        return scenario.model_copy(update={"method": methods})

    def with_sensors(self) -> Scenario:
        """Return the scenario with networks that are designed for its sensors and log."""
        figures = self.figures()
        methods = tuple(
            m.model_copy(update={"network": m.network.with_sensors(figures)}) for m in self.method
        )
        return self.model_copy(update={"method": methods})

    def figures(self) -> SensorFigures:
        """Random errors of gyros, accelerometers and log, SI."""
        return _figures(self.imu, self.reference)  # pyright: ignore[reportArgumentType]

    @property
    def earth(self) -> Earth:
        """Earth model of the run."""
        return EARTHS[self.run.earth]

    @property
    def omega_s(self) -> float:
        """Schuler frequency of the site, rad/s (theory.md 3.6)."""
        return self.earth.schuler_frequency(self.site.lat_deg * DEG)

    @property
    def strapdown(self) -> bool:
        """Whether the full mechanization is asked for."""
        return self.run.fidelity == "strapdown"

    @property
    def sampling(self) -> Sampling:
        """Rates of a strapdown run (a recorded IMU has its own rate)."""
        return sampling(self.run, self.reference)

    @property
    def steps(self) -> int:
        """Whole integration steps within the duration; of a strapdown run the recorded intervals."""
        if self.strapdown:
            return self.sampling.records
        return int(self.run.duration_h * HOUR / self.run.step_s + 1e-9)

    def faults(self) -> Iterator[Fault]:
        """What only the whole scenario can tell: lengths, names, missing references, refused networks."""
        run = self.run
        if self.steps < 1:
            yield Fault(
                "",
                "run.duration_h",
                run.duration_h,
                Text("must hold at least one step of {step_s:g} s", step_s=run.step_s),
            )
        if self.steps > MAX_STEPS:
            yield Fault(
                "",
                "run.duration_h",
                run.duration_h,
                Text(
                    "is {duration_h:.3g} steps of {step_s:g} s; at most {max_steps}",
                    duration_h=run.duration_h * HOUR / run.step_s,
                    step_s=run.step_s,
                    max_steps=MAX_STEPS,
                ),
            )
        if not 1 <= len(self.method) <= MAX_METHODS:
            yield Fault("", "method", len(self.method), _METHODS_ALLOWED)
        yield from _method_faults(self)
        yield from averaging_faults(self)
        yield from kalman_faults(self)
        yield from strapdown_faults(self)

    def canonical(self) -> dict[str, Any]:
        """Complete mapping of every field, as written to scenario.toml (None left out)."""
        return self.model_dump(mode="json", by_alias=True, exclude_none=True)


def _method_faults(scenario: Scenario) -> Iterator[Fault]:
    seen: dict[str, int] = {}
    for i, method in enumerate(scenario.method):
        at = f"method.{i}"
        other = seen.setdefault(method.label(), i)
        if other != i:
            yield Fault(
                "",
                f"{at}.name",
                method.label(),
                Text("must differ from the name of method.{other}", other=other),
            )
        if method.damping == "external" and scenario.reference.kind == "none":
            yield Fault(
                "",
                f"{at}.damping",
                "external",
                'needs a reference velocity: reference.kind must not be "none"',
            )
        if method.policy.needs_reference and not method.undamped and scenario.reference.kind == "none":
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
            continue
        if not method.undamped:
            found = list(
                combination_faults(
                    method.damping, method.network, method.policy, method.switching,
                    scenario.sampling.law_step_s if scenario.strapdown else scenario.run.step_s,
                )
            )  # fmt: skip
            if found:
                yield from InputError(found).located("", f"{at}.").faults


@lru_cache(maxsize=64)
def _figures(imu: Imu, log: Reference) -> SensorFigures:
    gyro, accel = imu.gyro(), imu.accel()
    known = 1.0 if log.kind == "log" else 0.0
    (gyro_drift, gyro_tau_s), (accel_drift, accel_tau_s) = gyro.markov, accel.markov
    return SensorFigures(
        gyro_white=gyro.white,
        gyro_drift=gyro_drift,
        gyro_tau_s=gyro_tau_s,
        accel_white=accel.white,
        accel_drift=accel_drift,
        accel_tau_s=accel_tau_s,
        log_noise=known * log.white,
        log_rate_hz=log.rate_hz,
        log_drift=known * log.markov[0],
        log_tau_s=log.markov[1],
    )
