"""Lessons and explanations, read from `assets`, with the live numbers they speak of."""
