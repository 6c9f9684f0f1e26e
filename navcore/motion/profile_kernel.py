"""A profile at the samples of a tile: course, speed and attitude change together. Compiled."""

from navcore.foundation.compiled import kernel
from navcore.foundation.trigonometry import sincos
from navcore.motion.course import (
    COURSE,
    COURSE_CHANGE,
    SHAPE,
    SPEED,
    SPEED_CHANGE,
    SPEED_TIME,
    START,
    leg_at,
    node_at,
    position_at,
    smooth_change,
)
from navcore.motion.kinematics import WIDTH
from navcore.motion.truth import (
    AE,
    AN,
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


@kernel
def fill_profile(t0, dt, legs, nodes, attitude, place, columns, samples, w):
    """Fill the buffer ``w`` (`navcore.motion.kinematics.WIDTH`) with a profile from t0 on.

    ``place`` holds the numbers of leg and node reached, for the next call, which begins ``samples`` steps
    later. Height and vertical motion stay as they are.
    """
    leg, node = place[0], place[1]
    for i in range(columns):
        t = t0 + i * dt
        leg, node = leg_at(t, legs, leg), node_at(t, nodes, node)
        if i == samples - 1:
            place[0], place[1] = leg, node
        w[LAT * WIDTH + i], w[LON * WIDTH + i] = position_at(t, nodes, node)
        done, rate = smooth_change(t - legs[leg, START], legs[leg, SPEED_TIME], 1.0, legs[leg, SHAPE])
        speed, acceleration = (
            legs[leg, SPEED] + done * legs[leg, SPEED_CHANGE],
            rate * legs[leg, SPEED_CHANGE],
        )
        across = speed * rate * legs[leg, COURSE_CHANGE]
        s, c = sincos(legs[leg, COURSE] + done * legs[leg, COURSE_CHANGE])
        w[VE * WIDTH + i], w[VN * WIDTH + i] = speed * s, speed * c
        w[AE * WIDTH + i], w[AN * WIDTH + i] = acceleration * s + across * c, acceleration * c - across * s
        w[PITCH * WIDTH + i] = attitude[leg, 0] + done * attitude[leg, 3]
        w[ROLL * WIDTH + i] = attitude[leg, 1] + done * attitude[leg, 4]
        w[HEADING * WIDTH + i] = attitude[leg, 2] + done * attitude[leg, 5]
        w[PITCH_RATE * WIDTH + i] = rate * attitude[leg, 3]
        w[ROLL_RATE * WIDTH + i] = rate * attitude[leg, 4]
        w[HEADING_RATE * WIDTH + i] = rate * attitude[leg, 5]
