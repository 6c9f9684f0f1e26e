"""The Kalman filter on the full mechanization: it corrects navigation and samples at every call of the law.

The mechanization runs undamped in between, on samples that are freed of the estimated sensor errors. The
covariance moves along the *computed* navigation: its position, velocity, attitude and specific force.
"""

import math
from dataclasses import dataclass, fields

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import EARTH_RATE, meridian_radius, prime_vertical_radius
from navcore.foundation.records import COUNT, REAL, new_record, record_type
from navcore.mechanization.kalman.filter import (
    ACCEL,
    LOG,
    FilterModel,
    FilterState,
    fill_transition,
    fill_turn,
    keep_sigma,
    predict,
    update,
)
from navcore.mechanization.strapdown.attitude import angles_of
from navcore.mechanization.strapdown.kernel import Pace, advance_kernel
from navcore.mechanization.strapdown.log import (
    LastCall,
    VelocityReference,
    held_difference,
    newest_epoch,
    usable,
)
from navcore.mechanization.strapdown.records import COMPLETE, UNDER_WAY
from navcore.mechanization.strapdown.run import StrapdownRun
from navcore.mechanization.trajectory import RateTerms

PLACE = record_type(
    epoch=COUNT,  # of the log, in force
    force=(REAL, (3,)),  # velocity increments since the last call, body axes, m/s
)
"""Where the filter is between two chunks."""


@inlined
def _computed(con, x, f_e, f_n, f_u):
    """Coefficients from the navigation x and the specific force (m/s^2)."""
    lat = con.lat0 + x.d_lat
    sin_lat, cos_lat = math.sin(lat), math.cos(lat)
    inv_m = 1.0 / (meridian_radius(con.e2, sin_lat) + x.height)
    inv_n = 1.0 / (prime_vertical_radius(con.e2, sin_lat) + x.height)
    v_e, v_n, tan_lat = x.v[0], x.v[1], sin_lat / cos_lat
    earth_n, earth_u = EARTH_RATE * cos_lat, EARTH_RATE * sin_lat
    return RateTerms(
        -v_n * inv_m, earth_n + v_e * inv_n, earth_u + v_e * tan_lat * inv_n, f_e, f_n, f_u, inv_m, inv_n,
        tan_lat, earth_n, earth_u, v_e, v_n, x.v[2], v_e * inv_n / (cos_lat * cos_lat), 1.0 / cos_lat,
    )  # fmt: skip


@inlined
def _turn(x, f):
    """C_b^n of the computed attitude."""
    pitch, roll, heading = angles_of(x.q[0], x.q[1], x.q[2], x.q[3])
    fill_turn(pitch, roll, heading, f.turn)
    return heading


@inlined
def _correct(x, d):
    """Take the estimated errors d off the navigation; the attitude is turned back by phi."""
    x.v[0] -= d[0]
    x.v[1] -= d[1]
    x.d_lat -= d[2]
    x.d_lon -= d[3]
    angle = math.sqrt(d[4] * d[4] + d[5] * d[5] + d[6] * d[6])
    w = math.cos(0.5 * angle)
    share = 0.5 if angle < 1e-9 else math.sin(0.5 * angle) / angle
    e, n, u = share * d[4], share * d[5], share * d[6]
    q0, q1, q2, q3 = x.q[0], x.q[1], x.q[2], x.q[3]
    x.q[0] = w * q0 - e * q1 - n * q2 - u * q3
    x.q[1] = w * q1 + e * q0 + n * q3 - u * q2
    x.q[2] = w * q2 + n * q0 + u * q1 - e * q3
    x.q[3] = w * q3 + u * q0 + e * q2 - n * q1


@inlined
def _measure(t, con, x, log, model, f, place):
    """Read the log and correct the navigation where there is a fresh sample."""
    before = place.epoch
    j = newest_epoch(t, before, log)
    if j == before:
        return
    place.epoch = j
    if not usable(t, j, log):
        return
    heading = _turn(x, f)
    v_e, v_n = x.v[0], x.v[1]
    last = LastCall(x.last.time, x.last.v_e, x.last.v_n)
    d_e, d_n = held_difference(t, j, v_e, v_n, heading, last, log)
    update(model, j, d_e, d_n, v_e, v_n, f)
    _correct(x, f.errors)


