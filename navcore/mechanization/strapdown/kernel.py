"""The strapdown loop: blocks of samples between two calls of the law, the law, and what is recorded."""

import math
from typing import NamedTuple

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import EARTH_RATE, meridian_radius, prime_vertical_radius
from navcore.law.azimuth import UpRate, steer
from navcore.law.history import USE_HEADING
from navcore.law.law import law_step
from navcore.law.records import FREE, E, N, Sensed, U, Watched
from navcore.law.user_law import ask_user_law
from navcore.mechanization.recorder import Errors, flush, given_out, record
from navcore.mechanization.strapdown.attitude import angles_of, heading_of, misalignment, quaternion_of
from navcore.mechanization.strapdown.log import LastCall, held_difference, newest_epoch, usable
from navcore.mechanization.strapdown.records import (
    COMPLETE,
    DIVERGED,
    LARGEST_LATITUDE,
    POLE,
    UNDER_WAY,
    keep_earth_terms,
)
from navcore.mechanization.strapdown.samples import is_steady, run_held, run_steady
from navcore.mechanization.strapdown.step import earth_terms
from navcore.motion.truth import HEADING, LAT, LON, PITCH, ROLL, VE, VN, VU
from navcore.motion.truth import HEIGHT as TRUE_HEIGHT

TILT_LIMIT = 1.0
"""Beyond this misalignment (rad) the run has diverged."""
VELOCITY_LIMIT = 1e4
"""Velocity error, m/s."""
_REFRESH = 128
"""Samples after which the Earth terms are formed anew, or one law interval if that is longer."""


class Pace(NamedTuple):
    """Samples of the run, between two calls of the law, between two records; s between two records."""

    final: int
    law_every: int
    record_every: int
    record_step_s: float


@inlined
def _read_log(t, v_e, v_n, heading, last, log, s):
    """Take the newest log epoch at or before t and hold its difference V_r - V_c."""
    j, before = newest_epoch(t, s.epoch, log), s.epoch
    if j != before:
        s.epoch = j
        call = LastCall(last.time, last.v_e, last.v_n)
        s.difference[E], s.difference[N] = held_difference(t, j, v_e, v_n, heading, call, log)
    s.valid = usable(t, j, log)


@inlined
def law_epoch(t, v_e, v_n, q, last, log, law):
    """Read the log and ask the law; return the `Correction` that it holds until the next epoch.

    ``q`` is the attitude's quaternion, four numbers; ``last`` a record `LAST_CALL`, which is kept up.
    """
    heading = 0.0
    if log.body_frame or law.p.remembers == USE_HEADING:
        heading = heading_of(q[0], q[1], q[2], q[3])
    _read_log(t, v_e, v_n, heading, last, log, law.s)
    last.time, last.v_e, last.v_n, last.heading = t, v_e, v_n, heading
    return law_step(law, Sensed(v_e, v_n, heading))


@inlined
def azimuth_epoch(law, held, terms, last):
    """Ask the azimuth channel of a law that has just given ``held``, at the place of `EarthTerms`.

    ``last`` is the record `LAST_CALL` of that call. A user's law gives all channels here.
    """
    if law.p.azimuth_order == 0:
        return held, 0.0
    v_e = last.v_e
    if law.p.user.step != 0:
        return ask_user_law(law, v_e, last.v_n, last.heading, math.atan2(terms.sin, terms.cos))
    by_v_e = terms.sin * terms.sec * terms.inv_n
    by_lat = EARTH_RATE * terms.cos + v_e * terms.inv_n * terms.sec * terms.sec
    up = UpRate(EARTH_RATE * terms.sin + v_e * by_v_e, by_lat, by_v_e, terms.inv_m, EARTH_RATE * terms.cos)
    return steer(law, held, up)


@inlined
def true_attitude(truth, i):
    """Quaternion of row i of the truth."""
    return quaternion_of(truth[i, PITCH], truth[i, ROLL], truth[i, HEADING])


@inlined
def errors_at(con, d_lat, d_lon, v_e, v_n, q, truth, i, true_q):
    """Errors against row i of the truth; d_lat, d_lon from the start (rad), q and true_q quaternions."""
    phi_e, phi_n, phi_u = misalignment(q[0], q[1], q[2], q[3], true_q[0], true_q[1], true_q[2], true_q[3])
    return Errors(
        v_e - truth[i, VE], v_n - truth[i, VN], con.lat0 + d_lat - truth[i, LAT],
        con.lon0 - truth[i, LON] + d_lon, phi_e, phi_n, phi_u,
    )  # fmt: skip


@inlined
def navigates(errors, height):
    """Whether the errors are in the range in which a run means anything."""
    level = abs(errors.phi_e) < TILT_LIMIT and abs(errors.phi_n) < TILT_LIMIT
    slow = math.hypot(errors.dv_e, errors.dv_n) < VELOCITY_LIMIT
    return level and slow and math.isfinite(errors.d_lat + errors.d_lon + errors.phi_u + height)


