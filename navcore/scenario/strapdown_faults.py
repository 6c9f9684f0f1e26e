"""Faults of the fields that concern a strapdown run only."""

from collections.abc import Iterator

from navcore.alignment.loop import check_latitude
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.motion import MOTIONS
from navcore.scenario.fields import ScenarioFields
from navcore.scenario.sampling import rate_faults

MAX_SAMPLES = 100_000_000
"""Most IMU samples in a run: eleven days at 100 Hz, about 20 s of computing."""
MAX_ALIGNMENT_SAMPLES = 1_500_000
"""Most IMU samples in an alignment, which are all held in memory: 72 MB."""
MAX_LOG_SAMPLES = 10_000_000
"""Most epochs of a simulated log: 0.5 GB."""
_FASTEST_LOOP = 0.1
"""Largest decay rate of the compass loop (1/s), as a part of the IMU's rate (Hz)."""


def strapdown_faults(scenario: ScenarioFields) -> Iterator[Fault]:
    """Yield the faults of rates, lengths, alignment and recorded IMU.

    Under another fidelity these fields are faults themselves when they are set.
    """
    if not scenario.strapdown:
        yield from _out_of_place(scenario)
        return
    yield from _recorded_faults(scenario)
    yield from _length_faults(scenario)
    if scenario.motion.dives and scenario.run.vertical == "locked" and scenario.imu.file is None:
        allowed = Text(
            'must be "altimeter", a depth gauge say: the motion changes its depth (motion.leg.depth_m)'
        )
        yield Fault("", "run.vertical", "locked", allowed)
    if scenario.imu.file is None:
        yield from rate_faults(scenario.motion, scenario.run.rate_hz)
    if scenario.alignment.kind == "compass":
        yield from _alignment_faults(scenario)


def _out_of_place(scenario: ScenarioFields) -> Iterator[Fault]:
    run, fidelity = scenario.run, scenario.run.fidelity
    needs = Text('needs run.fidelity = "strapdown", which is "{fidelity}"', fidelity=fidelity)
    if scenario.alignment.kind != "none":
        yield Fault("", "alignment.kind", scenario.alignment.kind, needs)
    if scenario.imu.file is not None:
        yield Fault("", "imu.file", scenario.imu.file, needs)
    if run.vertical != "locked":
        yield Fault("", "run.vertical", run.vertical, needs)
    if not run.compensation:
        yield Fault("", "run.compensation", run.compensation, needs)


def _recorded_faults(scenario: ScenarioFields) -> Iterator[Fault]:
    imu, motion = scenario.imu, scenario.motion
    if imu.file is not None and not motion.carries_recorded_imu:
        able = " or ".join(f'"{kind}"' for kind, model in MOTIONS.items() if model.carries_recorded_imu)
        yield Fault(
            "", "motion.kind", motion.kind, Text("must be {able} with a recorded IMU (imu.file)", able=able)
        )
    if imu.file is None and imu.begin_s > 0.0:
        yield Fault("", "imu.begin_s", imu.begin_s, Text("needs a recorded IMU: imu.file"))


def _length_faults(scenario: ScenarioFields) -> Iterator[Fault]:
    run, log = scenario.run, scenario.reference
    rates = scenario.sampling
    recorded = scenario.imu.file is not None
    if rates.samples > MAX_SAMPLES and not recorded:
        yield Fault(
            "",
            "run.duration_h",
            run.duration_h,
            Text(
                "is {samples:.3g} samples at {rate_hz:g} Hz; at most {max_samples}",
                samples=rates.samples,
                rate_hz=run.rate_hz,
                max_samples=MAX_SAMPLES,
            ),
        )
    if log.kind == "log" and rates.duration_s * log.rate_hz > MAX_LOG_SAMPLES:
        yield Fault(
            "",
            "reference.rate_hz",
            log.rate_hz,
            Text(
                "gives {duration_s:.3g} log samples in {duration_h:g} h; at most {max_log_samples}",
                duration_s=rates.duration_s * log.rate_hz,
                duration_h=run.duration_h,
                max_log_samples=MAX_LOG_SAMPLES,
            ),
        )


def _alignment_faults(scenario: ScenarioFields) -> Iterator[Fault]:
    alignment, rate = scenario.alignment, scenario.run.rate_hz
    try:
        check_latitude(scenario.site.lat_deg * DEG)
    except InputError as error:
        yield from error.faults
    if alignment.duration_s * rate > MAX_ALIGNMENT_SAMPLES:
        longest = MAX_ALIGNMENT_SAMPLES / rate
        yield Fault(
            "",
            "alignment.duration_s",
            alignment.duration_s,
            Text("must be <= {longest:g} (s) at {rate:g} Hz", longest=longest, rate=rate),
        )
    quickest = _FASTEST_LOOP * rate * min(1.0, alignment.xi)
    for name in ("level_sigma", "sigma"):
        value = getattr(alignment, name)
        if value > quickest:
            yield Fault(
                "",
                f"alignment.{name}",
                value,
                Text(
                    "must be <= {quickest:g} (1/s) at {rate:g} Hz: the loop is too fast",
                    quickest=quickest,
                    rate=rate,
                ),
            )
