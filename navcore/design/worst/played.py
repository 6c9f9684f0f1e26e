"""A scenario in which nothing errs but the log, and the file of a log that errs as it is told to."""

from __future__ import annotations

import io

import numpy as np

from navcore.design.worst.logs import LogError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.motion.truth import Truth
from navcore.scenario.blocks import Alignment
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.log_files import log_recording, log_series
from navcore.sensors.reference import Outage, Reference
from navcore.sensors.simulated_log import log_works, moored
from navcore.sensors.true_state import horizontal_state, to_ship

_KEPT = ("frame", "rate_hz", "outage", "min_speed_mps", "zero_below_mps")
"""Fields of the log that say how it is read, not how it errs."""
_EARLY = 0.25
"""Part of an interval by which an outage begins before its first epoch, so that rounding loses none."""
_NETWORKS = ("network", "azimuth")


def silent(scenario: Scenario) -> Scenario:
    """Return a scenario without any error: of the IMU, the start and the log.

    A recorded log is taken for a simulated one of the same rate; a network that is designed for the sensors
    keeps the figures for which it is designed.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    """
    log = scenario.reference
    kept = {name: getattr(log, name) for name in _KEPT}
    if log.kind == "file":
        series, along_axes = log_series(log, log_recording(log))
        kept |= {"rate_hz": float(np.clip(1.0 / series.interval_s, 1e-3, 1e3))}
        kept |= {} if along_axes else {"frame": "enu"}
    reference = Reference(kind="none" if log.kind == "none" else "log", **kept)
    return scenario.model_copy(
        update={
            "imu": Imu(),
            "alignment": Alignment(),
            "initial_error": InitialError(),
            "reference": reference,
            "requirement": (),
            "method": tuple(map(_designed, scenario.method)),
        }
    )


def _designed(method: Method) -> Method:
    """Return a method that gives the figures for which its networks are designed."""
    update: dict[str, object] = {"event": ()}
    for name in _NETWORKS:
        network = getattr(method, name)
        if taken := getattr(network, "taken", None):
            update[name] = network.model_copy(update=taken())
    return method.model_copy(update=update)


def epochs_of(scenario: Scenario) -> np.ndarray:
    """Epochs at which the law of a silent scenario reads its log, s, shape (m,)."""
    interval = max(1.0 / scenario.reference.rate_hz, scenario.law_step_s)
    sampled = scenario.strapdown
    duration_s = scenario.sampling.duration_s if sampled else scenario.steps * scenario.run.step_s
    return np.arange(int(duration_s / interval + 1e-9) + 1) * interval


def log_file(scenario: Scenario, truth: Truth, error: LogError, start_utc: float) -> str:
    """CSV of what a log says whose error is given.

    Parameters
    ----------
    scenario : Scenario
        Of `silent`.
    truth : Truth
        Its motion.
    error : LogError
        In the log's axes.
    start_utc : float
        Time of t = 0 in the file, s.
    """
    time_s, log = epochs_of(scenario), scenario.reference
    velocity, heading = horizontal_state(truth, time_s)
    velocity, heading = np.broadcast_to(velocity, (time_s.size, 2)), np.broadcast_to(heading, time_s.size)
    own = to_ship(velocity, heading) if log.frame == "body" else velocity
    said = own + error.at(time_s)
    said[np.broadcast_to(moored(log, truth, time_s), time_s.size)] = 0.0
    names = "speed_starboard_mps,speed_mps" if log.frame == "body" else "ve_mps,vn_mps"
    made = io.StringIO()
    made.write(f"t_s,{names}\n")
    np.savetxt(made, np.column_stack([time_s + start_utc, said]), fmt="%.10g,%.9g,%.9g")
    return made.getvalue()


def playing(scenario: Scenario, truth: Truth, method: Method, file: str, what: str) -> Scenario:
    """Return the scenario that plays the file of a log to one method.

    Parameters
    ----------
    scenario : Scenario
        Of `silent`.
    truth : Truth
        Its motion.
    method : Method
        One of its methods.
    file : str
        Name of the file.
    what : str
        Error that the log makes as large as it can.
    """
    log = scenario.reference
    reference = Reference(kind="file", file=file, frame=log.frame, outage=_outages(scenario, truth))
    title = Text("Worst log of {method} for the {what}", method=method.name, what=what)
    return scenario.model_copy(
        update={"title": str(title), "source": "", "reference": reference, "method": (method,)}
    )


def _outages(scenario: Scenario, truth: Truth) -> tuple[Outage, ...]:
    """Times in which the log gives nothing, for whatever reason."""
    time_s, log = epochs_of(scenario), scenario.reference
    fails = ~(log_works(log, truth, time_s) | np.broadcast_to(moored(log, truth, time_s), time_s.size))
    if len(time_s) < 2 or not fails.any():
        return ()
    changes = np.flatnonzero(np.diff(np.concatenate([[False], fails, [False]]).astype(np.int8)))
    interval = float(time_s[1] - time_s[0])
    begins, ends = changes[::2] * interval, changes[1::2] * interval
    return tuple(
        Outage(t_h=(begin - _EARLY * interval) / HOUR if begin else 0.0, duration_s=end - begin)
        for begin, end in zip(begins.tolist(), ends.tolist(), strict=True)
    )
