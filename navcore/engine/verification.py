"""verify(scenario) -> Verification: the linear error model beside the full strapdown, on the same noise.

The strapdown run makes the IMU's samples; what their errors add up to over each step of the linear model is
fed to the error model, which starts from the same errors and sees the same log. The difference is therefore
the linear model's own.
"""

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from navcore.engine.drivers import linear
from navcore.engine.drivers.common import STOPPED, Cancelled, Progress
from navcore.engine.environment import Environment, environment
from navcore.engine.levels import Level, level_text, levels, limit_texts, worst
from navcore.engine.run import MethodRun, Run
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, DEG, HOUR
from navcore.mechanization.recorder import DAMPED_COLUMN
from navcore.motion.truth import LAT
from navcore.quantities import ERRORS, HEADING, NAMES, TILT, RecordedError, components
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors, SensorErrors

TILT_DEG = 1.0
"""Level misalignment from which products of errors count, deg."""
HEADING_DEG = 5.0
"""The same of the heading."""
LATITUDE_DEG = 75.0
"""Latitude from which tan L multiplies position errors too much for a linear model, deg."""
LONG_H = 72.0
"""Length from which small differences of the periods have put the curves out of phase, h."""
OF_PEAK = 0.05
"""Part of a curve's peak from which a difference is reported."""
_STRAPDOWN_SHARE = 0.95
"""Of the time that a verification takes."""
_SMALLEST = {"angle": 0.1 * ARCSEC, "speed": 1e-3, "length": 1.0}
"""Differences below are nobody's concern, however small the peak."""


@dataclass(frozen=True)
class Difference:
    """Strapdown minus linear model in one quantity, over the common output rows.

    Attributes
    ----------
    peak : float
        Largest magnitude of the difference, SI.
    of_peak : float or None
        The same relative to the largest magnitude of the strapdown curve; None where that is zero.
    """

    peak: float
    of_peak: float | None


@dataclass(frozen=True)
class Verification(Answer):
    """Both runs of a scenario and how far they are apart.

    Attributes
    ----------
    strapdown : Run
        With ``run.fidelity = "strapdown"``; its methods carry `MethodRun.navigation`.
    linear : Run
        The error model fed with the same noise, methods in the same order, on the same output times.
    differences : tuple of dict
        For each method: quantity (`navcore.quantities.NAMES`) -> `Difference`. Empty for a method
        of which one of the runs has no two rows.
    levels : tuple of dict
        For each method: quantity -> `navcore.engine.levels.Level`, the second half over all seeds.
    statements : tuple of str
        Plain words: why the linear model is not to be trusted here (tilt, latitude, duration, a method that
        diverged ...); empty when nothing speaks against it.
    stopped : bool
        It was cancelled: both runs hold what was computed.
    """

    strapdown: Run
    linear: Run
    differences: tuple[dict[str, Difference], ...]
    statements: tuple[str, ...]
    stopped: bool = False
    levels: tuple[dict[str, Level], ...] = ()

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        pairs = zip(self.strapdown.methods, self.linear.methods, self.differences, strict=True)
        return {
            "trusted": not self.statements,
            "statements": list(self.statements),
            "methods": [
                {
                    "name": full.method.name,
                    "status": {"strapdown": full.status, "error_model": simple.status},
                    "differences": {name: vars(one) for name, one in difference.items()},
                }
                for full, simple, difference in pairs
            ],
        }

    def rows(self) -> Iterator[Table | str]:
        """Give the largest differences of each method, and why the model is not to be trusted."""
        yield Text("full strapdown minus linear model on the same noise: largest difference")
        heads = [Column(error.symbol, error.kind.unit, 3) for error in ERRORS]
        rows = [
            (
                full.method.name,
                *(difference[error.name].peak / error.kind.size if difference else None for error in ERRORS),
            )
            for full, difference in zip(self.strapdown.methods, self.differences, strict=True)
        ]
        yield Table((Column(Text("method")), *heads), tuple(rows))
        for text in self.statements:
            yield Text("warning: {text}", text=text)


def why_not(scenario: Scenario) -> str:
    """Say why a scenario cannot be verified; empty when it can."""
    if scenario.run.fidelity == "channel":
        return Text(
            'fidelity "channel" leaves the Earth\'s rotation and the heading out, which a strapdown run has: '
            'set run.fidelity to "error_model"'
        )
    if scenario.on_ins:
        return Text(
            "the sensors of a recorded INS stay inside it: there is nothing that a strapdown could run on"
        )
    if scenario.imu.file is not None:
        return Text(
            "a recorded IMU has errors that nobody knows, so that no linear model can be fed with them"
        )
    return ""


