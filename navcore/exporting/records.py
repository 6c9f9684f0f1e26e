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
