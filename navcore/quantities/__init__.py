"""Quantities by which a design is judged, and errors that a run records: one row each. Lists select rows."""

from navcore.quantities.errors import (
    COMPONENTS,
    ERRORS,
    HEADING,
    KINDS,
    NAMES,
    POSITION,
    STATISTICS,
    TILT,
    VELOCITY,
    Kind,
    RecordedError,
    budgeted,
    components,
)
from navcore.quantities.table import OBJECTIVES, QUANTITIES, TUNED, WEIGHED, Judged, Quantity, searched

__all__ = [
    "COMPONENTS",
    "ERRORS",
    "HEADING",
    "KINDS",
    "NAMES",
    "OBJECTIVES",
    "POSITION",
    "QUANTITIES",
    "STATISTICS",
    "TILT",
    "TUNED",
    "VELOCITY",
    "WEIGHED",
    "Judged",
    "Kind",
    "Quantity",
    "RecordedError",
    "budgeted",
    "components",
    "searched",
]