def verify(
    scenario: Scenario,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
    seeds: int = 1,
) -> Verification:
    """Run a scenario as full strapdown and as linear error model on the same noise, and compare them.

    A step below one second is raised to one second in both runs.

    Parameters
    ----------
    scenario : Scenario
        Of fidelity ``error_model`` (or ``strapdown``); its ``run.rate_hz`` is the IMU's rate.
    progress : callable, optional
        Called with the fraction done, 0..1, from any thread.
    cancelled : callable, optional
        Asked at least every 60 s of IMU data; True ends both runs, and what was computed is kept.
    seeds : int
        Seeds over which the difference is held against the methods' own level: that of the scenario, which
        the two runs shown are of, and those that follow.

    Raises
    ------
    InputError
        The scenario cannot be verified (`why_not`), or not be run as strapdown: one fault per field.
    """
    full = _as_strapdown(scenario)

    def report(index: int, fraction: float) -> None:
        if progress is not None:
            progress((index + fraction) / seeds)

    first, second = _both(full, lambda fraction: report(0, fraction), cancelled)
    pairs = list(zip(first.methods, second.methods, strict=True))
    of_seeds = [[pair] for pair in pairs]
    for k in range(1, seeds):
        if first.status == "stopped" or (cancelled is not None and cancelled()):
            break
        later = full.run.model_copy(update={"seed": full.run.seed + k})
        strapdown, simple = _both(
            full.model_copy(update={"run": later}), lambda fraction, k=k: report(k, fraction), cancelled
        )
        if strapdown.status != "stopped":
            for held, pair in zip(of_seeds, zip(strapdown.methods, simple.methods, strict=True), strict=True):
                held.append(pair)
    differences = tuple(_differences(*pair) for pair in pairs)
    found = tuple(levels(held) for held in of_seeds)
    return Verification(
        strapdown=first,
        linear=second,
        differences=differences,
        statements=tuple(_statements(scenario, first, pairs, differences, found)),
        stopped=first.status == "stopped",
        levels=found,
    )


def _both(full: Scenario, report: Progress, cancelled: Cancelled | None) -> tuple[Run, Run]:
    """Run a scenario as full strapdown, and as linear model on the noise that this has made."""
    # Only now: the strapdown kernels are slow to import, and the page shows this module's names at once.
    from navcore.engine.drivers import strapdown
    from navcore.engine.strapdown_environment import strapdown_environment

    simple = full.model_copy(update={"run": full.run.model_copy(update={"fidelity": "error_model"})})
    began = time.perf_counter()
    env, flat = strapdown_environment(full), environment(simple)
    sums: list[np.ndarray] = []
    first = strapdown.run_methods(
        full,
        env,
        lambda fraction: report(_STRAPDOWN_SHARE * fraction),
        cancelled,
        began,
        lambda part: sums.append(part.copy()),
    )
    fed = _fed(flat, np.concatenate(sums), full.run.step_s, env.block / env.sampling.rate_hz, env.reference)
    second = _linear_run(simple, fed, env.errors)
    if first.status == "stopped":
        stopped = (replace(m, status="stopped", reason=STOPPED) for m in second.methods)
        second = replace(second, methods=tuple(stopped))
    report(1.0)
    return first, second


def _linear_run(scenario: Scenario, env: Environment, state: np.ndarray) -> Run:
    return linear.run_methods(scenario, env, state, None, None, time.perf_counter())


def _as_strapdown(scenario: Scenario) -> Scenario:
    """Return the scenario with fidelity strapdown and a step of whole blocks of the IMU (about 1 s)."""
    reason, run = why_not(scenario), scenario.run
    if reason:
        field, value = "imu.file", scenario.imu.file
        if value is None:
            field, value = "run.fidelity", run.fidelity
        raise InputError(Fault("", field, value, reason))
    block_s = max(1, round(run.rate_hz)) / run.rate_hz
    step_s = max(1, round(run.step_s / block_s)) * block_s
    full = scenario.model_copy(
        update={"run": run.model_copy(update={"fidelity": "strapdown", "step_s": step_s})}
    )
    faults = list(full.faults())
    if faults:
        raise InputError(faults)
    return full


