"""A scenario on the output of a ship's own INS: damping laid on it from outside (theory.md 22)."""

import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from navcore.engine.against import OUTPUT, against_reference, as_recorded, damped_output, rows_of
from navcore.engine.drivers.common import (
    Cancelled,
    Progress,
    law_of,
    method_run,
    network_of,
    stability_of,
)
from navcore.engine.drivers.linear import run_methods
from navcore.engine.environment import Environment, environment, start_utc
from navcore.engine.ins_checks import already_damped, require_units
from navcore.engine.own_deviations import own_deviations
from navcore.engine.reference_errors import RecordedErrors, recorded_errors_of
from navcore.engine.run import RECORDED_PLACE, Against, MethodRun, Run
from navcore.engine.to_log import recorded_to_log
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.series import Series
from navcore.mechanization.outside import own_corrections, taken_off
from navcore.mechanization.recorder import make_recorder, output_steps
from navcore.motion.ins_track import InsTrack
from navcore.motion.truth import HEADING, LAT, LON, VE, VN
from navcore.quantities import COMPONENTS, QUANTITIES, components
from navcore.scenario.blocks import SiteSettings
from navcore.scenario.file import scenario_hash
from navcore.scenario.model import Scenario
from navcore.scenario.own_ins import AS_RECORDED
from navcore.sensors.log_files import log_recording, log_series


def settled(scenario: Scenario) -> Scenario:
    """Return a scenario on ``[ins]`` with what only its recordings tell.

    The site, where none is given, is where the recording starts: it gives omega_s and with it every network.
    A log in the ship's axes without a heading of its own is turned by that of the damped solution.

    Raises
    ------
    InputError
        A recording cannot serve the run.
    """
    motion, log = scenario.motion, scenario.reference
    assert isinstance(motion, InsTrack)
    changed: dict[str, object] = {}
    if log.kind == "file":
        try:
            recording = log_recording(log)
            series, along_axes = log_series(log, recording)
        except InputError as error:
            raise error.located("", "reference.") from None
        own_heading = recording.heading is not None and not _is_of_ins(recording.heading, motion)
        if along_axes and not own_heading:
            if not _has_heading(motion):
                raise InputError(Fault("", "reference.file", log.file, _no_heading(series.source)))
            changed["reference"] = log.model_copy(update={"frame": "body"})
    if scenario.site == SiteSettings():
        try:
            start = motion.truth(1, 1.0, scenario.site.site(), scenario.earth, start_utc(scenario)).values[0]
        except InputError as error:
            raise error.located("", f"{motion.block}.") from None
        lat_deg, lon_deg = (round(float(start[place]) / DEG, 6) for place in (LAT, LON))
        lat_deg = min(max(lat_deg, -89.0), 89.0)
        place = {"lat_deg": lat_deg, "lon_deg": (lon_deg + 180.0) % 360.0 - 180.0}
        changed["site"] = scenario.site.model_copy(update=place)
    return scenario.model_copy(update=changed).with_sensors() if changed else scenario


def _is_of_ins(heading: Series, motion: InsTrack) -> bool:
    """Whether a heading beside the log is the INS's own: one file holds both."""
    try:
        own = motion.recording().heading
    except InputError as error:
        raise error.located("", f"{motion.block}.") from None
    return own is not None and (own.file, own.what) == (heading.file, heading.what)


def _has_heading(motion: InsTrack) -> bool:
    try:
        return motion.has_heading
    except InputError as error:
        raise error.located("", f"{motion.block}.") from None


def _no_heading(source: str) -> Text:
    return Text(
        "{source} gives speeds along the ship's axes, and neither the INS's output nor the log holds a "
        "heading that turns them: add heading_deg or HDT sentences to ins.file or reference.file, or give a "
        "log of east and north, ve_mps and vn_mps",
        source=source,
    )


def run_outside(
    scenario: Scenario, progress: Progress | None = None, cancelled: Cancelled | None = None
) -> Run:
    """Run every method on the output of a ship's own INS; as `navcore.engine.simulation.simulate`."""
    began = time.perf_counter()
    placed, env, recorded = prepared(scenario)
    own = _own(placed, env)
    if own is not None:
        env = replace(env, sensors=taken_off(own, env.coefficients))
    run = placed.run
    output = output_steps(env.steps, run.step_s, run.output_step_s)
    rows = output if recorded is None else rows_of(recorded, output, run.step_s, env.steps)
    state = np.zeros(7)
    found = run_methods(placed, replace(env, rows=rows), state, progress, cancelled, began)
    methods = tuple(_with_output(method, env, run.step_s, placed) for method in found.methods)
    difference = recorded_to_log(env.reference, output * run.step_s)
    against = Against("recorded", to_log=difference)
    warnings = [*found.warnings]
    if recorded is not None:
        output_s, watched = output * run.step_s, [(one.begins_s, one.bound_m) for one in placed.requirement]
        truth = env.truth_half.at(np.rint(2.0 * recorded.time_s / run.step_s).astype(np.int64))
        first = _with_output(_as_recorded(placed, env, rows, own), env, run.step_s, placed)
        first, *methods = (
            against_reference(one, recorded, output_s, truth, watched) for one in (first, *methods)
        )
        first = replace(first, sigma=_deviations(placed, env, first))
        against = Against("truth", len(recorded.time_s), recorded.not_known, first, difference)
    return replace(
        found,
        scenario=scenario,
        methods=tuple(methods),
        warnings=tuple(dict.fromkeys(warnings)),
        elapsed_s=time.perf_counter() - began,
        scenario_sha256=scenario_hash(scenario),
        against=against,
    )


