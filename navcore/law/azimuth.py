"""The network of the azimuth channel: the correction of the platform's turn about the vertical. Compiled.

The platform is commanded to turn with omega_U + c_U, c_U = (1 - Y) u: external u = omega_Ur - omega_U, the
rate that the log's velocity and its dead-reckoned latitude L_r give against the computed one; internal
u = -omega_U (theory.md 3.7). L_r - L_c is the integral of the held difference, so it is kept instead of L_r.
"""

from typing import NamedTuple

from navcore.foundation.compiled import inlined
from navcore.law.network_state import advance_channel
from navcore.law.records import CLEAR, REST, E, N, U
from navcore.law.step import Correction


class UpRate(NamedTuple):
    """The computed rate about the vertical, omega_U = Omega sin L + V_E tan L/(N + h), and its slopes.

    Attributes
    ----------
    rate : float
        rad/s.
    by_lat, by_v_e : float
        d(omega_U)/dL (1/s) and d(omega_U)/dV_E (rad/m).
    inv_m : float
        1/(M + h), 1/m.
    earth_n : float
        Omega cos L, rad/s.
    """

    rate: float
    by_lat: float
    by_v_e: float
    inv_m: float
    earth_n: float


@inlined
def _difference(law, up):
    """Return omega_Ur - omega_U, rad/s, held from the log's epoch as V_r - V_c is."""
    s = law.s
    if s.epoch != s.azimuth_epoch:
        s.azimuth_epoch = s.epoch
        s.azimuth_input = up.by_lat * s.latitude + up.by_v_e * s.difference[E]
    return s.azimuth_input


@inlined
def _compass(law, c, up):
    """North channel and azimuth of a gyrocompass: w' = -K_U4 w + K_U3 dv_N/(Omega cos L), theory.md 3.8."""
    p, s = law.p, law.s
    w = s.x[U, 0]
    if s.action == CLEAR or not s.steered:
        w, s.steered = 0.0, True
    if not s.damped:
        s.x[U, 0] = s.correction[N] = s.correction[U] = 0.0
        return Correction(c.c_e, 0.0, c.a_e, 0.0), 0.0
    d_n = s.difference[N]
    after = p.compass.left * w - p.compass.gain * d_n / up.earth_n
    s.x[U, 0] = after
    c_n, c_u = -p.compass.k2 * d_n, 0.5 * (w + after)
    s.correction[N], s.correction[U] = c_n, c_u
    return Correction(c.c_e, c_n, c.a_e, p.compass.k1 * d_n), c_u


@inlined
def steer(law, c, up):
    """Return the `Correction` c as the azimuth channel leaves it, and its own c_U (rad/s).

    To be called after `navcore.law.step.law_step`, which gives c and decides.
    """
    p, s = law.p, law.s
    if p.gyrocompass:
        return _compass(law, c, up)
    if s.level_only:
        s.steered, s.correction[U] = False, 0.0
        return c, 0.0
    external = not s.internal
    if s.action == CLEAR or not s.steered:
        s.latitude, s.azimuth_epoch, s.steered = 0.0, -2, True
        u = 0.0 if external else -up.rate
        for i in range(p.azimuth_order):
            s.x[U, i] = s.azimuth.steady[i] * u
    u = -up.rate
    if external:
        u = _difference(law, up)
    if s.action == REST:
        for i in range(p.azimuth_order):
            s.x[U, i] = s.azimuth.steady[i] * u
    if not s.damped:
        s.correction[U] = 0.0
        return c, 0.0
    c_u = advance_channel(p.azimuth_order, s.azimuth, s, U, u)
    if external:
        s.latitude += s.difference[N] * up.inv_m * p.law_step
    s.correction[U] = c_u
    return c, c_u
