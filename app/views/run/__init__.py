"""Tab "Run": duration, site, motion, initial errors, strapdown settings."""
