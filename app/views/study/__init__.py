"""Tab "Study": a scenario over settings and seeds: map, what counts most, shares, the worst runs."""
