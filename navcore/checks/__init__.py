"""What a log, an IMU record or a scenario file holds, and what is wrong with it."""
