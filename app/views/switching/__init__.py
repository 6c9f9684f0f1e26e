"""Tab "Switching": when and why each method damps."""
