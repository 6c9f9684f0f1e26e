"""Common parts of the terms of a sensor's error, and the errors as the mechanizations take them."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from navcore.foundation.parameters import Parameters
from navcore.foundation.registry import loaded

NO_DRIFT = (0.0, 3600.0)


@dataclass(frozen=True, eq=False)
class ErrorPart:
    """Contribution of one term to the errors of a sensor with n axes; what is not given is not there.

    Attributes
    ----------
    fields : tuple of str
        Fields of the scenario's block that set it.
    source : str
        Name in the error budget: ``gyro_...``, ``accel_...`` or ``log_...``.
    label : str
        Name for people; parts of one label are one source in "Why".
    constant : ndarray, shape (n,)
        Error that does not change, SI.
    deviation : ndarray, shape (n,)
        Standard deviation by which the error budget knows the constant.
    white : float
        White noise: of an inertial sensor the random walk of its integral, of a log that of a sample.
    markov : tuple of float
        Standard deviation and correlation time (s) of a first-order Gauss-Markov process.
    lsb : ndarray or float
        Step of the readings; 0 for none.
    """

    fields: tuple[str, ...]
    source: str
    label: str
    constant: Any = 0.0
    deviation: Any = 0.0
    white: float = 0.0
    markov: tuple[float, float] = NO_DRIFT
    lsb: Any = 0.0

    @property
    def sensor(self) -> str:
        """The sensor: "gyro", "accel" or "log"."""
        return self.source.partition("_")[0]

    @property
    def has_shape(self) -> bool:
        """Whether the error budget knows it by the numbers of the scenario as they stand."""
        return False

    @property
    def active(self) -> bool:
        """Whether it does anything in a run."""
        own = np.any(self.constant) or np.any(self.lsb)
        return bool(own) or self.white > 0.0 or self.markov[0] > 0.0 or self.has_shape


def load_terms(*places: str) -> list[Any]:
    """Load the classes of terms from ``"package.module:Class"``."""
    return [*map(loaded, places)]


@dataclass(frozen=True)
class Apart:
    """A term that was added while the program runs, from whose class the sensor's block is not derived.

    Attributes
    ----------
    term : type
        The class of the term.
    """

    term: type[Parameters]

    def parts(self, block: Parameters) -> Iterable[Any]:
        """Give the parts of the term for the values of its fields in a block that may be older than it."""
        given = vars(block)
        own = {name: given.get(name, info.default) for name, info in self.term.model_fields.items()}
        return self.term.model_construct(**own).parts()  # pyright: ignore[reportAttributeAccessIssue]


def modelled_drift(parts: Iterable[ErrorPart]) -> ErrorPart | None:
    """Return the drift of a sensor that the stochastic model holds: the strongest; None without any."""
    drifts = (part for part in parts if part.markov[0] > 0.0)
    return max(drifts, key=lambda part: part.markov[0] ** 2 * part.markov[1], default=None)


@dataclass(frozen=True)
class SensorErrors:
    """Inertial sensor errors turned to the navigation frame, mean over each step.

    Of sensors side by side each array has a further axis, one place a set of sensors.

    Attributes
    ----------
    gyro : ndarray, shape (n, 3), or (1, 3) when constant
        eps in E, N, U, rad/s; row k holds over the step from t_k to t_(k+1).
    accel : ndarray, shape (n, 3) or (1, 3)
        nabla in E, N, U, m/s^2.
    """

    gyro: np.ndarray
    accel: np.ndarray

    def alone(self) -> "SensorErrors":
        """Return the first of sensors side by side."""
        return SensorErrors(self.gyro[:, :, 0], self.accel[:, :, 0])


@dataclass(frozen=True)
class ReferenceErrors:
    """Errors of the reference velocity (log) at its own epochs.

    Attributes
    ----------
    time_s : ndarray, shape (m,)
        Epochs, s after the start of navigation, increasing.
    error : ndarray, shape (m, 2)
        V_r minus the true velocity, E and N, m/s, as far as it does not depend on the computed heading. Of
        logs side by side (m, 2, width), one place a log.
    valid : ndarray of bool, shape (m,)
        False while the log gives nothing (outage, invalid flag).
    body_frame : bool
        The log measures in the body frame and is turned by the *computed* heading: the mechanization adds
        the effect of the heading error (physics: dV_rE += phi_U V_N, dV_rN -= phi_U V_E).
    hold_s : float
        A sample older than this counts as missing.
    moored : ndarray of bool, shape (m,) or (0,)
        Epochs at which the velocity zero of a moored ship stands in the place of the log; none where empty.
    """

    time_s: np.ndarray
    error: np.ndarray
    valid: np.ndarray
    body_frame: bool
    hold_s: float
    moored: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=bool))

    def alone(self) -> "ReferenceErrors":
        """Return the first of logs side by side."""
        return replace(self, error=self.error[:, :, 0])
