"""Tab "Learn": lessons."""
