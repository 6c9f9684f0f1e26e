"""The running network of both channels: start, clear, advance. Compiled; works on the law's state array."""

from __future__ import annotations

from navcore.compiled import inlined
from navcore.control.layout import (
    DAMPING,
    INTERNAL,
    MAX_STATES,
    NETWORK_A,
    NETWORK_B,
    NETWORK_C,
    NETWORK_D,
    NETWORK_STEADY,
    OFFSET,
    ORDER,
    X_E,
    X_N,
)


@inlined
def clear_network(p, s, u_e, u_n):
    """Put the network into its start state for the inputs u_E, u_N (m/s).

    External: empty (no difference before the start, as in the papers). Internal: the steady state, or a
    constant speed would look like an acceleration.
    """
    steady = 1.0 if p[DAMPING] == INTERNAL else 0.0
    s[OFFSET], s[OFFSET + 1] = 0.0, 0.0
    for i in range(int(p[ORDER])):
        s[X_E + i] = steady * s[NETWORK_STEADY + i] * u_e
        s[X_N + i] = steady * s[NETWORK_STEADY + i] * u_n


@inlined
def rest(p, s, u_e, u_n):
    """Put the network into the state at which the inputs u_E, u_N (m/s) leave it at rest."""
    s[OFFSET], s[OFFSET + 1] = 0.0, 0.0
    for i in range(int(p[ORDER])):
        s[X_E + i] = s[NETWORK_STEADY + i] * u_e
        s[X_N + i] = s[NETWORK_STEADY + i] * u_n


@inlined
def _advance_channel(n, s, x, u):
    y = s[NETWORK_D] * u
    x0, x1, x2, x3 = s[x], s[x + 1], s[x + 2], s[x + 3]
    for i in range(n):
        row = NETWORK_A + MAX_STATES * i
        y += s[NETWORK_C + i] * s[x + i]
    for i in range(n):
        row = NETWORK_A + MAX_STATES * i
        s[x + i] += s[row] * x0 + s[row + 1] * x1 + s[row + 2] * x2 + s[row + 3] * x3 + s[NETWORK_B + i] * u
    return y


@inlined
def advance_network(p, s, u_e, u_n):
    """Feed one sample to Q = 1 - H of both channels; return its outputs c_E, c_N (delta form)."""
    n = int(p[ORDER])
    return _advance_channel(n, s, X_E, u_e), _advance_channel(n, s, X_N, u_n)
