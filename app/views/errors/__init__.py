"""Tab "Errors": the error curves of a run over time."""
