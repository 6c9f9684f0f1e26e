"""Tab "Step": step responses."""
