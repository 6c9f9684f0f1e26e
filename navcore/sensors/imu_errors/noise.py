"""Random errors of the inertial sensors: white noise and bias instability."""

from collections.abc import Iterator

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR, DEG_PER_SQRT_HOUR, MICRO_G
from navcore.sensors.imu_errors.base import ImuTerm, Part


class White(ImuTerm):
    """Angular and velocity random walk."""

    gyro_arw_dpsh: float = quantity(
        0.0,
        unit="deg/sqrt(h)",
        ge=0.0,
        le=100.0,
        slider=(0.0, 0.05),
        label=Text("angular random walk"),
        help=Text("White noise of the gyros: standard deviation of the integrated angle after one hour."),
    )
    accel_vrw_ugpshz: float = quantity(
        0.0,
        unit="ug/sqrt(Hz)",
        ge=0.0,
        le=1e6,
        slider=(0.0, 100.0),
        label=Text("velocity random walk"),
        help=Text(
            "White noise of the accelerometers: the mean over T s has the standard deviation VRW/√(T)."
        ),
    )

    def parts(self) -> Iterator[Part]:
        """Yield the noise of both."""
        gyro, accel = self.gyro_arw_dpsh * DEG_PER_SQRT_HOUR, self.accel_vrw_ugpshz * MICRO_G
        yield Part(("gyro_arw_dpsh",), "gyro_white", Text("gyro noise"), white=gyro)
        yield Part(("accel_vrw_ugpshz",), "accel_white", Text("accelerometer noise"), white=accel)


class Drift(ImuTerm):
    """Instability of the biases, as first-order Gauss-Markov processes."""

    gyro_instability_dph: float = quantity(
        0.0,
        unit="deg/h",
        ge=0.0,
        le=1e4,
        slider=(0.0, 0.05),
        label=Text("gyro instability"),
        help=Text("Standard deviation of a first-order Gauss-Markov drift, stationary from the start."),
    )
    gyro_tau_s: float = quantity(
        3600.0,
        unit="s",
        ge=1.0,
        le=1e7,
        slider=(10.0, 86400.0),
        log=True,
        label=Text("gyro correlation time"),
        help=Text("Correlation time of the gyros' Gauss-Markov drift."),
    )
    accel_instability_ug: float = quantity(
        0.0,
        unit="ug",
        ge=0.0,
        le=1e5,
        slider=(0.0, 100.0),
        label=Text("accelerometer instability"),
        help=Text("Standard deviation of a first-order Gauss-Markov drift, stationary from the start."),
    )
    accel_tau_s: float = quantity(
        3600.0,
        unit="s",
        ge=1.0,
        le=1e7,
        slider=(10.0, 86400.0),
        log=True,
        label=Text("accelerometer correlation time"),
        help=Text("Correlation time of the accelerometers' Gauss-Markov drift."),
    )

    def parts(self) -> Iterator[Part]:
        """Yield the drift of both."""
        gyro = self.gyro_instability_dph * DEG_PER_HOUR, self.gyro_tau_s
        accel = self.accel_instability_ug * MICRO_G, self.accel_tau_s
        yield Part(("gyro_instability_dph",), "gyro_drift", Text("gyro noise"), markov=gyro)
        yield Part(("accel_instability_ug",), "accel_drift", Text("accelerometer noise"), markov=accel)
