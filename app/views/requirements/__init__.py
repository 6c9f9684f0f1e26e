"""Tab "Requirements": limits and which method meets them."""
