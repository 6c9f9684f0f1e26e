"""Tab "View": units, axes, envelope, export of a plot, light or dark page."""
