"""Tab "Sweep": a metric of all methods over latitude, log error, sensor grade and sea state."""
