"""Tab "Metrics": the numbers of a run, what dominates them, its warnings."""
