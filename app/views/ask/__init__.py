"""Tab "Ask": every question without a tab of its own, as a form made from its fields."""
