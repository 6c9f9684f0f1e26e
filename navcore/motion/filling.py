"""Every motion at the samples of a tile, for the true states and the simulated IMU alike. Compiled.

The buffer is that of `navcore.motion.kinematics.WIDTH`; its rows are the columns of `Truth`.
"""

import numpy as np

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.earth import Earth
from navcore.foundation.trigonometry import sincos_cycles
from navcore.motion.course import course_state_at, leg_at, node_at
from navcore.motion.kinematics import COURSE, PIECES, PROFILE, SWING, WAVES, WIDTH, Kinematics
from navcore.motion.pieces import fill_pieces
from navcore.motion.profile_kernel import fill_profile
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
from navcore.motion.wave_kernels import fill_waves

_TWO_PI = 6.283185307179586


@inlined
def fill_rest(rest, w):
    """All columns are the row of truth ``rest`` (15,)."""
    for j in range(COLUMNS):
        for i in range(WIDTH):
            w[j * WIDTH + i] = rest[j]


@inlined
def _fill_axis(t0, axes, axis, table, row, rate_row, columns, w):
    mean, amplitude, frequency, phase = axes[axis, 0], axes[axis, 1], axes[axis, 2], axes[axis, 3]
    s, c = sincos_cycles(frequency * t0 + phase)
    rate = _TWO_PI * frequency * amplitude
    for i in range(columns):
        ci, si = table[2 * axis * WIDTH + i], table[(2 * axis + 1) * WIDTH + i]
        w[row * WIDTH + i] = mean + amplitude * (s * ci + c * si)
        w[rate_row * WIDTH + i] = rate * (c * ci - s * si)


@inlined
def fill_swing(t0, axes, table, columns, w):
    """Angles and rates of a swing from time t0 on (`SwingMotion.packed`); the other rows stay.

    ``table`` (6 WIDTH,): cosine and sine of 2 pi f i dt of each axis. The phase is taken afresh at the tile's
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
        w[LAT * WIDTH + i], w[LON * WIDTH + i] = lat, lon
        w[VE * WIDTH + i], w[VN * WIDTH + i], w[AE * WIDTH + i], w[AN * WIDTH + i] = v_e, v_n, a_e, a_n
        w[HEADING * WIDTH + i], w[HEADING_RATE * WIDTH + i] = heading, turn_rate


@inlined
def fill_motion(
    kind, t0, dt, rest, oscillations, turns, legs, nodes, attitude, place, e2, columns, padded, samples, w
):
    """Fill ``columns`` columns, t0 on; the next call begins ``samples`` steps later. A motion at rest stays.

    ``kind`` to ``attitude``: the motion (`Kinematics`), ``turns`` of its oscillations; ``place`` (2,): legs
    and nodes reached; ``padded``: columns in whole vectors, or the rest of a row would be done one by one.
    """
    if kind == COURSE:
        fill_course(t0, dt, legs, nodes, place, columns, samples, w)
    elif kind == PIECES:
        fill_pieces(t0, dt, legs, place, e2, columns, samples, w)
    elif kind == PROFILE:
        fill_profile(t0, dt, legs, nodes, attitude, place, columns, samples, w)
    elif kind == WAVES:
        fill_waves(t0, dt, oscillations, turns, rest, nodes, place, padded, samples, w)
    elif kind == SWING:
        fill_swing(t0, oscillations, turns, padded, w)


@kernel
def _sample(kind, rest, oscillations, turns, legs, nodes, attitude, e2, step, out):
    w, place = np.repeat(rest, WIDTH), np.zeros(2, np.int64)
    for first in range(0, out.shape[0], WIDTH):
        rows = min(WIDTH, out.shape[0] - first)
        fill_motion(
            kind, first * step, step, rest, oscillations, turns, legs, nodes, attitude, place, e2, rows, rows,
            rows, w,
        )  # fmt: skip
        for i in range(rows):
            for j in range(COLUMNS):
                out[first + i, j] = w[j * WIDTH + i]


def sample(motion: Kinematics, count: int, step_s: float, earth: Earth) -> np.ndarray:
    """Rows of truth at t = 0, step_s, ...

    Parameters
    ----------
    motion : Kinematics
        Any motion, laid as far as the last of these times.
    count, step_s
        The times.
    earth : Earth
        Gives the radii of curvature.

    Returns
    -------
    ndarray, shape (count, 15)
        Columns of `navcore.motion.truth`; heading and longitude are not wrapped.
    """
    out = np.empty((count, COLUMNS))
    _sample(
        motion.kind, motion.rest, motion.oscillations, motion.turns(step_s), motion.legs, motion.nodes,
        motion.attitude, earth.e2, float(step_s), out,
    )  # fmt: skip
    return out
