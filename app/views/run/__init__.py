"""Fold "Run" of the tab "Setup": duration, site, initial errors, seed, strapdown settings."""
