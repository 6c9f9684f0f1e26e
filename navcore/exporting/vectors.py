"""Inputs of an exported law along its scenario: what the navigation computes, and the log, call by call."""

from __future__ import annotations

import numpy as np

from navcore.engine.drivers.common import seen_by
from navcore.engine.drivers.kalman import filtered_linear
from navcore.engine.environment import environment
from navcore.engine.simulation import simulate
from navcore.exporting.replay import INPUTS
from navcore.exporting.step import NO_SAMPLE, NOT_YET, SAMPLE
from navcore.exporting.subject import Subject
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.mechanization.error_model import STATES
from navcore.motion.truth import AE, AN, HEADING, HEIGHT, LAT, VE, VN
from navcore.quantities import COMPONENTS
from navcore.sensors.base import ReferenceErrors

_FEWEST_ROWS = 10


def inputs_along(subject: Subject) -> np.ndarray:
    """Inputs of each call of a method in the run of its scenario, shape (calls, 9), columns `INPUTS`.

    Raises
    ------
    InputError
        The scenario cannot be run, or the method diverges at once.
    """
    scenario = subject.scenario
    run = simulate(scenario)
    method = run.methods[0]
    calls = len(method.rows)
    if calls < _FEWEST_ROWS:
        allowed = Text("diverges within {calls} calls: there is nothing to replay", calls=calls)
        raise InputError(Fault("", "--method", subject.method.label(), allowed))
    truth = np.broadcast_to(run.truth, (len(run.t_s), run.truth.shape[1]))[:calls]
    errors = {name: method.rows[:, place].copy() for place, name in enumerate(COMPONENTS)}
    inputs = np.zeros((calls, len(INPUTS)))
    column = {name: inputs[:, place] for place, name in enumerate(INPUTS)}
    meridian = np.array([scenario.earth.radii(lat)[0] for lat in truth[:, LAT]]) + truth[:, HEIGHT]
    if subject.method.kind.carrying == "filter" and not scenario.strapdown:
        _before_corrections(subject, errors, truth[:, LAT], meridian)
    column["v_e_mps"][:] = truth[:, VE] + errors["dve_mps"]
    column["v_n_mps"][:] = truth[:, VN] + errors["dvn_mps"]
    column["lat_rad"][:] = truth[:, LAT] + errors["dlat_m"] / meridian
    column["yaw_rad"][:] = truth[:, HEADING] + errors["phi_u_rad"]
    column["accel_e_mps2"][:], column["accel_n_mps2"][:] = truth[:, AE], truth[:, AN]
    if scenario.reference.kind != "none":
        log = _log_along(subject, method.t_s, truth, errors["phi_u_rad"])
        column["log_e_mps"][:], column["log_n_mps"][:], column["log_valid"][:] = log
    return inputs


def corrections_of(subject: Subject) -> np.ndarray:
    """What a Kalman filter takes off the seven errors at each step of the run, shape (calls, 7), SI."""
    scenario = subject.scenario
    env, state = environment(scenario), np.array(scenario.initial_error.state())
    run, _ = filtered_linear(scenario, subject.method, env, state)
    found, epoch = np.zeros((env.steps + 1, STATES)), -1
    for off in found:
        run.advance(1)
        if run.law.s["epoch"] != epoch and run.law.s["valid"]:
            off[:] = run.filter.errors[:STATES]
        epoch = int(run.law.s["epoch"])
    return found


def _before_corrections(
    subject: Subject, errors: dict[str, np.ndarray], lat: np.ndarray, meridian: np.ndarray
) -> None:
    """Put back what a filter has corrected: a run records what is left, an exported filter is given all.

    Parameters
    ----------
    subject : Subject
        The method.
    errors : dict of ndarray
        Recorded errors by name; changed.
    lat, meridian : ndarray, shape (calls,)
        True latitude, rad, and radius, m.
    """
    off = corrections_of(subject)[: len(lat)]
    for name, place in zip(COMPONENTS, (4, 5, 6, 0, 1), strict=False):
        errors[name] += off[:, place]
    errors["dlat_m"] += off[:, 2] * meridian


def reference_of(subject: Subject) -> ReferenceErrors:
    """Errors of the log as the method sees it."""
    scenario = subject.scenario
    if scenario.strapdown:
        from navcore.engine.strapdown_environment import strapdown_environment

        return seen_by(subject.method, strapdown_environment(scenario).reference)
    return seen_by(subject.method, environment(scenario).reference)


def _log_along(
    subject: Subject, t_s: np.ndarray, truth: np.ndarray, phi_u: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """East, north and the word of the log at each call: the newest epoch, as the mechanization takes it."""
    log = reference_of(subject)
    newest = np.searchsorted(log.time_s, t_s + 1e-9, side="right") - 1
    fresh = np.diff(newest, prepend=-1) > 0
    known = np.maximum(newest, 0)
    valid = log.valid[known]
    word = np.where(fresh, np.where(valid, SAMPLE, NO_SAMPLE), NOT_YET).astype(float)
    east, north = truth[:, VE] + log.error[known, 0], truth[:, VN] + log.error[known, 1]
    if log.body_frame:
        east, north = east + phi_u * truth[:, VN], north - phi_u * truth[:, VE]
    given = word == SAMPLE
    return np.where(given, east, 0.0), np.where(given, north, 0.0), word
