"""Tab "Sensors": errors of gyros and accelerometers."""
