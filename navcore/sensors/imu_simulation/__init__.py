"""Increments of a simulated IMU, by quadrature of the analytic truth (theory.md 6)."""

from navcore.sensors.imu_simulation.lanes import side_by_side
from navcore.sensors.imu_simulation.simulation import ImuSimulation

__all__ = ["ImuSimulation", "side_by_side"]
