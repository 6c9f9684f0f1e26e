"""The strapdown loop: blocks of samples between two calls of the law, the law, and what is recorded."""

from __future__ import annotations

import math

from navcore.compiled import inlined, kernel
from navcore.control.law import law_step
from navcore.control.layout import (
    DAMPED,
    DAMPING,
    DIFFERENCE,
    EPOCH_INDEX,
    FREE,
    MEASURE,
    POLICY,
    VALID,
    WANTED,
    XI,
)
from navcore.earth import meridian_radius, prime_vertical_radius
from navcore.mechanization.recorder import CURSOR_BUFFER, CURSOR_ROW, flush, record
from navcore.mechanization.strapdown.attitude import angles_of, heading_of, misalignment, quaternion_of
from navcore.mechanization.strapdown.every_sample import is_steady, run_damped
from navcore.mechanization.strapdown.layout import (
    A_E,
    A_N,
    ALT_DIFFERENCE,
    ALT_INTEGRAL,
    ALT_K1,
    ALT_K2,
    ALT_K3,
    ALTIMETER,
    BODY_LOG,
    C_E,
    C_N,
    CARRY,
    COMPLETE,
    D_LAT,
    D_LON,
    DIVERGED,
    DV,
    E2,
    EARTH_TERMS,
    G_EQUATOR,
    HEIGHT,
    HOLD,
    K6,
    K12,
    K_GRAVITY,
    LARGEST_LATITUDE,
    LAST_TIME,
    LAST_V_E,
    LAST_V_N,
    LAT0,
    LAT_OFFSET,
    LON0,
    M_E,
    M_LAT,
    M_N,
    M_U,
    POLE,
    Q0,
    SINCE,
    STEP,
    THETA,
    UNDER_WAY,
    V_E,
    V_N,
    V_U,
)
from navcore.mechanization.strapdown.log import held_difference, newest_epoch, usable
from navcore.mechanization.strapdown.step import earth_terms, strapdown_step
from navcore.motion.base import HEADING, LAT, LON, PITCH, ROLL, VE, VN, VU
from navcore.motion.base import HEIGHT as TRUE_HEIGHT

TILT_LIMIT = 1.0
"""Beyond this misalignment (rad) the run has diverged."""
VELOCITY_LIMIT = 1e4
"""Velocity error, m/s."""
_REFRESH = 128
"""Samples after which the Earth terms are formed anew, or one law interval if that is longer."""
_NEEDS_MOTION = 2
"""Policies from this code on may look at heading and acceleration."""


@inlined
def _read_log(t, v_e, v_n, heading, con, x, epoch_s, epoch_v, epoch_valid, s):
    """Take the newest log epoch at or before t and hold its difference V_r - V_c."""
    j, before = newest_epoch(t, int(s[EPOCH_INDEX]), epoch_s), int(s[EPOCH_INDEX])
    if j != before:
        s[EPOCH_INDEX] = j
        s[DIFFERENCE], s[DIFFERENCE + 1] = held_difference(
            t, j, v_e, v_n, heading, con[BODY_LOG] != 0.0, x[LAST_TIME], x[LAST_V_E], x[LAST_V_N],
            epoch_s, epoch_v,
        )  # fmt: skip
    s[VALID] = 1.0 if usable(t, j, con[HOLD], epoch_s, epoch_valid) else 0.0


@inlined
def _law_epoch(t, v_e, v_n, q0, q1, q2, q3, con, x, epoch_s, epoch_v, epoch_valid, p, s, ring):
    """Read the log and ask the law; return the four values that it holds until the next epoch."""
    heading = acceleration = 0.0
    if con[BODY_LOG] != 0.0 or p[POLICY] >= _NEEDS_MOTION:
        heading = heading_of(q0, q1, q2, q3)
        elapsed = t - x[LAST_TIME]
        if elapsed > 0.0:
            acceleration = math.hypot(v_e - x[LAST_V_E], v_n - x[LAST_V_N]) / elapsed
    _read_log(t, v_e, v_n, heading, con, x, epoch_s, epoch_v, epoch_valid, s)
    x[LAST_TIME], x[LAST_V_E], x[LAST_V_N] = t, v_e, v_n
    return law_step(p, s, ring, v_e, v_n, acceleration, heading)


