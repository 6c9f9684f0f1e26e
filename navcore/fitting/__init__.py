"""Fits: the error models of a recorded log and of a standing IMU, with 95 % intervals."""
