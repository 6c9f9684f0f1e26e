"""Terms of the IMU's error, one file each: fields of the block ``imu`` and what they do to the readings."""

from navcore.sensors.base import load_terms

TERMS = load_terms(
    "navcore.sensors.imu_errors.bias:Bias",
    "navcore.sensors.imu_errors.noise:White",
    "navcore.sensors.imu_errors.noise:Drift",
    "navcore.sensors.imu_errors.coupling:Coupling",
    "navcore.sensors.imu_errors.counts:Counts",
    "navcore.sensors.imu_errors.bias:BiasDeviation",
)
"""All terms, in the order in which the page offers their fields."""