@inlined
def _record_state(
    k, d_lat, d_lon, h, v_e, v_n, v_u, q0, q1, q2, q3, con, truth, errors, s,
    row_steps, rows, navigation, buffer, cursor,
):  # fmt: skip
    """Record state k against its row of the truth; False when it has diverged."""
    i = k if truth.shape[0] > 1 else 0
    lat = con[LAT0] + d_lat
    t0, t1, t2, t3 = quaternion_of(truth[i, PITCH], truth[i, ROLL], truth[i, HEADING])
    phi_e, phi_n, phi_u = misalignment(q0, q1, q2, q3, t0, t1, t2, t3)
    errors[0], errors[1] = v_e - truth[i, VE], v_n - truth[i, VN]
    errors[2], errors[3] = lat - truth[i, LAT], con[LON0] - truth[i, LON] + d_lon
    errors[4], errors[5], errors[6] = phi_e, phi_n, phi_u
    level = abs(phi_e) < TILT_LIMIT and abs(phi_n) < TILT_LIMIT
    slow = math.hypot(errors[0], errors[1]) < VELOCITY_LIMIT
    if not (level and slow and math.isfinite(errors[2] + errors[3] + phi_u + h)):
        return False
    j = cursor[CURSOR_ROW]
    e2, sin_lat = con[E2], math.sin(truth[i, LAT])
    n_cos = prime_vertical_radius(e2, sin_lat) * math.cos(truth[i, LAT])
    record(
        k, errors, meridian_radius(e2, sin_lat), n_cos, s[DAMPED], s[XI], s[WANTED], s[MEASURE],
        row_steps, rows, buffer, cursor,
    )  # fmt: skip
    if cursor[CURSOR_ROW] > j:
        pitch, roll, heading = angles_of(q0, q1, q2, q3)
        navigation[j, 0], navigation[j, 1], navigation[j, 2] = lat, con[LON0] + d_lon, h
        navigation[j, 3], navigation[j, 4], navigation[j, 5] = v_e, v_n, v_u
        navigation[j, 6], navigation[j, 7], navigation[j, 8] = pitch, roll, heading
        navigation[j, 9], navigation[j, 10] = v_u - truth[i, VU], h - truth[i, TRUE_HEIGHT]
    return True


@inlined
def _form_earth_terms(con, x):
    x[LAT_OFFSET] = x[D_LAT]
    for i, term in enumerate(earth_terms(con[E2], con[LAT0] + x[D_LAT], x[HEIGHT])):
        x[EARTH_TERMS + i] = term


@inlined
def _run_block(first, last, increments, con, x, altimeter):
    """Integrate samples first..last of a chunk with what the law holds in x."""
    dt, e2, g_equator, k_gravity = con[STEP], con[E2], con[G_EQUATOR], con[K_GRAVITY]
    k12, k6 = con[K12], con[K6]
    d_lat, d_lon, h, v_e, v_n, v_u = x[D_LAT], x[D_LON], x[HEIGHT], x[V_E], x[V_N], x[V_U]
    q0, q1, q2, q3 = x[Q0], x[Q0 + 1], x[Q0 + 2], x[Q0 + 3]
    z0, z1, z2, z3 = x[CARRY], x[CARRY + 1], x[CARRY + 2], x[CARRY + 3]
    px, py, pz, ex, ey, ez = x[THETA], x[THETA + 1], x[THETA + 2], x[DV], x[DV + 1], x[DV + 2]
    m_e, m_n, m_u, m_lat = x[M_E], x[M_N], x[M_U], x[M_LAT]
    c_e, c_n, a_e, a_n = x[C_E], x[C_N], x[A_E], x[A_N]
    h_rate = a_u = 0.0
    if altimeter:
        h_rate = con[ALT_K1] * x[ALT_DIFFERENCE]
        a_u = con[ALT_K2] * x[ALT_DIFFERENCE] + x[ALT_INTEGRAL]
    origin, sin_0, cos_0 = x[LAT_OFFSET], x[EARTH_TERMS], x[EARTH_TERMS + 1]
    n_0, n_1, m_0, m_1 = x[EARTH_TERMS + 2], x[EARTH_TERMS + 3], x[EARTH_TERMS + 4], x[EARTH_TERMS + 5]
    sec_0, sec_1 = x[EARTH_TERMS + 6], x[EARTH_TERMS + 7]
    for i in range(first, last):
        tx, ty, tz = increments[i, 0], increments[i, 1], increments[i, 2]
        bx, by, bz = increments[i, 3], increments[i, 4], increments[i, 5]
        before = v_u
        (v_e, v_n, v_u, q0, q1, q2, q3, z0, z1, z2, z3, m_e, m_n, m_u, m_lat, m_lon) = strapdown_step(
            dt, e2, g_equator, k_gravity, k12, k6, altimeter,
            tx, ty, tz, bx, by, bz, px, py, pz, ex, ey, ez,
            sin_0, cos_0, n_0, n_1, m_0, m_1, sec_0, sec_1, d_lat - origin + 0.5 * m_lat,
            h, v_e, v_n, v_u, q0, q1, q2, q3, z0, z1, z2, z3, m_e, m_n, m_u,
            c_e, c_n, a_e, a_n, a_u,
        )  # fmt: skip
        d_lat += m_lat
        d_lon += m_lon
        if altimeter:
            h += dt * (0.5 * (before + v_u) + h_rate)
        px, py, pz, ex, ey, ez = tx, ty, tz, bx, by, bz
    x[D_LAT], x[D_LON], x[HEIGHT], x[V_E], x[V_N], x[V_U] = d_lat, d_lon, h, v_e, v_n, v_u
    x[Q0], x[Q0 + 1], x[Q0 + 2], x[Q0 + 3] = q0, q1, q2, q3
    x[CARRY], x[CARRY + 1], x[CARRY + 2], x[CARRY + 3] = z0, z1, z2, z3
    x[THETA], x[THETA + 1], x[THETA + 2], x[DV], x[DV + 1], x[DV + 2] = px, py, pz, ex, ey, ez
    x[M_E], x[M_N], x[M_U], x[M_LAT] = m_e, m_n, m_u, m_lat