@inlined
def arms(con, truth, i):
    """Turn latitude and longitude at row i of the truth into metres: m/rad."""
    sin_lat, height = math.sin(truth[i, LAT]), truth[i, TRUE_HEIGHT]
    n_cos = (prime_vertical_radius(con.e2, sin_lat) + height) * math.cos(truth[i, LAT])
    return meridian_radius(con.e2, sin_lat) + height, n_cos


@inlined
def _record_state(k, con, x, truth, law, navigation, recorder):
    """Record state k against its row of the truth; False when it has diverged."""
    i = k if truth.shape[0] > 1 else 0
    lat, v_u, height = con.lat0 + x.d_lat, x.v[2], x.height
    q = (x.q[0], x.q[1], x.q[2], x.q[3])
    errors = errors_at(con, x.d_lat, x.d_lon, x.v[E], x.v[N], q, truth, i, true_attitude(truth, i))
    if not navigates(errors, height):
        return False
    s, j = law.s, recorder.cursor.row
    watched = Watched(float(s.wanted), 1.0 if s.damped else 0.0, s.xi, s.measure)
    m, n_cos = arms(con, truth, i)
    record(k, given_out(errors, s), m, n_cos, watched, recorder)
    if recorder.cursor.row > j:
        pitch, roll, heading = angles_of(q[0], q[1], q[2], q[3])
        navigation[j, 0], navigation[j, 1], navigation[j, 2] = lat, con.lon0 + x.d_lon, height
        navigation[j, 3], navigation[j, 4] = x.v[E] - s.output[E], x.v[N] - s.output[N]
        navigation[j, 5] = v_u
        navigation[j, 6], navigation[j, 7], navigation[j, 8] = pitch, roll, heading
        navigation[j, 9], navigation[j, 10] = v_u - truth[i, VU], height - truth[i, TRUE_HEIGHT]
    return True


@inlined
def _altimeter_epoch(t, interval, con, x, height_s, heights):
    """Hold the difference of altimeter (the true height, linear between its rows) and computed height."""
    place = t / height_s
    i = min(int(place), heights.shape[0] - 1)
    after = min(i + 1, heights.shape[0] - 1)
    measured = heights[i] + min(place - i, 1.0) * (heights[after] - heights[i])
    x.altimeter_difference = measured - x.height
    x.altimeter_integral += con.altimeter_k3 * interval * x.altimeter_difference


@kernel
def advance_kernel(increments, first, pace, con, x, truth, heights, log, law, navigation, recorder):
    """Run a chunk of increments (n, 6), whose first ends at sample first + 1; return place and code."""
    final, law_every, record_every = pace.final, pace.law_every, pace.record_every
    k, end, dt, altimeter = first, first + increments.shape[0], con.dt, con.altimeter
    refresh = False
    # Counters in place of remainders: two divisions a sample are felt when the law runs at the IMU's rate.
    to_law, to_record, record_number = -k % law_every, -k % record_every, -(-k // record_every)
    while True:
        if k == end and k != final:
            break
        if to_law == 0:
            to_law = law_every
            # At law epochs only, so that the length of the chunks cannot change the result.
            x.since += law_every
            refresh = x.since > _REFRESH or k == 0
            if refresh:
                x.since = 0
            if abs(con.lat0 + x.d_lat) > LARGEST_LATITUDE:
                return k, POLE
            q = (x.q[0], x.q[1], x.q[2], x.q[3])
            held = law_epoch(k * dt, x.v[E], x.v[N], q, x.last, log, law)
            if law.p.azimuth_order > 0:
                terms = earth_terms(con.e2, con.lat0 + x.d_lat, x.height)
                held, x.c[U] = azimuth_epoch(law, held, terms, x.last)
            x.c[E], x.c[N], x.a[E], x.a[N] = held.c_e, held.c_n, held.a_e, held.a_n
            if altimeter:
                _altimeter_epoch(k * dt, law_every * dt, con, x, pace.record_step_s, heights)
        if to_record == 0:
            to_record, r = record_every, record_number
            record_number += 1
            if not _record_state(r, con, x, truth, law, navigation, recorder):
                flush(recorder)
                return k, DIVERGED
            if (r + 1) % recorder.bin_width == 0 or k == final:
                flush(recorder)
        if k == final:
            return k, COMPLETE
        if refresh:
            keep_earth_terms(x, earth_terms(con.e2, con.lat0 + x.d_lat, x.height))
            refresh = False
        n, j = min(to_law, to_record, end - k), k - first
        free = law.p.damping == FREE
        at_once = law_every == 1 and not altimeter and (free or is_steady(law))
        if at_once:
            # Nothing but the law can come before the next record or the next forming of the Earth terms.
            n = min(to_record, end - k, _REFRESH + 1 - x.since)
        if altimeter:
            run_held(increments, j, j + n, con, x, True)
        elif at_once and not free:
            n = run_steady(increments, j, j + n, first, con, x, log, law) - j
        else:
            run_held(increments, j, j + n, con, x, False)
        if at_once:
            x.since += n - 1
            to_law = n
        k += n
        to_law -= n
        to_record -= n
    flush(recorder)
    return k, UNDER_WAY
