"""Tab "Misprints": errors printed in the papers, as printed and corrected."""
