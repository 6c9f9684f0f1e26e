"""What the difference of a log and an INS says of both: a wrong unit, and damping that nobody told."""

import math

import numpy as np

from navcore.averaging.lines import line_phases
from navcore.engine.environment import Environment
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.foundation.units import KNOT
from navcore.scenario.model import Scenario
from navcore.sensors.true_state import horizontal_state

_FEWEST = 600
"""Readings of the log from which its unit and the lines of its difference are looked at."""
_LEAST_MPS = 3.0
"""Mean speed of the ship from which no current explains a factor of two."""
_NEAR_KNOT = 0.1
"""Share by which currents and scale errors may take a factor off that of a knot."""
_LEAST_PERIODS = 3.0
"""Schuler periods from which the line at 84 min can be told from its neighbours."""
_BESIDE = (0.6, 0.75, 1.35, 1.6)
"""Neighbours: their frequencies over that of the line."""
_STANDS_OUT = 2.5
"""A line is there where it is so many times as strong as its neighbours."""
_MOST = 6000


def require_units(scenario: Scenario, env: Environment) -> None:
    """Refuse a log whose speeds are those of the INS in another unit.

    Parameters
    ----------
    scenario : Scenario
        On ``[ins]``.
    env : Environment
        Of it.

    Raises
    ------
    InputError
        The log reads knots as metres a second, or the other way round; the fault gives the factor.
    """
    log = env.reference
    if np.count_nonzero(log.valid) < _FEWEST:
        return
    out = horizontal_state(env.truth_half, log.time_s[log.valid])[0]
    own, told = np.hypot(*out.T), np.hypot(*(out + log.error[log.valid]).T)
    if own.mean() < _LEAST_MPS:
        return
    factor = float(np.sum(told * own) / np.sum(own * own))
    for unit, words in ((1.0 / KNOT, Text("knots taken for m/s")), (KNOT, Text("m/s taken for knots"))):
        if abs(factor / unit - 1.0) < _NEAR_KNOT:
            allowed = Text(
                "the log reads {factor:.3g} times the speed of the INS: {words}? Set reference.factor = "
                "{value:.4g}, or the unit of the column in a map",
                factor=factor,
                words=words,
                value=scenario.reference.factor / unit,
            )
            raise InputError(Fault("", "reference.factor", scenario.reference.factor, allowed))


def already_damped(scenario: Scenario, env: Environment) -> str:
    """Say that the INS seems to have been damped when it was recorded; kept from run to run."""
    files = recorded_state(scenario.ins), recorded_state(scenario.reference)
    key = "already damped", files, scenario.ins, scenario.reference, scenario.run, scenario.earth.name
    return kept(key, lambda: _already_damped(scenario, env))


def _already_damped(scenario: Scenario, env: Environment) -> str:
    """Say that the INS seems to have been damped when it was recorded; empty where nothing says so.

    A free INS swings against its log with the Schuler period, in two lines that the Foucault effect parts.
    Where no line stands out from the frequencies beside it, something has damped it.
    """
    log, step_s = env.reference, scenario.run.step_s
    chosen = np.flatnonzero(log.valid)
    if scenario.ins.damping.kind.uses_network or chosen.size < _FEWEST:
        return ""
    chosen = chosen[:: max(1, chosen.size // _MOST)]
    time_s = log.time_s[chosen]
    periods = (time_s[-1] - time_s[0]) * scenario.omega_s / math.tau
    if periods < _LEAST_PERIODS:
        return ""
    rows = env.truth_half.at(np.rint(2.0 * time_s / step_s).astype(np.int64))
    plus, minus, earth = line_phases(time_s, rows, scenario.earth).T
    ramp = (time_s - time_s[0]) / (time_s[-1] - time_s[0])
    slow = [np.ones_like(ramp), ramp, ramp**2, np.cos(earth), np.sin(earth)]

    def strength(times: float) -> float:
        phases = (times * plus, times * minus) if plus[-1] - minus[-1] > 0.5 * math.pi else (times * plus,)
        waves = [wave(phase) for phase in phases for wave in (np.cos, np.sin)]
        design = np.column_stack([*slow, *waves])
        # by the normal equations: a few columns, and a thousand times less work
        found, *_ = np.linalg.lstsq(design.T @ design, design.T @ log.error[chosen], rcond=1e-12)
        return float(np.sqrt(np.mean(np.sum((design[:, len(slow) :] @ found[len(slow) :]) ** 2, axis=1))))

    line = strength(1.0)
    beside = float(np.exp(np.mean(np.log([max(strength(times), 1e-12) for times in _BESIDE]))))
    if line > _STANDS_OUT * beside:
        return ""
    return Text(
        "the INS shows no oscillation at {minutes:.0f} min against the log ({line:.2g} m/s, {beside:.2g} m/s "
        "at the periods beside it): it seems to have been damped when it was recorded. Say how in "
        "[ins.damping]; without that the methods are damping on top of an unknown damping",
        minutes=math.tau / scenario.omega_s / 60.0,
        line=line,
        beside=beside,
    )
