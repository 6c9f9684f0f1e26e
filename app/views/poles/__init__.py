"""Tab "Poles": the pole map, root locus and placement of a pair."""
