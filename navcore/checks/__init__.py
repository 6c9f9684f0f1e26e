"""Reports on a log, an IMU record or a scenario file, and on their faults."""
