"""Times of recordings: epochs, stamps coarser than the data, steps of a clock, and what is doubted."""
