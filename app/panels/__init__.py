"""Arrangement of widgets, one panel a file; no arithmetic, no lists of fields."""
