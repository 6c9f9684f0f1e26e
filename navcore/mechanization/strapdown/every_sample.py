"""The damping law at the IMU's rate: law and step in one loop, everything in local variables.

What `kernel` does once an interval would cost three times the step itself when the interval is one sample.
This loop is for the steady state of most runs only: policy `constant`, switching `hard`, damped, vertical
channel locked. It gives, to the last bit, what `control.law` gives there, and hands back as soon as that
state ends: a log sample missing, a pole.
"""

from __future__ import annotations

from navcore.compiled import inlined, kernel
from navcore.control.layout import (
    AS_PRINTED,
    CORRECTION,
    DAMPED,
    DAMPING,
    DIFFERENCE,
    EPOCH_INDEX,
    EXTERNAL,
    FEEDBACK_K1,
    NETWORK_A,
    NETWORK_B,
    NETWORK_C,
    NETWORK_D,
    ORDER,
    POLICY,
    REALISATION,
    STARTED,
    SWITCHING,
    X_E,
    X_N,
)
from navcore.control.policy.constant import Constant
from navcore.control.switching.hard import Hard
from navcore.mechanization.strapdown.attitude import heading_of
from navcore.mechanization.strapdown.layout import (
    A_E,
    A_N,
    BODY_LOG,
    C_E,
    C_N,
    CARRY,
    D_LAT,
    D_LON,
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
    M_E,
    M_LAT,
    M_N,
    Q0,
    STEP,
    THETA,
    V_E,
    V_N,
)
from navcore.mechanization.strapdown.log import held_difference, newest_epoch, usable
from navcore.mechanization.strapdown.step import strapdown_step

_CONSTANT, _HARD = Constant.code, Hard.code


@inlined
def is_steady(p, s):
    """Whether the law now does nothing but feed its network."""
    unchanging = p[POLICY] == _CONSTANT and p[SWITCHING] == _HARD
    return unchanging and s[STARTED] != 0.0 and s[DAMPED] != 0.0


@inlined
def _output(s, u, x0, x1, x2, x3):
    """Output of Q = 1 - H of one channel; states beyond the order are zero."""
    y = s[NETWORK_D] * u + s[NETWORK_C] * x0 + s[NETWORK_C + 1] * x1
    return y + s[NETWORK_C + 2] * x2 + s[NETWORK_C + 3] * x3


@inlined
def _change(i, s, u, x0, x1, x2, x3):
    """Change of state i over a step."""
    a = NETWORK_A + 4 * i
    return s[a] * x0 + s[a + 1] * x1 + s[a + 2] * x2 + s[a + 3] * x3 + s[NETWORK_B + i] * u


@inlined
def _fed(order, s, u, x0, x1, x2, x3):
    """Output and the states after the step."""
    y = _output(s, u, x0, x1, x2, x3)
    if order > 2:
        return (
            y,
            x0 + _change(0, s, u, x0, x1, x2, x3),
            x1 + _change(1, s, u, x0, x1, x2, x3),
            x2 + _change(2, s, u, x0, x1, x2, x3),
            x3 + _change(3, s, u, x0, x1, x2, x3),
        )
    return y, x0 + _change(0, s, u, x0, x1, 0.0, 0.0), x1 + _change(1, s, u, x0, x1, 0.0, 0.0), x2, x3


