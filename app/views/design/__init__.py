"""Tab "Design": which source each method's error is made of, beside the least error that is possible."""
