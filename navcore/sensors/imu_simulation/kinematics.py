"""Kinematic quantities of each motion at the samples of a tile: rows are the columns of `Truth`. Compiled."""

from navcore.foundation.compiled import inlined
from navcore.foundation.trigonometry import sincos_cycles
from navcore.motion.course import course_state_at, leg_at, node_at
from navcore.motion.truth import (
    AE,
    AN,
    COLUMNS,
    HEADING,
    HEADING_RATE,
    LAT,
    LON,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VE,
    VN,
)
from navcore.sensors.imu_simulation.work import W

_TWO_PI = 6.283185307179586


@inlined
def fill_rest(rest, w):
    """All columns are the row of truth ``rest`` (15,)."""
    for j in range(COLUMNS):
        for i in range(W):
            w[j * W + i] = rest[j]


@inlined
def _fill_axis(t0, axes, axis, table, row, rate_row, columns, w):
    mean, amplitude, frequency, phase = axes[axis, 0], axes[axis, 1], axes[axis, 2], axes[axis, 3]
    s, c = sincos_cycles(frequency * t0 + phase)
    rate = _TWO_PI * frequency * amplitude
    for i in range(columns):
        ci, si = table[2 * axis * W + i], table[(2 * axis + 1) * W + i]
        w[row * W + i] = mean + amplitude * (s * ci + c * si)
        w[rate_row * W + i] = rate * (c * ci - s * si)


@inlined
def fill_swing(t0, axes, table, columns, w):
    """Angles and rates of a swing from time t0 on (`SwingMotion.packed`); the other rows stay.

    ``table`` (6 W,): cosine and sine of 2 pi f i dt of each axis. The phase is taken afresh at the tile's
    start, so nothing accumulates over days.
    """
    _fill_axis(t0, axes, 0, table, PITCH, PITCH_RATE, columns, w)
    _fill_axis(t0, axes, 1, table, ROLL, ROLL_RATE, columns, w)
    _fill_axis(t0, axes, 2, table, HEADING, HEADING_RATE, columns, w)


@inlined
def fill_course(t0, dt, legs, nodes, place, columns, samples, w):
    """A course of legs; ``place`` holds the numbers of leg and node reached. Height, pitch, roll stay."""
    leg, node = place[0], place[1]
    for i in range(columns):
        t = t0 + i * dt
        leg, node = leg_at(t, legs, leg), node_at(t, nodes, node)
        if i == samples - 1:
            place[0], place[1] = leg, node
        lat, lon, v_e, v_n, a_e, a_n, heading, turn_rate = course_state_at(t, legs, nodes, leg, node)
        w[LAT * W + i], w[LON * W + i] = lat, lon
        w[VE * W + i], w[VN * W + i], w[AE * W + i], w[AN * W + i] = v_e, v_n, a_e, a_n
        w[HEADING * W + i], w[HEADING_RATE * W + i] = heading, turn_rate
