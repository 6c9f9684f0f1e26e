"""Tab "Files": recordings and scenarios in, scenario and numbers out."""
