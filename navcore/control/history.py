"""What the law remembers: clock and a ring with one row a call. Compiled."""

from __future__ import annotations

import math

from navcore.compiled import inlined, kernel
from navcore.control.layout import (
    CLOCK,
    DAMPED,
    DIFFERENCE,
    FRESH,
    LAST_HEADING,
    LAW_STEP,
    MAX_STATES,
    RING_AUXILIARY,
    RING_DAMPED,
    RING_DIFFERENCE,
    RING_FILL,
    RING_HEAD,
    RING_INPUT,
    RING_X,
    STARTED,
    TOTAL_HEADING,
    VALID,
    X_E,
)

USE_NOTHING, USE_HEADING, USE_ACCELERATION = 0, 1, 2
"""What a policy wants remembered besides the differences."""


@inlined
def row_of_age(s, ring, age):
    """Row of the ring that was written ``age`` calls ago."""
    row = int(s[RING_HEAD]) - age
    return row if row >= 0 else row + ring.shape[0]


@inlined
def samples(p, seconds):
    """Law calls in a time, at least one."""
    return max(1, int(math.floor(seconds / p[LAW_STEP] + 0.5)))


@kernel
def mean_of(s, ring, column, age, count):
    """Mean of a column over ``count`` rows, the newest of them written ``age`` calls ago."""
    total = 0.0
    for k in range(age, age + count):
        total += ring[row_of_age(s, ring, k), column]
    return total / count


@kernel
def remember(p, s, ring, u_e, u_n, accel, heading, use):
    """Advance the clock and take this call's difference, input, state and motion into the history."""
    starting = s[STARTED] == 0.0
    s[CLOCK] = 0.0 if starting else s[CLOCK] + p[LAW_STEP]
    s[FRESH] = s[FRESH] + 1.0 if s[VALID] != 0.0 else 0.0
    turned = 0.0 if starting else heading - s[LAST_HEADING]
    s[LAST_HEADING] = heading
    s[TOTAL_HEADING] += turned - 2.0 * math.pi * math.floor(turned / (2.0 * math.pi) + 0.5)
    head = int(s[RING_HEAD]) + 1
    head = 0 if head >= ring.shape[0] else head
    s[RING_HEAD] = head
    s[RING_FILL] = min(s[RING_FILL] + 1.0, float(ring.shape[0]))
    ring[head, RING_DIFFERENCE], ring[head, RING_DIFFERENCE + 1] = s[DIFFERENCE], s[DIFFERENCE + 1]
    ring[head, RING_INPUT], ring[head, RING_INPUT + 1] = u_e, u_n
    for i in range(2 * MAX_STATES):
        ring[head, RING_X + i] = s[X_E + i]
    ring[head, RING_AUXILIARY] = (
        s[TOTAL_HEADING] if use == USE_HEADING else accel if use == USE_ACCELERATION else 0.0
    )
    ring[head, RING_DAMPED] = s[DAMPED]


@kernel
def slide(s, ring, place, column, age, count):
    """Keep in ``s[place]`` the sum of a column over ``count`` rows from ``age`` on; return it.

    One row more than ``age + count`` must be in the ring. Rows not yet written are zero. Formed anew once a
    turn of the ring, so that roundings cannot pile up.
    """
    if int(s[RING_HEAD]) == 0:
        s[place] = count * mean_of(s, ring, column, age, count)
    else:
        entering = ring[row_of_age(s, ring, age), column]
        s[place] += entering - ring[row_of_age(s, ring, age + count), column]
    return s[place]
