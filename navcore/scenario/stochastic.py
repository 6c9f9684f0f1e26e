"""The stochastic model of a scenario's sensors, log and start, in SI (theory.md 14)."""

import math
from dataclasses import dataclass, replace

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.networks.lqg import SensorFigures
from navcore.scenario.model import Scenario

RANDOM_SOURCES = ("gyro_white", "gyro_drift", "accel_white", "accel_drift", "log_white", "log_drift")
"""Sources that are random processes, in the order of every table; the others are random constants."""

CONSTANTS = (
    ("gyro_bias", "imu", "gyro_bias_std_dph", "gyro_bias_dph"),
    ("accel_bias", "imu", "accel_bias_std_ug", "accel_bias_ug"),
    ("log_bias", "reference", "bias_std_mps", "bias_mps"),
    ("initial_tilt", "initial_error", "level_std_arcmin", "attitude_arcmin"),
    ("initial_heading", "initial_error", "heading_std_arcmin", "attitude_arcmin"),
    ("initial_velocity", "initial_error", "velocity_std_mps", "velocity_mps"),
    ("initial_position", "initial_error", "position_std_arcsec", "position_arcsec"),
)
"""Constant sources of the budget: name, block, field of the standard deviation, field of the numbers."""

_PARTS = {"initial_tilt": slice(0, 2), "initial_heading": slice(2, 3)}
"""Numbers of a field that belong to one source, where two sources share the field."""


@dataclass(frozen=True)
class Drift:
    """First-order Gauss-Markov process.

    Attributes
    ----------
    sigma : float
        Standard deviation, SI.
    tau_s : float
        Correlation time, s.
    """

    sigma: float
    tau_s: float

    @property
    def drive(self) -> float:
        """Power spectral density of the white noise that drives it, 2 sigma^2 / tau."""
        return 2.0 * self.sigma**2 / self.tau_s


@dataclass(frozen=True, eq=False)
class StochasticModel:
    """Prior knowledge of the error sources.

    Attributes
    ----------
    figures : SensorFigures
        Random errors, as a filter is told of them: the log's resolution counts as noise of lsb / sqrt(12).
    log : bool
        Whether there is a log at all.
    tide : ndarray, shape (2,)
        Amplitudes of the tidal stream, E and N, m/s.
    tide_period_s : float
        Its period.
    gyro_bias, accel_bias : ndarray, shape (3,)
        Standard deviations in body axes, rad/s, m/s^2.
    log_bias : ndarray, shape (2,)
        Standard deviations in the log's axes, m/s.
    initial : ndarray, shape (7,)
        Standard deviations of dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U at t = 0.
    rounding : float
        Root mean square of the error of the log's rounding that stands while the speed does, m/s; part of
        ``figures.log_noise``.
    """

    figures: SensorFigures
    log: bool
    tide: np.ndarray
    tide_period_s: float
    gyro_bias: np.ndarray
    accel_bias: np.ndarray
    log_bias: np.ndarray
    initial: np.ndarray
    rounding: float = 0.0

    @property
    def loop_figures(self) -> SensorFigures:
        """Random errors as they act on a loop: without the part of the rounding that stands."""
        left = self.figures.log_noise**2 - self.rounding**2
        return replace(self.figures, log_noise=math.sqrt(max(left, 0.0)))

    @property
    def gyro_drift(self) -> Drift:
        """Gauss-Markov part of the gyros, rad/s."""
        return Drift(self.figures.gyro_drift, self.figures.gyro_tau_s)

    @property
    def accel_drift(self) -> Drift:
        """Gauss-Markov part of the accelerometers, m/s^2."""
        return Drift(self.figures.accel_drift, self.figures.accel_tau_s)

    @property
    def log_drift(self) -> Drift:
        """Gauss-Markov part of the log, m/s."""
        return Drift(self.figures.log_drift, self.figures.log_tau_s)

    @property
    def silent(self) -> bool:
        """Whether no random process is on at all."""
        return not (self.figures.inertial or self.figures.log)


def stated_constants(scenario: Scenario) -> frozenset[str]:
    """Constant sources whose standard deviation is stated; the others are what their numbers say."""
    return frozenset(
        source
        for source, block, deviation, _ in CONSTANTS
        if getattr(getattr(scenario, block), deviation) is not None
    )


def drawn_as_zero(scenario: Scenario) -> tuple[str, ...]:
    """Fields of standard deviations that are given without a number: a run takes 0 for their constants.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.

    Examples
    --------
    >>> from navcore import load
    >>> drawn_as_zero(load("zha-fast", ["imu.gyro_bias_std_dph=0.01", "imu.gyro_bias_dph=[0,0,0]"]))
    ('imu.gyro_bias_std_dph',)
    """
    fields = []
    for source, block, deviation, number in CONSTANTS:
        values = getattr(getattr(scenario, block), number)
        part = _PARTS.get(source, slice(None))
        if f"{block}.{deviation}" in given_deviations(scenario) and not np.any(np.atleast_1d(values)[part]):
            fields.append(f"{block}.{deviation}")
    return tuple(fields)


def tells_constants(scenario: Scenario, block: str) -> bool:
    """Whether a block of `CONSTANTS` says what its constants are: one that is recorded does not."""
    if block == "reference":
        return scenario.reference.kind == "log"
    return not (scenario.on_ins or (block == "imu" and scenario.imu.file is not None))


def require_sensors(scenario: Scenario) -> None:
    """Refuse to say what errors of sensors do on the output of an INS, which does not tell them.

    Raises
    ------
    InputError
        The scenario runs on ``[ins]``.
    """
    if scenario.on_ins:
        told = Text(
            "the output of an INS does not tell the errors of its sensors, on which this rests: ask it of a "
            "scenario with [motion], [imu] and [reference] of your own; run, tune and the limits of a run go "
            "by the recording"
        )
        raise InputError(Fault("", "ins.file", scenario.ins.file, told))


def given_deviations(scenario: Scenario) -> tuple[str, ...]:
    """Fields of standard deviations above 0 that the scenario gives and its seeds draw by."""
    fields = []
    for _, block, deviation, _ in CONSTANTS:
        settings = getattr(scenario, block)
        if not tells_constants(scenario, block):
            continue
        if np.any(getattr(settings, deviation) or 0.0):
            fields.append(f"{block}.{deviation}")
    return tuple(fields)


def stochastic_model(scenario: Scenario) -> StochasticModel:
    """Make the model from ``[imu]``, ``[reference]`` and ``[initial_error]``.

    A bias or initial error that is given as one number counts as its own standard deviation, unless the
    scenario gives one (``gyro_bias_std_dph`` and the like). Of a recorded log nothing is known beforehand:
    it counts as a log without error.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    """
    imu, log = scenario.imu, scenario.reference
    simulated = log.kind == "log"
    known = 1.0 if simulated else 0.0
    return StochasticModel(
        figures=scenario.figures(),
        log=log.kind != "none",
        tide=known * np.array(log.tide_mps),
        tide_period_s=log.tide_period_h * HOUR,
        gyro_bias=imu.gyro().deviation,
        accel_bias=imu.accel().deviation,
        log_bias=known * log.deviation,
        initial=np.array(scenario.initial_error.standard_deviations()),
        rounding=known * log.rounding,
    )
