"""Records of a strapdown run: its constants and its state, each in one place."""

import math

from navcore.foundation.compiled import inlined
from navcore.foundation.records import COUNT, FLAG, REAL, record_type
from navcore.mechanization.strapdown.step import Constants, EarthTerms, Increment, Navigation

CONSTANTS = record_type(
    dt=REAL,  # interval, s
    e2=REAL,  # Earth: eccentricity squared,
    g_equator=REAL,  # gravity at the equator, m/s^2,
    k_gravity=REAL,  # and Somigliana's constant
    two_sample=REAL,  # weights of the compensation terms, 0: none
    third_order=REAL,
    lat0=REAL,  # start, rad
    lon0=REAL,
    height0=REAL,  # m
    altimeter=FLAG,  # vertical channel damped by the altimeter, else locked
    altimeter_k1=REAL,  # 1/s
    altimeter_k2=REAL,  # 1/s^2
    altimeter_k3=REAL,  # 1/s^3
)
"""Constants of a run."""
LAST_CALL = record_type(
    time=REAL,  # s
    v_e=REAL,  # computed velocity, m/s
    v_n=REAL,
    heading=REAL,  # rad; 0 where nothing needs it
)
"""The law's previous call."""
STATE = record_type(
    d_lat=REAL,  # offsets from the start, rad
    d_lon=REAL,
    height=REAL,  # m
    v=(REAL, (3,)),  # E, N, U, m/s
    q=(REAL, (4,)),  # quaternion body to navigation axes
    carry=(REAL, (4,)),  # its carries
    before=(REAL, (6,)),  # previous increment, rad, m/s
    m=(REAL, (3,)),  # changes of velocity over the previous interval, m/s
    m_lat=REAL,  # and of latitude, rad
    c=(REAL, (3,)),  # what the law holds: E, N (m/s), U (rad/s)
    a=(REAL, (2,)),  # m/s^2
    altimeter_difference=REAL,  # measured less computed height at the last law epoch, m
    altimeter_integral=REAL,  # m/s^2
    last=LAST_CALL,
    earth_terms=(REAL, (8,)),  # `step.EarthTerms`
    origin=REAL,  # offset of the latitude at which they were formed, rad
    since=COUNT,  # samples since then
)
"""State of a run."""

NAVIGATION = (
    "lat_rad", "lon_rad", "height_m", "ve_mps", "vn_mps", "vu_mps", "pitch_rad", "roll_rad", "heading_rad",
    "dvu_mps", "dheight_m",
)  # fmt: skip
"""Columns of the navigation rows."""

UNDER_WAY, COMPLETE, DIVERGED, POLE = 0, 1, 2, 3
"""How far a run came."""

LARGEST_LATITUDE = math.radians(89.9)
"""A computed latitude (rad) beyond this ends the run: too near a pole."""


@inlined
def constants_of(con):
    """Constants of a step, out of the record."""
    return Constants(con.dt, con.e2, con.g_equator, con.k_gravity, con.two_sample, con.third_order)


@inlined
def navigation_of(x):
    """Navigation, out of the state."""
    return Navigation(
        x.d_lat, x.d_lon, x.height, x.v[0], x.v[1], x.v[2], x.q[0], x.q[1], x.q[2], x.q[3],
        x.carry[0], x.carry[1], x.carry[2], x.carry[3], x.m[0], x.m[1], x.m[2], x.m_lat,
    )  # fmt: skip


@inlined
def keep_navigation(x, nav):
    """Put the navigation into the state."""
    x.d_lat, x.d_lon, x.height = nav.d_lat, nav.d_lon, nav.height
    x.v[0], x.v[1], x.v[2] = nav.v_e, nav.v_n, nav.v_u
    x.q[0], x.q[1], x.q[2], x.q[3] = nav.q0, nav.q1, nav.q2, nav.q3
    x.carry[0], x.carry[1], x.carry[2], x.carry[3] = nav.z0, nav.z1, nav.z2, nav.z3
    x.m[0], x.m[1], x.m[2], x.m_lat = nav.m_e, nav.m_n, nav.m_u, nav.m_lat


@inlined
def increment_before(x):
    """Previous increment, out of the state."""
    return Increment(x.before[0], x.before[1], x.before[2], x.before[3], x.before[4], x.before[5])


@inlined
def keep_increment(x, now):
    """Put an increment into the state, for the next interval."""
    x.before[0], x.before[1], x.before[2] = now.tx, now.ty, now.tz
    x.before[3], x.before[4], x.before[5] = now.bx, now.by, now.bz


@inlined
def earth_terms_of(x):
    """Earth terms, out of the state."""
    e = x.earth_terms
    return EarthTerms(e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7])


@inlined
def keep_earth_terms(x, terms):
    """Put Earth terms that were formed at the present latitude into the state."""
    x.origin = x.d_lat
    e = x.earth_terms
    e[0], e[1], e[2], e[3] = terms.sin, terms.cos, terms.inv_n, terms.inv_n_slope
    e[4], e[5], e[6], e[7] = terms.inv_m, terms.inv_m_slope, terms.sec, terms.sec_slope
