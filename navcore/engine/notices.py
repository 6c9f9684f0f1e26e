"""Notices of a run about its inputs: recordings, errors simulated beside them, waves, the site."""

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR, KNOT
from navcore.io.stretches import FASTEST_MPS
from navcore.motion.truth import LAT, Truth
from navcore.scenario.model import Scenario
from navcore.sensors.base import ErrorPart
from navcore.sensors.data_sheets import data_sheets, differing
from navcore.sensors.log_errors.events import event_velocity
from navcore.sensors.recorded import recording_notices, short_run_notices

FAR_FROM_SITE_DEG = 2.0
"""Latitude by which a track may start off the site before the user is warned, deg."""

_LOOK_S = 10.0
"""Spacing of the times at which the log's events are looked at, s."""


def input_notices(scenario: Scenario) -> tuple[str, ...]:
    """Return the notices about a scenario's recordings and a motion that ends early; raises `InputError`."""
    recorded = scenario.reference.kind == "file" or scenario.imu.file is not None
    end_s = scenario.run.duration_h * HOUR
    short = short_run_notices(scenario.motion, recorded, end_s)
    beside = _beside_recordings(scenario) if recorded or scenario.motion.recorded else ()
    return (
        *recording_notices(scenario.motion, scenario.reference),
        *beside,
        *_parts_overruled(scenario),
        *short,
        *scenario.motion.ending(end_s),
        *_waves_without_effect(scenario),
        *_too_fast_a_log(scenario),
        *_uneven_rows(scenario),
    )


def _uneven_rows(scenario: Scenario) -> Iterator[str]:
    """Say where the output rows stand when their interval is no multiple of the step."""
    step_s = scenario.sampling.record_step_s if scenario.strapdown else scenario.run.step_s
    wanted = scenario.run.output_step_s
    if wanted <= step_s or abs(wanted / step_s - round(wanted / step_s)) < 1e-6 * wanted / step_s:
        return
    yield Text(
        "run.output_step_s = {wanted:g} is no multiple of the step of {step_s:g} s: the rows stand at the "
        "nearest steps, {below:g} to {above:g} s apart",
        wanted=wanted,
        step_s=step_s,
        below=math.floor(wanted / step_s) * step_s,
        above=math.ceil(wanted / step_s) * step_s,
    )


def site_notices(scenario: Scenario, truth: Truth) -> list[str]:
    """Say so when a recorded track starts far from the site, whose gravity gives omega_s."""
    start = float(truth.values[0, LAT]) / DEG
    if abs(start - scenario.site.lat_deg) < FAR_FROM_SITE_DEG:
        return []
    return [
        Text(
            "the track starts at latitude {start:.2f}°, the site is at {lat_deg:g}°: ωₛ, "
            "and with it every network, is that of the site",
            start=start,
            lat_deg=scenario.site.lat_deg,
        )
    ]


def _beside_recordings(scenario: Scenario) -> Iterator[str]:
    """Yield which sensors' and initial errors the scenario adds to what is recorded."""
    if scenario.imu.file is not None or scenario.on_ins:
        return
    given = [*_given(scenario.imu, "imu"), *_given(scenario.initial_error, "initial_error")]
    if not given:
        yield Text("beside the recording, gyros, accelerometers and the start are taken as free of error")
        return
    yield Text(
        "beside the recording, gyros, accelerometers and initial errors are simulated as the scenario says: "
        "{given}",
        given=", ".join(given),
    )


def _parts_overruled(scenario: Scenario) -> Iterator[str]:
    """Say which figures of a part of the list do not count, because a field beside it gives another one."""
    for block in (scenario.imu, scenario.reference):
        sheet = data_sheets().get(block.part or "")
        if sheet is not None and (fields := [*differing(block, sheet)]):
            yield Text(
                '{block}.part = "{part}": {fields} given beside it count in the place of its figures',
                block=sheet.block,
                part=sheet.name,
                fields=", ".join(fields),
            )


def _given(block: Any, name: str) -> Iterator[str]:
    """Yield the numbers of a block that are not those of its class."""
    for field, info in type(block).model_fields.items():
        value = getattr(block, field)
        if value != info.default and isinstance(value, float | tuple):
            parts = value if isinstance(value, tuple) else (value,)
            words = ", ".join(f"{part:g}" for part in parts)
            yield f"{name}.{field} = [{words}]" if isinstance(value, tuple) else f"{name}.{field} = {words}"


def _waves_without_effect(scenario: Scenario) -> Iterator[str]:
    """Say why waves change nothing, where they do not: the error model has nothing that they act on."""
    waves = scenario.motion.kind == "waves" or getattr(scenario.motion, "rough", False)
    parts = (*scenario.imu.all_parts(), *scenario.reference.all_parts())
    acts = any(part.active for part in parts) or any(scenario.initial_error.state())
    if waves and acts and scenario.run.fidelity == "channel" and not _sees_motion(scenario, parts):
        yield Text(
            'the waves change nothing in this run: of its errors, fidelity "channel" lets only scale errors, '
            "misalignments, delay and resolution depend on the motion, and the scenario has none of them; "
            'take run.fidelity = "error_model" or "strapdown"'
        )
    if waves and not scenario.strapdown and not acts:
        yield Text(
            "the waves change nothing in this run: the error model carries errors along the motion, and the "
            'scenario has none; give the sensors errors, or take run.fidelity = "strapdown"'
        )


def _sees_motion(scenario: Scenario, parts: Iterable[ErrorPart]) -> bool:
    """Whether an error or a method of a channel run depends on the motion."""
    own = (
        method.kind.self_referenced or method.policy.id not in ("constant", "schedule")
        for method in scenario.method
    )
    in_axes = scenario.reference.frame == "body" and scenario.reference.kind == "log"
    return in_axes or any(own) or any(part.has_shape or np.any(part.lsb) for part in parts)


def _too_fast_a_log(scenario: Scenario) -> Iterator[str]:
    """Say where events of the simulated log add a speed to it that no ship has."""
    log, end_s = scenario.reference, scenario.run.duration_h * HOUR
    if log.kind != "log":
        return
    time_s = np.linspace(0.0, end_s, max(2, math.ceil(end_s / _LOOK_S) + 1))
    events = {"reference.event": log.event} | {
        f"method.{k}.event": method.event for k, method in enumerate(scenario.method)
    }
    for field, own in events.items():
        most = float(np.max(np.hypot(*event_velocity(own, time_s).T))) if own else 0.0
        if most > FASTEST_MPS:
            yield Text(
                "{field}: the log errs by up to {most:.1f} kn, more than any ship makes; an acceleration "
                "adds up over its time, and what it adds stays",
                field=field,
                most=most / KNOT,
            )
