"""Fold "Motion" of the tab "Setup": the ship's motion, and its route by hand."""