@kernel
def run_damped(first, last, start, increments, con, x, epoch_s, epoch_v, epoch_valid, p, s):
    """Integrate samples first..last of a chunk, asking the law before each but the first.

    ``start`` is the number of the chunk's first sample. The law must be steady (`is_steady`). Returns the
    sample at which that, or the whole, ended.
    """
    dt, e2, g_equator, k_gravity = con[STEP], con[E2], con[G_EQUATOR], con[K_GRAVITY]
    k12, k6, lat0, body, hold = con[K12], con[K6], con[LAT0], con[BODY_LOG] != 0.0, con[HOLD]
    external, as_printed = p[DAMPING] == EXTERNAL, p[REALISATION] == AS_PRINTED
    order, feedback = int(p[ORDER]), p[FEEDBACK_K1]
    d_lat, d_lon, height, v_e, v_n = x[D_LAT], x[D_LON], x[HEIGHT], x[V_E], x[V_N]
    q0, q1, q2, q3 = x[Q0], x[Q0 + 1], x[Q0 + 2], x[Q0 + 3]
    z0, z1, z2, z3 = x[CARRY], x[CARRY + 1], x[CARRY + 2], x[CARRY + 3]
    px, py, pz, ex, ey, ez = x[THETA], x[THETA + 1], x[THETA + 2], x[DV], x[DV + 1], x[DV + 2]
    m_e, m_n, m_lat = x[M_E], x[M_N], x[M_LAT]
    c_e, c_n, a_e, a_n = x[C_E], x[C_N], x[A_E], x[A_N]
    origin, sin_0, cos_0 = x[LAT_OFFSET], x[EARTH_TERMS], x[EARTH_TERMS + 1]
    n_0, n_1, m_0, m_1 = x[EARTH_TERMS + 2], x[EARTH_TERMS + 3], x[EARTH_TERMS + 4], x[EARTH_TERMS + 5]
    sec_0, sec_1 = x[EARTH_TERMS + 6], x[EARTH_TERMS + 7]
    epoch, u_e, u_n = int(s[EPOCH_INDEX]), s[DIFFERENCE], s[DIFFERENCE + 1]
    d_e, d_n = u_e, u_n
    last_t, last_e, last_n = x[LAST_TIME], x[LAST_V_E], x[LAST_V_N]
    e0, e1, e2_, e3 = s[X_E], s[X_E + 1], s[X_E + 2], s[X_E + 3]
    f0, f1, f2, f3 = s[X_N], s[X_N + 1], s[X_N + 2], s[X_N + 3]
    i = first
    while True:
        tx, ty, tz = increments[i, 0], increments[i, 1], increments[i, 2]
        bx, by, bz = increments[i, 3], increments[i, 4], increments[i, 5]
        (v_e, v_n, _, q0, q1, q2, q3, z0, z1, z2, z3, m_e, m_n, _, m_lat, m_lon) = strapdown_step(
            dt, e2, g_equator, k_gravity, k12, k6, False,
            tx, ty, tz, bx, by, bz, px, py, pz, ex, ey, ez,
            sin_0, cos_0, n_0, n_1, m_0, m_1, sec_0, sec_1, d_lat - origin + 0.5 * m_lat,
            height, v_e, v_n, 0.0, q0, q1, q2, q3, z0, z1, z2, z3, m_e, m_n, 0.0,
            c_e, c_n, a_e, a_n, 0.0,
        )  # fmt: skip
        d_lat += m_lat
        d_lon += m_lon
        px, py, pz, ex, ey, ez = tx, ty, tz, bx, by, bz
        i += 1
        if i == last or abs(lat0 + d_lat) > LARGEST_LATITUDE:
            break
        t = (start + i) * dt
        newest = newest_epoch(t, epoch, epoch_s)
        if newest != epoch:
            epoch = newest
            heading = heading_of(q0, q1, q2, q3) if body else 0.0
            d_e, d_n = held_difference(
                t, epoch, v_e, v_n, heading, body, last_t, last_e, last_n, epoch_s, epoch_v
            )
        if external and not usable(t, epoch, hold, epoch_s, epoch_valid):
            break
        last_t, last_e, last_n = t, v_e, v_n
        u_e, u_n = (d_e, d_n) if external else (-v_e, -v_n)
        c_e, e0, e1, e2_, e3 = _fed(order, s, u_e, e0, e1, e2_, e3)
        c_n, f0, f1, f2, f3 = _fed(order, s, u_n, f0, f1, f2, f3)
        if as_printed:
            c_e -= v_e + u_e
            c_n -= v_n + u_n
        a_e, a_n = feedback * u_e, feedback * u_n
    x[D_LAT], x[D_LON], x[V_E], x[V_N] = d_lat, d_lon, v_e, v_n
    x[Q0], x[Q0 + 1], x[Q0 + 2], x[Q0 + 3] = q0, q1, q2, q3
    x[CARRY], x[CARRY + 1], x[CARRY + 2], x[CARRY + 3] = z0, z1, z2, z3
    x[THETA], x[THETA + 1], x[THETA + 2], x[DV], x[DV + 1], x[DV + 2] = px, py, pz, ex, ey, ez
    x[M_E], x[M_N], x[M_LAT] = m_e, m_n, m_lat
    x[C_E], x[C_N], x[A_E], x[A_N] = c_e, c_n, a_e, a_n
    x[LAST_TIME], x[LAST_V_E], x[LAST_V_N] = last_t, last_e, last_n
    s[EPOCH_INDEX], s[DIFFERENCE], s[DIFFERENCE + 1] = epoch, d_e, d_n
    s[CORRECTION], s[CORRECTION + 1] = c_e, c_n
    s[X_E], s[X_E + 1], s[X_E + 2], s[X_E + 3] = e0, e1, e2_, e3
    s[X_N], s[X_N + 1], s[X_N + 2], s[X_N + 3] = f0, f1, f2, f3
    return i
