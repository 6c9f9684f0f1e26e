"""Sensors: what the true motion becomes once measured. Made once per scenario, shared by all methods."""
