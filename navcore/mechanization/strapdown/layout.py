"""Where everything lies in the arrays of a strapdown run."""

from __future__ import annotations

import math

# State x, float64, shape (STATE,).
D_LAT, D_LON, HEIGHT = 0, 1, 2  # offsets from the start (rad), height (m)
V_E, V_N, V_U = 3, 4, 5  # m/s
Q0 = 6  # quaternion body -> navigation, 4 values
CARRY = 10  # their carries, 4 values
THETA, DV = 14, 17  # previous increments, 3 values each
M_E, M_N, M_U, M_LAT = 20, 21, 22, 23  # changes over the previous interval
SINCE = 35  # samples since the Earth terms were formed
LAT_OFFSET = 24  # of the latitude at which the Earth terms were formed, rad
C_E, C_N, A_E, A_N = 26, 27, 28, 29  # what the law holds
ALT_INTEGRAL, ALT_DIFFERENCE = 30, 31  # vertical channel: m/s^2, m
LAST_V_E, LAST_V_N, LAST_TIME = 32, 33, 34  # at the previous law epoch
EARTH_TERMS = 36  # 8 values, `step.earth_terms`
STATE = 48

# Constants, float64, shape (CONSTANTS,).
STEP, E2, G_EQUATOR, K_GRAVITY, K12, K6 = 0, 1, 2, 3, 4, 5
LAT0, LON0 = 6, 7
ALTIMETER = 8  # 0 locked, 1 damped by the altimeter
ALT_K1, ALT_K2, ALT_K3 = 9, 10, 11
BODY_LOG, HOLD = 12, 13  # reference in the body frame (0/1), hold time (s)
HEIGHT0 = 14
CONSTANTS = 16

# Navigation rows.
NAVIGATION = (
    "lat_rad", "lon_rad", "height_m", "ve_mps", "vn_mps", "vu_mps", "pitch_rad", "roll_rad", "heading_rad",
    "dvu_mps", "dheight_m",
)  # fmt: skip

UNDER_WAY, COMPLETE, DIVERGED, POLE = 0, 1, 2, 3

LARGEST_LATITUDE = math.radians(89.9)
"""A computed latitude (rad) beyond this ends the run: too near a pole."""