def prepared(scenario: Scenario) -> tuple[Scenario, Environment, RecordedErrors | None]:
    """Make what all methods share, and hold the recordings against each other.

    Returns
    -------
    scenario : Scenario
        As of `settled`.
    env : Environment
        With all warnings about the recordings.
    recorded : RecordedErrors or None
        Errors of the INS as it was recorded; None without a reference.

    Raises
    ------
    InputError
        A recording cannot serve the run.
    """
    placed = settled(scenario)
    env = environment(placed)
    require_units(placed, env)
    recorded = recorded_errors_of(placed, start_utc(placed) or 0.0)
    _require_known(placed, recorded)
    more = (*_notices(placed, env), *(() if recorded is None else recorded.warnings))
    return placed, replace(env, warnings=(*env.warnings, *more)), recorded


def _own(scenario: Scenario, env: Environment) -> np.ndarray | None:
    """Corrections of the INS's own law; None where it ran free."""
    method = scenario.ins.damping
    if not method.kind.uses_network:
        return None
    files = recorded_state(scenario.ins), recorded_state(scenario.reference)
    key = "own corrections", files, scenario.ins, scenario.reference, scenario.run, scenario.site
    step_s = scenario.run.step_s
    own = scenario.designed(method)
    return kept(
        key,
        lambda: own_corrections(
            law_of(own, network_of(scenario, own), step_s), env.coefficients, env.reference, env.steps, step_s
        ),
    )


def _as_recorded(scenario: Scenario, env: Environment, rows: np.ndarray, own: np.ndarray | None) -> MethodRun:
    """Judge the INS's own damping as a method; its states before the reference are those of the recording."""
    step_s = scenario.run.step_s
    method = scenario.designed(scenario.ins.damping).model_copy(update={"name": AS_RECORDED})
    recorder = make_recorder(env.steps, step_s, scenario.run.output_step_s, rows=rows)
    recorder.cursor["row"] = len(rows)
    recorder.cursor["count"] = 1
    result = method_run(
        method,
        network_of(scenario, method),
        lambda network: stability_of(scenario, method, step_s, env.reference, env.truth_half, network),
        recorder,
        step_s,
        "ok",
        "",
        env.steps * step_s,
    )
    return replace(as_recorded(result, None if own is None else own[rows, 5:]), place=RECORDED_PLACE)


def _with_output(method: MethodRun, env: Environment, step_s: float, scenario: Scenario) -> MethodRun:
    """Add the damped output at a method's rows."""
    steps = np.rint(method.t_s / step_s).astype(np.int64)
    truth = env.truth_half.at(2 * steps)
    recorded = np.column_stack([truth[:, place] for place in (LAT, LON, VE, VN, HEADING)])
    half = env.coefficients.half[2 * steps]
    output = damped_output(method.rows, recorded, np.column_stack([half["m"], half["n_cos"]]))
    output[:, 1] = np.remainder(output[:, 1] + np.pi, 2.0 * np.pi) - np.pi
    output[:, 4] = np.remainder(output[:, 4], 2.0 * np.pi)
    motion = scenario.motion
    assert isinstance(motion, InsTrack) and len(OUTPUT) == output.shape[1]
    if not motion.has_heading:
        output[:, 4] = np.nan
    return replace(method, output=output, moved=method.rows[:, : len(COMPONENTS)].copy())


def _deviations(scenario: Scenario, env: Environment, first: MethodRun) -> np.ndarray | None:
    """Standard deviations that the INS gives its own output, at the output rows."""
    motion = scenario.motion
    assert isinstance(motion, InsTrack)
    steps = np.rint(first.t_s / scenario.run.step_s).astype(np.int64)
    heading = env.truth_half.at(2 * steps)[:, HEADING]
    return own_deviations(motion.recording(), (start_utc(scenario) or 0.0) + first.t_s, heading)


def unknown_errors(scenario: Scenario) -> frozenset[str]:
    """Errors that no reference of a settled scenario tells, of `navcore.quantities.COMPONENTS`."""
    recorded = recorded_errors_of(scenario, start_utc(scenario) or 0.0)
    return frozenset(COMPONENTS if recorded is None else recorded.not_known)


_NEEDED = {
    "tilt": Text("pitch, roll and heading"),
    "heading": Text("a heading"),
    "velocity": Text("a velocity"),
    "position": Text("a position"),
}
"""What output and reference must both hold for a kind of error to be known."""


def _require_known(scenario: Scenario, recorded: RecordedErrors | None) -> None:
    """Refuse limits of errors that the reference does not tell."""
    unknown = set() if recorded is None else set(recorded.not_known)
    faults = []
    for i, one in enumerate(scenario.requirement):
        kind = QUANTITIES[one.quantity].kind
        if kind is not None and unknown.intersection(components(kind)):
            allowed = Text(
                "is not known: output and reference do not both hold {what}",
                what=_NEEDED[kind.name],
            )
            faults.append(Fault("", f"requirement.{i}.quantity", one.quantity, allowed))
    if faults:
        raise InputError(faults)


def _notices(scenario: Scenario, env: Environment) -> Iterator[str]:
    """Yield what a run on an INS rests on."""
    own = scenario.ins.damping
    if damped := already_damped(scenario, env):
        yield damped
    if own.kind.uses_network:
        yield Text(
            "what the INS's own damping ({description}) did is taken off; the state of its network at the "
            "start of the recording is not known, and fades with its time constants",
            description=own.kind.description(own),
        )
    if scenario.truth.file is None:
        yield Text("without [truth] all errors are damped minus recorded: what damping changes")
