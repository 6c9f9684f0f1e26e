"""Files of a recorded log: its streams, put right as the scenario says, and the speed that is used."""

from dataclasses import replace

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.recording import load
from navcore.io.series import Recording, Series
from navcore.sensors.reference import Reference

_SPEEDS = ("water", "ground", "velocity")


def log_recording(reference: Reference) -> Recording:
    """Files of the log, by its own clock and factor put right; raises `InputError` with field ``file``."""
    recording = load(reference.file or (), field="file", map_file=reference.map)
    streams = {name: one.shifted(reference.clock_s) for name, one in recording.quantities().items()}
    if reference.factor != 1.0:
        streams |= {
            name: replace(one, values=one.values * reference.factor)
            for name, one in streams.items()
            if name in _SPEEDS
        }
    return replace(recording, **streams)


def log_series(reference: Reference, recording: Recording) -> tuple[Series, bool]:
    """Choose the speed that serves as reference.

    Returns
    -------
    series : Series
        Starboard and forward, or east and north.
    along_axes : bool
        True for starboard and forward.

    Raises
    ------
    InputError
        The files hold no speed.
    """
    wanted = {"water": recording.water, "ground": recording.ground}
    series = wanted.pop(reference.speed) or next(iter(wanted.values()))
    if series is not None:
        return series, True
    if recording.velocity is not None:
        return recording.velocity, False
    expected = Text("VBW, VHW, VTG or RMC sentences, or columns speed_mps, speed_kn or ve_mps and vn_mps")
    allowed = Text("holds no speed: expected {expected}", expected=expected)
    raise InputError(Fault("", "file", reference.file, allowed))