@kernel
def _advance(
    increments, first, pace, con, x, truth, heights, none, law, navigation, recorder, log, model, f, place
):
    """Run a chunk as `advance_kernel`, corrected at every call of the law; return place and code."""
    every, dt, end = pace.law_every, con.dt, first + increments.shape[0]
    freed = np.empty_like(increments)
    offset = np.zeros(6)
    k, code = first, UNDER_WAY
    while True:
        if k % every == 0:
            _measure(k * dt, con, x, log, model, f, place)
        offset[:] = 0.0
        for i in range(f.sensors.shape[0]):
            if model.axis[i] < LOG:
                offset[model.axis[i]] += f.sensors[i] * dt
        a = k - first
        b = min(end, k - k % every + every) - first
        for j in range(a, b):
            for i in range(6):
                freed[j, i] = increments[j, i] - offset[i]
            for i in range(3):
                place.force[i] += freed[j, ACCEL + i]
        row = recorder.cursor.row
        reached, code = advance_kernel(
            freed[a:b], k, pace, con, x, truth, heights, none, law, navigation, recorder
        )
        if recorder.cursor.row > row:
            keep_sigma(f, row)
        done = reached - k
        k = reached
        if k % every == 0 and done > 0:
            _turn(x, f)
            span = every * dt
            force, turn = place.force, f.turn
            c = _computed(
                con, x,
                (turn[0, 0] * force[0] + turn[0, 1] * force[1] + turn[0, 2] * force[2]) / span,
                (turn[1, 0] * force[0] + turn[1, 1] * force[1] + turn[1, 2] * force[2]) / span,
                (turn[2, 0] * force[0] + turn[2, 1] * force[1] + turn[2, 2] * force[2]) / span,
            )  # fmt: skip
            force[0] = force[1] = force[2] = 0.0
            fill_transition(span, c, c, c, f)
            predict(model, f)
        if code == COMPLETE:
            keep_sigma(f, recorder.row_steps.shape[0] - 1)
        if code != UNDER_WAY or k >= end:
            return k, code


@dataclass(kw_only=True)
class FilteredStrapdown(StrapdownRun):
    """One run of the filter under way; its law is that of a free method and its ``reference`` is empty.

    Attributes
    ----------
    log : VelocityReference
        What the filter measures with.
    model : FilterModel
        What it is told, for steps of the law's interval.
    filter : FilterState
        Its covariance and estimates.
    place : record
        `PLACE`.
    """

    log: VelocityReference
    model: FilterModel
    filter: FilterState
    place: np.void

    def advance(self, increments: np.ndarray) -> bool:
        """Integrate a chunk; return True when the run is complete or has diverged; as `StrapdownRun`."""
        room = self.settings.samples - self.position
        set_ = self.settings
        self.position, self.code = _advance(
            np.ascontiguousarray(increments[:room], dtype=float), self.position,
            Pace(set_.samples, set_.law_every, set_.record_every, set_.record_step_s),
            self.con, self.x, self.truth, self._heights, self.reference, self.law, self.navigation,
            self.recorder, self.log, self.model, self.filter, self.place,
        )  # fmt: skip
        return self.code != UNDER_WAY


def filtered_run(
    run: StrapdownRun, log: VelocityReference, model: FilterModel, state: FilterState
) -> FilteredStrapdown:
    """Make the run of the filter from a free run without a reference.

    Parameters
    ----------
    run : StrapdownRun
        From `navcore.mechanization.strapdown.start_run`.
    log : VelocityReference
        What the filter measures with.
    model : FilterModel
        For steps of ``law_every`` samples.
    state : FilterState
        At t = 0.
    """
    taken = {field.name: getattr(run, field.name) for field in fields(StrapdownRun)}
    place = new_record(PLACE, epoch=-1)
    return FilteredStrapdown(**taken, log=log, model=model, filter=state, place=place)
