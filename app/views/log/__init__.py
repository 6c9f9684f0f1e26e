"""Fold "Log" of the tab "Setup": the reference velocity, its errors, events and outages."""