@inlined
def _altimeter_epoch(t, interval, con, x, height_s, heights):
    """Hold the difference of altimeter (the true height, linear between its rows) and computed height."""
    place = t / height_s
    i = min(int(place), heights.shape[0] - 1)
    after = min(i + 1, heights.shape[0] - 1)
    measured = heights[i] + min(place - i, 1.0) * (heights[after] - heights[i])
    x[ALT_DIFFERENCE] = measured - x[HEIGHT]
    x[ALT_INTEGRAL] += con[ALT_K3] * interval * x[ALT_DIFFERENCE]


@kernel
def advance_kernel(
    increments, first, final, law_every, record_every, con, x, truth, height_s, heights,
    epoch_s, epoch_v, epoch_valid, p, s, ring, errors, navigation,
    row_steps, rows, stats, bin_width, bin_low, bin_high, bin_order, buffer, cursor,
):  # fmt: skip
    """Run a chunk of increments (n, 6), whose first ends at sample first + 1; return place and code."""
    k, end, dt = first, first + increments.shape[0], con[STEP]
    altimeter = con[ALTIMETER] != 0.0
    refresh = False
    # Counters in place of remainders: two divisions a sample are felt when the law runs at the IMU's rate.
    to_law, to_record, record_number = -k % law_every, -k % record_every, -(-k // record_every)
    while True:
        if k == end and k != final:
            break
        if to_law == 0:
            to_law = law_every
            # At law epochs only, so that the length of the chunks cannot change the result.
            x[SINCE] += law_every
            refresh = x[SINCE] > _REFRESH or k == 0
            if refresh:
                x[SINCE] = 0.0
            if abs(con[LAT0] + x[D_LAT]) > LARGEST_LATITUDE:
                return k, POLE
            x[C_E], x[C_N], x[A_E], x[A_N] = _law_epoch(
                k * dt, x[V_E], x[V_N], x[Q0], x[Q0 + 1], x[Q0 + 2], x[Q0 + 3], con, x,
                epoch_s, epoch_v, epoch_valid, p, s, ring,
            )  # fmt: skip
            if altimeter:
                _altimeter_epoch(k * dt, law_every * dt, con, x, height_s, heights)
        if to_record == 0:
            to_record, r = record_every, record_number
            record_number += 1
            if not _record_state(
                r, x[D_LAT], x[D_LON], x[HEIGHT], x[V_E], x[V_N], x[V_U],
                x[Q0], x[Q0 + 1], x[Q0 + 2], x[Q0 + 3], con, truth, errors, s,
                row_steps, rows, navigation, buffer, cursor,
            ):  # fmt: skip
                flush(max(r - 1, 0), bin_width, buffer, stats, bin_low, bin_high, bin_order, cursor)
                return k, DIVERGED
            if (r + 1) % bin_width == 0 or k == final:
                flush(r, bin_width, buffer, stats, bin_low, bin_high, bin_order, cursor)
        if k == final:
            return k, COMPLETE
        if refresh:
            _form_earth_terms(con, x)
            refresh = False
        n, j = min(to_law, to_record, end - k), k - first
        free = p[DAMPING] == FREE
        at_once = law_every == 1 and not altimeter and (free or is_steady(p, s))
        if at_once:
            # Nothing but the law can come before the next record or the next forming of the Earth terms.
            n = min(to_record, end - k, _REFRESH + 1 - int(x[SINCE]))
        if altimeter:
            _run_block(j, j + n, increments, con, x, True)
        elif at_once and not free:
            n = run_damped(j, j + n, first, increments, con, x, epoch_s, epoch_v, epoch_valid, p, s) - j
        else:
            _run_block(j, j + n, increments, con, x, False)
        if at_once:
            x[SINCE] += n - 1
            to_law = n
        k += n
        to_law -= n
        to_record -= n
    if cursor[CURSOR_BUFFER] > 0:
        flush(record_number - 1, bin_width, buffer, stats, bin_low, bin_high, bin_order, cursor)
    return k, UNDER_WAY
