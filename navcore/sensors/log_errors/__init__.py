"""Terms of the log's error, one file each: fields of the block ``reference`` and what they do to a sample."""

from navcore.sensors.base import load_terms

TERMS = load_terms(
    "navcore.sensors.log_errors.own:LogBias",
    "navcore.sensors.log_errors.own:LogNoise",
    "navcore.sensors.log_errors.own:LogDrift",
    "navcore.sensors.log_errors.reading:LogReading",
    "navcore.sensors.log_errors.water:Water",
    "navcore.sensors.log_errors.events:LogEvents",
)
"""All terms, in the order in which the page offers their fields."""
