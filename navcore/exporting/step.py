"""One call of an exported law: from what a navigation computer has at hand to what it is to do. Compiled.

The program replays these functions (`navcore.exporting.replay`), and `navcore.exporting.reading` reads them:
the vectors and the exported program have one source.
"""

import math
from typing import Any, NamedTuple

from navcore.foundation.compiled import inlined
from navcore.foundation.earth import EARTH_RATE, meridian_radius, prime_vertical_radius
from navcore.law.azimuth import UpRate, steer
from navcore.law.law import law_step
from navcore.law.records import E, N, Sensed

NO_SAMPLE, SAMPLE, NOT_YET = 0, 1, 2
"""Words of ``log_valid``: the log has none, a sample, none yet."""


class Commands(NamedTuple):
    """Outputs of a call, in the order of the contract; then the velocity that is given out."""

    v_star_e_mps: float
    v_star_n_mps: float
    feedback_e_mps2: float
    feedback_n_mps2: float
    azimuth_rate_radps: float
    damped: bool
    v_out_e_mps: float
    v_out_n_mps: float


class Reading(NamedTuple):
    """How the log comes: `navcore.exporting.records.LOG_PARAMETERS` and `LOG_STATE`."""

    p: Any
    s: Any


@inlined
def read_sample(reading, s, given):
    """Take the log's sample: between two of them the difference V_r - V_c of the last one is held.

    A sample that is given again before the next one is due is the same sample.
    """
    p, m = reading.p, reading.s
    if m.age <= p.hold:
        m.age += 1
    early = m.seen and m.age < p.period
    again = early and given.log_e_mps == m.last[E] and given.log_n_mps == m.last[N]
    if given.log_valid == SAMPLE:
        if not again:
            m.seen, m.age = True, 0
            m.last[E], m.last[N] = given.log_e_mps, given.log_n_mps
            s.epoch += 1
            s.difference[E] = given.log_e_mps - given.v_e_mps
            s.difference[N] = given.log_n_mps - given.v_n_mps
            s.valid = True
    elif given.log_valid == NO_SAMPLE and not early:
        s.valid = False
    if m.age > p.hold:
        s.valid = False


@inlined
def up_rate(p, given):
    """Computed rate about the vertical, and its slopes, at the computed latitude and velocity."""
    sin, cos = math.sin(given.lat_rad), math.cos(given.lat_rad)
    inv_m = 1.0 / (meridian_radius(p.e2, sin) + p.height)
    inv_n = 1.0 / (prime_vertical_radius(p.e2, sin) + p.height)
    earth_n, by_v_e = EARTH_RATE * cos, sin / cos * inv_n
    by_lat = earth_n + given.v_e_mps * inv_n / (cos * cos)
    return UpRate(EARTH_RATE * sin + given.v_e_mps * by_v_e, by_lat, by_v_e, inv_m, earth_n)


@inlined
def step(law, reading, given):
    """One call of the law: the velocities of the transport rate, V* = V_c + c, and what is fed back."""
    s = law.s
    if reading.p.reads:
        read_sample(reading, s, given)
    c, c_u = law_step(law, Sensed(given.v_e_mps, given.v_n_mps, given.yaw_rad)), 0.0
    if law.p.azimuth_order > 0:
        c, c_u = steer(law, c, up_rate(reading.p, given))
    return Commands(
        given.v_e_mps + c.c_e,
        given.v_n_mps + c.c_n,
        c.a_e,
        c.a_n,
        c_u,
        s.damped,
        given.v_e_mps - s.output[E],
        given.v_n_mps - s.output[N],
    )
