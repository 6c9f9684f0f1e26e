"""Words of choosers for the values of a file: ``external`` is "external (log)"."""

import re

from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES

_AXES = re.compile("[rlfbud]{3}")
"""Axes of an instrument, such as ``rfu``."""
_WORDS = {
    # damping
    "free": Text("free (undamped)"),
    "internal": Text("internal (no log)"),
    "external": Text("external (log)"),
    "averaging": Text("averaging (half period)"),
    "kalman": Text("Kalman filter"),
    # policy
    "constant": Text("constant (always)"),
    "threshold": Text("threshold (difference)"),
    "yaw_rate": Text("yaw rate"),
    "variation": Text("variation (of the log)"),
    "adaptive": Text("adaptive (coefficient)"),
    "schedule": Text("schedule (of gains)"),
    "mobility": Text("mobility (gains by acceleration)"),
    "states": Text("states (five of Sun)"),
    # switching
    "hard": Text("hard (reset)"),
    "keep": Text("keep (runs on)"),
    "ramp": Text("ramp (of coefficient)"),
    # run, log, motion
    "channel": Text("single channel"),
    "error_model": Text("error model"),
    "strapdown": Text("full strapdown"),
    "wgs84": Text("WGS 84 ellipsoid"),
    "enu": Text("east and north (ENU)"),
    "body": Text("ship's axes"),
    "water": Text("through water"),
    "ground": Text("over ground"),
    "raised_cosine": Text("raised cosine"),
    "half_sine": Text("half sine"),
    "bretschneider": Text("Bretschneider"),
    "pierson_moskowitz": Text("Pierson-Moskowitz"),
    "static": Text("static (at rest)"),
    "legs": Text("legs (manoeuvres)"),
    "track": Text("track (recorded)"),
    "as_printed": Text("as printed"),
}


def choice_words(value: str) -> str:
    """Words for a value of a field with choices: a quantity has its label, a word stands for itself."""
    if _AXES.fullmatch(value):
        return value.upper()
    return QUANTITIES[value].label if value in QUANTITIES else _WORDS.get(value, value)


def chosen(values: tuple[str, ...], words: str) -> str:
    """Value that is chosen by its words."""
    return next((value for value in values if choice_words(value) == words), words)
