"""Errors that the log adds in its own axes: bias, noise, drift."""

from collections.abc import Iterator
from typing import Annotated

import numpy as np

from navcore.foundation.parameters import bounded, quantity, vector_quantity
from navcore.foundation.text import Text
from navcore.sensors.log_errors.base import LogPart, LogTerm

_Speed = Annotated[float, bounded(unit="m/s", ge=-50.0, le=50.0)]


class LogBias(LogTerm):
    """Constant error."""

    bias_mps: tuple[_Speed, _Speed] = vector_quantity(
        (0.0, 0.0),
        unit="m/s",
        elements=("E / starboard", "N / forward"),
        slider=(-2.0, 2.0),
        label=Text("bias"),
        help=Text("Constant error: east, north; with frame = body starboard, forward."),
    )
    bias_std_mps: float | None = quantity(
        None,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 2.0),
        label=Text("bias, standard deviation"),
        help=Text(
            "Standard deviation of the bias on each axis, in the error budget and the tuning. Not given: "
            "the size of each bias_mps."
        ),
    )

    def parts(self) -> Iterator[LogPart]:
        """Yield the bias."""
        bias = np.array(self.bias_mps, dtype=float)
        deviation = np.abs(bias) if self.bias_std_mps is None else np.full(2, self.bias_std_mps)
        yield LogPart(("bias_mps",), "log_bias", Text("log bias"), constant=bias, deviation=deviation)


class LogNoise(LogTerm):
    """White noise of the samples."""

    noise_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 1.0),
        label=Text("noise"),
        help=Text(
            "Standard deviation of one sample, on each axis. At rates above one sample a step the samples "
            "of a step are averaged."
        ),
    )

    def parts(self) -> Iterator[LogPart]:
        """Yield the noise."""
        yield LogPart(("noise_mps",), "log_white", Text("log noise"), white=self.noise_mps)


class LogDrift(LogTerm):
    """Slow error as a first-order Gauss-Markov process."""

    drift_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 1.0),
        label=Text("drift"),
        help=Text("Standard deviation of a slow error, on each axis (first-order Gauss-Markov)."),
    )
    drift_tau_s: float = quantity(
        600.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(10.0, 36000.0),
        log=True,
        label=Text("drift time"),
        help=Text("Correlation time of the drift."),
    )

    def parts(self) -> Iterator[LogPart]:
        """Yield the drift."""
        yield LogPart(
            ("drift_mps",), "log_drift", Text("log drift"), markov=(self.drift_mps, self.drift_tau_s)
        )
