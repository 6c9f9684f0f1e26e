"""Tab "Log": the reference velocity, its errors, events and outages."""
