"""Records of what an exported law has beside the law itself: the log, call by call, and the Earth."""

from navcore.foundation.records import COUNT, FLAG, REAL, record_type

LOG_PARAMETERS = record_type(
    reads=FLAG,  # the law reads the log
    period=COUNT,  # calls between two samples of the log
    hold=COUNT,  # calls for which the last sample counts while none comes
    e2=REAL,  # square of the eccentricity of the Earth's ellipsoid
    height=REAL,  # height above it, m
)
"""Parameters of the reading of the log, and of the Earth."""
LOG_STATE = record_type(
    seen=FLAG,  # there was a sample
    age=COUNT,  # calls since the last one, counted up to ``hold`` + 1
    last=(REAL, (2,)),  # the last sample, m/s
)
"""State of the reading of the log."""
MOTION = record_type(
    step=REAL,  # time between two calls, s
    e2=REAL,  # square of the eccentricity of the Earth's ellipsoid
    g_equator=REAL,  # normal gravity at the equator, m/s^2
    k_gravity=REAL,  # Somigliana's constant
    height=REAL,  # height above the ellipsoid, m
    pitch=REAL,  # of the sensors' axes, rad
    roll=REAL,  # of the sensors' axes, rad
)
"""Parameters of a filter's motion."""
MOTION_STATE = record_type(
    started=FLAG,  # there was a call before
    lat=REAL,  # latitude at the last call, rad
    velocity=(REAL, (2,)),  # at the last call, E and N, m/s
    acceleration=(REAL, (2,)),  # at the last call, E and N, m/s^2
)
"""State of a filter's motion."""
BOX = record_type(
    step=REAL,  # time between two calls, s
    e2=REAL,  # square of the eccentricity of the Earth's ellipsoid
    g_equator=REAL,  # normal gravity at the equator, m/s^2
    k_gravity=REAL,  # Somigliana's constant
    height=REAL,  # height above the ellipsoid, m
    ship_axes=FLAG,  # the log is given to starboard and forward
    own_law=FLAG,  # the INS was damped itself: its correction is taken off
)
"""Parameters of a box beside an INS."""
BOX_STATE = record_type(
    started=FLAG,  # there was a call before
    lat=REAL,  # latitude of the last output, rad
    velocity=(REAL, (2,)),  # of the last output, E and N, m/s
    c=(REAL, (5,)),  # held correction: c_E, c_N (m/s), a_E, a_N (m/s^2), c_U (rad/s)
    e=(REAL, (7,)),  # damped minus given: dV_E, dV_N (m/s), dL, dlambda, phi_E, phi_N, phi_U (rad)
)
"""State of a box beside an INS."""
