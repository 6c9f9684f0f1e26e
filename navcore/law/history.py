"""Memory of the law: clock and a ring with one row a call. Compiled."""

import math

from navcore.foundation.compiled import inlined, kernel
from navcore.law.records import E, N, U

USE_NOTHING, USE_HEADING, USE_ACCELERATION = 0, 1, 2
"""Quantities that a policy wants remembered besides the differences."""


@inlined
def row_of_age(law, age):
    """Row of the history that was written ``age`` calls ago."""
    row = law.s.ring_head - age
    return law.ring[row if row >= 0 else row + law.ring.shape[0]]


@inlined
def difference_e(row):
    """Read V_r - V_c of a row, east."""
    return row.difference[E]


@inlined
def difference_n(row):
    """Read V_r - V_c of a row, north."""
    return row.difference[N]


@inlined
def input_e(row):
    """Read the network's input of a row, east."""
    return row.input[E]


@inlined
def input_n(row):
    """Read the network's input of a row, north."""
    return row.input[N]


@inlined
def auxiliary(row):
    """Read heading or acceleration of a row."""
    return row.auxiliary


@kernel
def mean_of(law, read, age, count):
    """Mean of what ``read`` reads over ``count`` rows, the newest of them written ``age`` calls ago."""
    total = 0.0
    for k in range(age, age + count):
        total += read(row_of_age(law, k))
    return total / count


@kernel
def slide(law, total, read, age, count):
    """Sum of what ``read`` reads over ``count`` rows from ``age`` on, from the ``total`` of the last call.

    One row more than ``age + count`` must be in the ring. Rows not yet written are zero. Formed anew once a
    turn of the ring, so that roundings cannot pile up.
    """
    if law.s.ring_head == 0:
        return count * mean_of(law, read, age, count)
    return total + (read(row_of_age(law, age)) - read(row_of_age(law, age + count)))


@kernel
def remember(law, u_e, u_n, sensed):
    """Advance the clock and take this call's difference, input, state and motion into the history."""
    p, s, ring = law.p, law.s, law.ring
    s.clock = s.clock + p.law_step if s.started else 0.0
    s.fresh = s.fresh + 1 if s.valid else 0
    turned = sensed.heading - s.last_heading if s.started else 0.0
    s.last_heading = sensed.heading
    s.total_heading += turned - 2.0 * math.pi * math.floor(turned / (2.0 * math.pi) + 0.5)
    change_e, change_n = sensed.v_e - s.last_velocity[E], sensed.v_n - s.last_velocity[N]
    s.last_velocity[E], s.last_velocity[N] = sensed.v_e, sensed.v_n
    head = s.ring_head + 1
    head = 0 if head >= ring.shape[0] else head
    s.ring_head = head
    s.ring_fill = min(s.ring_fill + 1, ring.shape[0])
    row = ring[head]
    row.difference[E], row.difference[N] = s.difference[E], s.difference[N]
    row.input[E], row.input[N] = u_e, u_n
    for i in range(p.order):
        row.x[E, i], row.x[N, i] = s.x[E, i], s.x[N, i]
    for i in range(p.azimuth_order):
        row.x[U, i] = s.x[U, i]
    row.auxiliary = 0.0
    if p.remembers == USE_HEADING:
        row.auxiliary = s.total_heading
    elif p.remembers == USE_ACCELERATION:
        row.auxiliary = math.hypot(change_e, change_n) / p.law_step if s.started else 0.0
    row.damped = s.damped
