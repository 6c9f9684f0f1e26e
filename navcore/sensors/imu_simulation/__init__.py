"""Increments of a simulated IMU, by quadrature of the analytic truth (theory.md 6)."""

from navcore.sensors.imu_simulation.simulation import ImuSimulation

__all__ = ["ImuSimulation"]
