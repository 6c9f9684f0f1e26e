"""Fields of a scenario and what follows from them; `navcore.scenario.model` checks the whole."""

from collections.abc import Iterator
from functools import lru_cache
from typing import Any, Literal

from pydantic import Field

from navcore.foundation.earth import EARTHS, Earth
from navcore.foundation.parameters import Parameters
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.motion import Motion, StaticMotion
from navcore.networks.lqg import SensorFigures
from navcore.scenario.blocks import Alignment, RunSettings, SiteSettings, View
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.scenario.own_ins import REPLACED, Ins, TruthFile
from navcore.scenario.requirement import MOST, Requirement
from navcore.scenario.sampling import Sampling, sampling
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference

SCHEMA = 1


class ScenarioFields(Parameters):
    """Blocks of a scenario, each checked by itself."""

    schema_version: Literal[1] = Field(
        default=SCHEMA, alias="schema", description=Text("Version of this format.")
    )
    title: str = Field(default="", max_length=300, description=Text("What the scenario shows, in one line."))
    source: str = Field(
        default="", max_length=300, description=Text("Where it is from: paper and figure, say.")
    )
    run: RunSettings = RunSettings()
    site: SiteSettings = SiteSettings()
    motion: Motion = Field(default_factory=StaticMotion)
    imu: Imu = Imu()
    alignment: Alignment = Alignment()
    initial_error: InitialError = InitialError()
    ins: Ins = Ins()
    truth: TruthFile = TruthFile()
    reference: Reference = Reference()
    method: tuple[Method, ...] = (Method(name="free"),)
    requirement: tuple[Requirement, ...] = Field(
        default=(), max_length=MOST, description=Text("Limits that a design has to keep.")
    )
    view: View = View()

    def figures(self) -> SensorFigures:
        """Random errors of gyros, accelerometers and log, SI."""
        return _figures(self.imu, self.reference)  # pyright: ignore[reportArgumentType]

    @property
    def on_ins(self) -> bool:
        """Whether it runs on the output of a ship's own INS."""
        return self.ins.file is not None

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
    def law_step_s(self) -> float:
        """Time between two calls of the law, s (a recorded IMU has its own)."""
        return self.sampling.law_step_s if self.strapdown else self.run.step_s

    @property
    def steps(self) -> int:
        """Whole integration steps within the duration; of a strapdown run the recorded intervals."""
        if self.strapdown:
            return self.sampling.records
        return int(self.run.duration_h * HOUR / self.run.step_s + 1e-9)

    def canonical(self) -> dict[str, Any]:
        """Complete mapping of every field, as written to scenario.toml (None left out)."""
        left_out = {name for name, used in self._blocks_in_use() if not used}
        return self.model_dump(mode="json", by_alias=True, exclude_none=True, exclude=left_out)

    def _blocks_in_use(self) -> Iterator[tuple[str, bool]]:
        """Yield blocks that few scenarios have, and those whose place ``[ins]`` takes."""
        own = self.on_ins
        yield "requirement", bool(self.requirement)
        yield "ins", own
        yield "truth", own and self.truth.file is not None
        yield from ((name, not own) for name in REPLACED)


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
