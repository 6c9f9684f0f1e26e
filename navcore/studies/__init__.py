"""Studies over many runs: tuning, and the sources that a result is made of."""
