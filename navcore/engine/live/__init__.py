"""Damping laid on the output of a ship's own INS as it comes (theory.md 22)."""
