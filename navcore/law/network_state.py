"""The running network of both channels: start, clear, feed. Compiled."""

from typing import NamedTuple

from navcore.foundation.compiled import inlined, kernel
from navcore.law.records import E, N

CARRIED = 4
"""States of a channel that run in local variables; a network with more runs in the law's state, in loops."""


class Channel(NamedTuple):
    """States in one channel of a network of at most `CARRIED`, zero beyond its order."""

    x0: float
    x1: float
    x2: float
    x3: float


@inlined
def clear_network(law, u_e, u_n):
    """Put the network into its start state for the inputs u_E, u_N (m/s).

    External: empty (no difference before the start, as in the papers). Internal: the steady state, or a
    constant speed would look like an acceleration.
    """
    p, s = law.p, law.s
    steady = 1.0 if s.internal else 0.0
    s.offset[E] = s.offset[N] = 0.0
    for i in range(p.order):
        s.x[E, i] = steady * s.network.steady[i] * u_e
        s.x[N, i] = steady * s.network.steady[i] * u_n


@inlined
def rest(law, u_e, u_n):
    """Put the network into the state at which the inputs u_E, u_N (m/s) leave it at rest."""
    s = law.s
    s.offset[E] = s.offset[N] = 0.0
    for i in range(law.p.order):
        s.x[E, i] = s.network.steady[i] * u_e
        s.x[N, i] = s.network.steady[i] * u_n


@inlined
def _change(network, i, x, u):
    dA = network.dA
    return dA[i, 0] * x.x0 + dA[i, 1] * x.x1 + dA[i, 2] * x.x2 + dA[i, 3] * x.x3 + network.B[i] * u


@inlined
def feed(order, network, x, u):
    """Feed one sample to Q = 1 - H of one channel; return its output (delta form) and its next states.

    For at most `CARRIED` states.
    """
    y = network.D * u + network.C[0] * x.x0 + network.C[1] * x.x1
    y = y + network.C[2] * x.x2 + network.C[3] * x.x3
    if order > 2:
        return y, Channel(
            x.x0 + _change(network, 0, x, u),
            x.x1 + _change(network, 1, x, u),
            x.x2 + _change(network, 2, x, u),
            x.x3 + _change(network, 3, x, u),
        )
    two = Channel(x.x0, x.x1, 0.0, 0.0)
    return y, Channel(x.x0 + _change(network, 0, two, u), x.x1 + _change(network, 1, two, u), x.x2, x.x3)


@inlined
def fed_back(network, x, u):
    """Second output of the network for one sample, m/s^2: before `feed`, which moves the states.

    For at most `CARRIED` states.
    """
    a = network.F * u + network.E[0] * x.x0 + network.E[1] * x.x1
    return a + network.E[2] * x.x2 + network.E[3] * x.x3


@inlined
def channel_of(s, channel):
    """States of a channel as they lie in the law's state."""
    return Channel(s.x[channel, 0], s.x[channel, 1], s.x[channel, 2], s.x[channel, 3])


@inlined
def keep_channel(s, channel, x):
    """Put the states of a channel back into the law's state."""
    s.x[channel, 0], s.x[channel, 1], s.x[channel, 2], s.x[channel, 3] = x.x0, x.x1, x.x2, x.x3


@kernel
def _feed_long(order, network, s, channel, u):
    """Feed one sample to a channel of more than `CARRIED` states in the law's state; return its output."""
    y = network.D * u
    for i in range(order):
        y += network.C[i] * s.x[channel, i]
        change = network.B[i] * u
        for j in range(order):
            change += network.dA[i, j] * s.x[channel, j]
        network.change[i] = change
    for i in range(order):
        s.x[channel, i] += network.change[i]
    return y


@kernel
def _fed_back_long(order, network, s, channel, u):
    """Second output of a network of more than `CARRIED` states."""
    a = network.F * u
    for i in range(order):
        a += network.E[i] * s.x[channel, i]
    return a


@inlined
def advance_channel(order, network, s, channel, u):
    """Feed one sample to a channel in the law's state; return its output."""
    if order > CARRIED:
        return _feed_long(order, network, s, channel, u)
    y, x = feed(order, network, channel_of(s, channel), u)
    keep_channel(s, channel, x)
    return y


@inlined
def second_output(order, network, s, channel, u):
    """Second output of a channel in the law's state, m/s^2: before `advance_channel` moves it."""
    if order > CARRIED:
        return _fed_back_long(order, network, s, channel, u)
    return fed_back(network, channel_of(s, channel), u)


@inlined
def advance_network(law, u_e, u_n):
    """Feed one sample to both channels in the law's state; return their outputs c_E, c_N."""
    p, s = law.p, law.s
    if p.order > CARRIED:
        c_e = _feed_long(p.order, s.network, s, E, u_e)
        return c_e, _feed_long(p.order, s.network, s, N, u_n)
    c_e, east = feed(p.order, s.network, channel_of(s, E), u_e)
    c_n, north = feed(p.order, s.network, channel_of(s, N), u_n)
    keep_channel(s, E, east)
    keep_channel(s, N, north)
    return c_e, c_n
