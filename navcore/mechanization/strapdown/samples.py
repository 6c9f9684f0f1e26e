"""The loop over samples, one for every use: with nothing between them, or with the law after each.

When the law runs at the IMU's rate, asking it as `navcore.law.step` does, through its state in memory, would
cost three times the step itself. In the steady state of most runs (policy `constant`, switching `hard`,
damped, vertical channel locked) it does nothing but feed its network: then all of it stays in local
variables. The numbers are those of `law_step`, to the last bit, and the loop hands back as soon as that state
ends: a log sample missing, a pole.
"""

from typing import NamedTuple

from navcore.foundation.compiled import inlined, kernel
from navcore.law.network_state import CARRIED, Channel, channel_of, fed_back, feed, keep_channel
from navcore.law.records import AS_PRINTED, EXTERNAL, E, N, Sensed, U
from navcore.law.step import as_printed
from navcore.mechanization.strapdown.attitude import heading_of
from navcore.mechanization.strapdown.log import LastCall, held_difference, newest_epoch, usable
from navcore.mechanization.strapdown.records import (
    LARGEST_LATITUDE,
    constants_of,
    earth_terms_of,
    increment_before,
    keep_increment,
    keep_navigation,
    navigation_of,
)
from navcore.mechanization.strapdown.step import Held, increment_at, strapdown_step


@inlined
def run_samples(increments, first, last, con, x, altimeter, ask, carried, fixed, network, log):
    """Integrate samples first..last of a chunk, ``ask`` the law after each but the last.

    ``ask(i, nav, carried, told, network, log)`` gives what is carried on, whose ``held`` is what the law
    holds, and whether the loop goes on. Returns the sample at which it ended, and what was carried. (Network
    and log are handed on apart: taken out of a tuple in the loop, their arrays would be counted as in use
    again with each sample.)
    """
    constants, terms, origin = constants_of(con), earth_terms_of(x), x.origin
    nav, before = navigation_of(x), increment_before(x)
    i = first
    while True:
        now = increment_at(increments, i)
        nav = strapdown_step(constants, now, before, nav, terms, origin, carried.held, altimeter)
        before = now
        i += 1
        if i == last:
            break
        carried, goes_on = ask(i, nav, carried, fixed, network, log)
        if not goes_on:
            break
    keep_navigation(x, nav)
    keep_increment(x, before)
    return i, carried


class _Unchanging(NamedTuple):
    held: Held


@inlined
def _ask_nothing(i, nav, carried, fixed, network, log):
    return carried, True


@inlined
def run_held(increments, first, last, con, x, altimeter):
    """Integrate samples first..last of a chunk with what law and altimeter hold."""
    height_rate = a_u = 0.0
    if altimeter:
        height_rate = con.altimeter_k1 * x.altimeter_difference
        a_u = con.altimeter_k2 * x.altimeter_difference + x.altimeter_integral
    held = Held(x.c[E], x.c[N], x.c[U], x.a[E], x.a[N], a_u, height_rate)
    run_samples(increments, first, last, con, x, altimeter, _ask_nothing, _Unchanging(held), 0, 0, 0)


class _Steady(NamedTuple):
    """State of the law while it is steady: all that `law_step` would keep in its state."""

    held: Held
    east: Channel
    north: Channel
    epoch: int
    d_e: float
    d_n: float
    last: LastCall


class _Fixed(NamedTuple):
    """Constants of the loop over samples."""

    start: int  # number of the chunk's first sample
    dt: float
    lat0: float
    external: bool
    as_printed: bool
    order: int
    feedback_k1: float
    feeds_back: bool


@inlined
def is_steady(law):
    """Whether the law now does nothing but feed its network of the level channels, in local variables."""
    short = law.p.order <= CARRIED and law.p.azimuth_order == 0
    return law.p.steady and short and law.s.started and law.s.damped


@inlined
def _newest_difference(t, nav, carried, log):
    """Newest epoch of the log and the difference held from it."""
    epoch = newest_epoch(t, carried.epoch, log)
    if epoch == carried.epoch:
        d_e, d_n = carried.d_e, carried.d_n
    else:
        heading = heading_of(nav.q0, nav.q1, nav.q2, nav.q3) if log.body_frame else 0.0
        d_e, d_n = held_difference(t, epoch, nav.v_e, nav.v_n, heading, carried.last, log)
    return epoch, d_e, d_n


@inlined
def _fed(t, nav, carried, fixed, network):
    """Feed the network of both channels with the difference held."""
    u_e, u_n = (carried.d_e, carried.d_n) if fixed.external else (-nav.v_e, -nav.v_n)
    if fixed.feeds_back:
        a_e, a_n = fed_back(network, carried.east, u_e), fed_back(network, carried.north, u_n)
    else:
        a_e, a_n = fixed.feedback_k1 * u_e, fixed.feedback_k1 * u_n
    c_e, east = feed(fixed.order, network, carried.east, u_e)
    c_n, north = feed(fixed.order, network, carried.north, u_n)
    if fixed.as_printed:
        c_e, c_n = as_printed(c_e, c_n, Sensed(nav.v_e, nav.v_n, 0.0), u_e, u_n)
    held = Held(c_e, c_n, 0.0, a_e, a_n, 0.0, 0.0)
    return _Steady(held, east, north, carried.epoch, carried.d_e, carried.d_n, LastCall(t, nav.v_e, nav.v_n))


@inlined
def _ask_steadily(i, nav, carried, fixed, network, log):
    t = (fixed.start + i) * fixed.dt
    epoch, d_e, d_n = _newest_difference(t, nav, carried, log)
    present = usable(t, epoch, log)
    goes_on = abs(fixed.lat0 + nav.d_lat) <= LARGEST_LATITUDE and (present or not fixed.external)
    carried = _Steady(carried.held, carried.east, carried.north, epoch, d_e, d_n, carried.last)
    if goes_on:
        carried = _fed(t, nav, carried, fixed, network)
    return carried, goes_on


@kernel
def run_steady(increments, first, last, start, con, x, log, law):
    """Integrate samples first..last of a chunk, feeding the law's network after each but the last.

    ``start`` is the number of the chunk's first sample. The law must be steady (`is_steady`) and the vertical
    channel locked. Returns the sample at which that, or the whole, ended.
    """
    p, s, kept = law.p, law.s, x.last
    external, printed = p.damping == EXTERNAL, p.realisation == AS_PRINTED
    fixed = _Fixed(start, con.dt, con.lat0, external, printed, p.order, p.feedback_k1, p.feeds_back)
    carried = _Steady(
        Held(x.c[E], x.c[N], 0.0, x.a[E], x.a[N], 0.0, 0.0), channel_of(s, E), channel_of(s, N),
        s.epoch, s.difference[E], s.difference[N], LastCall(kept.time, kept.v_e, kept.v_n),
    )  # fmt: skip
    i, end = run_samples(
        increments, first, last, con, x, False, _ask_steadily, carried, fixed, s.network, log
    )
    x.c[E], x.c[N], x.a[E], x.a[N] = end.held.c_e, end.held.c_n, end.held.a_e, end.held.a_n
    kept.time, kept.v_e, kept.v_n = end.last.time, end.last.v_e, end.last.v_n
    s.epoch, s.difference[E], s.difference[N] = end.epoch, end.d_e, end.d_n
    s.correction[E], s.correction[N] = end.held.c_e, end.held.c_n
    keep_channel(s, E, end.east)
    keep_channel(s, N, end.north)
    return i
