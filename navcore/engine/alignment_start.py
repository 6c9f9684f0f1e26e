"""The start of navigation after a simulated alignment (theory.md 6.1), and the errors of a start."""

from dataclasses import replace

import numpy as np

from navcore.alignment.fine import coarse_alignment, fine_alignment, turned_by
from navcore.foundation.compiled import plain
from navcore.mechanization.strapdown import Start, start_from
from navcore.mechanization.strapdown.attitude import misalignment, quaternion_of
from navcore.motion.truth import HEADING, HEIGHT, LAT, LON, PITCH, ROLL, VE, VN, Site
from navcore.scenario.model import Scenario
from navcore.sensors.imu_simulation import ImuSimulation

_OTHER_NOISE = 1
"""Added to the seed: the alignment's white noise is not that of the navigation."""


def aligned_start(scenario: Scenario, true_row: np.ndarray) -> Start:
    """Align at the site before t = 0 with the scenario's IMU and ``initial_error``.

    The vehicle swings as it will (`swing`), lies stopped in the same sea (`waves`), or rests at the attitude
    of t = 0. Biases, scale factors and misalignments are those of the navigation; white noise and
    Gauss-Markov drift are drawn anew. With ``alignment.coarse_s`` the record begins with a coarse alignment,
    from which the compass loop starts.

    Parameters
    ----------
    scenario : Scenario
        With ``alignment.kind = "compass"``.
    true_row : ndarray, shape (15,)
        True state at t = 0.

    Returns
    -------
    Start
        Aligned attitude, true velocity; position with its initial error, which an alignment cannot remove.

    Raises
    ------
    InputError
        |latitude| above 85 deg, a loop too fast for the IMU, or a coarse alignment that finds no north.
    """
    alignment, rate = scenario.alignment, scenario.run.rate_hz
    samples = max(1, round(alignment.duration_s * rate))
    motion = scenario.motion.before_start(true_row, samples / rate)
    site = Site(*(float(true_row[column]) for column in (LAT, LON, HEIGHT)))
    seed, begin_s = scenario.run.seed + _OTHER_NOISE, -samples / rate
    simulation = ImuSimulation(
        motion, site, scenario.earth, scenario.imu, rate, samples, seed, begin_s=begin_s
    )
    increments = np.concatenate([chunk.copy() for chunk, _ in simulation.chunks()])
    errors = np.array(scenario.initial_error.state())
    ends = simulation.truth_rows(2, samples / rate)
    attitude, lat = start_from(ends[0], errors).quaternion, site.lat + errors[2]
    if coarse := round(alignment.coarse_s * rate):
        attitude = turned_by(-errors[4:7], coarse_alignment(increments[:coarse], rate, lat))
        increments = increments[coarse:]
    aligned = fine_alignment(
        increments,
        rate,
        attitude,
        lat,
        site.height,
        scenario.earth,
        alignment.loop(),
        errors[:2],
    )
    left = replace(start_from(ends[-1]), quaternion=aligned.quaternion)
    errors[:2], errors[4:7] = 0.0, start_errors(left, ends[-1])[4:7]
    return start_from(true_row, errors)


def start_errors(start: Start, true_row: np.ndarray) -> np.ndarray:
    """Errors dV_E, dV_N, dL, dlambda, phi of a start against a row of truth, SI, shape (7,)."""
    t = plain(quaternion_of)(true_row[PITCH], true_row[ROLL], true_row[HEADING])
    velocity = start.velocity[:2] - true_row[[VE, VN]]
    place = start.lat - true_row[LAT], start.lon - true_row[LON]
    q = start.quaternion
    phi = plain(misalignment)(q[0], q[1], q[2], q[3], t[0], t[1], t[2], t[3])
    return np.array([*velocity, *place, *phi])
