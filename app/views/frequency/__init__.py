"""Tab "Frequency": Bode and Nyquist plots."""