def _fed(
    env: Environment, sums: np.ndarray, step_s: float, block_s: float, log: ReferenceErrors
) -> Environment:
    """Put the errors that the strapdown's IMU and log made into the environment of the linear model."""
    blocks = round(step_s / block_s)
    steps = min(env.steps, len(sums) // blocks)
    mean = sums[: steps * blocks].reshape(steps, blocks, 6).sum(axis=1) / step_s
    sensors = SensorErrors(np.ascontiguousarray(mean[:, :3]), np.ascontiguousarray(mean[:, 3:]))
    return replace(env, steps=steps, sensors=sensors, reference=_gathered(log, step_s))


def _gathered(log: ReferenceErrors, step_s: float) -> ReferenceErrors:
    """Give a log that is faster than the step once a step: the mean of what the strapdown run holds in it."""
    if len(log.time_s) < 2:
        return log
    interval = float(log.time_s[-1] - log.time_s[0]) / (len(log.time_s) - 1)
    many = round(step_s / interval)
    if many < 2 or log.time_s[0] != 0.0:
        return log
    whole = len(log.time_s) // many
    first = np.arange(whole) * many
    means = log.error[: whole * many].reshape(whole, many, 2).mean(axis=1)
    kept = log.moored[first] if log.moored.size else log.moored
    return replace(log, time_s=log.time_s[first], error=means, valid=log.valid[first], moored=kept)


def _differences(full: MethodRun, simple: MethodRun) -> dict[str, Difference]:
    rows = min(len(full.t_s), len(simple.t_s))
    if rows < 2:
        return {}
    result = {}
    for i, name in enumerate(NAMES):
        peak = float(np.abs(full.rows[:rows, i] - simple.rows[:rows, i]).max())
        largest = float(np.abs(full.rows[:rows, i]).max())
        result[name] = Difference(peak, peak / largest if largest > 0.0 else None)
    return result


def _statements(
    scenario: Scenario,
    full: Run,
    pairs: list[tuple[MethodRun, MethodRun]],
    differences: tuple[dict[str, Difference], ...],
    found: tuple[dict[str, Level], ...],
) -> Iterator[str]:
    latitude = float(np.abs(full.truth[:, LAT]).max()) / DEG
    if latitude > LATITUDE_DEG:
        yield (
            Text(
                "The latitude reaches {latitude:.1f}°: beyond {latitude_deg:g}° a small "
                "error of position turns north too far for a linear model.",
                latitude=latitude,
                latitude_deg=LATITUDE_DEG,
            )
        )
    if scenario.run.duration_h > LONG_H:
        yield (
            Text(
                "The run is {duration_h:g} h long: beyond {long_h:g} h small differences of "
                "the periods put the curves of an undamped method out of phase.",
                duration_h=scenario.run.duration_h,
                long_h=LONG_H,
            )
        )
    if scenario.run.step_s < 0.999 * full.scenario.run.step_s:
        yield (
            Text(
                "Both runs were made with steps of {step_s:g} s in place of {step_s_2:g} s: "
                "so finely are the errors of the IMU summed up.",
                step_s=full.scenario.run.step_s,
                step_s_2=scenario.run.step_s,
            )
        )
    for pair, difference, level in zip(pairs, differences, found, strict=True):
        texts = (*_about_method(*pair, difference, level), *limit_texts(scenario.requirement, pair))
        for text in texts:
            yield Text("{name}: {text}", name=pair[0].method.name, text=text)


def _about_method(
    full: MethodRun, simple: MethodRun, differences: dict[str, Difference], found: dict[str, Level]
) -> Iterator[str]:
    for run, which in ((full, Text("the strapdown run")), (simple, Text("the linear model"))):
        if run.status == "diverged":
            yield Text("{which} diverged: {reason}.", which=which, reason=run.reason)
    tilt = max(full.errors[name]["max_abs"] for name in components(TILT)) / DEG
    if tilt > TILT_DEG:
        yield (
            Text(
                "the tilt reaches {tilt:.2g}°: beyond about {tilt_deg:g}° products of errors "
                "count, which the linear model leaves out.",
                tilt=tilt,
                tilt_deg=TILT_DEG,
            )
        )
    heading = max(full.errors[name]["max_abs"] for name in components(HEADING)) / DEG
    if heading > HEADING_DEG:
        yield (
            Text(
                "the heading errs by up to {heading:.2g}°: beyond about {heading_deg:g}° "
                "sine and angle differ, and the platform's rates couple in ways the linear "
                "model leaves out.",
                heading=heading,
                heading_deg=HEADING_DEG,
            )
        )
    rows = min(len(full.t_s), len(simple.t_s))
    apart = np.flatnonzero(full.rows[:rows, DAMPED_COLUMN] != simple.rows[:rows, DAMPED_COLUMN])
    if apart.size:
        yield (
            Text(
                "damped and undamped at different times ({size} of {rows} output rows, first "
                "at {t_s:.3g} h): from there on the runs are not of the same thing.",
                size=apart.size,
                rows=rows,
                t_s=full.t_s[apart[0]] / HOUR,
            )
        )
    of_peak = _worst(differences)
    if of_peak is not None:
        error, difference = of_peak
        share = (
            ""
            if difference.of_peak is None
            else Text(", {of_peak:.2g} % of the peak", of_peak=100.0 * difference.of_peak)
        )
        yield Text(
            "{label} differs by up to {peak:.3g} {unit}{share}.",
            label=error.label,
            peak=difference.peak / error.kind.size,
            unit=error.kind.unit,
            share=share,
        )
    of_level = worst(found, _SMALLEST)
    if of_level is not None:
        yield level_text(*of_level)


def _worst(differences: dict[str, Difference]) -> tuple[RecordedError, Difference] | None:
    """Error that differs most relative to its peak, if by more than `OF_PEAK` and by what can be seen."""
    shares = {
        error: difference.of_peak if difference.of_peak is not None else math.inf
        for error in ERRORS
        if (difference := differences.get(error.name)) is not None
        and difference.peak > _SMALLEST[error.kind.dimension]
    }
    error = max(shares, key=shares.__getitem__, default=None)
    return None if error is None or shares[error] <= OF_PEAK else (error, differences[error.name])
