"""Inputs of an exported law along its scenario: what the navigation computes, and the log, call by call."""

from __future__ import annotations

import numpy as np

from navcore.engine.drivers.common import seen_by
from navcore.engine.environment import environment
from navcore.engine.simulation import simulate
from navcore.exporting.replay import INPUTS
from navcore.exporting.step import NO_SAMPLE, NOT_YET, SAMPLE
from navcore.exporting.subject import Subject
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
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
    errors = {name: method.rows[:, place] for place, name in enumerate(COMPONENTS)}
    inputs = np.zeros((calls, len(INPUTS)))
    column = {name: inputs[:, place] for place, name in enumerate(INPUTS)}
    meridian = np.array([scenario.earth.radii(lat)[0] for lat in truth[:, LAT]]) + truth[:, HEIGHT]
    column["v_e_mps"][:] = truth[:, VE] + errors["dve_mps"]
    column["v_n_mps"][:] = truth[:, VN] + errors["dvn_mps"]
    column["lat_rad"][:] = truth[:, LAT] + errors["dlat_m"] / meridian
    column["yaw_rad"][:] = truth[:, HEADING] + errors["phi_u_rad"]
    column["accel_e_mps2"][:], column["accel_n_mps2"][:] = truth[:, AE], truth[:, AN]
    if scenario.reference.kind != "none":
        log = _log_along(subject, method.t_s, truth, errors["phi_u_rad"])
        column["log_e_mps"][:], column["log_n_mps"][:], column["log_valid"][:] = log
    return inputs


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
