"""Fold "Sensors" of the tab "Setup": errors of gyros and accelerometers."""
